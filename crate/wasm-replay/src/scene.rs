//! What a recording was made with.

use mapless::PlannerConfig;
use mapless::config::CostModel;
use mapless::skyline::beam_grid::BeamGrid;
use mapless_recording::Player;
use serde::Serialize;
use tsify::Tsify;

use crate::file::File;
use crate::sight::{ImageSize, Mount, SegmentDemands, TiltLimits};

/// What a recording was made with, as far as the page shows it.
#[derive(Debug, Serialize, Tsify)]
pub struct RecordedScene {
    /// Whether the robot's own decisions are in it; those of other files are made anew.
    has_decisions: bool,
    /// Whether the subgoals' cost is the paper's.
    is_paper: bool,
    limits: TiltLimits,
    occupancy_radius_m: f64,
    mount: Mount,
    image: ImageSize,
    demands: SegmentDemands,
}

impl RecordedScene {
    pub(crate) fn of(player: &Player<File>, config: &PlannerConfig) -> Self {
        Self {
            has_decisions: player.head().is_some(),
            is_paper: config.decision.cost_model == CostModel::Paper,
            limits: TiltLimits::from(&config.robot),
            occupancy_radius_m: config.perception.surface_radius_m,
            mount: Mount::from(&config.sensor),
            image: ImageSize::from(&BeamGrid::new(&config.sensor)),
            demands: SegmentDemands::from(config),
        }
    }
}

//! The rows of a perception report: the planner's types by their names in JSON.

use mapless::Command;
use mapless::decision::subgoals::{Cost, Refusal, Subgoal};
use mapless::skyline::columns::column_azimuth_rad;
use mapless::skyline::profile::Column;
use mapless::skyline::segments::{Segment, Verdict};

#[derive(serde::Serialize)]
pub(crate) struct CommandRow {
    pub(crate) linear_m_s: f64,
    pub(crate) angular_rad_s: f64,
}

#[derive(serde::Serialize)]
pub(crate) struct ColumnRow {
    pub(crate) azimuth_rad: f64,
    pub(crate) elevation_rad: Option<f64>,
    pub(crate) kind: &'static str,
}

#[derive(serde::Serialize)]
pub(crate) struct SegmentRow {
    pub(crate) begin_rad: f64,
    pub(crate) end_rad: f64,
    pub(crate) extent_rad: f64,
    pub(crate) width_m: f64,
    pub(crate) elevation_rad: Option<f64>,
    pub(crate) height_m: Option<f64>,
    pub(crate) verdict: &'static str,
}

#[derive(serde::Serialize)]
pub(crate) struct SubgoalRow {
    /// Index of its segment; none for the goal itself.
    pub(crate) segment: Option<usize>,
    pub(crate) azimuth_rad: f64,
    pub(crate) elevation_rad: f64,
    pub(crate) bearing_rad: f64,
    pub(crate) position_m: [f64; 3],
    /// `tilt`, `unseen` or none for a candidate.
    pub(crate) refusal: Option<&'static str>,
    /// Weighted terms; none if refused.
    pub(crate) cost: Option<CostRow>,
}

#[derive(serde::Serialize)]
pub(crate) struct CostRow {
    pub(crate) direction: f64,
    pub(crate) distance: f64,
    pub(crate) steepness: f64,
    pub(crate) commitment: f64,
    pub(crate) correction: f64,
    pub(crate) total: f64,
}

impl ColumnRow {
    pub(crate) fn of(index: usize, column: Column) -> Self {
        let (elevation_rad, kind) = match column {
            Column::Ground { elevation_rad } => (Some(elevation_rad), "ground"),
            Column::Unknown => (None, "unknown"),
            Column::Wall => (None, "wall"),
        };
        Self { azimuth_rad: column_azimuth_rad(index), elevation_rad, kind }
    }
}

impl SegmentRow {
    pub(crate) fn of(segment: &Segment) -> Self {
        Self {
            begin_rad: segment.begin_rad,
            end_rad: segment.end_rad(),
            extent_rad: segment.extent_rad,
            width_m: segment.width_m,
            elevation_rad: segment.elevation_rad,
            height_m: segment.height_m,
            verdict: match segment.verdict {
                Verdict::Valid => "valid",
                Verdict::TooNarrow => "too_narrow",
                Verdict::TooSteep => "too_steep",
                Verdict::Unknown => "unknown",
                Verdict::Wall => "wall",
            },
        }
    }
}

impl SubgoalRow {
    pub(crate) fn of(subgoal: &Subgoal) -> Self {
        Self {
            segment: subgoal.segment,
            azimuth_rad: subgoal.azimuth_rad,
            elevation_rad: subgoal.elevation_rad,
            bearing_rad: subgoal.bearing_rad,
            position_m: subgoal.position_m.to_array(),
            refusal: subgoal.refusal.map(|refusal| match refusal {
                Refusal::Tilt => "tilt",
                Refusal::Unseen => "unseen",
            }),
            cost: subgoal.cost.as_ref().map(CostRow::of),
        }
    }
}

impl CostRow {
    fn of(cost: &Cost) -> Self {
        Self {
            direction: cost.direction,
            distance: cost.distance,
            steepness: cost.steepness,
            commitment: cost.commitment,
            correction: cost.correction,
            total: cost.total(),
        }
    }
}

impl CommandRow {
    pub(crate) fn of(command: Command) -> Self {
        Self { linear_m_s: command.linear_m_s, angular_rad_s: command.angular_rad_s }
    }
}

//! The oracle as a route planner.

use super::{OracleConfig, PlanPose, shortest_path};
use crate::RoutePlanner;
use glam::DVec2;
use mapless::Pose;
use mapless_world::{HeightField, RobotConfig};

/// Knows the whole ground, and takes the shortest safe path over it.
#[derive(Clone, Debug)]
pub struct Oracle {
    /// The ground.
    pub field: HeightField,
    /// The robot whose attitudes are checked.
    pub robot: RobotConfig,
    /// Parameters of the search.
    pub config: OracleConfig,
}

impl RoutePlanner for Oracle {
    fn route(&self, from: &Pose, to_m: DVec2) -> Option<Vec<DVec2>> {
        let start = PlanPose { position_m: from.plan_m(), yaw_rad: from.yaw_rad };
        let path = shortest_path(&self.field, &self.robot, start, to_m, &self.config).ok()?;
        Some(path.points_m().collect())
    }
}

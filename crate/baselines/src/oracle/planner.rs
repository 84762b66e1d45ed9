//! The oracle as a route planner.

use super::{OracleConfig, PlanPose, shortest_path};
use crate::RoutePlanner;
use crate::known_world::KnownWorld;
use glam::DVec2;
use mapless::Pose;

/// Knows the whole ground and what stands on it, and takes the shortest safe path over it.
#[derive(Clone, Debug)]
pub struct Oracle {
    /// What it knows.
    pub world: KnownWorld,
    /// Parameters of the search.
    pub config: OracleConfig,
}

impl RoutePlanner for Oracle {
    fn route(&self, from: &Pose, to_m: DVec2) -> Option<Vec<DVec2>> {
        let start = PlanPose { position_m: from.plan_m(), yaw_rad: from.yaw_rad };
        let path = shortest_path(&self.world, start, to_m, &self.config).ok()?;
        Some(path.points_m().collect())
    }
}

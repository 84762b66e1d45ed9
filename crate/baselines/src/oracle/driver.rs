//! The oracle in the closed loop.

use super::{OracleConfig, OracleError, OraclePath, PlanPose, shortest_path};
use crate::PathFollower;
use glam::DVec2;
use mapless::Command;
use mapless::config::ControllerConfig;
use mapless::pose::Pose;
use mapless_world::{HeightField, HuskyConfig};

/// Drives the oracle's path with the paper's PID controller.
#[derive(Clone, Debug)]
pub struct OracleDriver {
    path: OraclePath,
    follower: PathFollower,
    goal_m: DVec2,
}

impl OracleDriver {
    /// Plans from `start` to `goal_m`; `period_s` is the time between steps. The controller's configuration must have been
    /// validated.
    ///
    /// # Errors
    /// As [`shortest_path`].
    pub fn new(
        field: &HeightField,
        robot: &HuskyConfig,
        start: PlanPose,
        goal_m: DVec2,
        config: &OracleConfig,
        controller: ControllerConfig,
        period_s: f64,
    ) -> Result<Self, OracleError> {
        let path = shortest_path(field, robot, start, goal_m, config)?;
        let mut follower = PathFollower::new(controller, period_s);
        follower.set_path(path.points_m());
        Ok(Self { path, follower, goal_m })
    }

    /// The path it drives.
    #[must_use]
    pub fn path(&self) -> &OraclePath {
        &self.path
    }

    /// The command for a robot at `pose`; at the goal it stands still.
    pub fn step(&mut self, pose: &Pose) -> Command {
        self.follower.step(pose, self.goal_m)
    }
}

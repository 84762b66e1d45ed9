//! The interface between the planner and what chooses its subgoal.

use core::time::Duration;

use glam::{DVec2, Vec3};

use crate::config::PlannerConfig;
use crate::control::controller::{Command, Controller};
use crate::decision::step::TerrainOverride;
use crate::decision::subgoals::Subgoal;
use crate::pose::Pose;
use crate::route::state_lattice::PathPoint;
use crate::skyline::profile::Column;
use crate::skyline::segments::Segment;

/// What a policy decides from.
pub(crate) struct Situation<'a> {
    pub(crate) config: &'a PlannerConfig,
    pub(crate) pose: &'a Pose,
    pub(crate) goal_m: DVec2,
    pub(crate) goal_tolerance_m: f64,
    pub(crate) profile: &'a [Column],
    pub(crate) segments: &'a [Segment],
    /// Time since the step before.
    pub(crate) elapsed: Duration,
    /// Replaces what the policy knows of the terrain.
    pub(crate) terrain: Option<TerrainOverride<'a>>,
}

/// The subgoals of a step, the choice among them, and the path to it or back. Its memory is reused.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plan {
    pub(crate) subgoals: Vec<Subgoal>,
    pub(crate) chosen: Option<usize>,
    pub(crate) path: Vec<PathPoint>,
}

impl Plan {
    pub(crate) fn clear(&mut self) {
        self.subgoals.clear();
        self.chosen = None;
        self.path.clear();
    }
}

/// What a policy decided.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Motion {
    /// Drive to the chosen subgoal.
    Drive(Command),
    /// Go back along the robot's own trajectory.
    Backtrack(Command),
    /// There is no candidate.
    NoCandidate,
}

/// Chooses a subgoal and drives to it.
pub(crate) trait SubgoalPolicy {
    /// Forgets what was learned on the way to the last goal.
    fn start(&mut self);

    /// Forgets the terrain.
    fn forget_terrain(&mut self);

    /// Takes in a scan, in the sensor frame, from where the robot stands.
    fn observe(&mut self, config: &PlannerConfig, points_m: &[Vec3], pose: &Pose, elapsed: Duration);

    /// Fills the plan, which is empty, and says how to move.
    fn decide(&mut self, situation: &Situation<'_>, controller: &mut Controller, plan: &mut Plan) -> Motion;

    /// As much of a turn on the spot, anticlockwise, as keeps the robot within its tilt limits.
    fn safe_turn_rad(&self, turn_rad: f64) -> f64;

    /// Whether the robot may turn all around on the spot.
    fn may_spin(&self) -> bool;

    /// Moves all that is remembered from one world frame to another.
    fn relocalise(&mut self, change: &crate::pose::FrameChange);
}

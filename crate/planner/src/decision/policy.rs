//! The interface between the planner and the policy that chooses its subgoal.

use core::time::Duration;

use glam::DVec2;

use crate::config::PlannerConfig;
use crate::control::controller::{Command, Controller};
use crate::decision::step::TerrainOverride;
use crate::decision::subgoals::Subgoal;
use crate::pose::Pose;
use crate::route::state_lattice::PathPoint;
use crate::skyline::profile::Column;
use crate::skyline::scan_filter::ScanFilter;
use crate::skyline::segments::Segment;

/// The input of a policy.
pub(crate) struct Situation<'a> {
    pub(crate) config: &'a PlannerConfig,
    pub(crate) pose: &'a Pose,
    pub(crate) goal_m: DVec2,
    pub(crate) goal_tolerance_m: f64,
    pub(crate) profile: &'a [Column],
    pub(crate) segments: &'a [Segment],
    /// Time since the last step.
    pub(crate) elapsed: Duration,
    /// Time since the last step that observed the ground.
    pub(crate) since_observed: Duration,
    /// The command of the last step.
    pub(crate) last_command: Command,
    /// Replaces the policy's own knowledge of the terrain.
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

/// The motion that a policy decided on.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Motion {
    /// Drive to the chosen subgoal.
    Drive(Command),
    /// Backtrack along the robot's own trajectory.
    Backtrack(Command),
    /// There is no candidate.
    NoCandidate,
}

/// Chooses a subgoal and drives to it.
pub(crate) trait SubgoalPolicy {
    /// Forgets what was learned for the last goal.
    fn start(&mut self);

    /// Forgets the terrain.
    fn forget_terrain(&mut self);

    /// Adds a scan taken at `pose`.
    fn observe(&mut self, config: &PlannerConfig, scan: &ScanFilter, pose: &Pose, elapsed: Duration);

    /// Fills the plan, which is empty, and decides on a motion.
    fn decide(&mut self, situation: &Situation<'_>, controller: &mut Controller, plan: &mut Plan) -> Motion;

    /// Takes up where the robot stands, in a step that does not decide.
    fn stand(&mut self, pose: &Pose, elapsed: Duration);

    /// The largest part of a turn on the spot, anticlockwise, that keeps the robot within its tilt limits and
    /// off what is upright, where it stood last.
    fn safe_turn_rad(&self, turn_rad: f64) -> f64;

    /// Whether the body has room within `distance_m` of a point; `None` if that is unknown.
    fn has_room_within(&self, point_m: DVec2, distance_m: f64) -> Option<bool>;

    /// Whether the robot may turn all around on the spot.
    fn may_spin(&self) -> bool;
}

//! Input of a planner's step besides the scan, and its result.

use glam::DVec2;

use crate::control::controller::Command;
use crate::decision::subgoals::Subgoal;
use crate::gp::jitter::GpError;
use crate::route::state_lattice::PathPoint;
use crate::skyline::occupancy::OccupancySurface;
use crate::skyline::profile::Column;
use crate::skyline::scan_filter::ReturnKind;
use crate::skyline::segments::Segment;
use crate::skyline::surface::GpDiagnostics;
use crate::terrain::plane::Plane;

/// Why the planner stopped. A later step may go on, but after [`NoProgress`](Self::NoProgress) and
/// [`GoalUnreachable`](Self::GoalUnreachable) only with a new goal, or the same one after it was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StopReason {
    /// The pose or the goal is not finite, or more than 1000 km from the origin.
    #[error("the pose or the goal is not finite or too far away")]
    InvalidInput,
    /// No goal was set.
    #[error("no goal is set")]
    NoGoal,
    /// The scan is empty.
    #[error("the scan has no returns")]
    EmptyScan,
    /// The Gaussian process has no posterior.
    #[error("no perception: {0}")]
    NoPerception(GpError),
    /// The spin recovery found no candidate either. A later scan may show one.
    #[error("no subgoal found by the spin recovery")]
    NoSubgoal,
    /// The goal is in sight, or the body has no room there, and much driving brought the robot no nearer.
    #[error("the goal cannot be reached: driving about it brings the robot no nearer")]
    GoalUnreachable,
    /// The robot was commanded to move for half a minute, and got nowhere.
    #[error("no progress: 30 s of driving and turning left the robot within 0.5 m")]
    NoProgress,
    /// The requested final heading cannot be turned to at the goal without exceeding a tilt limit or touching
    /// something upright.
    #[error("turning to the goal's heading would exceed a tilt limit or touch something upright")]
    HeadingUnsafe,
}

/// The outcome of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Status {
    /// Driving to the chosen subgoal.
    Driving,
    /// The goal is within its tolerance.
    Arrived,
    /// Backtracking along its own trajectory: the ground is steeper than predicted, or no path leads on.
    Backtracking,
    /// Spin recovery: no candidate, turning on the spot to search for one, or standing where a turn is not
    /// safe.
    Searching,
    /// Stopped for this reason.
    Stopped(StopReason),
}

/// The result of one step: perception, decision and command.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Step<'a> {
    /// The outcome.
    pub status: Status,
    /// The velocity command.
    pub command: Command,
    /// The kind of each point of the scan, in its order.
    pub return_kinds: &'a [ReturnKind],
    /// The observed occupancy surface.
    pub observed: &'a OccupancySurface,
    /// Diagnostics of the Gaussian process's prediction of the profile.
    pub diagnostics: GpDiagnostics,
    /// The elevation profile.
    pub profile: &'a [Column],
    /// Its segments.
    pub segments: &'a [Segment],
    /// Every subgoal, refused ones included.
    pub subgoals: &'a [Subgoal],
    /// Index of the chosen subgoal.
    pub chosen: Option<usize>,
    /// The path to it, or back, from the robot's position on. Empty in the policy `paper`, which plans none.
    pub path: &'a [PathPoint],
}

/// The plane through the ground around a place seen from above, in the world frame; `None` where it is
/// unknown.
pub type TerrainOverride<'a> = &'a dyn Fn(DVec2) -> Option<Plane>;

/// A perception override: input that replaces what the planner perceives; none by default. Ground truth here
/// tells faults of perception from faults of decision.
#[derive(Clone, Copy, Default)]
pub struct PerceptionOverride<'a> {
    /// The elevation profile at an azimuth in the sensor frame.
    pub profile: Option<&'a dyn Fn(f64) -> Column>,
    /// The ground in place of the elevation window.
    pub terrain: Option<TerrainOverride<'a>>,
}

//! What a step of the planner takes beside the scan, and what it answers.

use glam::DVec2;

use crate::control::controller::Command;
use crate::decision::subgoals::Subgoal;
use crate::gp::jitter::GpError;
use crate::route::state_lattice::PathPoint;
use crate::skyline::occupancy::OccupancySurface;
use crate::skyline::profile::Column;
use crate::skyline::segments::Segment;
use crate::skyline::surface::GpDiagnostics;
use crate::terrain::plane::Plane;

/// Why the planner stands still for good.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StopReason {
    /// The pose or the goal is not a number, or more than 1000 km from the origin.
    #[error("the pose or the goal is not finite or too far away")]
    InvalidInput,
    /// The scan is empty.
    #[error("the scan has no returns")]
    EmptyScan,
    /// The Gaussian process has no posterior.
    #[error("no perception: {0}")]
    NoPerception(GpError),
    /// Looking around found no candidate either.
    #[error("no subgoal found after looking around")]
    NoSubgoal,
    /// A navigator with a map found no path on it.
    #[error("no path to the goal on the map")]
    NoPath,
}

/// What a step decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Status {
    /// Driving to the chosen subgoal.
    Driving,
    /// The goal is within its tolerance.
    Arrived,
    /// Going back the way it came, from ground that is steeper than it had looked or from where nothing leads on.
    Backtracking,
    /// No candidate: turning in place to look.
    Searching,
    /// AttitudeEstimate still, for this reason.
    Stopped(StopReason),
}

/// Everything one step saw and decided.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// What was decided.
    pub status: Status,
    /// The velocity command.
    pub command: Command,
    /// The observed occupancy surface.
    pub observed: &'a OccupancySurface,
    /// What the Gaussian process needed for the profile.
    pub diagnostics: GpDiagnostics,
    /// The elevation profile.
    pub profile: &'a [Column],
    /// Its segments.
    pub segments: &'a [Segment],
    /// Every subgoal, refused ones too.
    pub subgoals: &'a [Subgoal],
    /// Index of the chosen subgoal.
    pub chosen: Option<usize>,
    /// The way to it, or the way back, from where the robot stands; empty where subgoals are judged by the paper's height alone.
    pub path: &'a [PathPoint],
}

/// What a step is told instead of finding it out from scans; nothing by default. With the truth it tells a fault of
/// perception from one of decision.
#[derive(Clone, Copy, Default)]
pub struct PerceptionOverride<'a> {
    /// The elevation profile at an azimuth in the sensor frame.
    pub profile: Option<&'a dyn Fn(f64) -> Column>,
    /// The ground around a place seen from above, in the world; `None` where it is unknown.
    pub ground: Option<&'a dyn Fn(DVec2) -> Option<Plane>>,
}

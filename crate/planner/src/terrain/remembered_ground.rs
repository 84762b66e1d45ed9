//! The ground that the planner remembers, for display: a cell of the elevation window.

use core::time::Duration;

use glam::DVec3;

/// Remembered ground: what the returns of the last scans in a cell of the elevation window say together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RememberedGround {
    /// Mean of its returns, in the world frame, metres.
    pub mean_m: DVec3,
    /// Returns in that mean, counted up to 30: the more there are, the less noise is left in it.
    pub returns: u32,
    /// Time since the last of them, by what the steps were told to have `elapsed`.
    pub age: Duration,
    /// Whether something upright stands here, a wall, a post or a step: the robot keeps away from it, and it
    /// counts as no ground.
    pub is_upright: bool,
}

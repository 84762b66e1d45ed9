//! Commands: the PID controller, and backtracking along the robot's own trajectory.

pub(crate) mod backtrack;
pub mod controller;
pub(crate) mod trajectory_optimiser;

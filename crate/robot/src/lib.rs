//! What stands between a robot's messages and the planner.
//!
//! - [`supervisor`]: decides tick by tick whether the robot may move, limits every command and stops with a
//!   named reason.
//! - [`cloud`]: clouds of any layout as returns with times; sensors that cannot serve.
//! - [`deskew`]: the points of a sweep corrected for the motion during it.
//! - [`estimator`]: the robot's pose from odometry and IMU.
//!
//! The crate does no input or output, reads no clock and starts no thread: messages and times are arguments.
//! It builds natively and for wasm32-unknown-unknown.

pub mod cloud;
pub mod deskew;
pub mod estimator;
pub mod supervisor;

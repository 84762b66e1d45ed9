//! What stands between a robot's messages and the planner.
//!
//! - [`supervisor`]: decides tick by tick whether the robot may move, limits every command and stops with a
//!   named reason.
//! - [`cloud`]: clouds of any layout as returns with times; sensors that cannot serve.
//! - [`deskew`]: the points of a sweep corrected for the motion during it.
//! - [`estimator`]: the robot's pose from odometry and IMU.
//! - [`messages`]: the ROS 2 messages that a robot sends; [`senses`]: what each of them says to planner and
//!   supervisor.
//! - [`navigation`]: which goal is pursued; [`pilot`]: the planner that answers scans on the way to it.
//! - [`drive_config`]: everything that a drive depends on besides its messages.
//!
//! The crate does no input or output, reads no clock and starts no thread: messages and times are arguments.
//! It builds natively and for wasm32-unknown-unknown.

pub mod cloud;
pub mod deskew;
pub mod drive_config;
pub mod estimator;
pub mod frames;
pub mod messages;
pub mod navigation;
pub mod pilot;
pub mod senses;
pub mod supervisor;

/// Bytes in hexadecimal.
fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

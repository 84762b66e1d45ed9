//! The planner as a ROS 2 node that needs no ROS installation.
//!
//! The program `mapless-node` is this crate's only use; `docs/ROBOT.md` says how a robot is brought up with
//! it. Its threads, which meet in a hub of single-slot mailboxes:
//!
//! | thread | does |
//! |---|---|
//! | middleware | takes messages, follows the pose, serves goals, publishes diagnostics |
//! | planner | answers each scan; a panic is a fault |
//! | supervisor | at 50 Hz, and at once when the planner answers; it alone publishes commands |
//! | spin | follows who is on the network |
//! | LiDAR | if the sensor sends packets: puts them together |
//! | recording | writes what the others leave for it, if the file asks for a recording |

mod clock;
pub mod config;
mod diagnostics;
mod elevation;
mod hub;
mod lidar;
mod memory;
pub mod messages;
mod mount;
pub mod navigation;
mod parameters;
mod picture;
mod planning;
mod receiving;
mod recorder;
mod recording;
mod ros;
mod run;
mod senses;
mod service;
mod slot;
mod supervising;
mod surfaces;

pub use lidar::LidarError;
pub use mount::MountError;
pub use ros::RosError;
pub use run::{RunError, run};

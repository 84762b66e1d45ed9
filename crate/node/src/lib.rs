//! The planner as a ROS 2 node that needs no ROS installation.
//!
//! The program `mapless-node` is this crate's only use; `docs/ROBOT.md` says how a robot is brought up with it.

pub mod config;
pub mod messages;

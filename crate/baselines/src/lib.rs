//! What the mapless planner is compared with.
//!
//! Everything here is a pure function of its arguments and gives the same bits natively and on wasm.

// Tests state exact values where the arithmetic is exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

mod follower;
mod oracle;
mod tasks;

pub use follower::PathFollower;
pub use oracle::{OracleConfig, OracleDriver, OracleError, OraclePath, PlanPose, shortest_path};
pub use tasks::{Task, TaskError};

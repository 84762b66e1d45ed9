//! The planners that the mapless planner is compared with.
//!
//! [`NavigatorKind`] names every planner and builds it: this project's own in its configurations, and
//! planners that have the whole map: the paper's baseline ([`vgf`]), plane-fitting RRT* ([`putn`]), driving
//! straight at the goal ([`Straight`]) and the shortest safe path ([`Oracle`]). Generated tasks ([`Task`])
//! are those that the oracle can solve. [`GroundTruthPlanner`] is the mapless planner with ground truth in
//! place of perception.
//!
//! Everything here is a pure function of its arguments and gives the same bits natively and on wasm.

// Tests state exact values where the arithmetic is exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

mod cloud;
mod follower;
mod ground_truth_planner;
mod kind;
mod known_world;
mod oracle;
pub mod putn;
mod route;
mod tasks;
#[cfg(test)]
mod testing;
mod unknown_name;
pub mod vgf;

pub use cloud::{Cloud, MapError};
pub use follower::PathFollower;
pub use ground_truth_planner::{GroundTruthPlanner, Truth};
pub use kind::{BuildError, NavigatorKind};
pub use known_world::KnownWorld;
pub use oracle::{Oracle, OracleConfig, OracleError, OraclePath, PlanPose, shortest_path};
pub use route::{RouteNavigator, RoutePlanner, Straight};
pub use tasks::{NoTaskName, Task, TaskError, TaskName};
pub use unknown_name::UnknownName;

//! What the mapless planner is compared with.
//!
//! [`NavigatorKind`] names every planner and builds it: this project's own in its configurations, and planners that have
//! the whole map: the paper's baseline ([`vgf`]), plane-fitting RRT* ([`putn`]) and driving straight at the goal
//! ([`Straight`]). [`TrueSight`] gives the mapless planner the truth in place of what it perceives.
//!
//! Everything here is a pure function of its arguments and gives the same bits natively and on wasm.

// Tests state exact values where the arithmetic is exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

mod cloud;
mod follower;
mod kind;
pub mod putn;
mod route;
#[cfg(test)]
mod testing;
mod true_sight;
pub mod vgf;

pub use cloud::{Cloud, MapError};
pub use follower::PathFollower;
pub use kind::{BuildError, NavigatorKind, UnknownName};
pub use route::{RouteNavigator, RoutePlanner, Straight};
pub use true_sight::{TrueSight, Truth};

//! The choice of a subgoal and the drive to it: one interface, three policies (`paper`, `forecast`
//! and, in the making, `receding_horizon`), their cost terms and their commitments.

mod candidates;
mod committed_target;
pub mod cost;
mod detour_budget;
pub(crate) mod forecast_policy;
pub(crate) mod goal_progress;
mod observation;
pub(crate) mod paper_policy;
pub(crate) mod policy;
pub(crate) mod receding_horizon_policy;
pub(crate) mod step;
pub mod subgoals;

pub use step::{PerceptionOverride, TerrainOverride};

//! The choice of a subgoal and the drive to it: one interface, two policies (`paper` and `forecast`), their
//! cost terms and their commitments.

mod candidates;
mod committed_target;
pub mod cost;
mod detour_budget;
pub(crate) mod forecast_policy;
pub(crate) mod goal_progress;
pub(crate) mod paper_policy;
pub(crate) mod policy;
pub(crate) mod step;
pub mod subgoals;

pub use step::{PerceptionOverride, TerrainOverride};

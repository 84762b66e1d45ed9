//! The choice of a subgoal and the drive to it: one interface, two policies (`paper`, `forecast`), their cost
//! terms and their commitments.

mod candidates;
mod committed_target;
pub mod cost;
mod detour_budget;
pub(crate) mod forecast_policy;
pub(crate) mod goal_progress;
mod observation;
pub(crate) mod paper_policy;
mod path_following;
pub(crate) mod policy;
pub(crate) mod step;
pub mod subgoals;

pub use step::{PerceptionOverride, TerrainOverride};

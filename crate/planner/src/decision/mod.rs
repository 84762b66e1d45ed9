//! Which subgoal to drive to, and how: the paper's choice and the forecast's behind one interface, their costs, and what holds on to a choice.

mod candidates;
mod committed_target;
pub mod cost;
mod detour_budget;
pub(crate) mod forecast_policy;
pub(crate) mod paper_policy;
pub(crate) mod policy;
pub(crate) mod step;
pub mod subgoals;

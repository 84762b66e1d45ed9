//! Which subgoal to drive to: candidates, their cost, and what holds on to a choice.

pub(crate) mod candidates;
pub(crate) mod committed_target;
pub mod cost;
pub(crate) mod detour_budget;
pub(crate) mod step;
pub mod subgoals;

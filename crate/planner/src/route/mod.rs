//! Paths over the ground: the state lattice, its searches, and what is learned of the cost-to-go.

pub mod forecast;
pub(crate) mod heuristic_table;
mod queue;
pub(crate) mod state_lattice;

pub use state_lattice::PathPoint;

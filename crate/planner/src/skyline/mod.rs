//! From a scan to the skyline: the occupancy surface, the sparse Gaussian process over it, the edge of its
//! variance surface, and the segments of that edge (paper, sections V-A and V-B).

pub(crate) mod beam_gp;
pub mod beam_grid;
pub mod columns;
pub(crate) mod edge_tracer;
pub(crate) mod inducing;
pub mod inspection;
pub mod occupancy;
pub mod perception;
pub mod profile;
pub mod scan_filter;
pub mod segments;
pub mod surface;
pub(crate) mod window_gp;

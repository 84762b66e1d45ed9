//! The ground around the robot: the elevation window, and the robot's attitude on it.

pub(crate) mod attitude;
pub(crate) mod body_clearance;
pub(crate) mod elevation_window;
pub mod headings;
pub mod mount_misfit;
mod place_lattice;
pub mod plane;
pub mod remembered_ground;
pub(crate) mod rolling_grid;
pub(crate) mod slopes;
pub(crate) mod traversability;

//! The ground around the robot: the elevation window, and how the robot would stand on it.

pub(crate) mod attitude;
pub(crate) mod elevation_window;
pub(crate) mod headings;
pub mod plane;
pub(crate) mod slopes;
pub(crate) mod traversability;

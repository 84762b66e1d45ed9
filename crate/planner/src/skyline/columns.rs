//! The columns of the surfaces: one for each degree of azimuth, around the sensor's origin from the robot's x
//! axis.

use core::f64::consts::{PI, TAU};

use crate::math::elementary::floor;

/// Columns of the surfaces, one degree each; column `c` is centred on azimuth -π + c · 1°.
pub const COLUMNS: usize = 360;

pub(crate) const COLUMN_STEP_RAD: f64 = TAU / COLUMNS as f64;

/// Azimuth of the centre of a column, around the sensor's origin from the robot's x axis, in [-π, π).
pub fn column_azimuth_rad(column: usize) -> f64 {
    -PI + COLUMN_STEP_RAD * column as f64
}

/// The column an azimuth falls into.
pub fn column_of(azimuth_rad: f64) -> usize {
    floor((azimuth_rad + PI) / COLUMN_STEP_RAD + 0.5).rem_euclid(COLUMNS as i32) as usize
}

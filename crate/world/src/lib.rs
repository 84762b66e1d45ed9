//! The simulated world of `mapless`: ground, a VLP-16 laser scanner and a Husky robot.
//!
//! World frame: x east, y north, z up, with the origin at the south-west corner of the terrain. Robot frame: x
//! forward, y left, z up. Pitch is positive nose-up, roll positive with the left side up, yaw positive
//! counter-clockwise from east. Lengths are in metres, angles in radians.
//!
//! Everything here is a pure function of its arguments and gives the same bits natively and on wasm: no clock, no
//! threads, no hidden random state.

// Tests state exact values where the arithmetic is exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

mod attitude;
mod caster;
mod height_field;
mod husky;
mod husky_config;
mod level_places;
pub mod noise;
pub mod random;
mod sculpt;
mod sensor_pose;
mod skyline;
mod slopes;
mod vlp16;

pub use attitude::{Attitude, attitude_on, world_from_body};
pub use caster::Caster;
pub use height_field::{
    FieldError, HEIGHT_LIMIT_M, HeightField, MAX_CELL_M, MAX_SAMPLES, MIN_CELL_M, check_grid,
};
pub use husky::{DriveCommand, DriveError, Husky, HuskyState};
pub use husky_config::HuskyConfig;
pub use mapless_parameters::ConfigError;
pub use sculpt::{Brush, BrushKind, SampleRect, smooth_step};
pub use sensor_pose::SensorPose;
pub use skyline::{Skyline, true_skyline};
pub use slopes::SlopeDistribution;
pub use vlp16::{RING_COUNT, Scan, SensorConfig, Vlp16, ring_elevation_rad};

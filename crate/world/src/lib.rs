//! The simulated world of `mapless`: ground, a LiDAR and a wheeled robot.
//!
//! World frame: x east, y north, z up, with the origin at the south-west corner of the terrain. Robot frame:
//! x forward, y left, z up. Pitch is positive nose-up, roll positive with the left side up, yaw positive
//! counter-clockwise from east. Lengths are in metres, angles in radians.
//!
//! Everything here is a pure function of its arguments and gives the same bits natively and on wasm: no
//! clock, no threads, no hidden random state.

// Tests state exact values where the arithmetic is exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

mod attitude;
mod body;
mod caster;
mod ground;
mod height_field;
mod level_places;
mod lidar;
mod motion_config;
pub mod noise;
mod objects;
pub mod random;
mod returns;
mod robot;
mod robot_config;
mod sculpt;
mod sensing_config;
mod sensor_pose;
mod skyline;
mod slip;
mod slopes;
mod sweep;

pub use attitude::{Attitude, attitude_on, world_from_body};
pub use body::{Body, Contact, ContactKind};
pub use caster::Caster;
pub use ground::{Footing, Ground};
pub use height_field::{
    FieldError, HEIGHT_LIMIT_M, HeightField, MAX_CELL_M, MAX_SAMPLES, MIN_CELL_M, check_grid,
};
pub use lidar::{Lidar, Scan, Scene, SensorConfig};
pub use mapless_parameters::ConfigError;
pub use motion_config::MotionConfig;
pub use objects::{Object, Objects, Shape, Solid, Walk};
pub use robot::{DriveCommand, DriveError, Robot, RobotState};
pub use robot_config::RobotConfig;
pub use sculpt::{Brush, BrushKind, SampleRect, smooth_step};
pub use sensing_config::{MotionCompensation, SensingConfig};
pub use sensor_pose::SensorPose;
pub use skyline::{Skyline, true_skyline};
pub use slopes::SlopeDistribution;
pub use sweep::compensate;

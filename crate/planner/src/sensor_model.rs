//! The LiDAR as data: its rings, its field of view, and where it sits on the robot.

use core::f64::consts::{PI, TAU};

use glam::DVec3;

/// A multi-beam LiDAR and its mount. The default is a Velodyne VLP-16, 0.8 m above the ground.
///
/// The sensor frame has x forward, y left and z up along the sensor's axis; it is turned from the robot frame by yaw, then pitch
/// (nose-up positive), then roll. The planner takes points in the sensor frame, in any order: of the rings it needs to know no more than
/// how many there are and where the lowest and the highest one look.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct SensorModel {
    /// Rings, at least 2.
    pub rings: usize,
    /// Elevation of the lowest ring above the sensor's x-y plane, radians; negative when it looks down.
    pub lowest_elevation_rad: f64,
    /// Elevation of the highest ring, radians.
    pub highest_elevation_rad: f64,
    /// Directions around the sensor's axis in which each ring measures, for a full turn.
    pub columns: usize,
    /// Horizontal field of view, radians, half of it to each side of the sensor's x axis; 2π for a spinning sensor.
    pub horizontal_fov_rad: f64,
    /// Nothing nearer is measured, metres.
    pub min_range_m: f64,
    /// Nothing farther is measured, metres.
    pub max_range_m: f64,
    /// Forward of the point on the ground between the wheels, metres.
    pub forward_m: f64,
    /// To the left of it, metres.
    pub left_m: f64,
    /// Above the ground that the robot stands on, along the body's z axis, metres.
    pub height_m: f64,
    /// Roll of the mount, left side up positive, radians; π for a sensor upside down.
    pub roll_rad: f64,
    /// Pitch of the mount, nose-up positive, radians.
    pub pitch_rad: f64,
    /// Yaw of the mount, anticlockwise positive, radians.
    pub yaw_rad: f64,
}

impl SensorModel {
    /// Velodyne VLP-16 at 10 Hz, level, 0.8 m above the ground.
    pub fn vlp16() -> Self {
        Self {
            rings: 16,
            lowest_elevation_rad: -15.0 * (PI / 180.0),
            highest_elevation_rad: 15.0 * (PI / 180.0),
            columns: 1800,
            horizontal_fov_rad: TAU,
            min_range_m: 0.5,
            max_range_m: 100.0,
            forward_m: 0.0,
            left_m: 0.0,
            height_m: 0.8,
            roll_rad: 0.0,
            pitch_rad: 0.0,
            yaw_rad: 0.0,
        }
    }

    /// The sensor's origin in the robot frame.
    pub fn offset_m(&self) -> DVec3 {
        DVec3::new(self.forward_m, self.left_m, self.height_m)
    }
}

impl Default for SensorModel {
    fn default() -> Self {
        Self::vlp16()
    }
}

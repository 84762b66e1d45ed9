//! The LiDAR as data: its rings, its field of view, and where it sits on the robot.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use mapless_parameters::{ConfigError, parameters};

parameters! {
    /// A multi-beam LiDAR and its mount. The default is a Velodyne VLP-16, 0.8 m above the ground.
    ///
    /// The sensor frame has x forward, y left and z up along the sensor's axis; it is turned from the robot frame by yaw, then
    /// pitch (nose-up positive), then roll. The planner takes points in the sensor frame, in any order: of the rings it needs to
    /// know no more than how many there are and where the lowest and the highest one look.
    #[derive(Copy)]
    #[non_exhaustive]
    pub struct SensorModel {
        /// Rings of the sensor, each at one elevation.
        rings: usize = 16, range [2, 128], check AtLeast(2.0);
        /// Elevation of the lowest ring above the sensor's x-y plane; negative when it looks down.
        lowest_elevation_rad: f64 = -15.0 * (PI / 180.0), unit "rad", range [-1.5, 0.2], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Elevation of the highest ring.
        highest_elevation_rad: f64 = 15.0 * (PI / 180.0), unit "rad", range [-0.2, 1.5], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Directions around the sensor's axis in which each ring measures, for a full turn. The skyline has a column a degree.
        columns: usize = 1800, range [360, 4096], check AtLeast(360.0);
        /// Horizontal field of view, half of it to each side of the sensor's x axis; 2π for a spinning sensor.
        horizontal_fov_rad: f64 = TAU, unit "rad", range [0.5, TAU], check UpTo(TAU);
        /// Nothing nearer is measured.
        min_range_m: f64 = 0.5, unit "m", range [0.0, 5.0], check NotNegative;
        /// Nothing farther is measured.
        max_range_m: f64 = 100.0, unit "m", range [5.0, 300.0], check Positive;
        /// How far the sensor sits forward of the point on the ground between the wheels.
        forward_m: f64 = 0.0, unit "m", range [-1.0, 1.0], check Finite;
        /// How far it sits to the left of that point.
        left_m: f64 = 0.0, unit "m", range [-1.0, 1.0], check Finite;
        /// Height above the ground that the robot stands on, along the body's z axis.
        height_m: f64 = 0.8, unit "m", range [0.2, 3.0], check Positive;
        /// Roll of the mount, left side up positive; π for a sensor upside down.
        roll_rad: f64 = 0.0, unit "rad", range [-PI, PI], check Within(-PI, PI);
        /// Pitch of the mount, nose-up positive.
        pitch_rad: f64 = 0.0, unit "rad", range [-1.5, 1.5], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Yaw of the mount, anticlockwise positive.
        yaw_rad: f64 = 0.0, unit "rad", range [-PI, PI], check Within(-PI, PI);
    }
    relations check_order;
}

impl SensorModel {
    /// Velodyne VLP-16 at 10 Hz, level, 0.8 m above the ground.
    pub fn vlp16() -> Self {
        Self::default()
    }

    /// The sensor's origin in the robot frame.
    pub fn offset_m(&self) -> DVec3 {
        DVec3::new(self.forward_m, self.left_m, self.height_m)
    }

    fn check_order(&self, place: &str) -> Result<(), ConfigError> {
        let rises = self.lowest_elevation_rad < self.highest_elevation_rad;
        let value = self.lowest_elevation_rad;
        ConfigError::require(rises, place, "lowest_elevation_rad", value, "less than highest_elevation_rad")?;
        let grows = self.min_range_m < self.max_range_m;
        ConfigError::require(grows, place, "min_range_m", self.min_range_m, "less than max_range_m")
    }
}

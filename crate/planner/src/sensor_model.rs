//! The LiDAR model: rings, field of view, range and mount.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DVec3};
use mapless_parameters::{ConfigError, parameters};

parameters! {
    /// A multi-beam LiDAR and its mount. The default is a Velodyne VLP-16, 0.8 m above the ground.
    ///
    /// The sensor frame has x forward, y left and z up along the sensor's axis; it is turned from the robot
    /// frame by yaw, then pitch (nose-up positive), then roll. The planner takes points in the sensor frame,
    /// in any order: of the rings it uses only their number and the lowest and the highest elevation.
    #[derive(Copy)]
    #[non_exhaustive]
    pub struct SensorModel {
        /// Rings of the sensor, each at one elevation.
        rings: usize = 16, range [2, 128], check AtLeast(2.0);
        /// Elevation of the lowest ring above the sensor's x-y plane; negative when it looks down.
        lowest_elevation_rad: f64 = -15.0 * (PI / 180.0), unit "rad", range [-1.5, 0.2], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Elevation of the highest ring.
        highest_elevation_rad: f64 = 15.0 * (PI / 180.0), unit "rad", range [-0.2, 1.5], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Azimuths at which each ring measures, for a full turn. The skyline has a column for each degree.
        columns: usize = 1800, range [90, 4096], check AtLeast(1.0);
        /// Horizontal field of view, half of it to each side of the sensor's x axis; 2π for a spinning
        /// sensor.
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

    /// The rotation from the sensor frame to the robot frame; `None` if their axes are the same.
    pub fn robot_from_sensor(&self) -> Option<DMat3> {
        if [self.roll_rad, self.pitch_rad, self.yaw_rad].iter().all(|&angle| angle == 0.0) {
            return None;
        }
        let (sin_yaw, cos_yaw) = libm::sincos(self.yaw_rad);
        let (sin_pitch, cos_pitch) = libm::sincos(self.pitch_rad);
        let (sin_roll, cos_roll) = libm::sincos(self.roll_rad);
        let turned =
            |x: f64, y: f64, z: f64| DVec3::new(x * cos_yaw - y * sin_yaw, x * sin_yaw + y * cos_yaw, z);
        Some(DMat3::from_cols(
            turned(cos_pitch, 0.0, sin_pitch),
            turned(-sin_pitch * sin_roll, cos_roll, cos_pitch * sin_roll),
            turned(-sin_pitch * cos_roll, -sin_roll, cos_pitch * cos_roll),
        ))
    }

    /// Whether a unit vector in the sensor frame is in the field of view, vertical and horizontal, or outside
    /// by at most `slack_rad`.
    pub(crate) fn has_in_view(&self, beam: DVec3, slack_rad: f64) -> bool {
        let elevation = libm::asin(beam.z.clamp(-1.0, 1.0));
        let azimuth = libm::atan2(beam.y, beam.x);
        elevation >= self.lowest_elevation_rad - slack_rad
            && elevation <= self.highest_elevation_rad + slack_rad
            && azimuth.abs() <= 0.5 * self.horizontal_fov_rad + slack_rad
    }

    fn check_order(&self, place: &str) -> Result<(), ConfigError> {
        let rises = self.lowest_elevation_rad < self.highest_elevation_rad;
        let value = self.lowest_elevation_rad;
        ConfigError::require(rises, place, "lowest_elevation_rad", value, "less than highest_elevation_rad")?;
        let grows = self.min_range_m < self.max_range_m;
        ConfigError::require(grows, place, "min_range_m", self.min_range_m, "less than max_range_m")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::Pose;

    #[test]
    fn a_mount_turns_as_a_pose_does() {
        let mount = SensorModel { roll_rad: 0.3, pitch_rad: -0.7, yaw_rad: 2.0, ..SensorModel::vlp16() };
        let pose = Pose { position_m: DVec3::ZERO, roll_rad: 0.3, pitch_rad: -0.7, yaw_rad: 2.0 };
        let difference = mount.robot_from_sensor().unwrap() - pose.world_from_robot();
        assert!(difference.to_cols_array().iter().all(|entry| entry.abs() < 1e-15));
        assert_eq!(SensorModel::vlp16().robot_from_sensor(), None);
    }

    #[test]
    fn the_view_is_between_the_rings_and_within_the_field() {
        let sensor = SensorModel { horizontal_fov_rad: 2.0, ..SensorModel::vlp16() };
        let beam = |azimuth: f64, elevation: f64| {
            let ((sin_a, cos_a), (sin_e, cos_e)) = (libm::sincos(azimuth), libm::sincos(elevation));
            DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e)
        };
        assert!(sensor.has_in_view(beam(0.9, -0.25), 0.0) && sensor.has_in_view(beam(-0.9, 0.25), 0.0));
        assert!(!sensor.has_in_view(beam(1.1, 0.0), 0.0) && !sensor.has_in_view(beam(0.0, -0.3), 0.0));
        assert!(
            sensor.has_in_view(beam(1.1, 0.0), 0.2) && !SensorModel::vlp16().has_in_view(beam(3.0, 0.3), 0.0)
        );
    }
}

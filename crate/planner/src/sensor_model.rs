//! The LiDAR as data: its rings, its field of view, and where it sits on the robot.

use core::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

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

    /// The rotation from the sensor frame to the robot frame; `None` where their axes are the same.
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

    /// Whether a unit vector in the sensor frame is between the lowest and the highest ring and inside the horizontal field of view, or
    /// outside by no more than a slack.
    pub(crate) fn has_in_view(&self, beam: DVec3, slack_rad: f64) -> bool {
        let elevation = libm::asin(beam.z.clamp(-1.0, 1.0));
        let azimuth = libm::atan2(beam.y, beam.x);
        elevation >= self.lowest_elevation_rad - slack_rad
            && elevation <= self.highest_elevation_rad + slack_rad
            && azimuth.abs() <= 0.5 * self.horizontal_fov_rad + slack_rad
    }
}

impl Default for SensorModel {
    fn default() -> Self {
        Self::vlp16()
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

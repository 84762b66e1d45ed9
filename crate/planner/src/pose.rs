//! Frames: where the robot stands and how to get from its frame to the world's.
//!
//! The world frame W is x east, y north, z up. The robot frame R has its origin on the ground between the wheels, x
//! forward, y left, z up along the body. The sensor frame is R moved by the sensor's mount.

use glam::{DMat3, DVec2, DVec3};

/// Position and attitude of the robot frame in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Origin of the robot frame in the world frame, metres.
    pub position_m: DVec3,
    /// Rotation about the robot's forward axis, positive when its left side is up.
    pub roll_rad: f64,
    /// Nose-up positive.
    pub pitch_rad: f64,
    /// Heading, anticlockwise from the world's x axis.
    pub yaw_rad: f64,
}

impl Pose {
    /// Rotation from the robot frame to the world frame: yaw, then pitch, then roll.
    pub fn world_from_robot(&self) -> DMat3 {
        let (sin_yaw, cos_yaw) = libm::sincos(self.yaw_rad);
        let (sin_pitch, cos_pitch) = libm::sincos(self.pitch_rad);
        let (sin_roll, cos_roll) = libm::sincos(self.roll_rad);
        let yaw =
            DMat3::from_cols(DVec3::new(cos_yaw, sin_yaw, 0.0), DVec3::new(-sin_yaw, cos_yaw, 0.0), DVec3::Z);
        let pitch = DMat3::from_cols(
            DVec3::new(cos_pitch, 0.0, sin_pitch),
            DVec3::Y,
            DVec3::new(-sin_pitch, 0.0, cos_pitch),
        );
        let roll = DMat3::from_cols(
            DVec3::X,
            DVec3::new(0.0, cos_roll, sin_roll),
            DVec3::new(0.0, -sin_roll, cos_roll),
        );
        yaw * pitch * roll
    }

    /// The position seen from above.
    pub fn plan_m(&self) -> DVec2 {
        self.position_m.truncate()
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.position_m.is_finite()
            && self.roll_rad.is_finite()
            && self.pitch_rad.is_finite()
            && self.yaw_rad.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::FRAC_PI_2;

    #[test]
    fn pitch_lifts_the_nose_and_roll_lifts_the_left_side() {
        let level = Pose { position_m: DVec3::ZERO, roll_rad: 0.0, pitch_rad: 0.0, yaw_rad: 0.0 };
        assert!(Pose { pitch_rad: 0.3, ..level }.world_from_robot().x_axis.z > 0.29);
        assert!(Pose { roll_rad: 0.3, ..level }.world_from_robot().y_axis.z > 0.29);
        let north = Pose { yaw_rad: FRAC_PI_2, ..level }.world_from_robot();
        assert!((north * DVec3::X - DVec3::Y).length() < 1e-15);
    }

    #[test]
    fn the_rotation_is_orthonormal_and_right_handed() {
        let pose = Pose { position_m: DVec3::ZERO, roll_rad: 0.3, pitch_rad: -0.7, yaw_rad: 2.0 };
        let rotation = pose.world_from_robot();
        let error = rotation * rotation.transpose() - DMat3::IDENTITY;
        assert!(error.to_cols_array().iter().all(|e| e.abs() < 1e-15));
        assert!((rotation.determinant() - 1.0).abs() < 1e-15);
    }
}

//! Frames, and the robot's pose.
//!
//! The world frame W is x east, y north, z up. The robot frame R has its origin on the ground between the
//! wheels, x forward, y left, z up along the body. The sensor frame is R moved and turned by the sensor's
//! mount ([`SensorModel`](crate::SensorModel)).

use glam::{DMat3, DQuat, DVec2, DVec3};

/// Position and attitude of the robot frame in the world frame.
///
/// **Pitch is nose-up positive here.** ROS (REP 103, <https://www.ros.org/reps/rep-0103.html>) turns about
/// the left axis by the right-hand rule, so there nose-down is positive: use [`Pose::from_quaternion`], which
/// has no such ambiguity, or [`Pose::from_ros_rpy`]. The origin is on the ground between the wheels, not at
/// `base_link`: use [`Pose::moved`] for a pose of another point of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pose {
    /// Origin of the robot frame in the world frame, metres.
    pub position_m: DVec3,
    /// Rotation about the robot's forward axis, positive when its left side is up, radians.
    pub roll_rad: f64,
    /// Elevation of the robot's forward axis: nose-up positive, radians.
    pub pitch_rad: f64,
    /// Heading, anticlockwise from the world's x axis, radians.
    pub yaw_rad: f64,
}

impl Pose {
    /// From a rotation that takes vectors of the robot frame to the world frame, as in ROS messages. It need
    /// not be of unit length. A rotation of zero length or with a number that is not finite makes a pose that
    /// is not finite, which the planner answers with a stop.
    pub fn from_quaternion(position_m: DVec3, world_from_robot: DQuat) -> Self {
        let rotation = DMat3::from_quat(world_from_robot * (1.0 / world_from_robot.length()));
        let (ahead, left, up) = (rotation.x_axis, rotation.y_axis, rotation.z_axis);
        Self {
            position_m,
            roll_rad: libm::atan2(left.z, up.z),
            pitch_rad: libm::asin(ahead.z.clamp(-1.0, 1.0)),
            yaw_rad: libm::atan2(ahead.y, ahead.x),
        }
    }

    /// From roll, pitch and yaw in radians with pitch **nose-up** positive, turned by yaw, then pitch, then
    /// roll.
    pub const fn from_roll_pitch_yaw(
        position_m: DVec3,
        roll_rad: f64,
        pitch_up_rad: f64,
        yaw_rad: f64,
    ) -> Self {
        Self { position_m, roll_rad, pitch_rad: pitch_up_rad, yaw_rad }
    }

    /// From roll, pitch and yaw in radians in ROS's convention (REP 103, `tf` "RPY"): pitch **nose-down**
    /// positive.
    pub const fn from_ros_rpy(position_m: DVec3, roll_rad: f64, pitch_down_rad: f64, yaw_rad: f64) -> Self {
        Self { position_m, roll_rad, pitch_rad: -pitch_down_rad, yaw_rad }
    }

    /// The pose of a frame with the same axes whose origin lies at `offset_m` in this one. Called on the pose
    /// of `base_link`, with the offset from there down to the ground between the wheels, it gives the pose
    /// that the planner takes.
    #[must_use]
    pub fn moved(&self, offset_m: DVec3) -> Self {
        Self { position_m: self.position_m + self.world_from_robot() * offset_m, ..*self }
    }

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

/// The change from one world frame to another: a turn about z, then a shift.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameChange {
    turn_rad: f64,
    /// (cos, sin) of the turn.
    turn: DVec2,
    shift_m: DVec3,
}

impl FrameChange {
    /// The change that takes one pose to another.
    pub(crate) fn between(before: &Pose, after: &Pose) -> Self {
        let turn_rad = after.yaw_rad - before.yaw_rad;
        let (sin, cos) = libm::sincos(turn_rad);
        let turn = DVec2::new(cos, sin);
        let turned_m = turn.rotate(before.plan_m()).extend(before.position_m.z);
        Self { turn_rad, turn, shift_m: after.position_m - turned_m }
    }

    /// The turn of headings, radians.
    pub(crate) fn turn_rad(&self) -> f64 {
        self.turn_rad
    }

    /// A point in the new frame.
    pub(crate) fn point_m(&self, point_m: DVec3) -> DVec3 {
        self.vector(point_m) + self.shift_m
    }

    /// A place, seen from above, in the new frame.
    pub(crate) fn place_m(&self, place_m: DVec2) -> DVec2 {
        self.turn.rotate(place_m) + self.shift_m.truncate()
    }

    /// A rotation into the old frame as one into the new.
    pub(crate) fn rotation(&self, rotation: &DMat3) -> DMat3 {
        DMat3::from_cols(
            self.vector(rotation.x_axis),
            self.vector(rotation.y_axis),
            self.vector(rotation.z_axis),
        )
    }

    /// A vector in the new frame.
    pub(crate) fn vector(&self, vector: DVec3) -> DVec3 {
        self.turn.rotate(vector.truncate()).extend(vector.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::FRAC_PI_2;
    use proptest::prelude::*;

    #[test]
    fn pitch_lifts_the_nose_and_roll_lifts_the_left_side() {
        let level = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0);
        assert!(Pose { pitch_rad: 0.3, ..level }.world_from_robot().x_axis.z > 0.29);
        assert!(Pose { roll_rad: 0.3, ..level }.world_from_robot().y_axis.z > 0.29);
        let north = Pose { yaw_rad: FRAC_PI_2, ..level }.world_from_robot();
        assert!((north * DVec3::X - DVec3::Y).length() < 1e-15);
    }

    #[test]
    fn the_rotation_is_orthonormal_and_right_handed() {
        let rotation = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.3, -0.7, 2.0).world_from_robot();
        let error = rotation * rotation.transpose() - DMat3::IDENTITY;
        assert!(error.to_cols_array().iter().all(|e| e.abs() < 1e-15));
        assert!((rotation.determinant() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_turn_about_the_left_axis_puts_the_nose_down_as_in_ros() {
        let quaternion = Pose::from_quaternion(DVec3::ZERO, DQuat::from_rotation_y(0.2));
        let angles = Pose::from_ros_rpy(DVec3::ZERO, 0.0, 0.2, 0.0);
        assert!((quaternion.pitch_rad + 0.2).abs() < 1e-15 && (angles.pitch_rad + 0.2).abs() < 1e-15);
    }

    #[test]
    fn a_quaternion_that_is_none_gives_a_pose_that_is_not_finite() {
        for broken in [DQuat::from_array([0.0; 4]), DQuat::from_array([f64::NAN, 0.0, 0.0, 1.0])] {
            assert!(!Pose::from_quaternion(DVec3::ZERO, broken).is_finite());
        }
    }

    #[test]
    fn a_pose_is_moved_along_its_own_axes() {
        let base_link = Pose::from_roll_pitch_yaw(DVec3::new(1.0, 2.0, 3.0), 0.0, FRAC_PI_2, 0.0);
        let moved = base_link.moved(DVec3::new(0.0, 0.0, -0.5));
        assert!((moved.position_m - DVec3::new(1.5, 2.0, 3.0)).length() < 1e-15, "its z axis points back");
    }

    proptest! {
        #[test]
        fn a_quaternion_of_any_length_turns_as_the_angles_do(
            roll in -3.0..3.0_f64, pitch in -1.5..1.5_f64, yaw in -3.1..3.1_f64, length in 0.1..10.0_f64,
        ) {
            let pose = Pose::from_roll_pitch_yaw(DVec3::ONE, roll, pitch, yaw);
            let quaternion = DQuat::from_mat3(&pose.world_from_robot());
            let found = Pose::from_quaternion(DVec3::ONE, quaternion * length);
            let error = found.world_from_robot() - pose.world_from_robot();
            prop_assert!(error.to_cols_array().iter().all(|e| e.abs() < 1e-9));
        }
    }
}

//! Between the odometry's frame and the estimator's. The two part as odometry drifts or jumps; what lies to
//! the robot in one lies so in the other.

use mapless::Pose;
use mapless::glam::{DVec2, DVec3};

/// The change from one frame to another, by the robot's pose in both.
#[derive(Clone, Copy, Debug)]
pub struct FrameChange {
    from: Pose,
    to: Pose,
}

impl FrameChange {
    /// The change that takes a robot at `from` in one frame to `to` in the other.
    #[must_use]
    pub fn new(from: Pose, to: Pose) -> Self {
        Self { from, to }
    }

    fn turn_rad(&self) -> f64 {
        self.to.yaw_rad - self.from.yaw_rad
    }

    /// A heading, radians.
    #[must_use]
    pub fn heading_rad(&self, heading_rad: f64) -> f64 {
        heading_rad + self.turn_rad()
    }

    /// A place seen from above, metres.
    #[must_use]
    pub fn place_m(&self, place_m: DVec2) -> DVec2 {
        let (sin, cos) = libm::sincos(self.turn_rad());
        self.to.plan_m() + DVec2::new(cos, sin).rotate(place_m - self.from.plan_m())
    }

    /// A point, metres.
    #[must_use]
    pub fn point_m(&self, point_m: DVec3) -> DVec3 {
        let up_m = point_m.z - self.from.position_m.z;
        self.place_m(point_m.truncate()).extend(self.to.position_m.z + up_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::FRAC_PI_2;

    #[test]
    fn what_lies_to_the_robot_in_one_frame_lies_so_in_the_other() {
        let pose = |x, y, z, yaw| Pose::from_roll_pitch_yaw(DVec3::new(x, y, z), 0.0, 0.0, yaw);
        let change = FrameChange::new(pose(5.0, 1.0, 0.2, 0.0), pose(0.0, 0.0, 3.0, FRAC_PI_2));
        // Two metres ahead of the robot, one to its left and half a metre up.
        let moved = change.point_m(DVec3::new(7.0, 2.0, 0.7));
        assert!((moved - DVec3::new(-1.0, 2.0, 3.5)).length() < 1e-12);
        assert!((change.heading_rad(0.0) - FRAC_PI_2).abs() < 1e-12);
    }
}

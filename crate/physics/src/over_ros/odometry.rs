//! The odometry of a Clearpath A200: its filter runs in two-dimensional mode and takes the wheels alone.

use mapless_node::messages::{Header, Odometry, Quaternion, Time};
use mapless_world::DriveCommand;

/// Variances of x, y, z, roll, pitch and yaw. robot_localization gives 1e-6 to what it holds at zero, so it
/// looks as if height and tilt were known best.
const VARIANCES: [f64; 6] = [1e-2, 1e-2, 1e-6, 1e-6, 1e-6, 1e-2];

/// A position and heading summed up from the wheels' speeds; height and tilt are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WheelOdometry {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) yaw_rad: f64,
    wheels: DriveCommand,
}

impl WheelOdometry {
    /// The wheels have come to these speeds in `dt_s`.
    pub(crate) fn turn(&mut self, wheels: DriveCommand, dt_s: f64) {
        let mean = |before: f64, after: f64| 0.5 * (before + after) * dt_s;
        let way_m = mean(self.wheels.speed_m_s, wheels.speed_m_s);
        let turn_rad = mean(self.wheels.turn_rate_rad_s, wheels.turn_rate_rad_s);
        let (sin, cos) = libm::sincos(self.yaw_rad + 0.5 * turn_rad);
        self.x_m += way_m * cos;
        self.y_m += way_m * sin;
        self.yaw_rad += turn_rad;
        self.wheels = wheels;
    }

    /// What is published of it.
    pub(crate) fn message(&self, stamp: Time) -> Odometry {
        let header = Header { stamp, frame_id: "odom".to_owned() };
        let mut message = Odometry { header, child_frame_id: "base_link".to_owned(), ..Odometry::default() };
        (message.pose.pose.position.x, message.pose.pose.position.y) = (self.x_m, self.y_m);
        message.pose.pose.orientation = Quaternion::from_yaw(self.yaw_rad);
        for (axis, variance) in VARIANCES.into_iter().enumerate() {
            message.pose.covariance[axis][axis] = variance;
        }
        message.twist.twist.linear.x = self.wheels.speed_m_s;
        message.twist.twist.angular.z = self.wheels.turn_rate_rad_s;
        message
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_of_the_wheels_closes_and_knows_no_height() {
        let mut odometry = WheelOdometry::default();
        let wheels = DriveCommand { speed_m_s: 0.5, turn_rate_rad_s: 0.4 };
        odometry.turn(wheels, 0.0);
        let steps = 1000;
        let turn_s = std::f64::consts::TAU / 0.4;
        for _ in 0..steps {
            odometry.turn(wheels, turn_s / f64::from(steps));
        }
        assert!(odometry.x_m.abs() < 1e-9 && odometry.y_m.abs() < 1e-9, "{odometry:?}");
        for _ in 0..steps / 4 {
            odometry.turn(wheels, turn_s / f64::from(steps));
        }
        assert!((odometry.x_m - 1.25).abs() < 1e-4 && (odometry.y_m - 1.25).abs() < 1e-4, "{odometry:?}");
        let message = odometry.message(Time::default());
        assert_eq!((message.pose.pose.position.z, message.pose.pose.orientation.x), (0.0, 0.0));
        assert_eq!((message.twist.twist.linear.x, message.twist.twist.angular.z), (0.5, 0.4));
    }
}

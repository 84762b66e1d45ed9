//! How far odometry and the node's estimate are from where the robot truly is.

use std::time::Duration;

use glam::DVec2;
use mapless::Pose;
use mapless::math::angle::difference_rad;
use mapless_node::messages::{Imu, Odometry};
use mapless_robot::drive_config::DriveConfig;
use mapless_robot::senses::{Arrival, Senses};

use super::odometry::WheelOdometry;

/// The truth beside the node's own estimator, which takes the same messages here as in the node. What arrives
/// there a moment later makes them differ a little.
pub(crate) struct Drift {
    senses: Senses,
    believed: Option<Pose>,
    /// Where odometry begins, in the world.
    begin: Pose,
    truth: Pose,
}

/// A difference of poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Off {
    /// Seen from above.
    pub(crate) plan_m: f64,
    pub(crate) yaw_rad: f64,
}

impl Drift {
    /// Of a robot at rest.
    pub(crate) fn new(config: &DriveConfig, rest: Pose) -> anyhow::Result<Self> {
        Ok(Self { senses: config.senses()?, believed: None, begin: rest, truth: rest })
    }

    /// A place of the world in the odometry's frame.
    pub(crate) fn in_odometry(&self, place_m: DVec2) -> DVec2 {
        let (sin, cos) = libm::sincos(-self.begin.yaw_rad);
        DVec2::new(cos, sin).rotate(place_m - self.begin.plan_m())
    }

    /// The IMU is told.
    pub(crate) fn take_imu(&mut self, imu: &Imu) {
        self.senses.take_imu(arrival(imu.header.stamp.nanoseconds()), imu);
    }

    /// Odometry is told.
    pub(crate) fn take_odometry(&mut self, odometry: &Odometry) {
        let heard = self.senses.take_odometry(arrival(odometry.header.stamp.nanoseconds()), odometry);
        if let Some([believed, _]) = heard.poses {
            self.believed = Some(believed);
        }
    }

    /// The robot is there.
    pub(crate) fn move_to(&mut self, truth: Pose) {
        self.truth = truth;
    }

    /// From the estimate to a place in the odometry's frame, seen from above.
    pub(crate) fn distance_m(&self, place_m: DVec2) -> f64 {
        self.believed.map_or(f64::NAN, |believed| believed.plan_m().distance(place_m))
    }

    /// How far off odometry and the estimate are.
    pub(crate) fn off(&self, odometry: &WheelOdometry) -> [Off; 2] {
        let (plan_m, yaw_rad) =
            (self.in_odometry(self.truth.plan_m()), self.truth.yaw_rad - self.begin.yaw_rad);
        let off = |told_m: DVec2, told_rad: f64| Off {
            plan_m: told_m.distance(plan_m),
            yaw_rad: difference_rad(told_rad, yaw_rad),
        };
        let believed = self.believed.unwrap_or(self.begin);
        [
            off(DVec2::new(odometry.x_m, odometry.y_m), odometry.yaw_rad),
            off(believed.plan_m(), believed.yaw_rad),
        ]
    }
}

fn arrival(clock_ns: i64) -> Arrival {
    Arrival { at: Duration::from_nanos(u64::try_from(clock_ns).unwrap_or(0)), clock_ns }
}

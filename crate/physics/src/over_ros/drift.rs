//! How far odometry and the node's estimate are from where the robot truly is.

use std::time::Duration;

use glam::DVec2;
use mapless::Pose;
use mapless::math::angle::difference_rad;
use mapless_node::messages::{Imu, Odometry, Time};
use mapless_robot::drive_config::DriveConfig;
use mapless_robot::senses::{Arrival, Senses};

use super::odometry::WheelOdometry;

/// The truth beside the node's own estimator, which takes the same messages here as in the node. What arrives
/// there a moment later makes them differ a little.
pub(crate) struct Drift {
    senses: Senses,
    /// What it believed at each odometry, by the simulation's clock in nanoseconds.
    believed: Vec<(i64, Pose)>,
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
        Ok(Self { senses: config.senses()?, believed: Vec::new(), begin: rest, truth: rest })
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
        let clock_ns = odometry.header.stamp.nanoseconds();
        if let Some([believed, _]) = self.senses.take_odometry(arrival(clock_ns), odometry).poses {
            self.believed.push((clock_ns, believed));
        }
    }

    /// The robot is there.
    pub(crate) fn move_to(&mut self, truth: Pose) {
        self.truth = truth;
    }

    /// From the estimate of some time to a place in the odometry's frame, seen from above; `None` before it
    /// began.
    pub(crate) fn distance_m(&self, place_m: DVec2, stamp: Time) -> Option<f64> {
        let before = self.believed.partition_point(|(clock_ns, _)| *clock_ns <= stamp.nanoseconds());
        let (_, believed) = self.believed.get(before.checked_sub(1)?)?;
        Some(believed.plan_m().distance(place_m))
    }

    /// How far off odometry and the estimate are.
    pub(crate) fn off(&self, odometry: &WheelOdometry) -> [Off; 2] {
        let (plan_m, yaw_rad) =
            (self.in_odometry(self.truth.plan_m()), self.truth.yaw_rad - self.begin.yaw_rad);
        let off = |told_m: DVec2, told_rad: f64| Off {
            plan_m: told_m.distance(plan_m),
            yaw_rad: difference_rad(told_rad, yaw_rad),
        };
        let believed = self.believed.last().map_or(self.begin, |(_, believed)| *believed);
        [
            off(DVec2::new(odometry.x_m, odometry.y_m), odometry.yaw_rad),
            off(believed.plan_m(), believed.yaw_rad),
        ]
    }
}

fn arrival(clock_ns: i64) -> Arrival {
    Arrival { at: Duration::from_nanos(u64::try_from(clock_ns).unwrap_or(0)), clock_ns }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_ros::imu::ImuModel;
    use mapless_world::DriveCommand;

    #[test]
    fn wheels_that_slip_are_off_by_it_and_the_estimate_is_kept_by_its_time() {
        let at = |x_m: f64| {
            let turned = DVec2::from_angle(0.5) * x_m;
            Pose::from_roll_pitch_yaw(turned.extend(3.0), 0.0, 0.0, 0.5)
        };
        let mut drift = Drift::new(&DriveConfig::default(), at(0.0)).unwrap();
        let (mut odometry, mut imu) = (WheelOdometry::default(), ImuModel::new(1, at(0.0)));
        odometry.turn(DriveCommand { speed_m_s: 1.0, turn_rate_rad_s: 0.0 }, 0.0);
        // The wheels turn a quarter farther than the robot comes.
        for step in 1..=100 {
            let stamp = Time::from_nanoseconds(10_000_000 * i64::from(step));
            let truth = at(0.008 * f64::from(step));
            drift.take_imu(&imu.measure(truth, 0.01, stamp));
            odometry.turn(DriveCommand { speed_m_s: 1.0, turn_rate_rad_s: 0.0 }, 0.01);
            drift.take_odometry(&odometry.message(stamp));
            drift.move_to(truth);
        }
        let goal_m = drift.in_odometry(at(2.0).plan_m());
        assert!((goal_m - DVec2::new(2.0, 0.0)).length() < 1e-12, "{goal_m}");
        let [told, believed] = drift.off(&odometry);
        assert!((told.plan_m - 0.2).abs() < 1e-9 && told.yaw_rad.abs() < 1e-9, "{told:?}");
        assert!((believed.plan_m - 0.2).abs() < 0.03 && believed.yaw_rad.abs() < 0.02, "{believed:?}");
        let distance_m = |ms: i64| drift.distance_m(goal_m, Time::from_nanoseconds(ms * 1_000_000));
        assert_eq!(distance_m(5), None);
        assert!((distance_m(505).unwrap() - 1.5).abs() < 0.03);
    }
}

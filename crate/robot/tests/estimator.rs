//! The estimator on drives over hills whose true poses are known.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use core::f64::consts::TAU;
use core::time::Duration;

use mapless::Pose;
use mapless::glam::{DQuat, DVec2, DVec3};
use mapless_robot::estimator::{Estimator, EstimatorConfig, Imu, Jump, Odometry, ReadingError};
use mapless_world::random::{gaussian, key};
use mapless_world::{HeightField, RobotConfig, attitude_on};

const IMU_S: f64 = 0.01;
const STANDS_S: f64 = 5.0;
const BIAS_RAD_S: DVec3 = DVec3::new(0.004, -0.006, 0.02);
const BASE_M: f64 = 0.165;

/// Hills with slopes of up to 14°.
fn hills() -> HeightField {
    let height = |index: u32| {
        let (x, y) = (f64::from(index % 401) * 0.5, f64::from(index / 401) * 0.5);
        (1.5 * libm::sin(x / 9.0) * libm::cos(y / 7.0)) as f32
    };
    HeightField::new(401, 401, 0.5, (0..401 * 401).map(height).collect()).unwrap()
}

/// A drive over the hills, sampled with the IMU.
struct Drive {
    field: HeightField,
    /// Numbers of noise that were drawn.
    drawn: u64,
    ticks: u64,
    pose: Pose,
    /// Along the body, and the turn rate of the wheels.
    speed_m_s: f64,
    wheels_rad_s: f64,
    gyro_rad_s: DVec3,
    driven_m: f64,
    /// What the odometry of the wheels makes of it, level.
    wheel_place_m: DVec2,
    wheel_yaw_rad: f64,
}

impl Drive {
    fn new() -> Self {
        let (field, place_m) = (hills(), DVec2::splat(100.0));
        let pose = stand(&field, place_m, 0.3);
        let (wheel_place_m, wheel_yaw_rad) = (place_m, 0.3);
        Self {
            field,
            drawn: 0,
            ticks: 0,
            pose,
            speed_m_s: 0.0,
            wheels_rad_s: 0.0,
            gyro_rad_s: DVec3::ZERO,
            driven_m: 0.0,
            wheel_place_m,
            wheel_yaw_rad,
        }
    }

    fn at(&self) -> Duration {
        Duration::from_secs_f64(50.0 + self.ticks as f64 * IMU_S)
    }

    fn time_s(&self) -> f64 {
        self.ticks as f64 * IMU_S
    }

    /// The next 10 ms: the robot stands, then drives in bends at 0.8 m/s.
    fn advance(&mut self) {
        self.ticks += 1;
        let drives_s = (self.time_s() - STANDS_S).max(0.0);
        self.speed_m_s = (0.5 * drives_s).min(0.8);
        let turn_rad_s = if drives_s > 0.0 { 0.5 * libm::sin(drives_s / 5.0) } else { 0.0 };
        let before = self.pose;
        let ahead_m = before.world_from_robot() * DVec3::X * self.speed_m_s * IMU_S;
        self.pose =
            stand(&self.field, before.plan_m() + ahead_m.truncate(), before.yaw_rad + turn_rad_s * IMU_S);
        let turn = DQuat::from_mat3(&(before.world_from_robot().transpose() * self.pose.world_from_robot()));
        self.gyro_rad_s = turn.to_scaled_axis() / IMU_S;
        self.driven_m += self.speed_m_s * IMU_S;
        // Skid-steered wheels turn further than the body.
        self.wheels_rad_s = 1.3 * turn_rad_s;
        self.wheel_yaw_rad += self.wheels_rad_s * IMU_S;
        let (sin, cos) = libm::sincos(self.wheel_yaw_rad);
        self.wheel_place_m += self.speed_m_s * IMU_S * DVec2::new(cos, sin);
    }

    fn noise(&mut self, deviation: f64) -> f64 {
        self.drawn += 1;
        deviation * gaussian(key(4, self.drawn))
    }

    fn imu(&mut self, base_from_imu: DQuat) -> Imu {
        let noise = DVec3::new(self.noise(0.002), self.noise(0.002), self.noise(0.002));
        Imu {
            at: self.at(),
            // The heading of the IMU is its own.
            orientation: DQuat::from_rotation_z(1.0)
                * DQuat::from_mat3(&self.pose.world_from_robot())
                * base_from_imu,
            orientation_variance: 0.0,
            angular_rad_s: base_from_imu.conjugate() * (self.gyro_rad_s + BIAS_RAD_S + noise),
        }
    }

    /// As a filter in two-dimensional mode sends it.
    fn level_odometry(&mut self) -> Odometry {
        let speed_m_s = self.speed_m_s * (1.0 + self.noise(0.01));
        Odometry {
            at: self.at(),
            position_m: self.wheel_place_m.extend(0.0),
            orientation: DQuat::from_rotation_z(self.wheel_yaw_rad),
            variances: [1e-3; 6],
            linear_m_s: DVec3::X * speed_m_s,
            angular_rad_s: DVec3::Z * self.wheels_rad_s,
        }
    }

    /// As a LiDAR odometry sends it: all of the pose of `base_link`.
    fn full_odometry(&mut self) -> Odometry {
        Odometry {
            position_m: self.pose.moved(DVec3::Z * BASE_M).position_m,
            orientation: DQuat::from_mat3(&self.pose.world_from_robot()),
            ..self.level_odometry()
        }
    }

    fn send(&mut self, estimator: &mut Estimator, is_full: bool) -> Option<Jump> {
        self.advance();
        estimator.take_imu(&self.imu(DQuat::IDENTITY)).unwrap();
        if !self.ticks.is_multiple_of(2) {
            return None;
        }
        let odometry = if is_full { self.full_odometry() } else { self.level_odometry() };
        estimator.take_odometry(&odometry).unwrap()
    }
}

fn stand(field: &HeightField, place_m: DVec2, yaw_rad: f64) -> Pose {
    let attitude = attitude_on(field, place_m, yaw_rad, &RobotConfig::default()).unwrap();
    let position_m = place_m.extend(attitude.height_m);
    Pose::from_roll_pitch_yaw(position_m, attitude.roll_rad, attitude.pitch_rad, yaw_rad)
}

fn estimator() -> Estimator {
    Estimator::new(EstimatorConfig::default(), DQuat::IDENTITY).unwrap()
}

fn at(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

#[test]
fn level_odometry_and_an_imu_give_height_tilt_and_heading() {
    let (mut drive, mut estimator) = (Drive::new(), estimator());
    let [mut steepest_rad, mut worst_m, mut worst_rad, mut worst_of_wheels_rad] = [0.0_f64; 4];
    // The level odometry begins at height 0, and with the base over the ground.
    let first_z_m = drive.pose.position_m.z + BASE_M;
    while drive.driven_m < 100.0 {
        assert_eq!(drive.send(&mut estimator, false), None);
        assert!(!estimator.wheels_disagree(), "skid steering is no slip");
        if let Some(pose) = estimator.pose() {
            steepest_rad = steepest_rad.max(pose.pitch_rad.abs());
            assert!((pose.pitch_rad - drive.pose.pitch_rad).abs() < 1e-9, "nose-up positive");
            assert!((pose.roll_rad - drive.pose.roll_rad).abs() < 1e-9);
            let missed_m = pose.position_m + DVec3::Z * first_z_m - drive.pose.position_m;
            worst_m = worst_m.max(missed_m.length());
            worst_rad = worst_rad.max(libm::remainder(pose.yaw_rad - drive.pose.yaw_rad, TAU).abs());
            worst_of_wheels_rad = worst_of_wheels_rad.max((drive.wheel_yaw_rad - drive.pose.yaw_rad).abs());
        }
    }
    assert!(steepest_rad > 0.15, "{steepest_rad}");
    assert!(!estimator.is_three_dimensional_now());
    assert!((estimator.gyro_bias_rad_s() - BIAS_RAD_S).length() < 1e-3, "{}", estimator.gyro_bias_rad_s());
    println!("worst: {worst_m} m, {worst_rad} rad; wheels alone {worst_of_wheels_rad} rad");
    assert!(worst_m < 0.2 && worst_rad < 0.03, "{worst_m} m, {worst_rad} rad");
    assert!(worst_of_wheels_rad > 0.5, "the wheels alone turn too far: {worst_of_wheels_rad}");
}

#[test]
fn full_odometry_is_followed_where_its_covariance_says_so() {
    let (mut drive, mut full) = (Drive::new(), estimator());
    while drive.driven_m < 20.0 {
        assert_eq!(drive.send(&mut full, true), None);
    }
    let missed_m = full.pose().unwrap().position_m - drive.pose.position_m;
    assert!(full.is_three_dimensional_now() && missed_m.length() < 0.01, "{missed_m}");

    // The same poses with a variance of the height that says that it is not known.
    let (mut drive, mut unsure) = (Drive::new(), estimator());
    while drive.driven_m < 20.0 {
        drive.advance();
        unsure.take_imu(&drive.imu(DQuat::IDENTITY)).unwrap();
        let mut odometry = drive.full_odometry();
        odometry.variances[2] = 1e6;
        unsure.take_odometry(&odometry).unwrap();
    }
    assert!(!unsure.is_three_dimensional_now());
}

#[test]
fn an_imu_that_is_mounted_askew_gives_the_same() {
    let base_from_imu = DQuat::from_euler(mapless::glam::EulerRot::ZYX, 1.5, 0.2, 3.0);
    let (mut drive, mut straight) = (Drive::new(), estimator());
    let mut askew = Estimator::new(EstimatorConfig::default(), base_from_imu).unwrap();
    while drive.driven_m < 10.0 {
        drive.advance();
        let drawn = drive.drawn;
        straight.take_imu(&drive.imu(DQuat::IDENTITY)).unwrap();
        drive.drawn = drawn;
        askew.take_imu(&drive.imu(base_from_imu)).unwrap();
        let odometry = drive.level_odometry();
        straight.take_odometry(&odometry).unwrap();
        askew.take_odometry(&odometry).unwrap();
    }
    let [a, b] = [straight, askew].map(|estimator| estimator.pose().unwrap());
    assert!((a.position_m - b.position_m).length() < 1e-6);
    assert!((a.roll_rad - b.roll_rad).abs() < 1e-9 && (a.pitch_rad - b.pitch_rad).abs() < 1e-9);
}

#[test]
fn a_jump_is_told_with_both_poses_and_only_once() {
    for is_full in [false, true] {
        for (jump_m, jump_rad) in [(DVec3::new(0.5, -0.5, 0.0), 0.0), (DVec3::ZERO, 0.4)] {
            let (mut drive, mut estimator) = (Drive::new(), estimator());
            while drive.driven_m < 5.0 {
                assert_eq!(drive.send(&mut estimator, is_full), None);
            }
            let leap = |mut odometry: Odometry| {
                odometry.position_m += jump_m;
                odometry.orientation = DQuat::from_rotation_z(jump_rad) * odometry.orientation;
                odometry
            };
            let mut jumps = Vec::new();
            for _ in 0..50 {
                drive.advance();
                estimator.take_imu(&drive.imu(DQuat::IDENTITY)).unwrap();
                let odometry = if is_full { drive.full_odometry() } else { drive.level_odometry() };
                jumps.extend(estimator.take_odometry(&leap(odometry)).unwrap());
            }
            let [Jump { before, after }] = jumps.as_slice() else { panic!("{} jumps", jumps.len()) };
            let moved_m = (after.position_m - before.position_m).length();
            let expected_m = if is_full { jump_m.length() } else { 0.0 };
            assert!((moved_m - expected_m).abs() < 0.02, "{moved_m}");
            assert!((after.yaw_rad - before.yaw_rad - if is_full { jump_rad } else { 0.0 }).abs() < 0.01);
        }
    }
}

#[test]
fn wheels_that_spin_or_a_robot_that_is_turned_disagree() {
    for (wheels_rad_s, gyro_rad_s, disagree) in
        [(1.0, 0.0, true), (0.0, 0.6, true), (0.8, -0.2, true), (1.0, 0.6, false), (0.2, 0.4, false)]
    {
        let mut estimator = estimator();
        for tick in 0..300 {
            let imu = Imu {
                at: at(10 * tick),
                orientation: DQuat::IDENTITY,
                orientation_variance: 0.0,
                angular_rad_s: DVec3::Z * gyro_rad_s,
            };
            let odometry = Odometry {
                at: at(10 * tick),
                position_m: DVec3::ZERO,
                orientation: DQuat::IDENTITY,
                variances: [0.0; 6],
                linear_m_s: DVec3::ZERO,
                angular_rad_s: DVec3::Z * wheels_rad_s,
            };
            estimator.take_imu(&imu).unwrap();
            estimator.take_odometry(&odometry).unwrap();
        }
        assert_eq!(estimator.wheels_disagree(), disagree, "{wheels_rad_s} {gyro_rad_s}");
        assert!((estimator.slip_rad_s() - (wheels_rad_s - gyro_rad_s)).abs() < 0.05);
    }
}

#[test]
fn a_velocity_without_a_new_word_does_not_move_the_robot_on() {
    let imu = |tick: u64, turn_rad_s: f64| Imu {
        at: at(10 * tick),
        orientation: DQuat::IDENTITY,
        orientation_variance: 0.0,
        angular_rad_s: DVec3::Z * turn_rad_s,
    };
    let odometry = |tick: u64, speed_m_s: f64, turn_rad_s: f64| Odometry {
        at: at(10 * tick),
        position_m: DVec3::ZERO,
        orientation: DQuat::IDENTITY,
        variances: [0.0; 6],
        linear_m_s: DVec3::X * speed_m_s,
        angular_rad_s: DVec3::Z * turn_rad_s,
    };
    // Two seconds without the IMU, in which the wheels stop, and two without odometry.
    for (is_imu_lost, speed_m_s, turn_rad_s) in [(true, 0.0, 1.0), (false, 0.8, 0.0)] {
        let mut estimator = estimator();
        for tick in 0..100 {
            estimator.take_imu(&imu(tick, turn_rad_s)).unwrap();
            estimator.take_odometry(&odometry(tick, speed_m_s, turn_rad_s)).unwrap();
        }
        let before = estimator.pose().unwrap();
        for tick in 100..300 {
            if is_imu_lost {
                estimator.take_odometry(&odometry(tick, 0.0, 0.0)).unwrap();
            } else {
                estimator.take_imu(&imu(tick, 0.0)).unwrap();
            }
        }
        estimator.take_imu(&imu(300, 0.0)).unwrap();
        let after = estimator.pose().unwrap();
        let (moved_m, turned_rad) =
            ((after.position_m - before.position_m).length(), (after.yaw_rad - before.yaw_rad).abs());
        assert!(moved_m < 0.2 && turned_rad < 0.25, "{moved_m} {turned_rad}");
    }
}

#[test]
fn without_a_gyro_the_heading_follows_the_odometry() {
    let mut estimator = estimator();
    let still = Imu {
        at: at(0),
        orientation: DQuat::IDENTITY,
        orientation_variance: 0.0,
        angular_rad_s: DVec3::ZERO,
    };
    estimator.take_imu(&still).unwrap();
    for tick in 0..=100 {
        let turning = Odometry {
            at: at(10 * tick),
            position_m: DVec3::ZERO,
            orientation: DQuat::from_rotation_z(0.005 * tick as f64),
            variances: [0.0; 6],
            linear_m_s: DVec3::ZERO,
            angular_rad_s: DVec3::Z * 0.5,
        };
        assert_eq!(estimator.take_odometry(&turning), Ok(None));
    }
    let turned_rad = estimator.pose().unwrap().yaw_rad;
    assert!((0.35..0.45).contains(&turned_rad), "after the 0.2 s for which the gyro holds: {turned_rad}");
}

#[test]
fn what_cannot_be_used_is_named_and_passed_over() {
    let (mut drive, mut estimator) = (Drive::new(), estimator());
    while drive.driven_m < 1.0 {
        drive.send(&mut estimator, false);
    }
    let before = estimator.pose();
    let imu = drive.imu(DQuat::IDENTITY);
    let odometry = drive.level_odometry();
    assert_eq!(
        estimator.take_imu(&Imu { orientation_variance: -1.0, ..imu }),
        Err(ReadingError::NoOrientation)
    );
    let fault = estimator.take_imu(&Imu { orientation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..imu });
    assert_eq!(
        fault.unwrap_err().to_string(),
        "imu.orientation = [0, 0, 0, 0]: expected a quaternion of length 1"
    );
    let fault = estimator.take_odometry(&Odometry { position_m: DVec3::new(f64::NAN, 0.0, 1.0), ..odometry });
    assert_eq!(
        fault.unwrap_err().to_string(),
        "odometry.pose.position = [NaN, 0, 1]: expected finite numbers"
    );
    assert_eq!(estimator.pose(), before);
}

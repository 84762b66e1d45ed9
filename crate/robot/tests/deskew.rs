//! Motion compensation of the world's swept scans, by the trajectory of the estimator.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use core::time::Duration;

use mapless::glam::{DQuat, DVec2, DVec3, Vec3};
use mapless::{Pose, SensorModel};
use mapless_robot::deskew::{DeskewError, deskew};
use mapless_robot::estimator::{Estimator, EstimatorConfig, Imu, Odometry, Trajectory};
use mapless_world::{Attitude, Caster, HeightField, Lidar, Scan, Scene, SensorConfig};

const PERIOD_S: f64 = 0.1;
const BASE_M: f64 = 0.165;
/// The end of the sweep.
const END_S: f64 = 10.0;

/// A robot that drives ahead, turns and nods, at `at_s`.
fn truth(at_s: f64) -> Pose {
    let ago_s = END_S - at_s;
    let yaw_rad = 0.4 - 0.9 * ago_s;
    // Along the body, on a circle, from a place in the middle of the bowl.
    let radius_m = 0.8 / 0.9;
    let (sin, cos) = libm::sincos(yaw_rad);
    let place_m = DVec2::splat(50.0) + radius_m * DVec2::new(sin, -cos);
    Pose::from_roll_pitch_yaw(place_m.extend(1.0), 0.1 * ago_s, 0.05 - 0.3 * ago_s, yaw_rad)
}

fn bowl() -> Caster {
    let height = |index: u32| {
        let (x, y) = (f64::from(index % 201) - 100.0, f64::from(index / 201) - 100.0);
        (0.0004 * (x * x + 2.0 * y * y)) as f32
    };
    Caster::new(HeightField::new(201, 201, 0.5, (0..201 * 201).map(height).collect()).unwrap())
}

/// A sensor that is mounted aside and askew.
fn sensors() -> (SensorModel, SensorConfig) {
    let mut sensor = SensorModel::vlp16();
    (sensor.forward_m, sensor.left_m, sensor.yaw_rad, sensor.pitch_rad) = (0.2, -0.3, 0.3, -0.1);
    let config = SensorConfig {
        range_noise_m: 0.0,
        max_range_m: 20.0,
        forward_m: 0.2,
        left_m: -0.3,
        yaw_rad: 0.3,
        pitch_rad: -0.1,
        ..SensorConfig::default()
    };
    (sensor, config)
}

/// A swept scan, and when each of its points was measured, in seconds from its end.
fn sweep(caster: &Caster, config: &SensorConfig) -> (Vec<Vec3>, Vec<f64>) {
    let fired_from = |share: f64| {
        let pose = truth(END_S - PERIOD_S * (1.0 - share));
        let attitude =
            Attitude { height_m: pose.position_m.z, roll_rad: pose.roll_rad, pitch_rad: pose.pitch_rad };
        config.pose_on(pose.plan_m(), pose.yaw_rad, &attitude)
    };
    let mut scan = Scan::default();
    let lidar = Lidar::new(config.clone()).unwrap();
    lidar.scan_along(20.0, &Scene::bare(caster), fired_from, 1, 2, &mut scan);
    let columns = (scan.ranges_m.len() / config.rings) as f64;
    let returns = scan.ranges_m.iter().enumerate().filter(|(_, range_m)| !range_m.is_nan());
    let times_s = returns.map(|(beam, _)| ((beam / config.rings + 1) as f64 / columns - 1.0) * PERIOD_S);
    (scan.points, times_s.collect())
}

/// The trajectory that the estimator makes of odometry at 50 Hz and an IMU at 100 Hz.
fn estimated() -> Trajectory {
    let mut estimator = Estimator::new(EstimatorConfig::default(), DQuat::IDENTITY).unwrap();
    for tick in 0..=(END_S * 100.0) as u32 {
        let at_s = f64::from(tick) * 0.01;
        let pose = truth(at_s);
        let turn =
            truth(at_s - 0.005).world_from_robot().transpose() * truth(at_s + 0.005).world_from_robot();
        let orientation = DQuat::from_mat3(&pose.world_from_robot());
        let angular_rad_s = DQuat::from_mat3(&turn).to_scaled_axis() / 0.01;
        let at = Duration::from_secs_f64(at_s);
        estimator.take_imu(&Imu { at, orientation, orientation_variance: 0.0, angular_rad_s }).unwrap();
        if tick.is_multiple_of(2) {
            let odometry = Odometry {
                at,
                position_m: pose.moved(DVec3::Z * BASE_M).position_m,
                orientation,
                variances: [0.01; 6],
                linear_m_s: DVec3::X * 0.8,
                angular_rad_s,
            };
            estimator.take_odometry(&odometry).unwrap();
        }
    }
    estimator.trajectory().clone()
}

/// The largest height of points over the ground, with the sensor where it is at a pose.
fn worst_m(caster: &Caster, config: &SensorConfig, pose: &Pose, points_m: &[Vec3]) -> f64 {
    let attitude =
        Attitude { height_m: pose.position_m.z, roll_rad: pose.roll_rad, pitch_rad: pose.pitch_rad };
    let sensor = config.pose_on(pose.plan_m(), pose.yaw_rad, &attitude);
    let above = points_m.iter().map(|point_m| {
        let world_m = sensor.position + sensor.world_from_sensor * point_m.as_dvec3();
        (world_m.z - caster.field().height_m(world_m.truncate()).unwrap()).abs()
    });
    above.fold(0.0, f64::max)
}

#[test]
fn a_swept_scan_lies_on_the_ground_again() {
    let (caster, (sensor, config)) = (bowl(), sensors());
    let (swept_m, times_s) = sweep(&caster, &config);
    assert!(worst_m(&caster, &config, &truth(END_S), &swept_m) > 0.2, "the motion bends the ground");
    let trajectory = estimated();
    for (instant_s, from_end_s) in [(END_S, 0.0), (END_S - PERIOD_S, PERIOD_S), (END_S - 0.03, 0.03)] {
        let mut points_m = swept_m.clone();
        let times_s: Vec<f64> = times_s.iter().map(|time_s| time_s + from_end_s).collect();
        let instant = Duration::from_secs_f64(instant_s);
        let pose = deskew(&mut points_m, &times_s, instant, &trajectory, &sensor).unwrap();
        assert!((pose.position_m - truth(instant_s).position_m).length() < 0.01);
        let worst_m = worst_m(&caster, &config, &truth(instant_s), &points_m);
        println!("at {instant_s} s: {worst_m} m");
        assert!(worst_m < 0.01, "{worst_m} m at {instant_s} s");
    }
}

#[test]
fn a_robot_that_stands_moves_no_point() {
    let mut trajectory = Trajectory::default();
    for tick in 0..20 {
        trajectory.push(Duration::from_millis(10 * tick), truth(0.0));
    }
    let mut points_m = vec![Vec3::new(3.0, -2.0, 0.5); 3];
    let times_s = [-0.1, -0.05, 0.0];
    deskew(&mut points_m, &times_s, Duration::from_millis(190), &trajectory, &SensorModel::vlp16()).unwrap();
    assert!(points_m.iter().all(|point_m| point_m.distance(Vec3::new(3.0, -2.0, 0.5)) < 1e-6));
}

#[test]
fn a_sweep_without_poses_is_told_and_left_as_it_is() {
    let trajectory = estimated();
    let mut points_m = vec![Vec3::X; 2];
    let mut fault = |times_s: &[f64], instant_s: f64| {
        let instant = Duration::from_secs_f64(instant_s);
        deskew(&mut points_m, times_s, instant, &trajectory, &SensorModel::vlp16()).unwrap_err()
    };
    assert_eq!(fault(&[0.0], END_S), DeskewError::Times { points: 2, times: 1 });
    assert_eq!(fault(&[0.0, 3.0], END_S), DeskewError::Sweep { at_s: 3.0 });
    assert!(matches!(fault(&[0.0, f64::NAN], END_S), DeskewError::Sweep { .. }));
    assert_eq!(
        fault(&[0.0, -0.1], END_S + 0.2).to_string(),
        "no pose is known 0.000 s from the instant of the scan: expected odometry and IMU then"
    );
    assert!(matches!(fault(&[0.0, 0.1], END_S), DeskewError::Trajectory { .. }));
    // Earlier than what is kept, and before all time.
    assert!(matches!(fault(&[0.0, -0.1], 5.0), DeskewError::Trajectory { .. }));
    assert!(matches!(fault(&[0.0, -0.1], 0.05), DeskewError::Trajectory { .. }));
    assert_eq!(points_m, [Vec3::X; 2]);
}

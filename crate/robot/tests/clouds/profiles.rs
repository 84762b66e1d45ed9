//! One ground as many sensors and layouts show it: the planner's profile must be the same.

use core::time::Duration;

use mapless::glam::{DVec2, Vec3};
use mapless::skyline::profile::Column;
use mapless::{Goal, Planner, PlannerConfig, Pose, RobotModel, SensorModel, Status, Step};
use mapless_robot::cloud::{check_sensor, check_view};
use mapless_world::{Attitude, Caster, HeightField, Lidar, RobotConfig, Scan, SensorConfig, attitude_on};

use crate::layouts::{LAYOUTS, Layout, Point};

/// Hills that hide what is behind them within r_oc.
fn ground() -> Caster {
    let height = |index: u32| {
        let (x, y) = (f64::from(index % 401) * 0.1, f64::from(index / 401) * 0.1);
        (0.6 * libm::sin(x / 1.9) * libm::cos(y / 2.3) + 0.04 * x) as f32
    };
    Caster::new(HeightField::new(401, 401, 0.1, (0..401 * 401).map(height).collect()).unwrap())
}

/// The world's sensor as the planner's model has it.
fn world_sensor(sensor: &SensorModel) -> SensorConfig {
    SensorConfig {
        rings: sensor.rings,
        lowest_elevation_rad: sensor.lowest_elevation_rad,
        highest_elevation_rad: sensor.highest_elevation_rad,
        columns: 1800,
        range_noise_m: 0.0,
        forward_m: sensor.forward_m,
        left_m: sensor.left_m,
        height_m: sensor.height_m,
        roll_rad: sensor.roll_rad,
        pitch_rad: sensor.pitch_rad,
        yaw_rad: sensor.yaw_rad,
        ..SensorConfig::default()
    }
}

/// Every beam of a scan, NaN without a return.
fn beams(scan: &Scan, rings: usize) -> Vec<Point> {
    let mut returns = scan.points.iter();
    let columns = scan.ranges_m.len() / rings;
    let point = |(beam, range_m): (usize, &f32)| Point {
        point_m: if range_m.is_nan() { Vec3::NAN } else { *returns.next().unwrap() },
        ring: (beam % rings) as u16,
        since_s: 0.1 * (beam / rings) as f64 / columns as f64,
    };
    scan.ranges_m.iter().enumerate().map(point).collect()
}

/// What a new planner makes of a scan; `hears` is told its step.
fn step<Answer>(
    caster: &Caster,
    place_m: DVec2,
    sensor: SensorModel,
    layout: &Layout,
    hears: impl FnOnce(Step<'_>) -> Answer,
) -> Answer {
    let attitude = attitude_on(caster.field(), place_m, 0.7, &RobotConfig::default()).unwrap();
    let Attitude { height_m, roll_rad, pitch_rad } = attitude;
    let world = world_sensor(&sensor);
    let mut scan = Scan::default();
    let lidar = Lidar::new(world.clone()).unwrap();
    lidar.scan(caster, &world.pose_on(place_m, 0.7, &attitude), 0, 0, &mut scan);
    let returns = layout.read(&beams(&scan, sensor.rings), sensor.rings);
    check_sensor(&sensor, &RobotModel::husky()).unwrap();
    check_view(&returns.points_m, &sensor).unwrap();
    let mut planner = Planner::new(PlannerConfig::for_robot(sensor, RobotModel::husky())).unwrap();
    planner.set_goal(Goal::at(place_m + 15.0 * DVec2::from_angle(0.7)));
    let pose = Pose::from_roll_pitch_yaw(place_m.extend(height_m), roll_rad, pitch_rad, 0.7);
    hears(planner.step(&returns.points_m, &pose, Duration::from_millis(100)))
}

fn profile(caster: &Caster, place_m: DVec2, sensor: SensorModel, layout: &Layout) -> Vec<Column> {
    step(caster, place_m, sensor, layout, |step| step.profile.to_vec())
}

/// How far two profiles differ, degrees, in every column where both see a skyline.
fn differences_deg(a: &[Column], b: &[Column]) -> Vec<f64> {
    let difference = |pair| match pair {
        (&Column::Ground { elevation_rad: a }, &Column::Ground { elevation_rad: b }) => {
            Some((a - b).to_degrees().abs())
        }
        _ => None,
    };
    a.iter().zip(b).filter_map(difference).collect()
}

fn sensor(rings: usize, half_view_deg: f64) -> SensorModel {
    let mut sensor = SensorModel::vlp16();
    sensor.rings = rings;
    (sensor.lowest_elevation_rad, sensor.highest_elevation_rad) =
        (-half_view_deg.to_radians(), half_view_deg.to_radians());
    sensor
}

#[test]
fn the_same_ground_has_the_same_profile() {
    let caster = ground();
    let turned = |roll_deg: f64, pitch_deg: f64, yaw_deg: f64, left_m: f64| {
        let mut sensor = SensorModel::vlp16();
        (sensor.roll_rad, sensor.pitch_rad) = (roll_deg.to_radians(), pitch_deg.to_radians());
        (sensor.yaw_rad, sensor.left_m) = (yaw_deg.to_radians(), left_m);
        sensor
    };
    let mut cases = vec![
        ("32 rings at ±45°", sensor(32, 45.0), 3),
        ("64 rings, organised", sensor(64, 45.0), 4),
        ("64 rings of ±22.5°, organised", sensor(64, 22.5), 6),
        ("128 rings, organised", sensor(128, 45.0), 4),
        ("128 rings of ±22.5°", sensor(128, 22.5), 7),
        ("yaw of 10°", turned(0.0, 0.0, 10.0, 0.0), 0),
        ("pitch of -10°", turned(0.0, -10.0, 0.0, 0.0), 0),
        ("roll of 10°", turned(10.0, 0.0, 0.0, 0.0), 0),
        ("0.3 m aside", turned(0.0, 0.0, 0.0, 0.3), 0),
        ("yaw of 10° and 0.3 m aside", turned(0.0, 0.0, 10.0, 0.3), 0),
    ];
    cases
        .extend(LAYOUTS.iter().enumerate().map(|(index, layout)| (layout.name, SensorModel::vlp16(), index)));
    let places_m = [[20.0, 20.0], [14.0, 23.0], [25.0, 11.0], [12.0, 12.0]].map(DVec2::from_array);
    let references = places_m.map(|place_m| profile(&caster, place_m, SensorModel::vlp16(), &LAYOUTS[0]));
    for (name, sensor, layout) in cases {
        let mut differences: Vec<f64> = Vec::new();
        for (&place_m, reference) in places_m.iter().zip(&references) {
            differences
                .extend(differences_deg(reference, &profile(&caster, place_m, sensor, &LAYOUTS[layout])));
        }
        differences.sort_by(f64::total_cmp);
        let median_deg = differences[differences.len() / 2];
        println!("{name}: {median_deg:.3}° in the median of {} columns", differences.len());
        assert!(median_deg <= 0.5 && differences.len() > 700, "{name}: {median_deg}°, {}", differences.len());
    }
}

#[test]
fn a_sensor_that_looks_farther_down_drives_over_level_ground() {
    let level = Caster::new(HeightField::new(401, 401, 0.1, vec![0.0; 401 * 401]).unwrap());
    for (rings, half_view_deg) in [(8, 15.0), (16, 15.0), (32, 45.0), (64, 22.5), (128, 45.0)] {
        let sensor = sensor(rings, half_view_deg);
        step(&level, DVec2::splat(20.0), sensor, &LAYOUTS[3], |step| {
            assert_eq!(step.status, Status::Driving, "{rings} rings");
            assert!(step.command.linear_m_s > 0.07, "{rings} rings: {:?}", step.command);
            let is_ground = |column: &&Column| matches!(column, Column::Ground { .. });
            assert_eq!(step.profile.iter().filter(is_ground).count(), step.profile.len(), "{rings} rings");
        });
    }
}

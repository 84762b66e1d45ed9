//! What spoils a scan: each effect against a clean one.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use glam::{DVec2, DVec3, Vec3};
use mapless_world::{Attitude, Caster, HeightField, Lidar, Scan, SensingConfig, SensorConfig};
use std::f64::consts::PI;

const LEVEL: Attitude = Attitude { height_m: 1.0, roll_rad: 0.0, pitch_rad: 0.0 };

fn sensor(sensing: SensingConfig) -> Lidar {
    let config = SensorConfig { range_noise_m: 0.0, ..SensorConfig::default() };
    Lidar::new(config).unwrap().in_the_field(sensing).unwrap()
}

/// A scan of level ground from 0.8 m above it.
fn take(sensing: SensingConfig) -> Scan {
    let ground = Caster::new(HeightField::new(401, 401, 0.25, vec![1.0; 401 * 401]).unwrap());
    let sensor = sensor(sensing);
    let pose = sensor.true_pose_on(DVec2::splat(50.0), 0.0, &LEVEL);
    let mut scan = Scan::default();
    sensor.scan(&ground, &pose, 1, 2, &mut scan);
    sensor.add_zeros(&mut scan);
    scan
}

fn ideal() -> SensingConfig {
    SensingConfig::default()
}

#[test]
fn a_blocked_sector_has_no_returns_and_the_rest_all() {
    let blocked = take(SensingConfig { blocked_azimuth_rad: 1.0, blocked_width_rad: 0.5, ..ideal() });
    let clean = take(ideal());
    for (column, (blocked, clean)) in blocked.ranges_m.chunks(16).zip(clean.ranges_m.chunks(16)).enumerate() {
        let azimuth_rad = -PI + column as f64 * (2.0 * PI / 1800.0);
        if (azimuth_rad - 1.0).abs() < 0.25 {
            assert!(blocked.iter().all(|range_m| range_m.is_nan()));
        } else {
            assert!(blocked.iter().zip(clean).all(|(a, b)| a.to_bits() == b.to_bits()));
        }
    }
    // Across the seam behind the robot, too.
    let behind = take(SensingConfig { blocked_width_rad: 0.5, ..ideal() });
    assert!(behind.points.iter().all(|point| point.y.atan2(-point.x).abs() > 0.24));
    // A column more or less, by where the columns lie.
    assert!(behind.points.len().abs_diff(blocked.points.len()) <= 8);
}

#[test]
fn zeros_stand_for_every_beam_without_a_return() {
    let scan = take(SensingConfig { zeros: true, ..ideal() });
    let zeros = scan.points.iter().filter(|point| **point == Vec3::ZERO).count();
    assert_eq!((scan.points.len(), zeros), (16 * 1800, 8 * 1800), "the upper half of the rings sees the sky");
    assert!(take(ideal()).points.iter().all(|point| *point != Vec3::ZERO));
}

#[test]
fn a_mount_that_is_off_tilts_and_lifts_the_ground_that_is_believed() {
    let seen = |sensing: SensingConfig| {
        let told = sensor(ideal()).config().pose_on(DVec2::splat(50.0), 0.0, &LEVEL);
        let points: Vec<DVec3> = take(sensing)
            .points
            .iter()
            .map(|point| told.position + told.world_from_sensor * point.as_dvec3())
            .collect();
        points
    };
    let pitched = seen(SensingConfig { mount_pitch_rad: 0.02, ..ideal() });
    // Nose-up by 0.02 rad and believed level: ground ahead seems lower, in proportion to its distance.
    let rolled = seen(SensingConfig { mount_roll_rad: 0.02, ..ideal() });
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 0.01, "{found} {expected}");
    for point in pitched.iter().filter(|point| (point.x - 50.0).abs() < 7.0) {
        close(point.z - 1.0, -0.02 * (point.x - 50.0));
    }
    for point in rolled.iter().filter(|point| (point.y - 50.0).abs() < 7.0) {
        close(point.z - 1.0, -0.02 * (point.y - 50.0));
    }
    assert!(pitched.len() > 5000 && rolled.len() > 5000);
    // Higher than believed: all ground seems lower.
    let lifted = seen(SensingConfig { mount_height_m: 0.03, ..ideal() });
    assert!(lifted.iter().all(|point| (point.z - 0.97).abs() < 1e-4));
}

#[test]
fn wet_ground_far_away_is_lost_first() {
    let wet = take(SensingConfig { weakest_return: 0.04, wetness: 0.8, ..ideal() });
    let per_ring = |scan: &Scan, ring: usize| {
        scan.ranges_m.iter().skip(ring).step_by(16).filter(|range_m| !range_m.is_nan()).count()
    };
    let clean = take(ideal());
    assert_eq!(per_ring(&wet, 0), per_ring(&clean, 0), "3 m away");
    let farther = per_ring(&wet, 4);
    assert!(farther > 0 && farther < 1600, "7 m away: {farther}");
    assert_eq!(per_ring(&wet, 5), 0, "9 m away");
    assert_eq!(take(SensingConfig { wetness: 0.8, ..ideal() }).points.len(), clean.points.len());
}

#[test]
fn strays_and_returns_on_the_robot_take_their_share() {
    let strays = take(SensingConfig { stray_probability: 0.1, ..ideal() });
    let above = strays.points.iter().filter(|point| point.z > -0.79).count() as f64;
    // Beams to the sky as well as to the ground.
    assert!((above / (16.0 * 1800.0) - 0.1).abs() < 0.02, "{above}");
    let mut points_m = Vec::new();
    sensor(SensingConfig { self_returns: 7, ..ideal() }).add_self_returns(
        DVec2::new(1.0, 0.7),
        1,
        2,
        &mut points_m,
    );
    assert_eq!(points_m.len(), 7);
    assert!(points_m.iter().all(|point| point.x.abs() <= 0.5 && point.y.abs() <= 0.35));
}

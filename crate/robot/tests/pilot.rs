//! What the pilot makes of goals and of the time between them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use core::f64::consts::TAU;
use core::time::Duration;

use mapless::glam::{DVec2, DVec3, Vec3};
use mapless::{Goal, PlannerConfig, Pose, Status, StopReason};
use mapless_robot::messages::Time;
use mapless_robot::navigation::Task;
use mapless_robot::pilot::Pilot;
use mapless_robot::senses::Scan;

/// Level ground, 16 rings × 360 azimuths, from 0.8 m above it.
fn level_ground() -> Vec<Vec3> {
    let beam = |column: u32, ring: u32| {
        let (sin_a, cos_a) = libm::sincos(TAU * f64::from(column) / 360.0);
        let (sin_e, cos_e) = libm::sincos((f64::from(ring) * 2.0 - 15.0).to_radians());
        let direction = DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
        (sin_e < -0.01).then(|| (direction * (0.8 / -sin_e)).as_vec3())
    };
    (0..360).flat_map(|column| (0..16).filter_map(move |ring| beam(column, ring))).collect()
}

#[test]
fn the_same_goal_again_after_a_stop_is_a_new_drive() {
    let mut pilot = Pilot::new(PlannerConfig::default()).unwrap();
    let mut scan = Scan {
        arrived: Duration::ZERO,
        stamp: Time::default(),
        points_m: level_ground(),
        pose: Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0),
    };
    let mut status = |number: u64| {
        scan.arrived += Duration::from_millis(500);
        pilot.answer(&scan, Task { number, goal: Goal::at(DVec2::X * 20.0) }, false).status
    };
    let stopped = Some(Status::Stopped(StopReason::NoProgress));
    // It is told to drive, and stays where it is.
    assert!((0..80).any(|_| status(1) == stopped));
    assert_eq!(status(1), stopped, "the goal is not taken up again by itself");
    assert_eq!(status(2), Some(Status::Driving));
}

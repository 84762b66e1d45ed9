//! Steps of the planner on any scans, poses and goals: a finite command within the limits, and no command
//! after a stop.

#![no_main]

use arbitrary::Arbitrary;
use core::time::Duration;

use glam::{DVec2, DVec3, Vec3};
use libfuzzer_sys::fuzz_target;
use mapless::Pose;
use mapless::{Command, Planner, PlannerConfig, Status};

#[derive(Arbitrary, Debug)]
struct Input {
    paper: bool,
    steps: Vec<Step>,
}

#[derive(Arbitrary, Debug)]
struct Step {
    place: Place,
    goal: Goal,
    beams: Vec<Beam>,
    loose_points_m: Vec<[f32; 3]>,
}

/// The robot's pose: near the last one, as robots drive, or anywhere.
#[derive(Arbitrary, Debug)]
enum Place {
    /// Centimetres, then hundredths of a radian of roll, pitch and turn.
    Near([i8; 6]),
    Any([f64; 6]),
}

#[derive(Arbitrary, Debug)]
enum Goal {
    Same,
    Near([i8; 2]),
    Any([f64; 2]),
}

/// An interval of one ring with a range in quarters of a decimetre, so that few bytes make a scan.
#[derive(Arbitrary, Debug)]
struct Beam {
    ring: u8,
    first_degree: u8,
    degrees: u8,
    range: u8,
}

const STEPS: usize = 12;

fuzz_target!(|input: Input| {
    let config = if input.paper { PlannerConfig::paper() } else { PlannerConfig::default() };
    let limits = config.controller;
    let mut planner = Planner::new(config).expect("presets are valid");
    let mut pose = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0);
    let mut goal_m = DVec2::new(20.0, 0.0);
    for step in input.steps.iter().take(STEPS) {
        match step.place {
            Place::Near(hundredths) => {
                let [x, y, z, roll_rad, pitch_rad, turn_rad] =
                    hundredths.map(|value| 0.01 * f64::from(value));
                let position_m = pose.position_m + DVec3::new(x, y, z);
                pose = Pose::from_roll_pitch_yaw(position_m, roll_rad, pitch_rad, pose.yaw_rad + turn_rad);
            }
            Place::Any([x, y, z, roll_rad, pitch_rad, yaw_rad]) => {
                pose = Pose::from_roll_pitch_yaw(DVec3::new(x, y, z), roll_rad, pitch_rad, yaw_rad);
            }
        }
        match step.goal {
            Goal::Same => {}
            Goal::Near(metres) => goal_m = DVec2::from_array(metres.map(f64::from)),
            Goal::Any(anywhere_m) => goal_m = DVec2::from_array(anywhere_m),
        }
        let mut points_m: Vec<Vec3> = step.beams.iter().flat_map(returns_m).collect();
        points_m.extend(step.loose_points_m.iter().copied().map(Vec3::from_array));
        planner.set_goal(mapless::Goal::at(goal_m));
        let decided = planner.step(&points_m, &pose, Duration::from_millis(100));
        let Command { linear_m_s, angular_rad_s } = decided.command;
        assert!(linear_m_s.abs() <= limits.max_speed_m_s, "{linear_m_s} m/s");
        assert!(angular_rad_s.abs() <= limits.max_turn_rate_rad_s, "{angular_rad_s} rad/s");
        if matches!(decided.status, Status::Stopped(_) | Status::Arrived) {
            assert_eq!(decided.command, Command::STOP);
        }
    }
});

fn returns_m(beam: &Beam) -> impl Iterator<Item = Vec3> {
    let elevation = (2.0 * f32::from(beam.ring % 16) - 15.0).to_radians();
    let range_m = 0.025 * f32::from(beam.range);
    let first = 2 * u16::from(beam.first_degree);
    (first..=first + u16::from(beam.degrees)).map(move |degree| {
        let (sin, cos) = f32::from(degree).to_radians().sin_cos();
        range_m * Vec3::new(elevation.cos() * cos, elevation.cos() * sin, elevation.sin())
    })
}

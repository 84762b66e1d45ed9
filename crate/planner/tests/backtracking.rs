//! Conditions for backtracking.

use core::time::Duration;

use glam::{DVec2, DVec3};
use mapless::Pose;
use mapless::decision::PerceptionOverride;
use mapless::skyline::profile::Column;
use mapless::terrain::plane::Plane;
use mapless::{Goal, Planner, PlannerConfig, Status};

const GOAL_M: DVec2 = DVec2::new(20.0, 0.0);

/// A step with level ground as perception override, however steep the robot's attitude; returns status and
/// speed.
fn step(planner: &mut Planner, x_m: f64, pitch_rad: f64) -> (Status, f64) {
    let pose = Pose::from_roll_pitch_yaw(DVec3::new(x_m, 0.0, 0.0), 0.0, pitch_rad, 0.0);
    let profile = |_: f64| Column::Ground { elevation_rad: 0.0 };
    let ground = |_: DVec2| Some(Plane { height_m: 0.0, gradient: DVec2::ZERO, gradient_deviation: 0.0 });
    let overrides = PerceptionOverride { profile: Some(&profile), terrain: Some(&ground) };
    planner.set_goal(Goal::at(GOAL_M));
    let step = planner.step_with(&[], &pose, Duration::from_millis(100), overrides);
    (step.status, step.command.linear_m_s)
}

fn drive(planner: &mut Planner, to_x_m: f64) {
    for k in 0..=(10.0 * to_x_m) as i32 {
        assert_eq!(step(planner, 0.1 * f64::from(k), 0.0).0, Status::Driving);
    }
}

#[test]
fn it_backtracks_from_ground_steeper_than_predicted_and_drives_on_after_a_metre() {
    let mut planner = Planner::new(PlannerConfig::default()).unwrap();
    drive(&mut planner, 3.0);
    let steep_rad = 0.75;
    assert_eq!(step(&mut planner, 3.1, steep_rad), (Status::Backtracking, 0.0), "it moves yet");
    let (status, speed_m_s) = step(&mut planner, 3.1, steep_rad);
    assert!(status == Status::Backtracking && speed_m_s < 0.0, "{status:?}, {speed_m_s} m/s");
    for x_m in [3.0, 2.9, 2.8, 2.7, 2.6, 2.5, 2.4, 2.3, 2.2] {
        assert_eq!(step(&mut planner, x_m, 0.0).0, Status::Backtracking, "not yet a metre back");
    }
    assert_eq!(step(&mut planner, 2.0, 0.0).0, Status::Driving);
}

/// Steps at one place with a pitch that grows each time; returns the last status.
fn steepen(planner: &mut Planner, x_m: f64, to_pitch_rad: f64, step_rad: f64) -> Status {
    let steps = (to_pitch_rad / step_rad) as i32;
    let pitches_rad = (0..=steps).rev().map(|k| to_pitch_rad - step_rad * f64::from(k));
    pitches_rad.fold(Status::Searching, |_, pitch_rad| step(planner, x_m, pitch_rad).0)
}

#[test]
fn it_turns_back_the_sooner_the_faster_the_ground_gets_steeper() {
    let PlannerConfig { robot: limits, state_lattice: forecast, .. } = PlannerConfig::default();
    let pitch_rad = limits.pitch_limit_rad - forecast.recovery_margin_rad - 0.03;
    for (step_rad, turns_back) in [(0.01, false), (0.04, true)] {
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        drive(&mut planner, 3.0);
        let status = steepen(&mut planner, 3.1, pitch_rad, step_rad);
        assert_eq!(status == Status::Backtracking, turns_back, "{step_rad} rad a step: {status:?}");
    }
}

#[test]
fn a_robot_that_has_not_driven_cannot_backtrack() {
    let mut planner = Planner::new(PlannerConfig::default()).unwrap();
    assert_ne!(step(&mut planner, 0.0, 0.75).0, Status::Backtracking);
}

#[test]
fn beyond_its_budget_it_drives_on_where_it_would_have_backtracked() {
    let PlannerConfig { robot: limits, state_lattice: forecast, .. } = PlannerConfig::default();
    let steep_rad =
        limits.pitch_limit_rad - 0.5 * (forecast.recovery_margin_rad + forecast.over_budget_margin_rad);
    // 3 m and 45 m; the detour budget is 40 m.
    for (laps, turns_back) in [(1, true), (15, false)] {
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        for lap in 0..laps {
            for k in 0..=30 {
                let x_m = 0.1 * f64::from(if lap % 2 == 0 { k } else { 30 - k });
                step(&mut planner, x_m, 0.0);
            }
        }
        let status = steepen(&mut planner, 3.0, steep_rad, 0.01);
        assert_eq!(status == Status::Backtracking, turns_back, "{laps} laps: {status:?}");
    }
}

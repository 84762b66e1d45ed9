//! Behaviour of the planner on scans of simple ground, and on invalid input.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use core::f64::consts::PI;
use core::time::Duration;

use glam::{DVec2, DVec3, Vec3};
use mapless::Pose;
use mapless::config::{FollowingLaw, InducingInputs};
use mapless::decision::PerceptionOverride;
use mapless::decision::subgoals::Subgoal;
use mapless::skyline::profile::Column;
use mapless::skyline::segments::Verdict;
use mapless::terrain::plane::Plane;
use mapless::{Command, Goal, Planner, PlannerConfig, Status, Step, StopReason};
use proptest::prelude::*;

const START: Pose = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0);
const PERIOD: Duration = Duration::from_millis(100);
const AHEAD: DVec2 = DVec2::new(50.0, 0.0);

/// A full scan, 16 rings × 1800 azimuths, from 0.8 m above the origin; `range_m` gives the range of a beam's
/// unit direction.
fn scan(range_m: impl Fn(DVec3) -> Option<f64>) -> Vec<Vec3> {
    let mut points = Vec::new();
    for column in 0..1800 {
        let (sin_a, cos_a) = libm::sincos(f64::from(column) * 0.2_f64.to_radians() - std::f64::consts::PI);
        for ring in 0..16 {
            let (sin_e, cos_e) = libm::sincos((f64::from(ring) * 2.0 - 15.0).to_radians());
            let direction = DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
            if let Some(range) = range_m(direction) {
                points.push((direction * range).as_vec3());
            }
        }
    }
    points
}

/// One step towards a goal.
fn step<'a>(planner: &'a mut Planner, points_m: &[Vec3], pose: &Pose, goal_m: DVec2) -> Step<'a> {
    planner.set_goal(Goal::at(goal_m));
    planner.step(points_m, pose, PERIOD)
}

/// Level ground.
fn level(direction: DVec3) -> Option<f64> {
    (direction.z < -0.01).then(|| 0.8 / -direction.z)
}

/// Level ground inside a round wall.
fn walled(radius_m: f64) -> impl Fn(DVec3) -> Option<f64> {
    move |direction| {
        let wall = radius_m / libm::hypot(direction.x, direction.y);
        Some(level(direction).map_or(wall, |ground| ground.min(wall)))
    }
}

/// Every policy and law of following, with a short spin recovery: a scan full of walls is the most expensive
/// one.
fn every_policy() -> [Planner; 3] {
    let mut pid = PlannerConfig::default();
    pid.controller.following = FollowingLaw::Pid;
    [PlannerConfig::default(), PlannerConfig::paper(), pid].map(|mut config| {
        config.decision.spin_recovery_s = 0.3;
        Planner::new(config).unwrap()
    })
}

#[test]
fn level_ground_is_seen_level_all_around_and_driven_over() {
    for mut planner in every_policy() {
        let seen = scan(level);
        // Until a controller that limits its acceleration is at full speed.
        for _ in 0..9 {
            step(&mut planner, &seen, &START, AHEAD);
        }
        let step = step(&mut planner, &seen, &START, AHEAD);
        assert_eq!(step.status, Status::Driving);
        assert!(
            step.command.linear_m_s > 0.5 && step.command.angular_rad_s.abs() < 0.2,
            "{:?}",
            step.command
        );
        assert!(step.segments.iter().all(|segment| segment.verdict == Verdict::Valid));
        let chosen = step.subgoals[step.chosen.unwrap()];
        assert!(chosen.bearing_rad.abs() < 0.2 && chosen.cost.is_some());
    }
}

#[test]
fn a_wall_all_around_ends_in_a_named_stop() {
    for mut planner in every_policy() {
        let points = scan(walled(1.5));
        let first = step(&mut planner, &points, &START, AHEAD);
        assert!(first.segments.iter().all(|segment| segment.verdict == Verdict::Wall));
        assert_eq!(first.status, Status::Searching);
        assert!(first.command.linear_m_s.abs() < 1e-12 && first.command.angular_rad_s > 0.0);
        for _ in 0..3 {
            step(&mut planner, &points, &START, AHEAD);
        }
        let last = planner.last_step();
        assert_eq!(last.status, Status::Stopped(StopReason::NoSubgoal));
        assert_eq!(last.command, Command::STOP);
    }
}

#[test]
fn a_robot_that_does_not_move_is_stopped_and_a_new_goal_begins_anew() {
    for mut planner in every_policy() {
        let points = scan(level);
        // The wheels spin.
        planner.set_goal(Goal::at(AHEAD));
        let second = Duration::from_secs(1);
        let statuses = (0..40).map(|_| planner.step(&points, &START, second).status);
        let driven = statuses.take_while(|status| *status == Status::Driving).count();
        assert_eq!(driven, 31);
        assert_eq!(planner.last_step().status, Status::Stopped(StopReason::NoProgress));
        assert_eq!(step(&mut planner, &points, &START, AHEAD).command, Command::STOP, "the same goal");
        planner.cancel_goal();
        assert_eq!(step(&mut planner, &points, &START, AHEAD).status, Status::Driving);
    }
}

#[test]
fn a_planner_that_gave_up_goes_on_once_the_world_has_changed() {
    let [mut planner, ..] = every_policy();
    let points = scan(walled(1.5));
    for _ in 0..=3 {
        step(&mut planner, &points, &START, AHEAD);
    }
    assert_eq!(planner.last_step().status, Status::Stopped(StopReason::NoSubgoal));
    // The walls are remembered until a reset.
    planner.reset();
    assert_eq!(step(&mut planner, &scan(level), &START, AHEAD).status, Status::Driving);
}

#[test]
fn an_optimised_drive_begins_anew_from_a_stop() {
    let [mut planner, ..] = every_policy();
    let seen = scan(level);
    for _ in 0..10 {
        step(&mut planner, &seen, &START, AHEAD);
    }
    assert!(planner.last_step().command.linear_m_s > 0.5);
    assert_eq!(step(&mut planner, &[], &START, AHEAD).command, Command::STOP);
    let begun = step(&mut planner, &seen, &START, AHEAD).command;
    assert!(begun.linear_m_s > 0.0 && begun.linear_m_s < 0.1, "{begun:?}");
}

#[test]
fn after_a_reset_a_planner_decides_as_a_new_one() {
    let seen = scan(level);
    for (mut planner, mut new) in every_policy().into_iter().zip(every_policy()) {
        for _ in 0..10 {
            step(&mut planner, &seen, &START, AHEAD);
        }
        planner.reset();
        for _ in 0..3 {
            let command = step(&mut planner, &seen, &START, AHEAD).command;
            assert_eq!(command, step(&mut new, &seen, &START, AHEAD).command);
        }
    }
}

#[test]
fn a_goal_in_sight_is_driven_to_and_arrived_at() {
    for mut planner in every_policy() {
        let points = scan(level);
        let goal = DVec2::new(0.0, 4.0);
        let found = step(&mut planner, &points, &START, goal);
        let chosen = found.subgoals[found.chosen.unwrap()];
        assert_eq!(chosen.segment, None);
        assert!((chosen.position_m.truncate() - goal).length() < 1e-9);
        assert_eq!(step(&mut planner, &points, &START, DVec2::new(0.3, 0.3)).status, Status::Arrived);
    }
}

/// A step of a planner whose terrain is overridden.
fn step_overridden(goal_m: DVec2, ground: impl Fn(DVec2) -> Option<Plane>) -> (Status, Option<Subgoal>) {
    let mut planner = Planner::new(PlannerConfig::default()).unwrap();
    let overrides = PerceptionOverride { terrain: Some(&ground), ..PerceptionOverride::default() };
    planner.set_goal(Goal::at(goal_m));
    let step = planner.step_with(&scan(level), &START, PERIOD, overrides);
    (step.status, step.chosen.map(|chosen| step.subgoals[chosen]))
}

#[test]
fn an_unsafe_goal_is_driven_to_within_its_tolerance() {
    let goal_m = DVec2::new(3.0, 1.0);
    let (status, chosen) = step_overridden(goal_m, |place_m| {
        let steep = (place_m - goal_m).length() < 0.4;
        let gradient = if steep { DVec2::splat(2.0) } else { DVec2::ZERO };
        Some(Plane { height_m: 0.0, gradient, gradient_deviation: 0.0 })
    });
    let beside_m = chosen.unwrap().position_m.truncate();
    assert_eq!(status, Status::Driving);
    assert!((0.4..=0.5).contains(&(beside_m - goal_m).length()), "{beside_m}");
}

#[test]
fn on_a_hilltop_whose_flanks_it_cannot_see_it_drives_to_the_edge() {
    let (status, chosen) = step_overridden(AHEAD, |place_m| {
        let plane = Plane { height_m: 0.0, gradient: DVec2::ZERO, gradient_deviation: 0.0 };
        (place_m.length() < 1.7).then_some(plane)
    });
    let edge_m = chosen.unwrap().position_m.truncate();
    assert_eq!(status, Status::Driving);
    assert!(edge_m.x > 1.0 && (1.2..1.7).contains(&edge_m.length()), "{edge_m}");
}

#[test]
fn what_makes_no_sense_is_answered_with_a_stop_and_its_reason() {
    let mut planner = Planner::new(PlannerConfig::default()).unwrap();
    let points = scan(level);
    let lost = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, f64::NAN);
    for (points, pose, goal, reason) in [
        (&points[..], lost, AHEAD, StopReason::InvalidInput),
        (&points[..], START, DVec2::new(f64::INFINITY, 0.0), StopReason::InvalidInput),
        (&[][..], START, AHEAD, StopReason::EmptyScan),
    ] {
        let step = step(&mut planner, points, &pose, goal);
        assert_eq!((step.status, step.command), (Status::Stopped(reason), Command::STOP));
    }
    assert_eq!(step(&mut planner, &points, &START, AHEAD).status, Status::Driving);
}

#[test]
fn after_a_relocalisation_the_planner_decides_as_if_the_frame_had_always_been_this() {
    let points = scan(level);
    // The same drive in two frames: the second is turned by half a circle, shifted and raised.
    let in_second = |x_m: f64| Pose::from_roll_pitch_yaw(DVec3::new(30.0 - x_m, 7.0, 2.0), 0.0, 0.0, PI);
    let in_first = |x_m: f64| Pose::from_roll_pitch_yaw(DVec3::new(x_m, 0.0, 0.0), 0.0, 0.0, 0.0);
    let (first_goal, second_goal) = (DVec2::new(20.0, 0.0), DVec2::new(10.0, 7.0));
    let planner = || Planner::new(PlannerConfig::default()).unwrap();
    let (mut moved, mut steady, mut torn) = (planner(), planner(), planner());
    for tick in 0..20 {
        let x_m = 0.05 * f64::from(tick);
        step(&mut moved, &points, &in_first(x_m), first_goal);
        step(&mut torn, &points, &in_first(x_m), first_goal);
        step(&mut steady, &points, &in_second(x_m), second_goal);
    }
    moved.relocalise(&in_first(1.0), &in_second(1.0));
    let window = |planner: &mut Planner| {
        let found = step(planner, &points, &in_second(1.0), second_goal);
        let reach_m = |subgoal: &Subgoal| subgoal.forecast.map_or(0.0, |forecast| forecast.reach_m);
        (found.status, found.subgoals.iter().map(reach_m).sum::<f64>())
    };
    let (moved, steady, torn) = (window(&mut moved), window(&mut steady), window(&mut torn));
    assert_eq!(moved.0, steady.0);
    assert!((moved.1 - steady.1).abs() < 0.05 * steady.1, "{moved:?} {steady:?}");
    assert!(
        (torn.1 - steady.1).abs() > 0.05 * steady.1,
        "without being told it has lost the ground: {torn:?}"
    );
}

#[test]
fn a_goal_that_moves_by_less_than_its_tolerance_forgets_nothing() {
    let mut planner = Planner::new(PlannerConfig::default()).unwrap();
    let points = scan(walled(1.5));
    let goal = Goal::at(AHEAD).within(0.5);
    planner.set_goal(goal);
    let seconds = |planner: &mut Planner, count: u32, goal: Goal| {
        for _ in 0..10 * count {
            planner.set_goal(goal);
            planner.step(&points, &START, PERIOD);
        }
        planner.last_step().status
    };
    // The spin recovery gives up after 15 s, whether or not the goal is told anew a little elsewhere.
    assert_eq!(seconds(&mut planner, 10, goal), Status::Searching);
    let near = Goal::at(AHEAD + DVec2::new(0.3, 0.0)).within(0.5);
    assert_eq!(seconds(&mut planner, 6, near), Status::Stopped(StopReason::NoSubgoal));
    let far = Goal::at(AHEAD + DVec2::new(3.0, 0.0));
    assert_eq!(seconds(&mut planner, 6, far), Status::Searching, "a new goal begins anew");
}

#[test]
fn the_turn_at_a_goal_is_judged_where_the_robot_stands_and_by_what_is_beside_it() {
    let turns = |points: &[Vec3], pitch_rad: f64, steps: u32| {
        let pose = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, pitch_rad, 0.0);
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        for _ in 0..steps {
            planner.set_goal(Goal::at(DVec2::ZERO).facing(0.0));
            assert_eq!(planner.step(points, &pose, PERIOD).status, Status::Arrived);
        }
        planner.set_goal(Goal::at(DVec2::ZERO).facing(0.5 * PI));
        planner.step(points, &pose, PERIOD).status
    };
    let unsafe_turn = Status::Stopped(StopReason::HeadingUnsafe);
    let free = scan(level);
    // The first step of all: nothing was searched before. Then the slope to the side would be 31°.
    assert_eq!((turns(&free, 0.0, 0), turns(&free, 0.54, 0)), (Status::Driving, unsafe_turn));
    // A wall that the side passes, and the corner does not.
    let beside = scan(|direction| {
        let wall = if direction.y > 0.0 { 0.45 / direction.y } else { 100.0 };
        Some(level(direction).map_or(wall, |ground| ground.min(wall)).min(100.0))
    });
    assert_eq!(turns(&beside, 0.0, 5), unsafe_turn);
}

#[test]
fn steps_that_stop_before_the_ground_is_observed_age_what_is_remembered() {
    let mut planner = Planner::new(PlannerConfig::default()).unwrap();
    let points = scan(level);
    step(&mut planner, &points, &START, AHEAD);
    let far_off = Pose::from_roll_pitch_yaw(DVec3::X * 12.0, 0.0, 0.0, 0.0);
    let is_behind = |planner: &Planner| planner.remembered_ground().any(|cell| cell.mean_m.x < 4.0);
    step(&mut planner, &points, &far_off, AHEAD);
    assert!(is_behind(&planner));
    for _ in 0..31 {
        planner.step(&[], &far_off, Duration::from_secs(10));
    }
    step(&mut planner, &points, &far_off, AHEAD);
    assert!(!is_behind(&planner), "older than five minutes");
}

#[test]
fn the_time_between_two_goals_is_not_spent_searching() {
    let mut planner = Planner::new(PlannerConfig::default()).unwrap();
    planner.set_goal(Goal::at(AHEAD));
    let late = planner.step(&scan(walled(1.5)), &START, Duration::from_secs(60));
    assert_eq!(late.status, Status::Searching);
}

#[test]
fn returns_nearer_than_the_sensor_measures_change_nothing() {
    let decide = |points: &[Vec3]| {
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        let found = step(&mut planner, points, &START, AHEAD);
        (found.status, found.command, found.subgoals.to_vec())
    };
    let clean = scan(level);
    let mut dirty = clean.clone();
    dirty.extend([Vec3::ZERO, Vec3::new(0.3, 0.1, -0.2), Vec3::new(0.0, -0.45, 0.0)]);
    assert_eq!(decide(&dirty), decide(&clean));
}

#[test]
fn at_the_goal_it_turns_to_any_final_heading_and_arrives() {
    let points = scan(level);
    // The part of a turn of 0.106… rad that is safe is, rounded, less than the turn.
    for start_rad in [-2.9, -1.3, -0.3, 0.106_962_725_102_028_38, 0.7, 2.3] {
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        planner.set_goal(Goal::at(DVec2::ZERO).facing(0.0));
        let mut yaw_rad: f64 = start_rad;
        let mut status = Status::Driving;
        for _ in 0..100 {
            let pose = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, yaw_rad);
            let step = planner.step(&points, &pose, PERIOD);
            yaw_rad += step.command.angular_rad_s * PERIOD.as_secs_f64();
            status = step.status;
            if status != Status::Driving {
                break;
            }
            assert!(step.command.linear_m_s.abs() < 1e-12);
        }
        assert_eq!(status, Status::Arrived, "from {start_rad}");
        assert!(yaw_rad.abs() <= 0.1, "{yaw_rad} from {start_rad}");
    }
}

/// An upright cylinder at a place ahead, as tall as a person.
fn person(ahead_m: f64) -> impl Fn(DVec3) -> Option<f64> {
    move |direction| {
        let plan = direction.truncate();
        let half = plan.x * ahead_m / plan.length_squared();
        let apart = half * half - (ahead_m * ahead_m - 0.2 * 0.2) / plan.length_squared();
        let range_m = (apart >= 0.0 && half > 0.0).then(|| half - apart.sqrt())?;
        (-0.8..0.9).contains(&(range_m * direction.z)).then_some(range_m)
    }
}

#[test]
fn a_person_who_walked_away_is_forgotten() {
    let with_person = scan(|direction| person(3.0)(direction).or_else(|| level(direction)));
    let clean = scan(level);
    let paths_m = |scans: &[&Vec<Vec3>]| {
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        for points in scans {
            step(&mut planner, points, &START, AHEAD);
        }
        let ahead = planner.last_step().subgoals.iter().filter(|subgoal| subgoal.bearing_rad.abs() < 0.5);
        ahead.filter_map(|subgoal| subgoal.forecast).map(|forecast| forecast.path_m).collect::<Vec<_>>()
    };
    let sum_m = |paths_m: &[f64]| paths_m.iter().sum::<f64>();
    let (free_m, blocked_m) = (paths_m(&[&clean; 8]), paths_m(&[&with_person; 4]));
    let again_m = paths_m(&[&[&with_person; 4][..], &[&clean; 4]].concat());
    assert!(blocked_m.len() < free_m.len());
    assert_eq!(again_m.len(), free_m.len());
    assert!((sum_m(&again_m) / sum_m(&free_m) - 1.0).abs() < 0.03, "{again_m:?} {free_m:?}");
}

/// A scan in which a share of the beams ends early, at random.
fn rainy(seed: u64, share: f64) -> Vec<Vec3> {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut points = scan(level);
    for point in &mut points {
        if random() < share {
            *point *= (0.1 + 0.9 * random()) as f32;
        }
    }
    points
}

#[test]
fn rain_neither_stops_nor_slows_it() {
    let mean_m_s = |share: f64| {
        let mut speeds_m_s = Vec::new();
        for seed in 0..6 {
            let mut planner = Planner::new(PlannerConfig::default()).unwrap();
            for tick in 0..5 {
                let found = step(&mut planner, &rainy(100 * seed + tick, share), &START, AHEAD);
                assert_eq!(found.status, Status::Driving);
                speeds_m_s.push(found.command.linear_m_s);
            }
        }
        speeds_m_s.iter().sum::<f64>() / speeds_m_s.len() as f64
    };
    let (dry_m_s, wet_m_s) = (mean_m_s(0.0), mean_m_s(0.02));
    assert!(wet_m_s > 0.95 * dry_m_s, "{wet_m_s} after {dry_m_s}");
}

#[test]
fn returns_on_its_own_body_change_nothing() {
    let clean = scan(level);
    let mut own = clean.clone();
    // Four posts of a roll bar.
    for (x, y) in [(0.25, 0.2), (0.25, -0.2), (-0.25, 0.2), (-0.25, -0.2)] {
        own.extend((0..60).map(|index| Vec3::new(x, y, -0.6 + 0.01 * index as f32)));
    }
    let decide = |points: &[Vec3]| {
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        let found = step(&mut planner, points, &START, AHEAD);
        (found.status, found.command, found.subgoals.to_vec())
    };
    assert_eq!(decide(&own), decide(&clean));
}

#[test]
fn a_scan_with_returns_at_the_origin_alone_is_empty() {
    let mut planner = Planner::new(PlannerConfig::default()).unwrap();
    let found = step(&mut planner, &[Vec3::ZERO; 2000], &START, AHEAD);
    assert_eq!(found.status, Status::Stopped(StopReason::EmptyScan));
}

#[test]
fn without_a_goal_it_stands_and_says_so() {
    let mut planner = Planner::new(PlannerConfig::default()).unwrap();
    let step = planner.step(&scan(level), &START, PERIOD);
    assert_eq!((step.status, step.command), (Status::Stopped(StopReason::NoGoal), Command::STOP));
    planner.set_goal(Goal::at(AHEAD));
    assert_eq!(planner.step(&scan(level), &START, PERIOD).status, Status::Driving);
    planner.cancel_goal();
    assert_eq!(planner.step(&scan(level), &START, PERIOD).status, Status::Stopped(StopReason::NoGoal));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_scan_gets_a_finite_command_inside_the_limits(
        points in prop::collection::vec(
            prop_oneof![
                8 => (-12.0..12.0_f32, -12.0..12.0_f32, -3.0..3.0_f32).prop_map(|(x, y, z)| Vec3::new(x, y, z)),
                1 => Just(Vec3::NAN),
                1 => Just(Vec3::new(f32::INFINITY, 0.0, 0.0)),
                1 => Just(Vec3::ZERO),
            ],
            0..400,
        ),
        roll in -0.5..0.5_f64, pitch in -0.7..0.7_f64, yaw in -10.0..10.0_f64,
        goal_x in -50.0..50.0_f64, goal_y in -50.0..50.0_f64,
    ) {
        let pose = Pose::from_roll_pitch_yaw(DVec3::ZERO, roll, pitch, yaw);
        for mut planner in every_policy() {
            let limits = planner.config().controller;
            let step = step(&mut planner, &points, &pose, DVec2::new(goal_x, goal_y));
            prop_assert!(step.command.linear_m_s.abs() <= limits.max_speed_m_s);
            prop_assert!(step.command.angular_rad_s.abs() <= limits.max_turn_rate_rad_s);
            if let Ok(surface) = planner.predicted_surface() {
                prop_assert!(surface.relative_variance.iter().all(|v| v.is_finite()));
                prop_assert!(surface.mean_m.iter().all(|m| m.is_finite()));
            }
        }
    }

    #[test]
    fn extreme_hyperparameters_get_an_answer_too(
        azimuth in -3.0..0.5_f64, elevation in -3.0..0.5_f64, variance in -3.0..3.0_f64, noise in -6.0..3.0_f64,
        alpha in prop_oneof![Just(0.1), Just(10.0), 0.5..80.0_f64], spacing in 0.3..3.0_f64, threshold in 0.01..0.99_f64,
        lattice: bool, gap in 0..16_usize,
    ) {
        let power = |exponent: f64| libm::pow(10.0, exponent);
        let mut config = PlannerConfig::default();
        let perception = &mut config.perception;
        perception.kernel.length_scales_rad = [power(azimuth), power(elevation)];
        perception.kernel.variance = power(variance);
        perception.kernel.alpha = alpha;
        perception.noise_variance_m2 = power(noise);
        perception.inducing_spacing_length_scales = spacing;
        perception.variance_threshold = threshold;
        perception.max_inducing_inputs = 60;
        if !lattice {
            perception.inducing_inputs = InducingInputs::FarthestPoints;
        }
        // A sector of level ground with a wall of some rings behind it.
        let returns: Vec<Vec3> = scan(walled(5.0))
            .into_iter()
            .filter(|p| p.x > 4.0 && f64::from(p.z) < 0.1 * gap as f64)
            .collect();
        let mut planner = Planner::new(config).unwrap();
        let step = step(&mut planner, &returns, &START, AHEAD);
        prop_assert!(step.command.linear_m_s.is_finite() && step.command.angular_rad_s.is_finite());
        let named = matches!(step.status, Status::Stopped(StopReason::NoPerception(_) | StopReason::EmptyScan));
        prop_assert!(named || step.profile.len() == 360);
        for column in step.profile {
            if let Column::Ground { elevation_rad } = column {
                prop_assert!(elevation_rad.abs() <= 0.2618, "{}", elevation_rad);
            }
        }
        if let Ok(surface) = planner.predicted_surface() {
            prop_assert!(surface.relative_variance.iter().chain(&surface.mean_m).all(|v| v.is_finite()));
        }
    }
}

use core::time::Duration;

use super::*;
use crate::{NavigatorKind, RouteNavigator, Task, TaskName};
use glam::DVec3;
use mapless::Pose;
use mapless::{Goal, PlannerConfig};
use mapless_terrain::generate::{Difficulty, Family};
use mapless_trials::{Navigator as _, Outcome, Scenario, Trial};
use mapless_world::{DriveCommand, HeightField, Robot, RobotConfig, attitude_on};
use proptest::prelude::*;

/// A square of 40 m with a height for each place.
fn ground(height_m: impl Fn(f64, f64) -> f64) -> HeightField {
    let heights_m =
        (0..201 * 201).map(|i| height_m(f64::from(i % 201) * 0.2, f64::from(i / 201) * 0.2) as f32).collect();
    HeightField::new(201, 201, 0.2, heights_m).unwrap()
}

fn gaussian(x: f64) -> f64 {
    libm::exp(-0.5 * x * x)
}

const START: PlanPose = PlanPose { position_m: DVec2::new(5.0, 20.0), yaw_rad: 0.4 };
const PERIOD: Duration = Duration::from_millis(100);
const GOAL_M: DVec2 = DVec2::new(35.0, 21.0);

fn bare(field: &HeightField) -> KnownWorld {
    KnownWorld::bare(field, &RobotConfig::default())
}

fn path(field: &HeightField) -> Result<OraclePath, OracleError> {
    shortest_path(&bare(field), START, GOAL_M, &OracleConfig::default())
}

fn within_limits(field: &HeightField, path: &OraclePath) -> bool {
    let (robot, margin_rad) = (RobotConfig::default(), OracleConfig::default().margin_rad);
    path.poses.iter().all(|pose| {
        let attitude = attitude_on(field, pose.position_m, pose.yaw_rad, &robot).unwrap();
        attitude.roll_rad.abs() <= robot.roll_limit_rad - margin_rad
            && attitude.pitch_rad.abs() <= robot.pitch_limit_rad - margin_rad
    })
}

/// Drives the path with the kinematic Husky; returns where it ended and its largest tilt utilisation.
fn drive(field: &HeightField, start: PlanPose, goal_m: DVec2) -> (DVec2, f64) {
    let robot = RobotConfig::default();
    let oracle = Oracle { world: bare(field), config: OracleConfig::default() };
    let mut driver = RouteNavigator::new(oracle, &PlannerConfig::default());
    let mut husky = Robot::new(robot.clone(), field, start.position_m, start.yaw_rad).unwrap();
    let mut worst: f64 = 0.0;
    for _ in 0..3000 {
        let state = *husky.state();
        let pose = Pose::from_roll_pitch_yaw(
            husky.position(),
            state.attitude.roll_rad,
            state.attitude.pitch_rad,
            state.yaw_rad,
        );
        let command = driver.navigate(&[], &pose, &Goal::at(goal_m), PERIOD).command;
        let command = DriveCommand { speed_m_s: command.linear_m_s, turn_rate_rad_s: command.angular_rad_s };
        for _ in 0..10 {
            husky.step(command, 0.01, field).unwrap();
            let tilt = husky.state().attitude;
            worst = worst
                .max(tilt.roll_rad.abs() / robot.roll_limit_rad)
                .max(tilt.pitch_rad.abs() / robot.pitch_limit_rad);
        }
    }
    (husky.state().position, worst)
}

#[test]
fn on_level_ground_it_is_the_straight_way() {
    let path = path(&ground(|_, _| 0.0)).unwrap();
    assert!((path.length_m - START.position_m.distance(GOAL_M)).abs() < 1e-9, "{}", path.length_m);
    assert_eq!(path.poses[0], START);
    assert!(path.poses[path.poses.len() - 1].position_m.distance(GOAL_M) < 1e-9);
    for pair in path.poses.windows(2) {
        assert!(pair[0].position_m.distance(pair[1].position_m) <= 0.125 + 1e-9);
        assert!((pair[0].yaw_rad - pair[1].yaw_rad).abs() <= 0.2);
    }
}

/// A wall across the terrain, 3 m high, with a gap 3 m wide at y = 32 m.
fn wall_with_a_gap() -> HeightField {
    ground(|x, y| if (y - 32.0).abs() < 1.5 { 0.0 } else { 3.0 * gaussian((x - 20.0) / 0.8) })
}

#[test]
fn a_wall_is_passed_through_its_gap() {
    let field = wall_with_a_gap();
    let path = path(&field).unwrap();
    let through = |pose: &PlanPose| (pose.position_m.x - 20.0).abs() < 0.1;
    assert!(path.poses.iter().any(through));
    assert!(
        path.poses.iter().filter(|pose| through(pose)).all(|pose| (pose.position_m.y - 32.0).abs() < 1.5)
    );
    assert!(within_limits(&field, &path));
    // Two straight lines to the gap.
    let gap_m = DVec2::new(20.0, 30.8);
    let shortest_m = START.position_m.distance(gap_m) + gap_m.distance(GOAL_M);
    assert!(path.length_m < 1.06 * shortest_m, "{} {shortest_m}", path.length_m);
}

#[test]
fn a_steep_ridge_is_gone_around_and_a_gentle_one_crossed() {
    let ridge = |height_m: f64| {
        ground(move |x, y| {
            height_m
                * gaussian((x - 20.0) / 1.5)
                * gaussian((y - 20.0).max(0.0) / 2.0)
                * if y < 8.0 { gaussian((8.0 - y) / 2.0) } else { 1.0 }
        })
    };
    let straight_m = START.position_m.distance(GOAL_M);
    let around = path(&ridge(4.0)).unwrap();
    assert!(around.length_m > straight_m + 0.5, "{}", around.length_m);
    assert!(around.poses.iter().any(|pose| pose.position_m.y > 22.0));
    let across = path(&ridge(0.6)).unwrap();
    assert!(across.length_m < straight_m + 1e-6, "{}", across.length_m);
}

#[test]
fn a_slope_too_steep_to_roll_on_is_climbed_more_steeply() {
    // A bank of 31°, which the straight line would cross at 65° from its fall line: too much roll, while the
    // pitch of a straight climb is allowed.
    let (sin, cos) = libm::sincos(1.13);
    let field = ground(|x, y| 0.6 * (x * cos + y * sin).clamp(24.0, 29.0));
    let path = path(&field).unwrap();
    assert!(within_limits(&field, &path));
    let straight_m = START.position_m.distance(GOAL_M);
    assert!(path.length_m > straight_m + 0.1, "{}", path.length_m);
    assert!(path.length_m < 1.2 * straight_m, "{}", path.length_m);
}

#[test]
fn without_a_way_there_is_no_path() {
    let closed = ground(|x, _| 3.0 * gaussian((x - 20.0) / 0.8));
    assert!(matches!(path(&closed), Err(OracleError::NoPath { .. })));
    let steep = ground(|x, _| 1.5 * x);
    let error = path(&steep).unwrap_err();
    assert!(matches!(error, OracleError::NotStandable { what: "start", .. }), "{error}");
    let hole = ground(|x, y| 4.0 * gaussian((x - 33.0) / 1.3) * gaussian((y - 21.0) / 1.3));
    let error = path(&hole).unwrap_err();
    assert_eq!(
        error.to_string(),
        "goal = (35.000, 21.000) m is too steep: expected at most 0.444 rad of roll and 0.705 rad of pitch"
    );
}

#[test]
fn places_and_values_are_checked() {
    let field = ground(|_, _| 0.0);
    let robot = RobotConfig::default();
    let search = |start: PlanPose, goal_m, config: OracleConfig| {
        shortest_path(&KnownWorld::bare(&field, &robot), start, goal_m, &config).unwrap_err()
    };
    let ok = OracleConfig::default();
    let off = PlanPose { position_m: DVec2::new(0.1, 5.0), ..START };
    assert!(matches!(search(off, GOAL_M, ok), OracleError::OffTerrain { what: "start", .. }));
    let blind = PlanPose { yaw_rad: f64::NAN, ..START };
    assert!(matches!(search(blind, GOAL_M, ok), OracleError::OffTerrain { what: "start", .. }));
    let goal_m = DVec2::new(5.0, 40.1);
    assert!(matches!(search(START, goal_m, ok), OracleError::OffTerrain { what: "goal", .. }));
    assert!(matches!(search(START, DVec2::NAN, ok), OracleError::OffTerrain { what: "goal", .. }));
    let fine = OracleConfig { cell_m: 0.01, ..ok };
    assert_eq!(
        search(START, GOAL_M, fine).to_string(),
        "oracle.cell_m = 0.01: expected a number from 0.1 to 10"
    );
    let wide = OracleConfig { margin_rad: 0.6, ..ok };
    assert!(
        search(START, GOAL_M, wide).to_string().starts_with("oracle.margin_rad = 0.6: expected less than")
    );
    let far = HeightField::new(3, 3, 1000.0, vec![0.0; 9]).unwrap();
    let error = shortest_path(&KnownWorld::bare(&far, &robot), START, GOAL_M, &ok).unwrap_err();
    assert!(matches!(error, OracleError::TooLarge { .. }), "{error}");
}

#[test]
fn a_goal_at_the_start_is_reached() {
    let field = ground(|_, _| 0.0);
    let goal_m = START.position_m + DVec2::new(0.1, 0.0);
    let config = OracleConfig::default();
    let path = shortest_path(&bare(&field), START, goal_m, &config).unwrap();
    assert_eq!((path.poses, path.length_m), (vec![START], 0.0));
}

#[test]
fn its_path_can_be_driven() {
    let (end_m, worst) = drive(&wall_with_a_gap(), START, GOAL_M);
    assert!(end_m.distance(GOAL_M) <= PlannerConfig::default().goal_tolerance_m, "{end_m}");
    assert!(worst < 1.0, "{worst}");
    for index in 1..=2 {
        for family in Difficulty::ALL.map(Family::Ground) {
            let task = Task::generate(TaskName { family, seed: 9, index }).unwrap();
            let (end_m, worst) = drive(&task.terrain.field, task.start, task.goal_m);
            println!("{}: at most {worst:.2} of a limit", task.name);
            assert!(
                end_m.distance(task.goal_m) <= PlannerConfig::default().goal_tolerance_m,
                "{}: {end_m}",
                task.name
            );
            assert!(worst < 1.0, "{}: {worst}", task.name);
        }
    }
}

#[test]
fn its_path_among_obstacles_can_be_driven() {
    // Nobody with a map knows where people will walk. `Mixed` always has rocks and posts.
    for family in [Family::Walls, Family::Ditches, Family::Mixed] {
        let task = Task::generate(TaskName { family, seed: 9, index: 1 }).unwrap();
        let scenario = Scenario::parse("task.toml", &task.scenario("terrain.toml")).unwrap();
        let scenario = scenario.on_terrain(&task.terrain.objects);
        let field = task.terrain.field.clone();
        let oracle = NavigatorKind::Oracle.build(&field, &scenario, 1).unwrap();
        let mut trial = Trial::with_navigator(field, &scenario, oracle, 1).unwrap();
        while trial.tick().is_none() {}
        assert_eq!(trial.outcome(), Some(Outcome::Reached), "{}: {:?}", task.name, trial.contact());
    }
}

prop_compose! {
    fn hill()(x in 0.0..40.0f64, y in 0.0..40.0f64, height_m in -3.0..4.0f64, radius_m in 1.5..5.0f64) -> [f64; 4] {
        [x, y, height_m, radius_m]
    }
}

fn hilly(hills: &[[f64; 4]]) -> HeightField {
    ground(|x, y| {
        let one = |&[cx, cy, h, r]: &[f64; 4]| h * gaussian(DVec3::new(x - cx, y - cy, 0.0).length() / r);
        hills.iter().map(one).sum()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_pose_is_within_the_limits(hills in prop::collection::vec(hill(), 10..25)) {
        let field = hilly(&hills);
        if let Ok(path) = path(&field) {
            prop_assert!(within_limits(&field, &path));
            prop_assert!(path.length_m >= START.position_m.distance(GOAL_M) - 1e-9);
            prop_assert!(path.poses[path.poses.len() - 1].position_m.distance(GOAL_M) < 1e-9);
        }
    }

    /// The shortcut for gentle ground is never more permissive than the attitudes.
    #[test]
    fn gentle_ground_is_safe_for_every_heading(
        hills in prop::collection::vec(hill(), 5..15),
        places in prop::collection::vec((0.0..40.0f64, 0.0..40.0f64, -3.2..3.2f64), 200),
    ) {
        let field = hilly(&hills);
        let (robot, world) = (RobotConfig::default(), bare(&field));
        let safe_poses = SafePoses::new(&world, &OracleConfig::default()).unwrap();
        for (x, y, yaw_rad) in places {
            let at_m = DVec2::new(x, y);
            let safe = attitude_on(&field, at_m, yaw_rad, &robot)
                .is_some_and(|tilt| tilt.roll_rad.abs() <= 0.524 - 0.08 && tilt.pitch_rad.abs() <= 0.785 - 0.08);
            prop_assert_eq!(safe_poses.is_safe(at_m, yaw_rad), safe, "{} {}", at_m, yaw_rad);
        }
    }
}

//! `Trial::act_by`: something else moves the robot.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::convert::Infallible;

use mapless_trials::{Moved, Outcome, Preset, Scenario, Trial};
use mapless_world::{DriveCommand, DriveError, Footing, HeightField, Robot};

const SCENARIO: &str = "terrain = \"it\"\nstart = [10.0, 10.0, 0.0]\ngoal = [16.0, 11.0]\nseed = 7\n\
    [[objects]]\nkind = \"post\"\nat = [13.0, 10.2]\nradius_m = 0.2\nheight_m = 1.5\n";

fn hilly() -> HeightField {
    let height_m = |x: f64, y: f64| 0.6 * libm::sin(0.5 * x) * libm::cos(0.4 * y);
    let heights = (0..121 * 121)
        .map(|i| height_m(0.25 * f64::from(i % 121), 0.25 * f64::from(i / 121)) as f32)
        .collect();
    HeightField::new(121, 121, 0.25, heights).unwrap()
}

fn trial(more: &str) -> (Scenario, Trial) {
    let scenario = Scenario::parse("it", &format!("{SCENARIO}{more}")).unwrap();
    let trial = Trial::new(hilly(), &scenario, Preset::Default, scenario.seed).unwrap();
    (scenario, trial)
}

#[test]
fn the_kinematic_motion_from_outside_gives_the_same_bits() {
    for reality in ["", "[reality]\npreset = \"field\"\n"] {
        let (scenario, mut own) = trial(reality);
        while own.tick().is_none() {}
        assert_eq!(own.outcome(), Some(Outcome::Reached));

        let (_, mut moved) = trial(reality);
        let field = hilly();
        let solids = moved.objects().solids().to_vec();
        let footing = Footing { field: &field, solids: &solids };
        let start = scenario.start;
        let mut robot = Robot::new(scenario.robot, &footing, start.position_m, start.heading_rad)
            .unwrap()
            .with_motion(scenario.reality.motion);
        let mut motion = |command: DriveCommand, dt_s: f64| {
            robot.step(command, dt_s, &footing)?;
            let state = *robot.state();
            Ok::<Moved, DriveError>(Moved { state, wheels: robot.wheels(), judged: state.attitude })
        };
        while moved.outcome().is_none() {
            moved.look();
            moved.plan();
            moved.act_by(&mut motion).unwrap();
        }
        assert_eq!((moved.digest(), moved.metrics()), (own.digest(), own.metrics()));
    }
}

/// The outcome of a period in which the robot is moved once as `change` says.
fn after(change: impl Fn(&mut Moved)) -> (Option<Outcome>, f64) {
    let (_, mut trial) = trial("");
    let state = *trial.robot();
    let mut moved = Moved { state, wheels: DriveCommand::default(), judged: state.attitude };
    change(&mut moved);
    trial.look();
    trial.plan();
    let outcome = trial.act_by(|_, _| Ok::<Moved, Infallible>(moved)).unwrap();
    (outcome, trial.robot().attitude.roll_rad)
}

#[test]
fn a_robot_that_is_moved_is_judged_where_it_is_moved_to() {
    assert_eq!(after(|_| ()).0, None);
    assert_eq!(after(|moved| moved.state.position.x = -1.0).0, Some(Outcome::LeftTerrain));
    assert_eq!(after(|moved| moved.state.position.x = 13.0).0, Some(Outcome::Collision));
}

#[test]
fn the_judged_tilt_ends_a_trial_and_the_robot_has_its_own() {
    assert_eq!(after(|moved| moved.judged.roll_rad = 0.6).0, Some(Outcome::TiltLimit));
    let (outcome, roll_rad) = after(|moved| moved.state.attitude.roll_rad = 0.6);
    assert_eq!((outcome, roll_rad.to_bits()), (None, 0.6_f64.to_bits()));
}

#[test]
fn an_error_of_the_motion_is_given_on() {
    let (_, mut trial) = trial("");
    trial.look();
    trial.plan();
    assert_eq!(trial.act_by(|_, _| Err("broken")), Err("broken"));
}

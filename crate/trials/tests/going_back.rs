//! A trial that goes back and runs forward again has the bits of an uninterrupted one, and so has one with a
//! longer sensor range than the planner uses; waypoints come before the goal.
#![allow(clippy::unwrap_used, missing_docs)]

use glam::DVec2;
use mapless_trials::{History, Outcome, Preset, Scenario, Trial};
use mapless_world::{Brush, BrushKind, HeightField};

const SCENARIO: &str = "terrain = \"a.toml\"\nstart = [4.0, 4.0, 0.2]\ngoal = [9.0, 5.0]\nseed = 3\n";

fn trial(scenario: &str) -> Trial {
    trial_of(scenario, Preset::Default)
}

fn trial_of(scenario: &str, preset: Preset) -> Trial {
    let cells = 81;
    let height_m = |index: usize| {
        let (x, y) = ((index % cells) as f64 * 0.25, (index / cells) as f64 * 0.25);
        (0.3 * libm::sin(0.5 * x) * libm::cos(0.4 * y)) as f32
    };
    let field = HeightField::new(cells, cells, 0.25, (0..cells * cells).map(height_m).collect()).unwrap();
    Trial::new(field, &Scenario::parse("it", scenario).unwrap(), preset, 3).unwrap()
}

fn run_to(trial: &mut Trial, history: &mut History<Trial>, tick: u64) {
    while trial.ticks() < tick && trial.tick().is_none() {
        if let Some(changed) = history.reached(trial.ticks(), trial) {
            *trial = changed.clone();
        }
    }
}

#[test]
fn going_back_and_on_gives_the_same_digest() {
    let mut plain = trial(SCENARIO);
    while plain.tick().is_none() {}
    assert_eq!(plain.outcome(), Some(Outcome::Reached));

    let mut scrubbed = trial(SCENARIO);
    let mut history = History::new(10, 8, 0, &scrubbed);
    for (ahead, back) in [(23, 4), (47, 31), (60, 60)] {
        run_to(&mut scrubbed, &mut history, ahead);
        scrubbed = history.at_or_before(back).unwrap().clone();
        run_to(&mut scrubbed, &mut history, back);
        assert_eq!(scrubbed.ticks(), back);
    }
    run_to(&mut scrubbed, &mut history, u64::MAX);
    assert_eq!(scrubbed.digest(), plain.digest());
    assert_eq!(scrubbed.metrics(), plain.metrics());
}

#[test]
fn a_longer_sensor_range_than_the_planner_uses_changes_nothing() {
    for preset in Preset::ALL {
        let (mut near, mut far) = (trial_of(SCENARIO, preset), trial_of(SCENARIO, preset));
        for _ in 0..60 {
            near.tick();
            far.look_far();
            assert!(far.scan().points.len() > near.scan().points.len());
            far.plan();
            far.act();
        }
        assert_eq!(near.digest(), far.digest(), "{preset:?}");
    }
}

#[test]
fn on_a_pillar_the_far_returns_are_seen_for_want_of_near_ones() {
    let cells = 201;
    let on_pillar = |index: usize| {
        let (x, y) = ((index % cells) as f64 * 0.25 - 25.0, (index / cells) as f64 * 0.25 - 25.0);
        x.abs().max(y.abs()) < 1.1
    };
    let height_m = |index: usize| if on_pillar(index) { 0.0 } else { -4.0 };
    let field = HeightField::new(cells, cells, 0.25, (0..cells * cells).map(height_m).collect()).unwrap();
    let scenario = SCENARIO.replace("[4.0, 4.0, 0.2]", "[25.0, 25.0, 0.2]");
    let scenario = Scenario::parse("it", &scenario).unwrap();
    let mut near = Trial::new(field, &scenario, Preset::Default, 3).unwrap();
    let mut far = near.clone();
    near.look();
    far.look_far();
    assert!(far.scan().points.iter().all(|point| point.length() > 9.0));
    assert!(near.scan().points == far.scan().points, "a scan without returns is that of a blind sensor");
}

#[test]
fn a_copy_keeps_its_ground_when_the_other_is_sculpted() {
    let mut trial = trial(SCENARIO);
    let copy = trial.clone();
    let centre = DVec2::new(10.0, 10.0);
    let before_m = copy.field().height_m(centre);
    let brush = Brush { centre, radius_m: 2.0, strength_m: 1.0, kind: BrushKind::Raise };
    trial.sculpt(&brush).unwrap();
    assert_eq!(copy.field().height_m(centre), before_m);
    assert!(trial.field().height_m(centre) > before_m);
}

#[test]
fn waypoints_are_driven_to_one_after_the_other() {
    let mut trial = trial(&format!("{SCENARIO}waypoints = [[7.0, 7.0], [10.0, 8.0]]\n"));
    let mut passed = Vec::new();
    while trial.tick().is_none() {
        if trial.waypoints_passed() > passed.len() {
            passed.push(trial.pose().plan_m());
        }
    }
    assert_eq!(trial.outcome(), Some(Outcome::Reached));
    assert_eq!(passed.len(), 2);
    for (place, target) in passed.iter().zip([DVec2::new(7.0, 7.0), DVec2::new(10.0, 8.0)]) {
        assert!((*place - target).length() < 0.8, "{place} is not at {target}");
    }
    assert!((trial.pose().plan_m() - DVec2::new(9.0, 5.0)).length() < 0.8);

    let fault =
        trial.set_route(vec![DVec2::new(99.0, 1.0)], DVec2::new(5.0, 5.0), None).unwrap_err().to_string();
    assert!(fault.starts_with("waypoint = (99.000, 1.000) m: expected a place on the terrain"), "{fault}");
    assert_eq!(trial.waypoints_m().len(), 2);
    trial.set_start(trial.start()).unwrap();
    assert_eq!((trial.waypoints_passed(), trial.target_m()), (0, DVec2::new(7.0, 7.0)));
}

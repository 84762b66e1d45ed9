//! Where the ground ends, the robot does not drive on: no return comes from beyond an edge, and from above a
//! ledge looks like the plain.
#![allow(clippy::unwrap_used, missing_docs)]

use glam::DVec2;
use mapless_trials::{Outcome, Preset, Scenario, Trial};
use mapless_world::HeightField;

const SCENARIO: &str = "terrain = \"a.toml\"\nstart = [10.0, 20.0, 0.0]\ngoal = [33.0, 20.0]\nseed = 1\n";

/// 40 m square, with a height for each place.
fn trial(height_m: impl Fn(DVec2) -> f64, seed: u64) -> Trial {
    let (cells, cell_m) = (201, 0.2);
    let place_m = |index: usize| DVec2::new((index % cells) as f64, (index / cells) as f64) * cell_m;
    let heights_m = (0..cells * cells).map(|index| height_m(place_m(index)) as f32).collect();
    let field = HeightField::new(cells, cells, cell_m, heights_m).unwrap();
    let scenario = Scenario::parse("it", SCENARIO).unwrap();
    Trial::new(field, &scenario, Preset::Default, seed).unwrap()
}

fn outcome_within(trial: &mut Trial, seconds: u64) -> Option<Outcome> {
    (0..10 * seconds).find_map(|_| trial.tick())
}

/// Level ground that ends where `beyond_m` is above 0, with a fall of `depth_m` there. The goal lies beyond.
/// A robot that does not notice the fall is over it in a quarter of a minute; this one gets there, and drives
/// along it.
fn stays_before_the_fall(beyond_m: fn(DVec2) -> f64, depth_m: f64, seed: u64) {
    let mut trial = trial(|place| if beyond_m(place) > 0.0 { -depth_m } else { 0.0 }, seed);
    let mut nearest_m = f64::INFINITY;
    for _ in 0..300 {
        assert_eq!(trial.tick(), None, "seed {seed}");
        nearest_m = nearest_m.min(-beyond_m(trial.robot().position));
    }
    assert!((0.5..1.5).contains(&nearest_m), "seed {seed}: {nearest_m} m from the edge");
    assert!(trial.metrics().distance_m > 15.0, "seed {seed}");
}

#[test]
fn a_robot_does_not_drive_over_the_edge_of_an_abyss() {
    for seed in 1..=2 {
        stays_before_the_fall(|place| place.x - 20.0, 6.0, seed);
    }
    stays_before_the_fall(|place| (place - DVec2::new(20.0, 20.0)).dot(DVec2::new(0.86, 0.51)), 6.0, 1);
}

#[test]
fn a_robot_does_not_drive_over_a_ledge_whose_foot_it_sees() {
    for seed in 1..=2 {
        stays_before_the_fall(|place| place.x - 20.0, 1.0, seed);
    }
}

#[test]
fn a_robot_finds_the_ramp_down_a_ledge() {
    let ramp = |place: DVec2| {
        let on_ramp = (24.0..34.0).contains(&place.y);
        let level_m = if place.x < 20.0 { 0.0 } else { -3.0 };
        if on_ramp { (-0.25 * (place.x - 20.0)).clamp(-3.0, 0.0) } else { level_m }
    };
    assert_eq!(outcome_within(&mut trial(ramp, 1), 120), Some(Outcome::Reached));
}

#[test]
fn a_robot_drives_around_a_trench_whose_bottom_it_does_not_see() {
    let trench = |place: DVec2| if (20.0..22.5).contains(&place.x) && place.y < 30.0 { -3.0 } else { 0.0 };
    assert_eq!(outcome_within(&mut trial(trench, 1), 150), Some(Outcome::Reached));
}

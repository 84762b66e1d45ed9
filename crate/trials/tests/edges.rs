//! Where the ground ends, the robot does not drive on: no return comes from beyond an edge, and from above a ledge looks like the plain.
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

#[test]
fn a_robot_does_not_drive_over_the_edge_of_an_abyss() {
    let abyss = |place: DVec2| if place.x < 20.0 { 0.0 } else { -6.0 };
    let slanting = |place: DVec2| if place.x + 0.6 * place.y < 32.0 { 0.0 } else { -6.0 };
    for seed in 1..=2 {
        for mut trial in [trial(abyss, seed), trial(slanting, seed)] {
            // In this time it drives along the edge and on along that of the world.
            assert_eq!(outcome_within(&mut trial, 120), None, "seed {seed}");
            assert!(trial.metrics().distance_m > 50.0, "seed {seed}");
        }
    }
}

#[test]
fn a_robot_does_not_drive_over_a_ledge_whose_foot_it_sees() {
    let ledge = |place: DVec2| if place.x < 20.0 { 0.0 } else { -1.0 };
    for seed in 1..=3 {
        let mut trial = trial(ledge, seed);
        assert_eq!(outcome_within(&mut trial, 240), None, "seed {seed}");
        assert!(trial.metrics().distance_m > 100.0, "seed {seed}");
    }
}

#[test]
fn a_robot_finds_the_ramp_down_a_ledge() {
    let ramp = |place: DVec2| {
        let on_ramp = (24.0..34.0).contains(&place.y);
        let level_m = if place.x < 20.0 { 0.0 } else { -3.0 };
        if on_ramp { (-0.25 * (place.x - 20.0)).clamp(-3.0, 0.0) } else { level_m }
    };
    for seed in 1..=3 {
        assert_eq!(outcome_within(&mut trial(ramp, seed), 400), Some(Outcome::Reached), "seed {seed}");
    }
}

#[test]
fn a_robot_drives_around_a_trench_whose_bottom_it_does_not_see() {
    let trench = |place: DVec2| if (20.0..22.5).contains(&place.x) && place.y < 30.0 { -3.0 } else { 0.0 };
    for seed in 1..=3 {
        assert_eq!(outcome_within(&mut trial(trench, seed), 400), Some(Outcome::Reached), "seed {seed}");
    }
}

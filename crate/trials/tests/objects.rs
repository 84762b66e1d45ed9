//! What stands and walks on the ground, in a trial.
#![allow(clippy::unwrap_used, missing_docs)]

use mapless_trials::{Outcome, Preset, Scenario, Trial};
use mapless_world::HeightField;

const SCENARIO: &str = "terrain = \"a.toml\"\nstart = [10.0, 20.0, 0.0]\ngoal = [30.0, 20.0]\nseed = 1\n";

fn trial(objects: &str) -> Trial {
    trial_of(SCENARIO, objects)
}

/// Level ground, 40 m square, with these objects.
fn trial_of(scenario: &str, objects: &str) -> Trial {
    let field = HeightField::new(201, 201, 0.2, vec![0.0; 201 * 201]).unwrap();
    let scenario = Scenario::parse("it", &format!("{scenario}{objects}")).unwrap();
    Trial::new(field, &scenario, Preset::Default, 1).unwrap()
}

fn outcome_within(trial: &mut Trial, seconds: u64) -> Option<Outcome> {
    (0..10 * seconds).find_map(|_| trial.tick())
}

fn wall(from: [f64; 2], to: [f64; 2]) -> String {
    format!("[[objects]]\nkind = \"wall\"\nfrom = {from:?}\nto = {to:?}\nheight_m = 1.0\n")
}

#[test]
fn a_post_in_the_way_is_driven_around() {
    let mut trial =
        trial("[[objects]]\nkind = \"post\"\nat = [20.0, 20.0]\nradius_m = 0.15\nheight_m = 1.5\n");
    assert_eq!(outcome_within(&mut trial, 60), Some(Outcome::Reached), "{:?}", trial.end_reason());
}

#[test]
fn a_wall_is_driven_through_where_it_is_open() {
    let objects = wall([20.0, 5.0], [20.0, 22.0]) + &wall([20.0, 25.0], [20.0, 38.0]);
    let mut trial = trial(&objects);
    assert_eq!(outcome_within(&mut trial, 120), Some(Outcome::Reached), "{:?}", trial.end_reason());
}

#[test]
fn two_walls_are_passed_though_their_openings_do_not_lie_opposite() {
    // Ground between and behind the walls is hidden. It is no cliff, or the openings would be closed.
    let objects = [
        wall([20.0, 5.0], [20.0, 19.0]),
        wall([20.0, 21.0], [20.0, 38.0]),
        wall([21.1, 5.0], [21.1, 18.2]),
        wall([21.1, 20.2], [21.1, 38.0]),
    ];
    // From the second start, a path turns back on the spot between the walls.
    for start in ["[10.0, 20.0, 0.0]", "[12.0, 20.0, 0.0]"] {
        let mut trial = trial_of(&SCENARIO.replace("[10.0, 20.0, 0.0]", start), &objects.concat());
        assert_eq!(
            outcome_within(&mut trial, 45),
            Some(Outcome::Reached),
            "{start}: {:?}",
            trial.end_reason()
        );
    }
}

#[test]
fn a_collision_has_a_place_and_a_cause() {
    // Too thin to be seen in time: the planner sees no wire.
    let wire =
        "[[objects]]\nkind = \"box\"\nat = [20.0, 20.0]\nsize_m = [0.002, 30.0, 0.02]\nraised_m = 0.3\n";
    let mut trial = trial(wire);
    assert_eq!(outcome_within(&mut trial, 60), Some(Outcome::Collision));
    let reason = trial.end_reason().unwrap();
    assert!(reason.starts_with("the body ran into box 1 at (20.0"), "{reason}");
}

#[test]
fn objects_of_the_scenario_replace_those_of_the_terrain() {
    let own = "[[objects]]\nkind = \"rock\"\nat = [20.0, 30.0]\nradius_m = 0.4\n";
    let of_terrain = Scenario::parse("it", &format!("{SCENARIO}{own}")).unwrap().objects.unwrap();
    let bare = Scenario::parse("it", SCENARIO).unwrap();
    assert_eq!(bare.clone().on_terrain(&of_terrain).objects.unwrap(), of_terrain);
    let none = Scenario::parse("it", &format!("objects = []\n{SCENARIO}")).unwrap();
    assert_eq!(none.on_terrain(&of_terrain).objects.unwrap(), []);
}

#[test]
fn an_object_out_of_its_range_is_an_error_with_its_place() {
    let bad = "[[objects]]\nkind = \"post\"\nat = [20.0, 20.0]\nradius_m = -1.0\nheight_m = 1.5\n";
    let error = Scenario::parse("it", &format!("{SCENARIO}{bad}")).unwrap_err().to_string();
    assert_eq!(error, "it: objects[1].radius_m = -1: expected a number from 0.001 to 100");
    let unknown = Scenario::parse("it", &format!("{SCENARIO}[[objects]]\nkind = \"tree\"\n")).unwrap_err();
    assert!(
        unknown.to_string().contains("unknown variant `tree`, expected one of `post`, `box`"),
        "{unknown}"
    );
}

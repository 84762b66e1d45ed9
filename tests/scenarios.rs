//! Every scenario is worth a trial: driving straight at its goal fails, and a safe way there exists.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use glam::DVec2;
use mapless_trials::LoadedScenario;
use mapless_world::{DriveCommand, HeightField, Husky, HuskyConfig, attitude_on, load_terrain};
use pathfinding::directed::astar::astar;

const SCENARIOS: [&str; 10] =
    ["cht-ab", "cht-ac", "cht-ad", "cht-ae", "cht-ba", "cht-bd", "gsb", "ht", "ml", "vta"];
const TERRAINS: [&str; 5] = ["cht", "gsb", "ht", "ml", "vta"];

fn terrains() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../terrains")
}

/// Every scenario, loaded once for all tests.
static LOADED: LazyLock<Vec<LoadedScenario>> = LazyLock::new(|| {
    let load = |name| {
        let path = terrains().join("scenarios").join(name).with_extension("toml");
        LoadedScenario::read(&path).unwrap_or_else(|error| panic!("{error}"))
    };
    SCENARIOS.map(load).into()
});

fn loaded() -> impl Iterator<Item = (&'static str, &'static LoadedScenario)> {
    SCENARIOS.into_iter().zip(LOADED.iter())
}

/// Names of the recipes or scenarios in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut names: Vec<String> = entries
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn all_are_there() {
    assert_eq!(names(&terrains().join("scenarios")), SCENARIOS);
    assert_eq!(names(&terrains()), TERRAINS);
}

#[test]
fn a_recipe_gives_the_same_bits_twice() {
    for name in TERRAINS {
        let bits = || -> Vec<u32> {
            let terrain = load_terrain(&terrains().join(name).with_extension("toml")).unwrap();
            terrain.field.heights_m().iter().map(|height| height.to_bits()).collect()
        };
        assert!(bits() == bits(), "{name}");
    }
}

/// The same letter is the same place in every route of the Challenging Hilly Terrain.
#[test]
fn routes_share_their_places() {
    let scenario = |wanted| &loaded().find(|(name, _)| *name == wanted).unwrap().1.scenario;
    let start = |name| scenario(name).start.position_m;
    let goal = |name| scenario(name).goal_m;
    let (a, b, d) = (start("cht-ab"), goal("cht-ab"), goal("cht-ad"));
    for name in ["cht-ac", "cht-ad", "cht-ae"] {
        assert_eq!(start(name), a, "{name}");
    }
    assert_eq!((start("cht-ba"), goal("cht-ba")), (b, a));
    assert_eq!((start("cht-bd"), goal("cht-bd")), (b, d));
}

const MOTION_STEP_S: f64 = 0.02;
const SPEED_M_S: f64 = 0.8;
const GOAL_TOLERANCE_M: f64 = 0.5;

/// Drives straight at the goal; gives where and why that ended, or `None` at the goal.
fn drive_straight(field: &HeightField, start: DVec2, heading_rad: f64, goal: DVec2) -> Option<String> {
    let config = HuskyConfig::default();
    let mut husky = Husky::new(config.clone(), field, start, heading_rad).unwrap();
    let patience = 3.0 * start.distance(goal) / SPEED_M_S / MOTION_STEP_S;
    for _ in 0..patience as usize {
        let state = *husky.state();
        let way = goal - state.position;
        if way.length() <= GOAL_TOLERANCE_M {
            return None;
        }
        let turn_rad = libm::remainder(libm::atan2(way.y, way.x) - state.yaw_rad, TAU);
        let command = DriveCommand {
            speed_m_s: if turn_rad.abs() < 0.8 { SPEED_M_S } else { 0.0 },
            turn_rate_rad_s: (1.5 * turn_rad).clamp(-1.0, 1.0),
        };
        if husky.step(command, MOTION_STEP_S, field).is_err() {
            return Some(format!("left the terrain at {}", state.position));
        }
        let tilt = husky.state().attitude;
        if tilt.roll_rad.abs() > config.roll_limit_rad || tilt.pitch_rad.abs() > config.pitch_limit_rad {
            return Some(format!("tilted too far at {}", state.position));
        }
    }
    panic!("neither arrived nor failed");
}

#[test]
fn driving_straight_at_the_goal_fails() {
    for (name, LoadedScenario { scenario, terrain }) in loaded() {
        let start = scenario.start;
        let end = drive_straight(&terrain.field, start.position_m, start.heading_rad, scenario.goal_m);
        assert!(end.is_some(), "{name}: reached its goal straight on");
    }
}

/// Places the search may stand on.
const GRID_M: f64 = 0.5;
const MAX_ROLL_RAD: f64 = 0.40;
const MAX_PITCH_RAD: f64 = 0.45;
const MAX_INCLINATION_RAD: f64 = 0.42;

/// Neighbours of a place: every direction a knight or a king moves in.
const MOVES: [(i32, i32); 16] = [
    (1, 0),
    (2, 1),
    (1, 1),
    (1, 2),
    (0, 1),
    (-1, 2),
    (-1, 1),
    (-2, 1),
    (-1, 0),
    (-2, -1),
    (-1, -1),
    (-1, -2),
    (0, -1),
    (1, -2),
    (1, -1),
    (2, -1),
];

/// Whether a Husky may drive from one place to another, by its standing tilt at both ends and half way.
fn safe(field: &HeightField, robot: &HuskyConfig, from: DVec2, to: DVec2) -> bool {
    let way = to - from;
    let yaw_rad = libm::atan2(way.y, way.x);
    [from, from.midpoint(to), to].into_iter().all(|place| {
        attitude_on(field, place, yaw_rad, robot).is_some_and(|tilt| {
            let inclination_rad = libm::acos(libm::cos(tilt.pitch_rad) * libm::cos(tilt.roll_rad));
            tilt.roll_rad.abs() < MAX_ROLL_RAD
                && tilt.pitch_rad.abs() < MAX_PITCH_RAD
                && inclination_rad < MAX_INCLINATION_RAD
        })
    })
}

/// Length of the shortest safe way on a grid.
fn safe_way_m(field: &HeightField, start: DVec2, goal: DVec2) -> Option<f64> {
    let robot = HuskyConfig::default();
    let place = |(x, y): (i32, i32)| DVec2::new(f64::from(x), f64::from(y)) * GRID_M;
    let node = |place: DVec2| ((place.x / GRID_M).round() as i32, (place.y / GRID_M).round() as i32);
    // Whole millimetres, because the search needs an exact order.
    let millimetres = |a, b| (place(a).distance(place(b)) * 1e3).ceil() as u64;
    let goal = node(goal);
    let (_, length) = astar(
        &node(start),
        |&here| {
            let neighbours = MOVES.map(|(x, y)| (here.0 + x, here.1 + y));
            neighbours
                .into_iter()
                .filter(|&there| safe(field, &robot, place(here), place(there)))
                .map(|there| (there, millimetres(here, there)))
                .collect::<Vec<_>>()
        },
        |&here| millimetres(here, goal),
        |&here| here == goal,
    )?;
    Some(length as f64 / 1e3)
}

#[test]
fn a_safe_way_to_the_goal_exists() {
    for (name, LoadedScenario { scenario, terrain }) in loaded() {
        let (start, goal) = (scenario.start.position_m, scenario.goal_m);
        let length_m =
            safe_way_m(&terrain.field, start, goal).unwrap_or_else(|| panic!("{name}: no safe way"));
        println!("{name}: {length_m:.1} m, straight {:.1} m", start.distance(goal));
        assert!(length_m < 1.5 * start.distance(goal), "{name}: a detour of {length_m} m");
    }
}

/// Start and goal are places to stand on, away from the border.
#[test]
fn start_and_goal_are_nearly_level() {
    for (name, LoadedScenario { scenario, terrain }) in loaded() {
        for (what, centre) in [("start", scenario.start.position_m), ("goal", scenario.goal_m)] {
            let inside = centre.min_element().min((terrain.field.extent_m() - centre).min_element());
            assert!(inside >= 5.0, "{name}: {what} is {inside} m from the border");
            for step in 0..625 {
                let offset = (DVec2::new(f64::from(step % 25), f64::from(step / 25)) - 12.0) * 0.25;
                if offset.length() <= 3.0 {
                    let tilt =
                        attitude_on(&terrain.field, centre + offset, 0.0, &HuskyConfig::default()).unwrap();
                    let inclination_rad = libm::acos(libm::cos(tilt.pitch_rad) * libm::cos(tilt.roll_rad));
                    assert!(
                        inclination_rad < 0.15,
                        "{name}: {inclination_rad} rad near the {what}, at {offset}"
                    );
                }
            }
        }
    }
}

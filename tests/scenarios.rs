//! Every scenario is a real task: driving straight at its goal fails, and a safe path exists.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use glam::DVec2;
use mapless_baselines::{KnownWorld, NavigatorKind, OracleConfig, PlanPose, shortest_path};
use mapless_tests::scenarios_text;
use mapless_trials::{LoadedScenario, Outcome, Preset, Scenario, Trial};
use mapless_world::{RobotConfig, attitude_on};

fn terrains() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../terrains")
}

/// Every scenario of the repository by its name, loaded once for all tests.
static LOADED: LazyLock<BTreeMap<String, LoadedScenario>> = LazyLock::new(|| {
    let files = std::fs::read_dir(terrains().join("scenarios")).unwrap().map(|entry| entry.unwrap().path());
    files
        .map(|path| {
            let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
            (name, LoadedScenario::read(&path).unwrap_or_else(|error| panic!("{error}")))
        })
        .collect()
});

/// A scenario without a recorded trajectory would be compared on no target.
#[test]
fn every_scenario_is_bundled_with_its_digest() {
    let bundled: Vec<&str> = scenarios_text::SCENARIOS.iter().map(|scenario| scenario.name).collect();
    let digests: BTreeMap<String, String> = toml::from_str(scenarios_text::DIGESTS).unwrap();
    let names: Vec<&str> = LOADED.keys().map(String::as_str).collect();
    assert_eq!(bundled, names);
    assert_eq!(digests.keys().collect::<Vec<_>>(), names);
}

/// The same letter is the same place in every route of the Challenging Hilly Terrain.
#[test]
fn routes_share_their_places() {
    let scenario = |name| &LOADED[name].scenario;
    let start = |name| scenario(name).start.position_m;
    let goal = |name| scenario(name).goal_m;
    let (a, b, d) = (start("cht-ab"), goal("cht-ab"), goal("cht-ad"));
    for name in ["cht-ac", "cht-ad", "cht-ae"] {
        assert_eq!(start(name), a, "{name}");
    }
    assert_eq!((start("cht-ba"), goal("cht-ba")), (b, a));
    assert_eq!((start("cht-bd"), goal("cht-bd")), (b, d));
}

#[test]
fn driving_straight_at_the_goal_fails() {
    for (name, LoadedScenario { scenario, terrain }) in LOADED.iter() {
        let straight = NavigatorKind::Direct.build(&terrain.field, scenario, 1).unwrap();
        let mut trial = Trial::with_navigator(terrain.field.clone(), scenario, straight, 1).unwrap();
        while trial.tick().is_none() {}
        assert_ne!(trial.outcome(), Some(Outcome::Reached), "{name}");
    }
}

#[test]
fn a_safe_path_to_the_goal_exists() {
    for (name, LoadedScenario { scenario, terrain }) in LOADED.iter() {
        let Scenario { start, goal_m, .. } = scenario;
        let from = PlanPose { position_m: start.position_m, yaw_rad: start.heading_rad };
        let path = shortest_path(
            &KnownWorld::new(&terrain.field, scenario),
            from,
            *goal_m,
            &OracleConfig::default(),
        );
        let length_m = path.unwrap_or_else(|error| panic!("{name}: {error}")).length_m;
        let straight_m = from.position_m.distance(*goal_m);
        assert!(length_m < 1.5 * straight_m, "{name}: a detour of {length_m} m");
    }
}

/// Start and goal are safe places, away from the border.
#[test]
fn start_and_goal_are_nearly_level() {
    for (name, LoadedScenario { scenario, terrain }) in LOADED.iter() {
        for (what, centre) in [("start", scenario.start.position_m), ("goal", scenario.goal_m)] {
            let inside = centre.min_element().min((terrain.field.extent_m() - centre).min_element());
            assert!(inside >= 5.0, "{name}: {what} is {inside} m from the border");
            for step in 0..625 {
                let offset = (DVec2::new(f64::from(step % 25), f64::from(step / 25)) - 12.0) * 0.25;
                if offset.length() <= 3.0 {
                    let tilt =
                        attitude_on(&terrain.field, centre + offset, 0.0, &RobotConfig::default()).unwrap();
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

#[test]
fn the_optimised_trajectory_is_as_long_as_under_pid_and_much_smoother() {
    let text = std::fs::read_to_string(terrains().join("scenarios/ht.toml")).unwrap();
    let metrics = |law: &str| {
        let text = format!("{text}\n[planner.controller]\nfollowing = \"{law}\"\n");
        let scenario = Scenario::parse("ht", &text).unwrap();
        let mut trial =
            Trial::new(LOADED["ht"].terrain.field.clone(), &scenario, Preset::Default, 1).unwrap();
        while trial.tick().is_none() {}
        assert_eq!(trial.outcome(), Some(Outcome::Reached), "{law}");
        trial.metrics()
    };
    let (pid, optimised) = (metrics("pid"), metrics("receding_horizon"));
    assert!(optimised.distance_m < 1.05 * pid.distance_m, "{optimised:?}, {pid:?}");
    assert!(3.0 * optimised.curvature_change_rad_m < pid.curvature_change_rad_m, "{optimised:?}, {pid:?}");
}

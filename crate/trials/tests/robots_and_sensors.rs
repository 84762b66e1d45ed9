//! Other sensors and other robots drive the paper's scenarios to the goal.
#![allow(clippy::unwrap_used, missing_docs)]

use core::f64::consts::PI;
use core::time::Duration;
use std::path::Path;

use glam::Vec3;
use mapless::{Goal, Planner, Pose};
use mapless_trials::{Decision, LoadedScenario, Navigator, Outcome, Preset, Trial};
use mapless_world::random::key;
use mapless_world::{RobotConfig, SensorConfig};
use rayon::prelude::*;

/// A sensor with so many rings from one elevation to another.
fn rings(rings: usize, lowest_deg: f64, highest_deg: f64) -> SensorConfig {
    SensorConfig {
        rings,
        lowest_elevation_rad: lowest_deg.to_radians(),
        highest_elevation_rad: highest_deg.to_radians(),
        // Many rings with the columns of a VLP-16 would take long to simulate; one in a degree suffices.
        columns: if rings > 16 { 360 } else { 1800 },
        ..SensorConfig::default()
    }
}

fn variants() -> Vec<(&'static str, SensorConfig, RobotConfig)> {
    let vlp16 = SensorConfig::default;
    let husky = RobotConfig::husky;
    let tilt_rad = 15_f64.to_radians();
    vec![
        ("8 rings", rings(8, -15.0, 15.0), husky()),
        ("32 rings", rings(32, -25.0, 15.0), husky()),
        ("64 rings", rings(64, -24.9, 2.0), husky()),
        ("128 rings", rings(128, -22.5, 22.5), husky()),
        ("32 rings over 90°", rings(32, -45.0, 45.0), husky()),
        ("0.4 m up", SensorConfig { height_m: 0.4, ..vlp16() }, husky()),
        ("1.7 m up", SensorConfig { height_m: 1.7, ..vlp16() }, husky()),
        ("nose-down", SensorConfig { pitch_rad: -tilt_rad, ..vlp16() }, husky()),
        ("rolled", SensorConfig { roll_rad: tilt_rad, ..vlp16() }, husky()),
        (
            "upside down",
            SensorConfig { roll_rad: PI, yaw_rad: 1.0, left_m: 0.1, ..rings(32, -15.0, 25.0) },
            husky(),
        ),
        ("20 scans a second", SensorConfig { period_s: 0.05, columns: 900, ..vlp16() }, husky()),
        ("5 scans a second", SensorConfig { period_s: 0.2, ..vlp16() }, husky()),
        ("Jackal", vlp16(), RobotConfig::jackal()),
        ("Warthog", vlp16(), RobotConfig::warthog()),
    ]
}

fn load(name: &str) -> LoadedScenario {
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../terrains/scenarios");
    LoadedScenario::read(&scenarios.join(format!("{name}.toml"))).unwrap()
}

/// Scenarios whose goals are moved to about half their ways, which halves the time of a drive.
const HALFWAY: [(&str, [f64; 2]); 2] = [("gsb", [32.0, 14.5]), ("ht", [24.0, 10.0])];

fn halfway() -> [(&'static str, LoadedScenario); 2] {
    HALFWAY.map(|(name, goal_m)| {
        let mut loaded = load(name);
        loaded.scenario.goal_m = goal_m.into();
        (name, loaded)
    })
}

/// Drives a scenario to its end; gives the trial.
fn drive(loaded: &LoadedScenario, sensor: &SensorConfig, robot: &RobotConfig) -> Trial {
    let mut scenario = loaded.scenario.clone();
    (scenario.sensor, scenario.robot) = (sensor.clone(), robot.clone());
    let seed = scenario.seed;
    let mut trial = Trial::new(loaded.terrain.field.clone(), &scenario, Preset::Default, seed).unwrap();
    while trial.tick().is_none() {}
    trial
}

#[test]
fn each_drives_to_the_goal_within_its_tilt_limits() {
    let (variants, scenarios) = (variants(), halfway());
    let failure = |(index, (name, sensor, robot)): (usize, &(&str, SensorConfig, RobotConfig))| {
        // Each on one of the two, in turn.
        let (scenario, loaded) = &scenarios[index % scenarios.len()];
        let trial = drive(loaded, sensor, robot);
        let metrics = trial.metrics();
        let is_within = metrics.max_abs_roll_rad < robot.roll_limit_rad
            && metrics.max_abs_pitch_rad < robot.pitch_limit_rad;
        let is_well = trial.outcome() == Some(Outcome::Reached) && is_within;
        (!is_well).then(|| format!("{name} on {scenario}: {:?}, {metrics:?}", trial.outcome()))
    };
    let failures: Vec<String> = variants.par_iter().enumerate().filter_map(failure).collect();
    assert!(failures.is_empty(), "{failures:#?}");
}

/// The planner with the points of each scan in an order of their own.
struct Shuffled {
    planner: Planner,
    points_m: Vec<Vec3>,
    scans: u64,
}

impl Navigator for Shuffled {
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal: &Goal, elapsed: Duration) -> Decision {
        self.scans += 1;
        self.points_m.clear();
        self.points_m.extend_from_slice(points_m);
        for last in (1..points_m.len()).rev() {
            let other = key(self.scans, last as u64) % (last as u64 + 1);
            self.points_m.swap(last, other as usize);
        }
        self.planner.navigate(&self.points_m, pose, goal, elapsed)
    }

    fn sight_m(&self) -> f64 {
        self.planner.sight_m()
    }

    fn max_speed_m_s(&self) -> f64 {
        self.planner.max_speed_m_s()
    }

    fn reset(&mut self) {
        Planner::reset(&mut self.planner);
    }
}

#[test]
fn the_points_of_a_scan_may_come_in_any_order() {
    let [_, (_, LoadedScenario { scenario, terrain })] = halfway();
    let planner = Planner::new(scenario.planner_config(Preset::Default).unwrap()).unwrap();
    let shuffled = Shuffled { planner, points_m: Vec::new(), scans: 0 };
    let mut trial = Trial::with_navigator(terrain.field, &scenario, shuffled, scenario.seed).unwrap();
    while trial.tick().is_none() {}
    assert_eq!(trial.outcome(), Some(Outcome::Reached));
}

#[test]
fn a_goal_with_a_heading_is_reached_with_it() {
    let LoadedScenario { mut scenario, terrain } = load("gsb");
    scenario.goal_heading_rad = Some(2.0);
    let mut trial = Trial::new(terrain.field, &scenario, Preset::Default, scenario.seed).unwrap();
    while trial.tick().is_none() {}
    assert_eq!(trial.outcome(), Some(Outcome::Reached));
    let turn_rad = (trial.robot().yaw_rad - 2.0).rem_euclid(2.0 * PI);
    assert!(turn_rad.min(2.0 * PI - turn_rad) < 0.1, "{turn_rad}");
}

/// The planner that gets no more than every third scan.
struct Dropping {
    planner: Planner,
    since: Duration,
    last: Option<Decision>,
    scans: u32,
}

impl Navigator for Dropping {
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal: &Goal, elapsed: Duration) -> Decision {
        self.since += elapsed;
        self.scans += 1;
        if let Some(last) = self.last.filter(|_| !self.scans.is_multiple_of(3)) {
            return last;
        }
        let decision = self.planner.navigate(points_m, pose, goal, std::mem::take(&mut self.since));
        self.last = Some(decision);
        decision
    }

    fn sight_m(&self) -> f64 {
        self.planner.sight_m()
    }

    fn max_speed_m_s(&self) -> f64 {
        self.planner.max_speed_m_s()
    }

    fn reset(&mut self) {
        Planner::reset(&mut self.planner);
    }
}

#[test]
fn dropped_scans_are_time_that_passed() {
    let LoadedScenario { scenario, terrain } = load("gsb");
    let planner = Planner::new(scenario.planner_config(Preset::Default).unwrap()).unwrap();
    let dropping = Dropping { planner, since: Duration::ZERO, last: None, scans: 0 };
    let mut trial = Trial::with_navigator(terrain.field, &scenario, dropping, scenario.seed).unwrap();
    while trial.tick().is_none() {}
    assert_eq!(trial.outcome(), Some(Outcome::Reached));
}

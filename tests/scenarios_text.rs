//! The scenarios of the repository as text, so that they run where there are no files, and their trajectory
//! digests.

use std::collections::BTreeMap;

use mapless_trials::{Outcome, Preset, RealityPreset, Scenario, Trial};
use mapless_world::RobotConfig;

/// A scenario with its terrain.
#[derive(Clone, Copy, Debug)]
pub struct Bundled {
    /// Name of the scenario file, without extension.
    pub name: &'static str,
    scenario: &'static str,
    terrain: &'static str,
}

macro_rules! bundled {
    ($($name:literal on $terrain:literal),* $(,)?) => {
        [$(Bundled {
            name: $name,
            scenario: include_str!(concat!("../terrains/scenarios/", $name, ".toml")),
            terrain: include_str!(concat!("../terrains/", $terrain, ".toml")),
        }),*]
    };
}

/// Every scenario under `terrains/scenarios/`.
pub const SCENARIOS: [Bundled; 10] = bundled![
    "cht-ab" on "cht", "cht-ac" on "cht", "cht-ad" on "cht", "cht-ae" on "cht", "cht-ba" on "cht",
    "cht-bd" on "cht", "gsb" on "gsb", "ht" on "ht", "ml" on "ml", "vta" on "vta",
];

/// Digests of the trajectories with the preset `default` and the scenario's own seed, by scenario.
pub const DIGESTS: &str = include_str!("digests.toml");

/// The same in the world of the reality preset `field`, of two routes.
pub const FIELD_DIGESTS: &str = include_str!("field_digests.toml");

impl Bundled {
    /// A trial ready to run, with the preset `default` and the scenario's own seed.
    ///
    /// # Errors
    /// What is wrong with the files.
    pub fn trial(&self) -> Result<Trial, String> {
        self.trial_in(RealityPreset::Ideal)
    }

    /// As [`Bundled::trial`], in a world that is as hard as `reality` says.
    ///
    /// # Errors
    /// What is wrong with the files.
    pub fn trial_in(&self, reality: RealityPreset) -> Result<Trial, String> {
        let mut scenario = Scenario::parse(self.name, self.scenario).map_err(|e| e.to_string())?;
        scenario.reality = reality.config();
        let terrain =
            mapless_terrain::load_recipe(&scenario.terrain, self.terrain.as_bytes(), &mut |_, _| {
                Err(mapless_terrain::Fault::Read { reason: "not bundled".to_owned() })
            })
            .map_err(|e| e.to_string())?;
        let seed = scenario.seed;
        Trial::new(terrain.field, &scenario, Preset::Default, seed).map_err(|e| e.to_string())
    }

    /// Drives the trial to its end.
    ///
    /// # Errors
    /// What is wrong with the files.
    pub fn drive(&self) -> Result<Trial, String> {
        self.drive_in(RealityPreset::Ideal)
    }

    /// As [`Bundled::drive`], in a world that is as hard as `reality` says.
    ///
    /// # Errors
    /// What is wrong with the files.
    pub fn drive_in(&self, reality: RealityPreset) -> Result<Trial, String> {
        let mut trial = self.trial_in(reality)?;
        while trial.tick().is_none() {}
        Ok(trial)
    }

    /// Drives the trial in the world of `field` and compares its digest with the recorded one.
    ///
    /// # Errors
    /// What is another.
    pub fn check_in_the_field(&self) -> Result<(), String> {
        let trial = self.drive_in(RealityPreset::Field)?;
        self.compare(FIELD_DIGESTS, &trial)
    }

    /// Drives the trial and compares how it went: the goal reached within the limits of tilt, over a path of
    /// a possible length, with the recorded digest.
    ///
    /// # Errors
    /// What is another.
    pub fn check(&self) -> Result<(), String> {
        let trial = self.drive()?;
        if trial.outcome() != Some(Outcome::Reached) {
            return Err(format!("{}: {:?} instead of reached", self.name, trial.outcome()));
        }
        let (metrics, robot) = (trial.metrics(), RobotConfig::default());
        let straight_m = trial.start().position_m.distance(trial.goal_m());
        let is_possible = metrics.max_abs_roll_rad <= robot.roll_limit_rad
            && metrics.max_abs_pitch_rad <= robot.pitch_limit_rad
            && (straight_m - 1.0..2.0 * straight_m).contains(&metrics.distance_m);
        if !is_possible {
            return Err(format!("{}: {straight_m} m to the goal, {metrics:?}", self.name));
        }
        self.compare(DIGESTS, &trial)
    }

    fn compare(&self, digests: &str, trial: &Trial) -> Result<(), String> {
        let recorded: BTreeMap<String, String> = toml::from_str(digests).map_err(|e| e.to_string())?;
        match recorded.get(self.name) {
            Some(expected) if *expected == trial.digest() => Ok(()),
            expected => Err(format!("{}: digest {}, recorded {expected:?}", self.name, trial.digest())),
        }
    }
}

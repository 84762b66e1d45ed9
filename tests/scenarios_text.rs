//! The scenarios of the repository as text, so that they run where there are no files, and their trajectory digests.

use std::collections::BTreeMap;

use mapless_trials::{Outcome, Preset, Scenario, Trial};

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

impl Bundled {
    /// A trial ready to run, with the preset `default` and the scenario's own seed.
    ///
    /// # Errors
    /// What is wrong with the files.
    pub fn trial(&self) -> Result<Trial, String> {
        let scenario = Scenario::parse(self.name, self.scenario).map_err(|e| e.to_string())?;
        let terrain =
            mapless_terrain::load_terrain_bytes(&scenario.terrain, self.terrain.as_bytes(), &mut |file| {
                Err(format!("{file}: not bundled"))
            })
            .map_err(|e| e.to_string())?;
        let seed = scenario.seed;
        Trial::new(terrain.field, &scenario, Preset::Default, seed).map_err(|e| e.to_string())
    }

    /// Runs the trial to its end; gives outcome and digest.
    ///
    /// # Errors
    /// What is wrong with the files.
    pub fn run(&self) -> Result<(Outcome, String), String> {
        let mut trial = self.trial()?;
        loop {
            if let Some(outcome) = trial.tick() {
                return Ok((outcome, trial.digest()));
            }
        }
    }

    /// Runs the trial and compares its digest with the recorded one.
    ///
    /// # Errors
    /// Another outcome than `reached`, or another digest.
    pub fn check(&self) -> Result<(), String> {
        let recorded: BTreeMap<String, String> = toml::from_str(DIGESTS).map_err(|e| e.to_string())?;
        let (outcome, digest) = self.run()?;
        if outcome != Outcome::Reached {
            return Err(format!("{}: {} instead of reached", self.name, outcome.name()));
        }
        match recorded.get(self.name) {
            Some(expected) if *expected == digest => Ok(()),
            expected => Err(format!("{}: digest {digest}, recorded {expected:?}", self.name)),
        }
    }
}

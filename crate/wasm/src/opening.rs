//! What a session is opened with.

use mapless::gp::learning::LearningMode;
use mapless_trials::Scenario;
use serde::{Deserialize, Serialize};
use toml::Table;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::objects::ObjectList;
use crate::places::{Goal, Heading, Place};
use crate::shared::{Overrides, give};
use crate::terrain::TerrainFiles;

/// All that a session is opened with.
#[derive(Debug, Deserialize, Tsify)]
pub struct SessionOptions {
    pub(crate) scenario: TextFile,
    pub(crate) terrain: TerrainFiles,
    pub(crate) preset: Preset,
    /// The scenario's own without it.
    #[tsify(optional)]
    pub(crate) learning: Option<Learning>,
    /// The scenario's own without it.
    #[tsify(optional)]
    pub(crate) seed: Option<u64>,
    /// Set from the beginning: see `Session.set_parameters`.
    #[tsify(optional)]
    pub(crate) overrides: Option<Overrides>,
}

/// A file by its name, which messages about it begin with.
#[derive(Debug, Deserialize, Tsify)]
pub struct TextFile {
    pub(crate) name: String,
    pub(crate) text: String,
}

/// `default` is the best mapless planner known to the project, `paper` the literal text of the paper.
#[derive(Clone, Copy, Debug, Deserialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// The best mapless planner known to the project.
    Default,
    /// The paper read literally.
    Paper,
}

impl From<Preset> for mapless_trials::Preset {
    fn from(preset: Preset) -> Self {
        match preset {
            Preset::Default => Self::Default,
            Preset::Paper => Self::Paper,
        }
    }
}

/// When the planner learns the hyperparameters of its Gaussian process.
#[derive(Clone, Copy, Debug, Deserialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum Learning {
    /// Never: they are those of the configuration.
    Fixed,
    /// From the first scan.
    Once,
    /// From every scan.
    EveryScan,
}

impl From<Learning> for LearningMode {
    fn from(learning: Learning) -> Self {
        match learning {
            Learning::Fixed => Self::Fixed,
            Learning::Once => Self::Once,
            Learning::EveryScan => Self::EveryScan,
        }
    }
}

/// What a checked scenario file says.
#[derive(Debug, Serialize, Tsify)]
#[tsify(hashmap_as_object)]
pub struct ScenarioRead {
    terrain: String,
    start: Heading,
    waypoints: Vec<Place>,
    goal: Goal,
    seed: f64,
    /// Its tables `planner`, `sensor`, `robot` and `reality` as written, where they are there.
    overrides: Overrides,
    /// Absent where the scenario stands on what its terrain lists.
    #[tsify(optional)]
    objects: Option<ObjectList>,
}

/// Reads a scenario file.
///
/// # Errors
/// The scenario's fault, with file, place, value and expectation.
#[wasm_bindgen]
pub fn read_scenario(file: &str, text: &str) -> Result<Ts<ScenarioRead>, JsError> {
    let scenario = Scenario::parse(file, text)?;
    let mut written: Table = mapless_toml::from_str(text)?;
    written.retain(|key, _| ["planner", "sensor", "robot", "reality"].contains(&key));
    give(&ScenarioRead {
        terrain: scenario.terrain,
        start: scenario.start.into(),
        waypoints: scenario.waypoints_m.into_iter().map(Place::from).collect(),
        goal: Goal::new(scenario.goal_m, scenario.goal_heading_rad),
        seed: scenario.seed as f64,
        overrides: Overrides(written),
        objects: scenario.objects.map(ObjectList),
    })
}

//! Whole trials of every navigator, for the page's ghosts and batches, and generated tasks. A module of its own: the page opens without it.

#[path = "../../wasm/src/panic.rs"]
mod panic;

use mapless_baselines::{NavigatorKind, Task};
use mapless_trials::{Navigator, Scenario, Trial, statistics};
use mapless_world::HeightField;
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// Runs once when the page loads the module.
#[wasm_bindgen(start)]
pub fn start() {
    panic::install_hook();
}

/// The names of all navigators.
#[wasm_bindgen]
pub fn planners() -> Vec<String> {
    NavigatorKind::ALL.iter().map(|kind| kind.name().to_owned()).collect()
}

/// The generated task of a name such as `hard-1-0007`: its scenario file, whose terrain is at `terrain.toml`, and the recipe of that.
///
/// # Errors
/// What names no task; a task that the oracle cannot solve however often it is drawn.
#[wasm_bindgen]
pub fn generated_task(name: &str) -> Result<Vec<String>, JsError> {
    let task = Task::generate(name.parse()?)?;
    Ok(vec![task.scenario("terrain.toml"), task.recipe])
}

/// Wilson's 95 % interval of the rate behind `successes` of `trials`.
#[wasm_bindgen]
pub fn wilson(successes: usize, trials: usize) -> Vec<f64> {
    let (low, high) = statistics::wilson(successes, trials);
    vec![low, high]
}

/// Mean and sample standard deviation; NaN where there is none.
#[wasm_bindgen]
pub fn mean_and_deviation(values: &[f64]) -> Vec<f64> {
    let (mean, deviation) = statistics::mean_and_deviation(values).unwrap_or((f64::NAN, None));
    vec![mean, deviation.unwrap_or(f64::NAN)]
}

/// The ground that trials run on, as the page has it now.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Ground {
    field: HeightField,
}

#[wasm_bindgen]
impl Ground {
    /// A height field, row by row from the south-west.
    ///
    /// # Errors
    /// Heights that make no field.
    #[wasm_bindgen(constructor)]
    pub fn new(columns: usize, rows: usize, cell_m: f64, heights_m: Vec<f32>) -> Result<Ground, JsError> {
        Ok(Ground { field: HeightField::new(columns, rows, cell_m, heights_m)? })
    }
}

/// One trial of one navigator.
#[wasm_bindgen]
#[allow(missing_debug_implementations)]
pub struct Runner {
    trial: Trial<Box<dyn Navigator>>,
}

#[wasm_bindgen]
impl Runner {
    /// Puts the scenario's robot on the ground with the navigator of the name `planner`; `parameters` is TOML with nothing
    /// but `[planner]`, `[sensor]` and `[robot]`.
    ///
    /// # Errors
    /// A fault in the scenario or a value that makes no sense, with its place and what was expected.
    #[wasm_bindgen(constructor)]
    pub fn new(
        ground: &Ground,
        scenario_file: &str,
        scenario_toml: &str,
        parameters: &str,
        planner: &str,
        seed: u64,
    ) -> Result<Runner, JsError> {
        let scenario =
            Scenario::parse(scenario_file, scenario_toml)?.with_parameters("settings", parameters)?;
        let kind: NavigatorKind = planner.parse()?;
        let navigator = kind.build(&ground.field, &scenario, seed)?;
        Ok(Runner { trial: Trial::with_navigator(ground.field.clone(), &scenario, navigator, seed)? })
    }

    /// One planning period; returns whether the trial goes on.
    pub fn tick(&mut self) -> bool {
        self.trial.tick().is_none()
    }

    /// How the trial ended, or `running`.
    pub fn outcome(&self) -> String {
        self.trial.outcome().map_or("running", |outcome| outcome.name()).to_owned()
    }

    /// Tick, time; x, y, z, roll, pitch, yaw; then the six metrics in the order of [`mapless_trials::Metrics`].
    pub fn status(&self) -> Vec<f64> {
        let mut values = vec![self.trial.ticks() as f64, self.trial.time_s()];
        values.extend(&self.trial.motion()[..6]);
        values.extend(self.trial.metrics().values());
        values
    }

    /// Digest of the trajectory so far.
    pub fn digest(&self) -> String {
        self.trial.digest()
    }
}

//! Whole trials of every navigator, for the page's ghosts and batches, and generated tasks. A module of its
//! own: the page opens without it.

mod ground;
mod guest;
#[path = "../../wasm/src/shared/mod.rs"]
mod shared;
mod trial_status;

pub use ground::Ground;
pub use guest::{GuestGoal, GuestModel, GuestOptions, GuestQuestion, GuestRunner};
use mapless_baselines::{NavigatorKind, Task};
use mapless_trials::{Navigator, Scenario, Trial, statistics};
use serde::{Deserialize, Serialize};
pub use shared::{Metrics, Outcome, OverrideValue, Overrides, Pose};
use shared::{changed, give, read};
pub use trial_status::TrialStatus;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// Runs once when the page loads the module.
#[wasm_bindgen(start)]
pub fn start() {
    shared::panic::install_hook();
}

/// The names of all navigators.
#[wasm_bindgen]
pub fn planners() -> Vec<String> {
    NavigatorKind::ALL.iter().map(|kind| kind.name().to_owned()).collect()
}

/// A generated task.
#[derive(Debug, Serialize, Tsify)]
pub struct GeneratedTask {
    /// Its scenario file, whose terrain is at `terrain.toml`.
    scenario: String,
    /// The recipe of that.
    recipe: String,
}

/// The generated task of a name such as `hard-1-0007`.
///
/// # Errors
/// What names no task; a task that the oracle cannot solve however often it is drawn.
#[wasm_bindgen]
pub fn generated_task(name: &str) -> Result<Ts<GeneratedTask>, JsError> {
    let task = Task::generate(name.parse()?)?;
    give(&GeneratedTask { scenario: task.scenario("terrain.toml"), recipe: task.recipe })
}

/// Where a rate lies.
#[derive(Debug, Serialize, Tsify)]
pub struct Interval {
    low: f64,
    high: f64,
}

/// Wilson's 95 % interval of the rate behind `successes` of `trials`.
///
/// # Errors
/// None, unless JavaScript runs out of memory.
#[wasm_bindgen]
pub fn wilson(successes: usize, trials: usize) -> Result<Ts<Interval>, JsError> {
    let (low, high) = statistics::wilson(successes, trials);
    give(&Interval { low, high })
}

/// Mean and sample standard deviation; NaN where there is none.
#[derive(Debug, Serialize, Tsify)]
pub struct Spread {
    mean: f64,
    deviation: f64,
}

/// Mean and sample standard deviation; NaN where there is none.
///
/// # Errors
/// None, unless JavaScript runs out of memory.
#[wasm_bindgen]
pub fn mean_and_deviation(values: &[f64]) -> Result<Ts<Spread>, JsError> {
    let (mean, deviation) = statistics::mean_and_deviation(values).unwrap_or((f64::NAN, None));
    give(&Spread { mean, deviation: deviation.unwrap_or(f64::NAN) })
}

/// All that a trial is begun with, on a ground.
#[derive(Debug, Deserialize, Tsify)]
pub struct RunnerOptions {
    /// The text of a scenario file, whose terrain is left unread.
    scenario: String,
    /// Set from the beginning.
    overrides: Overrides,
    /// The name of a navigator.
    planner: String,
    seed: u64,
}

/// One trial of one navigator.
#[wasm_bindgen]
#[allow(missing_debug_implementations)]
pub struct Runner {
    trial: Trial<Box<dyn Navigator>>,
}

#[wasm_bindgen]
impl Runner {
    /// Puts the scenario's robot on the ground with a navigator.
    ///
    /// # Errors
    /// A fault in the scenario or a value that makes no sense, with its place and what was expected.
    #[wasm_bindgen(constructor)]
    pub fn new(ground: &Ground, options: Ts<RunnerOptions>) -> Result<Runner, JsError> {
        let RunnerOptions { scenario, overrides, planner, seed } = read(options)?;
        let scenario = changed(&Scenario::parse("scenario.toml", &scenario)?, &overrides)?;
        let kind: NavigatorKind = planner.parse()?;
        let navigator = kind.build(&ground.field, &scenario, seed)?;
        Ok(Runner { trial: Trial::with_navigator(ground.field.clone(), &scenario, navigator, seed)? })
    }

    /// One planning period; returns whether the trial goes on.
    pub fn tick(&mut self) -> bool {
        self.trial.tick().is_none()
    }

    /// How the trial stands.
    ///
    /// # Errors
    /// None, unless JavaScript runs out of memory.
    pub fn status(&self) -> Result<Ts<TrialStatus>, JsError> {
        give(&TrialStatus::of(&self.trial))
    }

    /// Digest of the trajectory so far.
    pub fn digest(&self) -> String {
        self.trial.digest()
    }
}

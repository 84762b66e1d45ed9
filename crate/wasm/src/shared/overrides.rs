//! Parameters that differ from those of a scenario file.

use mapless_trials::Scenario;
use serde::{Deserialize, Serialize};
use toml::Table;
use tsify::Tsify;
use wasm_bindgen::prelude::JsError;

/// Parameters by the names and tables of scenario files: nothing but `planner`, `sensor`, `robot` and
/// `reality`, and within them what differs.
#[derive(Clone, Debug, Default, Serialize, Deserialize, Tsify)]
#[serde(transparent)]
#[tsify(hashmap_as_object, type = "{ readonly [key: string]: OverrideValue | Overrides }")]
pub struct Overrides(pub(crate) Table);

/// The value of a parameter.
#[derive(Tsify)]
#[tsify(type = "number | string | boolean | readonly (OverrideValue | Overrides)[]")]
pub struct OverrideValue;

/// The scenario with other values of parameters. Errors name the place as `settings`.
pub(crate) fn changed(scenario: &Scenario, overrides: &Overrides) -> Result<Scenario, JsError> {
    Ok(scenario.with_parameters("settings", &toml::to_string(&overrides.0)?)?)
}

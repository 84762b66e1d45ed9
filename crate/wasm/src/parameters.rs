//! Every parameter that a scenario file may set, described for people.

use mapless_trials::parameters::{self, Kind, Value, Valued};
use mapless_trials::{Preset, Scenario};
use serde::Serialize;
use tsify::Tsify;
use wasm_bindgen::prelude::JsError;

/// Parameters that belong together.
#[derive(Debug, Serialize, Tsify)]
pub struct ParameterGroup {
    /// The table of a scenario file that they stand in.
    table: &'static str,
    title: &'static str,
    parameters: Vec<Parameter>,
}

/// What people are told of a parameter.
#[derive(Debug, Serialize, Tsify)]
pub struct Parameter {
    name: &'static str,
    /// Empty for shares, counts and choices.
    unit: &'static str,
    /// What it does.
    text: &'static str,
    kind: ParameterKind,
    /// Of a number, a whole number or a pair: lowest and highest.
    #[tsify(type = "readonly [low: number, high: number] | undefined")]
    range: Option<[f64; 2]>,
    /// Of a choice.
    choices: Option<&'static [&'static str]>,
    /// What holds where nothing is overridden.
    #[tsify(type = "OverrideValue")]
    value: Value,
    /// What the paper gives, where it gives one.
    #[tsify(type = "OverrideValue | undefined")]
    paper: Option<Value>,
}

/// What a parameter's value may be.
#[derive(Clone, Copy, Debug, Serialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum ParameterKind {
    /// A number.
    Number,
    /// A whole number.
    Whole,
    /// Two numbers.
    Pair,
    /// True or false.
    Switch,
    /// One of some words.
    Choice,
}

/// All of them, with the values of the scenario `file`; what the planner takes from sensor and robot follows `running`, the
/// scenario with its overrides.
pub(crate) fn groups(
    file: &Scenario,
    running: &Scenario,
    preset: Preset,
) -> Result<Vec<ParameterGroup>, JsError> {
    let values = parameters::values(file, running, preset)?;
    let groups = values.into_iter().map(|group| ParameterGroup {
        table: group.table,
        title: group.title,
        parameters: group.parameters.iter().map(described).collect(),
    });
    Ok(groups.collect())
}

fn described(Valued { parameter, value }: &Valued) -> Parameter {
    let (kind, range, choices) = match parameter.kind {
        Kind::Number(low, high) => (ParameterKind::Number, Some([low, high]), None),
        Kind::Whole(low, high) => (ParameterKind::Whole, Some([low.into(), high.into()]), None),
        Kind::Pair(low, high) => (ParameterKind::Pair, Some([low, high]), None),
        Kind::Switch => (ParameterKind::Switch, None, None),
        Kind::Choice(choices) => (ParameterKind::Choice, None, Some(choices)),
    };
    Parameter {
        name: parameter.name,
        unit: parameter.unit,
        text: parameter.text,
        kind,
        range,
        choices,
        value: *value,
        paper: parameter.paper,
    }
}

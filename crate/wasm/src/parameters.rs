//! Every parameter that a scenario file may set, described for people.

use mapless_trials::parameters::{self, Group, Kind, Value, Valued};
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
    /// What the presets of `reality` give; empty outside it.
    #[tsify(type = "readonly PresetValue[]")]
    presets: Vec<PresetValue>,
}

/// What a preset gives for a parameter.
#[derive(Debug, Serialize, Tsify)]
pub struct PresetValue {
    preset: &'static str,
    #[tsify(type = "OverrideValue")]
    value: Value,
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

/// All of them, with the values of the scenario `file`; what the planner takes from sensor and robot follows
/// `running`, the scenario with its overrides.
pub(crate) fn groups(
    file: &Scenario,
    running: &Scenario,
    preset: Preset,
) -> Result<Vec<ParameterGroup>, JsError> {
    let presets = parameters::reality_presets();
    let values = parameters::values(file, running, preset)?;
    let groups = values.into_iter().map(|group| {
        let given = |index: usize| preset_values(&presets, group.table, index);
        let parameters = group.parameters.iter().enumerate();
        ParameterGroup {
            table: group.table,
            title: group.title,
            parameters: parameters.map(|(index, one)| described(one, given(index))).collect(),
        }
    });
    Ok(groups.collect())
}

/// What each preset gives for a parameter of a table.
fn preset_values(presets: &[(&'static str, Vec<Group>)], table: &str, index: usize) -> Vec<PresetValue> {
    let values = presets.iter().filter_map(|(preset, groups)| {
        let group = groups.iter().find(|group| group.table == table)?;
        Some(PresetValue { preset, value: group.parameters.get(index)?.value })
    });
    values.collect()
}

fn described(Valued { parameter, value }: &Valued, presets: Vec<PresetValue>) -> Parameter {
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
        presets,
    }
}

//! How arguments that name one of a few things are read.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use mapless::gp::learning::LearningMode;
use mapless_baselines::{NavigatorKind, Truth};
use mapless_terrain::generate::Difficulty;
use mapless_trials::Preset;

/// Reads the name of a configuration of this project's planner, for `--planner` where nothing else can be
/// meant.
pub(crate) fn preset() -> impl TypedValueParser<Value = Preset> {
    PossibleValuesParser::new(Preset::ALL.map(Preset::name)).try_map(|name| name.parse::<Preset>())
}

/// Reads the name of a navigator, for `--planner`.
pub(crate) fn planner() -> impl TypedValueParser<Value = NavigatorKind> {
    PossibleValuesParser::new(NavigatorKind::ALL.map(NavigatorKind::name))
        .try_map(|name| name.parse::<NavigatorKind>())
}

/// Reads what is true in place of perceived, for `--truth`.
pub(crate) fn truth() -> impl TypedValueParser<Value = Truth> {
    PossibleValuesParser::new(Truth::NAMES).try_map(|name| name.parse::<Truth>())
}

/// Reads the name of a mode of learning, for `--learning`.
pub(crate) fn learning() -> impl TypedValueParser<Value = LearningMode> {
    PossibleValuesParser::new(["fixed", "once", "every_scan"]).try_map(|name| name.parse::<LearningMode>())
}

/// Reads the name of a difficulty, for `--difficulty`.
pub(crate) fn difficulty() -> impl TypedValueParser<Value = Difficulty> {
    PossibleValuesParser::new(Difficulty::ALL.map(Difficulty::name))
        .try_map(|name| name.parse::<Difficulty>())
}

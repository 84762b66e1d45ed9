//! Parsers of arguments with a fixed set of names.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use mapless::gp::learning::LearningMode;
use mapless_baselines::{NavigatorKind, Truth};
use mapless_terrain::Holes;
use mapless_terrain::generate::Family;
use mapless_trials::Preset;

/// Parses the name of a configuration of the mapless planner, for `--planner` where baselines do not apply.
pub(crate) fn preset() -> impl TypedValueParser<Value = Preset> {
    PossibleValuesParser::new(Preset::ALL.map(Preset::name)).try_map(|name| name.parse::<Preset>())
}

/// Parses the name of a navigator, for `--planner`.
pub(crate) fn planner() -> impl TypedValueParser<Value = NavigatorKind> {
    PossibleValuesParser::new(NavigatorKind::ALL.map(NavigatorKind::name))
        .try_map(|name| name.parse::<NavigatorKind>())
}

/// Parses the ground truth that replaces perception, for `--truth`.
pub(crate) fn truth() -> impl TypedValueParser<Value = Truth> {
    PossibleValuesParser::new(Truth::NAMES).try_map(|name| name.parse::<Truth>())
}

/// Parses the name of a learning mode, for `--learning`.
pub(crate) fn learning() -> impl TypedValueParser<Value = LearningMode> {
    PossibleValuesParser::new(["fixed", "once", "every_scan"]).try_map(|name| name.parse::<LearningMode>())
}

/// Parses the name of a family of generated terrains, for `--family`.
pub(crate) fn family() -> impl TypedValueParser<Value = Family> {
    PossibleValuesParser::new(Family::ALL.map(Family::name)).try_map(|name| name.parse::<Family>())
}

/// Parses what becomes of samples without a height, for `--holes`.
pub(crate) fn holes() -> impl TypedValueParser<Value = Holes> {
    PossibleValuesParser::new(Holes::NAMES.map(|(name, _)| name)).try_map(|name| name.parse::<Holes>())
}

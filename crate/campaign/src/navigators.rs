//! The planners that a campaign can name, and how each is built.

use mapless::PlannerConfig;
use mapless_baselines::{NavigatorKind, Truth};
use mapless_trials::{Navigator, Scenario};
use mapless_world::HeightField;

/// The planner of this name.
pub(crate) fn kind(planner: &str) -> Result<NavigatorKind, String> {
    planner.parse().map_err(|error: mapless_baselines::UnknownName| error.to_string())
}

/// The configuration of `planner` in this scenario, before a campaign's parameters.
pub(crate) fn configuration(planner: &str, scenario: &Scenario) -> Result<PlannerConfig, String> {
    kind(planner)?.planner_config(scenario).map_err(|fault| fault.to_string())
}

/// Whether a planner perceives anything that ground truth could replace.
pub(crate) fn perceives(planner: &str) -> bool {
    matches!(kind(planner), Ok(NavigatorKind::Mapless(_)))
}

/// Builds `planner` with `config` for one trial. A planner with a map takes it from `field`; a planner that
/// draws random numbers is seeded with `seed`.
pub(crate) fn navigator(
    planner: &str,
    truth: Truth,
    field: &HeightField,
    scenario: &Scenario,
    config: &PlannerConfig,
    seed: u64,
) -> Result<Box<dyn Navigator>, String> {
    kind(planner)?.build_with(config.clone(), truth, field, scenario, seed).map_err(|error| error.to_string())
}

//! The planners a campaign can name, and how each is made.

use mapless::{Navigator, Planner, PlannerConfig};
use mapless_trials::{Preset, Scenario};
use mapless_world::HeightField;

/// What a planner is told of the world in place of what it perceives, so that one sees where a failure comes from.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Truth {
    /// Nothing: it perceives all by itself.
    #[default]
    None,
    /// The true elevation profile.
    Profile,
    /// The true ground under its way.
    Ground,
    /// The true profile and the true ground.
    Both,
}

impl Truth {
    /// The name used in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Profile => "profile",
            Self::Ground => "ground",
            Self::Both => "both",
        }
    }
}

/// The names that a campaign's `planners` may hold.
pub(crate) const PLANNERS: [&str; 2] = ["default", "paper"];

/// What a campaign's `truth` may hold.
pub(crate) const TRUTHS: [Truth; 1] = [Truth::None];

/// The configuration of `planner` in this scenario, before a campaign's parameters.
pub(crate) fn configuration(planner: &str, scenario: &Scenario) -> Result<PlannerConfig, String> {
    let preset: Preset = planner.parse()?;
    scenario.planner_config(preset).map_err(|fault| fault.to_string())
}

/// Makes `planner` with `config` for one trial. A planner with a map takes it from `field`, a planner that draws random
/// numbers begins them with `seed`.
pub(crate) fn navigator(
    planner: &str,
    truth: Truth,
    _field: &HeightField,
    _scenario: &Scenario,
    config: &PlannerConfig,
    _seed: u64,
) -> Result<Box<dyn Navigator>, String> {
    match (planner, truth) {
        ("default" | "paper", Truth::None) => {
            Ok(Box::new(Planner::new(config.clone()).map_err(|error| error.to_string())?))
        }
        _ => Err(format!(
            "planner {planner} with truth {}: expected one of {PLANNERS:?} with {TRUTHS:?}",
            truth.name()
        )),
    }
}

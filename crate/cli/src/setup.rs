//! The arguments that `profile` and `perceive` share: a scenario and a configuration of the planner.

use std::path::PathBuf;

use anyhow::Context as _;
use mapless::PlannerConfig;
use mapless::gp::learning::LearningMode;
use mapless_trials::{LoadedScenario, Preset};

use crate::parsers;

#[derive(clap::Args)]
pub(crate) struct Setup {
    /// Scenario file (TOML): terrain, start, goal, seed and what differs from the defaults.
    pub(crate) scenario: PathBuf,
    #[command(flatten)]
    pub(crate) planner: PlannerChoice,
}

/// The planner's configuration by its name.
#[derive(clap::Args)]
pub(crate) struct PlannerChoice {
    /// Planner configuration; a scenario's [planner] section starts from it.
    #[arg(long, default_value = "default", value_parser = parsers::preset(), value_name = "NAME")]
    pub(crate) planner: Preset,
    /// When hyperparameters are learned, instead of what the configuration says.
    #[arg(long, value_parser = parsers::learning(), value_name = "MODE")]
    learning: Option<LearningMode>,
}

impl Setup {
    /// The scenario with its terrain, and the planner's configuration.
    pub(crate) fn load(&self) -> anyhow::Result<(LoadedScenario, PlannerConfig)> {
        let loaded = LoadedScenario::read(&self.scenario)?;
        show_warnings(&loaded.terrain.warnings);
        let config = loaded.scenario.planner_config(self.planner.planner).with_context(|| self.file())?;
        Ok((loaded, self.planner.apply(config)))
    }

    /// The scenario file's name, for messages.
    pub(crate) fn file(&self) -> String {
        self.scenario.display().to_string()
    }
}

/// Says what was done to files that their owner should know.
pub(crate) fn show_warnings(warnings: &[String]) {
    for warning in warnings {
        eprintln!("warning: {warning}");
    }
}

impl PlannerChoice {
    /// The configuration with the options of the command line.
    pub(crate) fn apply(&self, mut config: PlannerConfig) -> PlannerConfig {
        if let Some(mode) = self.learning {
            config.perception.learning.mode = mode;
        }
        config
    }
}

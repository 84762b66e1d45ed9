//! Every navigator by its name.

use core::fmt;
use std::str::FromStr;

use mapless::{ConfigError, Planner, PlannerConfig};
use mapless_trials::{Navigator, Preset, Scenario, ScenarioFault};
use mapless_world::HeightField;

use crate::cloud::MapError;
use crate::ground_truth_planner::{GroundTruthPlanner, Truth};
use crate::known_world::KnownWorld;
use crate::oracle::{Oracle, OracleConfig};
use crate::putn::{Putn, PutnConfig};
use crate::route::{RouteNavigator, RoutePlanner, Straight};
use crate::unknown_name::UnknownName;
use crate::vgf::{Vgf, VgfConfig};

/// What drives the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NavigatorKind {
    /// This project's planner in one of its configurations.
    Mapless(Preset),
    /// Straight at the goal.
    Direct,
    /// The paper's baseline with its published values.
    Vgf,
    /// The paper's baseline with a better search.
    VgfTuned,
    /// Plane-fitting RRT*.
    Putn,
    /// The shortest safe path over the known ground.
    Oracle,
}

/// Why a navigator cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// The scenario's `[planner]` section does not fit.
    #[error(transparent)]
    Scenario(#[from] ScenarioFault),
    /// A configuration value makes no sense.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The terrain has no map.
    #[error("planner {kind}: {error}")]
    Map {
        /// Which navigator.
        kind: NavigatorKind,
        /// Why.
        error: MapError,
    },
    /// Ground truth for a navigator without perception.
    #[error("planner {0} has no perception to override: expected one of default, paper, flat")]
    PerceivesNothing(NavigatorKind),
}

impl NavigatorKind {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Mapless(Preset::Default),
        Self::Mapless(Preset::Paper),
        Self::Mapless(Preset::Flat),
        Self::Direct,
        Self::Vgf,
        Self::VgfTuned,
        Self::Putn,
        Self::Oracle,
    ];

    /// The name as on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mapless(preset) => preset.name(),
            Self::Direct => "direct",
            Self::Vgf => "vgf",
            Self::VgfTuned => "vgf_tuned",
            Self::Putn => "putn",
            Self::Oracle => "oracle",
        }
    }

    /// The planner's configuration in a scenario. Navigators with a map take tolerance, controller and limits
    /// from it.
    ///
    /// # Errors
    /// The value of the scenario that does not fit.
    pub fn planner_config(self, scenario: &Scenario) -> Result<PlannerConfig, ScenarioFault> {
        match self {
            Self::Mapless(preset) => scenario.planner_config(preset),
            _ => scenario.planner_config(Preset::Default),
        }
    }

    /// The navigator for a scenario on `field`; `seed` decides what a planner draws at random.
    ///
    /// # Errors
    /// [`BuildError`].
    pub fn build(
        self,
        field: &HeightField,
        scenario: &Scenario,
        seed: u64,
    ) -> Result<Box<dyn Navigator>, BuildError> {
        self.build_with(self.planner_config(scenario)?, Truth::None, field, scenario, seed)
    }

    /// As [`NavigatorKind::build`], with another configuration and, for a mapless planner, ground truth in
    /// place of perception.
    ///
    /// # Errors
    /// [`BuildError`].
    pub fn build_with(
        self,
        config: PlannerConfig,
        truth: Truth,
        field: &HeightField,
        scenario: &Scenario,
        seed: u64,
    ) -> Result<Box<dyn Navigator>, BuildError> {
        let map = |error| BuildError::Map { kind: self, error };
        let world = || KnownWorld::new(field, scenario);
        Ok(match self {
            Self::Mapless(_) if truth == Truth::None => Box::new(Planner::new(config)?),
            Self::Mapless(_) => Box::new(GroundTruthPlanner::new(config, truth, world().surface())?),
            _ if truth != Truth::None => return Err(BuildError::PerceivesNothing(self)),
            Self::Direct => along(Straight, &config),
            Self::Vgf => along(Vgf::new(&world().surface(), &VgfConfig::published()).map_err(map)?, &config),
            Self::VgfTuned => along(Vgf::new(&world().surface(), &VgfConfig::tuned()).map_err(map)?, &config),
            Self::Putn => {
                let surface = world().surface();
                along(Putn::new(&surface, PutnConfig::default(), config.robot, seed).map_err(map)?, &config)
            }
            Self::Oracle => along(Oracle { world: world(), config: OracleConfig::default() }, &config),
        })
    }
}

fn along<R: RoutePlanner + 'static>(planner: R, config: &PlannerConfig) -> Box<dyn Navigator> {
    Box::new(RouteNavigator::new(planner, config))
}

impl fmt::Display for NavigatorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for NavigatorKind {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        let kind = Self::ALL.into_iter().find(|kind| kind.name() == name);
        kind.ok_or_else(|| UnknownName::new("planner", name, &Self::ALL.map(Self::name)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{field, undulating, walled};
    use glam::DVec2;
    use mapless_trials::{NavigatorStop, Outcome, Trial};

    fn scenario() -> Scenario {
        let text = "terrain = \"a.toml\"\nstart = [3.0, 10.0, 0.3]\ngoal = [17.0, 11.0]\nseed = 1\n";
        Scenario::parse("a.toml", text).unwrap()
    }

    fn drive(
        kind: NavigatorKind,
        height_m: impl Fn(DVec2) -> f64,
    ) -> (Outcome, Option<NavigatorStop>, String) {
        let (scenario, field) = (scenario(), field(20.0, height_m));
        let navigator = kind.build(&field, &scenario, 1).unwrap();
        let mut trial = Trial::with_navigator(field, &scenario, navigator, 1).unwrap();
        loop {
            if let Some(outcome) = trial.tick() {
                return (outcome, trial.stop_reason(), trial.digest());
            }
        }
    }

    #[test]
    fn every_baseline_reaches_a_goal_over_gentle_ground_and_repeats_itself() {
        for kind in NavigatorKind::ALL.into_iter().filter(|kind| !matches!(kind, NavigatorKind::Mapless(_))) {
            let first = drive(kind, undulating);
            assert_eq!(first.0, Outcome::Reached, "{kind}");
            assert_eq!(first, drive(kind, undulating), "{kind}");
        }
    }

    #[test]
    fn the_planner_by_name_drives_as_the_planner_itself() {
        let (scenario, field) = (scenario(), field(20.0, undulating));
        let mut trial = Trial::new(field, &scenario, Preset::Default, 1).unwrap();
        while trial.tick().is_none() {}
        assert_eq!(drive(NavigatorKind::Mapless(Preset::Default), undulating).2, trial.digest());
    }

    #[test]
    fn a_navigator_with_a_map_sees_that_a_wall_leaves_no_path() {
        for kind in [NavigatorKind::Vgf, NavigatorKind::VgfTuned, NavigatorKind::Putn] {
            let (outcome, reason, _) = drive(kind, walled);
            assert_eq!((outcome, reason), (Outcome::NoSubgoal, Some(NavigatorStop::NoPath)), "{kind}");
        }
    }

    #[test]
    fn names_are_read_back_and_others_are_refused() {
        for kind in NavigatorKind::ALL {
            assert_eq!(kind.name().parse(), Ok(kind));
        }
        let error = "putm".parse::<NavigatorKind>().unwrap_err().to_string();
        assert_eq!(
            error,
            "planner \"putm\": expected one of default, paper, flat, direct, vgf, vgf_tuned, putn, oracle"
        );
        let error = "sky".parse::<Truth>().unwrap_err().to_string();
        assert_eq!(error, "truth \"sky\": expected one of none, profile, ground, both");
    }

    #[test]
    fn truth_is_for_those_that_perceive() {
        let (scenario, field) = (scenario(), field(20.0, |_| 0.0));
        for kind in NavigatorKind::ALL {
            let config = kind.planner_config(&scenario).unwrap();
            let built = kind.build_with(config, Truth::Both, &field, &scenario, 1);
            assert_eq!(built.is_ok(), matches!(kind, NavigatorKind::Mapless(_)), "{kind}");
        }
    }

    #[test]
    fn a_terrain_too_large_to_map_is_an_error() {
        let vast = HeightField::new(3, 3, 500.0, vec![0.0; 9]).unwrap();
        let error = NavigatorKind::Vgf.build(&vast, &scenario(), 1).err().unwrap().to_string();
        assert!(
            error.starts_with("planner vgf: a terrain of 1000.0 × 1000.0 m: expected at most"),
            "{error}"
        );
    }
}

//! What relates several parameters. What a single one must hold stands in its entry.

use mapless_parameters::ConfigError;

use super::{ElevationWindowConfig, InducingInputs, PerceptionConfig, PlannerConfig, WINDOW_CELLS};
use crate::gp::hyperparameters::Hyperparameters;
use crate::gp::learning::LearningMode;

impl PlannerConfig {
    pub(super) fn check_relations(&self, place: &str) -> Result<(), ConfigError> {
        let place = mapless_parameters::inside(place, "state_lattice");
        let lattice = &self.state_lattice;
        ConfigError::require(
            self.perception.surface_radius_m <= 40.0 * lattice.step_m,
            &place,
            "step_m",
            lattice.step_m,
            "at least a fortieth of planner.perception.surface_radius_m",
        )?;
        let least_rad = self.robot.roll_limit_rad.min(self.robot.pitch_limit_rad);
        for (name, margin_rad) in [
            ("tilt_margin_rad", lattice.tilt_margin_rad),
            ("recovery_margin_rad", lattice.recovery_margin_rad),
            ("over_budget_margin_rad", lattice.over_budget_margin_rad),
        ] {
            let expected = "less than both tilt limits";
            ConfigError::require(margin_rad < least_rad, &place, name, margin_rad, expected)?;
        }
        Ok(())
    }
}

impl PerceptionConfig {
    pub(super) fn check_learning(&self, place: &str) -> Result<(), ConfigError> {
        if self.learning.mode == LearningMode::Fixed {
            return Ok(());
        }
        let start = Hyperparameters { kernel: self.kernel, noise_variance: self.noise_variance_m2 };
        if let Err(fault) = self.learning.check_start(&start) {
            let expected = "a start (kernel, noise_variance_m2) within its bounds";
            ConfigError::require(false, place, "learning", fault, expected)?;
        }
        ConfigError::require(
            !(self.inducing_inputs == InducingInputs::Lattice && self.learning.learn_inducing_inputs),
            &mapless_parameters::inside(place, "learning"),
            "learn_inducing_inputs",
            true,
            "false with inducing_inputs = \"lattice\", which cannot move",
        )
    }
}

impl ElevationWindowConfig {
    /// Two different places inside the window must not share a slot.
    pub(super) fn check_span(&self, place: &str) -> Result<(), ConfigError> {
        ConfigError::require(
            self.cell_m * WINDOW_CELLS as f64 > 2.0 * self.radius_m,
            place,
            "cell_m",
            self.cell_m,
            "cells large enough that 96 of them span twice radius_m",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(config: &PlannerConfig) -> String {
        config.validate("planner").unwrap_err().to_string()
    }

    #[test]
    fn both_presets_are_valid() {
        assert_eq!(PlannerConfig::default().validate("planner"), Ok(()));
        assert_eq!(PlannerConfig::paper().validate("planner"), Ok(()));
    }

    #[test]
    fn a_lattice_too_large_to_search_is_refused() {
        for (step_m, surface_radius_m) in [(0.1, 3.0), (0.5, 100.0)] {
            let mut config = PlannerConfig::default();
            config.state_lattice.step_m = step_m;
            config.perception.surface_radius_m = surface_radius_m;
            let error = fault(&config);
            assert!(error.starts_with("planner.state_lattice.step_m = "), "{error}");
        }
    }

    #[test]
    fn a_margin_as_large_as_a_tilt_limit_is_refused() {
        let mut config = PlannerConfig::default();
        config.robot.roll_limit_rad = config.state_lattice.recovery_margin_rad;
        config.state_lattice.tilt_margin_rad = 0.01;
        let expected =
            "planner.state_lattice.recovery_margin_rad = 0.06: expected less than both tilt limits";
        assert_eq!(fault(&config), expected);
    }

    #[test]
    fn a_window_that_its_cells_do_not_span_is_refused() {
        let mut config = PlannerConfig::default();
        config.elevation_window.cell_m = 0.1;
        assert!(fault(&config).starts_with("planner.elevation_window.cell_m = 0.1: expected cells"));
    }

    #[test]
    fn an_error_names_place_value_and_expectation() {
        let mut config = PlannerConfig::default();
        config.perception.kernel.alpha = f64::NAN;
        assert_eq!(fault(&config), "planner.perception.kernel.alpha = NaN: expected a positive number");
    }
}

//! Checks every value, with its place and what was expected.

use core::f64::consts::{FRAC_PI_2, TAU};

use super::{
    ControllerConfig, DecisionConfig, ElevationWindowConfig, InducingInputs, PerceptionConfig, PlannerConfig,
    SegmentConfig, StateLatticeConfig,
};
use crate::error::{ConfigError, require};
use crate::gp::hyperparameters::Hyperparameters;
use crate::gp::learning::LearningMode;
use crate::robot_model::RobotModel;
use crate::sensor_model::SensorModel;
use crate::terrain::elevation_window::{MOST_SIDE, side_of};

impl PlannerConfig {
    /// Checks every value.
    ///
    /// # Errors
    /// [`ConfigError`] with the first value that makes no sense, its place and what was expected.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner";
        positive(self.period_s, place, "period_s")?;
        positive(self.goal_tolerance_m, place, "goal_tolerance_m")?;
        self.robot.validate()?;
        self.sensor.validate()?;
        self.perception.validate()?;
        self.segments.validate()?;
        self.elevation_window.validate()?;
        self.state_lattice.validate()?;
        let step_m = self.state_lattice.step_m;
        require(
            step_m >= 0.2 && self.perception.surface_radius_m <= 40.0 * step_m,
            "planner.state_lattice",
            "step_m",
            step_m,
            "at least 0.2 m and a fortieth of planner.perception.surface_radius_m",
        )?;
        let StateLatticeConfig { tilt_margin_rad, escape_margin_rad, impatient_margin_rad, .. } =
            self.state_lattice;
        for (name, margin) in [
            ("tilt_margin_rad", tilt_margin_rad),
            ("escape_margin_rad", escape_margin_rad),
            ("impatient_margin_rad", impatient_margin_rad),
        ] {
            let least = self.robot.roll_limit_rad.min(self.robot.pitch_limit_rad);
            require(margin < least, "planner.state_lattice", name, margin, "less than both tilt limits")?;
        }
        self.decision.validate()?;
        self.controller.validate()
    }
}

impl RobotModel {
    fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner.robot";
        for (name, value) in [
            ("length_m", self.length_m),
            ("width_m", self.width_m),
            ("wheelbase_m", self.wheelbase_m),
            ("track_m", self.track_m),
            ("wheel_radius_m", self.wheel_radius_m),
            ("ground_clearance_m", self.ground_clearance_m),
        ] {
            positive(value, place, name)?;
        }
        not_negative(self.max_step_m, place, "max_step_m")?;
        angle(self.roll_limit_rad, place, "roll_limit_rad")?;
        angle(self.pitch_limit_rad, place, "pitch_limit_rad")
    }
}

impl SensorModel {
    fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner.sensor";
        let Self { rings, lowest_elevation_rad: lowest, highest_elevation_rad: highest, .. } = *self;
        require((2..=1024).contains(&rings), place, "rings", rings, "2 to 1024")?;
        require((1..=36_000).contains(&self.columns), place, "columns", self.columns, "1 to 36000")?;
        let in_sight = |elevation: f64| (-FRAC_PI_2..=FRAC_PI_2).contains(&elevation);
        require(in_sight(lowest), place, "lowest_elevation_rad", lowest, "an angle from -π/2 to π/2 rad")?;
        let above = in_sight(highest) && highest > lowest;
        let expected = "an angle above lowest_elevation_rad, at most π/2 rad";
        require(above, place, "highest_elevation_rad", highest, expected)?;
        let fov = self.horizontal_fov_rad;
        require(
            fov > 0.0 && fov <= TAU,
            place,
            "horizontal_fov_rad",
            fov,
            "an angle above 0, at most 2π rad",
        )?;
        not_negative(self.min_range_m, place, "min_range_m")?;
        let farther = self.max_range_m > self.min_range_m;
        require(farther, place, "max_range_m", self.max_range_m, "more than min_range_m")?;
        positive(self.height_m, place, "height_m")?;
        for (name, value) in [("forward_m", self.forward_m), ("left_m", self.left_m)] {
            require(value.is_finite(), place, name, value, "a number")?;
        }
        for (name, value) in
            [("roll_rad", self.roll_rad), ("pitch_rad", self.pitch_rad), ("yaw_rad", self.yaw_rad)]
        {
            require(value.abs() <= TAU, place, name, value, "an angle from -2π to 2π rad")?;
        }
        Ok(())
    }
}

impl PerceptionConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner.perception";
        positive(self.surface_radius_m, place, "surface_radius_m")?;
        self.kernel.validate("planner.perception.kernel")?;
        positive(self.noise_variance_m2, place, "noise_variance_m2")?;
        positive(self.inducing_spacing_length_scales, place, "inducing_spacing_length_scales")?;
        require(self.max_inducing_inputs > 0, place, "max_inducing_inputs", 0, "at least 1")?;
        self.learning.validate("planner.perception.learning")?;
        if self.learning.mode != LearningMode::Fixed {
            let start = Hyperparameters { kernel: self.kernel, noise_variance: self.noise_variance_m2 };
            let expected = "a start (kernel, noise_variance_m2) within its bounds";
            let fault = self.learning.check_start(&start).err();
            let value = fault.as_ref().map_or(String::new(), ToString::to_string);
            require(fault.is_none(), "planner.perception", "learning", value, expected)?;
            let lattice = self.inducing_inputs == InducingInputs::Lattice;
            let place = "planner.perception.learning";
            let expected = "false with inducing_inputs = \"lattice\", which cannot move";
            require(
                !(lattice && self.learning.learn_inducing_inputs),
                place,
                "learn_inducing_inputs",
                true,
                expected,
            )?;
        }
        let threshold = self.variance_threshold;
        require(
            threshold > 0.0 && threshold < 1.0,
            place,
            "variance_threshold",
            threshold,
            "a share of the signal variance between 0 and 1",
        )
    }
}

impl SegmentConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner.segments";
        angle(self.elevation_tolerance_rad, place, "elevation_tolerance_rad")?;
        not_negative(self.safety_margin_m, place, "safety_margin_m")?;
        angle(self.max_slope_rad, place, "max_slope_rad")
    }
}

impl ElevationWindowConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner.elevation_window";
        positive(self.radius_m, place, "radius_m")?;
        positive(self.cell_m, place, "cell_m")?;
        require(
            side_of(self) <= MOST_SIDE,
            place,
            "cell_m",
            self.cell_m,
            "cells so large that a thousand of them span twice radius_m",
        )?;
        not_negative(self.curvature_per_m, place, "curvature_per_m")?;
        require(self.memory_ticks > 0, place, "memory_ticks", self.memory_ticks, "at least 1")
    }
}

impl StateLatticeConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner.state_lattice";
        positive(self.step_m, place, "step_m")?;
        not_negative(self.tilt_margin_rad, place, "tilt_margin_rad")?;
        not_negative(self.escape_margin_rad, place, "escape_margin_rad")?;
        not_negative(self.impatient_margin_rad, place, "impatient_margin_rad")?;
        not_negative(self.change_cost_m, place, "change_cost_m")?;
        let reverse = self.reverse_price;
        require(reverse >= 1.0 && reverse.is_finite(), place, "reverse_price", reverse, "at least 1")?;
        not_negative(self.escape_m, place, "escape_m")?;
        not_negative(self.deviations, place, "deviations")?;
        not_negative(self.blind_radius_m, place, "blind_radius_m")?;
        not_negative(self.tilt_price, place, "tilt_price")?;
        not_negative(self.climb_price, place, "climb_price")?;
        let turn = self.turn_cost_m;
        require(turn >= 0.1 && turn.is_finite(), place, "turn_cost_m", turn, "at least 0.1 m")?;
        not_negative(self.clearance_m, place, "clearance_m")?;
        not_negative(self.min_reach_m, place, "min_reach_m")
    }
}

impl DecisionConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner.decision";
        not_negative(self.direction_weight, place, "direction_weight")?;
        not_negative(self.distance_weight, place, "distance_weight")?;
        not_negative(self.steepness_weight, place, "steepness_weight")?;
        not_negative(self.climb_weight, place, "climb_weight")?;
        not_negative(self.commitment_weight, place, "commitment_weight")?;
        not_negative(self.dead_end_weight, place, "dead_end_weight")
    }
}

impl ControllerConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        for (gains, place) in
            [(self.distance, "planner.controller.distance"), (self.yaw, "planner.controller.yaw")]
        {
            not_negative(gains.proportional, place, "proportional")?;
            not_negative(gains.integral, place, "integral")?;
            not_negative(gains.derivative, place, "derivative")?;
        }
        let place = "planner.controller";
        positive(self.max_speed_m_s, place, "max_speed_m_s")?;
        positive(self.max_turn_rate_rad_s, place, "max_turn_rate_rad_s")?;
        angle(self.turn_first_rad, place, "turn_first_rad")?;
        positive(self.look_turn_rate_rad_s, place, "look_turn_rate_rad_s")?;
        let from = self.slow_from_share;
        require((0.0..1.0).contains(&from), place, "slow_from_share", from, "a share below 1")?;
        let least = self.least_speed_share;
        require(least > 0.0 && least <= 1.0, place, "least_speed_share", least, "a share above 0")
    }
}

fn positive(value: f64, place: &str, name: &'static str) -> Result<(), ConfigError> {
    require(value.is_finite() && value > 0.0, place, name, value, "a positive number")
}

fn not_negative(value: f64, place: &str, name: &'static str) -> Result<(), ConfigError> {
    require(value.is_finite() && value >= 0.0, place, name, value, "zero or a positive number")
}

fn angle(value: f64, place: &str, name: &'static str) -> Result<(), ConfigError> {
    let right = core::f64::consts::FRAC_PI_2;
    require(value > 0.0 && value < right, place, name, value, "an angle between 0 and π/2 rad")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_presets_are_valid() {
        PlannerConfig::default().validate().unwrap();
        PlannerConfig::paper().validate().unwrap();
    }

    #[test]
    fn a_lattice_too_large_to_search_is_refused() {
        for (step_m, surface_radius_m) in [(0.1, 3.0), (0.5, 100.0)] {
            let mut config = PlannerConfig::default();
            config.state_lattice.step_m = step_m;
            config.perception.surface_radius_m = surface_radius_m;
            let error = config.validate().unwrap_err().to_string();
            assert!(error.starts_with("planner.state_lattice.step_m = "), "{error}");
        }
    }

    #[test]
    fn an_error_names_place_value_and_expectation() {
        let mut config = PlannerConfig::default();
        config.perception.kernel.alpha = f64::NAN;
        assert_eq!(
            config.validate().unwrap_err().to_string(),
            "planner.perception.kernel.alpha = NaN: expected a positive number"
        );
    }
}

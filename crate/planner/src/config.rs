//! Every parameter of the planner, with its unit and the paper's value.

use crate::error::{ConfigError, require};
use crate::hyperparameters::Hyperparameters;
use crate::kernel::RationalQuadratic;
use crate::learning::{LearningConfig, LearningMode};
use crate::pose::SensorMount;

/// The planner's configuration. [`PlannerConfig::default`] is the best mapless choice known here, and
/// [`PlannerConfig::paper`] the paper's text as literally as it allows.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PlannerConfig {
    /// Time between steps, seconds. Paper: 0.1 (10 Hz).
    pub period_s: f64,
    /// The goal counts as reached within this distance, metres. Paper: not given.
    pub goal_tolerance_m: f64,
    /// Robot width w_r, metres. The Husky's is 0.685.
    pub robot_width_m: f64,
    /// Distance between front and rear axle, metres. The Husky's is 0.512.
    pub wheelbase_m: f64,
    /// Distance between the middles of left and right wheels, metres. The Husky's is 0.571.
    pub track_m: f64,
    /// Where the LiDAR sits.
    pub mount: SensorMount,
    /// The tilt the robot must never reach.
    pub limits: TiltLimits,
    /// From scan to variance surface and profile.
    pub perception: PerceptionConfig,
    /// From profile to segments and subgoals.
    pub segments: SegmentConfig,
    /// What is remembered of the ground for the forecast.
    pub ground: GroundConfig,
    /// Ways over that ground, and the tilt they promise.
    pub forecast: ForecastConfig,
    /// The cost of a subgoal.
    pub decision: DecisionConfig,
    /// The PID controller.
    pub controller: ControllerConfig,
}

/// Roll and pitch limits (paper, section VI-B; Clearpath).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TiltLimits {
    /// Largest safe |roll|. Paper: 0.524.
    pub roll_rad: f64,
    /// Largest safe |pitch|. Paper: 0.785.
    pub pitch_rad: f64,
}

/// The occupancy surface and the sparse Gaussian process over it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PerceptionConfig {
    /// Radius r_oc of the occupancy surface, metres. Paper: 7.
    pub surface_radius_m: f64,
    /// Kernel hyperparameters. Paper: learned, isotropic.
    pub kernel: RationalQuadratic,
    /// Noise variance σₙ² of one cell's occupancy, square metres. Paper: learned.
    pub noise_variance_m2: f64,
    /// Where the inducing inputs lie. Paper: not given.
    pub inducing_inputs: InducingInputs,
    /// Spacing of the inducing inputs, in length-scales: at most on the lattice, at least with farthest points.
    pub inducing_spacing_length_scales: f64,
    /// Farthest points at most. Paper: not given; the authors' earlier code uses 400 to 500.
    pub max_inducing_inputs: usize,
    /// Whether and how the kernel's hyperparameters and the noise are learned; the values above are then where it starts.
    pub learning: LearningConfig,
    /// Threshold V_th on the variance, as a share of the signal variance. Paper: 0.7.
    pub variance_threshold: f64,
}

/// How inducing inputs are placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InducingInputs {
    /// On the lattice of the sensor's columns and rings, wherever there are returns.
    Lattice,
    /// Among the returns, each the farthest from those before it, until every return is near one.
    FarthestPoints,
}

/// Segments and subgoals.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SegmentConfig {
    /// A column belongs to a segment while its elevation is this near to the segment's mean. Paper: not given.
    pub elevation_tolerance_rad: f64,
    /// Safety margin δ on the robot's width, metres. Paper: not given.
    pub safety_margin_m: f64,
    /// Steepest rise or fall to the skyline that counts as climbable. Paper: "climbing capabilities", no value.
    pub max_slope_rad: f64,
    /// Whether columns without a return may carry subgoals, on ground that earlier scans saw. Paper: no.
    pub subgoals_on_unknown: bool,
}

/// Memory of the ground.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GroundConfig {
    /// Side of a cell, metres.
    pub cell_m: f64,
    /// Returns within this range are remembered, metres. It reaches a little beyond r_oc, so that a robot on a knoll,
    /// which hides what is nearer, knows where the ground goes on.
    pub radius_m: f64,
    /// Steps after which ground not seen again is forgotten.
    pub memory_ticks: u64,
    /// Standard deviation of the slope of ground for each metre that it lies from what was seen of it.
    pub curvature_per_m: f64,
}

/// The ways that are looked for over remembered ground, and the tilt they promise.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ForecastConfig {
    /// Spacing of the places looked at, metres.
    pub step_m: f64,
    /// How far inside the tilt limits a way stays, radians.
    pub tilt_margin_rad: f64,
    /// The least margin, radians: for ground that is the last choice, for turns on the spot, and for a robot that has to get away.
    pub escape_margin_rad: f64,
    /// How far from a robot that finds no way at all the least margin suffices, without what is uncertain, metres.
    pub escape_m: f64,
    /// Standard deviations of the predicted slope added to it before it is compared.
    pub deviations: f64,
    /// Unseen ground bridged next to the robot, where no beam reaches, metres.
    pub blind_radius_m: f64,
    /// What a metre at the tilt limit costs beyond itself, in metres of level ground; in between with the square of the slope.
    pub tilt_price: f64,
    /// What a metre up or down costs beyond the way itself, in metres of level ground.
    pub climb_price: f64,
    /// What turning by a sixteenth of a circle costs, in metres driven.
    pub turn_cost_m: f64,
    /// What it costs to begin otherwise than the step before meant to, in metres driven; twice that with each change nearby.
    pub change_cost_m: f64,
    /// What a metre in reverse costs, in metres forward; without rear sight it is the last choice.
    pub reverse_price: f64,
    /// How far before steep or unseen ground a subgoal is placed, metres.
    pub clearance_m: f64,
    /// A subgoal is refused when it lies nearer than this, metres.
    pub min_reach_m: f64,
}

/// How steepness is judged and the terms are scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CostModel {
    /// The paper's eq. 6: steepness from the subgoal's height and the robot's pitch; each term divided by its greatest
    /// value over the candidates.
    Paper,
    /// Steepness from the tilt forecast; every term on a fixed physical scale.
    Forecast,
}

/// The cost function J.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DecisionConfig {
    /// Which terms.
    pub cost_model: CostModel,
    /// Direction factor k_dir. Paper: 0.2.
    pub direction_weight: f64,
    /// Distance factor k_dst. Paper: 0.3.
    pub distance_weight: f64,
    /// Steepness factor k_stp. Paper: 0.5.
    pub steepness_weight: f64,
    /// Metres of level ground that a metre up or down counts for in the distance. Paper: none.
    pub climb_weight: f64,
    /// Charge for turning away from the last choice. Paper: none.
    pub commitment_weight: f64,
    /// Charge for the detour that is known from a place driven over, on the scale of the distance. Paper: none.
    pub dead_end_weight: f64,
    /// Steps of turning in place without a candidate before giving up. Paper: not given.
    pub look_ticks: u32,
}

/// Gains of one PID loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PidGains {
    /// Per unit of error.
    pub proportional: f64,
    /// Per unit of error and second.
    pub integral: f64,
    /// Per unit of error a second.
    pub derivative: f64,
}

/// The controller.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ControllerConfig {
    /// Distance loop: metres to metres a second.
    pub distance: PidGains,
    /// Yaw loop: radians to radians a second.
    pub yaw: PidGains,
    /// Speed limit. Paper: 0.8 on the real robot.
    pub max_speed_m_s: f64,
    /// Turn-rate limit.
    pub max_turn_rate_rad_s: f64,
    /// The robot turns in place while its heading is off by more than this.
    pub turn_first_rad: f64,
    /// Turn rate while looking for a candidate.
    pub look_turn_rate_rad_s: f64,
    /// Share of a tilt limit from which on the robot drives more slowly, in proportion to what is left of it: so that it can stop
    /// before what it did not foresee. Paper: none.
    pub slow_from_share: f64,
    /// The least share of its speed that it keeps.
    pub least_speed_share: f64,
}

impl Default for PlannerConfig {
    fn default() -> Self {
        Self {
            period_s: 0.1,
            goal_tolerance_m: 0.5,
            robot_width_m: 0.685,
            wheelbase_m: 0.512,
            track_m: 0.571,
            mount: SensorMount::default(),
            limits: TiltLimits::default(),
            perception: PerceptionConfig::default(),
            segments: SegmentConfig::default(),
            ground: GroundConfig::default(),
            forecast: ForecastConfig::default(),
            decision: DecisionConfig::default(),
            controller: ControllerConfig::default(),
        }
    }
}

impl Default for TiltLimits {
    fn default() -> Self {
        Self { roll_rad: 0.524, pitch_rad: 0.785 }
    }
}

impl Default for PerceptionConfig {
    fn default() -> Self {
        Self {
            surface_radius_m: 7.0,
            kernel: RationalQuadratic::default(),
            noise_variance_m2: 3.0,
            inducing_inputs: InducingInputs::Lattice,
            inducing_spacing_length_scales: 0.95,
            max_inducing_inputs: 1000,
            learning: LearningConfig::default(),
            variance_threshold: 0.3,
        }
    }
}

impl Default for SegmentConfig {
    fn default() -> Self {
        Self {
            elevation_tolerance_rad: 0.05,
            safety_margin_m: 0.3,
            max_slope_rad: 0.5,
            subgoals_on_unknown: true,
        }
    }
}

impl Default for GroundConfig {
    fn default() -> Self {
        Self { cell_m: 0.2, radius_m: 9.0, memory_ticks: 600, curvature_per_m: 0.5 }
    }
}

impl Default for ForecastConfig {
    fn default() -> Self {
        Self {
            step_m: 0.5,
            tilt_margin_rad: 0.09,
            escape_margin_rad: 0.06,
            escape_m: 2.5,
            deviations: 1.0,
            blind_radius_m: 7.5,
            tilt_price: 4.0,
            climb_price: 4.0,
            turn_cost_m: 0.15,
            change_cost_m: 1.0,
            reverse_price: 2.0,
            clearance_m: 0.7,
            min_reach_m: 1.0,
        }
    }
}

impl Default for DecisionConfig {
    fn default() -> Self {
        Self {
            cost_model: CostModel::Forecast,
            direction_weight: 0.2,
            distance_weight: 1.0,
            steepness_weight: 1.0,
            climb_weight: 1.0,
            commitment_weight: 0.3,
            dead_end_weight: 1.0,
            look_ticks: 150,
        }
    }
}

impl Default for ControllerConfig {
    fn default() -> Self {
        Self {
            distance: PidGains { proportional: 0.8, integral: 0.0, derivative: 0.0 },
            yaw: PidGains { proportional: 1.5, integral: 0.0, derivative: 0.0 },
            max_speed_m_s: 0.8,
            max_turn_rate_rad_s: 1.0,
            turn_first_rad: 0.8,
            look_turn_rate_rad_s: 0.5,
            slow_from_share: 0.3,
            least_speed_share: 0.2,
        }
    }
}

impl PlannerConfig {
    /// The paper read literally: isotropic kernel, V_th = 0.7, subgoals at r_oc, three normalised cost terms.
    ///
    /// What the text leaves open (length-scale, noise, δ, slope range, gains) is written up in DESIGN.md.
    pub fn paper() -> Self {
        let default = Self::default();
        Self {
            perception: PerceptionConfig {
                kernel: RationalQuadratic { variance: 1.0, length_scales_rad: [0.035, 0.035], alpha: 10.0 },
                noise_variance_m2: 0.01,
                inducing_inputs: InducingInputs::FarthestPoints,
                inducing_spacing_length_scales: 0.85,
                learning: LearningConfig { mode: LearningMode::Fixed, ..LearningConfig::paper() },
                variance_threshold: 0.7,
                ..default.perception
            },
            segments: SegmentConfig { subgoals_on_unknown: false, ..default.segments },
            decision: DecisionConfig {
                cost_model: CostModel::Paper,
                direction_weight: 0.2,
                distance_weight: 0.3,
                steepness_weight: 0.5,
                climb_weight: 0.0,
                commitment_weight: 0.0,
                dead_end_weight: 0.0,
                ..default.decision
            },
            ..default
        }
    }

    /// Checks every value.
    ///
    /// # Errors
    /// [`ConfigError`] with the first value that makes no sense, its place and what was expected.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner";
        positive(self.period_s, place, "period_s")?;
        positive(self.goal_tolerance_m, place, "goal_tolerance_m")?;
        positive(self.robot_width_m, place, "robot_width_m")?;
        positive(self.wheelbase_m, place, "wheelbase_m")?;
        positive(self.track_m, place, "track_m")?;
        let mount = "planner.mount";
        positive(self.mount.height_m, mount, "height_m")?;
        require(self.mount.forward_m.is_finite(), mount, "forward_m", self.mount.forward_m, "a number")?;
        angle(self.limits.roll_rad, "planner.limits", "roll_rad")?;
        angle(self.limits.pitch_rad, "planner.limits", "pitch_rad")?;
        self.perception.validate()?;
        self.segments.validate()?;
        self.ground.validate()?;
        self.forecast.validate()?;
        let step_m = self.forecast.step_m;
        require(
            step_m >= 0.2 && self.perception.surface_radius_m <= 40.0 * step_m,
            "planner.forecast",
            "step_m",
            step_m,
            "at least 0.2 m and a fortieth of planner.perception.surface_radius_m",
        )?;
        let ForecastConfig { tilt_margin_rad, escape_margin_rad, .. } = self.forecast;
        for (name, margin) in [("tilt_margin_rad", tilt_margin_rad), ("escape_margin_rad", escape_margin_rad)]
        {
            let least = self.limits.roll_rad.min(self.limits.pitch_rad);
            require(margin < least, "planner.forecast", name, margin, "less than both tilt limits")?;
        }
        self.decision.validate()?;
        self.controller.validate()
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

impl GroundConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner.ground";
        positive(self.radius_m, place, "radius_m")?;
        positive(self.cell_m, place, "cell_m")?;
        // Two different places inside the window must not share a slot.
        require(
            self.cell_m * crate::ground::SIDE as f64 > 2.0 * self.radius_m,
            place,
            "cell_m",
            self.cell_m,
            "cells large enough that 96 of them span twice radius_m",
        )?;
        not_negative(self.curvature_per_m, place, "curvature_per_m")?;
        require(self.memory_ticks > 0, place, "memory_ticks", self.memory_ticks, "at least 1")
    }
}

impl ForecastConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        let place = "planner.forecast";
        positive(self.step_m, place, "step_m")?;
        not_negative(self.tilt_margin_rad, place, "tilt_margin_rad")?;
        not_negative(self.escape_margin_rad, place, "escape_margin_rad")?;
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
            config.forecast.step_m = step_m;
            config.perception.surface_radius_m = surface_radius_m;
            let error = config.validate().unwrap_err().to_string();
            assert!(error.starts_with("planner.forecast.step_m = "), "{error}");
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

//! The two presets: `default`, the best that is known here, and `paper`.

use super::{
    ControllerConfig, CostModel, DecisionConfig, ElevationWindowConfig, InducingInputs, PerceptionConfig,
    PidGains, PlannerConfig, SegmentConfig, StateLatticeConfig,
};
use crate::gp::kernel::RationalQuadratic;
use crate::gp::learning::{LearningConfig, LearningMode};
use crate::robot_model::RobotModel;
use crate::sensor_model::SensorModel;

impl Default for PlannerConfig {
    fn default() -> Self {
        Self {
            period_s: 0.1,
            goal_tolerance_m: 0.5,
            robot: RobotModel::default(),
            sensor: SensorModel::default(),
            perception: PerceptionConfig::default(),
            segments: SegmentConfig::default(),
            elevation_window: ElevationWindowConfig::default(),
            state_lattice: StateLatticeConfig::default(),
            decision: DecisionConfig::default(),
            controller: ControllerConfig::default(),
        }
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

impl Default for ElevationWindowConfig {
    fn default() -> Self {
        Self { cell_m: 0.2, radius_m: 9.0, memory_ticks: 3000, curvature_per_m: 0.5 }
    }
}

impl Default for StateLatticeConfig {
    fn default() -> Self {
        Self {
            step_m: 0.5,
            tilt_margin_rad: 0.09,
            escape_margin_rad: 0.06,
            impatient_margin_rad: 0.03,
            escape_m: 2.5,
            deviations: 1.0,
            blind_radius_m: 7.5,
            avoids_edges: true,
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
}

//! Every parameter of the planner, with its unit and the paper's value.

mod checks;
mod for_robot;
mod presets;

use crate::gp::kernel::RationalQuadratic;
use crate::gp::learning::LearningConfig;
use crate::robot_model::RobotModel;
use crate::sensor_model::SensorModel;

/// The planner's configuration. [`PlannerConfig::default`] is the best mapless choice known here, and
/// [`PlannerConfig::paper`] the paper's text as literally as it allows.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PlannerConfig {
    /// Time between steps, seconds. Paper: 0.1 (10 Hz).
    pub period_s: f64,
    /// The goal counts as reached within this distance, metres. Paper: not given.
    pub goal_tolerance_m: f64,
    /// The robot.
    pub robot: RobotModel,
    /// The LiDAR and where it sits.
    pub sensor: SensorModel,
    /// From scan to variance surface and profile.
    pub perception: PerceptionConfig,
    /// From profile to segments and subgoals.
    pub segments: SegmentConfig,
    /// What is remembered of the ground for the forecast.
    pub elevation_window: ElevationWindowConfig,
    /// StateLattice over that ground, and the tilt they promise.
    pub state_lattice: StateLatticeConfig,
    /// The cost of a subgoal.
    pub decision: DecisionConfig,
    /// The PID controller.
    pub controller: ControllerConfig,
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
pub struct ElevationWindowConfig {
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
pub struct StateLatticeConfig {
    /// Spacing of the places looked at, metres.
    pub step_m: f64,
    /// How far inside the tilt limits a way stays, radians.
    pub tilt_margin_rad: f64,
    /// The least margin, radians: for ground that is the last choice, for turns on the spot, and for a robot that has to get away.
    pub escape_margin_rad: f64,
    /// What takes the place of the least margin once the robot has lost its patience, radians.
    pub impatient_margin_rad: f64,
    /// How far from a robot that finds no way at all the least margin suffices, without what is uncertain, metres.
    pub escape_m: f64,
    /// Standard deviations of the predicted slope added to it before it is compared.
    pub deviations: f64,
    /// Unseen ground bridged next to the robot, where no beam reaches, metres.
    pub blind_radius_m: f64,
    /// Whether ground that would have been seen if it went on, and was not, counts as an edge to keep away from. From above the sensor
    /// cannot tell an edge from a slope that begins with a corner of more than 15°; without this the robot drives over both.
    pub avoids_edges: bool,
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

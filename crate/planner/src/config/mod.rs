//! Every parameter of the planner: one entry each, with its description, default, the paper's value, unit, the range that
//! makes sense and the check that it must pass. [`mapless_parameters`] says how an entry is written.

mod checks;
mod presets;

use core::time::Duration;

use mapless_parameters::{choices, parameters};

use crate::gp::kernel::RationalQuadratic;
use crate::gp::learning::LearningConfig;
use crate::robot_model::RobotModel;
use crate::sensor_model::SensorModel;

parameters! {
    /// The planner's configuration. [`PlannerConfig::default`] is the best mapless choice known here, and
    /// [`PlannerConfig::paper`] the paper's text as literally as it allows.
    pub struct PlannerConfig {
        /// The goal counts as reached within this distance.
        goal_tolerance_m: f64 = 0.5, unit "m", range [0.1, 3.0], check Positive;
    }
    tables {
        /// The robot.
        robot: RobotModel;
        /// The LiDAR and where it sits.
        sensor: SensorModel;
        /// From scan to variance surface and profile.
        perception: PerceptionConfig;
        /// From profile to segments and subgoals.
        segments: SegmentConfig;
        /// What is remembered of the ground.
        elevation_window: ElevationWindowConfig;
        /// Paths over that ground, and the tilt they promise.
        state_lattice: StateLatticeConfig;
        /// The cost of a subgoal.
        decision: DecisionConfig;
        /// The PID controller.
        controller: ControllerConfig;
    }
    relations check_relations;
}

parameters! {
    /// The occupancy surface and the sparse Gaussian process over it.
    #[derive(Copy)]
    pub struct PerceptionConfig {
        /// Radius r_oc of the occupancy surface: only returns within it count.
        surface_radius_m: f64 = 7.0, paper 7.0, unit "m", range [3.0, 9.0], check Positive;
        /// Share V_th of the signal variance above which a direction counts as free.
        variance_threshold: f64 = 0.3, paper 0.7, range [0.02, 0.98], check Share;
        /// Noise variance σₙ² of the occupancy of one cell. The paper learns it.
        noise_variance_m2: f64 = 3.0, unit "m²", range [0.001, 10.0], check Positive;
        /// Where the sparse process puts its inducing inputs: on the lattice of the beams, or among the returns.
        inducing_inputs: InducingInputs = InducingInputs::Lattice;
        /// Spacing of the inducing inputs: at most this on the lattice, at least this with farthest points. Closer is more
        /// exact and slower.
        inducing_spacing_length_scales: f64 = 0.95, unit "length-scales", range [0.4, 2.0], check Positive;
        /// Most inducing inputs with farthest points. The authors' earlier code uses 400 to 500.
        max_inducing_inputs: usize = 1000, range [50, 2000], check AtLeast(1.0);
    }
    tables {
        /// The kernel, or where learning it starts. The paper learns an isotropic one.
        kernel: RationalQuadratic;
        /// Whether and how the kernel and the noise are learned.
        learning: LearningConfig;
    }
    relations check_learning;
}

choices! {
    /// How inducing inputs are placed.
    pub enum InducingInputs {
        /// On the lattice of the sensor's columns and rings, wherever there are returns.
        Lattice = "lattice",
        /// Among the returns, each the farthest from those before it, until every return is near one.
        FarthestPoints = "farthest_points",
    }
}

parameters! {
    /// Segments and subgoals.
    #[derive(Copy)]
    pub struct SegmentConfig {
        /// A column joins a segment while its elevation is this near to the segment's mean.
        elevation_tolerance_rad: f64 = 0.05, unit "rad", range [0.01, 0.3], check Angle;
        /// Margin δ added to the robot's width.
        safety_margin_m: f64 = 0.3, unit "m", range [0.0, 1.5], check NotNegative;
        /// Steepest rise or fall to the skyline that counts as climbable.
        max_slope_rad: f64 = 0.5, unit "rad", range [0.1, 1.2], check Angle;
        /// Whether directions without returns may carry subgoals, on ground that earlier scans saw.
        subgoals_on_unknown: bool = true, paper false;
    }
}

parameters! {
    /// The elevation window: what is remembered of the ground.
    #[derive(Copy)]
    pub struct ElevationWindowConfig {
        /// Side of a cell.
        cell_m: f64 = 0.2, unit "m", range [0.19, 0.5], check Positive;
        /// Returns within this range are remembered. A little more than r_oc, so that a robot on a knoll, which hides what is
        /// nearer, knows where the ground goes on.
        radius_m: f64 = 9.0, unit "m", range [3.0, 9.5], check Positive;
        /// Time after which ground that was not seen again is forgotten.
        memory_s: f64 = 300.0, unit "s", range [1.0, 300.0], check Within(0.0, 3.2e7);
        /// Standard deviation of the slope of ground for each metre that it lies from what was seen of it.
        slope_deviation_per_m: f64 = 0.5, unit "1/m", range [0.0, 3.0], check NotNegative;
    }
    relations check_span;
}

parameters! {
    /// The state lattice: paths over the remembered ground, and the tilt they promise.
    #[derive(Copy)]
    pub struct StateLatticeConfig {
        /// Spacing of the places on a path.
        step_m: f64 = 0.5, unit "m", range [0.2, 2.0], check AtLeast(0.2);
        /// How far inside the tilt limits a path stays.
        tilt_margin_rad: f64 = 0.09, unit "rad", range [0.0, 0.4], check NotNegative;
        /// The least margin: for ground that is the last choice, for turns on the spot, and for a robot that has to get away.
        recovery_margin_rad: f64 = 0.06, unit "rad", range [0.0, 0.4], check NotNegative;
        /// What takes the place of the least margin once the robot has spent its detour budget, twice the straight line.
        over_budget_margin_rad: f64 = 0.03, unit "rad", range [0.0, 0.4], check NotNegative;
        /// How far from a robot that finds no path at all the least margin suffices, without what is uncertain.
        recovery_radius_m: f64 = 2.5, unit "m", range [0.0, 10.0], check NotNegative;
        /// Standard deviations of the predicted slope that are added to it before it is compared.
        slope_deviations: f64 = 1.0, range [0.0, 4.0], check NotNegative;
        /// Unseen ground that is bridged next to the robot, where no beam reaches.
        blind_radius_m: f64 = 7.5, unit "m", range [0.0, 12.0], check NotNegative;
        /// Whether the robot keeps away from negative obstacles: places where ground would have been seen if it went on, and was
        /// not. From above the sensor cannot tell a cliff from a slope that begins with a corner of more than 15°.
        avoids_negative_obstacles: bool = true;
        /// What a metre at the tilt limit costs beyond itself, in metres of level ground; in between with the square of the slope.
        tilt_price: f64 = 4.0, range [0.0, 5.0], check NotNegative;
        /// What a metre up or down costs beyond the path itself, in metres of level ground.
        climb_price: f64 = 4.0, range [0.0, 20.0], check NotNegative;
        /// What turning by a sixteenth of a circle costs, in metres driven.
        turn_cost_m: f64 = 0.15, unit "m", range [0.1, 2.0], check AtLeast(0.1);
        /// What it costs to begin otherwise than was meant before, in metres driven; twice that with each change nearby.
        change_cost_m: f64 = 1.0, unit "m", range [0.0, 5.0], check NotNegative;
        /// What a metre in reverse costs, in metres forward; without rear sight it is the last choice.
        reverse_price: f64 = 2.0, range [1.0, 10.0], check AtLeast(1.0);
        /// How far before steep or unseen ground a subgoal is placed.
        clearance_m: f64 = 0.7, unit "m", range [0.0, 3.0], check NotNegative;
        /// Nearer than this, a subgoal is refused.
        min_reach_m: f64 = 1.0, unit "m", range [0.0, 5.0], check NotNegative;
    }
}

choices! {
    /// How steepness is judged and the terms are scaled.
    pub enum CostModel {
        /// The paper's eq. 6: steepness from the subgoal's height and the robot's pitch; each term divided by its greatest
        /// value over the candidates.
        Paper = "paper",
        /// Steepness from the tilt forecast; every term on a fixed physical scale.
        Forecast = "forecast",
    }
}

parameters! {
    /// The cost function J.
    #[derive(Copy)]
    pub struct DecisionConfig {
        /// Steepness from the subgoal's height (paper) or from the forecast of the tilt on the path.
        cost_model: CostModel = CostModel::Forecast, paper CostModel::Paper;
        /// Charge k_dir for turning away from the heading.
        direction_weight: f64 = 0.2, paper 0.2, range [0.0, 3.0], check NotNegative;
        /// Charge k_dst for what remains to the goal.
        distance_weight: f64 = 1.0, paper 0.3, range [0.0, 3.0], check NotNegative;
        /// Charge k_stp for steep paths.
        steepness_weight: f64 = 1.0, paper 0.5, range [0.0, 3.0], check NotNegative;
        /// Metres of level ground that a metre up or down counts for in the distance.
        climb_weight: f64 = 1.0, paper 0.0, range [0.0, 5.0], check NotNegative;
        /// Charge for leaving the last choice.
        commitment_weight: f64 = 0.3, paper 0.0, range [0.0, 3.0], check NotNegative;
        /// Charge for the learned correction of the way that remains, which grows where the robot had to turn back, on the
        /// scale of the distance.
        correction_weight: f64 = 1.0, paper 0.0, range [0.0, 3.0], check NotNegative;
        /// Time spent turning on the spot without a candidate before giving up.
        spin_recovery_s: f64 = 15.0, unit "s", range [0.1, 60.0], check Within(0.0, 3.2e7);
    }
}

parameters! {
    /// Gains of one PID loop.
    #[derive(Copy)]
    pub struct PidGains {
        /// Command per unit of error.
        proportional: f64 = 0.0, unit "1/s", range [0.0, 8.0], check NotNegative;
        /// Command per unit of error and second.
        integral: f64 = 0.0, unit "1/s²", range [0.0, 2.0], check NotNegative;
        /// Command per unit of error a second.
        derivative: f64 = 0.0, range [0.0, 2.0], check NotNegative;
    }
}

parameters! {
    /// The controller.
    #[derive(Copy)]
    pub struct ControllerConfig {
        /// Speed limit.
        max_speed_m_s: f64 = 0.8, paper 0.8, unit "m/s", range [0.1, 3.0], check Positive;
        /// Turn-rate limit.
        max_turn_rate_rad_s: f64 = 1.0, unit "rad/s", range [0.1, 3.0], check Positive;
        /// The robot turns in place while its heading is off by more than this.
        rotate_in_place_rad: f64 = 0.8, unit "rad", range [0.1, 1.5], check Angle;
        /// Turn rate while it searches for a candidate.
        spin_turn_rate_rad_s: f64 = 0.5, unit "rad/s", range [0.1, 2.0], check Positive;
        /// Share of a tilt limit from which on the robot drives more slowly, in proportion to what is left of it: so that it
        /// can stop before what it did not foresee.
        regulate_from_utilisation: f64 = 0.3, range [0.0, 0.95], check Below(1.0);
        /// The least share of its speed that it keeps.
        min_speed_share: f64 = 0.2, range [0.05, 1.0], check UpTo(1.0);
    }
    tables {
        /// Distance loop: metres to metres a second.
        distance: PidGains = PidGains { proportional: 0.8, ..PidGains::default() };
        /// Yaw loop: radians to radians a second.
        yaw: PidGains = PidGains { proportional: 1.5, ..PidGains::default() };
    }
}

/// Cells on a side of the elevation window.
pub(crate) const WINDOW_CELLS: usize = 96;

impl ElevationWindowConfig {
    /// Time after which ground that is not seen again is forgotten.
    pub(crate) fn memory(&self) -> Duration {
        Duration::from_secs_f64(self.memory_s)
    }
}

impl DecisionConfig {
    /// How long the robot turns in place without a candidate before it gives up.
    pub(crate) fn spin_recovery(&self) -> Duration {
        Duration::from_secs_f64(self.spin_recovery_s)
    }
}

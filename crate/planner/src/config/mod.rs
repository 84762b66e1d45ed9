//! Every parameter of the planner, one entry each: description, default, the paper's value, unit, range and
//! check. [`mapless_parameters`] describes the form of an entry.

mod checks;
mod presets;

use core::f64::consts::TAU;
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
        /// The LiDAR and its mount.
        sensor: SensorModel;
        /// From scan to variance surface and profile.
        perception: PerceptionConfig;
        /// From profile to segments and subgoals.
        segments: SegmentConfig;
        /// The elevation window: seen ground around the robot.
        elevation_window: ElevationWindowConfig;
        /// The state lattice: paths over the elevation window, and their predicted tilt.
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
        /// What the skyline is read from.
        skyline: Skyline = Skyline::VarianceSurface;
        /// Share V_th of the signal variance above which a direction counts as free.
        variance_threshold: f64 = 0.3, paper 0.7, range [0.02, 0.98], check Share;
        /// Noise variance σₙ² of the occupancy of one cell. The paper learns it.
        noise_variance_m2: f64 = 3.0, unit "m²", range [0.001, 10.0], check Positive;
        /// Placement of the inducing inputs: on the lattice of the beams, or among the returns.
        inducing_inputs: InducingInputs = InducingInputs::Lattice;
        /// Spacing of the inducing inputs: at most this on the lattice, at least this with farthest points.
        /// Closer is more exact and slower.
        inducing_spacing_length_scales: f64 = 0.95, unit "length-scales", range [0.4, 2.0], check Positive;
        /// Most inducing inputs with farthest points. The authors' earlier code uses 400 to 500.
        max_inducing_inputs: usize = 1000, range [50, 2000], check AtLeast(1.0);
    }
    tables {
        /// The kernel, or the start of learning it. The paper learns an isotropic one.
        kernel: RationalQuadratic;
        /// Whether and how the kernel and the noise are learned.
        learning: LearningConfig;
    }
    relations check_learning;
}

choices! {
    /// What the skyline is read from.
    pub enum Skyline {
        /// The edge of the variance surface of the Gaussian process.
        VarianceSurface = "variance_surface",
        /// Half a ring above the highest return of each column, where ground ends on average, without a
        /// Gaussian process: to see what that is worth.
        HighestReturns = "highest_returns",
    }
}

choices! {
    /// Placement of the inducing inputs.
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
        /// Whether directions without returns may carry subgoals, on ground already in the elevation window.
        subgoals_on_unknown: bool = true, paper false;
    }
}

parameters! {
    /// The elevation window.
    #[derive(Copy)]
    pub struct ElevationWindowConfig {
        /// Side of a cell.
        cell_m: f64 = 0.2, unit "m", range [0.19, 0.5], check Positive;
        /// Returns within this range are kept. A little more than r_oc: on a knoll, which hides nearer
        /// ground, the robot still knows the ground beyond.
        radius_m: f64 = 9.0, unit "m", range [3.0, 9.5], check Positive;
        /// Time after which ground that was not seen again is forgotten.
        memory_s: f64 = 300.0, unit "s", range [1.0, 300.0], check Within(0.0, 3.2e7);
        /// Standard deviation of the slope for each metre from the nearest seen ground.
        slope_deviation_per_m: f64 = 0.5, unit "1/m", range [0.0, 3.0], check NotNegative;
    }
    relations check_span;
}

parameters! {
    /// The state lattice.
    #[derive(Copy)]
    pub struct StateLatticeConfig {
        /// Spacing of the places of the lattice.
        step_m: f64 = 0.5, unit "m", range [0.2, 2.0], check AtLeast(0.2);
        /// How far inside the tilt limits a path stays.
        tilt_margin_rad: f64 = 0.09, unit "rad", range [0.0, 0.4], check NotNegative;
        /// Smallest margin: on tight ground, for turns on the spot and in recovery.
        recovery_margin_rad: f64 = 0.06, unit "rad", range [0.0, 0.4], check NotNegative;
        /// Smallest margin once the detour budget, twice the straight line, is used up.
        over_budget_margin_rad: f64 = 0.03, unit "rad", range [0.0, 0.4], check NotNegative;
        /// Radius around a robot without a path within which the smallest margin suffices.
        recovery_radius_m: f64 = 2.5, unit "m", range [0.0, 10.0], check NotNegative;
        /// Standard deviations of the predicted slope added to it before it is compared.
        slope_deviations: f64 = 1.0, range [0.0, 4.0], check NotNegative;
        /// Length of the virtual surface over unseen ground next to the robot.
        blind_radius_m: f64 = 7.5, unit "m", range [0.0, 12.0], check NotNegative;
        /// Whether the robot keeps away from negative obstacles: ground that should have been seen and was
        /// not. That is a cliff, or a slope down that begins with a corner of more than 15°.
        avoids_negative_obstacles: bool = true;
        /// Whether the robot keeps belly and bumpers off the ground, and its wheels out of holes. In a
        /// scenario it follows touches_ground of reality.motion, unless it is set.
        keeps_underside_clear: bool = true;
        /// Cost of a metre at the tilt limit beyond its length, in metres of level ground; it grows with the
        /// square of the slope.
        tilt_price: f64 = 4.0, range [0.0, 5.0], check NotNegative;
        /// Cost of a metre up or down beyond the length of the path, in metres of level ground.
        climb_price: f64 = 4.0, range [0.0, 20.0], check NotNegative;
        /// Cost of turning by a sixteenth of a circle, in metres driven.
        turn_cost_m: f64 = 0.15, unit "m", range [0.1, 2.0], check AtLeast(0.1);
        /// Cost of a metre in reverse, in metres forward; the robot has no rear sight.
        reverse_price: f64 = 2.0, range [1.0, 10.0], check AtLeast(1.0);
        /// How far before steep or unseen ground a subgoal is placed.
        clearance_m: f64 = 0.7, unit "m", range [0.0, 3.0], check NotNegative;
        /// A subgoal nearer than this is refused.
        min_reach_m: f64 = 1.0, unit "m", range [0.0, 5.0], check NotNegative;
    }
}

choices! {
    /// The model of steepness and the scale of the terms.
    pub enum CostModel {
        /// The paper's eq. 6: steepness from the subgoal's height and the robot's pitch; each term divided by
        /// its greatest value over the candidates.
        Paper = "paper",
        /// Steepness from the predicted tilt of the path; every term on a fixed physical scale.
        Forecast = "forecast",
    }
}

parameters! {
    /// The cost function J.
    #[derive(Copy)]
    pub struct DecisionConfig {
        /// Steepness from the subgoal's height (paper) or from the predicted tilt of the path (forecast).
        cost_model: CostModel = CostModel::Forecast, paper CostModel::Paper;
        /// Weight k_dir of turning away from the heading.
        direction_weight: f64 = 0.2, paper 0.2, range [0.0, 3.0], check NotNegative;
        /// Weight k_dst of the remaining distance to the goal.
        distance_weight: f64 = 1.0, paper 0.3, range [0.0, 3.0], check NotNegative;
        /// Weight k_stp of steepness: the mean risk of the path.
        steepness_weight: f64 = 1.0, paper 0.5, range [0.0, 3.0], check NotNegative;
        /// Weight of climb: metres of distance for each metre up or down.
        climb_weight: f64 = 1.0, paper 0.0, range [0.0, 5.0], check NotNegative;
        /// Weight of leaving the last choice.
        commitment_weight: f64 = 0.3, paper 0.0, range [0.0, 3.0], check NotNegative;
        /// Weight of the learned correction of the cost-to-go, on the scale of the distance.
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

choices! {
    /// How the robot follows the path to the chosen subgoal.
    pub enum FollowingLaw {
        /// The paper's PID loops, towards a lookahead point of the path.
        Pid = "pid",
        /// The best trajectory of the next two seconds, by its tilt, its smoothness and its progress along
        /// the path.
        RecedingHorizon = "receding_horizon",
    }
}

parameters! {
    /// What `receding_horizon` optimises. Prices are in metres of level ground.
    #[derive(Copy)]
    pub struct TrajectoryConfig {
        /// Largest acceleration along the body.
        acceleration_m_s2: f64 = 0.8, unit "m/s²", range [0.1, 3.0], check Positive;
        /// Largest acceleration of the turn rate.
        turn_acceleration_rad_s2: f64 = 1.5, unit "rad/s²", range [0.2, 10.0], check Positive;
        /// Largest speed in reverse, as a share of that forward.
        reverse_share: f64 = 0.5, range [0.1, 1.0], check UpTo(1.0);
        /// Price of a second at 1 (rad/s²)².
        turn_smoothness: f64 = 0.8, range [0.0, 5.0], check NotNegative;
        /// Price of a second at 1 (m/s²)².
        speed_smoothness: f64 = 0.28, range [0.0, 5.0], check NotNegative;
        /// What a metre of the path is worth, as a multiple of its cost. Above the price of a metre at the
        /// tilt limit, so that progress along a path that was found safe always pays.
        progress_weight: f64 = 5.5, range [1.0, 20.0], check AtLeast(1.0);
        /// Price of a square metre of (distance from the path)².
        aside_price: f64 = 0.6, range [0.0, 5.0], check NotNegative;
    }
}

parameters! {
    /// The controller.
    #[derive(Copy)]
    pub struct ControllerConfig {
        /// How the path to the chosen subgoal is followed. The policy of the paper always has the PID loops.
        following: FollowingLaw = FollowingLaw::RecedingHorizon, paper FollowingLaw::Pid;
        /// Speed limit.
        max_speed_m_s: f64 = 0.8, paper 0.8, unit "m/s", range [0.1, 3.0], check Positive;
        /// Turn-rate limit.
        max_turn_rate_rad_s: f64 = 1.0, unit "rad/s", range [0.1, 3.0], check Positive;
        /// The robot turns on the spot while its heading is off by more than this.
        rotate_in_place_rad: f64 = 0.8, unit "rad", range [0.1, 1.5], check Angle;
        /// Turn rate of the spin recovery.
        spin_turn_rate_rad_s: f64 = 0.5, unit "rad/s", range [0.1, 2.0], check Positive;
        /// Tilt utilisation from which on the speed is reduced, in proportion to the rest: a slower robot
        /// stops sooner on unexpected slopes.
        regulate_from_utilisation: f64 = 0.3, range [0.0, 0.95], check Below(1.0);
        /// Smallest share of the speed that is kept.
        min_speed_share: f64 = 0.2, range [0.05, 1.0], check UpTo(1.0);
    }
    tables {
        /// Distance loop: metres to metres a second.
        distance: PidGains = PidGains { proportional: 0.8, ..PidGains::default() };
        /// Yaw loop: radians to radians a second.
        yaw: PidGains = PidGains { proportional: 1.5, ..PidGains::default() };
        /// The optimised trajectory.
        trajectory: TrajectoryConfig;
    }
}

/// Bounds on the cells on a side of the elevation window, and the cells beyond its radius.
const LEAST_CELLS_PER_SIDE: usize = 96;
const MOST_CELLS_PER_SIDE: usize = 1024;
const SPARE_CELLS: usize = 6;

/// [`StateLatticeConfig::turn_cost_m`] is that of so many parts of a circle.
const HEADINGS_OF_TURN_COST: f64 = 16.0;

impl ElevationWindowConfig {
    /// Cells on a side, such that no two places inside the window share a slot.
    pub(crate) fn cells_per_side(&self) -> usize {
        let spanned = (2.0 * self.radius_m / self.cell_m).ceil() as usize;
        spanned.saturating_add(SPARE_CELLS).max(LEAST_CELLS_PER_SIDE)
    }

    /// Time after which ground that is not seen again is forgotten.
    pub(crate) fn memory(&self) -> Duration {
        Duration::from_secs_f64(self.memory_s)
    }
}

impl StateLatticeConfig {
    /// Cost of a radian turned, in metres driven.
    pub(crate) fn turn_m_rad(&self) -> f64 {
        self.turn_cost_m * HEADINGS_OF_TURN_COST / TAU
    }
}

impl ControllerConfig {
    /// Largest speed in reverse.
    pub(crate) fn reverse_m_s(&self) -> f64 {
        self.trajectory.reverse_share * self.max_speed_m_s
    }

    /// Share of the speed that is kept at a tilt utilisation.
    pub(crate) fn speed_share(&self, utilisation: f64) -> f64 {
        ((1.0 - utilisation) / (1.0 - self.regulate_from_utilisation)).clamp(self.min_speed_share, 1.0)
    }
}

impl DecisionConfig {
    /// Longest spin recovery without a candidate.
    pub(crate) fn spin_recovery(&self) -> Duration {
        Duration::from_secs_f64(self.spin_recovery_s)
    }
}

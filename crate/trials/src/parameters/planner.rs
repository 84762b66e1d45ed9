//! The planner's parameters.

use super::Kind::{Choice, Number, Pair, Switch, Whole};
use super::{Group, given, open};

pub(super) const GROUPS: &[Group] = &[
    Group {
        table: "planner",
        title: "Planner",
        parameters: &[
            given("period_s", "s", Number(0.05, 0.5), "0.1", "Time between two decisions."),
            open(
                "goal_tolerance_m",
                "m",
                Number(0.1, 3.0),
                "The goal counts as reached within this distance.",
            ),
            open(
                "robot_width_m",
                "m",
                Number(0.3, 1.5),
                "Width that a segment must let through. Follows the robot's own width unless set.",
            ),
            open(
                "wheelbase_m",
                "m",
                Number(0.2, 1.5),
                "From front to rear axle, to foresee how the robot stands. Follows the robot's own unless set.",
            ),
            open(
                "track_m",
                "m",
                Number(0.2, 1.5),
                "From left to right wheels, to foresee how the robot stands. Follows the robot's own unless set.",
            ),
        ],
    },
    Group {
        table: "planner.perception",
        title: "Perception",
        parameters: &[
            given(
                "surface_radius_m",
                "m",
                Number(3.0, 9.0),
                "7.0",
                "Radius of the occupancy surface: only returns within it count.",
            ),
            given(
                "variance_threshold",
                "",
                Number(0.02, 0.98),
                "0.7",
                "Share of the signal variance above which a direction counts as free.",
            ),
            open(
                "noise_variance_m2",
                "m²",
                Number(0.001, 10.0),
                "Noise variance of the occupancy of one cell. The paper learns it.",
            ),
            open(
                "inducing_inputs",
                "",
                Choice(&["lattice", "farthest_points"]),
                "Where the sparse process puts its inducing inputs: on the lattice of the beams, or among the returns.",
            ),
            open(
                "inducing_spacing_length_scales",
                "length-scales",
                Number(0.4, 2.0),
                "Spacing of the inducing inputs. Closer is more exact and slower.",
            ),
            open("max_inducing_inputs", "", Whole(50, 2000), "Most inducing inputs with farthest points."),
        ],
    },
    Group {
        table: "planner.perception.kernel",
        title: "Kernel",
        parameters: &[
            open(
                "variance",
                "m²",
                Number(0.05, 10.0),
                "Signal variance of the occupancy. The paper learns it.",
            ),
            open(
                "length_scales_rad",
                "rad",
                Pair(0.01, 0.5),
                "Length-scales over azimuth and elevation. The paper learns one for both.",
            ),
            open(
                "alpha",
                "",
                Number(0.5, 50.0),
                "Weighting of length-scales in the rational quadratic. Whole numbers are faster.",
            ),
        ],
    },
    Group {
        table: "planner.perception.learning",
        title: "Learning",
        parameters: &[
            given(
                "mode",
                "",
                Choice(&["fixed", "once", "every_scan"]),
                "\"every_scan\"",
                "When the kernel and the noise are learned.",
            ),
            open("optimiser", "", Choice(&["lbfgs", "adam"]), "Method that climbs the bound."),
            open(
                "evaluations_per_scan",
                "",
                Whole(2, 200),
                "Evaluations of the bound for each scan learned from.",
            ),
            given(
                "learn_inducing_inputs",
                "",
                Switch,
                "true",
                "Whether the inducing inputs move too. Not with the lattice.",
            ),
            given("isotropic", "", Switch, "true", "Whether one length-scale serves both axes."),
        ],
    },
    Group {
        table: "planner.perception.learning.bounds",
        title: "Bounds of learning",
        parameters: &[
            open("variance_m2", "m²", Pair(0.05, 10.0), "Lowest and highest signal variance."),
            open(
                "azimuth_length_scale_rad",
                "rad",
                Pair(0.01, 0.5),
                "Lowest and highest length-scale over azimuth.",
            ),
            open(
                "elevation_length_scale_rad",
                "rad",
                Pair(0.01, 0.5),
                "Lowest and highest length-scale over elevation.",
            ),
            open("alpha", "", Pair(0.5, 50.0), "Lowest and highest weighting of length-scales."),
            open("noise_variance_m2", "m²", Pair(0.001, 10.0), "Lowest and highest noise variance."),
        ],
    },
    Group {
        table: "planner.segments",
        title: "Segments and subgoals",
        parameters: &[
            open(
                "elevation_tolerance_rad",
                "rad",
                Number(0.01, 0.3),
                "A column joins a segment while its elevation is this near to the segment's mean.",
            ),
            open("safety_margin_m", "m", Number(0.0, 1.5), "Margin added to the robot's width."),
            open("max_slope_rad", "rad", Number(0.1, 1.2), "Steepest rise or fall that counts as climbable."),
            open(
                "subgoals_on_unknown",
                "",
                Switch,
                "Whether directions without returns may carry subgoals, on ground seen before.",
            ),
        ],
    },
    Group {
        table: "planner.decision",
        title: "Cost of a subgoal",
        parameters: &[
            given(
                "cost_model",
                "",
                Choice(&["paper", "forecast"]),
                "\"paper\"",
                "Steepness from the subgoal's height (paper) or from the forecast of the tilt on the way.",
            ),
            given(
                "direction_weight",
                "",
                Number(0.0, 3.0),
                "0.2",
                "Charge for turning away from the heading.",
            ),
            given("distance_weight", "", Number(0.0, 3.0), "0.3", "Charge for what remains to the goal."),
            given("steepness_weight", "", Number(0.0, 3.0), "0.5", "Charge for steep ways."),
            given("climb_weight", "", Number(0.0, 5.0), "0.0", "Metres that a metre up or down counts for."),
            given("commitment_weight", "", Number(0.0, 3.0), "0.0", "Charge for leaving the last choice."),
            given(
                "dead_end_weight",
                "",
                Number(0.0, 3.0),
                "0.0",
                "Charge for the detour that is known from a place driven over.",
            ),
            open(
                "look_ticks",
                "",
                Whole(1, 600),
                "Decisions spent turning without a candidate before giving up.",
            ),
        ],
    },
    Group {
        table: "planner.forecast",
        title: "Ways and their tilt",
        parameters: &[
            open("step_m", "m", Number(0.2, 2.0), "Spacing of the places looked at on the way."),
            open("tilt_margin_rad", "rad", Number(0.0, 0.4), "How far inside the tilt limits a way stays."),
            open(
                "escape_margin_rad",
                "rad",
                Number(0.0, 0.4),
                "The least margin: for ground that is the last choice, for turns on the spot, and to get away.",
            ),
            open(
                "impatient_margin_rad",
                "rad",
                Number(0.0, 0.4),
                "What takes the place of the least margin once the robot has driven twice the straight way.",
            ),
            open(
                "escape_m",
                "m",
                Number(0.0, 10.0),
                "How far from a robot that finds no way at all the least margin suffices.",
            ),
            open(
                "deviations",
                "",
                Number(0.0, 4.0),
                "Standard deviations of the predicted slope added to it.",
            ),
            open("blind_radius_m", "m", Number(0.0, 12.0), "Unseen ground bridged next to the robot."),
            open(
                "avoids_edges",
                "",
                Switch,
                "Whether the robot keeps away from where ground would have been seen if it went on: an edge, or a steep slope down.",
            ),
            open(
                "tilt_price",
                "",
                Number(0.0, 5.0),
                "What a metre at the tilt limit costs beyond itself, in metres of level ground.",
            ),
            open(
                "climb_price",
                "",
                Number(0.0, 20.0),
                "What a metre up or down costs beyond the way itself, in metres of level ground.",
            ),
            open(
                "turn_cost_m",
                "m",
                Number(0.1, 2.0),
                "What turning by a sixteenth of a circle costs, in metres driven.",
            ),
            open(
                "change_cost_m",
                "m",
                Number(0.0, 5.0),
                "What it costs to begin otherwise than was meant before, in metres driven.",
            ),
            open("reverse_price", "", Number(1.0, 10.0), "What a metre in reverse costs, in metres forward."),
            open(
                "clearance_m",
                "m",
                Number(0.0, 3.0),
                "How far before steep or unseen ground a subgoal stands.",
            ),
            open("min_reach_m", "m", Number(0.0, 5.0), "Nearer than this, a subgoal is refused."),
        ],
    },
    Group {
        table: "planner.ground",
        title: "Memory of the ground",
        parameters: &[
            open("cell_m", "m", Number(0.19, 0.5), "Side of a cell."),
            open("radius_m", "m", Number(3.0, 9.5), "Returns within this range are remembered."),
            open("memory_ticks", "", Whole(10, 3000), "Decisions after which unseen ground is forgotten."),
            open(
                "curvature_per_m",
                "1/m",
                Number(0.0, 3.0),
                "Standard deviation of the slope for each metre from what was seen of the ground.",
            ),
        ],
    },
    Group {
        table: "planner.controller",
        title: "Controller",
        parameters: &[
            given("max_speed_m_s", "m/s", Number(0.1, 3.0), "0.8", "Speed limit."),
            open("max_turn_rate_rad_s", "rad/s", Number(0.1, 3.0), "Turn-rate limit."),
            open(
                "turn_first_rad",
                "rad",
                Number(0.1, 1.5),
                "The robot turns in place while it is off by more.",
            ),
            open(
                "look_turn_rate_rad_s",
                "rad/s",
                Number(0.1, 2.0),
                "Turn rate while it looks for a candidate.",
            ),
            open(
                "slow_from_share",
                "",
                Number(0.0, 0.95),
                "Share of a tilt limit from which on the robot drives more slowly.",
            ),
            open("least_speed_share", "", Number(0.05, 1.0), "The least share of its speed that it keeps."),
        ],
    },
    Group {
        table: "planner.controller.distance",
        title: "Distance loop",
        parameters: &[
            open("proportional", "1/s", Number(0.0, 5.0), "Speed per metre of distance."),
            open("integral", "1/s²", Number(0.0, 2.0), "Per metre of distance and second."),
            open("derivative", "", Number(0.0, 2.0), "Per metre a second of change."),
        ],
    },
    Group {
        table: "planner.controller.yaw",
        title: "Heading loop",
        parameters: &[
            open("proportional", "1/s", Number(0.0, 8.0), "Turn rate per radian of error."),
            open("integral", "1/s²", Number(0.0, 2.0), "Per radian of error and second."),
            open("derivative", "", Number(0.0, 2.0), "Per radian a second of change."),
        ],
    },
    Group {
        table: "planner.limits",
        title: "Tilt limits the planner keeps",
        parameters: &[
            given(
                "roll_rad",
                "rad",
                Number(0.1, 1.2),
                "0.524",
                "Largest |roll|. Follows the robot's own limit unless set.",
            ),
            given(
                "pitch_rad",
                "rad",
                Number(0.1, 1.2),
                "0.785",
                "Largest |pitch|. Follows the robot's own limit unless set.",
            ),
        ],
    },
    Group {
        table: "planner.mount",
        title: "Where the planner believes the sensor",
        parameters: &[
            open(
                "forward_m",
                "m",
                Number(-1.0, 1.0),
                "Ahead of the middle of the wheels. Follows the sensor unless set.",
            ),
            open("height_m", "m", Number(0.2, 3.0), "Above the ground. Follows the sensor unless set."),
        ],
    },
];

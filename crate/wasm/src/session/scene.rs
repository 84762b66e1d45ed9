//! What changes only between trials and with the route.

use mapless::SensorModel;
use mapless::skyline::columns::COLUMNS;
use mapless_trials::RealityPreset;
use serde::Serialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::Session;
use crate::places::{Goal, Heading, Place};
use crate::shared::give;

/// What a scenario is made of, after its files were read.
#[derive(Debug, Serialize, Tsify)]
pub struct Scene {
    /// Of the sensor's noise.
    seed: u64,
    start: Heading,
    /// Driven to one after the other, before the goal.
    waypoints: Vec<Place>,
    goal: Goal,
    /// Time between two ticks.
    period_s: f64,
    limits: TiltLimits,
    /// Radius of the occupancy surface: what lies farther is not looked at.
    occupancy_radius_m: f64,
    mount: Mount,
    image: ImageSize,
    demands: SegmentDemands,
    /// The preset whose values `reality` has, `own` where they are those of none.
    #[tsify(type = "'ideal' | 'field' | 'harsh' | 'own'")]
    reality: &'static str,
}

/// Where the sensor sits on the robot and how it is turned there, as the planner is told.
#[derive(Debug, Serialize, Tsify)]
pub struct Mount {
    /// Ahead of the point on the ground between the wheels.
    forward_m: f64,
    left_m: f64,
    /// Above the ground contact, along the body's z axis.
    height_m: f64,
    /// Left side up; π upside down. The mount is turned by yaw, pitch, roll.
    roll_rad: f64,
    /// Nose-up.
    pitch_rad: f64,
    yaw_rad: f64,
}

impl From<&SensorModel> for Mount {
    fn from(sensor: &SensorModel) -> Self {
        Self {
            forward_m: sensor.forward_m,
            left_m: sensor.left_m,
            height_m: sensor.height_m,
            roll_rad: sensor.roll_rad,
            pitch_rad: sensor.pitch_rad,
            yaw_rad: sensor.yaw_rad,
        }
    }
}

/// How far the robot may tilt.
#[derive(Debug, Serialize, Tsify)]
pub struct TiltLimits {
    roll_rad: f64,
    pitch_rad: f64,
}

/// Lattice of the predicted surfaces; the observed one has a row for each ring of the sensor.
#[derive(Debug, Serialize, Tsify)]
pub struct ImageSize {
    columns: usize,
    rows: usize,
    rings: usize,
}

/// What a segment must be to carry subgoals.
#[derive(Debug, Serialize, Tsify)]
pub struct SegmentDemands {
    /// Wider than the robot's width and the margin on it together.
    robot_width_m: f64,
    safety_margin_m: f64,
    /// The skyline no higher and no lower than this, seen from the sensor's foot.
    max_slope_rad: f64,
    /// Whether columns without a return may carry subgoals, on ground that earlier scans saw.
    subgoals_on_unknown: bool,
}

#[wasm_bindgen]
impl Session {
    /// What changes only between trials and with the route.
    ///
    /// # Errors
    /// A seed beyond the whole numbers of JavaScript.
    pub fn scene(&self) -> Result<Ts<Scene>, JsError> {
        let trial = &self.shown().trial;
        // A new route holds before it is thought about.
        let route = &self.now.trial;
        let config = trial.planner_config();
        let grid = trial.step().observed.grid();
        give(&Scene {
            seed: self.seed,
            start: route.start().into(),
            waypoints: route.waypoints_m().iter().copied().map(Place::from).collect(),
            goal: Goal::new(route.goal_m(), route.goal_heading_rad()),
            period_s: trial.period_s(),
            limits: TiltLimits {
                roll_rad: config.robot.roll_limit_rad,
                pitch_rad: config.robot.pitch_limit_rad,
            },
            occupancy_radius_m: config.perception.surface_radius_m,
            mount: Mount::from(&config.sensor),
            image: ImageSize { columns: COLUMNS, rows: grid.rows(), rings: grid.rings() },
            demands: SegmentDemands {
                robot_width_m: config.robot.width_m,
                safety_margin_m: config.segments.safety_margin_m,
                max_slope_rad: config.segments.max_slope_rad,
                subgoals_on_unknown: config.segments.subgoals_on_unknown,
            },
            reality: self.setting().0.reality.matching_preset().map_or("own", RealityPreset::word),
        })
    }
}

//! A trial that somebody's own planner drives, outside this module: it is asked on each scan, and its command
//! comes back later.

use core::time::Duration;
use std::collections::BTreeMap;

use glam::Vec3;
use mapless::math::angle::difference_rad;
use mapless::{Command, Goal, Pose as PlannerPose};
use mapless_parameters::{Parameter, Value};
use mapless_trials::{Activity, Decision, Navigator, Preset, Question, Scenario, Trial};
use mapless_world::{RobotConfig, SensorConfig};
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::ground::Ground;
use crate::shared::{Overrides, Pose, changed, give, read};
use crate::trial_status::TrialStatus;

/// A final heading is reached within this.
const HEADING_TOLERANCE_RAD: f64 = 0.05;

/// Drives by the command that it was told last. Whether the robot has arrived is judged here, by the rule for
/// every planner.
struct Guest {
    command: Command,
    goal_tolerance_m: f64,
    max_speed_m_s: f64,
}

impl Navigator for Guest {
    fn navigate(&mut self, _: &[Vec3], pose: &PlannerPose, goal: &Goal, _: Duration) -> Decision {
        let away_m = goal.position_m.distance(pose.plan_m());
        let turned = goal.heading_rad.is_none_or(|heading_rad| {
            difference_rad(heading_rad, pose.yaw_rad).abs() <= HEADING_TOLERANCE_RAD
        });
        if away_m <= goal.tolerance_m.unwrap_or(self.goal_tolerance_m) && turned {
            return Decision { activity: Activity::Arrived, command: Command::STOP };
        }
        Decision { activity: Activity::Driving, command: self.command }
    }

    fn max_speed_m_s(&self) -> f64 {
        self.max_speed_m_s
    }

    fn reset(&mut self) {
        self.command = Command::STOP;
    }
}

/// All that such a trial is begun with, on a ground.
#[derive(Debug, Deserialize, Tsify)]
pub struct GuestOptions {
    /// The text of a scenario file, whose terrain is left unread.
    scenario: String,
    /// Set from the beginning.
    overrides: Overrides,
    seed: u64,
}

/// What the planner is told once: the tables `sensor` and `robot` of scenario files.
#[derive(Debug, Serialize, Tsify)]
#[tsify(hashmap_as_object)]
pub struct GuestModel {
    #[tsify(type = "Readonly<Record<string, number>>")]
    sensor: BTreeMap<&'static str, Value>,
    #[tsify(type = "Readonly<Record<string, number>>")]
    robot: BTreeMap<&'static str, Value>,
    /// The goal is reached within this distance.
    goal_tolerance_m: f64,
}

/// What the planner is asked on each scan, besides its points.
#[derive(Debug, Serialize, Tsify)]
pub struct GuestQuestion {
    time_s: f64,
    /// Since the last question.
    elapsed_s: f64,
    /// As the robot believes.
    pose: Pose,
    /// The next waypoint, or the goal.
    goal: GuestGoal,
}

/// Where to.
#[derive(Debug, Serialize, Tsify)]
pub struct GuestGoal {
    x: f64,
    y: f64,
    /// The heading to end with; any where there is none.
    heading_rad: Option<f64>,
}

/// One trial of somebody's own planner. Each tick is `look`, then `question`, `points` and `answer` if that
/// gave true, then `act`.
#[wasm_bindgen]
#[allow(missing_debug_implementations)]
pub struct GuestRunner {
    trial: Trial<Guest>,
    question: Option<Question>,
    model: GuestModel,
}

#[wasm_bindgen]
impl GuestRunner {
    /// Puts the scenario's robot on the ground.
    ///
    /// # Errors
    /// A fault in the scenario or a value that makes no sense, with its place and what was expected.
    #[wasm_bindgen(constructor)]
    pub fn new(ground: &Ground, options: Ts<GuestOptions>) -> Result<GuestRunner, JsError> {
        let GuestOptions { scenario, overrides, seed } = read(options)?;
        let scenario = changed(&Scenario::parse("scenario.toml", &scenario)?, &overrides)?;
        let goal_tolerance_m = scenario.planner_config(Preset::Default)?.goal_tolerance_m;
        let (sensor, robot) = (&scenario.sensor, &scenario.robot);
        let guest = Guest { command: Command::STOP, goal_tolerance_m, max_speed_m_s: robot.max_speed_m_s };
        let model = GuestModel {
            sensor: table(SensorConfig::PARAMETERS, &sensor.values()),
            robot: table(RobotConfig::PARAMETERS, &robot.values()),
            goal_tolerance_m,
        };
        let trial = Trial::with_navigator(ground.field.clone(), &scenario, guest, seed)?;
        Ok(GuestRunner { trial, question: None, model })
    }

    /// Sensor and robot.
    ///
    /// # Errors
    /// None, unless JavaScript runs out of memory.
    pub fn model(&self) -> Result<Ts<GuestModel>, JsError> {
        give(&self.model)
    }

    /// Takes a scan; returns whether there is something to decide.
    pub fn look(&mut self) -> bool {
        self.trial.look();
        self.question = self.trial.question();
        self.question.is_some()
    }

    /// What is to be decided on.
    ///
    /// # Errors
    /// Nothing is to be decided now.
    pub fn question(&self) -> Result<Ts<GuestQuestion>, JsError> {
        let Question { pose, goal, elapsed } = self.asked()?;
        give(&GuestQuestion {
            time_s: self.trial.time_s(),
            elapsed_s: elapsed.as_secs_f64(),
            pose: pose.into(),
            goal: GuestGoal { x: goal.position_m.x, y: goal.position_m.y, heading_rad: goal.heading_rad },
        })
    }

    /// x, y, z of each return of the scan, in the sensor frame.
    pub fn points(&self) -> Vec<f32> {
        self.trial.scan().points.iter().flat_map(|point| point.to_array()).collect()
    }

    /// Takes the answer.
    ///
    /// # Errors
    /// Nothing is to be decided now, or the command is not finite.
    pub fn answer(&mut self, linear_m_s: f64, angular_rad_s: f64) -> Result<(), JsError> {
        let question = self.asked()?;
        for (name, value) in [("linear_m_s", linear_m_s), ("angular_rad_s", angular_rad_s)] {
            if !value.is_finite() {
                return Err(JsError::new(&format!("{name} = {value}: expected a finite number")));
            }
        }
        self.trial.navigator_mut().command = Command { linear_m_s, angular_rad_s };
        self.trial.decide(&question);
        self.question = None;
        Ok(())
    }

    /// Drives on until the next scan; returns whether the trial goes on.
    pub fn act(&mut self) -> bool {
        self.trial.act().is_none()
    }

    /// How the trial stands.
    ///
    /// # Errors
    /// None, unless JavaScript runs out of memory.
    pub fn status(&self) -> Result<Ts<TrialStatus>, JsError> {
        give(&TrialStatus::of(&self.trial))
    }

    /// Digest of the trajectory so far.
    pub fn digest(&self) -> String {
        self.trial.digest()
    }

    fn asked(&self) -> Result<Question, JsError> {
        self.question.ok_or_else(|| JsError::new("nothing is to be decided before the next scan"))
    }
}

fn table(parameters: &'static [Parameter], values: &[Value]) -> BTreeMap<&'static str, Value> {
    parameters.iter().map(|parameter| parameter.name).zip(values.iter().copied()).collect()
}

//! How well the robot has driven.

use mapless_trials::{Navigator, Trial};
use serde::Serialize;
use tsify::Tsify;

use super::pose::Pose;

impl Pose {
    pub(crate) fn of<N: Navigator>(trial: &Trial<N>) -> Self {
        trial.pose().into()
    }
}

/// The paper's six metrics, with the names that the command line prints.
#[derive(Debug, Serialize, Tsify)]
pub struct Metrics {
    distance_m: f64,
    max_abs_roll_rad: f64,
    max_abs_pitch_rad: f64,
    mean_vibration_rad_s: f64,
    mean_elevation_rate_cm_s: f64,
    curvature_change_rad_m: f64,
}

impl Metrics {
    pub(crate) fn of<N: Navigator>(trial: &Trial<N>) -> Self {
        let metrics = trial.metrics();
        Self {
            distance_m: metrics.distance_m,
            max_abs_roll_rad: metrics.max_abs_roll_rad,
            max_abs_pitch_rad: metrics.max_abs_pitch_rad,
            mean_vibration_rad_s: metrics.mean_vibration_rad_s,
            mean_elevation_rate_cm_s: metrics.mean_elevation_rate_cm_s,
            curvature_change_rad_m: metrics.curvature_change_rad_m,
        }
    }
}

/// How a trial stands: `running`, or how it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// It goes on.
    Running,
    /// The robot is at the goal.
    Reached,
    /// It rolled or pitched too far.
    TiltLimit,
    /// Its body ran into an object.
    Collision,
    /// Its belly or a bumper is on the ground or on a low object.
    HighCentred,
    /// A wheel is against more than it climbs.
    Step,
    /// It got nowhere for too long.
    Stuck,
    /// The planner knows no way on.
    NoSubgoal,
    /// It would have left the terrain.
    LeftTerrain,
    /// Its time ran out.
    Timeout,
}

impl Outcome {
    pub(crate) fn of<N: Navigator>(trial: &Trial<N>) -> Self {
        use mapless_trials::Outcome as Ended;
        match trial.outcome() {
            None => Self::Running,
            Some(Ended::Reached) => Self::Reached,
            Some(Ended::TiltLimit) => Self::TiltLimit,
            Some(Ended::Collision) => Self::Collision,
            Some(Ended::HighCentred) => Self::HighCentred,
            Some(Ended::Step) => Self::Step,
            Some(Ended::Stuck) => Self::Stuck,
            Some(Ended::NoSubgoal) => Self::NoSubgoal,
            Some(Ended::LeftTerrain) => Self::LeftTerrain,
            Some(Ended::Timeout) => Self::Timeout,
        }
    }
}

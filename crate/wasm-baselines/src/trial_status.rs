//! How a trial stands.

use mapless_trials::{Navigator, Trial};
use serde::Serialize;
use tsify::Tsify;

use crate::shared::{Metrics, Outcome, Pose};

/// How a trial stands.
#[derive(Debug, Serialize, Tsify)]
pub struct TrialStatus {
    tick: u64,
    time_s: f64,
    pose: Pose,
    metrics: Metrics,
    outcome: Outcome,
}

impl TrialStatus {
    pub(crate) fn of<N: Navigator>(trial: &Trial<N>) -> Self {
        Self {
            tick: trial.ticks(),
            time_s: trial.time_s(),
            pose: Pose::of(trial),
            metrics: Metrics::of(trial),
            outcome: Outcome::of(trial),
        }
    }
}

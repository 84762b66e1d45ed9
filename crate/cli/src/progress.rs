//! Progress of a running trial, on standard error if that is a terminal.

use std::time::Instant;

use crate::any_trial::AnyTrial;
use indicatif::{ProgressBar, ProgressStyle};

/// A bar that fills as the goal comes closer.
pub(crate) struct Progress {
    bar: ProgressBar,
    begun: Instant,
    straight_m: f64,
}

impl Progress {
    pub(crate) fn new(trial: &AnyTrial) -> Self {
        let straight_m = to_goal_m(trial);
        // The bar counts centimetres. Indicatif draws only on a terminal.
        let bar = ProgressBar::new((100.0 * straight_m) as u64);
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}") {
            bar.set_style(style);
        }
        Self { bar, begun: Instant::now(), straight_m }
    }

    pub(crate) fn show(&self, trial: &AnyTrial) {
        let left_m = to_goal_m(trial);
        let factor = trial.time_s() / self.begun.elapsed().as_secs_f64();
        self.bar.set_position((100.0 * (self.straight_m - left_m).max(0.0)) as u64);
        self.bar.set_message(format!(
            "{:6.1} s driven, {left_m:5.1} m to the goal, {factor:.1} × real time",
            trial.time_s()
        ));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn to_goal_m(trial: &AnyTrial) -> f64 {
    (trial.goal_m() - trial.robot().position).length()
}

//! The result of a trial: as JSON and as a table.

use std::fmt;
use std::time::Duration;

use comfy_table::{CellAlignment, Table, presets};
use mapless_trials::{Metrics, Outcome, statistics};

use crate::any_trial::AnyTrial;

/// Scenario, planner and seed; the title of the table and the picture.
pub(crate) struct Subject {
    /// Name of the scenario file, without extension.
    pub(crate) scenario: String,
    pub(crate) terrain: String,
    /// Name of the planner, and of the ground truth in place of perception.
    pub(crate) planner: String,
    pub(crate) seed: u64,
    pub(crate) roll_limit_rad: f64,
    pub(crate) pitch_limit_rad: f64,
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} on {}, planner {}, seed {}", self.scenario, self.terrain, self.planner, self.seed)
    }
}

/// The result of a trial, as `--json` prints it.
#[derive(serde::Serialize)]
pub(crate) struct Report {
    #[serde(skip)]
    pub(crate) subject: Subject,
    pub(crate) outcome: Outcome,
    /// Why the planner stopped, if it did.
    pub(crate) reason: Option<String>,
    pub(crate) metrics: Metrics,
    /// From where the robot truly is at the end, seen from above.
    pub(crate) distance_to_goal_m: f64,
    pub(crate) ticks: u64,
    pub(crate) sim_time_s: f64,
    pub(crate) planner_ms: PlannerTime,
    pub(crate) digest: String,
    /// What was done to the terrain's file that its owner should know.
    pub(crate) warnings: Vec<String>,
}

/// Quantiles of the time of one planner step, by wall clock, in milliseconds.
#[derive(serde::Serialize)]
pub(crate) struct PlannerTime {
    pub(crate) p50: f64,
    pub(crate) p99: f64,
}

impl Report {
    pub(crate) fn new(
        subject: Subject,
        trial: &AnyTrial,
        outcome: Outcome,
        planner_times: Vec<Duration>,
        warnings: Vec<String>,
    ) -> Self {
        Self {
            subject,
            outcome,
            reason: trial.end_reason(),
            metrics: trial.metrics(),
            distance_to_goal_m: trial.true_distance_to_goal_m(),
            ticks: trial.ticks(),
            sim_time_s: trial.time_s(),
            planner_ms: PlannerTime::of(planner_times),
            digest: trial.digest(),
            warnings,
        }
    }

    /// The outcome in a line.
    pub(crate) fn headline(&self) -> String {
        format!("{} after {:.1} m, {:.1} s", self.outcome.name(), self.metrics.distance_m, self.sim_time_s)
    }

    /// The largest tilts and their limits.
    pub(crate) fn tilts(&self) -> String {
        format!(
            "max |roll| {:.1}° of {:.1}°, max |pitch| {:.1}° of {:.1}°",
            self.metrics.max_abs_roll_rad.to_degrees(),
            self.subject.roll_limit_rad.to_degrees(),
            self.metrics.max_abs_pitch_rad.to_degrees(),
            self.subject.pitch_limit_rad.to_degrees()
        )
    }

    /// The report as text, with the limits beside the largest tilts.
    pub(crate) fn table(&self) -> String {
        let metrics = &self.metrics;
        let tilt = |angle_rad: f64| format!("{:.1}", angle_rad.to_degrees());
        let limit = |angle_rad: f64| format!("° (limit {:.1}°)", angle_rad.to_degrees());
        let mut table = Table::new();
        table.load_preset(presets::NOTHING);
        let mut row = |name: &str, value: String, unit: &str| {
            table.add_row([name, &value, unit]);
        };
        row("outcome", self.outcome.name().to_owned(), "");
        row("distance", format!("{:.2}", metrics.distance_m), "m");
        row("from the goal at the end", format!("{:.2}", self.distance_to_goal_m), "m");
        row("max |roll|", tilt(metrics.max_abs_roll_rad), &limit(self.subject.roll_limit_rad));
        row("max |pitch|", tilt(metrics.max_abs_pitch_rad), &limit(self.subject.pitch_limit_rad));
        row("mean vibration", format!("{:.4}", metrics.mean_vibration_rad_s), "rad/s");
        row("mean elevation rate", format!("{:.2}", metrics.mean_elevation_rate_cm_s), "cm/s");
        row("curvature change", format!("{:.4}", metrics.curvature_change_rad_m), "rad/m");
        row("simulated time", format!("{:.1}", self.sim_time_s), "s");
        row("planner steps", self.ticks.to_string(), "");
        row("planner step, median", format!("{:.1}", self.planner_ms.p50), "ms");
        row("planner step, 99 %", format!("{:.1}", self.planner_ms.p99), "ms");
        if let Some(values) = table.column_mut(1) {
            values.set_cell_alignment(CellAlignment::Right);
        }
        let reason =
            self.reason.as_ref().map_or(String::new(), |reason| format!("The planner stopped: {reason}.\n"));
        format!("{}\n{}\n{reason}digest {}", self.subject, table.trim_fmt(), self.digest)
    }
}

impl PlannerTime {
    fn of(times: Vec<Duration>) -> Self {
        let [p50, p99] = statistics::percentiles_ms(times, [50, 99]);
        Self { p50, p99 }
    }
}

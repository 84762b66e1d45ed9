//! The row of one trial.

/// One row of `trials.csv` and `trials.parquet`.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialRow {
    /// The trial's identity within its campaign.
    pub id: String,
    /// The campaign's identity.
    pub campaign: String,
    /// Name of the planner.
    pub planner: String,
    /// Name of the route.
    pub route: String,
    /// Ground truth in place of perception: `none`, `profile`, `ground` or `both`.
    pub truth: String,
    /// `path=value` of every parameter that was set, separated by spaces.
    pub parameters: String,
    /// Name of the condition that the scenario's `[reality]` was changed by; empty for the scenario's own.
    #[serde(default)]
    pub reality: String,
    /// Seed of the sensor's noise.
    pub seed: u64,
    /// How it ended, or `error`.
    pub outcome: String,
    /// Why the planner stopped, if it did.
    pub stop_reason: Option<String>,
    /// Why there is no outcome.
    pub error: Option<String>,
    /// Length D of the path, in space.
    pub distance_m: Option<f64>,
    /// Largest |φ|.
    pub max_abs_roll_rad: Option<f64>,
    /// Largest |ψ|.
    pub max_abs_pitch_rad: Option<f64>,
    /// Mean of |φ'| + |ψ'| over time.
    pub mean_vibration_rad_s: Option<f64>,
    /// Mean of |z'| over time, centimetres a second.
    pub mean_elevation_rate_cm_s: Option<f64>,
    /// C_chg.
    pub curvature_change_rad_m: Option<f64>,
    /// Mean of |φ| over time.
    pub mean_abs_roll_rad: Option<f64>,
    /// Mean of |ψ| over time.
    pub mean_abs_pitch_rad: Option<f64>,
    /// The longest time without a move from the place, seconds.
    pub longest_standstill_s: Option<f64>,
    /// Simulated time, seconds.
    pub sim_time_s: Option<f64>,
    /// Planning periods.
    pub ticks: Option<u64>,
    /// Straight distance from the start over the waypoints to the goal, seen from above.
    pub straight_m: f64,
    /// Length of the shortest safe path, if it is known.
    pub oracle_length_m: Option<f64>,
    /// Digest of the trajectory.
    pub digest: Option<String>,
    /// The planner's whole configuration as JSON; empty if it was invalid.
    pub configuration: String,
}

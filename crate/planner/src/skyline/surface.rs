//! The surfaces that the process predicts, and the lattice of directions they are predicted on.

use core::f64::consts::PI;

use crate::gp::hyperparameters::Hyperparameters;
use crate::gp::learning::Stop;
use crate::skyline::occupancy::{COLUMNS, LOWEST_ELEVATION_RAD};

/// Elevation rows of the predicted surfaces: -15° to +15°, one degree apart.
pub const ROWS: usize = 31;
/// Spacing of the elevation rows.
pub const ROW_STEP_RAD: f64 = PI / 180.0;
pub(crate) const ROWS_PER_RING: usize = 2;

/// The circle is predicted in sectors, each from a window around it.
pub(crate) const SECTORS: usize = 18;
pub(crate) const SECTOR_COLUMNS: usize = COLUMNS / SECTORS;
/// How far beyond its sector a window reaches. At 3.5 length-scales the kernel is below 1 % of its peak.
pub(crate) const REACH_LENGTH_SCALES: f64 = 3.5;

/// Elevation of a row of the predicted surfaces.
pub fn row_elevation_rad(row: usize) -> f64 {
    LOWEST_ELEVATION_RAD + ROW_STEP_RAD * row as f64
}

/// The two surfaces the process predicts, [`COLUMNS`] × [`ROWS`], column by column, lowest row first.
#[derive(Clone, Debug)]
pub struct PredictedSurface {
    /// Predicted occupancy, metres.
    pub mean_m: Vec<f64>,
    /// Predictive variance of the occupancy, as a share of the signal variance: 1 where nothing was observed.
    pub relative_variance: Vec<f64>,
    /// What the process needed for it.
    pub diagnostics: GpDiagnostics,
}

/// What a posterior needed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GpDiagnostics {
    /// Inducing inputs used.
    pub inducing_inputs: usize,
    /// Largest jitter any sector needed on the covariance of its inducing inputs.
    pub jitter: f64,
    /// What was learned from this scan or, with [`LearningMode::Once`], from the first one.
    pub learned: Option<LearnedHyperparameters>,
}

/// What learning came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearnedHyperparameters {
    /// The hyperparameters.
    pub hyperparameters: Hyperparameters,
    /// The bound at the start and where it ended, nats.
    pub bound: [f64; 2],
    /// Evaluations of the bound.
    pub evaluations: u32,
    /// Why learning ended.
    pub stop: Stop,
}

impl Default for PredictedSurface {
    /// Nothing observed.
    fn default() -> Self {
        Self {
            mean_m: vec![0.0; COLUMNS * ROWS],
            relative_variance: vec![1.0; COLUMNS * ROWS],
            diagnostics: GpDiagnostics::default(),
        }
    }
}

impl PredictedSurface {
    /// The relative variances of one column, lowest row first.
    pub fn variance_column(&self, column: usize) -> &[f64] {
        &self.relative_variance[column * ROWS..(column + 1) * ROWS]
    }
}

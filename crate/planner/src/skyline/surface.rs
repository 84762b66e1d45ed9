//! The predicted surfaces, and the lattice of their directions.

use crate::gp::hyperparameters::Hyperparameters;
use crate::gp::learning::Stop;
use crate::skyline::beam_grid::{RING_STEP_RAD, ROWS_PER_RING};
use crate::skyline::columns::COLUMNS;
use crate::skyline::occupancy::LOWEST_ROW_RAD;

/// Spacing of the predicted rows in the Gaussian process.
pub(crate) const ROW_STEP_RAD: f64 = RING_STEP_RAD / ROWS_PER_RING as f64;

/// The circle is predicted in sectors, each from a window around it.
pub(crate) const SECTORS: usize = 18;
pub(crate) const SECTOR_COLUMNS: usize = COLUMNS / SECTORS;
/// Reach of a window beyond its sector. At 3.5 length-scales the kernel is below 1 % of its peak.
pub(crate) const REACH_LENGTH_SCALES: f64 = 3.5;

/// Elevation of a predicted row in the Gaussian process.
pub(crate) fn row_rad(row: usize) -> f64 {
    LOWEST_ROW_RAD + ROW_STEP_RAD * row as f64
}

/// The two predicted surfaces, [`COLUMNS`] × [`PredictedSurface::rows`], column by column, lowest row first.
#[derive(Clone, Debug)]
pub struct PredictedSurface {
    /// Predicted occupancy, metres.
    pub mean_m: Vec<f64>,
    /// Predictive variance of the occupancy, as a share of the signal variance: 1 where nothing was observed.
    pub relative_variance: Vec<f64>,
    /// Diagnostics of the process.
    pub diagnostics: GpDiagnostics,
    rows: usize,
}

/// Diagnostics of a posterior.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct GpDiagnostics {
    /// Inducing inputs used.
    pub inducing_inputs: usize,
    /// Largest jitter any sector needed on the covariance of its inducing inputs.
    pub jitter: f64,
    /// Hyperparameters learned from this scan or, with `LearningMode::Once`, from the first one.
    pub learned: Option<LearnedHyperparameters>,
}

/// The result of learning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearnedHyperparameters {
    /// The hyperparameters.
    pub hyperparameters: Hyperparameters,
    /// The bound at the start and at the end, nats.
    pub bound: [f64; 2],
    /// Evaluations of the bound.
    pub evaluations: u32,
    /// Why learning ended.
    pub stop: Stop,
}

impl PredictedSurface {
    /// Surfaces without observations.
    pub(crate) fn new(rows: usize) -> Self {
        Self {
            mean_m: vec![0.0; COLUMNS * rows],
            relative_variance: vec![1.0; COLUMNS * rows],
            diagnostics: GpDiagnostics::default(),
            rows,
        }
    }

    /// Number of rows;
    /// [`BeamGrid::row_elevation_rad`](crate::skyline::beam_grid::BeamGrid::row_elevation_rad) has their
    /// elevations.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The relative variances of one column, lowest row first.
    pub fn variance_column(&self, column: usize) -> &[f64] {
        &self.relative_variance[column * self.rows..(column + 1) * self.rows]
    }
}

//! The perception model (paper, section V-A): a sparse Gaussian process over the occupancy surface, its mean (the
//! reconstructed occupancy) and its variance (the variance surface).
//!
//! The kernel decays within a few length-scales, so the surface is predicted sector by sector, each from the returns
//! and inducing inputs of a window around it; DESIGN.md gives the difference from the whole surface. Azimuths are taken
//! relative to the sector's centre, so the seam at ±π is like any other place.

use core::f64::consts::PI;

use glam::DVec2;

use crate::angle::difference_rad;
use crate::config::PerceptionConfig;
use crate::inducing::FarthestPoints;
use crate::occupancy::{COLUMNS, LOWEST_ELEVATION_RAD, OccupancySurface, column_azimuth_rad};
use crate::sparse_gp::{GpError, SparseGp};

/// Elevation rows of the predicted surfaces: -15° to +15°, one degree apart.
pub const ROWS: usize = 31;
/// Spacing of the elevation rows.
pub const ROW_STEP_RAD: f64 = PI / 180.0;

const SECTORS: usize = 18;
const SECTOR_COLUMNS: usize = COLUMNS / SECTORS;
const SECTOR_HALF_WIDTH_RAD: f64 = PI / SECTORS as f64;
/// How far beyond its sector a window reaches. At 3.5 length-scales the kernel is below 1 % of its peak.
const WINDOW_MARGIN_LENGTH_SCALES: f64 = 3.5;

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
    /// Inducing inputs used.
    pub inducing_inputs: usize,
    /// Largest jitter any sector needed.
    pub jitter: f64,
}

impl PredictedSurface {
    /// The relative variances of one column, lowest row first.
    pub fn variance_column(&self, column: usize) -> &[f64] {
        &self.relative_variance[column * ROWS..(column + 1) * ROWS]
    }
}

/// The process with its workspace.
#[derive(Clone, Debug)]
pub(crate) struct Perception {
    config: PerceptionConfig,
    gp: SparseGp,
    farthest_points: FarthestPoints,
    directions: Vec<DVec2>,
    chosen: Vec<usize>,
    window_inputs: Vec<DVec2>,
    window_targets: Vec<f64>,
    window_inducing: Vec<DVec2>,
    queries: Vec<DVec2>,
    surface: PredictedSurface,
}

impl Perception {
    pub(crate) fn new(config: PerceptionConfig) -> Self {
        let queries = (0..SECTOR_COLUMNS)
            .flat_map(|column| (0..ROWS).map(move |row| (column, row)))
            .map(|(column, row)| {
                let azimuth = column_azimuth_rad(column) - sector_centre_rad(0);
                DVec2::new(azimuth, row_elevation_rad(row))
            })
            .collect();
        Self {
            config,
            gp: SparseGp::new(config.kernel, config.noise_variance_m2),
            farthest_points: FarthestPoints::default(),
            directions: Vec::new(),
            chosen: Vec::new(),
            window_inputs: Vec::new(),
            window_targets: Vec::new(),
            window_inducing: Vec::new(),
            queries,
            surface: PredictedSurface {
                mean_m: vec![0.0; COLUMNS * ROWS],
                relative_variance: vec![1.0; COLUMNS * ROWS],
                inducing_inputs: 0,
                jitter: 0.0,
            },
        }
    }

    pub(crate) fn surface(&self) -> &PredictedSurface {
        &self.surface
    }

    /// Predicts both surfaces from the observed one.
    pub(crate) fn predict(&mut self, observed: &OccupancySurface) -> Result<(), GpError> {
        self.directions.clear();
        self.directions.extend(observed.cells().iter().map(|cell| cell.direction_rad()));
        self.farthest_points.choose(
            &self.directions,
            self.config.kernel.length_scales_rad,
            self.config.inducing_spacing_length_scales,
            self.config.max_inducing_inputs,
            &mut self.chosen,
        );
        self.surface.inducing_inputs = self.chosen.len();
        self.surface.jitter = 0.0;
        (0..SECTORS).try_for_each(|sector| self.predict_sector(sector, observed))
    }

    fn predict_sector(&mut self, sector: usize, observed: &OccupancySurface) -> Result<(), GpError> {
        let centre = sector_centre_rad(sector);
        let margin = WINDOW_MARGIN_LENGTH_SCALES * self.config.kernel.length_scales_rad[0];
        let half_width = SECTOR_HALF_WIDTH_RAD + margin;
        let in_window = |direction: DVec2| {
            let local = DVec2::new(difference_rad(direction.x, centre), direction.y);
            (local.x.abs() <= half_width).then_some(local)
        };

        self.window_inputs.clear();
        self.window_targets.clear();
        for (&direction, cell) in self.directions.iter().zip(observed.cells()) {
            if let Some(local) = in_window(direction) {
                self.window_inputs.push(local);
                self.window_targets.push(cell.occupancy_m);
            }
        }
        self.window_inducing.clear();
        self.window_inducing
            .extend(self.chosen.iter().filter_map(|&index| in_window(self.directions[index])));

        let span = sector * SECTOR_COLUMNS * ROWS..(sector + 1) * SECTOR_COLUMNS * ROWS;
        let mean = &mut self.surface.mean_m[span.clone()];
        let variance = &mut self.surface.relative_variance[span];
        if self.window_inducing.is_empty() {
            mean.fill(0.0);
            variance.fill(1.0);
            return Ok(());
        }
        self.gp.fit(&self.window_inputs, &self.window_targets, &self.window_inducing)?;
        self.gp.predict(&self.queries, mean, variance);
        let scale = 1.0 / self.config.kernel.variance;
        for value in variance {
            *value *= scale;
        }
        self.surface.jitter = self.surface.jitter.max(self.gp.jitter());
        Ok(())
    }
}

/// Azimuth halfway between a sector's first and last column.
fn sector_centre_rad(sector: usize) -> f64 {
    let first = sector * SECTOR_COLUMNS;
    0.5 * (column_azimuth_rad(first) + column_azimuth_rad(first + SECTOR_COLUMNS - 1))
}

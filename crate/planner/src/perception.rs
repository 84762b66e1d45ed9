//! The perception model (paper, section V-A): a sparse Gaussian process over the occupancy surface, its mean (the
//! reconstructed occupancy) and its variance (the variance surface), and the elevation profile read off the latter.
//!
//! A step needs the profile only. With inducing inputs on the beams' lattice it is traced along the edge, and the surfaces are
//! predicted when somebody asks for them.

use core::f64::consts::PI;

use crate::config::{InducingInputs, PerceptionConfig};
use crate::edge::{EdgeTracer, all_cells};
use crate::lattice::{LatticeGp, Query};
use crate::occupancy::{COLUMNS, LOWEST_ELEVATION_RAD, OccupancySurface};
use crate::profile::{ElevationProfile, read_profile};
use crate::sectors::SectorGp;
use crate::sparse_gp::GpError;

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
    pub effort: Effort,
}

/// What a posterior needed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Inducing inputs used.
    pub inducing_inputs: usize,
    /// Largest jitter any sector needed on the covariance of its inducing inputs.
    pub jitter: f64,
}

impl Default for PredictedSurface {
    /// Nothing observed.
    fn default() -> Self {
        Self {
            mean_m: vec![0.0; COLUMNS * ROWS],
            relative_variance: vec![1.0; COLUMNS * ROWS],
            effort: Effort::default(),
        }
    }
}

impl PredictedSurface {
    /// The relative variances of one column, lowest row first.
    pub fn variance_column(&self, column: usize) -> &[f64] {
        &self.relative_variance[column * ROWS..(column + 1) * ROWS]
    }
}

/// The process, by where its inducing inputs lie.
#[derive(Clone, Debug)]
enum Process {
    Lattice(Box<LatticeGp>),
    FarthestPoints(Box<SectorGp>),
}

/// The perception model with its workspace.
#[derive(Clone, Debug)]
pub(crate) struct Perception {
    config: PerceptionConfig,
    process: Process,
    edge: EdgeTracer,
    surface: PredictedSurface,
    effort: Effort,
    queries: Vec<Query>,
    values: Vec<f64>,
}

impl Perception {
    pub(crate) fn new(config: PerceptionConfig) -> Self {
        let process = match config.inducing_inputs {
            InducingInputs::Lattice => Process::Lattice(Box::new(LatticeGp::new(&config))),
            InducingInputs::FarthestPoints => Process::FarthestPoints(Box::new(SectorGp::new(config))),
        };
        Self {
            edge: EdgeTracer::new(&config),
            config,
            process,
            surface: PredictedSurface::default(),
            effort: Effort::default(),
            queries: Vec::new(),
            values: Vec::new(),
        }
    }

    /// What the last profile needed.
    pub(crate) fn effort(&self) -> Effort {
        self.effort
    }

    /// The elevation profile of the observed surface.
    pub(crate) fn profile(
        &mut self,
        observed: &OccupancySurface,
        profile: &mut ElevationProfile,
    ) -> Result<(), GpError> {
        match &mut self.process {
            Process::Lattice(gp) => self.effort = self.edge.trace(observed, gp, profile)?,
            Process::FarthestPoints(gp) => {
                gp.predict(observed, &mut self.surface)?;
                self.effort = self.surface.effort;
                read_profile(observed, &self.surface, self.config.variance_threshold, profile);
            }
        }
        Ok(())
    }

    /// Both surfaces, predicted from the observed one.
    pub(crate) fn surface(&mut self, observed: &OccupancySurface) -> Result<&PredictedSurface, GpError> {
        match &mut self.process {
            Process::Lattice(gp) => {
                gp.observe(observed, &all_cells(observed));
                self.surface.effort = Effort { inducing_inputs: gp.inducing_inputs(), jitter: 0.0 };
                self.surface.mean_m.fill(0.0);
                self.surface.relative_variance.fill(1.0);
                self.queries.clear();
                let columns = 0..SECTOR_COLUMNS;
                self.queries
                    .extend(columns.flat_map(|column| (0..ROWS).map(move |row| Query { column, row })));
                for sector in 0..SECTORS {
                    if !gp.enter(sector)? {
                        continue;
                    }
                    self.surface.effort.jitter = self.surface.effort.jitter.max(gp.jitter());
                    gp.relative_variances(sector, &self.queries, &mut self.values);
                    scatter(&self.values, gp.sector_columns(sector), &mut self.surface.relative_variance);
                    gp.means(&mut self.values);
                    scatter(&self.values, gp.sector_columns(sector), &mut self.surface.mean_m);
                }
            }
            Process::FarthestPoints(gp) => gp.predict(observed, &mut self.surface)?,
        }
        Ok(&self.surface)
    }
}

/// Copies whole columns of a sector to their places.
fn scatter(values: &[f64], columns: impl Iterator<Item = usize>, surface: &mut [f64]) {
    for (values, column) in values.chunks_exact(ROWS).zip(columns) {
        surface[column * ROWS..(column + 1) * ROWS].copy_from_slice(values);
    }
}

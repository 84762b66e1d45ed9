//! The process looked into, for those who want to understand it: where its inducing inputs are, what it would
//! predict with others, and how far the kernel reaches. Planning needs none of this.

use glam::DVec2;

use crate::config::{InducingInputs, PerceptionConfig};
use crate::gp::GpError;
use crate::gp::hyperparameters::Hyperparameters;
use crate::gp::kernel::RationalQuadratic;
use crate::gp::learning::{HyperparameterBounds, Learner, LearningConfig, LearningError};
use crate::skyline::beam_gp::{BeamGp, all_cells};
use crate::skyline::beam_grid::ROWS_PER_RING;
use crate::skyline::columns::{COLUMN_STEP_RAD, COLUMNS};
use crate::skyline::inducing::FarthestPoints;
use crate::skyline::occupancy::{Cell, OccupancySurface};
use crate::skyline::profile::{ElevationProfile, read_profile};
use crate::skyline::surface::{PredictedSurface, ROW_STEP_RAD};

/// What a climb takes: every third column, and at most so many inducing inputs and evaluations.
const CLIMB_COLUMNS: usize = 3;
const CLIMB_INDUCING_INPUTS: usize = 80;
const CLIMB_EVALUATIONS: u32 = 30;
/// As good as no bounds.
const UNBOUNDED: [f64; 2] = [1e-3, 1e3];

/// A direction of the predicted surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticeDirection {
    /// Azimuth column, 0 to 359.
    pub column: usize,
    /// Row of the predicted surfaces, the lowest is 0; an inducing input may lie above the highest.
    pub row: usize,
}

/// Where the inducing inputs are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// On the lattice of the sensor's columns and rows, wherever there are returns.
    Lattice,
    /// Among the returns, each the farthest from those before it.
    FarthestPoints,
    /// Returns at even steps, in the order of azimuth and elevation, about as many as the lattice has.
    Strided,
}

impl From<InducingInputs> for Placement {
    fn from(inputs: InducingInputs) -> Self {
        match inputs {
            InducingInputs::Lattice => Self::Lattice,
            InducingInputs::FarthestPoints => Self::FarthestPoints,
        }
    }
}

/// The sparse process over one scan, with inducing inputs of one's own choice.
#[derive(Clone, Debug)]
pub struct Inspection {
    threshold: f64,
    gp: BeamGp,
    inputs: Vec<LatticeDirection>,
    surface: PredictedSurface,
}

impl Inspection {
    /// The process with these hyperparameters and inducing inputs; it predicts nothing yet.
    pub fn new(config: &PerceptionConfig, observed: &OccupancySurface, placement: Placement) -> Self {
        let grid = observed.grid();
        let gp = BeamGp::new(config, grid);
        let inputs = match placement {
            Placement::Lattice => lattice(&gp, observed),
            Placement::FarthestPoints => {
                let mut chosen = Vec::new();
                FarthestPoints::default().choose_cells(observed, config, &mut chosen);
                cells(observed, chosen.into_iter())
            }
            Placement::Strided => {
                let stride = observed.cells().len().div_ceil(lattice(&gp, observed).len().max(1)).max(1);
                cells(observed, (0..observed.cells().len()).step_by(stride))
            }
        };
        Self { threshold: config.variance_threshold, gp, inputs, surface: PredictedSurface::new(grid.rows()) }
    }

    /// The inducing inputs.
    pub fn inducing_inputs(&self) -> &[LatticeDirection] {
        &self.inputs
    }

    /// Both surfaces without the inducing inputs of these numbers, and the profile along their edge.
    ///
    /// # Errors
    /// [`GpError`] when there is no posterior.
    pub fn predict(
        &mut self,
        observed: &OccupancySurface,
        without: &[usize],
    ) -> Result<(&PredictedSurface, ElevationProfile), GpError> {
        let kept = self.inputs.iter().enumerate().filter(|(index, _)| !without.contains(index));
        self.gp.place(kept.map(|(_, input)| (input.column, input.row)));
        self.gp.predict(observed, &mut self.surface)?;
        let mut profile = Vec::new();
        read_profile(observed, &self.surface, self.threshold, &mut profile);
        Ok((&self.surface, profile))
    }
}

/// One step of learning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClimbStep {
    /// The hyperparameters.
    pub hyperparameters: Hyperparameters,
    /// The collapsed bound on the log marginal likelihood, nats: never less than in the step before.
    pub bound: f64,
}

/// The climb of the bound from the configured hyperparameters, with nothing to hold them, as they are learned
/// from a scan: step by step, the start first. To be quick it takes every third column of the scan and few
/// inducing inputs.
///
/// # Errors
/// [`LearningError`] when the bound has no value at the start, as without returns.
pub fn unbounded_climb(
    config: &PerceptionConfig,
    observed: &OccupancySurface,
) -> Result<Vec<ClimbStep>, LearningError> {
    let taken = || observed.cells().iter().filter(|cell| cell.column.is_multiple_of(CLIMB_COLUMNS));
    let inputs: Vec<DVec2> = taken().map(Cell::direction_rad).collect();
    let targets: Vec<f64> = taken().map(|cell| cell.occupancy_m).collect();
    let stride = inputs.len().div_ceil(CLIMB_INDUCING_INPUTS).max(1);
    let inducing: Vec<DVec2> = inputs.iter().copied().step_by(stride).collect();
    let (kernel, noise_variance) = (config.kernel, config.noise_variance_m2);
    let mut steps: Vec<ClimbStep> = Vec::new();
    let learning = LearningConfig {
        evaluations_per_scan: CLIMB_EVALUATIONS,
        learn_inducing_inputs: false,
        isotropic: false,
        bounds: HyperparameterBounds {
            variance_m2: UNBOUNDED,
            azimuth_length_scale_rad: UNBOUNDED,
            elevation_length_scale_rad: UNBOUNDED,
            alpha: UNBOUNDED,
            noise_variance_m2: UNBOUNDED,
        },
        ..config.learning
    };
    Learner::new(learning).learn_watched(
        &inputs,
        &targets,
        &inducing,
        &Hyperparameters { kernel, noise_variance },
        |&hyperparameters, bound| {
            if steps.last().is_none_or(|last| bound >= last.bound) {
                steps.push(ClimbStep { hyperparameters, bound });
            }
        },
    )?;
    Ok(steps)
}

fn lattice(gp: &BeamGp, observed: &OccupancySurface) -> Vec<LatticeDirection> {
    let mut gp = gp.clone();
    gp.observe(observed, &all_cells(observed));
    gp.directions().map(|(column, row)| LatticeDirection { column, row }).collect()
}

fn cells(observed: &OccupancySurface, chosen: impl Iterator<Item = usize>) -> Vec<LatticeDirection> {
    chosen
        .map(|index| observed.cells()[index])
        .map(|cell| LatticeDirection { column: cell.column, row: ROWS_PER_RING * cell.ring })
        .collect()
}

/// The covariance of every direction of the predicted surfaces with one of them, as a share of the signal
/// variance: [`COLUMNS`] × `rows`, column by column, lowest row first.
pub fn relative_covariances(kernel: &RationalQuadratic, from: LatticeDirection, rows: usize) -> Vec<f64> {
    let place = |column: usize, row: usize| {
        let around = column.abs_diff(from.column);
        let columns = around.min(COLUMNS - around) as f64;
        DVec2::new(COLUMN_STEP_RAD * columns, ROW_STEP_RAD * row.abs_diff(from.row) as f64)
    };
    (0..COLUMNS)
        .flat_map(|column| (0..rows).map(move |row| place(column, row)))
        .map(|apart| kernel.covariance(DVec2::ZERO, apart) / kernel.variance)
        .collect()
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "what is the same has the same bits")]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::skyline::perception::Perception;
    use crate::skyline::profile::Column;
    use crate::testing::{undulating_scan, vlp16_surface};

    fn observed() -> OccupancySurface {
        let mut observed = vlp16_surface();
        observed.project(&undulating_scan(0, 360));
        observed
    }

    fn ground_columns(profile: &[Column]) -> usize {
        profile.iter().filter(|column| matches!(column, Column::Ground { .. })).count()
    }

    #[test]
    fn with_the_planners_own_inducing_inputs_it_is_the_planners_process() {
        for config in [PlannerConfig::default(), PlannerConfig::paper()] {
            let (observed, mut config) = (observed(), config.perception);
            config.learning.mode = crate::gp::learning::LearningMode::Fixed;
            let mut inspection = Inspection::new(&config, &observed, config.inducing_inputs.into());
            let (surface, _) = inspection.predict(&observed, &[]).unwrap();
            let mut perception = Perception::new(config, observed.grid());
            let planners = perception.surface(&observed).unwrap();
            let differences = surface.relative_variance.iter().zip(&planners.relative_variance);
            let most = differences.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(most < 0.02, "{:?}: {most}", config.inducing_inputs);
            let used = surface.diagnostics.inducing_inputs;
            assert_eq!(used, inspection.inducing_inputs().len());
        }
    }

    #[test]
    fn without_an_inducing_input_the_process_is_less_sure_there_and_the_same_far_away() {
        let (observed, config) = (observed(), PlannerConfig::default().perception);
        let mut inspection = Inspection::new(&config, &observed, Placement::Lattice);
        let whole = inspection.predict(&observed, &[]).unwrap().0.clone();
        let taken = inspection.inducing_inputs().len() / 2;
        let LatticeDirection { column, row } = inspection.inducing_inputs()[taken];
        let (less, _) = inspection.predict(&observed, &[taken]).unwrap();
        let at = column * whole.rows() + row.min(whole.rows() - 1);
        let (before, after) = (whole.relative_variance[at], less.relative_variance[at]);
        assert!(after > before + 0.01, "{before} {after}");
        let opposite = (column + COLUMNS / 2) % COLUMNS;
        assert_eq!(less.variance_column(opposite), whole.variance_column(opposite));
    }

    #[test]
    fn every_placement_covers_the_scan_with_as_many_inputs_as_it_says() {
        let (observed, config) = (observed(), PlannerConfig::default().perception);
        let lattice = Inspection::new(&config, &observed, Placement::Lattice).inducing_inputs().len();
        for placement in [Placement::Lattice, Placement::FarthestPoints, Placement::Strided] {
            let mut inspection = Inspection::new(&config, &observed, placement);
            let count = inspection.inducing_inputs().len();
            assert!(count > lattice / 3 && count <= 3 * lattice, "{placement:?}: {count} of {lattice}");
            let (_, profile) = inspection.predict(&observed, &[]).unwrap();
            assert!(ground_columns(&profile) > 300, "{placement:?}: {}", ground_columns(&profile));
        }
    }

    #[test]
    fn without_any_inducing_input_all_is_free() {
        let (observed, config) = (observed(), PlannerConfig::default().perception);
        let mut inspection = Inspection::new(&config, &observed, Placement::Lattice);
        let all: Vec<usize> = (0..inspection.inducing_inputs().len()).collect();
        let (surface, profile) = inspection.predict(&observed, &all).unwrap();
        assert!(surface.relative_variance.iter().all(|&variance| variance == 1.0));
        assert_eq!(ground_columns(&profile), 0);
    }

    #[test]
    fn a_climb_without_bounds_rises_and_widens_the_kernel() {
        let config = PlannerConfig::default().perception;
        let steps = unbounded_climb(&config, &observed()).unwrap();
        assert_eq!(steps[0].hyperparameters.kernel, config.kernel);
        assert!(steps.len() > 4 && steps.windows(2).all(|pair| pair[1].bound >= pair[0].bound));
        let last = steps[steps.len() - 1].hyperparameters.kernel;
        assert!(last.variance > 2.0 * config.kernel.variance, "{last:?}");
        assert!(unbounded_climb(&config, &vlp16_surface()).is_err());
    }

    #[test]
    fn the_kernel_is_one_at_its_place_and_the_same_around_the_circle() {
        let kernel = PlannerConfig::default().perception.kernel;
        let covariances = |column| relative_covariances(&kernel, LatticeDirection { column, row: 10 }, 31);
        let at = |values: &[f64], column: usize, row: usize| values[column * 31 + row];
        let (seam, middle) = (covariances(0), covariances(180));
        assert_eq!(at(&seam, 0, 10), 1.0);
        for apart in 1..170 {
            assert_eq!(at(&seam, apart, 12), at(&middle, 180 + apart, 12));
            assert_eq!(at(&seam, 360 - apart, 12), at(&middle, 180 - apart, 12));
            assert!(at(&seam, apart, 10) < at(&seam, apart - 1, 10));
        }
    }
}

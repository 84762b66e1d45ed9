//! The perception model (paper, section V-A): a sparse Gaussian process over the occupancy surface, its mean (the
//! reconstructed occupancy) and its variance (the variance surface), and the elevation profile read off the latter.
//!
//! A step needs the profile only. With inducing inputs on the beams' lattice it is traced along the edge, and the surfaces are
//! predicted when somebody asks for them.

use glam::DVec2;

use crate::config::{InducingInputs, PerceptionConfig};
use crate::gp::hyperparameters::Hyperparameters;
use crate::gp::jitter::GpError;
use crate::gp::learning::{Learner, LearningConfig, LearningMode};
use crate::skyline::beam_gp::{BeamGp, Query};
use crate::skyline::edge_tracer::{EdgeTracer, all_cells};
use crate::skyline::inducing::FarthestPoints;
use crate::skyline::occupancy::OccupancySurface;
use crate::skyline::profile::{ElevationProfile, read_profile};
use crate::skyline::surface::{
    GpDiagnostics, LearnedHyperparameters, PredictedSurface, ROWS, SECTOR_COLUMNS, SECTORS,
};
use crate::skyline::window_gp::WindowGp;

/// The farthest points that hyperparameters are learned through: enough for them, and a bound on the cost.
const MOST_INDUCING_INPUTS_FOR_HYPERPARAMETERS: usize = 200;

/// The process, by where its inducing inputs lie.
#[derive(Clone, Debug)]
enum Process {
    Lattice(Box<BeamGp>),
    FarthestPoints(Box<WindowGp>),
}

/// The perception model with its workspace.
#[derive(Clone, Debug)]
pub(crate) struct Perception {
    config: PerceptionConfig,
    process: Process,
    edge: EdgeTracer,
    surface: PredictedSurface,
    diagnostics: GpDiagnostics,
    learner: Learner,
    learned: Option<LearnedHyperparameters>,
    farthest_points: FarthestPoints,
    queries: Vec<Query>,
    values: Vec<f64>,
}

impl Process {
    fn new(config: PerceptionConfig) -> Self {
        match config.inducing_inputs {
            InducingInputs::Lattice => Self::Lattice(Box::new(BeamGp::new(&config))),
            InducingInputs::FarthestPoints => Self::FarthestPoints(Box::new(WindowGp::new(config))),
        }
    }
}

impl Perception {
    pub(crate) fn new(config: PerceptionConfig) -> Self {
        Self {
            edge: EdgeTracer::new(&config),
            process: Process::new(config),
            learner: Learner::new(LearningConfig {
                // The inducing inputs of one scan are of no use to the next.
                learn_inducing_inputs: config.learning.learn_inducing_inputs
                    && config.learning.mode == LearningMode::EveryScan,
                ..config.learning
            }),
            learned: None,
            farthest_points: FarthestPoints::default(),
            config,
            surface: PredictedSurface::default(),
            diagnostics: GpDiagnostics::default(),
            queries: Vec::new(),
            values: Vec::new(),
        }
    }

    /// Forgets what was learned: back to the configured hyperparameters.
    pub(crate) fn reset(&mut self, config: PerceptionConfig) {
        if self.learned.is_some() {
            *self = Self::new(config);
        }
    }

    /// What the last profile needed.
    pub(crate) fn diagnostics(&self) -> GpDiagnostics {
        self.diagnostics
    }

    /// The elevation profile of the observed surface.
    pub(crate) fn profile(
        &mut self,
        observed: &OccupancySurface,
        profile: &mut ElevationProfile,
    ) -> Result<(), GpError> {
        self.learn(observed)?;
        match &mut self.process {
            Process::Lattice(gp) => self.diagnostics = self.edge.trace(observed, gp, profile)?,
            Process::FarthestPoints(gp) => {
                gp.predict(observed, &mut self.surface)?;
                self.diagnostics = self.surface.diagnostics;
                read_profile(observed, &self.surface, self.config.variance_threshold, profile);
            }
        }
        self.diagnostics.learned = self.learned;
        Ok(())
    }

    /// Learns from the observed surface, where that is configured and there is something to learn from.
    fn learn(&mut self, observed: &OccupancySurface) -> Result<(), GpError> {
        let due = match self.config.learning.mode {
            LearningMode::Fixed => false,
            LearningMode::Once => self.learned.is_none(),
            LearningMode::EveryScan => true,
        };
        if !due || observed.cells().is_empty() {
            return Ok(());
        }
        let mut chosen = Vec::new();
        self.farthest_points.choose_cells(observed, &self.config, &mut chosen);
        if !self.learner.moves_inducing_inputs() {
            chosen.truncate(MOST_INDUCING_INPUTS_FOR_HYPERPARAMETERS);
        }
        let inputs: Vec<DVec2> = observed.cells().iter().map(|cell| cell.direction_rad()).collect();
        let targets: Vec<f64> = observed.cells().iter().map(|cell| cell.occupancy_m).collect();
        let inducing: Vec<DVec2> = chosen.iter().map(|&index| inputs[index]).collect();
        let start =
            Hyperparameters { kernel: self.config.kernel, noise_variance: self.config.noise_variance_m2 };
        // The start is within its bounds and the cells are finite numbers, so only the factorisation can fail.
        let Ok(learned) = self.learner.learn(&inputs, &targets, &inducing, &start) else {
            return Err(GpError::NothingLearned { inducing: inducing.len() });
        };
        self.config.kernel = learned.hyperparameters.kernel;
        self.config.noise_variance_m2 = learned.hyperparameters.noise_variance;
        self.edge = EdgeTracer::new(&self.config);
        self.process = Process::new(self.config);
        if let Process::FarthestPoints(gp) = &mut self.process
            && self.learner.moves_inducing_inputs()
        {
            gp.set_inducing_inputs(learned.inducing);
        }
        self.learned = Some(LearnedHyperparameters {
            hyperparameters: learned.hyperparameters,
            bound: [learned.bound_before, learned.bound_after],
            evaluations: learned.evaluations,
            stop: learned.stop,
        });
        Ok(())
    }

    /// Both surfaces, predicted from the observed one.
    pub(crate) fn surface(&mut self, observed: &OccupancySurface) -> Result<&PredictedSurface, GpError> {
        match &mut self.process {
            Process::Lattice(gp) => {
                gp.observe(observed, &all_cells(observed));
                self.surface.diagnostics =
                    GpDiagnostics { inducing_inputs: gp.inducing_inputs(), ..GpDiagnostics::default() };
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
                    self.surface.diagnostics.jitter = self.surface.diagnostics.jitter.max(gp.jitter());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::skyline::profile::Column;
    use crate::testing::undulating_scan;

    /// Profiles of two scans, and what was learned from each.
    fn two_scans(config: PerceptionConfig) -> [(ElevationProfile, Option<LearnedHyperparameters>); 2] {
        let mut perception = Perception::new(config);
        [(90, 150), (100, 170)].map(|(from, to)| {
            let mut observed = OccupancySurface::new(7.0);
            observed.project(&undulating_scan(from, to));
            let mut profile = Vec::new();
            perception.profile(&observed, &mut profile).unwrap();
            (profile, perception.diagnostics().learned)
        })
    }

    fn with_mode(mut config: PlannerConfig, mode: LearningMode) -> PerceptionConfig {
        config.perception.learning.mode = mode;
        config.perception.learning.evaluations_per_scan = 6;
        config.validate("planner").unwrap();
        config.perception
    }

    fn ground(profile: &[Column]) -> usize {
        profile.iter().filter(|column| matches!(column, Column::Ground { .. })).count()
    }

    #[test]
    fn each_mode_learns_when_it_says() {
        for preset in [PlannerConfig::default, PlannerConfig::paper] {
            let learned = |mode| {
                two_scans(with_mode(preset(), mode)).map(|(profile, learned)| {
                    assert!(ground(&profile) >= 55, "{mode:?}: {}", ground(&profile));
                    learned
                })
            };
            assert_eq!(learned(LearningMode::Fixed), [None, None]);
            let [first, second] = learned(LearningMode::Once);
            assert!(first.is_some() && first == second);
            let [first, second] = learned(LearningMode::EveryScan).map(Option::unwrap);
            assert!(first.bound[1] > first.bound[0] && second.bound[1] >= second.bound[0]);
            assert_ne!(first, second);
        }
    }

    #[test]
    fn what_was_learned_is_forgotten_on_a_reset() {
        let config = with_mode(PlannerConfig::default(), LearningMode::EveryScan);
        let mut perception = Perception::new(config);
        let learn = |perception: &mut Perception| {
            let mut observed = OccupancySurface::new(7.0);
            observed.project(&undulating_scan(90, 150));
            perception.profile(&observed, &mut Vec::new()).unwrap();
            perception.diagnostics().learned
        };
        let first = learn(&mut perception);
        assert_ne!(learn(&mut perception), first);
        perception.reset(config);
        assert_eq!(learn(&mut perception), first);
    }

    #[test]
    fn learning_must_begin_within_its_bounds_and_leave_a_lattice_alone() {
        let mut config = PlannerConfig::default();
        config.perception.learning.mode = LearningMode::Once;
        config.perception.noise_variance_m2 = 100.0;
        let error = config.validate("planner").unwrap_err().to_string();
        assert!(error.contains("noise_variance = 100: expected a start between"), "{error}");
        let mut config = PlannerConfig::default();
        config.perception.learning.mode = LearningMode::EveryScan;
        config.perception.learning.learn_inducing_inputs = true;
        let error = config.validate("planner").unwrap_err().to_string();
        assert!(error.starts_with("planner.perception.learning.learn_inducing_inputs = true"), "{error}");
    }
}

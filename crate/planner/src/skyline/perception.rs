//! The perception model (paper, section V-A): a sparse Gaussian process over the occupancy surface, its mean
//! (the reconstructed occupancy) and its variance (the variance surface), and the elevation profile along the
//! edge of the latter.
//!
//! A step needs the profile only. With inducing inputs on the beams' lattice it is traced along the edge, and
//! the surfaces are predicted on request.

use glam::DVec2;

use crate::config::{InducingInputs, PerceptionConfig, Skyline};
use crate::gp::hyperparameters::Hyperparameters;
use crate::gp::jitter::GpError;
use crate::gp::learning::{Learner, LearningConfig, LearningMode};
use crate::skyline::beam_gp::BeamGp;
use crate::skyline::beam_grid::BeamGrid;
use crate::skyline::edge_tracer::EdgeTracer;
use crate::skyline::inducing::FarthestPoints;
use crate::skyline::occupancy::OccupancySurface;
use crate::skyline::profile::{ElevationProfile, read_highest_returns, read_profile};
use crate::skyline::surface::{GpDiagnostics, LearnedHyperparameters, PredictedSurface};
use crate::skyline::window_gp::WindowGp;

/// Number of farthest points through which hyperparameters are learned: enough for them, and a bound on the
/// cost.
const MOST_INDUCING_INPUTS_FOR_HYPERPARAMETERS: usize = 200;

/// The process, by the placement of its inducing inputs.
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
}

impl Process {
    fn new(config: PerceptionConfig, grid: &BeamGrid) -> Self {
        match config.inducing_inputs {
            InducingInputs::Lattice => Self::Lattice(Box::new(BeamGp::new(&config, grid))),
            InducingInputs::FarthestPoints => {
                Self::FarthestPoints(Box::new(WindowGp::new(config, grid.rows())))
            }
        }
    }
}

impl Perception {
    pub(crate) fn new(config: PerceptionConfig, grid: &BeamGrid) -> Self {
        Self {
            edge: EdgeTracer::new(&config, grid),
            process: Process::new(config, grid),
            learner: Learner::new(LearningConfig {
                // The inducing inputs of one scan do not suit the next.
                learn_inducing_inputs: config.learning.learn_inducing_inputs
                    && config.learning.mode == LearningMode::EveryScan,
                ..config.learning
            }),
            learned: None,
            farthest_points: FarthestPoints::default(),
            config,
            surface: PredictedSurface::new(grid.rows()),
            diagnostics: GpDiagnostics::default(),
        }
    }

    /// Forgets what was learned: back to the configured hyperparameters.
    pub(crate) fn reset(&mut self, config: PerceptionConfig, grid: &BeamGrid) {
        if self.learned.is_some() {
            *self = Self::new(config, grid);
        }
    }

    /// Diagnostics of the last profile.
    pub(crate) fn diagnostics(&self) -> GpDiagnostics {
        self.diagnostics
    }

    /// The elevation profile of the observed surface.
    pub(crate) fn profile(
        &mut self,
        observed: &OccupancySurface,
        profile: &mut ElevationProfile,
    ) -> Result<(), GpError> {
        if self.config.skyline == Skyline::HighestReturns {
            read_highest_returns(observed, profile);
            self.diagnostics = GpDiagnostics::default();
            return Ok(());
        }
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

    /// Learns from the observed surface, if that is configured and the surface is not empty.
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
        // The start is within its bounds and the cells are finite numbers, so only the factorisation can
        // fail.
        let Ok(learned) = self.learner.learn(&inputs, &targets, &inducing, &start) else {
            return Err(GpError::NothingLearned { inducing: inducing.len() });
        };
        self.config.kernel = learned.hyperparameters.kernel;
        self.config.noise_variance_m2 = learned.hyperparameters.noise_variance;
        self.edge = EdgeTracer::new(&self.config, observed.grid());
        self.process = Process::new(self.config, observed.grid());
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
            Process::Lattice(gp) => gp.predict(observed, &mut self.surface)?,
            Process::FarthestPoints(gp) => gp.predict(observed, &mut self.surface)?,
        }
        Ok(&self.surface)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::skyline::beam_grid::{RING_STEP_RAD, ROWS_PER_RING};
    use crate::skyline::profile::Column;
    use crate::testing::{undulating_scan, vlp16_surface};

    /// Profiles of two scans, and the hyperparameters learned from each.
    fn two_scans(config: PerceptionConfig) -> [(ElevationProfile, Option<LearnedHyperparameters>); 2] {
        let mut perception = Perception::new(config, vlp16_surface().grid());
        [(90, 150), (100, 170)].map(|(from, to)| {
            let mut observed = vlp16_surface();
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
    fn without_a_process_the_skyline_follows_the_highest_returns() {
        let mut observed = vlp16_surface();
        observed.project(&undulating_scan(90, 150));
        let profile = |skyline| {
            let config = PerceptionConfig { skyline, ..PlannerConfig::default().perception };
            let mut profile = Vec::new();
            Perception::new(config, observed.grid()).profile(&observed, &mut profile).unwrap();
            profile
        };
        let (edge, highest) = (profile(Skyline::VarianceSurface), profile(Skyline::HighestReturns));
        for (column, (edge, found)) in edge.iter().zip(&highest).enumerate() {
            let Some(cell) = observed.column(column).last() else {
                assert_eq!(*found, Column::Unknown);
                continue;
            };
            let grid = observed.grid();
            let elevation_rad = grid.row_elevation_rad(ROWS_PER_RING * cell.ring + ROWS_PER_RING / 2);
            assert_eq!(*found, Column::Ground { elevation_rad });
            // The edge of the variance lies within a ring or two of it.
            let Column::Ground { elevation_rad: edge_rad } = *edge else { continue };
            assert!((edge_rad - elevation_rad).abs() < 2.0 * RING_STEP_RAD, "{edge_rad} {elevation_rad}");
        }
        assert!(ground(&highest) >= 55);
    }

    #[test]
    fn what_was_learned_is_forgotten_on_a_reset() {
        let config = with_mode(PlannerConfig::default(), LearningMode::EveryScan);
        let mut perception = Perception::new(config, vlp16_surface().grid());
        let learn = |perception: &mut Perception| {
            let mut observed = vlp16_surface();
            observed.project(&undulating_scan(90, 150));
            perception.profile(&observed, &mut Vec::new()).unwrap();
            perception.diagnostics().learned
        };
        let first = learn(&mut perception);
        assert_ne!(learn(&mut perception), first);
        perception.reset(config, vlp16_surface().grid());
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

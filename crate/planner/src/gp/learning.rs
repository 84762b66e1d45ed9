//! Learning the hyperparameters, and if wanted the inducing inputs, by maximising the collapsed bound
//! ([`crate::gp::bound`]), as the paper does for each scan.
//!
//! Left alone, variance and length-scales grow until they blur the skyline: the occupancy of a scan has a
//! mean of some metres where the process assumes zero. So every hyperparameter has bounds, and most of them
//! bind. Within the default ones the edge of the surface stays about a degree above the highest return of a
//! column, as with the fixed hyperparameters; without bounds it leaves the returns by several degrees
//! (`tests/learned_edges.rs`).
//!
//! Learning happens in the logarithms of the hyperparameters and in units of the length-scales for inducing
//! inputs.

mod space;

use glam::DVec2;
use mapless_parameters::{ConfigError, choices, parameters};

use crate::gp::bound::CollapsedBound;
use crate::gp::hyperparameters::{Hyperparameters, RegressionError};
use crate::math::optimiser;
pub use crate::math::optimiser::{Optimiser, Stop};
use space::Space;

choices! {
    /// When hyperparameters are learned.
    pub enum LearningMode {
        /// Never: the configured values hold.
        Fixed = "fixed",
        /// On the first scan; the values then hold.
        Once = "once",
        /// On every scan, from the values of the scan before. Paper.
        EveryScan = "every_scan",
    }
}

impl core::str::FromStr for LearningMode {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let mode = Self::ALL.iter().find(|mode| mode.word() == name);
        mode.copied().ok_or_else(|| format!("learning \"{name}\": expected fixed, once or every_scan"))
    }
}

parameters! {
/// The mode of learning, its bounds and its budget.
    #[derive(Copy)]
    pub struct LearningConfig {
        /// When the kernel and the noise are learned.
        mode: LearningMode = LearningMode::Fixed, paper LearningMode::EveryScan;
        /// Method that climbs the bound.
        optimiser: Optimiser = Optimiser::Lbfgs;
    /// Evaluations of the bound with its gradient for each scan learned from, the first included. From the
    /// default hyperparameters within the default bounds the climb takes 7 to 15; moving inducing inputs take
    /// many more.
        evaluations_per_scan: u32 = 20, range [2, 200], check AtLeast(2.0);
        /// Whether the inducing inputs move too. Not with the lattice.
        learn_inducing_inputs: bool = false, paper true;
        /// Whether one length-scale serves both axes, within the bounds of both.
        isotropic: bool = false, paper true;
    }
    tables {
    /// Bounds of the hyperparameters.
        bounds: HyperparameterBounds;
    }
    relations check_common_bounds;
}

parameters! {
    /// Lowest and highest value of each hyperparameter; two equal ones hold it fixed.
    #[derive(Copy)]
    pub struct HyperparameterBounds {
        /// Lowest and highest signal variance σ².
        variance_m2: [f64; 2] = [0.8, 1.25], unit "m²", range [0.05, 10.0], check Ascending;
        /// Lowest and highest length-scale over azimuth.
        azimuth_length_scale_rad: [f64; 2] = [0.12, 0.2], unit "rad", range [0.01, 0.5], check Ascending;
        /// Lowest and highest length-scale over elevation.
        elevation_length_scale_rad: [f64; 2] = [0.035, 0.045], unit "rad", range [0.01, 0.5], check Ascending;
        /// Lowest and highest weighting of length-scales γ.
        alpha: [f64; 2] = [5.0, 20.0], range [0.5, 50.0], check Ascending;
        /// Lowest and highest noise variance σₙ².
        noise_variance_m2: [f64; 2] = [2.5, 4.0], unit "m²", range [0.001, 10.0], check Ascending;
    }
}

impl LearningConfig {
    /// The paper: on every scan, with one length-scale, inducing inputs included. The bounds are ours, around
    /// the length-scale and noise of [`crate::PlannerConfig::paper`].
    pub fn paper() -> Self {
        let length_scale_rad = [0.03, 0.04];
        let mut config = Self::default().with_paper_values();
        config.bounds.azimuth_length_scale_rad = length_scale_rad;
        config.bounds.elevation_length_scale_rad = length_scale_rad;
        config.bounds.noise_variance_m2 = [0.01, 2.0];
        config
    }

    fn check_common_bounds(&self, place: &str) -> Result<(), ConfigError> {
        let [lowest, highest] = self.bounds.common_length_scale_rad();
        let ok = !self.isotropic || lowest <= highest;
        let expected = "bounds on both length-scales that overlap";
        ConfigError::require(ok, place, "isotropic", self.isotropic, expected)
    }
}

impl LearningConfig {
    /// Checks that learning can start at `start`.
    ///
    /// # Errors
    /// [`LearningError`] when it lies outside the bounds.
    pub fn check_start(&self, start: &Hyperparameters) -> Result<(), LearningError> {
        Space::new(self, start, &[]).map(|_| ())
    }
}

impl HyperparameterBounds {
    fn common_length_scale_rad(&self) -> [f64; 2] {
        let ([a, b], [c, d]) = (self.azimuth_length_scale_rad, self.elevation_length_scale_rad);
        [a.max(c), b.min(d)]
    }
}

/// Why nothing could be learned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LearningError {
    /// The bound has no value at the start.
    #[error(transparent)]
    Regression(#[from] RegressionError),
    /// A hyperparameter starts outside its bounds.
    #[error("{name} = {value}: expected a start between {lowest} and {highest}")]
    OutsideBounds {
        /// Name of the hyperparameter.
        name: &'static str,
        /// Its value at the start.
        value: f64,
        /// Its lower bound.
        lowest: f64,
        /// Its upper bound.
        highest: f64,
    },
    /// One length-scale was asked for but the start has two.
    #[error("length_scales_rad = {length_scales_rad:?}: expected two equal ones, as learning is isotropic")]
    NotIsotropic {
        /// The length-scales at the start.
        length_scales_rad: [f64; 2],
    },
}

/// The result of learning from one scan.
#[derive(Clone, Debug, PartialEq)]
pub struct Learned {
    /// The hyperparameters, within their bounds; to be passed as the next start.
    pub hyperparameters: Hyperparameters,
    /// The inducing inputs, within the rectangle around the inputs and the starting ones.
    pub inducing: Vec<DVec2>,
    /// The bound at the start, nats.
    pub bound_before: f64,
    /// The bound reached, nats; never less than before.
    pub bound_after: f64,
    /// Evaluations used.
    pub evaluations: u32,
    /// Why learning ended.
    pub stop: Stop,
}

/// Learns by maximising the bound; keeps its workspace.
#[derive(Clone, Debug)]
pub struct Learner {
    config: LearningConfig,
    bound: CollapsedBound,
}

impl Learner {
    /// A learner with an empty workspace.
    pub fn new(config: LearningConfig) -> Self {
        Self { config, bound: CollapsedBound::new() }
    }

    /// Whether inducing inputs are learned too.
    pub fn moves_inducing_inputs(&self) -> bool {
        self.config.learn_inducing_inputs
    }

    /// Climbs the bound for `targets` (n) at `inputs` (n, azimuth and elevation in radians) from `start` and
    /// the inducing inputs `inducing` (m).
    ///
    /// A start learned from the scan before makes it a warm one. The first evaluation is made whatever the
    /// budget.
    ///
    /// # Errors
    /// [`LearningError`] when the start lies outside the bounds or the bound cannot be evaluated there.
    pub fn learn(
        &mut self,
        inputs: &[DVec2],
        targets: &[f64],
        inducing: &[DVec2],
        start: &Hyperparameters,
    ) -> Result<Learned, LearningError> {
        self.learn_watched(inputs, targets, inducing, start, |_, _| {})
    }

    /// As [`Learner::learn`]; `watch` is told the hyperparameters and the bound (nats) of every evaluation,
    /// the start among them. Some evaluations are steps too far and lie lower than those before.
    ///
    /// # Errors
    /// As [`Learner::learn`].
    pub fn learn_watched(
        &mut self,
        inputs: &[DVec2],
        targets: &[f64],
        inducing: &[DVec2],
        start: &Hyperparameters,
        mut watch: impl FnMut(&Hyperparameters, f64),
    ) -> Result<Learned, LearningError> {
        let space = Space::new(&self.config, start, inducing)?;
        let bound_before = self.bound.evaluate(inputs, targets, inducing, start)?;
        watch(start, bound_before);
        let mut gradient = vec![0.0; space.start.len()];
        space.write_gradient(&self.bound, &mut gradient);
        let bounds = space.bounds(&self.config, inputs);
        let mut moved = inducing.to_vec();
        let optimum = optimiser::maximise(
            self.config.optimiser,
            space.start.clone(),
            bound_before,
            gradient,
            &bounds,
            self.config.evaluations_per_scan,
            |x, gradient| {
                let hyperparameters = space.read(x, &mut moved);
                let value = self.bound.evaluate(inputs, targets, &moved, &hyperparameters).ok()?;
                watch(&hyperparameters, value);
                space.write_gradient(&self.bound, gradient);
                Some(value)
            },
        );
        let hyperparameters = space.read(&optimum.x, &mut moved);
        Ok(Learned {
            hyperparameters,
            inducing: moved,
            bound_before,
            bound_after: optimum.value,
            evaluations: optimum.evaluations,
            stop: optimum.stop,
        })
    }
}

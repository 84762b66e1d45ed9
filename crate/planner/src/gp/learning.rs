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

use crate::error::{ConfigError, require};
use crate::gp::bound::CollapsedBound;
use crate::gp::hyperparameters::{Hyperparameters, RegressionError};
use crate::math::optimiser;
pub use crate::math::optimiser::{Optimiser, Stop};
use space::Space;

/// When hyperparameters are learned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LearningMode {
    /// Never: the configured values hold.
    Fixed,
    /// On the first scan; the values then hold.
    Once,
    /// On every scan, from the values of the scan before. Paper.
    EveryScan,
}

impl core::str::FromStr for LearningMode {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "fixed" => Ok(Self::Fixed),
            "once" => Ok(Self::Once),
            "every_scan" => Ok(Self::EveryScan),
            _ => Err(format!("learning \"{name}\": expected fixed, once or every_scan")),
        }
    }
}

/// The mode of learning, its bounds and its budget.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LearningConfig {
    /// When hyperparameters are learned.
    pub mode: LearningMode,
    /// The optimiser that maximises the bound. Paper: not given.
    pub optimiser: Optimiser,
    /// Evaluations of the bound with its gradient for each scan learned from, the first included. From the
    /// default hyperparameters within the default bounds the climb takes 7 to 15; moving inducing inputs take
    /// many more.
    pub evaluations_per_scan: u32,
    /// Whether the inducing inputs move too. Paper: yes.
    pub learn_inducing_inputs: bool,
    /// Whether one length-scale serves both axes, within the bounds of both. Paper: yes.
    pub isotropic: bool,
    /// Bounds of the hyperparameters.
    pub bounds: HyperparameterBounds,
}

/// Lowest and highest value of each hyperparameter; two equal ones hold it fixed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HyperparameterBounds {
    /// Signal variance σ², square metres.
    pub variance_m2: [f64; 2],
    /// Length-scale over azimuth.
    pub azimuth_length_scale_rad: [f64; 2],
    /// Length-scale over elevation.
    pub elevation_length_scale_rad: [f64; 2],
    /// Weighting of length-scales γ.
    pub alpha: [f64; 2],
    /// Noise variance σₙ², square metres.
    pub noise_variance_m2: [f64; 2],
}

impl Default for LearningConfig {
    fn default() -> Self {
        Self {
            mode: LearningMode::Fixed,
            optimiser: Optimiser::Lbfgs,
            evaluations_per_scan: 20,
            learn_inducing_inputs: false,
            isotropic: false,
            bounds: HyperparameterBounds::default(),
        }
    }
}

impl Default for HyperparameterBounds {
    fn default() -> Self {
        Self {
            variance_m2: [0.8, 1.25],
            azimuth_length_scale_rad: [0.12, 0.2],
            elevation_length_scale_rad: [0.035, 0.045],
            alpha: [5.0, 20.0],
            noise_variance_m2: [2.5, 4.0],
        }
    }
}

impl LearningConfig {
    /// The paper: on every scan, with one length-scale, inducing inputs included. The bounds are ours, around
    /// the length-scale and noise of [`crate::PlannerConfig::paper`].
    pub fn paper() -> Self {
        let length_scale_rad = [0.03, 0.04];
        Self {
            mode: LearningMode::EveryScan,
            learn_inducing_inputs: true,
            isotropic: true,
            bounds: HyperparameterBounds {
                azimuth_length_scale_rad: length_scale_rad,
                elevation_length_scale_rad: length_scale_rad,
                noise_variance_m2: [0.01, 2.0],
                ..HyperparameterBounds::default()
            },
            ..Self::default()
        }
    }
}

impl LearningConfig {
    /// Checks every value; `place` names the table in error messages.
    ///
    /// # Errors
    /// [`ConfigError`] with the first value that makes no sense.
    pub fn validate(&self, place: &str) -> Result<(), ConfigError> {
        let evaluations = self.evaluations_per_scan;
        require(evaluations >= 2, place, "evaluations_per_scan", evaluations, "at least 2")?;
        let bounds = &self.bounds;
        let ranges = [
            ("bounds.variance_m2", bounds.variance_m2),
            ("bounds.azimuth_length_scale_rad", bounds.azimuth_length_scale_rad),
            ("bounds.elevation_length_scale_rad", bounds.elevation_length_scale_rad),
            ("bounds.alpha", bounds.alpha),
            ("bounds.noise_variance_m2", bounds.noise_variance_m2),
        ];
        for (name, [lowest, highest]) in ranges {
            let ok = lowest > 0.0 && lowest <= highest && highest.is_finite();
            let value = format!("[{lowest}, {highest}]");
            require(ok, place, name, value, "two positive numbers, the lower one first")?;
        }
        let [lowest, highest] = bounds.common_length_scale_rad();
        require(
            !self.isotropic || lowest <= highest,
            place,
            "isotropic",
            self.isotropic,
            "bounds on both length-scales that overlap",
        )
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
        let space = Space::new(&self.config, start, inducing)?;
        let bound_before = self.bound.evaluate(inputs, targets, inducing, start)?;
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

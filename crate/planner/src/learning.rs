//! Learning the hyperparameters, and if wanted the inducing inputs, by maximising the collapsed bound ([`crate::bound`]), as
//! the paper does for each scan.
//!
//! Left alone, the maximum lies at a variance in the thousands and length-scales that blur the skyline: the occupancy of a scan
//! has a mean of some metres where the process assumes zero. So every hyperparameter has bounds, and most of them bind. Within the
//! default ones the edge of the surface stays about a degree above the highest return of a column, as with the fixed
//! hyperparameters; without bounds it leaves the returns by several degrees (`tests/learned_edges.rs`).
//!
//! Learning happens in the logarithms of the hyperparameters and in units of the length-scales for inducing inputs.

use glam::DVec2;

use crate::ascent::{self, Bounds};
pub use crate::ascent::{Optimiser, Stop};
use crate::bound::CollapsedBound;
use crate::error::{ConfigError, require};
use crate::hyperparameters::{Hyperparameters, LogGradient, RegressionError};
use crate::kernel::RationalQuadratic;

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

/// What learning may do and how much work it may be.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LearningConfig {
    /// When.
    pub mode: LearningMode,
    /// Which method climbs the bound. Paper: not given.
    pub optimiser: Optimiser,
    /// Evaluations of the bound with its gradient for each scan learned from, the first included. From the default
    /// hyperparameters within the default bounds the climb takes 7 to 15; moving inducing inputs take many more.
    pub evaluations_per_scan: u32,
    /// Whether the inducing inputs move too. Paper: yes.
    pub learn_inducing_inputs: bool,
    /// Whether one length-scale serves both axes, within the bounds of both. Paper: yes.
    pub isotropic: bool,
    /// Where the hyperparameters may go.
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
            variance_m2: [0.5, 2.0],
            azimuth_length_scale_rad: [0.05, 0.12],
            elevation_length_scale_rad: [0.025, 0.04],
            alpha: [1.0, 10.0],
            noise_variance_m2: [0.5, 2.0],
        }
    }
}

impl LearningConfig {
    /// The paper: on every scan, with one length-scale, inducing inputs included. The bounds are ours, around the length-scale
    /// and noise of [`crate::PlannerConfig::paper`].
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

/// What was learned from one scan.
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

/// Learns by climbing the bound; keeps its workspace.
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

    /// Climbs the bound for `targets` (n) at `inputs` (n, azimuth and elevation in radians) from `start` and the inducing
    /// inputs `inducing` (m).
    ///
    /// A start learned from the scan before makes it a warm one. The first evaluation is made whatever the budget.
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
        let summit = ascent::climb(
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
        let hyperparameters = space.read(&summit.x, &mut moved);
        Ok(Learned {
            hyperparameters,
            inducing: moved,
            bound_before,
            bound_after: summit.value,
            evaluations: summit.evaluations,
            stop: summit.stop,
        })
    }
}

/// The coordinates learned: logarithms of the hyperparameters, then inducing inputs over the starting length-scales.
struct Space<'a> {
    from: &'a Hyperparameters,
    inducing: &'a [DVec2],
    /// Radians in one unit of an inducing coordinate.
    unit: DVec2,
    isotropic: bool,
    /// Bounds of the hyperparameters, in the order of the coordinates.
    ranges: Vec<[f64; 2]>,
    start: Vec<f64>,
}

impl<'a> Space<'a> {
    fn new(
        config: &LearningConfig,
        from: &'a Hyperparameters,
        inducing: &'a [DVec2],
    ) -> Result<Self, LearningError> {
        let [azimuth, elevation] = from.kernel.length_scales_rad;
        let bounds = &config.bounds;
        let mut named = vec![("kernel.variance", from.kernel.variance, bounds.variance_m2)];
        if config.isotropic {
            if azimuth.to_bits() != elevation.to_bits() {
                return Err(LearningError::NotIsotropic { length_scales_rad: [azimuth, elevation] });
            }
            named.push(("kernel.length_scales_rad", azimuth, bounds.common_length_scale_rad()));
        } else {
            named.push(("kernel.length_scales_rad[0]", azimuth, bounds.azimuth_length_scale_rad));
            named.push(("kernel.length_scales_rad[1]", elevation, bounds.elevation_length_scale_rad));
        }
        named.push(("kernel.alpha", from.kernel.alpha, bounds.alpha));
        named.push(("noise_variance", from.noise_variance, bounds.noise_variance_m2));
        for &(name, value, [lowest, highest]) in &named {
            // NaN lies in no range.
            if !(lowest..=highest).contains(&value) {
                return Err(LearningError::OutsideBounds { name, value, lowest, highest });
            }
        }
        let unit = DVec2::new(azimuth, elevation);
        let mut start: Vec<f64> = named.iter().map(|(_, value, _)| libm::log(*value)).collect();
        if config.learn_inducing_inputs {
            start.extend(inducing.iter().flat_map(|z| (*z / unit).to_array()));
        }
        let ranges = named.iter().map(|(_, _, range)| *range).collect();
        Ok(Self { from, inducing, unit, isotropic: config.isotropic, ranges, start })
    }

    /// The box of the coordinates: around inducing inputs the rectangle that holds them and the inputs.
    fn bounds(&self, config: &LearningConfig, inputs: &[DVec2]) -> Bounds {
        let side = |k: usize| self.ranges.iter().map(|range| libm::log(range[k])).collect::<Vec<f64>>();
        let mut bounds = Bounds { lowest: side(0), highest: side(1) };
        if config.learn_inducing_inputs {
            let all = || inputs.iter().chain(self.inducing).map(|point| *point / self.unit);
            let lowest = all().fold(DVec2::INFINITY, DVec2::min).to_array();
            let highest = all().fold(DVec2::NEG_INFINITY, DVec2::max).to_array();
            for _ in self.inducing {
                bounds.lowest.extend(lowest);
                bounds.highest.extend(highest);
            }
        }
        bounds
    }

    /// The hyperparameters at `x`, and the inducing inputs into `moved`; a coordinate that has not moved keeps its bits.
    fn read(&self, x: &[f64], moved: &mut [DVec2]) -> Hyperparameters {
        let at = |k: usize, from: f64| {
            let [lowest, highest] = self.ranges[k];
            let same = x[k].to_bits() == self.start[k].to_bits();
            if same { from } else { libm::exp(x[k]).min(highest).max(lowest) }
        };
        let count = self.ranges.len();
        for ((place, pair), from) in moved.iter_mut().zip(x[count..].chunks_exact(2)).zip(self.inducing) {
            let unmoved = *from / self.unit;
            let scaled = DVec2::new(pair[0], pair[1]);
            *place = if scaled == unmoved { *from } else { scaled * self.unit };
        }
        let RationalQuadratic { variance, length_scales_rad: [azimuth, elevation], alpha } = self.from.kernel;
        let second = if self.isotropic { 1 } else { 2 };
        let kernel = RationalQuadratic {
            variance: at(0, variance),
            length_scales_rad: [at(1, azimuth), at(second, elevation)],
            alpha: at(second + 1, alpha),
        };
        Hyperparameters { kernel, noise_variance: at(second + 2, self.from.noise_variance) }
    }

    /// The gradient of the last evaluation in these coordinates.
    fn write_gradient(&self, bound: &CollapsedBound, gradient: &mut [f64]) {
        let LogGradient { variance, length_scales: [azimuth, elevation], alpha, noise_variance } =
            *bound.gradient();
        let count = self.ranges.len();
        if self.isotropic {
            gradient[..count].copy_from_slice(&[variance, azimuth + elevation, alpha, noise_variance]);
        } else {
            gradient[..count].copy_from_slice(&[variance, azimuth, elevation, alpha, noise_variance]);
        }
        for (pair, slope) in gradient[count..].chunks_exact_mut(2).zip(bound.inducing_gradient()) {
            pair.copy_from_slice(&(*slope * self.unit).to_array());
        }
    }
}

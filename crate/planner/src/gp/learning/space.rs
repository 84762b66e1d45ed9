//! The coordinates of learning.

use glam::DVec2;

use super::{LearningConfig, LearningError};
use crate::gp::bound::CollapsedBound;
use crate::gp::hyperparameters::{Hyperparameters, LogGradient};
use crate::gp::kernel::RationalQuadratic;
use crate::math::optimiser::Bounds;

/// The coordinates learned: logarithms of the hyperparameters, then inducing inputs over the starting
/// length-scales.
pub(super) struct Space<'a> {
    from: &'a Hyperparameters,
    inducing: &'a [DVec2],
    /// Radians in one unit of an inducing coordinate.
    unit: DVec2,
    isotropic: bool,
    /// Bounds of the hyperparameters, in the order of the coordinates.
    ranges: Vec<[f64; 2]>,
    pub(super) start: Vec<f64>,
}

impl<'a> Space<'a> {
    pub(super) fn new(
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
    pub(super) fn bounds(&self, config: &LearningConfig, inputs: &[DVec2]) -> Bounds {
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

    /// The hyperparameters at `x`, and the inducing inputs into `moved`; a coordinate that has not moved
    /// keeps its bits.
    pub(super) fn read(&self, x: &[f64], moved: &mut [DVec2]) -> Hyperparameters {
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
    pub(super) fn write_gradient(&self, bound: &CollapsedBound, gradient: &mut [f64]) {
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

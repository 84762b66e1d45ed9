//! The hyperparameters of Gaussian process regression, and what can be wrong with a regression problem.

use glam::DVec2;

use crate::gp::jitter::GpError;
use crate::gp::kernel::RationalQuadratic;

/// What a regression is given besides its data.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hyperparameters {
    /// The kernel: signal variance, length-scales and alpha.
    pub kernel: RationalQuadratic,
    /// Noise variance σₙ² of a target, in the square of the targets' unit.
    pub noise_variance: f64,
}

/// Derivatives of an objective with respect to the logarithms of the hyperparameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LogGradient {
    /// With respect to the log signal variance.
    pub variance: f64,
    /// With respect to the log length-scales over azimuth and elevation.
    pub length_scales: [f64; 2],
    /// With respect to log alpha.
    pub alpha: f64,
    /// With respect to the log noise variance.
    pub noise_variance: f64,
}

/// Why a regression has no value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RegressionError {
    /// There are no training inputs.
    #[error("no training inputs: expected at least one")]
    NoInputs,
    /// As many targets as inputs are needed.
    #[error("{targets} targets for {inputs} inputs: expected as many")]
    LengthMismatch {
        /// Number of training inputs.
        inputs: usize,
        /// Number of targets.
        targets: usize,
    },
    /// A coordinate or target is not a number.
    #[error("{what}[{index}] = {value}: expected a finite number")]
    NotFinite {
        /// Which list holds the value.
        what: &'static str,
        /// Its place in the list.
        index: usize,
        /// The value.
        value: f64,
    },
    /// A hyperparameter outside its meaning.
    #[error("{name} = {value}: expected a positive number")]
    NotPositive {
        /// Name of the hyperparameter.
        name: &'static str,
        /// The value.
        value: f64,
    },
    /// The inducing covariance could not be factored, or there are no inducing inputs.
    #[error(transparent)]
    Sparse(#[from] GpError),
    /// The covariance of the targets could not be factored, or the value overflows.
    #[error(
        "the covariance of {inputs} targets is not positive definite at noise variance {noise_variance:e}"
    )]
    IllConditioned {
        /// Number of training inputs.
        inputs: usize,
        /// The noise variance on its diagonal.
        noise_variance: f64,
    },
}

impl Hyperparameters {
    /// Fails unless every hyperparameter is positive and finite.
    pub(crate) fn check(&self) -> Result<(), RegressionError> {
        let [azimuth, elevation] = self.kernel.length_scales_rad;
        let named = [
            ("kernel.variance", self.kernel.variance),
            ("kernel.length_scales_rad[0]", azimuth),
            ("kernel.length_scales_rad[1]", elevation),
            ("kernel.alpha", self.kernel.alpha),
            ("noise_variance", self.noise_variance),
        ];
        for (name, value) in named {
            if !(value > 0.0 && value.is_finite()) {
                return Err(RegressionError::NotPositive { name, value });
            }
        }
        Ok(())
    }
}

/// Fails unless inputs and targets pair up and are finite.
pub(crate) fn check_data(inputs: &[DVec2], targets: &[f64]) -> Result<(), RegressionError> {
    if inputs.is_empty() {
        return Err(RegressionError::NoInputs);
    }
    if inputs.len() != targets.len() {
        return Err(RegressionError::LengthMismatch { inputs: inputs.len(), targets: targets.len() });
    }
    check_points("inputs", inputs)?;
    match targets.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(RegressionError::NotFinite { what: "targets", index, value: targets[index] }),
        None => Ok(()),
    }
}

/// Fails unless every coordinate is finite.
pub(crate) fn check_points(what: &'static str, points: &[DVec2]) -> Result<(), RegressionError> {
    for (index, point) in points.iter().enumerate() {
        if !point.is_finite() {
            let value = if point.x.is_finite() { point.y } else { point.x };
            return Err(RegressionError::NotFinite { what, index, value });
        }
    }
    Ok(())
}

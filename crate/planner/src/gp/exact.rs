//! Exact Gaussian process regression, the reference for the sparse approximation. O(n³), plain rather than
//! fast, and without jitter.
//!
//! With K the covariance of the inputs, L Lᵀ = K + σₙ² I and a = (K + σₙ² I)⁻¹ y (Rasmussen and Williams
//! 2006, algorithm 2.1, <https://gaussianprocess.org/gpml/>):
//!
//! - log p(y) = -½ yᵀa - Σ log L_ii - n/2 log 2π,
//! - its derivative with respect to θ: ½ tr((a aᵀ - (K + σₙ² I)⁻¹) ∂K/∂θ),
//! - at a test input with covariances k_*: mean = k_*ᵀ a, variance = k_** - |L⁻¹ k_*|².

use core::f64::consts::TAU;

use glam::DVec2;

use crate::gp::hyperparameters::{Hyperparameters, LogGradient, RegressionError, check_data};
use crate::math::cholesky::{NotPositiveDefinite, cholesky};
use crate::math::linalg;
use crate::math::panels;

/// A fitted exact posterior.
#[derive(Clone, Debug)]
pub struct ExactGp {
    hyperparameters: Hyperparameters,
    inputs: Vec<DVec2>,
    /// L, n × n.
    l: Vec<f64>,
    /// a, n.
    weights: Vec<f64>,
    log_marginal_likelihood: f64,
}

impl ExactGp {
    /// Fits the posterior to `targets` (n) at `inputs` (n), given as (azimuth, elevation) in radians.
    ///
    /// # Errors
    /// [`RegressionError`] when the data do not pair up, something is not a number, a hyperparameter is not
    /// positive, or the covariance cannot be factored.
    pub fn fit(
        inputs: &[DVec2],
        targets: &[f64],
        hyperparameters: Hyperparameters,
    ) -> Result<Self, RegressionError> {
        check_data(inputs, targets)?;
        hyperparameters.check()?;
        let Hyperparameters { kernel, noise_variance } = hyperparameters;
        let n = inputs.len();
        let mut l: Vec<f64> =
            inputs.iter().flat_map(|a| inputs.iter().map(move |b| kernel.covariance(*a, *b))).collect();
        for i in 0..n {
            l[i * n + i] += noise_variance;
        }
        let ill_conditioned = RegressionError::IllConditioned { inputs: n, noise_variance };
        cholesky(&mut l, n, &mut Vec::new()).map_err(|NotPositiveDefinite| ill_conditioned.clone())?;
        let mut weights = targets.to_vec();
        linalg::solve_lower_vector(&l, n, &mut weights);
        linalg::solve_lower_transposed_vector(&l, n, &mut weights);
        let fit: f64 = targets.iter().zip(&weights).map(|(y, a)| y * a).sum();
        let half_log_det: f64 = (0..n).map(|i| libm::log(l[i * n + i])).sum();
        let log_marginal_likelihood = -0.5 * (fit + n as f64 * libm::log(TAU)) - half_log_det;
        if !log_marginal_likelihood.is_finite() {
            return Err(ill_conditioned);
        }
        Ok(Self { hyperparameters, inputs: inputs.to_vec(), l, weights, log_marginal_likelihood })
    }

    /// log p(y) in nats.
    pub fn log_marginal_likelihood(&self) -> f64 {
        self.log_marginal_likelihood
    }

    /// The gradient of log p(y) with respect to the log hyperparameters.
    pub fn gradient(&self) -> LogGradient {
        let n = self.inputs.len();
        let Hyperparameters { kernel, noise_variance } = self.hyperparameters;
        let (mut inverse, mut scratch) = (vec![0.0; n * n], vec![0.0; n * n]);
        panels::invert(&self.l, n, &mut inverse, &mut scratch, &mut Vec::new());

        let [azimuth, elevation] = kernel.length_scales_rad;
        let mut gradient = LogGradient::default();
        for i in 0..n {
            for j in 0..n {
                let adjoint = 0.5 * (self.weights[i] * self.weights[j] - inverse[i * n + j]);
                let weighted = adjoint * kernel.covariance(self.inputs[i], self.inputs[j]);
                let scaled = (self.inputs[i] - self.inputs[j]) / DVec2::new(azimuth, elevation);
                let squares = scaled * scaled;
                let s = 1.0 + (squares.x + squares.y) / (2.0 * kernel.alpha);
                gradient.variance += weighted;
                gradient.length_scales[0] += weighted * squares.x / s;
                gradient.length_scales[1] += weighted * squares.y / s;
                gradient.alpha += kernel.alpha * weighted * ((s - 1.0) / s - libm::log(s));
                if i == j {
                    gradient.noise_variance += noise_variance * adjoint;
                }
            }
        }
        gradient
    }

    /// Predictive mean and variance of the latent function at one input, without noise.
    pub fn predict(&self, input: DVec2) -> (f64, f64) {
        let kernel = &self.hyperparameters.kernel;
        let mut covariances: Vec<f64> = self.inputs.iter().map(|x| kernel.covariance(*x, input)).collect();
        let mean = covariances.iter().zip(&self.weights).map(|(k, a)| k * a).sum();
        linalg::solve_lower_vector(&self.l, self.inputs.len(), &mut covariances);
        let explained: f64 = covariances.iter().map(|t| t * t).sum();
        (mean, kernel.variance - explained)
    }
}

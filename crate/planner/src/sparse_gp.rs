//! Variational sparse Gaussian process regression (Titsias 2009, collapsed bound), as gpflow's `SGPR` computes it.
//!
//! With inducing inputs Z (m), training inputs X (n), targets y and noise variance σₙ²:
//! L Lᵀ = K_uu + jitter I, A = L⁻¹ K_uf / σₙ, L_B L_Bᵀ = I + A Aᵀ, c = L_B⁻¹ A y / σₙ. At a test input with
//! covariances k_u*: t = L⁻¹ k_u*, s = L_B⁻¹ t, mean = sᵀ c, variance = k_** - tᵀ t + sᵀ s.
//! Fitting costs O(n m²), a prediction O(m²).

use glam::DVec2;

use crate::hyperparameters::Hyperparameters;
use crate::kernel::RationalQuadratic;
use crate::linalg::{self, NotPositiveDefinite};
use crate::panels::{self, Row, WIDTH};
use crate::projection::Projection;

/// Why a fit gave no posterior.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GpError {
    /// The inducing covariance stayed indefinite at the largest jitter.
    #[error("the covariance of {inducing} inducing inputs is not positive definite at jitter {jitter:e}")]
    IllConditioned {
        /// Number of inducing inputs.
        inducing: usize,
        /// The last jitter tried.
        jitter: f64,
    },
    /// No bound to climb: the covariance could not be factored at the start.
    #[error("nothing can be learned through {inducing} inducing inputs")]
    NothingLearned {
        /// Number of inducing inputs.
        inducing: usize,
    },
    /// There was nothing to fit.
    #[error("no inducing inputs")]
    NoInducingInputs,
}

/// Jitter tried first and last; gpflow adds the first one.
const FIRST_JITTER: f64 = 1e-6;
const LAST_JITTER: f64 = 1e-2;

/// Tries to `factor` the covariance of `inducing` inputs with ever more jitter on its diagonal; gives the jitter that did.
pub(crate) fn with_rising_jitter(
    inducing: usize,
    mut factor: impl FnMut(f64) -> Result<(), NotPositiveDefinite>,
) -> Result<f64, GpError> {
    let mut jitter = FIRST_JITTER;
    while factor(jitter).is_err() {
        if jitter >= LAST_JITTER {
            return Err(GpError::IllConditioned { inducing, jitter });
        }
        jitter *= 10.0;
    }
    Ok(jitter)
}

/// A fitted posterior with its workspace; refitting reuses the memory.
#[derive(Clone, Debug)]
pub struct SparseGp {
    hyperparameters: Hyperparameters,
    projection: Projection,
    /// L_B, m × m.
    l_b: Vec<f64>,
    c: Vec<f64>,
    panel: Vec<Row>,
}

impl SparseGp {
    /// An unfitted process; `noise_variance` is σₙ² in the square of the targets' unit.
    pub fn new(kernel: RationalQuadratic, noise_variance: f64) -> Self {
        Self {
            hyperparameters: Hyperparameters { kernel, noise_variance },
            projection: Projection::default(),
            l_b: Vec::new(),
            c: Vec::new(),
            panel: Vec::new(),
        }
    }

    /// The kernel.
    pub fn kernel(&self) -> &RationalQuadratic {
        &self.hyperparameters.kernel
    }

    /// Jitter on the inducing covariance that the last fit needed; 1e-6 unless it was ill-conditioned.
    pub fn jitter(&self) -> f64 {
        self.projection.jitter
    }

    /// Fits the posterior to `targets` (n) at `inputs` (n) through the inducing inputs `inducing` (m).
    ///
    /// Inputs are (azimuth, elevation) in radians.
    ///
    /// # Errors
    /// [`GpError`] when there are no inducing inputs or no jitter makes their covariance positive definite.
    pub fn fit(&mut self, inputs: &[DVec2], targets: &[f64], inducing: &[DVec2]) -> Result<(), GpError> {
        if inducing.is_empty() {
            return Err(GpError::NoInducingInputs);
        }
        let m = inducing.len();
        self.projection.project(inputs, targets, inducing, &self.hyperparameters)?;
        self.l_b.clone_from(&self.projection.aat);
        for i in 0..m {
            self.l_b[i * m + i] += 1.0;
        }
        linalg::cholesky(&mut self.l_b, m)
            .map_err(|NotPositiveDefinite| GpError::IllConditioned { inducing: m, jitter: self.jitter() })?;
        self.c.clone_from(&self.projection.c);
        linalg::solve_lower_vector(&self.l_b, m, &mut self.c);
        Ok(())
    }

    /// Predictive mean and variance of the latent function at `inputs`, added to no noise.
    pub fn predict(&mut self, inputs: &[DVec2], mean: &mut [f64], variance: &mut [f64]) {
        let kernel = &self.hyperparameters.kernel;
        let Projection { points, input_panels, l, .. } = &mut self.projection;
        input_panels.set(inputs, kernel);
        self.panel.resize(points.len(), [0.0; WIDTH]);
        for (index, (mean, variance)) in mean.chunks_mut(WIDTH).zip(variance.chunks_mut(WIDTH)).enumerate() {
            input_panels.covariances(kernel, points, index, &mut self.panel);
            let (mut means, mut variances) = ([0.0; WIDTH], [kernel.variance; WIDTH]);
            panels::solve_lower(l, &mut self.panel);
            for t in &self.panel {
                for lane in 0..WIDTH {
                    variances[lane] -= t[lane] * t[lane];
                }
            }
            panels::solve_lower(&self.l_b, &mut self.panel);
            for (s, c) in self.panel.iter().zip(&self.c) {
                for lane in 0..WIDTH {
                    variances[lane] += s[lane] * s[lane];
                    means[lane] += s[lane] * c;
                }
            }
            mean.copy_from_slice(&means[..mean.len()]);
            variance.copy_from_slice(&variances[..variance.len()]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNEL: RationalQuadratic =
        RationalQuadratic { variance: 1.0, length_scales_rad: [0.15, 0.05], alpha: 10.0 };

    #[test]
    fn far_from_the_data_the_prior_returns() {
        let mut gp = SparseGp::new(KERNEL, 0.01);
        gp.fit(&[DVec2::ZERO], &[2.0], &[DVec2::ZERO]).unwrap();
        let (mut mean, mut variance) = ([0.0; 2], [0.0; 2]);
        gp.predict(&[DVec2::ZERO, DVec2::new(3.0, 0.0)], &mut mean, &mut variance);
        assert!((mean[0] - 2.0 / 1.01).abs() < 1e-5 && variance[0] < 0.011);
        assert!(mean[1].abs() < 1e-9 && (variance[1] - 1.0).abs() < 1e-9);
    }

    #[test]
    fn duplicate_inducing_inputs_are_carried_by_the_jitter() {
        let mut gp = SparseGp::new(KERNEL, 0.01);
        let inputs = [DVec2::ZERO; 5];
        gp.fit(&inputs, &[1.0; 5], &inputs).unwrap();
        let (mut mean, mut variance) = ([0.0], [0.0]);
        gp.predict(&inputs[..1], &mut mean, &mut variance);
        assert!((mean[0] - 1.0).abs() < 0.01 && variance[0] >= 0.0);
    }

    #[test]
    fn nothing_to_fit_is_an_error() {
        assert_eq!(SparseGp::new(KERNEL, 0.1).fit(&[], &[], &[]), Err(GpError::NoInducingInputs));
    }
}

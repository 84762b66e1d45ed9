//! Variational sparse Gaussian process regression (Titsias 2009, collapsed bound), as gpflow's `SGPR` computes it.
//!
//! With inducing inputs Z (m), training inputs X (n), targets y and noise variance σₙ²:
//! L Lᵀ = K_uu + jitter I, A = L⁻¹ K_uf / σₙ, L_B L_Bᵀ = I + A Aᵀ, c = L_B⁻¹ A y / σₙ. At a test input with
//! covariances k_u*: t = L⁻¹ k_u*, s = L_B⁻¹ t, mean = sᵀ c, variance = k_** - tᵀ t + sᵀ s.
//! Fitting costs O(n m²), a prediction O(m²).

use glam::DVec2;

use crate::kernel::RationalQuadratic;
use crate::linalg::{self, NotPositiveDefinite};

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
    /// There was nothing to fit.
    #[error("no inducing inputs")]
    NoInducingInputs,
}

/// Jitter tried first and last; gpflow adds the first one.
pub(crate) const FIRST_JITTER: f64 = 1e-6;
pub(crate) const LAST_JITTER: f64 = 1e-2;

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

/// Coordinates divided by the kernel's length-scales, one array per axis so that kernel rows vectorise.
#[derive(Clone, Debug, Default)]
struct ScaledInputs {
    azimuths: Vec<f64>,
    elevations: Vec<f64>,
}

impl ScaledInputs {
    fn set(&mut self, inputs: &[DVec2], kernel: &RationalQuadratic) {
        let [azimuth, elevation] = kernel.length_scales_rad;
        self.azimuths.clear();
        self.elevations.clear();
        self.azimuths.extend(inputs.iter().map(|p| p.x / azimuth));
        self.elevations.extend(inputs.iter().map(|p| p.y / elevation));
    }

    fn len(&self) -> usize {
        self.azimuths.len()
    }

    fn point(&self, index: usize) -> DVec2 {
        DVec2::new(self.azimuths[index], self.elevations[index])
    }
}

/// A fitted posterior with its workspace; refitting reuses the memory.
#[derive(Clone, Debug)]
pub struct SparseGp {
    kernel: RationalQuadratic,
    noise_variance: f64,
    jitter: f64,
    inducing: ScaledInputs,
    inputs: ScaledInputs,
    /// L, m × m.
    l: Vec<f64>,
    /// L_B, m × m.
    l_b: Vec<f64>,
    /// A while fitting (m × n), L⁻¹ K_u* while predicting (m × test inputs).
    wide: Vec<f64>,
    c: Vec<f64>,
}

impl SparseGp {
    /// An unfitted process; `noise_variance` is σₙ² in the square of the targets' unit.
    pub fn new(kernel: RationalQuadratic, noise_variance: f64) -> Self {
        Self {
            kernel,
            noise_variance,
            jitter: FIRST_JITTER,
            inducing: ScaledInputs::default(),
            inputs: ScaledInputs::default(),
            l: Vec::new(),
            l_b: Vec::new(),
            wide: Vec::new(),
            c: Vec::new(),
        }
    }

    /// The kernel.
    pub fn kernel(&self) -> &RationalQuadratic {
        &self.kernel
    }

    /// Jitter on the inducing covariance that the last fit needed; 1e-6 unless it was ill-conditioned.
    pub fn jitter(&self) -> f64 {
        self.jitter
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
        self.inducing.set(inducing, &self.kernel);
        self.inputs.set(inputs, &self.kernel);
        let (m, n) = (self.inducing.len(), self.inputs.len());

        self.factor_inducing_covariance()?;
        self.fill_covariances();
        linalg::solve_lower(&self.l, m, &mut self.wide, n);
        let inverse_noise_deviation = 1.0 / self.noise_variance.sqrt();
        for value in &mut self.wide {
            *value *= inverse_noise_deviation;
        }

        self.l_b.resize(m * m, 0.0);
        linalg::outer_product(&self.wide, m, n, &mut self.l_b);
        for i in 0..m {
            self.l_b[i * m + i] += 1.0;
        }
        linalg::cholesky(&mut self.l_b, m)
            .map_err(|NotPositiveDefinite| GpError::IllConditioned { inducing: m, jitter: self.jitter })?;

        self.c.resize(m, 0.0);
        linalg::multiply_vector(&self.wide, n, targets, &mut self.c);
        for value in &mut self.c {
            *value *= inverse_noise_deviation;
        }
        linalg::solve_lower_vector(&self.l_b, m, &mut self.c);
        Ok(())
    }

    /// Predictive mean and variance of the latent function at `inputs`, added to no noise.
    pub fn predict(&mut self, inputs: &[DVec2], mean: &mut [f64], variance: &mut [f64]) {
        self.inputs.set(inputs, &self.kernel);
        let (m, count) = (self.inducing.len(), self.inputs.len());
        self.fill_covariances();
        linalg::solve_lower(&self.l, m, &mut self.wide, count);
        variance.fill(self.kernel.variance);
        for row in self.wide.chunks_exact(count) {
            for (v, t) in variance.iter_mut().zip(row) {
                *v -= t * t;
            }
        }
        linalg::solve_lower(&self.l_b, m, &mut self.wide, count);
        mean.fill(0.0);
        for (row, c) in self.wide.chunks_exact(count).zip(&self.c) {
            for ((v, e), s) in variance.iter_mut().zip(mean.iter_mut()).zip(row) {
                *v += s * s;
                *e += s * c;
            }
        }
    }

    /// L of K_uu, with the jitter raised step by step until it exists.
    fn factor_inducing_covariance(&mut self) -> Result<(), GpError> {
        let m = self.inducing.len();
        self.l.resize(m * m, 0.0);
        let Self { l, inducing, kernel, .. } = self;
        self.jitter = with_rising_jitter(m, |jitter| {
            for (i, row) in l.chunks_exact_mut(m).enumerate() {
                kernel.row(inducing.point(i), &inducing.azimuths, &inducing.elevations, row);
                row[i] += jitter;
            }
            linalg::cholesky(l, m)
        })?;
        Ok(())
    }

    /// K between the inducing inputs and the current inputs, into `wide`.
    fn fill_covariances(&mut self) {
        let n = self.inputs.len();
        self.wide.resize(self.inducing.len() * n, 0.0);
        if n == 0 {
            return;
        }
        for (i, row) in self.wide.chunks_exact_mut(n).enumerate() {
            self.kernel.row(self.inducing.point(i), &self.inputs.azimuths, &self.inputs.elevations, row);
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

//! Variational sparse Gaussian process regression (Titsias 2009, collapsed bound,
//! <https://proceedings.mlr.press/v5/titsias09a.html>), as gpflow's `SGPR` computes it.
//!
//! With inducing inputs Z (m), training inputs X (n), targets y and noise variance σₙ²:
//!
//! - L Lᵀ = K_uu + jitter I, A = L⁻¹ K_uf / σₙ, L_B L_Bᵀ = I + A Aᵀ, c = L_B⁻¹ A y / σₙ,
//! - at a test input with covariances k_u*: t = L⁻¹ k_u*, s = L_B⁻¹ t,
//! - mean = sᵀ c, variance = k_** - tᵀ t + sᵀ s.
//!
//! The factors that do not depend on the test input are computed once (W in module `reduction`):
//!
//! - mean = wᵀ k_u* with w = L⁻ᵀ L_B⁻ᵀ c,
//! - variance = k_** - k_u*ᵀ W k_u*.
//!
//! Fitting costs O(n m²), a prediction O(m²). Everything is sorted by azimuth, so that inputs out of the
//! kernel's reach cost nothing.

use glam::DVec2;

use crate::gp::hyperparameters::Hyperparameters;
use crate::gp::jitter::GpError;
use crate::gp::kernel::RationalQuadratic;
use crate::gp::projection::Projection;
use crate::gp::reduction::Reduction;
use crate::math::cholesky::{NotPositiveDefinite, cholesky};
use crate::math::linalg;
use crate::math::panels::{Row, WIDTH};

/// Covariances below this share of the variance count as zero.
const NEGLIGIBLE: f64 = 1e-12;
/// Covariances below this share of the variance count as zero in the form kᵀ W k, where they are multiplied
/// with factors as small.
const NEGLIGIBLE_IN_VARIANCE: f64 = 1e-8;

/// A fitted posterior with its workspace; refitting reuses the memory.
#[derive(Clone, Debug)]
pub struct SparseGp {
    hyperparameters: Hyperparameters,
    /// The last fit's data, in ascending order of azimuth.
    data: Vec<(DVec2, f64)>,
    inputs: Vec<DVec2>,
    targets: Vec<f64>,
    inducing: Vec<DVec2>,
    projection: Projection,
    /// L_B, m × m.
    l_b: Vec<f64>,
    /// w.
    weights: Vec<f64>,
    /// W.
    reduction: Reduction,
    panel: Vec<Row>,
}

impl SparseGp {
    /// An unfitted process; `noise_variance` is σₙ² in the square of the targets' unit.
    pub fn new(kernel: RationalQuadratic, noise_variance: f64) -> Self {
        Self {
            hyperparameters: Hyperparameters { kernel, noise_variance },
            data: Vec::new(),
            inputs: Vec::new(),
            targets: Vec::new(),
            inducing: Vec::new(),
            projection: Projection::default(),
            l_b: Vec::new(),
            weights: Vec::new(),
            reduction: Reduction::default(),
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
        self.sort(inputs, targets, inducing);
        let reach = self.kernel().reach(NEGLIGIBLE);
        self.projection.project(&self.inputs, &self.targets, &self.inducing, &self.hyperparameters, reach)?;
        self.l_b.clone_from(&self.projection.aat);
        for i in 0..m {
            self.l_b[i * m + i] += 1.0;
        }
        cholesky(&mut self.l_b, m, &mut self.panel)
            .map_err(|NotPositiveDefinite| GpError::IllConditioned { inducing: m, jitter: self.jitter() })?;
        self.weights.clone_from(&self.projection.c);
        linalg::solve_lower_vector(&self.l_b, m, &mut self.weights);
        linalg::solve_lower_transposed_vector(&self.l_b, m, &mut self.weights);
        linalg::solve_lower_transposed_vector(&self.projection.l, m, &mut self.weights);
        self.reduction.set(&self.projection.l, &self.l_b, m, &mut self.panel);
        Ok(())
    }

    fn sort(&mut self, inputs: &[DVec2], targets: &[f64], inducing: &[DVec2]) {
        let in_order = |a: &DVec2, b: &DVec2| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
        self.data.clear();
        self.data.extend(inputs.iter().copied().zip(targets.iter().copied()));
        // Entries that compare equal have the same bits, so their order does not matter.
        self.data.sort_unstable_by(|(a, y), (b, z)| in_order(a, b).then(y.total_cmp(z)));
        self.inputs.clear();
        self.inputs.extend(self.data.iter().map(|(input, _)| *input));
        self.targets.clear();
        self.targets.extend(self.data.iter().map(|(_, target)| *target));
        self.inducing.clear();
        self.inducing.extend_from_slice(inducing);
        self.inducing.sort_unstable_by(in_order);
    }

    /// Predictive mean and variance of the latent function at `inputs`, without noise.
    pub fn predict(&mut self, inputs: &[DVec2], mean: &mut [f64], variance: &mut [f64]) {
        let kernel = &self.hyperparameters.kernel;
        let Projection { points, input_panels, .. } = &mut self.projection;
        input_panels.set(inputs, kernel);
        let m = points.len();
        self.panel.resize(m, [0.0; WIDTH]);
        let distance = kernel.reach(NEGLIGIBLE);
        let near_distance = kernel.reach(NEGLIGIBLE_IN_VARIANCE);
        for (index, (mean, variance)) in mean.chunks_mut(WIDTH).zip(variance.chunks_mut(WIDTH)).enumerate() {
            let (least, most) = input_panels.azimuths(index);
            let within = |distance: f64| {
                points.partition_point(|point| point.x < least - distance)
                    ..points.partition_point(|point| point.x <= most + distance)
            };
            let reach = within(distance);
            let near = within(near_distance);
            let covariances = &mut self.panel[reach.clone()];
            input_panels.covariances(kernel, &points[reach.clone()], index, covariances);
            let mut means = [0.0; WIDTH];
            for (row, weight) in covariances.iter().zip(&self.weights[reach.clone()]) {
                for lane in 0..WIDTH {
                    means[lane] += row[lane] * weight;
                }
            }
            let from = near.start - reach.start;
            let reductions = self.reduction.of(&covariances[from..from + near.len()], near, m);
            mean.copy_from_slice(&means[..mean.len()]);
            for (variance, reduction) in variance.iter_mut().zip(reductions) {
                *variance = kernel.variance - reduction;
            }
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

//! The collapsed variational bound on the log marginal likelihood (Titsias 2009), as gpflow's `SGPR.elbo`
//! computes it, with its gradient.
//!
//! With the symbols of [`crate::gp::sparse`] and B = I + A Aᵀ:
//!
//! F = -n/2 log 2π - ½ log|B| - n/2 log σₙ² - (yᵀy + n σ²) / (2 σₙ²) + ½ cᵀc + ½ tr(A Aᵀ).
//!
//! Let u = L_B⁻ᵀ c, w = L⁻ᵀ u and r = y - σₙ Aᵀ u, the residual of the posterior mean. Then
//!
//! ∂F/∂K_uf = L⁻ᵀ (I - B⁻¹) A / σₙ + w rᵀ / σₙ²,
//! ∂F/∂K_uu = ½ L⁻ᵀ (2 I - B⁻¹ - B - u uᵀ) L⁻¹,
//! ∂F/∂log σₙ² = ½ (m - tr B⁻¹ - tr(A Aᵀ) - n + (rᵀr + n σ²) / σₙ²),
//!
//! and the kernel's derivatives carry the first two on to its hyperparameters and to Z. Three passes of O(n
//! m²), in panels that stay in the cache: L⁻¹ K_uf, A Aᵀ and ∂F/∂K_uf.

use core::f64::consts::TAU;

use glam::DVec2;

use crate::gp::hyperparameters::{Hyperparameters, LogGradient, RegressionError, check_data, check_points};
use crate::gp::jitter::GpError;
use crate::gp::kernel::RationalQuadratic;
use crate::gp::kernel_panels::KernelSums;
use crate::gp::projection::Projection;
use crate::math::cholesky::{NotPositiveDefinite, cholesky};
use crate::math::linalg;
use crate::math::panels::{self, WIDTH, total};

/// The bound with its gradient and workspace; a second evaluation of the same size allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct CollapsedBound {
    projection: Projection,
    gradient: LogGradient,
    inducing_gradient: Vec<DVec2>,
    /// L_B, m × m, as are the next two.
    l_b: Vec<f64>,
    /// I - B⁻¹, later L⁻ᵀ (I - B⁻¹) / σₙ.
    reduction: Vec<f64>,
    /// A factor reversed and transposed.
    reversed: Vec<f64>,
    /// c, u and w.
    c: Vec<f64>,
    u: Vec<f64>,
    w: Vec<f64>,
    sums: KernelSums,
}

impl CollapsedBound {
    /// A bound with an empty workspace.
    pub fn new() -> Self {
        Self::default()
    }

    /// The gradient of the last evaluation with respect to the log hyperparameters.
    pub fn gradient(&self) -> &LogGradient {
        &self.gradient
    }

    /// The gradient of the last evaluation with respect to each inducing input, 1 / rad.
    pub fn inducing_gradient(&self) -> &[DVec2] {
        &self.inducing_gradient
    }

    /// Jitter on the inducing covariance that the last evaluation needed; 1e-6 unless it was ill-conditioned.
    pub fn jitter(&self) -> f64 {
        self.projection.jitter
    }

    /// The bound F on log p(y), in nats, for `targets` (n) at `inputs` (n) through the inducing inputs
    /// `inducing` (m); leaves its gradient in [`Self::gradient`] and [`Self::inducing_gradient`].
    ///
    /// Inputs are (azimuth, elevation) in radians.
    ///
    /// # Errors
    /// [`RegressionError`] when the data do not pair up, something is not a number, a hyperparameter is not
    /// positive, there is nothing to fit, or a covariance cannot be factored. The gradients are then those of
    /// no evaluation.
    pub fn evaluate(
        &mut self,
        inputs: &[DVec2],
        targets: &[f64],
        inducing: &[DVec2],
        hyperparameters: &Hyperparameters,
    ) -> Result<f64, RegressionError> {
        check_data(inputs, targets)?;
        check_points("inducing", inducing)?;
        hyperparameters.check()?;
        if inducing.is_empty() {
            return Err(GpError::NoInducingInputs.into());
        }
        let Hyperparameters { kernel, noise_variance } = *hyperparameters;
        let (n, m) = (inputs.len() as f64, inducing.len());
        // Without truncation: the gradient is that of a smooth function.
        self.projection.project(inputs, targets, inducing, hyperparameters, f64::INFINITY)?;
        for square in [&mut self.l_b, &mut self.reduction, &mut self.reversed] {
            square.resize(m * m, 0.0);
        }
        for vector in [&mut self.c, &mut self.u, &mut self.w] {
            vector.resize(m, 0.0);
        }
        copy(&self.projection.aat, &mut self.l_b);
        copy(&self.projection.c, &mut self.c);
        let overflow = || RegressionError::IllConditioned { inputs: inputs.len(), noise_variance };

        // B, whose trace and factor are needed apart.
        let trace_aat: f64 = (0..m).map(|i| self.l_b[i * m + i]).sum();
        for i in 0..m {
            self.l_b[i * m + i] += 1.0;
        }
        copy(&self.l_b, &mut self.reduction);
        panels::mirror_lower(&mut self.reduction, m);
        cholesky(&mut self.l_b, m, &mut self.projection.panel).map_err(|NotPositiveDefinite| overflow())?;
        linalg::solve_lower_vector(&self.l_b, m, &mut self.c);

        let half_log_det_b: f64 = (0..m).map(|i| libm::log(self.l_b[i * m + i])).sum();
        let squares: f64 = targets.iter().map(|y| y * y).sum();
        let quadratic: f64 = self.c.iter().map(|c| c * c).sum();
        let value = -0.5 * n * libm::log(TAU * noise_variance) - half_log_det_b
            + 0.5 * (quadratic + trace_aat - (squares + n * kernel.variance) / noise_variance);

        let trace_reduction = self.adjoin_inducing_covariance(noise_variance);
        let residual_squares = self.carry_to_kernel(&kernel, noise_variance);
        let prior = n * kernel.variance / noise_variance;
        let lengths = self.sums.length_scales;
        self.gradient = LogGradient {
            variance: total(&self.sums.variance) - 0.5 * prior,
            length_scales: [total(&lengths[0]), total(&lengths[1])],
            alpha: kernel.alpha * total(&self.sums.alpha),
            noise_variance: 0.5
                * (trace_reduction - trace_aat - n + residual_squares / noise_variance + prior),
        };
        let [azimuth, elevation] = kernel.length_scales_rad;
        self.inducing_gradient.clear();
        self.inducing_gradient.extend(
            self.sums.points.iter().map(|[x, y]| DVec2::new(total(x) / azimuth, total(y) / elevation)),
        );
        let g = &self.gradient;
        let sum = value + g.variance + g.length_scales[0] + g.length_scales[1] + g.alpha + g.noise_variance;
        let finite = sum.is_finite() && self.inducing_gradient.iter().all(|g| g.is_finite());
        if finite { Ok(value) } else { Err(overflow()) }
    }

    /// ∂F/∂K_uu into `k_uu`, L⁻ᵀ (I - B⁻¹) / σₙ into `reduction`, u and w; gives tr(I - B⁻¹).
    fn adjoin_inducing_covariance(&mut self, noise_variance: f64) -> f64 {
        let m = self.projection.points.len();
        copy(&self.c, &mut self.u);
        linalg::solve_lower_transposed_vector(&self.l_b, m, &mut self.u);
        copy(&self.u, &mut self.w);
        linalg::solve_lower_transposed_vector(&self.projection.l, m, &mut self.w);

        // `reduction` holds B; `k_uu` becomes 2 I - B⁻¹ - B - u uᵀ.
        let (reduction, adjoint) = (&mut self.reduction, &mut self.projection.k_uu);
        for (i, row) in adjoint.chunks_exact_mut(m).enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value = -reduction[i * m + j] - self.u[i] * self.u[j];
            }
            row[i] += 1.0;
        }
        panels::invert(&self.l_b, m, reduction, &mut self.reversed, &mut self.projection.panel);
        for value in reduction.iter_mut() {
            *value = -*value;
        }
        let mut trace = 0.0;
        for i in 0..m {
            reduction[i * m + i] += 1.0;
            trace += reduction[i * m + i];
        }
        for (value, part) in adjoint.iter_mut().zip(reduction.iter()) {
            *value += part;
        }

        panels::reverse_transpose(&self.projection.l, m, &mut self.reversed);
        panels::solve_transposed(&self.reversed, m, reduction, &mut self.projection.panel);
        let inverse_deviation = 1.0 / noise_variance.sqrt();
        for value in reduction.iter_mut() {
            *value *= inverse_deviation;
        }
        panels::solve_transposed(&self.reversed, m, adjoint, &mut self.projection.panel);
        panels::transpose(adjoint, m);
        panels::solve_transposed(&self.reversed, m, adjoint, &mut self.projection.panel);
        for value in adjoint.iter_mut() {
            *value *= 0.5;
        }
        trace
    }

    /// Both adjoints through the kernel, into `sums`; gives rᵀr.
    fn carry_to_kernel(&mut self, kernel: &RationalQuadratic, noise_variance: f64) -> f64 {
        let Projection { points, point_panels, input_panels, target_panels, k_uu, a, panel, .. } =
            &mut self.projection;
        let m = points.len();
        self.sums.clear(m);
        for index in 0..point_panels.len() {
            let columns = index * WIDTH..m.min((index + 1) * WIDTH);
            for (row, values) in k_uu.chunks_exact(m).zip(panel.iter_mut()) {
                *values = [0.0; WIDTH];
                values[..columns.len()].copy_from_slice(&row[columns.clone()]);
            }
            point_panels.add_derivatives(kernel, points, index, panel, &mut self.sums);
        }
        // Every inducing input is a row of K_uu and a column of it.
        for value in self.sums.points.iter_mut().flatten().flatten() {
            *value *= 2.0;
        }

        let deviation = noise_variance.sqrt();
        let mut squares = [0.0; WIDTH];
        for (index, (rows, targets)) in a.chunks_exact(m).zip(target_panels.iter()).enumerate() {
            let mut mean = [0.0; WIDTH];
            for (row, u) in rows.iter().zip(&self.u) {
                for lane in 0..WIDTH {
                    mean[lane] += row[lane] * u;
                }
            }
            let mut residual = [0.0; WIDTH];
            for lane in 0..WIDTH {
                residual[lane] = targets[lane] - deviation * mean[lane];
                squares[lane] += residual[lane] * residual[lane];
                residual[lane] /= noise_variance;
            }
            panels::multiply(&self.reduction, rows, panel);
            for (row, w) in panel.iter_mut().zip(&self.w) {
                for lane in 0..WIDTH {
                    row[lane] += w * residual[lane];
                }
            }
            input_panels.add_derivatives(kernel, points, index, panel, &mut self.sums);
        }
        total(&squares)
    }
}

/// Copies between slices of one length.
fn copy(from: &[f64], to: &mut [f64]) {
    to.copy_from_slice(from);
}

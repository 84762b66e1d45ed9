//! The common part of bound and posterior: the projection of the training data on the inducing inputs.
//!
//! L Lᵀ = K_uu + jitter I, A = L⁻¹ K_uf / σₙ, A Aᵀ and A y / σₙ, in panels that stay in the cache.

use glam::DVec2;

use crate::gp::hyperparameters::Hyperparameters;
use crate::gp::jitter::{GpError, with_rising_jitter};
use crate::gp::kernel::RationalQuadratic;
use crate::gp::kernel_panels::{ScaledPanels, scale};
use crate::math::cholesky::cholesky;
use crate::math::linalg;
use crate::math::panels::{self, BLOCK_COLUMNS, Row, WIDTH};

/// The projection with its workspace; a second one of the same size allocates nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Projection {
    pub(crate) jitter: f64,
    /// Inducing inputs over length-scales, and the same as panels.
    pub(crate) points: Vec<DVec2>,
    pub(crate) point_panels: ScaledPanels,
    pub(crate) input_panels: ScaledPanels,
    /// Targets, zero beyond the last.
    pub(crate) target_panels: Vec<Row>,
    /// K_uu without jitter, m × m, as are the next two.
    pub(crate) k_uu: Vec<f64>,
    pub(crate) l: Vec<f64>,
    /// A Aᵀ; the upper triangle is valid only after mirroring.
    pub(crate) aat: Vec<f64>,
    /// A in panels, m rows each.
    pub(crate) a: Vec<Row>,
    /// A y / σₙ.
    pub(crate) c: Vec<f64>,
    /// m rows of scratch.
    pub(crate) panel: Vec<Row>,
    /// Columns of A row by row, for A Aᵀ.
    block: Vec<f64>,
}

impl Projection {
    /// Projects `targets` at `inputs` on the inducing inputs. If inputs and inducing inputs are in ascending
    /// order of azimuth, covariances over more than `reach` length-scales of azimuth are taken for zero.
    pub(crate) fn project(
        &mut self,
        inputs: &[DVec2],
        targets: &[f64],
        inducing: &[DVec2],
        hyperparameters: &Hyperparameters,
        reach: f64,
    ) -> Result<(), GpError> {
        let Hyperparameters { kernel, noise_variance } = hyperparameters;
        self.set_data(inputs, targets, inducing, kernel);
        self.factor_inducing_covariance(kernel)?;
        self.fill_a(kernel, *noise_variance, reach);
        Ok(())
    }

    fn set_data(
        &mut self,
        inputs: &[DVec2],
        targets: &[f64],
        inducing: &[DVec2],
        kernel: &RationalQuadratic,
    ) {
        let m = inducing.len();
        self.points.clear();
        self.points.extend(inducing.iter().map(|&point| scale(point, kernel)));
        self.point_panels.set(inducing, kernel);
        self.input_panels.set(inputs, kernel);
        self.target_panels.clear();
        self.target_panels.extend(targets.chunks(WIDTH).map(|chunk| {
            let mut row = [0.0; WIDTH];
            row[..chunk.len()].copy_from_slice(chunk);
            row
        }));
        for square in [&mut self.k_uu, &mut self.l, &mut self.aat] {
            square.resize(m * m, 0.0);
        }
        self.c.resize(m, 0.0);
        self.a.resize(m * self.input_panels.len(), [0.0; WIDTH]);
        self.panel.resize(m, [0.0; WIDTH]);
        self.block.resize(m * BLOCK_COLUMNS, 0.0);
    }

    /// L of K_uu, with rising jitter until it exists.
    fn factor_inducing_covariance(&mut self, kernel: &RationalQuadratic) -> Result<(), GpError> {
        let m = self.points.len();
        for panel in 0..self.point_panels.len() {
            self.point_panels.covariances(kernel, &self.points, panel, &mut self.panel);
            let columns = panel * WIDTH..m.min((panel + 1) * WIDTH);
            for (row, values) in self.k_uu.chunks_exact_mut(m).zip(&self.panel) {
                row[columns.clone()].copy_from_slice(&values[..columns.len()]);
            }
        }
        let Self { l, k_uu, panel, .. } = self;
        self.jitter = with_rising_jitter(m, |jitter| {
            l.copy_from_slice(k_uu);
            for i in 0..m {
                l[i * m + i] += jitter;
            }
            cholesky(l, m, panel)
        })?;
        Ok(())
    }

    /// A into `a`, A Aᵀ into `aat` and A y / σₙ into `c`.
    fn fill_a(&mut self, kernel: &RationalQuadratic, noise_variance: f64, reach: f64) {
        let m = self.points.len();
        let inverse_deviation = 1.0 / noise_variance.sqrt();
        self.aat.fill(0.0);
        self.c.fill(0.0);
        let block_panels = BLOCK_COLUMNS / WIDTH;
        // Rows before this are zero in the whole block.
        let mut block_first = m;
        for (index, rows) in self.a.chunks_exact_mut(m).enumerate() {
            let before = self.input_panels.azimuths(index).0 - reach;
            let first = self.points.iter().take_while(|point| point.x < before).count() / WIDTH * WIDTH;
            rows[..first].fill([0.0; WIDTH]);
            self.input_panels.covariances(kernel, &self.points[first..], index, &mut rows[first..]);
            panels::solve_lower(&self.l, first, rows);
            block_first = block_first.min(first);
            let in_block = index % block_panels;
            for (row, line) in rows.iter_mut().zip(self.block.chunks_exact_mut(BLOCK_COLUMNS)) {
                for value in row.iter_mut() {
                    *value *= inverse_deviation;
                }
                line[in_block * WIDTH..(in_block + 1) * WIDTH].copy_from_slice(row);
            }
            let last = index + 1 == self.input_panels.len();
            if in_block + 1 < block_panels && !last {
                continue;
            }
            for line in self.block.chunks_exact_mut(BLOCK_COLUMNS) {
                line[(in_block + 1) * WIDTH..].fill(0.0);
            }
            panels::add_outer_product(&self.block, m, block_first, &mut self.aat);
            block_first = m;
            let targets = self.target_panels[index - in_block..=index].as_flattened();
            for (line, c) in self.block.chunks_exact(BLOCK_COLUMNS).zip(&mut self.c) {
                let mut partial = [0.0];
                linalg::multiply_vector(&line[..targets.len()], targets.len(), targets, &mut partial);
                *c += inverse_deviation * partial[0];
            }
        }
    }
}

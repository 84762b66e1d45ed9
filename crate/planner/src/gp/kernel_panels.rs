//! The rational quadratic kernel and its derivatives, a panel of eight inputs at a time.
//!
//! With s = 1 + r² / (2γ) and k = σ² s^(-γ): ∂k/∂log σ² = k, ∂k/∂log ℓ_d = (k / s) Δ_d² / ℓ_d²,
//! ∂k/∂log γ = γ k ((s - 1) / s - ln s) and ∂k/∂z_d = -(k / s) Δ_d / ℓ_d², where Δ = z - x.

use glam::DVec2;
use multiversion::multiversion;

use crate::gp::kernel::RationalQuadratic;
use crate::math::elementary::{exp_of_negative, ln};
use crate::math::panels::{Row, WIDTH};

/// Inputs divided by the length-scales, eight at a time, azimuths and elevations apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct ScaledPanels {
    panels: Vec<[Row; 2]>,
    count: usize,
}

impl ScaledPanels {
    pub(crate) fn set(&mut self, inputs: &[DVec2], kernel: &RationalQuadratic) {
        self.count = inputs.len();
        self.panels.clear();
        self.panels.extend(inputs.chunks(WIDTH).map(|chunk| {
            let mut panel = [[0.0; WIDTH]; 2];
            for (lane, input) in chunk.iter().enumerate() {
                let scaled = scale(*input, kernel);
                (panel[0][lane], panel[1][lane]) = (scaled.x, scaled.y);
            }
            panel
        }));
    }

    /// Number of panels; the last may be partly empty.
    pub(crate) fn len(&self) -> usize {
        self.panels.len()
    }

    /// Inputs in one panel.
    fn columns(&self, panel: usize) -> usize {
        WIDTH.min(self.count - panel * WIDTH)
    }

    /// The least and the greatest scaled azimuth of a panel.
    pub(crate) fn azimuths(&self, panel: usize) -> (f64, f64) {
        let azimuths = &self.panels[panel][0][..self.columns(panel)];
        azimuths
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &x| (x.min(least), x.max(most)))
    }

    /// Writes the covariances of `points` (already scaled) with one panel of inputs; zero beyond the last
    /// input.
    pub(crate) fn covariances(
        &self,
        kernel: &RationalQuadratic,
        points: &[DVec2],
        panel: usize,
        out: &mut [Row],
    ) {
        let mut amplitude = [0.0; WIDTH];
        amplitude[..self.columns(panel)].fill(kernel.variance);
        match kernel.whole_alpha() {
            Some(exponent) => whole_covariances(exponent, amplitude, points, &self.panels[panel], out),
            None => covariances(kernel.alpha, amplitude, points, &self.panels[panel], out),
        }
    }

    /// Adds the part of the gradient that flows through one panel of covariances, whose derivatives are
    /// `weights`.
    pub(crate) fn add_derivatives(
        &self,
        kernel: &RationalQuadratic,
        points: &[DVec2],
        panel: usize,
        weights: &[Row],
        sums: &mut KernelSums,
    ) {
        add_derivatives(kernel, points, &self.panels[panel], weights, sums);
    }
}

/// A point divided by the kernel's length-scales.
pub(crate) fn scale(point: DVec2, kernel: &RationalQuadratic) -> DVec2 {
    let [azimuth, elevation] = kernel.length_scales_rad;
    DVec2::new(point.x / azimuth, point.y / elevation)
}

/// A gradient through the kernel, in eight lanes; `points` has -Σ (k/s) Δ/ℓ for each point.
#[derive(Clone, Debug, Default)]
pub(crate) struct KernelSums {
    pub(crate) variance: Row,
    pub(crate) length_scales: [Row; 2],
    pub(crate) alpha: Row,
    pub(crate) points: Vec<[Row; 2]>,
}

impl KernelSums {
    pub(crate) fn clear(&mut self, points: usize) {
        self.variance = [0.0; WIDTH];
        self.length_scales = [[0.0; WIDTH]; 2];
        self.alpha = [0.0; WIDTH];
        self.points.clear();
        self.points.resize(points, [[0.0; WIDTH]; 2]);
    }
}

/// Scaled differences Δ/ℓ and s.
#[inline(always)]
fn base(alpha: f64, point: DVec2, inputs: &[Row; 2]) -> (Row, Row, Row) {
    let (mut dx, mut dy, mut s) = ([0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
    let factor = 0.5 / alpha;
    for lane in 0..WIDTH {
        dx[lane] = point.x - inputs[0][lane];
        dy[lane] = point.y - inputs[1][lane];
        s[lane] = 1.0 + (dx[lane] * dx[lane] + dy[lane] * dy[lane]) * factor;
    }
    (dx, dy, s)
}

#[inline(always)]
fn values(alpha: f64, amplitude: &Row, ln_s: &Row) -> Row {
    let mut powers = [0.0; WIDTH];
    for lane in 0..WIDTH {
        powers[lane] = -alpha * ln_s[lane];
    }
    let mut values = exp_of_negative(powers);
    for lane in 0..WIDTH {
        values[lane] *= amplitude[lane];
    }
    values
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn covariances(alpha: f64, amplitude: Row, points: &[DVec2], inputs: &[Row; 2], out: &mut [Row]) {
    for (point, out) in points.iter().zip(out) {
        let (_, _, s) = base(alpha, *point, inputs);
        *out = values(alpha, &amplitude, &ln(s));
    }
}

/// Covariances for a whole γ: one division and repeated squaring.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn whole_covariances(exponent: u32, amplitude: Row, points: &[DVec2], inputs: &[Row; 2], out: &mut [Row]) {
    for (point, out) in points.iter().zip(out) {
        let (_, _, s) = base(f64::from(exponent), *point, inputs);
        let mut factor = [0.0; WIDTH];
        for lane in 0..WIDTH {
            factor[lane] = 1.0 / s[lane];
        }
        let mut power = amplitude;
        let mut bits = exponent;
        while bits > 0 {
            if bits & 1 == 1 {
                for lane in 0..WIDTH {
                    power[lane] *= factor[lane];
                }
            }
            for value in &mut factor {
                *value *= *value;
            }
            bits >>= 1;
        }
        *out = power;
    }
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn add_derivatives(
    kernel: &RationalQuadratic,
    points: &[DVec2],
    inputs: &[Row; 2],
    weights: &[Row],
    sums: &mut KernelSums,
) {
    let amplitude = [kernel.variance; WIDTH];
    let (mut variance, mut alpha) = (sums.variance, sums.alpha);
    let [mut azimuth, mut elevation] = sums.length_scales;
    for ((point, weights), point_sums) in points.iter().zip(weights).zip(&mut sums.points) {
        let (dx, dy, s) = base(kernel.alpha, *point, inputs);
        let ln_s = ln(s);
        let k = values(kernel.alpha, &amplitude, &ln_s);
        let [x_sum, y_sum] = point_sums;
        for lane in 0..WIDTH {
            let weighted = weights[lane] * k[lane];
            let inverse = 1.0 / s[lane];
            let share = weighted * inverse;
            let (along_x, along_y) = (share * dx[lane], share * dy[lane]);
            variance[lane] += weighted;
            alpha[lane] += weighted * ((s[lane] - 1.0) * inverse - ln_s[lane]);
            azimuth[lane] += along_x * dx[lane];
            elevation[lane] += along_y * dy[lane];
            x_sum[lane] -= along_x;
            y_sum[lane] -= along_y;
        }
    }
    (sums.variance, sums.alpha, sums.length_scales) = (variance, alpha, [azimuth, elevation]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn panels_have_the_kernels_covariances(
            places in prop::collection::vec((-2.0..2.0_f64, -0.5..0.5_f64), 1..20), alpha in 0.3..20.0_f64, whole in any::<bool>(),
        ) {
            let alpha = if whole { alpha.ceil() } else { alpha };
            let kernel = RationalQuadratic { variance: 0.7, length_scales_rad: [0.1, 0.05], alpha };
            let inputs: Vec<DVec2> = places.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
            let mut panels = ScaledPanels::default();
            panels.set(&inputs, &kernel);
            let mut out = [[0.0; WIDTH]];
            for panel in 0..panels.len() {
                panels.covariances(&kernel, &[scale(inputs[0], &kernel)], panel, &mut out);
                for (lane, value) in out[0].iter().enumerate() {
                    let exact = inputs.get(panel * WIDTH + lane).map_or(0.0, |b| kernel.covariance(inputs[0], *b));
                    prop_assert!((exact - value).abs() <= 1e-12 * exact, "{} {}", exact, value);
                }
            }
        }
    }
}

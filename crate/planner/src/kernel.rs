//! The rational quadratic kernel (paper, eq. 5):
//! k(z, z') = σ² (1 + r² / (2γ))^(-γ) with r² = Σ ((z - z') / ℓ)² over azimuth and elevation.

use glam::DVec2;
use multiversion::multiversion;

use crate::error::{ConfigError, require};

/// Hyperparameters of the rational quadratic kernel.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RationalQuadratic {
    /// Signal variance σ², in square metres of occupancy.
    pub variance: f64,
    /// Length-scales ℓ over azimuth and elevation; equal ones give the paper's isotropic kernel.
    pub length_scales_rad: [f64; 2],
    /// Weighting of length-scales γ (alpha elsewhere); whole numbers need no power function.
    pub alpha: f64,
}

impl Default for RationalQuadratic {
    /// An elevation length-scale near the sensor's ring spacing; DESIGN.md says how the values were chosen.
    fn default() -> Self {
        Self { variance: 1.0, length_scales_rad: [0.15, 0.04], alpha: 10.0 }
    }
}

/// Points evaluated together.
const LANES: usize = 8;

impl RationalQuadratic {
    /// Checks every hyperparameter; `place` names the table in error messages.
    pub(crate) fn validate(&self, place: &str) -> Result<(), ConfigError> {
        let positive = |v: f64| v.is_finite() && v > 0.0;
        require(positive(self.variance), place, "variance", self.variance, "a positive number")?;
        for length_scale in self.length_scales_rad {
            require(positive(length_scale), place, "length_scales_rad", length_scale, "two positive angles")?;
        }
        require(positive(self.alpha), place, "alpha", self.alpha, "a positive number")
    }

    /// The covariance of two points given as (azimuth, elevation) in radians.
    pub fn covariance(&self, a: DVec2, b: DVec2) -> f64 {
        let mut out = [0.0];
        let [azimuth, elevation] = self.length_scales_rad;
        let scaled = (a - b) / DVec2::new(azimuth, elevation);
        self.row(DVec2::ZERO, &[scaled.x], &[scaled.y], &mut out);
        out[0]
    }

    /// Covariances of one point with many; all coordinates are already divided by the length-scales.
    pub(crate) fn row(&self, point: DVec2, azimuths: &[f64], elevations: &[f64], out: &mut [f64]) {
        if self.alpha <= 64.0 && self.alpha.fract() == 0.0 {
            whole_power_row(self, self.alpha as u32, point, azimuths, elevations, out);
        } else {
            for ((&azimuth, &elevation), out) in azimuths.iter().zip(elevations).zip(out) {
                *out = self.variance * libm::pow(self.base(point, azimuth, elevation), -self.alpha);
            }
        }
    }

    /// 1 + r² / (2γ).
    #[inline(always)]
    fn base(&self, point: DVec2, azimuth: f64, elevation: f64) -> f64 {
        let (dx, dy) = (point.x - azimuth, point.y - elevation);
        1.0 + (dx * dx + dy * dy) * (0.5 / self.alpha)
    }
}

/// A kernel row for a whole γ: one division and repeated squaring, a chunk at a time so that it vectorises.
#[multiversion(targets("x86_64+avx2"))]
fn whole_power_row(
    kernel: &RationalQuadratic,
    exponent: u32,
    point: DVec2,
    azimuths: &[f64],
    elevations: &[f64],
    out: &mut [f64],
) {
    let chunks = azimuths.chunks(LANES).zip(elevations.chunks(LANES)).zip(out.chunks_mut(LANES));
    for ((azimuths, elevations), out) in chunks {
        // The last chunk may be short; its idle lanes hold the point itself.
        let (mut x, mut y) = ([point.x; LANES], [point.y; LANES]);
        x[..azimuths.len()].copy_from_slice(azimuths);
        y[..elevations.len()].copy_from_slice(elevations);
        let mut factor = [0.0; LANES];
        for lane in 0..LANES {
            factor[lane] = 1.0 / kernel.base(point, x[lane], y[lane]);
        }
        let mut power = [kernel.variance; LANES];
        let mut bits = exponent;
        while bits > 0 {
            if bits & 1 == 1 {
                for lane in 0..LANES {
                    power[lane] *= factor[lane];
                }
            }
            for value in &mut factor {
                *value *= *value;
            }
            bits >>= 1;
        }
        out.copy_from_slice(&power[..out.len()]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn whole_and_general_powers_agree(dx in -2.0..2.0_f64, dy in -0.5..0.5_f64, alpha in 1..20_u32) {
            let kernel = RationalQuadratic { variance: 0.7, length_scales_rad: [0.1, 0.05], alpha: alpha.into() };
            let nearby = RationalQuadratic { alpha: f64::from(alpha) * (1.0 + 1e-13), ..kernel };
            let (a, b) = (DVec2::new(dx, dy), DVec2::ZERO);
            let (exact, general) = (kernel.covariance(a, b), nearby.covariance(a, b));
            prop_assert!((exact - general).abs() <= 1e-10 * exact);
        }
    }
}

//! The rational quadratic kernel (paper, eq. 5):
//! k(z, z') = σ² (1 + r² / (2γ))^(-γ) with r² = Σ ((z - z') / ℓ)² over azimuth and elevation.

use glam::DVec2;

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
    /// An elevation length-scale near the sensor's ring spacing; chosen by measurement:
    /// docs/design/perception.md.
    fn default() -> Self {
        Self { variance: 1.0, length_scales_rad: [0.15, 0.04], alpha: 10.0 }
    }
}

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
        let [azimuth, elevation] = self.length_scales_rad;
        let scaled = (a - b) / DVec2::new(azimuth, elevation);
        let base = 1.0 + scaled.length_squared() * (0.5 / self.alpha);
        self.variance * libm::pow(base, -self.alpha)
    }

    /// The distance in length-scales beyond which a covariance is less than this share of the variance.
    pub(crate) fn reach(&self, share: f64) -> f64 {
        (2.0 * self.alpha * (libm::pow(share, -1.0 / self.alpha) - 1.0)).sqrt()
    }

    /// γ as a whole number, for which no logarithm is needed.
    pub(crate) fn whole_alpha(&self) -> Option<u32> {
        (self.alpha <= 64.0 && self.alpha.fract() == 0.0).then_some(self.alpha as u32)
    }
}

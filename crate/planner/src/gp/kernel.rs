//! The rational quadratic kernel (paper, eq. 5):
//! k(z, z') = σ² (1 + r² / (2γ))^(-γ) with r² = Σ ((z - z') / ℓ)² over azimuth and elevation.

use glam::DVec2;

use mapless_parameters::parameters;

parameters! {
    /// Hyperparameters of the rational quadratic kernel.
    #[derive(Copy)]
    pub struct RationalQuadratic {
        /// Signal variance σ² of the occupancy. The paper learns it.
        variance: f64 = 1.0, unit "m²", range [0.05, 10.0], check Positive;
        /// Length-scales ℓ over azimuth and elevation. The paper learns one for both, so its kernel is isotropic. By default
        /// the one over elevation is near the sensor's ring spacing.
        length_scales_rad: [f64; 2] = [0.15, 0.04], unit "rad", range [0.01, 0.5], check Positive;
        /// Weighting of length-scales γ in the rational quadratic, alpha elsewhere. Whole numbers are faster.
        alpha: f64 = 10.0, range [0.5, 50.0], check Positive;
    }
}

impl RationalQuadratic {
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

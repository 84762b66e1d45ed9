//! How steep a terrain is.

use crate::height_field::HeightField;
use glam::DVec2;

/// The slopes of a terrain, taken in the middle of every cell, and its relief.
#[derive(Clone, Debug, PartialEq)]
pub struct SlopeDistribution {
    /// Slopes as rise over run, in ascending order.
    rises: Vec<f64>,
    /// Highest sample less the lowest, metres.
    pub relief_m: f64,
}

impl SlopeDistribution {
    /// Measures a terrain.
    #[must_use]
    pub fn of(field: &HeightField) -> Self {
        let (columns, rows) = (field.columns() - 1, field.rows() - 1);
        let middle = |i: usize| DVec2::new((i % columns) as f64 + 0.5, (i / columns) as f64 + 0.5);
        let mut rises: Vec<f64> = (0..columns * rows)
            .filter_map(|i| Some(field.gradient(middle(i) * field.cell_m())?.length()))
            .collect();
        rises.sort_by(f64::total_cmp);
        let (low_m, high_m) = field.height_range_m();
        Self { rises, relief_m: f64::from(high_m) - f64::from(low_m) }
    }

    /// The slope in radians that a share of the ground, from 0 to 1, does not exceed.
    #[must_use]
    pub fn quantile_rad(&self, share: f64) -> f64 {
        let last = self.rises.len() - 1;
        libm::atan(self.rises[((share * last as f64) as usize).min(last)])
    }

    /// The share of the ground steeper than `slope_rad`.
    #[must_use]
    pub fn share_above(&self, slope_rad: f64) -> f64 {
        let rise = libm::tan(slope_rad);
        let above = self.rises.len() - self.rises.partition_point(|&slope| slope <= rise);
        above as f64 / self.rises.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bank_beside_level_ground_is_measured() {
        // 20 level columns, then 10 that rise by 0.5 m a metre.
        let heights_m = (0..31 * 11).map(|i| 0.5 * ((i % 31) as f32 - 20.0).max(0.0)).collect();
        let slopes = SlopeDistribution::of(&HeightField::new(31, 11, 1.0, heights_m).unwrap());
        assert_eq!(slopes.relief_m, 5.0);
        assert_eq!(slopes.quantile_rad(0.5), 0.0);
        assert!((slopes.quantile_rad(0.9) - libm::atan(0.5)).abs() < 1e-12);
        assert!((slopes.share_above(0.4) - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(slopes.share_above(0.5), 0.0);
    }
}

//! How steep a terrain is.

use crate::height_field::HeightField;
use glam::DVec2;

/// The slopes of a terrain, taken in the middle of every cell, and its relief.
#[derive(Clone, Debug, PartialEq)]
pub struct SlopeDistribution {
    /// Slopes as rise over run, in ascending order.
    rises: Vec<f64>,
    /// Height of the highest sample above the lowest, metres.
    pub relief_m: f64,
}

impl SlopeDistribution {
    /// Measures a terrain without what lies within `border_m` of its border, unless that is all of it.
    #[must_use]
    pub fn of(field: &HeightField, border_m: f64) -> Option<Self> {
        let (columns, rows) = (field.columns(), field.rows());
        let border = (border_m / field.cell_m()).ceil() as usize;
        let inside = |count: usize| border..(count - 1).saturating_sub(border);
        let mut rises = Vec::new();
        let (mut low_m, mut high_m) = (f32::INFINITY, f32::NEG_INFINITY);
        for row in inside(rows) {
            for column in inside(columns) {
                let middle_m = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) * field.cell_m();
                rises.extend(field.gradient(middle_m).map(DVec2::length));
                for sample in [row * columns + column, (row + 1) * columns + column + 1] {
                    let height_m = field.heights_m()[sample];
                    (low_m, high_m) = (low_m.min(height_m), high_m.max(height_m));
                }
            }
        }
        rises.sort_by(f64::total_cmp);
        let relief_m = f64::from(high_m) - f64::from(low_m);
        (!rises.is_empty()).then_some(Self { rises, relief_m })
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
        let slopes = SlopeDistribution::of(&HeightField::new(31, 11, 1.0, heights_m).unwrap(), 0.0).unwrap();
        assert_eq!(slopes.relief_m, 5.0);
        assert_eq!(slopes.quantile_rad(0.5), 0.0);
        assert!((slopes.quantile_rad(0.9) - libm::atan(0.5)).abs() < 1e-12);
        assert!((slopes.share_above(0.4) - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(slopes.share_above(0.5), 0.0);
    }

    #[test]
    fn the_border_is_left_out() {
        // A bank of one column along the western border.
        let heights_m = (0..31 * 31).map(|i| if i % 31 == 0 { 9.0 } else { 0.0 }).collect();
        let field = HeightField::new(31, 31, 1.0, heights_m).unwrap();
        let inner = SlopeDistribution::of(&field, 1.0).unwrap();
        assert_eq!((inner.relief_m, inner.quantile_rad(1.0)), (0.0, 0.0));
        assert_eq!(SlopeDistribution::of(&field, 0.0).unwrap().relief_m, 9.0);
        assert_eq!(SlopeDistribution::of(&field, 15.0), None);
    }
}

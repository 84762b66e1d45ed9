//! The map of the planners with a map: points on the ground, evenly spaced as seen from above.

use glam::DVec2;
use mapless_world::HeightField;

/// Spacing of the points.
pub(crate) const SPACING_M: f64 = 0.1;
/// The most points of a map: 400 × 400 m.
const MOST_POINTS: f64 = 16e6;

/// Why a terrain has no map.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MapError {
    /// The terrain is too large to keep as points.
    #[error("a terrain of {:.1} × {:.1} m: expected at most {MOST_POINTS} points on the map, {SPACING_M} m apart", extent_m.x, extent_m.y)]
    TooLarge {
        /// Size of the terrain, metres.
        extent_m: DVec2,
    },
}

/// Heights of the ground, [`Cloud::columns`] × [`Cloud::rows`] points 0.1 m apart, row by row from the
/// south-west corner.
#[derive(Clone, Debug)]
pub struct Cloud {
    columns: usize,
    rows: usize,
    heights_m: Vec<f64>,
}

impl Cloud {
    /// Samples the ground.
    ///
    /// # Errors
    /// [`MapError::TooLarge`] for more points than fit into memory.
    pub fn new(field: &HeightField) -> Result<Self, MapError> {
        let extent_m = field.extent_m();
        let count = (extent_m / SPACING_M + 1e-9).floor() + 1.0;
        if count.x * count.y > MOST_POINTS {
            return Err(MapError::TooLarge { extent_m });
        }
        let (columns, rows) = (count.x as usize, count.y as usize);
        let heights_m = (0..columns * rows)
            .filter_map(|index| {
                let place = DVec2::new((index % columns) as f64, (index / columns) as f64) * SPACING_M;
                field.height_m(place.min(extent_m))
            })
            .collect();
        Ok(Self { columns, rows, heights_m })
    }

    /// Points from west to east.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Points from south to north.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The north-east point, metres.
    #[must_use]
    pub fn extent_m(&self) -> DVec2 {
        DVec2::new((self.columns - 1) as f64, (self.rows - 1) as f64) * SPACING_M
    }

    /// Height of the point in a column and row; `None` beyond the border.
    #[must_use]
    pub fn height_m(&self, column: i64, row: i64) -> Option<f64> {
        let inside = |index: i64, count: usize| usize::try_from(index).ok().filter(|&index| index < count);
        Some(self.heights_m[inside(row, self.rows)? * self.columns + inside(column, self.columns)?])
    }

    /// All heights in metres, row by row from the south-west corner.
    #[must_use]
    pub fn heights_m(&self) -> &[f64] {
        &self.heights_m
    }

    /// Column and row of the point nearest to a place seen from above, which may lie beyond the border.
    #[must_use]
    pub fn nearest(&self, place_m: DVec2) -> (i64, i64) {
        let nearest = (place_m / SPACING_M).round();
        (nearest.x as i64, nearest.y as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::field;

    #[test]
    fn points_lie_on_the_ground() {
        let ground = |place: DVec2| 0.3 * place.x - 0.1 * place.y;
        let cloud = Cloud::new(&field(6.0, ground)).unwrap();
        assert_eq!((cloud.columns(), cloud.rows()), (61, 61));
        let at = DVec2::new(2.5, 4.1);
        let (column, row) = cloud.nearest(at);
        assert_eq!((column, row), (25, 41));
        assert!((cloud.height_m(column, row).unwrap() - ground(at)).abs() < 1e-6);
        assert_eq!(cloud.height_m(-1, 3), None);
        assert_eq!(cloud.height_m(3, 61), None);
    }

    #[test]
    fn a_terrain_too_large_is_refused() {
        let vast = HeightField::new(2, 2, 1000.0, vec![0.0; 4]).unwrap();
        let error = Cloud::new(&vast).unwrap_err().to_string();
        assert!(error.starts_with("a terrain of 1000.0 × 1000.0 m: expected at most"), "{error}");
    }
}

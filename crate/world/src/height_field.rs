//! A regular grid of heights with bilinear interpolation between the samples.

use glam::{DVec2, DVec3};
use thiserror::Error;

/// The most samples a height field may have: 4096 × 4096.
pub const MAX_SAMPLES: usize = 4096 * 4096;
/// The smallest spacing between samples, in metres.
pub const MIN_CELL_M: f64 = 0.01;
/// The largest spacing between samples, in metres.
pub const MAX_CELL_M: f64 = 1000.0;
/// The largest magnitude of a height, in metres; beyond it `f32` no longer resolves a centimetre.
pub const HEIGHT_LIMIT_M: f32 = 1e5;

/// Why a grid of heights is not a height field.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FieldError {
    /// Fewer than 2 × 2 samples enclose no ground.
    #[error("{columns} × {rows} samples: expected at least 2 × 2")]
    TooFewSamples {
        /// Samples from west to east.
        columns: usize,
        /// Samples from south to north.
        rows: usize,
    },
    /// More than [`MAX_SAMPLES`] samples.
    #[error("{columns} × {rows} samples: expected at most {MAX_SAMPLES} in all")]
    TooManySamples {
        /// Samples from west to east.
        columns: usize,
        /// Samples from south to north.
        rows: usize,
    },
    /// A rectangle that is empty or not within the field.
    #[error("rectangle of samples: expected one within {columns} × {rows}")]
    Rectangle {
        /// Samples of the field from west to east.
        columns: usize,
        /// Samples of the field from south to north.
        rows: usize,
    },
    /// The number of heights is not `columns * rows`.
    #[error("{found} heights: expected {expected}")]
    HeightCount {
        /// Heights given.
        found: usize,
        /// `columns * rows`.
        expected: usize,
    },
    /// The spacing is not a number between [`MIN_CELL_M`] and [`MAX_CELL_M`].
    #[error("spacing of {cell_m} m: expected {MIN_CELL_M} to {MAX_CELL_M} m")]
    Cell {
        /// The spacing given, in metres.
        cell_m: f64,
    },
    /// A height is not finite or larger than [`HEIGHT_LIMIT_M`].
    #[error(
        "height {height_m} m at column {column}, row {row} (from the south-west): expected a number of at most {HEIGHT_LIMIT_M} m"
    )]
    Height {
        /// Column of the first bad sample, 0 = west.
        column: usize,
        /// Row of the first bad sample, 0 = south.
        row: usize,
        /// The height given, in metres.
        height_m: f32,
    },
}

/// The ground: heights on a regular grid, row 0 = south, column 0 = west, the south-west sample at (0, 0).
///
/// Between four samples the surface is the bilinear patch through them, so the ground is continuous
/// everywhere and smooth inside each cell. The ground exists on the closed rectangle from (0, 0) to
/// [`HeightField::extent_m`].
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    columns: usize,
    rows: usize,
    cell_m: f64,
    heights_m: Vec<f32>,
}

/// One bilinear patch: `h(u, v) = h00 + along_u u + along_v v + twist u v`, with u, v in [0, 1] across the
/// cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    pub(crate) h00: f64,
    pub(crate) along_u: f64,
    pub(crate) along_v: f64,
    pub(crate) twist: f64,
}

impl Patch {
    /// Height at cell coordinates (u, v), in metres.
    pub(crate) fn height(&self, u: f64, v: f64) -> f64 {
        self.h00 + self.along_u * u + (self.along_v + self.twist * u) * v
    }
}

impl HeightField {
    /// Takes `columns * rows` heights in metres, row by row from the south, at a spacing of `cell_m` metres.
    ///
    /// # Errors
    /// [`FieldError`] when the grid is smaller than 2 × 2, too large, or holds a value that is no height.
    pub fn new(columns: usize, rows: usize, cell_m: f64, heights_m: Vec<f32>) -> Result<Self, FieldError> {
        let expected = check_grid(columns, rows, cell_m)?;
        if heights_m.len() != expected {
            return Err(FieldError::HeightCount { found: heights_m.len(), expected });
        }
        let is_height = |height: &f32| height.abs() <= HEIGHT_LIMIT_M;
        if let Some(index) = heights_m.iter().position(|height| !is_height(height)) {
            return Err(FieldError::Height {
                column: index % columns,
                row: index / columns,
                height_m: heights_m[index],
            });
        }
        Ok(Self { columns, rows, cell_m, heights_m })
    }

    /// Samples from west to east.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Samples from south to north.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Spacing of the samples, in metres.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// All heights in metres, row by row from the south, each row from the west.
    #[must_use]
    pub fn heights_m(&self) -> &[f32] {
        &self.heights_m
    }

    pub(crate) fn heights_mut(&mut self) -> &mut [f32] {
        &mut self.heights_m
    }

    /// The north-east corner, in metres; the south-west corner is the origin.
    #[must_use]
    pub fn extent_m(&self) -> DVec2 {
        DVec2::new((self.columns - 1) as f64, (self.rows - 1) as f64) * self.cell_m
    }

    /// Lowest and highest sample, in metres: the bounds of the whole surface.
    #[must_use]
    pub fn height_range_m(&self) -> (f32, f32) {
        self.heights_m
            .iter()
            .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), &h| (low.min(h), high.max(h)))
    }

    /// Whether there is ground at `position`, borders included.
    #[must_use]
    pub fn contains(&self, position: DVec2) -> bool {
        let extent = self.extent_m();
        position.x >= 0.0 && position.y >= 0.0 && position.x <= extent.x && position.y <= extent.y
    }

    /// Height of the ground in metres; `None` off the terrain.
    #[must_use]
    pub fn height_m(&self, position: DVec2) -> Option<f64> {
        let (patch, u, v) = self.locate(position)?;
        Some(patch.height(u, v))
    }

    /// Gradient (dz/dx, dz/dy) of the ground; `None` off the terrain. On an edge between cells it is that of
    /// the cell to the north-east.
    #[must_use]
    pub fn gradient(&self, position: DVec2) -> Option<DVec2> {
        let (patch, u, v) = self.locate(position)?;
        Some(DVec2::new(patch.along_u + patch.twist * v, patch.along_v + patch.twist * u) / self.cell_m)
    }

    /// Upward unit normal of the ground; `None` off the terrain.
    #[must_use]
    pub fn normal(&self, position: DVec2) -> Option<DVec3> {
        let gradient = self.gradient(position)?;
        Some(DVec3::new(-gradient.x, -gradient.y, 1.0).normalize())
    }

    /// Steepest slope of the ground, in radians from level; `None` off the terrain.
    #[must_use]
    pub fn slope_rad(&self, position: DVec2) -> Option<f64> {
        Some(libm::atan(self.gradient(position)?.length()))
    }

    /// The patch of cell (column, row); the cell must exist.
    #[inline]
    pub(crate) fn patch(&self, column: usize, row: usize) -> Patch {
        let south = row * self.columns + column;
        let north = south + self.columns;
        let [h00, h10] = [self.heights_m[south], self.heights_m[south + 1]].map(f64::from);
        let [h01, h11] = [self.heights_m[north], self.heights_m[north + 1]].map(f64::from);
        Patch { h00, along_u: h10 - h00, along_v: h01 - h00, twist: h11 - h10 - h01 + h00 }
    }

    fn locate(&self, position: DVec2) -> Option<(Patch, f64, f64)> {
        if !self.contains(position) {
            return None;
        }
        let grid = position / self.cell_m;
        let column = (grid.x as usize).min(self.columns - 2);
        let row = (grid.y as usize).min(self.rows - 2);
        Some((self.patch(column, row), grid.x - column as f64, grid.y - row as f64))
    }
}

/// Checks the shape of a grid before its heights are read, so that nothing absurd is allocated. Returns the
/// number of samples.
pub fn check_grid(columns: usize, rows: usize, cell_m: f64) -> Result<usize, FieldError> {
    if columns < 2 || rows < 2 {
        return Err(FieldError::TooFewSamples { columns, rows });
    }
    if !(MIN_CELL_M..=MAX_CELL_M).contains(&cell_m) {
        return Err(FieldError::Cell { cell_m });
    }
    match columns.checked_mul(rows) {
        Some(count) if count <= MAX_SAMPLES => Ok(count),
        _ => Err(FieldError::TooManySamples { columns, rows }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn saddle() -> HeightField {
        HeightField::new(3, 2, 0.5, vec![0.0, 1.0, 2.0, 1.0, 0.0, 4.0]).unwrap()
    }

    #[test]
    fn samples_are_met_exactly_and_the_middle_is_their_mean() {
        let field = saddle();
        assert_eq!(field.extent_m(), DVec2::new(1.0, 0.5));
        for row in 0..2 {
            for column in 0..3 {
                let at = DVec2::new(column as f64, row as f64) * 0.5;
                let sample = f64::from(field.heights_m()[row * 3 + column]);
                assert_eq!(field.height_m(at), Some(sample));
            }
        }
        assert_eq!(field.height_m(DVec2::new(0.25, 0.25)), Some(0.5));
        assert_eq!(field.height_m(DVec2::new(0.75, 0.25)), Some(1.75));
        assert_eq!(field.height_range_m(), (0.0, 4.0));
    }

    #[test]
    fn there_is_no_ground_beyond_the_border() {
        let field = saddle();
        for (x, y) in [(-1e-9, 0.1), (0.1, -1e-9), (1.0 + 1e-9, 0.1), (0.1, 0.5 + 1e-9), (f64::NAN, 0.1)] {
            assert_eq!(field.height_m(DVec2::new(x, y)), None, "({x}, {y})");
            assert_eq!(field.normal(DVec2::new(x, y)), None);
        }
    }

    #[test]
    fn bad_grids_are_refused() {
        let new = HeightField::new;
        assert_eq!(new(1, 1, 1.0, vec![0.0]), Err(FieldError::TooFewSamples { columns: 1, rows: 1 }));
        assert_eq!(new(2, 2, 1.0, vec![0.0; 3]), Err(FieldError::HeightCount { found: 3, expected: 4 }));
        assert!(matches!(new(2, 2, 0.0, vec![0.0; 4]), Err(FieldError::Cell { .. })));
        assert!(matches!(new(2, 2, f64::NAN, vec![0.0; 4]), Err(FieldError::Cell { .. })));
        assert!(matches!(new(usize::MAX, 2, 1.0, vec![]), Err(FieldError::TooManySamples { .. })));
        let hole = new(2, 2, 1.0, vec![0.0, 0.0, 0.0, f32::NAN]);
        assert!(matches!(hole, Err(FieldError::Height { column: 1, row: 1, .. })));
        assert!(new(2, 2, 1.0, vec![0.0, f32::INFINITY, 0.0, 0.0]).is_err());
    }

    proptest! {
        #[test]
        fn normal_and_slope_agree_with_finite_differences(
            heights in prop::collection::vec(-2.0f32..2.0, 16),
            x in 0.0..0.75f64, y in 0.0..0.75f64,
        ) {
            let field = HeightField::new(4, 4, 0.25, heights).unwrap();
            let at = DVec2::new(x, y);
            let step = 1e-6;
            // Stay inside one cell: the gradient jumps at the edges.
            let inside = |value: f64| { let f = value / 0.25 % 1.0; f > 1e-4 && f < 1.0 - 1e-4 };
            prop_assume!(inside(x) && inside(y));
            let height = |dx: f64, dy: f64| field.height_m(at + DVec2::new(dx, dy)).unwrap();
            let dzdx = (height(step, 0.0) - height(-step, 0.0)) / (2.0 * step);
            let dzdy = (height(0.0, step) - height(0.0, -step)) / (2.0 * step);
            let normal = field.normal(at).unwrap();
            prop_assert!((normal.length() - 1.0).abs() < 1e-12);
            prop_assert!((-normal.x / normal.z - dzdx).abs() < 1e-6);
            prop_assert!((-normal.y / normal.z - dzdy).abs() < 1e-6);
            prop_assert!((libm::cos(field.slope_rad(at).unwrap()) - normal.z).abs() < 1e-12);
        }

        #[test]
        fn surface_stays_between_its_samples(
            heights in prop::collection::vec(-50.0f32..50.0, 12), x in 0.0..3.0f64, y in 0.0..2.0f64,
        ) {
            let field = HeightField::new(4, 3, 1.0, heights).unwrap();
            let (low, high) = field.height_range_m();
            let height = field.height_m(DVec2::new(x, y)).unwrap();
            prop_assert!(height >= f64::from(low) - 1e-12 && height <= f64::from(high) + 1e-12);
        }
    }
}

//! A pyramid of the highest points of square groups of cells, and the steepest slope of the field.

use crate::height_field::HeightField;
use crate::sculpt::SampleRect;

/// The levels of the pyramid. A node of level `k` covers 2ᵏ × 2ᵏ cells; level 0 is the cells themselves, whose four
/// corners are read from the field, and the top level is a single node.
#[derive(Clone, Debug)]
pub(super) struct Pyramid {
    levels: Vec<Level>,
    /// A bound of the slope (rise over run) in each row of cells.
    row_slopes: Vec<f64>,
    steepest: f64,
}

#[derive(Clone, Debug)]
struct Level {
    columns: usize,
    rows: usize,
    max_m: Vec<f32>,
}

impl Pyramid {
    pub(super) fn new(field: &HeightField) -> Self {
        let mut levels = Vec::new();
        let (mut columns, mut rows) = (field.columns() - 1, field.rows() - 1);
        while levels.is_empty() || columns > 1 || rows > 1 {
            columns = columns.div_ceil(2);
            rows = rows.div_ceil(2);
            levels.push(Level { columns, rows, max_m: vec![0.0; columns * rows] });
        }
        let mut pyramid = Self { levels, row_slopes: vec![0.0; field.rows() - 1], steepest: 0.0 };
        let all =
            SampleRect { column_begin: 0, column_end: field.columns(), row_begin: 0, row_end: field.rows() };
        pyramid.update(field, all);
        pyramid
    }

    /// The topmost level.
    pub(super) fn top(&self) -> usize {
        self.levels.len()
    }

    /// The highest point of the whole field, in metres.
    pub(super) fn highest(&self) -> f64 {
        self.max(self.top(), [0, 0])
    }

    /// A bound of the slope (rise over run) of the whole field.
    pub(super) fn steepest(&self) -> f64 {
        self.steepest
    }

    /// The highest point of a node, in metres; level 1 and above.
    pub(super) fn max(&self, level: usize, node: [usize; 2]) -> f64 {
        let level = &self.levels[level - 1];
        f64::from(level.max_m[node[1] * level.columns + node[0]])
    }

    /// Brings the nodes above the changed samples up to date.
    pub(super) fn update(&mut self, field: &HeightField, changed: SampleRect) {
        // A sample belongs to the cells on both its sides.
        let mut columns = (changed.column_begin.saturating_sub(1), changed.column_end - 1);
        let mut rows = (changed.row_begin.saturating_sub(1), changed.row_end - 1);
        for row in rows.0..=rows.1.min(self.row_slopes.len() - 1) {
            self.row_slopes[row] = slope_bound(field, row);
        }
        self.steepest = self.row_slopes.iter().fold(0.0, |steepest, &slope| steepest.max(slope));
        for index in 0..self.levels.len() {
            let (below, above) = self.levels.split_at_mut(index);
            let level = &mut above[0];
            columns = (columns.0 / 2, (columns.1 / 2).min(level.columns - 1));
            rows = (rows.0 / 2, (rows.1 / 2).min(level.rows - 1));
            for row in rows.0..=rows.1 {
                for column in columns.0..=columns.1 {
                    let max_m = match below.last() {
                        // Two cells a side have three samples a side.
                        None => highest(field.heights_m(), field.columns(), field.rows(), [column, row], 3),
                        Some(finer) => highest(&finer.max_m, finer.columns, finer.rows, [column, row], 2),
                    };
                    level.max_m[row * level.columns + column] = max_m;
                }
            }
        }
    }
}

/// A bound of the slope in a row of cells: each component of a patch's gradient lies between those of its edges.
fn slope_bound(field: &HeightField, row: usize) -> f64 {
    let columns = field.columns();
    let (south, north) = field.heights_m()[row * columns..(row + 2) * columns].split_at(columns);
    let mut largest = 0.0f32;
    for column in 0..columns - 1 {
        let east_rise =
            (south[column + 1] - south[column]).abs().max((north[column + 1] - north[column]).abs());
        let north_rise =
            (north[column] - south[column]).abs().max((north[column + 1] - south[column + 1]).abs());
        largest = largest.max(east_rise * east_rise + north_rise * north_rise);
    }
    // The sums above are rounded to f32.
    f64::from(largest).sqrt() * (1.0 + 1e-6) / field.cell_m()
}

/// The highest of `side` × `side` values from twice the index of `node`, cut at the border.
fn highest(values: &[f32], columns: usize, rows: usize, node: [usize; 2], side: usize) -> f32 {
    let (column, row) = (2 * node[0], 2 * node[1]);
    let mut max = f32::NEG_INFINITY;
    for r in row..(row + side).min(rows) {
        for &value in &values[r * columns + column..r * columns + (column + side).min(columns)] {
            max = max.max(value);
        }
    }
    max
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Brush, BrushKind, Caster};
    use glam::DVec2;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn nodes_hold_the_highest_sample_of_their_cells(columns in 2..40usize, rows in 2..40usize, seed in any::<u32>()) {
            let heights: Vec<f32> = (0..columns * rows)
                .map(|i| ((i as u32).wrapping_mul(2_654_435_761) ^ seed) as f32 / 1e6).collect();
            let field = HeightField::new(columns, rows, 1.0, heights).unwrap();
            let pyramid = Pyramid::new(&field);
            for level in 1..=pyramid.top() {
                let side = 1 << level;
                for j in 0..(rows - 1).div_ceil(side) {
                    for i in 0..(columns - 1).div_ceil(side) {
                        let mut expected = f32::NEG_INFINITY;
                        for r in j * side..=((j + 1) * side).min(rows - 1) {
                            for c in i * side..=((i + 1) * side).min(columns - 1) {
                                expected = expected.max(field.heights_m()[r * columns + c]);
                            }
                        }
                        prop_assert_eq!(pyramid.max(level, [i, j]), f64::from(expected));
                    }
                }
            }
        }

        #[test]
        fn no_point_is_steeper_than_the_bound(
            heights in prop::collection::vec(-1.0f32..1.0, 25), x in 0.0..2.0f64, y in 0.0..2.0f64,
        ) {
            let field = HeightField::new(5, 5, 0.5, heights).unwrap();
            let gradient = field.gradient(DVec2::new(x, y)).unwrap();
            prop_assert!(gradient.length() <= Pyramid::new(&field).steepest());
        }

        #[test]
        fn sculpting_leaves_the_pyramid_as_if_built_anew(
            x in -2.0..40.0f64, y in -2.0..30.0f64, radius_m in 0.1..12.0f64, lower in any::<bool>(),
        ) {
            let field = HeightField::new(38, 27, 1.0, (0..38 * 27).map(|i| (i % 7) as f32).collect()).unwrap();
            let mut caster = Caster::new(field);
            let kind = if lower { BrushKind::Lower } else { BrushKind::Raise };
            caster.sculpt(&Brush { centre: DVec2::new(x, y), radius_m, strength_m: 9.0, kind }).unwrap();
            let anew = Pyramid::new(caster.field());
            prop_assert_eq!(caster.pyramid.steepest(), anew.steepest());
            for (updated, built) in caster.pyramid.levels.iter().zip(&anew.levels) {
                prop_assert_eq!(&updated.max_m, &built.max_m);
            }
        }
    }
}

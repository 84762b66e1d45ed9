//! A pyramid of planes above square groups of cells, and bounds of the whole field.

use crate::height_field::HeightField;
use crate::sculpt::SampleRect;

/// A plane that bounds a node from above.
///
/// On a slope a plane is as tight as the ground is smooth, where a maximum would block every ray that passes
/// less than the node's rise above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    /// Height at the south-west corner of the field, in metres.
    pub(super) origin_m: f64,
    /// Rise in metres per cell to the east and to the north.
    pub(super) rise: [f32; 2],
}

/// Level 0 is the cells themselves, whose four corners are read from the field. A node of level `k` covers
/// 4ᵏ × 4ᵏ cells, and the top level is a single node.
#[derive(Clone, Debug)]
pub(super) struct Pyramid {
    levels: Vec<Level>,
    rows: Vec<RowBounds>,
    highest: f64,
    steepest: f64,
}

#[derive(Clone, Debug)]
struct Level {
    columns: usize,
    rows: usize,
    planes: Vec<Plane>,
}

/// Bounds of a row of cells.
#[derive(Clone, Copy, Debug, Default)]
struct RowBounds {
    highest: f64,
    /// Rise over run.
    steepest: f64,
}

/// Nodes along a side of the node above.
const SIDE: usize = 4;

/// The logarithm to base 2 of the cells along a side of a node.
pub(super) fn shift(level: usize) -> u32 {
    SIDE.ilog2() * level as u32
}

impl Plane {
    /// The lowest plane with these rises over points given by column, row and height in metres.
    fn over(rise: [f32; 2], points: impl Iterator<Item = (usize, usize, f64)>) -> Self {
        let mut plane = Self { origin_m: 0.0, rise };
        let height_m = |(column, row, height_m)| height_m - plane.height_m(column, row);
        let origin_m = points.map(height_m).fold(f64::NEG_INFINITY, f64::max);
        // No ray shall get below the plane by rounding.
        plane.origin_m = origin_m + 1e-9 + 1e-12 * origin_m.abs();
        plane
    }

    fn height_m(&self, column: usize, row: usize) -> f64 {
        self.origin_m + f64::from(self.rise[0]) * column as f64 + f64::from(self.rise[1]) * row as f64
    }
}

impl Pyramid {
    pub(super) fn new(field: &HeightField) -> Self {
        let cells = [field.columns() - 1, field.rows() - 1];
        let mut levels: Vec<Level> = Vec::new();
        while levels.last().is_none_or(|top| top.planes.len() > 1) {
            let side = 1 << shift(levels.len() + 1);
            let [columns, rows] = cells.map(|count| count.div_ceil(side));
            levels.push(Level {
                columns,
                rows,
                planes: vec![Plane { origin_m: 0.0, rise: [0.0; 2] }; columns * rows],
            });
        }
        let mut pyramid =
            Self { levels, rows: vec![RowBounds::default(); cells[1]], highest: 0.0, steepest: 0.0 };
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
        self.highest
    }

    /// A bound of the slope (rise over run) of the whole field.
    pub(super) fn steepest(&self) -> f64 {
        self.steepest
    }

    /// The plane above a node; level 1 and above.
    pub(super) fn plane(&self, level: usize, node: [u32; 2]) -> &Plane {
        let level = &self.levels[level - 1];
        &level.planes[node[1] as usize * level.columns + node[0] as usize]
    }

    /// Brings the nodes above the changed samples up to date.
    pub(super) fn update(&mut self, field: &HeightField, changed: SampleRect) {
        // A sample belongs to the cells on both its sides.
        let mut columns = (changed.column_begin.saturating_sub(1), changed.column_end - 1);
        let mut rows = (changed.row_begin.saturating_sub(1), changed.row_end - 1);
        for row in rows.0..=rows.1.min(self.rows.len() - 1) {
            self.rows[row] = row_bounds(field, row);
        }
        self.highest = self.rows.iter().fold(f64::NEG_INFINITY, |highest, row| highest.max(row.highest));
        self.steepest = self.rows.iter().fold(0.0, |steepest, row| steepest.max(row.steepest));
        for level in 1..=self.levels.len() {
            let Level { columns: width, rows: height, .. } = self.levels[level - 1];
            columns = (columns.0 / SIDE, (columns.1 / SIDE).min(width - 1));
            rows = (rows.0 / SIDE, (rows.1 / SIDE).min(height - 1));
            for row in rows.0..=rows.1 {
                for column in columns.0..=columns.1 {
                    let plane = if level == 1 {
                        above_samples(field, [column, row])
                    } else {
                        self.above_nodes(field, level, [column, row])
                    };
                    self.levels[level - 1].planes[row * width + column] = plane;
                }
            }
        }
    }

    /// The plane above a node of level 2 or more: with the mean rise of the nodes below it, above their
    /// corners.
    fn above_nodes(&self, field: &HeightField, level: usize, node: [usize; 2]) -> Plane {
        let below = &self.levels[level - 2];
        let [first_column, first_row] = node.map(|index| index * SIDE);
        let rows = first_row..(first_row + SIDE).min(below.rows);
        let columns = first_column..(first_column + SIDE).min(below.columns);
        let nodes = || {
            let columns = columns.clone();
            rows.clone().flat_map(move |row| {
                columns.clone().map(move |column| ([column, row], below.planes[row * below.columns + column]))
            })
        };
        let share = 1.0 / (rows.len() * columns.len()) as f32;
        let rise = nodes().fold([0.0; 2], |sum, (_, plane)| {
            [sum[0] + plane.rise[0] * share, sum[1] + plane.rise[1] * share]
        });
        let cells = [field.columns() - 1, field.rows() - 1];
        Plane::over(
            rise,
            nodes().flat_map(|(node, plane)| {
                let low = node.map(|index| index << shift(level - 1));
                let high = [0, 1].map(|axis| ((node[axis] + 1) << shift(level - 1)).min(cells[axis]));
                [(low[0], low[1]), (high[0], low[1]), (low[0], high[1]), (high[0], high[1])]
                    .map(|(column, row)| (column, row, plane.height_m(column, row)))
            }),
        )
    }
}

/// The plane above a node of level 1, with the mean rise between its opposite sides.
fn above_samples(field: &HeightField, node: [usize; 2]) -> Plane {
    let [column, row] = node.map(|index| index * SIDE);
    let (width, height) = (SIDE.min(field.columns() - 1 - column), SIDE.min(field.rows() - 1 - row));
    let at = |east: usize, north: usize| field.heights_m()[(row + north) * field.columns() + column + east];
    let east_rise: f32 = (0..=height).map(|north| at(width, north) - at(0, north)).sum();
    let north_rise: f32 = (0..=width).map(|east| at(east, height) - at(east, 0)).sum();
    let rise = [east_rise / (width * (height + 1)) as f32, north_rise / (height * (width + 1)) as f32];
    let samples = (row..=row + height).flat_map(|row| {
        let heights = &field.heights_m()[row * field.columns()..];
        (column..=column + width).map(move |column| (column, row, f64::from(heights[column])))
    });
    Plane::over(rise, samples)
}

/// Each component of a patch's gradient lies between those of its edges.
fn row_bounds(field: &HeightField, row: usize) -> RowBounds {
    let columns = field.columns();
    let (south, north) = field.heights_m()[row * columns..(row + 2) * columns].split_at(columns);
    let mut largest = 0.0f32;
    let mut highest = south[0].max(north[0]);
    for column in 0..columns - 1 {
        let east_rise =
            (south[column + 1] - south[column]).abs().max((north[column + 1] - north[column]).abs());
        let north_rise =
            (north[column] - south[column]).abs().max((north[column + 1] - south[column + 1]).abs());
        largest = largest.max(east_rise * east_rise + north_rise * north_rise);
        highest = highest.max(south[column + 1]).max(north[column + 1]);
    }
    // The sums above are rounded to f32.
    let steepest = f64::from(largest).sqrt() * (1.0 + 1e-6) / field.cell_m();
    RowBounds { highest: f64::from(highest), steepest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Brush, BrushKind, Caster};
    use glam::DVec2;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_sample_of_a_node_is_above_its_plane(
            columns in 2..40usize, rows in 2..40usize, seed in any::<u32>(), offset_m in -1e4..1e4f32,
        ) {
            let heights: Vec<f32> = (0..columns * rows)
                .map(|i| offset_m + ((i as u32).wrapping_mul(2_654_435_761) ^ seed) as f32 / 1e6).collect();
            let field = HeightField::new(columns, rows, 1.0, heights).unwrap();
            let pyramid = Pyramid::new(&field);
            prop_assert_eq!(pyramid.highest(), f64::from(field.height_range_m().1));
            for level in 1..=pyramid.top() {
                let side = 1 << shift(level);
                for j in 0..(rows - 1).div_ceil(side) {
                    for i in 0..(columns - 1).div_ceil(side) {
                        let plane = pyramid.plane(level, [i as u32, j as u32]);
                        for r in j * side..=((j + 1) * side).min(rows - 1) {
                            for c in i * side..=((i + 1) * side).min(columns - 1) {
                                let sample = f64::from(field.heights_m()[r * columns + c]);
                                prop_assert!(sample <= plane.height_m(c, r));
                            }
                        }
                    }
                }
            }
        }

        #[test]
        fn on_a_slope_every_plane_lies_on_the_ground(east in -2.0..2.0f32, north in -2.0..2.0f32) {
            let heights = (0..30 * 20).map(|i| (i % 30) as f32 * east + (i / 30) as f32 * north).collect();
            let field = HeightField::new(30, 20, 1.0, heights).unwrap();
            let pyramid = Pyramid::new(&field);
            for level in 1..=pyramid.top() {
                let corner = pyramid.plane(level, [0, 0]);
                prop_assert!(corner.origin_m.abs() < 1e-3, "{corner:?}");
                prop_assert!((corner.rise[0] - east).abs() < 1e-3 && (corner.rise[1] - north).abs() < 1e-3);
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
                prop_assert_eq!(&updated.planes, &built.planes);
            }
        }
    }
}

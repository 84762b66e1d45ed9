//! Heights for holes, from around them: Laplace's equation, level across the border of the grid.
//!
//! Every hole becomes the mean of its neighbours, so that nothing in it is higher or lower than what
//! surrounds it. Grids of half the resolution, each solved before the next finer one, carry heights far into
//! wide holes.

/// Sweeps over the holes of each grid: what they leave over is smooth, and small from the coarser grid.
const SWEEPS: usize = 40;

struct Level {
    columns: usize,
    rows: usize,
    /// Not a number where no height is known.
    heights_m: Vec<f32>,
}

/// Fills what is not a number. Something must be one.
pub(crate) fn fill(columns: usize, heights_m: &mut [f32]) {
    let finest = Level { columns, rows: heights_m.len() / columns, heights_m: heights_m.to_vec() };
    let mut levels = vec![finest];
    while let Some(level) = levels.last()
        && level.heights_m.iter().any(|height| height.is_nan())
        && level.heights_m.len() > 1
    {
        let coarser = level.halved();
        levels.push(coarser);
    }
    let Some(mut coarser) = levels.pop() else { return };
    while let Some(mut level) = levels.pop() {
        level.solve(&coarser);
        coarser = level;
    }
    heights_m.copy_from_slice(&coarser.heights_m);
}

impl Level {
    /// Each height the mean of those that are known among four.
    fn halved(&self) -> Self {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let mut heights_m = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                let (mut sum, mut known) = (0.0, 0.0);
                for fine_row in 2 * row..(2 * row + 2).min(self.rows) {
                    for fine_column in 2 * column..(2 * column + 2).min(self.columns) {
                        let height_m = self.heights_m[fine_row * self.columns + fine_column];
                        if !height_m.is_nan() {
                            sum += f64::from(height_m);
                            known += 1.0;
                        }
                    }
                }
                heights_m.push(if known > 0.0 { (sum / known) as f32 } else { f32::NAN });
            }
        }
        Self { columns, rows, heights_m }
    }

    /// Fills the holes: from the coarser grid, whose holes are filled, and then each from its neighbours.
    fn solve(&mut self, coarser: &Self) {
        let holes: Vec<usize> = (0..self.heights_m.len()).filter(|&at| self.heights_m[at].is_nan()).collect();
        for &at in &holes {
            self.heights_m[at] = coarser.between(at / self.columns, at % self.columns);
        }
        for _ in 0..SWEEPS {
            holes.iter().for_each(|&at| self.relax(at));
            holes.iter().rev().for_each(|&at| self.relax(at));
        }
    }

    /// The height at a row and column of the next finer grid.
    fn between(&self, fine_row: usize, fine_column: usize) -> f32 {
        // Coarse samples lie in the middle of four fine ones: a quarter of a coarse cell beside each.
        let around = |fine: usize, count: usize| {
            let near = fine / 2;
            let far = if fine.is_multiple_of(2) { near.saturating_sub(1) } else { near + 1 };
            (near, far.min(count - 1))
        };
        let (row, other_row) = around(fine_row, self.rows);
        let (column, other_column) = around(fine_column, self.columns);
        let height_m = |row: usize, column: usize| f64::from(self.heights_m[row * self.columns + column]);
        let along = |row: usize| 0.75 * height_m(row, column) + 0.25 * height_m(row, other_column);
        (0.75 * along(row) + 0.25 * along(other_row)) as f32
    }

    /// Makes a sample the mean of its neighbours.
    fn relax(&mut self, at: usize) {
        let (row, column) = (at / self.columns, at % self.columns);
        let (mut sum, mut count) = (0.0, 0.0);
        let mut add = |is_there: bool, neighbour: usize| {
            if is_there {
                sum += f64::from(self.heights_m[neighbour]);
                count += 1.0;
            }
        };
        add(column > 0, at.wrapping_sub(1));
        add(column + 1 < self.columns, at + 1);
        add(row > 0, at.wrapping_sub(self.columns));
        add(row + 1 < self.rows, at + self.columns);
        self.heights_m[at] = (sum / count) as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_hole_in_a_slope_gets_the_slope_back() {
        let (columns, rows) = (60, 50);
        let slope = |at: usize| 100.0 + 0.2 * (at % columns) as f32 - 0.1 * (at / columns) as f32;
        let mut heights: Vec<f32> = (0..columns * rows).map(slope).collect();
        for row in 10..40 {
            heights[row * columns + 15..row * columns + 45].fill(f32::NAN);
        }
        fill(columns, &mut heights);
        for (at, height) in heights.into_iter().enumerate() {
            assert!((height - slope(at)).abs() < 0.05, "{at}: {height}, not {}", slope(at));
        }
    }

    #[test]
    fn a_frame_goes_on_as_the_ground_beside_it() {
        let mut heights = vec![f32::NAN; 8 * 8];
        for row in 1..7 {
            heights[row * 8 + 1..row * 8 + 7].fill(2.5);
        }
        fill(8, &mut heights);
        assert_eq!(heights, [2.5; 64]);
    }

    proptest! {
        #[test]
        fn what_is_filled_is_no_pit_and_no_peak(
            columns in 2..12usize,
            heights in prop::collection::vec(prop::option::of(-50.0f32..900.0), 24..140),
        ) {
            let whole = heights.len() / columns * columns;
            let given: Vec<f32> = heights[..whole].iter().map(|height| height.unwrap_or(f32::NAN)).collect();
            let known = || given.iter().copied().filter(|height| !height.is_nan());
            prop_assume!(known().count() > 0);
            let (low, high) = known().fold((f32::MAX, f32::MIN), |(low, high), h| (low.min(h), high.max(h)));
            let mut filled = given.clone();
            fill(columns, &mut filled);
            for (before, after) in given.iter().zip(&filled) {
                prop_assert!((low - 1e-3..=high + 1e-3).contains(after), "{after} beside {low} to {high}");
                prop_assert!(before.is_nan() || before == after);
            }
        }
    }
}

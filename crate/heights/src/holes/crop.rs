//! The largest rectangle without a hole.

use std::fmt;

/// A rectangle of samples, by its first row and column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Rectangle {
    column: usize,
    row: usize,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl fmt::Display for Rectangle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { column, row, columns, rows } = self;
        write!(f, "columns {} to {}, rows {} to {}", column + 1, column + columns, row + 1, row + rows)
    }
}

impl Rectangle {
    /// Its samples, of a grid with so many columns.
    pub(crate) fn cut(&self, columns: usize, heights_m: &[f32]) -> Vec<f32> {
        let lines = heights_m.chunks_exact(columns).skip(self.row).take(self.rows);
        lines.flat_map(|line| &line[self.column..self.column + self.columns]).copied().collect()
    }
}

/// The rectangle with the most samples that has no hole; of equal ones, that which ends first.
pub(crate) fn largest_whole(columns: usize, heights_m: &[f32]) -> Rectangle {
    let mut largest = Rectangle::default();
    // For each column, how many rows there are without a hole up to the present one.
    let mut free = vec![0_usize; columns];
    // Columns from which a rectangle may still grow to the east, each with its number of rows, which
    // increase.
    let mut open: Vec<(usize, usize)> = Vec::new();
    for (row, line) in heights_m.chunks_exact(columns).enumerate() {
        for (rows, height_m) in free.iter_mut().zip(line) {
            *rows = if height_m.is_nan() { 0 } else { *rows + 1 };
        }
        for end in 0..=columns {
            let rows = free.get(end).copied().unwrap_or(0);
            let mut begin = end;
            while let Some(&(from, tall)) = open.last()
                && tall >= rows
            {
                open.pop();
                begin = from;
                if tall * (end - from) > largest.rows * largest.columns {
                    largest =
                        Rectangle { column: from, row: row + 1 - tall, columns: end - from, rows: tall };
                }
            }
            if rows > 0 {
                open.push((begin, rows));
            }
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn area_by_trial(columns: usize, heights_m: &[f32]) -> usize {
        let rows = heights_m.len() / columns;
        let mut most = 0;
        for (top, bottom) in (0..rows).flat_map(|top| (top..rows).map(move |bottom| (top, bottom))) {
            for (left, right) in (0..columns).flat_map(|left| (left..columns).map(move |right| (left, right)))
            {
                let mut inside = (top..=bottom)
                    .flat_map(|row| (left..=right).map(move |column| heights_m[row * columns + column]));
                if inside.all(|height| !height.is_nan()) {
                    most = most.max((bottom + 1 - top) * (right + 1 - left));
                }
            }
        }
        most
    }

    #[test]
    fn a_frame_is_cut_off() {
        let mut heights = vec![f32::NAN; 5 * 4];
        for at in [6, 7, 8, 11, 12, 13] {
            heights[at] = at as f32;
        }
        let kept = largest_whole(5, &heights);
        assert_eq!(kept.to_string(), "columns 2 to 4, rows 2 to 3");
        assert_eq!(kept.cut(5, &heights), [6.0, 7.0, 8.0, 11.0, 12.0, 13.0]);
        assert_eq!(largest_whole(2, &[f32::NAN; 4]), Rectangle::default());
    }

    proptest! {
        #[test]
        fn no_rectangle_is_larger(
            columns in 1..7usize, holes in prop::collection::vec(any::<bool>(), 1..42),
        ) {
            let whole = holes.len() / columns * columns;
            let height = |&hole: &bool| if hole { f32::NAN } else { 1.0 };
            let heights: Vec<f32> = holes[..whole].iter().map(height).collect();
            let found = largest_whole(columns, &heights);
            let cut = found.cut(columns, &heights);
            prop_assert_eq!(cut.len(), area_by_trial(columns, &heights));
            prop_assert!(cut.iter().all(|height| !height.is_nan()));
        }
    }
}

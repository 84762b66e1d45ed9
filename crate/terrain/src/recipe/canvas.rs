//! The grid a recipe works on, in double precision.

use glam::DVec2;
use mapless_world::HeightField;
use std::ops::Range;

/// Bound on the samples that all features and strokes of a recipe touch, each time counted: a few seconds of
/// work, more than a day's sculpting, and fifteen features as large as the largest terrain.
pub(super) const MAX_TOUCHED_SAMPLES: usize = 250_000_000;

/// The samples that a recipe has touched so far.
#[derive(Default)]
pub(super) struct Effort {
    pub(super) samples: usize,
}

/// More samples than a recipe may touch.
pub(super) struct TooMuch(pub(super) usize);

impl Effort {
    /// Adds `samples` to those touched, unless that is too many.
    pub(super) fn spend(&mut self, samples: usize) -> Result<(), TooMuch> {
        self.samples = self.samples.saturating_add(samples);
        if self.samples <= MAX_TOUCHED_SAMPLES { Ok(()) } else { Err(TooMuch(self.samples)) }
    }
}

pub(super) struct Canvas {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) cell_m: f64,
    pub(super) heights_m: Vec<f64>,
    pub(super) effort: Effort,
}

impl Canvas {
    pub(super) fn from_field(field: &HeightField) -> Self {
        let heights_m = field.heights_m().iter().map(|&height| f64::from(height)).collect();
        Self {
            columns: field.columns(),
            rows: field.rows(),
            cell_m: field.cell_m(),
            heights_m,
            effort: Effort::default(),
        }
    }

    pub(super) fn extent_m(&self) -> DVec2 {
        DVec2::new((self.columns - 1) as f64, (self.rows - 1) as f64) * self.cell_m
    }

    /// Visits every sample with its position and height.
    pub(super) fn each(&mut self, change: impl FnMut(DVec2, &mut f64)) -> Result<(), TooMuch> {
        let extent = self.extent_m();
        self.each_within(DVec2::ZERO, extent, change)
    }

    /// Visits every sample in the box from `low` to `high` with its position and height.
    pub(super) fn each_within(
        &mut self,
        low: DVec2,
        high: DVec2,
        mut change: impl FnMut(DVec2, &mut f64),
    ) -> Result<(), TooMuch> {
        let (columns, rows) = self.samples_within(low, high);
        self.effort.spend(columns.len() * rows.len())?;
        for row in rows {
            for column in columns.clone() {
                change(self.place(column, row), &mut self.heights_m[row * self.columns + column]);
            }
        }
        Ok(())
    }

    /// The columns and rows of the box from `low` to `high`.
    pub(super) fn samples_within(&self, low: DVec2, high: DVec2) -> (Range<usize>, Range<usize>) {
        // Casts to integers saturate, so boxes that reach beyond the terrain are cut.
        let first = |value_m: f64| (value_m / self.cell_m).max(0.0) as usize;
        let last = |value_m: f64, count: usize| ((value_m / self.cell_m + 1.0).max(0.0) as usize).min(count);
        (first(low.x)..last(high.x, self.columns), first(low.y)..last(high.y, self.rows))
    }

    /// Position of a sample.
    pub(super) fn place(&self, column: usize, row: usize) -> DVec2 {
        DVec2::new(column as f64, row as f64) * self.cell_m
    }

    /// Height at a position, which is moved to the nearest point of the terrain when it lies off it.
    pub(super) fn height_m(&self, position: DVec2) -> f64 {
        let grid = position.clamp(DVec2::ZERO, self.extent_m()) / self.cell_m;
        let column = (grid.x as usize).min(self.columns - 2);
        let row = (grid.y as usize).min(self.rows - 2);
        let (u, v) = (grid.x - column as f64, grid.y - row as f64);
        let at = |c: usize, r: usize| self.heights_m[(row + r) * self.columns + column + c];
        (at(0, 0) * (1.0 - u) + at(1, 0) * u) * (1.0 - v) + (at(0, 1) * (1.0 - u) + at(1, 1) * u) * v
    }
}

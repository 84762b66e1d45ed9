//! Shaping the ground: brushes that change it at one place or along a line.

mod profile;

use crate::height_field::{FieldError, HEIGHT_LIMIT_M, HeightField};
use crate::noise::GradientNoise;
use glam::DVec2;
use mapless_parameters::{Check, ConfigError, Value};
use profile::{boulder, bump, crater, flat_bottom, flat_top};

pub use profile::smooth_step;

/// What a brush does to the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BrushKind {
    /// Adds height.
    Raise,
    /// Takes height away.
    Lower,
    /// Moves each sample towards the mean of its 3 × 3 neighbourhood.
    Smooth,
    /// Moves each sample towards one height.
    Level {
        /// That height, in metres.
        height_m: f64,
    },
    /// Adds seeded noise, whose waves are half as long as the brush's radius.
    Roughen {
        /// Another seed gives other bumps.
        seed: u64,
    },
    /// A bowl of `strength_m` depth with a rim at 0.6 of the radius.
    Crater,
    /// A round rock of `strength_m` height.
    Boulder,
    /// An even slope from the ground at the centre to the ground at another place.
    Ramp {
        /// Where it ends.
        to: DVec2,
    },
    /// A channel of `strength_m` depth from the centre to another place.
    Ditch {
        /// Where it ends.
        to: DVec2,
    },
}

/// One touch of a brush. Its effect falls off from the centre, or from the line to the place where it ends,
/// to nothing at the radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// Centre in the world frame, in metres; it may lie off the terrain.
    pub centre: DVec2,
    /// Radius in metres, above 0.
    pub radius_m: f64,
    /// The largest change of a height, in metres, from 0 to 100.
    pub strength_m: f64,
    /// What it does.
    pub kind: BrushKind,
}

/// A rectangle of samples: columns `column_begin..column_end`, rows `row_begin..row_end`, never empty.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct SampleRect {
    /// First column.
    pub column_begin: usize,
    /// One past the last column.
    pub column_end: usize,
    /// First row.
    pub row_begin: usize,
    /// One past the last row.
    pub row_end: usize,
}

impl SampleRect {
    /// How many samples it holds.
    #[must_use]
    pub fn samples(self) -> usize {
        (self.column_end - self.column_begin) * (self.row_end - self.row_begin)
    }

    /// The smallest rectangle that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            column_begin: self.column_begin.min(other.column_begin),
            column_end: self.column_end.max(other.column_end),
            row_begin: self.row_begin.min(other.row_begin),
            row_end: self.row_end.max(other.row_end),
        }
    }
}

impl Brush {
    /// Checks that the brush is usable.
    ///
    /// # Errors
    /// [`ConfigError`] names the first field outside its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let limit_m = f64::from(HEIGHT_LIMIT_M);
        let end = self.end();
        let mut checks = vec![
            ("centre.x", self.centre.x, Check::Finite),
            ("centre.y", self.centre.y, Check::Finite),
            ("radius_m", self.radius_m, Check::Positive),
            ("strength_m", self.strength_m, Check::Within(0.0, 100.0)),
            ("to.x", end.x, Check::Finite),
            ("to.y", end.y, Check::Finite),
        ];
        if let BrushKind::Level { height_m } = self.kind {
            checks.push(("height_m", height_m, Check::Within(-limit_m, limit_m)));
        }
        checks.into_iter().try_for_each(|(name, value, check)| check.require("", name, Value::Number(value)))
    }

    /// The samples that it may change; `None` where it is beside the field.
    #[must_use]
    pub fn covered(&self, field: &HeightField) -> Option<SampleRect> {
        let (low, high) = (self.centre.min(self.end()), self.centre.max(self.end()));
        // A cast from float to integer saturates, so a brush far away or far too large needs no special case.
        let span = |low_m: f64, high_m: f64, count: usize| {
            let begin = ((low_m - self.radius_m) / field.cell_m()).max(0.0) as usize;
            let end = (((high_m + self.radius_m) / field.cell_m() + 1.0).max(0.0) as usize).min(count);
            (begin, end)
        };
        let (column_begin, column_end) = span(low.x, high.x, field.columns());
        let (row_begin, row_end) = span(low.y, high.y, field.rows());
        (column_begin < column_end && row_begin < row_end).then_some(SampleRect {
            column_begin,
            column_end,
            row_begin,
            row_end,
        })
    }

    /// Where the line ends; the centre, for a brush that works at one place.
    fn end(&self) -> DVec2 {
        match self.kind {
            BrushKind::Ramp { to } | BrushKind::Ditch { to } => to,
            _ => self.centre,
        }
    }

    /// Share of the line from the centre to the end where `position` is nearest to it, and the distance to
    /// there in radii.
    fn nearest(&self, position: DVec2) -> (f64, f64) {
        let along = self.end() - self.centre;
        let share = (position - self.centre).dot(along) / along.length_squared();
        // At one place there is no line: not a number.
        let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
        (share, position.distance(self.centre + along * share) / self.radius_m)
    }
}

impl HeightField {
    /// Applies one touch of a brush and returns the samples it may have changed, or `None` when it covers
    /// none.
    ///
    /// Heights stop at ±[`HEIGHT_LIMIT_M`]: the ground stays finite however often it is raised.
    ///
    /// # Errors
    /// [`ConfigError`] when the brush is not valid.
    pub fn sculpt(&mut self, brush: &Brush) -> Result<Option<SampleRect>, ConfigError> {
        brush.validate()?;
        let Some(rect) = brush.covered(self) else { return Ok(None) };
        let columns = self.columns();
        let ends_m = [brush.centre, brush.end()].map(|place| self.nearest_height_m(place));
        let mut changed = Vec::with_capacity(rect.samples());
        for row in rect.row_begin..rect.row_end {
            for column in rect.column_begin..rect.column_end {
                let height_m = f64::from(self.heights_m()[row * columns + column]);
                let target_m = self.target_m(brush, ends_m, column, row, height_m);
                changed.push((target_m as f32).clamp(-HEIGHT_LIMIT_M, HEIGHT_LIMIT_M));
            }
        }
        self.copy_in(rect, &changed);
        Ok(Some(rect))
    }

    /// Puts other heights, row by row from the south-west, in place of those in a rectangle.
    ///
    /// # Errors
    /// [`FieldError`] when the rectangle is not within the field, their number is another, or one is no
    /// height.
    pub fn replace(&mut self, rect: SampleRect, heights_m: &[f32]) -> Result<(), FieldError> {
        let SampleRect { column_begin, column_end, row_begin, row_end } = rect;
        if column_begin >= column_end
            || row_begin >= row_end
            || column_end > self.columns()
            || row_end > self.rows()
        {
            return Err(FieldError::Rectangle { columns: self.columns(), rows: self.rows() });
        }
        let width = column_end - column_begin;
        let expected = width * (row_end - row_begin);
        if heights_m.len() != expected {
            return Err(FieldError::HeightCount { found: heights_m.len(), expected });
        }
        if let Some(index) =
            heights_m.iter().position(|height| height.is_nan() || height.abs() > HEIGHT_LIMIT_M)
        {
            return Err(FieldError::Height {
                column: column_begin + index % width,
                row: row_begin + index / width,
                height_m: heights_m[index],
            });
        }
        self.copy_in(rect, heights_m);
        Ok(())
    }

    fn copy_in(&mut self, rect: SampleRect, heights_m: &[f32]) {
        let width = rect.column_end - rect.column_begin;
        let columns = self.columns();
        for (row, new) in (rect.row_begin..rect.row_end).zip(heights_m.chunks_exact(width)) {
            let begin = row * columns + rect.column_begin;
            self.heights_mut()[begin..begin + width].copy_from_slice(new);
        }
    }

    /// What a brush makes of one sample; `ends_m` are the heights of the ground where its line begins and
    /// ends.
    fn target_m(&self, brush: &Brush, ends_m: [f64; 2], column: usize, row: usize, height_m: f64) -> f64 {
        let position = DVec2::new(column as f64, row as f64) * self.cell_m();
        let (share, radii) = brush.nearest(position);
        if radii >= 1.0 {
            return height_m;
        }
        let strength_m = brush.strength_m;
        let towards = |target_m: f64, most_m: f64| target_m.max(height_m - most_m).min(height_m + most_m);
        match brush.kind {
            BrushKind::Raise => height_m + strength_m * bump(radii),
            BrushKind::Lower => height_m - strength_m * bump(radii),
            BrushKind::Smooth => towards(self.local_mean(column, row), strength_m * bump(radii)),
            BrushKind::Level { height_m: level_m } => towards(level_m, strength_m * bump(radii)),
            BrushKind::Roughen { seed } => {
                // Shorter waves would fall between the samples.
                let wave_m = (0.5 * brush.radius_m).max(4.0 * self.cell_m());
                height_m + strength_m * bump(radii) * GradientNoise::new(seed).at(position / wave_m)
            }
            BrushKind::Crater => height_m + strength_m * crater(radii),
            BrushKind::Boulder => height_m + strength_m * boulder(radii),
            BrushKind::Ramp { .. } => {
                let [begin_m, end_m] = ends_m;
                let slope_m = begin_m + (end_m - begin_m) * share;
                towards(height_m + (slope_m - height_m) * flat_top(radii), strength_m)
            }
            BrushKind::Ditch { .. } => height_m - strength_m * flat_bottom(radii),
        }
    }

    /// Height of the ground, or of its nearest point for a place off the terrain.
    fn nearest_height_m(&self, place: DVec2) -> f64 {
        self.height_m(place.clamp(DVec2::ZERO, self.extent_m())).unwrap_or_default()
    }

    fn local_mean(&self, column: usize, row: usize) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for r in row.saturating_sub(1)..(row + 2).min(self.rows()) {
            for c in column.saturating_sub(1)..(column + 2).min(self.columns()) {
                sum += f64::from(self.heights_m()[r * self.columns() + c]);
                count += 1.0;
            }
        }
        sum / count
    }
}

#[cfg(test)]
mod tests;

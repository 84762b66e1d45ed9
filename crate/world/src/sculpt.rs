//! Shaping the ground with a round brush.

use crate::config::{ConfigError, positive, within};
use crate::height_field::{HEIGHT_LIMIT_M, HeightField};
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// What a brush does to the ground.
#[derive(Clone, Copy, Debug, Deserialize, Eq, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BrushKind {
    /// Adds height.
    Raise,
    /// Takes height away.
    Lower,
    /// Moves each sample towards the mean of its 3 × 3 neighbourhood.
    Smooth,
}

/// One dab of a round brush. Its effect falls off smoothly from the centre to nothing at the radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// Centre in the world frame, in metres; it may lie off the terrain.
    pub centre: DVec2,
    /// Radius in metres, above 0.
    pub radius_m: f64,
    /// The largest change of a height, reached at the centre, in metres, from 0 to 100.
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

impl Brush {
    /// Checks that the brush is usable.
    ///
    /// # Errors
    /// [`ConfigError`] names the first field outside its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        within("centre.x", self.centre.x, f64::MIN, f64::MAX)?;
        within("centre.y", self.centre.y, f64::MIN, f64::MAX)?;
        positive("radius_m", self.radius_m)?;
        within("strength_m", self.strength_m, 0.0, 100.0)
    }
}

impl HeightField {
    /// Applies one dab of a brush and returns the samples it may have changed, or `None` when it covers none.
    ///
    /// Heights stop at ±[`HEIGHT_LIMIT_M`]: the ground stays finite however often it is raised.
    ///
    /// # Errors
    /// [`ConfigError`] when the brush is not valid.
    pub fn sculpt(&mut self, brush: &Brush) -> Result<Option<SampleRect>, ConfigError> {
        brush.validate()?;
        let Some(rect) = covered(self, brush) else { return Ok(None) };
        let columns = self.columns();
        let mut changed =
            Vec::with_capacity((rect.column_end - rect.column_begin) * (rect.row_end - rect.row_begin));
        for row in rect.row_begin..rect.row_end {
            for column in rect.column_begin..rect.column_end {
                let height = f64::from(self.heights_m()[row * columns + column]);
                let step = brush.strength_m * self.falloff(brush, column, row);
                let target = match brush.kind {
                    BrushKind::Raise => height + step,
                    BrushKind::Lower => height - step,
                    BrushKind::Smooth => self.local_mean(column, row).max(height - step).min(height + step),
                };
                changed.push((target as f32).clamp(-HEIGHT_LIMIT_M, HEIGHT_LIMIT_M));
            }
        }
        let width = rect.column_end - rect.column_begin;
        for (row, new) in (rect.row_begin..rect.row_end).zip(changed.chunks_exact(width)) {
            let begin = row * columns + rect.column_begin;
            self.heights_mut()[begin..begin + width].copy_from_slice(new);
        }
        Ok(Some(rect))
    }

    /// `(1 - d²/r²)²` inside the brush, 0 outside: level at the centre and at the rim.
    fn falloff(&self, brush: &Brush, column: usize, row: usize) -> f64 {
        let sample = DVec2::new(column as f64, row as f64) * self.cell_m();
        let rest = (1.0 - ((sample - brush.centre) / brush.radius_m).length_squared()).max(0.0);
        rest * rest
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

fn covered(field: &HeightField, brush: &Brush) -> Option<SampleRect> {
    // A cast from float to integer saturates, so a brush far away or far too large needs no special case.
    let span = |centre_m: f64, count: usize| {
        let begin = ((centre_m - brush.radius_m) / field.cell_m()).max(0.0) as usize;
        let end = (((centre_m + brush.radius_m) / field.cell_m() + 1.0).max(0.0) as usize).min(count);
        (begin, end)
    };
    let (column_begin, column_end) = span(brush.centre.x, field.columns());
    let (row_begin, row_end) = span(brush.centre.y, field.rows());
    (column_begin < column_end && row_begin < row_end).then_some(SampleRect {
        column_begin,
        column_end,
        row_begin,
        row_end,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn flat() -> HeightField {
        HeightField::new(21, 21, 0.5, vec![0.0; 441]).unwrap()
    }

    fn brush(kind: BrushKind) -> Brush {
        Brush { centre: DVec2::new(5.0, 5.0), radius_m: 2.0, strength_m: 0.5, kind }
    }

    #[test]
    fn raising_lifts_the_centre_by_the_strength_and_nothing_beyond_the_radius() {
        let mut field = flat();
        let rect = field.sculpt(&brush(BrushKind::Raise)).unwrap().unwrap();
        assert_eq!(field.height_m(DVec2::new(5.0, 5.0)), Some(0.5));
        for row in 0..21 {
            for column in 0..21 {
                let away = (DVec2::new(column as f64, row as f64) * 0.5).distance(DVec2::new(5.0, 5.0));
                let height = field.heights_m()[row * 21 + column];
                assert_eq!(height > 0.0, away < 2.0, "{column}, {row}: {height}");
                let inside = (rect.column_begin..rect.column_end).contains(&column)
                    && (rect.row_begin..rect.row_end).contains(&row);
                assert!(inside || height == 0.0);
            }
        }
        field.sculpt(&brush(BrushKind::Lower)).unwrap();
        assert!(field.heights_m().iter().all(|h| h.abs() < 1e-6), "lowering undoes raising");
    }

    #[test]
    fn smoothing_levels_a_spike() {
        let mut field = flat();
        field.heights_mut()[10 * 21 + 10] = 3.0;
        for _ in 0..100 {
            field.sculpt(&brush(BrushKind::Smooth)).unwrap();
        }
        assert!(field.height_range_m().1 < 0.3, "{:?}", field.height_range_m());
    }

    #[test]
    fn bad_brushes_are_refused() {
        let mut field = flat();
        let good = brush(BrushKind::Raise);
        for bad in [
            Brush { radius_m: 0.0, ..good },
            Brush { radius_m: f64::NAN, ..good },
            Brush { strength_m: -1.0, ..good },
            Brush { centre: DVec2::new(f64::INFINITY, 0.0), ..good },
        ] {
            assert!(field.sculpt(&bad).is_err(), "{bad:?}");
        }
        let away = Brush { centre: DVec2::new(-10.0, 5.0), ..good };
        assert_eq!(field.sculpt(&away), Ok(None));
        assert_eq!(field, flat());
    }

    proptest! {
        #[test]
        fn ground_stays_finite(
            x in -1e6..1e6f64, y in -1e6..1e6f64, radius_m in 0.001..1e9f64, strength_m in 0.0..100.0f64,
            kind in prop::sample::select(vec![BrushKind::Raise, BrushKind::Lower, BrushKind::Smooth]),
            near in any::<bool>(),
        ) {
            let mut field = HeightField::new(9, 7, 0.5, (0..63).map(|i| HEIGHT_LIMIT_M - i as f32).collect()).unwrap();
            let centre = if near { DVec2::new(x, y) / 1e6 * 4.0 } else { DVec2::new(x, y) };
            field.sculpt(&Brush { centre, radius_m, strength_m, kind }).unwrap();
            let heights = field.heights_m().to_vec();
            prop_assert!(HeightField::new(9, 7, 0.5, heights).is_ok());
        }
    }
}

//! Checks of single values that name their table and line.

use super::canvas::{MAX_TOUCHED_SAMPLES, TooMuch};
use crate::stroke::StrokeError;
use crate::terrain::TerrainFault;
use serde::Deserialize;

/// No coordinate of a recipe lies farther out than this, in metres.
const FAR_M: f64 = 1e6;

/// The table whose values are being checked.
pub(super) struct Table<'a> {
    /// The recipe, where in it the table begins, and which of its kind it is; nothing at the top level. The
    /// line is counted for a fault only: doing so for each of many tables takes long.
    place: Option<(&'a str, usize, &'static str, usize)>,
}

/// A value for a whole line, or one for each of its points.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a number, or a list with one number per point")]
pub(super) enum PerPoint {
    One(f64),
    Each(Vec<f64>),
}

impl PerPoint {
    /// One value per point.
    pub(super) fn values(&self, points: usize) -> Vec<f64> {
        match self {
            Self::One(value) => vec![*value; points],
            Self::Each(values) => values.clone(),
        }
    }
}

impl<'a> Table<'a> {
    pub(super) fn top_level() -> Self {
        Self { place: None }
    }

    /// The table `[[kind]]` number `index + 1`, which begins at byte `start` of the recipe.
    pub(super) fn at(text: &'a str, start: usize, kind: &'static str, index: usize) -> Self {
        Self { place: Some((text, start, kind, index)) }
    }

    pub(super) fn fault(&self, key: &str, value: impl ToString, expected: impl Into<String>) -> TerrainFault {
        let prefix = self.place.map_or(String::new(), |(text, start, kind, index)| {
            let line = text.bytes().take(start).filter(|&byte| byte == b'\n').count() + 1;
            format!("line {line}, {kind}[{}].", index + 1)
        });
        TerrainFault::value(format!("{prefix}{key}"), value, expected)
    }

    /// The fault of a recipe that touches too many samples.
    pub(super) fn too_much(&self, TooMuch(samples): TooMuch) -> TerrainFault {
        let expected = format!("at most {MAX_TOUCHED_SAMPLES} in all tables");
        self.fault("samples touched", samples, expected)
    }

    /// The fault of a `[[stroke]]`.
    pub(super) fn stroke_fault(&self, error: StrokeError) -> TerrainFault {
        match error {
            StrokeError::Syntax(reason) => TerrainFault::damaged("recipe", reason),
            StrokeError::Value { key, value, expected } => self.fault(&key, value, expected),
            StrokeError::Brush { point, fault } => {
                self.fault(&format!("points[{point}], {}", fault.name), fault.value, fault.expected)
            }
        }
    }

    pub(super) fn finite(&self, key: &str, value: f64) -> Result<(), TerrainFault> {
        if value.is_finite() { Ok(()) } else { Err(self.fault(key, value, "a finite number")) }
    }

    pub(super) fn positive(&self, key: &str, value: f64) -> Result<(), TerrainFault> {
        if value > 0.0 && value < FAR_M {
            Ok(())
        } else {
            Err(self.fault(key, value, "a finite number above 0"))
        }
    }

    pub(super) fn not_negative(&self, key: &str, value: f64) -> Result<(), TerrainFault> {
        if (0.0..FAR_M).contains(&value) {
            Ok(())
        } else {
            Err(self.fault(key, value, "a finite number from 0"))
        }
    }

    pub(super) fn point(&self, key: &str, point: [f64; 2]) -> Result<(), TerrainFault> {
        if point.iter().all(|value| value.abs() < FAR_M) {
            return Ok(());
        }
        Err(self.fault(key, format!("{point:?}"), "two finite coordinates in metres"))
    }

    /// At least two points, each apart from the one before.
    pub(super) fn line(&self, points: &[[f64; 2]]) -> Result<(), TerrainFault> {
        if points.len() < 2 {
            return Err(self.fault("points", format!("{points:?}"), "at least two points"));
        }
        for (index, &point) in points.iter().enumerate() {
            self.point(&format!("points[{}]", index + 1), point)?;
        }
        for (index, pair) in points.windows(2).enumerate() {
            if (pair[0][0] - pair[1][0]).abs() + (pair[0][1] - pair[1][1]).abs() < 0.01 {
                let expected = "a point at least 1 cm from the one before";
                return Err(self.fault(
                    &format!("points[{}]", index + 2),
                    format!("{:?}", pair[1]),
                    expected,
                ));
            }
        }
        Ok(())
    }

    pub(super) fn per_point(&self, key: &str, value: &PerPoint, points: usize) -> Result<(), TerrainFault> {
        let values = value.values(points);
        if values.len() != points {
            let expected = format!("one number, or one for each of the {points} points");
            return Err(self.fault(key, format!("{values:?}"), expected));
        }
        values.into_iter().try_for_each(|value| self.finite(key, value))
    }
}

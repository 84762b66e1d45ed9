//! Strokes: the touches of one brush, as the table of a recipe that describes them.

use glam::DVec2;
use mapless_world::{Brush, BrushKind, ConfigError, HeightField, SampleRect};
use serde::Deserialize;
use thiserror::Error;

/// One tool in one go: `[[stroke]]` of a recipe.
///
/// ```toml
/// kind = "raise"            # raise, lower, smooth, level, roughen, crater, boulder, ramp or ditch
/// radius_m = 2.0
/// strength_m = 0.1          # the largest change of a height by one touch
/// height_m = 4.0            # of `level`
/// seed = 7                  # of `roughen`
/// points = [[10.0, 12.0]]   # a touch at each; `ramp` and `ditch` go from each to the next
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    brushes: Vec<Brush>,
}

/// Why a table describes no stroke.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StrokeError {
    /// Not TOML, a wrong key or a value of the wrong kind.
    #[error("stroke: {0}")]
    Syntax(String),
    /// A value is not allowed.
    #[error("stroke.{key} = {value}: expected {expected}")]
    Value {
        /// The key.
        key: String,
        /// What stands there.
        value: String,
        /// What is allowed there.
        expected: String,
    },
    /// A touch of the brush is not valid.
    #[error("stroke.points[{point}], {fault}")]
    Brush {
        /// The point, counted from 1.
        point: usize,
        /// What is wrong.
        fault: ConfigError,
    },
}

/// A stroke as written, unchecked.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct StrokeTable {
    /// What each touch does.
    pub kind: StrokeKind,
    /// Radius of the brush.
    pub radius_m: f64,
    /// The largest change of a height by one touch.
    pub strength_m: f64,
    /// Of [`StrokeKind::Level`] alone.
    pub height_m: Option<f64>,
    /// Of [`StrokeKind::Roughen`] alone.
    pub seed: Option<u64>,
    /// x and y of each touch.
    pub points: Vec<[f64; 2]>,
}

/// The tool of a stroke: see [`BrushKind`].
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum StrokeKind {
    /// [`BrushKind::Raise`].
    Raise,
    /// [`BrushKind::Lower`].
    Lower,
    /// [`BrushKind::Smooth`].
    Smooth,
    /// [`BrushKind::Level`].
    Level,
    /// [`BrushKind::Roughen`].
    Roughen,
    /// [`BrushKind::Crater`].
    Crater,
    /// [`BrushKind::Boulder`].
    Boulder,
    /// [`BrushKind::Ramp`] from each place to the next.
    Ramp,
    /// [`BrushKind::Ditch`] from each place to the next.
    Ditch,
}

impl Stroke {
    /// Reads the keys of one stroke, without the header of their table.
    ///
    /// # Errors
    /// [`StrokeError`] names the key, its value and what was expected.
    pub fn parse(text: &str) -> Result<Self, StrokeError> {
        let table: StrokeTable =
            mapless_toml::from_str(text).map_err(|error| StrokeError::Syntax(error.to_string()))?;
        Self::try_from(&table)
    }

    /// How many samples of a field the touches cover, each counted for every touch.
    #[must_use]
    pub fn samples(&self, field: &HeightField) -> usize {
        let covered = self.brushes.iter().filter_map(|brush| brush.covered(field));
        // Where an integer has 32 bits, a few hundred touches of the largest field are more than it holds.
        covered.map(SampleRect::samples).fold(0, usize::saturating_add)
    }

    /// The touches, in their order.
    #[must_use]
    pub fn brushes(&self) -> &[Brush] {
        &self.brushes
    }
}

impl TryFrom<&StrokeTable> for Stroke {
    type Error = StrokeError;

    fn try_from(table: &StrokeTable) -> Result<Self, StrokeError> {
        let kinds = table.kinds()?;
        let brushes = kinds.into_iter().zip(&table.points).enumerate().map(|(index, (kind, &point))| {
            let centre = DVec2::from_array(point);
            let brush = Brush { centre, radius_m: table.radius_m, strength_m: table.strength_m, kind };
            brush.validate().map_err(|fault| StrokeError::Brush { point: index + 1, fault })?;
            Ok(brush)
        });
        Ok(Self { brushes: brushes.collect::<Result<_, _>>()? })
    }
}

impl StrokeTable {
    /// What each touch does.
    fn kinds(&self) -> Result<Vec<BrushKind>, StrokeError> {
        let value = |key: &str, value: String, expected: &str| StrokeError::Value {
            key: key.to_owned(),
            value,
            expected: expected.to_owned(),
        };
        let missing = |key| value(key, "absent".to_owned(), "a value");
        if self.height_m.is_some() && self.kind != StrokeKind::Level {
            return Err(value("height_m", "present".to_owned(), "none beside a kind other than level"));
        }
        if self.seed.is_some() && self.kind != StrokeKind::Roughen {
            return Err(value("seed", "present".to_owned(), "none beside a kind other than roughen"));
        }
        let to = |make: fn(DVec2) -> BrushKind| {
            if self.points.len() < 2 {
                return Err(value("points", format!("{:?}", self.points), "at least two points"));
            }
            Ok(self.points.iter().skip(1).map(|&point| make(DVec2::from_array(point))).collect())
        };
        let kind = match self.kind {
            StrokeKind::Raise => BrushKind::Raise,
            StrokeKind::Lower => BrushKind::Lower,
            StrokeKind::Smooth => BrushKind::Smooth,
            StrokeKind::Level => {
                BrushKind::Level { height_m: self.height_m.ok_or_else(|| missing("height_m"))? }
            }
            StrokeKind::Roughen => BrushKind::Roughen { seed: self.seed.ok_or_else(|| missing("seed"))? },
            StrokeKind::Crater => BrushKind::Crater,
            StrokeKind::Boulder => BrushKind::Boulder,
            StrokeKind::Ramp => return to(|to| BrushKind::Ramp { to }),
            StrokeKind::Ditch => return to(|to| BrushKind::Ditch { to }),
        };
        if self.points.is_empty() {
            return Err(value("points", "[]".to_owned(), "at least one point"));
        }
        Ok(vec![kind; self.points.len()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RAISE: &str =
        "kind = \"raise\"\nradius_m = 2\nstrength_m = 0.5\npoints = [[1.0, 2.0], [3.0, 4.0]]\n";

    fn fault(text: &str) -> String {
        Stroke::parse(text).unwrap_err().to_string()
    }

    #[test]
    fn a_touch_at_each_point_and_a_line_between_two() {
        let touches = Stroke::parse(RAISE).unwrap();
        let centres: Vec<DVec2> = touches.brushes().iter().map(|brush| brush.centre).collect();
        assert_eq!(centres, [DVec2::new(1.0, 2.0), DVec2::new(3.0, 4.0)]);
        let ditch = Stroke::parse(&RAISE.replace("raise", "ditch")).unwrap();
        assert_eq!(ditch.brushes().len(), 1);
        assert_eq!(ditch.brushes()[0].kind, BrushKind::Ditch { to: DVec2::new(3.0, 4.0) });
        let level = Stroke::parse(&format!("{}height_m = -1.5\n", RAISE.replace("raise", "level"))).unwrap();
        assert_eq!(level.brushes()[1].kind, BrushKind::Level { height_m: -1.5 });
    }

    #[test]
    fn faults_name_key_value_and_expectation() {
        assert!(fault(&RAISE.replace("raise", "polish")).contains("unknown variant `polish`"));
        assert!(fault(&format!("{RAISE}colour = 1")).contains("unknown field `colour`"));
        assert_eq!(fault(&RAISE.replace("raise", "level")), "stroke.height_m = absent: expected a value");
        assert!(fault(&format!("{RAISE}seed = 3")).starts_with("stroke.seed = present: expected none"));
        assert!(
            fault(&RAISE.replace("raise", "ramp").replace(", [3.0, 4.0]", ""))
                .contains("at least two points")
        );
        assert!(fault(&RAISE.replace("[[1.0, 2.0], [3.0, 4.0]]", "[]")).contains("at least one point"));
        assert!(
            fault(&RAISE.replace("radius_m = 2", "radius_m = nan"))
                .starts_with("stroke.points[1], radius_m = NaN")
        );
        assert!(fault(&RAISE.replace("3.0", "inf")).starts_with("stroke.points[2], centre.x = inf"));
    }
}

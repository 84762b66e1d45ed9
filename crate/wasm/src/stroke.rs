//! A stroke of a brush as the page keeps it.

use mapless_terrain::StrokeTable;
use serde::Deserialize;
use tsify::Tsify;

/// One tool in one go. The names are those of a recipe's `[[stroke]]`.
#[derive(Debug, Deserialize, Tsify)]
pub struct Stroke {
    kind: StrokeKind,
    radius_m: f64,
    /// The largest change of a height by one touch.
    strength_m: f64,
    /// Of `level`.
    #[tsify(optional)]
    height_m: Option<f64>,
    /// Of `roughen`.
    #[tsify(optional)]
    seed: Option<u64>,
    /// x, y of each touch in whole centimetres; `ramp` and `ditch` go from each place to the next.
    #[tsify(type = "readonly number[]")]
    points_cm: Vec<f64>,
}

/// What each touch does.
#[derive(Clone, Copy, Debug, Deserialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum StrokeKind {
    /// Adds a bump.
    Raise,
    /// Digs a hollow.
    Lower,
    /// Evens out.
    Smooth,
    /// Brings to a height.
    Level,
    /// Adds bumps and hollows at random.
    Roughen,
    /// Digs a bowl with a rim.
    Crater,
    /// Puts a round rock.
    Boulder,
    /// Makes the ground even from place to place.
    Ramp,
    /// Digs a channel from place to place.
    Ditch,
}

impl From<Stroke> for StrokeTable {
    fn from(stroke: Stroke) -> Self {
        use mapless_terrain::StrokeKind as Kind;
        Self {
            kind: match stroke.kind {
                StrokeKind::Raise => Kind::Raise,
                StrokeKind::Lower => Kind::Lower,
                StrokeKind::Smooth => Kind::Smooth,
                StrokeKind::Level => Kind::Level,
                StrokeKind::Roughen => Kind::Roughen,
                StrokeKind::Crater => Kind::Crater,
                StrokeKind::Boulder => Kind::Boulder,
                StrokeKind::Ramp => Kind::Ramp,
                StrokeKind::Ditch => Kind::Ditch,
            },
            radius_m: stroke.radius_m,
            strength_m: stroke.strength_m,
            height_m: stroke.height_m,
            seed: stroke.seed,
            points: stroke.points_cm.chunks_exact(2).map(|cm| [cm[0] / 100.0, cm[1] / 100.0]).collect(),
        }
    }
}

//! Objects as files name them, and the solids that they are made of.

use super::solid::{Shape, Solid};
use super::walk::Walk;
use crate::height_field::HeightField;
use glam::{DVec2, DVec3};
use mapless_parameters::{Check, ConfigError, Value};

/// Something that stands on the ground and is not ground. Places are seen from above, in metres; angles are
/// counter-clockwise from east.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Object {
    /// An upright cylinder: a post, a trunk, a person.
    Post {
        /// Place of its axis.
        at: [f64; 2],
        /// Radius.
        radius_m: f64,
        /// Height above the ground at its place.
        height_m: f64,
        /// Where it walks, if it does.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        walk: Option<Walk>,
    },
    /// A box.
    Box {
        /// Place of its middle.
        at: [f64; 2],
        /// Length, width and height.
        size_m: [f64; 3],
        /// Direction of its length.
        #[serde(default)]
        yaw_rad: f64,
        /// Room beneath it.
        #[serde(default)]
        raised_m: f64,
        /// Where it walks, if it does.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        walk: Option<Walk>,
    },
    /// A ball, partly in the ground.
    Rock {
        /// Place of its middle.
        at: [f64; 2],
        /// Radius.
        radius_m: f64,
        /// How much of its height is in the ground.
        #[serde(default)]
        sunk_m: f64,
    },
    /// A wall that follows the ground.
    Wall {
        /// One end.
        from: [f64; 2],
        /// The other end.
        to: [f64; 2],
        /// Height above the ground.
        height_m: f64,
        /// Thickness.
        #[serde(default = "wall_thickness_m")]
        thickness_m: f64,
    },
    /// Two posts and a beam to drive through.
    Gate {
        /// Place of the middle of the opening.
        at: [f64; 2],
        /// Direction in which it is driven through.
        yaw_rad: f64,
        /// Clear width.
        width_m: f64,
        /// Clear height.
        height_m: f64,
    },
    /// A plate on four posts.
    Roof {
        /// Place of its middle.
        at: [f64; 2],
        /// Length, width and thickness.
        size_m: [f64; 3],
        /// Direction of its length.
        #[serde(default)]
        yaw_rad: f64,
        /// Clear height beneath it.
        height_m: f64,
    },
}

fn wall_thickness_m() -> f64 {
    0.2
}

/// A wall is made of pieces at most this long, each with the height of the ground at its place, metres.
const WALL_PIECE_M: f64 = 1.0;
/// Side of the posts of a gate and of a roof, and thickness of a gate's beam, metres.
const POST_SIDE_M: f64 = 0.15;
/// Nothing but a wall is larger than this, metres.
const MAX_SIZE_M: f64 = 100.0;
/// No wall is longer than this, metres.
const MAX_WALL_M: f64 = 1000.0;

impl Object {
    /// Where it stands, or stood before it walked.
    #[must_use]
    pub fn place_m(&self) -> DVec2 {
        match *self {
            Self::Post { at, .. }
            | Self::Box { at, .. }
            | Self::Rock { at, .. }
            | Self::Gate { at, .. }
            | Self::Roof { at, .. } => at.into(),
            Self::Wall { from, to, .. } => (DVec2::from(from) + DVec2::from(to)) / 2.0,
        }
    }

    /// Where it walks, if it does.
    #[must_use]
    pub fn walk(&self) -> Option<&Walk> {
        match self {
            Self::Post { walk, .. } | Self::Box { walk, .. } => walk.as_ref(),
            Self::Rock { .. } | Self::Wall { .. } | Self::Gate { .. } | Self::Roof { .. } => None,
        }
    }

    /// What it is called in sentences.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Post { walk: Some(_), .. } | Self::Box { walk: Some(_), .. } => "mover",
            Self::Post { .. } => "post",
            Self::Box { .. } => "box",
            Self::Rock { .. } => "rock",
            Self::Wall { .. } => "wall",
            Self::Gate { .. } => "gate",
            Self::Roof { .. } => "roof",
        }
    }

    /// Checks its values; `place` names it in errors.
    ///
    /// # Errors
    /// [`ConfigError`] for the first value outside its range.
    pub fn validate(&self, place: &str) -> Result<(), ConfigError> {
        let check = |check: Check, name, value: f64| check.require(place, name, Value::Number(value));
        let size = |name, value| check(Check::Within(0.001, MAX_SIZE_M), name, value);
        let angle = |value| check(Check::Within(-1000.0, 1000.0), "yaw_rad", value);
        let spot = |name, at: [f64; 2]| {
            at.into_iter().try_for_each(|value| check(Check::Within(0.0, 1e6), name, value))
        };
        let walks = |walk: &Option<Walk>| walk.as_ref().map_or(Ok(()), |walk| walk.validate(place));
        match self {
            Self::Post { at, radius_m, height_m, walk } => {
                spot("at", *at)?;
                size("radius_m", *radius_m)?;
                size("height_m", *height_m)?;
                walks(walk)
            }
            Self::Box { at, size_m, yaw_rad, raised_m, walk } => {
                spot("at", *at)?;
                size_m.iter().try_for_each(|&side_m| size("size_m", side_m))?;
                angle(*yaw_rad)?;
                check(Check::Within(0.0, MAX_SIZE_M), "raised_m", *raised_m)?;
                walks(walk)
            }
            Self::Rock { at, radius_m, sunk_m } => {
                spot("at", *at)?;
                size("radius_m", *radius_m)?;
                check(Check::Within(0.0, 2.0 * radius_m), "sunk_m", *sunk_m)
            }
            Self::Wall { from, to, height_m, thickness_m } => {
                spot("from", *from)?;
                spot("to", *to)?;
                let length_m = DVec2::from(*from).distance((*to).into());
                let is_long = length_m > 0.0 && length_m <= MAX_WALL_M;
                ConfigError::require(is_long, place, "to", length_m, "0 to 1000 m from the other end")?;
                size("height_m", *height_m)?;
                size("thickness_m", *thickness_m)
            }
            Self::Gate { at, yaw_rad, width_m, height_m } => {
                spot("at", *at)?;
                angle(*yaw_rad)?;
                size("width_m", *width_m)?;
                size("height_m", *height_m)
            }
            Self::Roof { at, size_m, yaw_rad, height_m } => {
                spot("at", *at)?;
                size_m.iter().try_for_each(|&side_m| size("size_m", side_m))?;
                angle(*yaw_rad)?;
                size("height_m", *height_m)
            }
        }
    }

    /// Adds its solids, with its own place moved by `offset_m`.
    pub(super) fn place(&self, field: &HeightField, object: usize, offset_m: DVec2, solids: &mut Vec<Solid>) {
        let builder = Builder { field, object };
        let place_m = self.place_m() + offset_m;
        match *self {
            Self::Post { radius_m, height_m, .. } => {
                solids.extend(builder.post(place_m, radius_m, height_m));
            }
            Self::Box { size_m, yaw_rad, raised_m, .. } => {
                solids.extend(builder.cuboid(place_m, size_m, yaw_rad, raised_m));
            }
            Self::Rock { radius_m, sunk_m, .. } => {
                solids.extend(builder.ground_m(place_m).map(|ground_m| Solid {
                    centre_m: place_m.extend(ground_m + radius_m - sunk_m),
                    shape: Shape::Ball { radius_m },
                    object,
                    is_grounded: true,
                }));
            }
            Self::Wall { from, to, height_m, thickness_m } => {
                let (from, along) = (DVec2::from(from), DVec2::from(to) - DVec2::from(from));
                let yaw_rad = libm::atan2(along.y, along.x);
                let pieces = (along.length() / WALL_PIECE_M).ceil().max(1.0);
                let size_m = [along.length() / pieces, thickness_m, height_m];
                for piece in 0..pieces as usize {
                    let middle_m = from + along * ((piece as f64 + 0.5) / pieces);
                    solids.extend(builder.cuboid(middle_m, size_m, yaw_rad, 0.0));
                }
            }
            Self::Gate { yaw_rad, width_m, height_m, .. } => {
                let (sin, cos) = libm::sincos(yaw_rad);
                let aside = DVec2::new(-sin, cos);
                for side in [-1.0, 1.0] {
                    let post_m = place_m + aside * (side * (width_m + POST_SIDE_M) / 2.0);
                    let size_m = [POST_SIDE_M, POST_SIDE_M, height_m + POST_SIDE_M];
                    solids.extend(builder.cuboid(post_m, size_m, yaw_rad, 0.0));
                }
                let size_m = [POST_SIDE_M, width_m, POST_SIDE_M];
                solids.extend(builder.cuboid(place_m, size_m, yaw_rad, height_m));
            }
            Self::Roof { size_m, yaw_rad, height_m, .. } => {
                solids.extend(builder.cuboid(place_m, size_m, yaw_rad, height_m));
                let (sin, cos) = libm::sincos(yaw_rad);
                for (ahead, aside) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                    let (x, y) = (
                        ahead * (size_m[0] - POST_SIDE_M).max(0.0) / 2.0,
                        aside * (size_m[1] - POST_SIDE_M).max(0.0) / 2.0,
                    );
                    let post_m = place_m + DVec2::new(x * cos - y * sin, x * sin + y * cos);
                    let post_size_m = [POST_SIDE_M, POST_SIDE_M, height_m];
                    solids.extend(builder.cuboid(post_m, post_size_m, yaw_rad, 0.0));
                }
            }
        }
    }
}

/// Places shapes on the ground.
struct Builder<'a> {
    field: &'a HeightField,
    object: usize,
}

impl Builder<'_> {
    fn ground_m(&self, place_m: DVec2) -> Option<f64> {
        self.field.height_m(place_m)
    }

    /// A box whose height counts from the ground at its middle. A box without room beneath goes down to the
    /// lowest ground under its corners.
    fn cuboid(&self, place_m: DVec2, size_m: [f64; 3], yaw_rad: f64, raised_m: f64) -> Option<Solid> {
        let [length_m, width_m, height_m] = size_m;
        let (sin, cos) = libm::sincos(yaw_rad);
        let ground_m = self.ground_m(place_m)?;
        let is_grounded = raised_m <= 0.0;
        let lowest_m = if is_grounded {
            [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
                .iter()
                .filter_map(|(ahead, aside)| {
                    let (x, y) = (ahead * length_m / 2.0, aside * width_m / 2.0);
                    self.ground_m(place_m + DVec2::new(x * cos - y * sin, x * sin + y * cos))
                })
                .fold(ground_m, f64::min)
        } else {
            ground_m + raised_m
        };
        let top_m = ground_m + raised_m + height_m;
        let half_m = DVec3::new(length_m, width_m, top_m - lowest_m) / 2.0;
        Some(Solid {
            centre_m: place_m.extend((top_m + lowest_m) / 2.0),
            shape: Shape::Cuboid { half_m, sin_cos_yaw: (sin, cos) },
            object: self.object,
            is_grounded,
        })
    }

    /// An upright cylinder that goes down to the lowest ground under its rim.
    fn post(&self, place_m: DVec2, radius_m: f64, height_m: f64) -> Option<Solid> {
        let ground_m = self.ground_m(place_m)?;
        let lowest_m = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y]
            .iter()
            .filter_map(|&side| self.ground_m(place_m + side * radius_m))
            .fold(ground_m, f64::min);
        let top_m = ground_m + height_m;
        Some(Solid {
            centre_m: place_m.extend((top_m + lowest_m) / 2.0),
            shape: Shape::Cylinder { radius_m, half_height_m: (top_m - lowest_m) / 2.0 },
            object: self.object,
            is_grounded: true,
        })
    }
}

//! Solid shapes in the world: what a ray meets and what a wheel can stand on.

use glam::{DVec2, DVec3};

/// A shape, upright in the world, about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A box.
    Cuboid {
        /// Half of length, width and height, metres.
        half_m: DVec3,
        /// Sine and cosine of the direction of its length, counter-clockwise from east.
        sin_cos_yaw: (f64, f64),
    },
    /// An upright cylinder.
    Cylinder {
        /// Radius, metres.
        radius_m: f64,
        /// Half of the height, metres.
        half_height_m: f64,
    },
    /// A ball.
    Ball {
        /// Radius, metres.
        radius_m: f64,
    },
}

/// A shape at its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// World position of the centre, metres.
    pub centre_m: DVec3,
    /// The shape.
    pub shape: Shape,
    /// Index of the object that it is part of.
    pub object: usize,
    /// Whether it stands on the ground; otherwise there is room beneath.
    pub is_grounded: bool,
}

impl Solid {
    /// Radius of the ball about the centre that holds the solid, metres.
    #[must_use]
    pub fn bounding_radius_m(&self) -> f64 {
        match self.shape {
            Shape::Cuboid { half_m, .. } => half_m.length(),
            Shape::Cylinder { radius_m, half_height_m } => libm::hypot(radius_m, half_height_m),
            Shape::Ball { radius_m } => radius_m,
        }
    }

    /// World height of the highest point, metres.
    #[must_use]
    pub fn top_m(&self) -> f64 {
        let above_m = match self.shape {
            Shape::Cuboid { half_m, .. } => half_m.z,
            Shape::Cylinder { half_height_m, .. } => half_height_m,
            Shape::Ball { radius_m } => radius_m,
        };
        self.centre_m.z + above_m
    }

    /// Distance in metres from `origin` along the unit vector `direction` to the surface, at most
    /// `max_range_m`. A ray that starts inside has no return.
    #[must_use]
    pub fn cast(&self, origin: DVec3, direction: DVec3, max_range_m: f64) -> Option<f64> {
        let from = self.in_own_axes(origin - self.centre_m);
        let along = self.in_own_axes(direction);
        let enter_m = match self.shape {
            Shape::Cuboid { half_m, .. } => slabs(from, along, half_m)?,
            Shape::Cylinder { radius_m, half_height_m } => {
                let (side_in, side_out) = round(from.truncate(), along.truncate(), radius_m)?;
                let (cap_in, cap_out) = slab(from.z, along.z, half_height_m)?;
                interval(side_in.max(cap_in), side_out.min(cap_out))?
            }
            Shape::Ball { radius_m } => {
                let half_b = from.dot(along);
                let discriminant = half_b * half_b - (from.length_squared() - radius_m * radius_m);
                let half_chord = if discriminant >= 0.0 { discriminant.sqrt() } else { return None };
                interval(-half_b - half_chord, -half_b + half_chord)?
            }
        };
        (enter_m > 0.0 && enter_m <= max_range_m).then_some(enter_m)
    }

    /// The point of the solid that is nearest to `point`: the point itself if it lies inside.
    #[must_use]
    pub fn nearest(&self, point: DVec3) -> DVec3 {
        let from = self.in_own_axes(point - self.centre_m);
        let inside = match self.shape {
            Shape::Cuboid { half_m, .. } => from.clamp(-half_m, half_m),
            Shape::Cylinder { radius_m, half_height_m } => {
                let side = from.truncate().clamp_length_max(radius_m);
                side.extend(from.z.clamp(-half_height_m, half_height_m))
            }
            Shape::Ball { radius_m } => from.clamp_length_max(radius_m),
        };
        self.centre_m + self.in_world_axes(inside)
    }

    /// The point of the solid that is farthest along `direction`.
    #[must_use]
    pub fn farthest(&self, direction: DVec3) -> DVec3 {
        let along = self.in_own_axes(direction);
        let farthest = match self.shape {
            Shape::Cuboid { half_m, .. } => half_m * along.signum(),
            Shape::Cylinder { radius_m, half_height_m } => {
                let side = along.truncate().normalize_or_zero() * radius_m;
                side.extend(half_height_m * along.z.signum())
            }
            Shape::Ball { radius_m } => along.normalize_or_zero() * radius_m,
        };
        self.centre_m + self.in_world_axes(farthest)
    }

    /// World height of the top above a place seen from above, metres; `None` beside the solid.
    #[must_use]
    pub fn top_at_m(&self, place_m: DVec2) -> Option<f64> {
        let from = self.in_own_axes((place_m - self.centre_m.truncate()).extend(0.0));
        let above_m = match self.shape {
            Shape::Cuboid { half_m, .. } => {
                let is_over = from.x.abs() <= half_m.x && from.y.abs() <= half_m.y;
                is_over.then_some(half_m.z)?
            }
            Shape::Cylinder { radius_m, half_height_m } => {
                (from.length_squared() <= radius_m * radius_m).then_some(half_height_m)?
            }
            Shape::Ball { radius_m } => {
                let squared = radius_m * radius_m - from.length_squared();
                if squared >= 0.0 { squared.sqrt() } else { return None }
            }
        };
        Some(self.centre_m.z + above_m)
    }

    fn in_own_axes(&self, v: DVec3) -> DVec3 {
        match self.shape {
            Shape::Cuboid { sin_cos_yaw: (sin, cos), .. } => {
                DVec3::new(v.x * cos + v.y * sin, v.y * cos - v.x * sin, v.z)
            }
            Shape::Cylinder { .. } | Shape::Ball { .. } => v,
        }
    }

    fn in_world_axes(&self, v: DVec3) -> DVec3 {
        match self.shape {
            Shape::Cuboid { sin_cos_yaw: (sin, cos), .. } => {
                DVec3::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos, v.z)
            }
            Shape::Cylinder { .. } | Shape::Ball { .. } => v,
        }
    }
}

/// Where a ray enters an interval, if it is one.
fn interval(enter_m: f64, exit_m: f64) -> Option<f64> {
    (enter_m <= exit_m).then_some(enter_m)
}

/// Entry and exit of a ray between the planes at `-half_m` and `half_m` of one axis.
fn slab(from: f64, along: f64, half_m: f64) -> Option<(f64, f64)> {
    if along == 0.0 {
        return (from.abs() <= half_m).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (a, b) = ((-half_m - from) / along, (half_m - from) / along);
    Some((a.min(b), a.max(b)))
}

fn slabs(from: DVec3, along: DVec3, half_m: DVec3) -> Option<f64> {
    let (mut enter_m, mut exit_m) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (a, b) = slab(from[axis], along[axis], half_m[axis])?;
        (enter_m, exit_m) = (enter_m.max(a), exit_m.min(b));
    }
    interval(enter_m, exit_m)
}

/// Entry and exit of a ray, seen from above, in a circle about the origin.
fn round(from: DVec2, along: DVec2, radius_m: f64) -> Option<(f64, f64)> {
    let a = along.length_squared();
    let c = from.length_squared() - radius_m * radius_m;
    if a == 0.0 {
        return (c <= 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let half_b = from.dot(along);
    let discriminant = half_b * half_b - a * c;
    let root = if discriminant >= 0.0 { discriminant.sqrt() } else { return None };
    Some(((-half_b - root) / a, (-half_b + root) / a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn shape(kind: u8, size: DVec3, yaw_rad: f64) -> Shape {
        match kind {
            0 => Shape::Cuboid { half_m: size, sin_cos_yaw: libm::sincos(yaw_rad) },
            1 => Shape::Cylinder { radius_m: size.x, half_height_m: size.z },
            _ => Shape::Ball { radius_m: size.x },
        }
    }

    fn solid(kind: u8, size: DVec3, yaw_rad: f64) -> Solid {
        let centre_m = DVec3::new(3.0, -2.0, 1.0);
        Solid { centre_m, shape: shape(kind, size, yaw_rad), object: 0, is_grounded: true }
    }

    #[test]
    fn a_post_is_hit_where_it_stands() {
        let post = solid(1, DVec3::new(0.1, 0.1, 1.0), 0.0);
        let east = post.cast(DVec3::new(0.0, -2.0, 1.5), DVec3::X, 10.0);
        assert!((east.unwrap() - 2.9).abs() < 1e-12);
        assert_eq!(post.cast(DVec3::new(0.0, -2.0, 1.5), DVec3::X, 2.8), None);
        assert_eq!(post.cast(DVec3::new(0.0, -2.0, 2.1), DVec3::X, 10.0), None, "above its top");
        assert_eq!(post.cast(DVec3::new(0.0, -1.8, 1.5), DVec3::X, 10.0), None, "beside it");
        assert_eq!(post.cast(DVec3::new(3.0, -2.0, 1.0), DVec3::X, 10.0), None, "from inside");
        let down = post.cast(DVec3::new(3.0, -2.05, 4.0), -DVec3::Z, 10.0);
        assert!((down.unwrap() - 2.0).abs() < 1e-12, "its top");
    }

    #[test]
    fn a_turned_box_is_hit_on_its_turned_side() {
        let turned = solid(0, DVec3::new(1.0, 0.2, 0.5), std::f64::consts::FRAC_PI_2);
        let hit = turned.cast(DVec3::new(0.0, -2.0, 1.0), DVec3::X, 10.0);
        assert!((hit.unwrap() - 2.8).abs() < 1e-12);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn a_ray_meets_what_a_walk_along_it_meets(
            kind in 0u8..3, x in 0.05..1.0f64, y in 0.05..1.0f64, z in 0.05..1.0f64, yaw_rad in -3.2..3.2f64,
            from in prop::array::uniform3(-4.0..4.0f64), to in prop::array::uniform3(-1.2..1.2f64),
        ) {
            let solid = solid(kind, DVec3::new(x, y, z), yaw_rad);
            let origin = solid.centre_m + DVec3::from(from);
            let direction = (DVec3::from(to) - DVec3::from(from)).normalize();
            let inside = |t: f64| {
                let point = origin + direction * t;
                solid.nearest(point).distance(point) < 1e-9
            };
            prop_assume!(!inside(0.0));
            let walked = (1..2400).map(|step| f64::from(step) * 0.005).find(|&t| inside(t));
            match (solid.cast(origin, direction, 12.0), walked) {
                (Some(hit), Some(walked)) => prop_assert!(hit <= walked + 1e-9 && walked - hit < 0.0051),
                // A walk may step over a corner, a ray does not.
                (Some(hit), None) => prop_assert!(!inside(hit - 1e-6) && inside(hit + 1e-9) || !inside(hit + 0.01)),
                (None, walked) => prop_assert_eq!(walked, None),
            }
        }

        #[test]
        fn nothing_in_the_solid_is_nearer_or_farther_along(
            kind in 0u8..3, x in 0.05..1.0f64, y in 0.05..1.0f64, z in 0.05..1.0f64, yaw_rad in -3.2..3.2f64,
            from in prop::array::uniform3(-3.0..3.0f64), other in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let solid = solid(kind, DVec3::new(x, y, z), yaw_rad);
            let point = solid.centre_m + DVec3::from(from);
            let nearest = solid.nearest(point);
            let within = solid.nearest(solid.centre_m + DVec3::from(other));
            prop_assert!(solid.nearest(nearest).distance(nearest) < 1e-9, "it lies in the solid");
            prop_assert!(point.distance(nearest) <= point.distance(within) + 1e-9);
            let along = DVec3::from(from);
            let farthest = solid.farthest(along);
            prop_assert!(solid.nearest(farthest).distance(farthest) < 1e-9, "it lies in the solid");
            prop_assert!(within.dot(along) <= farthest.dot(along) + 1e-9);
        }

        #[test]
        fn the_top_is_where_a_ray_from_above_meets_it(
            kind in 0u8..3, x in 0.05..1.0f64, y in 0.05..1.0f64, z in 0.05..1.0f64, yaw_rad in -3.2..3.2f64,
            east in -1.2..1.2f64, north in -1.2..1.2f64,
        ) {
            let solid = solid(kind, DVec3::new(x, y, z), yaw_rad);
            let place_m = solid.centre_m.truncate() + DVec2::new(east, north);
            let hit = solid.cast(place_m.extend(9.0), -DVec3::Z, 20.0).map(|range_m| 9.0 - range_m);
            match (solid.top_at_m(place_m), hit) {
                (Some(top_m), Some(hit_m)) => prop_assert!((top_m - hit_m).abs() < 1e-9),
                (top, hit) => prop_assert_eq!(top.is_some(), hit.is_some()),
            }
        }
    }
}

//! Boxes that a robot's body is made of, and where they touch a solid.

use crate::objects::Solid;
use glam::{DMat3, DVec3};

/// A box fixed to the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    /// Centre in the robot frame, metres.
    pub(super) centre_m: DVec3,
    /// Half of its length, width and height, metres.
    pub(super) half_m: DVec3,
}

/// Two shapes this near to each other touch, metres.
const TOUCH_M: f64 = 1e-3;
/// Shapes that graze each other by less than a millimetre may take more; they are then apart.
const ROUNDS: usize = 200;

impl Part {
    /// A point of the solid that the part touches, with the robot's origin and rotation in the world; `None`
    /// if they are apart.
    ///
    /// Points of two convex shapes are brought together by reflecting at one and the other in turn (Douglas
    /// and Rachford 1956; for convex sets Bauschke, Combettes and Luke 2004,
    /// <https://doi.org/10.1016/j.jat.2004.02.006>), until they meet or a plane lies between the shapes.
    pub(super) fn touches(&self, origin_m: DVec3, rotation: &DMat3, solid: &Solid) -> Option<DVec3> {
        let centre_m = origin_m + *rotation * self.centre_m;
        let reach_m = self.half_m.length() + solid.bounding_radius_m();
        if centre_m.distance_squared(solid.centre_m) > reach_m * reach_m {
            return None;
        }
        let mut point_m = centre_m;
        for _ in 0..ROUNDS {
            let own_m = centre_m + *rotation * self.clamped(rotation.transpose() * (point_m - centre_m));
            let solid_m = solid.nearest(2.0 * own_m - point_m);
            let gap_m = solid_m - own_m;
            if gap_m.length() < TOUCH_M {
                return Some(solid_m);
            }
            let farthest_m = centre_m + *rotation * self.farthest(rotation.transpose() * gap_m);
            if gap_m.dot(solid.farthest(-gap_m) - farthest_m) > 0.0 {
                return None;
            }
            point_m += gap_m;
        }
        None
    }

    fn clamped(&self, own_m: DVec3) -> DVec3 {
        own_m.clamp(-self.half_m, self.half_m)
    }

    /// The point that is farthest along a direction, both in the part's own frame.
    fn farthest(&self, direction: DVec3) -> DVec3 {
        self.half_m * direction.signum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attitude::{Attitude, world_from_body};
    use crate::objects::Shape;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        /// Samples of the part are near the solid if they touch, and none lies a centimetre deep in it if
        /// they do not.
        #[test]
        fn touches_what_a_sampled_box_touches(
            kind in 0u8..3, size in prop::array::uniform3(0.05..0.6f64), yaw_rad in -3.2..3.2f64,
            place in prop::array::uniform3(-1.2..1.2f64), half in prop::array::uniform3(0.1..0.6f64),
            roll_rad in -0.6..0.6f64, pitch_rad in -0.8..0.8f64, heading_rad in -3.2..3.2f64,
        ) {
            let solid = |less_m: f64| {
                let size = size.map(|side_m| side_m - less_m);
                let shape = match kind {
                    0 => Shape::Cuboid { half_m: size.into(), sin_cos_yaw: libm::sincos(yaw_rad) },
                    1 => Shape::Cylinder { radius_m: size[0], half_height_m: size[2] },
                    _ => Shape::Ball { radius_m: size[0] },
                };
                Solid { centre_m: place.into(), shape, object: 0, is_grounded: true }
            };
            let (solid, core) = (solid(0.0), solid(0.01));
            let part = Part { centre_m: DVec3::new(0.1, 0.0, 0.2), half_m: half.into() };
            let rotation = world_from_body(heading_rad, &Attitude { height_m: 0.0, roll_rad, pitch_rad });
            let found = part.touches(DVec3::ZERO, &rotation, &solid);
            let steps = || (0..=24).map(|step| f64::from(step) / 12.0 - 1.0);
            let (mut least_m, mut is_deep) = (f64::INFINITY, false);
            for x in steps() {
                for y in steps() {
                    for z in steps() {
                        let point = rotation * (part.centre_m + part.half_m * DVec3::new(x, y, z));
                        least_m = least_m.min(solid.nearest(point).distance(point));
                        is_deep |= core.nearest(point).distance(point) < 1e-9;
                    }
                }
            }
            // Neighbouring samples are at most this far from any point between them.
            let spacing_m = part.half_m.length() / 12.0;
            match found {
                Some(point) => {
                    prop_assert!(least_m <= spacing_m, "{least_m}");
                    prop_assert!(solid.nearest(point).distance(point) < 1e-9);
                }
                None => prop_assert!(!is_deep),
            }
        }
    }
}

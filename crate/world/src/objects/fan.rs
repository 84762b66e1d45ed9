//! The solids that the beams of one azimuth may meet.

use super::solid::Solid;
use crate::caster::Fan;
use crate::sensor_pose::SensorPose;
use glam::DVec3;

/// A sensor moves less than this in a sweep.
const SWEEP_M: f64 = 1.0;
/// The solids about a plane serve for fans turned by no more than this, as a distance of unit vectors: some
/// sixteen columns of 0.2°.
const TURN: f64 = 0.06;
/// And for fans from no farther away than this, metres.
const MOVE_M: f64 = 0.05;
/// What rounding may add to a distance, metres.
const SLACK_M: f64 = 1e-6;

/// The solids within reach of a sensor, narrowed down for one fan after the other.
pub(crate) struct NearSolids<'a> {
    near: Vec<Near<'a>>,
    /// Origin, `ahead` and `aside` of the fan about whose plane the solids were looked for last.
    about: Option<[DVec3; 3]>,
    about_plane: Vec<Near<'a>>,
    in_plane: Vec<InPlane<'a>>,
}

/// A solid with the radius of the ball that holds it.
#[derive(Clone, Copy)]
struct Near<'a> {
    radius_m: f64,
    solid: &'a Solid,
}

/// A solid in the plane of a fan, with the place of its centre in that plane.
struct InPlane<'a> {
    radius_m: f64,
    ahead_m: f64,
    up_m: f64,
    solid: &'a Solid,
}

impl<'a> NearSolids<'a> {
    /// Those within reach of a sensor whose sweep ends at `pose`.
    pub(crate) fn new(solids: &'a [Solid], pose: &SensorPose, reach_m: f64) -> Self {
        let near = solids
            .iter()
            .map(|solid| Near { radius_m: solid.bounding_radius_m(), solid })
            .filter(|near| near.solid.centre_m.distance(pose.position) - near.radius_m <= reach_m + SWEEP_M)
            .collect();
        Self { near, about: None, about_plane: Vec::new(), in_plane: Vec::new() }
    }

    /// Goes on to the fan from `pose`.
    pub(crate) fn turn_to(&mut self, pose: &SensorPose, fan: &Fan<'_>) {
        let (origin, ahead, aside, up) = (pose.position, fan.ahead(), fan.aside(), fan.up());
        let is_close = self.about.is_some_and(|[about_origin, about_ahead, about_aside]| {
            origin.distance_squared(about_origin) <= MOVE_M * MOVE_M
                && ahead.distance_squared(about_ahead) <= TURN * TURN
                && aside.distance_squared(about_aside) <= TURN * TURN
        });
        if !is_close {
            self.about = Some([origin, ahead, aside]);
            self.about_plane.clear();
            self.about_plane.extend(self.near.iter().filter(|near| {
                let offset_m = near.solid.centre_m - origin;
                // The most by which a component of the offset differs in another fan that is close.
                let slack_m = MOVE_M + TURN * (offset_m.length() + MOVE_M) + SLACK_M;
                let reach_m = near.radius_m + slack_m;
                offset_m.dot(aside).abs() <= reach_m && offset_m.dot(ahead) >= -reach_m
            }));
        }
        self.in_plane.clear();
        self.in_plane.extend(self.about_plane.iter().filter_map(|&Near { radius_m, solid }| {
            let offset_m = solid.centre_m - origin;
            let ahead_m = offset_m.dot(ahead);
            let is_in_plane = offset_m.dot(aside).abs() <= radius_m && ahead_m >= -radius_m;
            is_in_plane.then(|| InPlane { radius_m, ahead_m, up_m: offset_m.dot(up), solid })
        }));
    }

    /// Distance in metres to the first of these solids in the fan from `pose`, at the elevation with this
    /// sine and cosine.
    pub(crate) fn cast(
        &self,
        pose: &SensorPose,
        fan: &Fan<'_>,
        sin_elevation: f64,
        cos_elevation: f64,
        max_range_m: f64,
    ) -> Option<f64> {
        let mut first_m = None;
        for InPlane { radius_m, ahead_m, up_m, solid } in &self.in_plane {
            let beside_m = (ahead_m * sin_elevation - up_m * cos_elevation).abs();
            if beside_m <= radius_m + SLACK_M {
                let direction = fan.direction(sin_elevation, cos_elevation);
                first_m = solid.cast(pose.position, direction, first_m.unwrap_or(max_range_m)).or(first_m);
            }
        }
        first_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attitude::{Attitude, world_from_body};
    use crate::caster::Caster;
    use crate::height_field::HeightField;
    use crate::objects::Shape;
    use proptest::prelude::*;

    const COLUMNS: u32 = 90;

    fn solid(object: usize, [x, y, z]: [f64; 3], size: [f64; 3], kind: u8) -> Solid {
        let shape = match kind {
            0 => Shape::Cuboid { half_m: size.into(), sin_cos_yaw: libm::sincos(size[0] * 9.0) },
            1 => Shape::Cylinder { radius_m: size[0], half_height_m: size[2] },
            _ => Shape::Ball { radius_m: size[0] },
        };
        Solid { centre_m: DVec3::new(x, y, z), shape, object, is_grounded: true }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        /// In a sweep of some and of many columns to a turn, and however fast the sensor turns and moves.
        #[test]
        fn a_moving_sensor_misses_no_solid(
            places in prop::collection::vec(prop::array::uniform3(-8.0..8.0f64), 12),
            sizes in prop::collection::vec(prop::array::uniform3(0.05..1.5f64), 12),
            step_rad in 0.001..0.1f64, turn_rad in -0.5..0.5f64, tilt_rad in -0.5..0.5f64,
            moved in prop::array::uniform3(-0.5..0.5f64),
        ) {
            let caster = Caster::new(HeightField::new(2, 2, 1.0, vec![-99.0; 4]).unwrap());
            let solids: Vec<Solid> = (0..12).map(|k| solid(k, places[k], sizes[k], k as u8 % 3)).collect();
            let pose = |share: f64| SensorPose {
                position: DVec3::from(moved) * share,
                world_from_sensor: world_from_body(
                    turn_rad * share,
                    &Attitude { height_m: 0.0, roll_rad: tilt_rad, pitch_rad: tilt_rad * share },
                ),
            };
            let mut near = NearSolids::new(&solids, &pose(1.0), 10.0);
            for column in 0..COLUMNS {
                let pose = pose(f64::from(column + 1) / f64::from(COLUMNS));
                let (sin_azimuth, cos_azimuth) = libm::sincos(step_rad * f64::from(column));
                let fan = Fan::new(&caster, &pose, sin_azimuth, cos_azimuth);
                near.turn_to(&pose, &fan);
                for degrees in (-45..=45).step_by(3) {
                    let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
                    let hits = solids
                        .iter()
                        .filter_map(|solid| solid.cast(pose.position, fan.direction(sin, cos), 10.0));
                    let nearest = hits.reduce(f64::min);
                    prop_assert_eq!(near.cast(&pose, &fan, sin, cos, 10.0), nearest);
                }
            }
        }
    }
}

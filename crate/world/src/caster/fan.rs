//! Rays of one azimuth, from the lowest elevation to the highest.

use super::{Caster, Trace};
use crate::sensor_pose::SensorPose;
use glam::DVec3;

/// The rays of a sensor at one azimuth, cast in ascending order of elevation.
///
/// In the plane of these rays, ground above a lower ray would have to reach down to it, unless the ground is
/// steeper than the sensor's downward axis. So a ray is free at least as far as the ray below it, and only
/// the rest needs to be walked: a whole fan costs little more than one ray along its skyline. On ground too
/// steep for this, and with a sensor beside the terrain, every ray is walked from its origin.
#[derive(Clone)]
pub(crate) struct Fan<'a> {
    caster: &'a Caster,
    origin: DVec3,
    ahead: DVec3,
    up: DVec3,
    can_skip: bool,
    /// How far the rays so far are free, measured along `ahead`, in metres.
    free_m: f64,
}

/// What rounding may have added to the range of the ray below, in metres.
const SLACK_M: f64 = 1e-6;

impl<'a> Fan<'a> {
    /// The fan at the azimuth with this sine and cosine in the sensor frame.
    pub(crate) fn new(caster: &'a Caster, pose: &SensorPose, sin_azimuth: f64, cos_azimuth: f64) -> Self {
        let frame = &pose.world_from_sensor;
        let up = frame.z_axis;
        let ahead = frame.x_axis * cos_azimuth + frame.y_axis * sin_azimuth;
        let is_gentle = up.z > caster.pyramid.steepest() * up.truncate().length();
        let is_finite = pose.position.is_finite() && ahead.is_finite() && up.is_finite();
        Self {
            caster,
            origin: pose.position,
            ahead,
            up,
            can_skip: !is_finite || is_gentle && caster.field.contains(pose.position.truncate()),
            // Rays with a non-finite pose meet nothing.
            free_m: if is_finite { 0.0 } else { f64::INFINITY },
        }
    }

    /// Unit vector of the fan's plane at elevation 0.
    pub(crate) fn ahead(&self) -> DVec3 {
        self.ahead
    }

    /// Unit vector across the fan's plane.
    pub(crate) fn aside(&self) -> DVec3 {
        self.up.cross(self.ahead)
    }

    /// Unit vector up in the fan's plane.
    pub(crate) fn up(&self) -> DVec3 {
        self.up
    }

    /// Unit vector of the beam at the elevation with this sine and cosine.
    pub(crate) fn direction(&self, sin_elevation: f64, cos_elevation: f64) -> DVec3 {
        self.ahead * cos_elevation + self.up * sin_elevation
    }

    /// Range in metres to the ground at the elevation with this sine and cosine, which must not be lower than
    /// the one before; see [`Caster::cast`].
    pub(crate) fn cast(&mut self, sin_elevation: f64, cos_elevation: f64, max_range_m: f64) -> Option<f64> {
        let direction = self.direction(sin_elevation, cos_elevation);
        let begin_m = if self.can_skip { (self.free_m / cos_elevation - SLACK_M).max(0.0) } else { 0.0 };
        if begin_m >= max_range_m || max_range_m.is_nan() {
            return None;
        }
        let (range_m, free_m) = match self.caster.trace(self.origin, direction, begin_m, max_range_m) {
            Trace::Ground(range_m) => (Some(range_m), range_m),
            Trace::Nothing(free_m) => (None, free_m),
        };
        self.free_m = self.free_m.max(free_m * cos_elevation);
        range_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attitude::{Attitude, world_from_body};
    use crate::height_field::HeightField;
    use glam::DVec2;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        #[test]
        fn sees_what_single_rays_see(
            heights in prop::collection::vec(-1.0f32..1.0, 30 * 30), relief in 0.0..1.0f32,
            x in 0.0..1.0f64, y in 0.0..1.0f64, above_m in 0.01..1.5f64,
            azimuth_rad in -3.2..3.2f64, yaw_rad in -3.2..3.2f64, roll_rad in -0.6..0.6f64, pitch_rad in -0.8..0.8f64,
        ) {
            let heights = heights.iter().map(|height| height * relief).collect();
            let field = HeightField::new(30, 30, 0.5, heights).unwrap();
            let at = DVec2::new(x, y) * field.extent_m();
            let position = at.extend(field.height_m(at).unwrap() + above_m);
            let world_from_sensor = world_from_body(yaw_rad, &Attitude { height_m: 0.0, roll_rad, pitch_rad });
            let caster = Caster::new(field);
            let (sin_azimuth, cos_azimuth) = libm::sincos(azimuth_rad);
            let mut fan = Fan::new(&caster, &SensorPose { position, world_from_sensor }, sin_azimuth, cos_azimuth);
            for degrees in -15..=15 {
                let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
                let beam = DVec3::new(cos * cos_azimuth, cos * sin_azimuth, sin);
                let alone = caster.cast(position, world_from_sensor * beam, 12.0);
                match (fan.cast(sin, cos, 12.0), alone) {
                    (Some(found), Some(alone)) => prop_assert!((found - alone).abs() < 1e-9, "{found} {alone}"),
                    (found, alone) => prop_assert_eq!(found, alone, "{}°", degrees),
                }
            }
        }
    }
}

//! The solids that the beams of one azimuth may meet.

use super::solid::Solid;
use crate::caster::Fan;
use crate::sensor_pose::SensorPose;
use glam::DVec3;

/// The solids within reach of a sensor.
pub(crate) struct NearSolids<'a> {
    origin: DVec3,
    /// With the offset of the centre from the sensor and the bounding radius, metres.
    near: Vec<(DVec3, f64, &'a Solid)>,
}

impl<'a> NearSolids<'a> {
    pub(crate) fn new(solids: &'a [Solid], pose: &SensorPose, reach_m: f64) -> Self {
        let origin = pose.position;
        let near = solids
            .iter()
            .map(|solid| (solid.centre_m - origin, solid.bounding_radius_m(), solid))
            .filter(|(offset_m, radius_m, _)| offset_m.length() - radius_m <= reach_m)
            .collect();
        Self { origin, near }
    }

    /// Finds those that the beams of a fan may meet.
    pub(crate) fn in_plane(&self, fan: &Fan<'_>, found: &mut Vec<&'a Solid>) {
        let (ahead, aside) = (fan.ahead(), fan.aside());
        found.clear();
        found.extend(self.near.iter().filter_map(|&(offset_m, radius_m, solid)| {
            (offset_m.dot(aside).abs() <= radius_m && offset_m.dot(ahead) >= -radius_m).then_some(solid)
        }));
    }

    /// Distance in metres to the first of these solids along the unit vector `direction`.
    pub(crate) fn cast(&self, solids: &[&Solid], direction: DVec3, max_range_m: f64) -> Option<f64> {
        solids.iter().fold(None, |first_m: Option<f64>, solid| {
            solid.cast(self.origin, direction, first_m.unwrap_or(max_range_m)).or(first_m)
        })
    }
}

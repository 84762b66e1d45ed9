//! The solids that the beams of one azimuth may meet.

use super::solid::Solid;
use crate::caster::Fan;
use crate::sensor_pose::SensorPose;
use glam::DVec3;

/// A sensor moves less than this in a sweep.
const SWEEP_M: f64 = 1.0;

/// The solids within reach of a sensor.
pub(crate) struct NearSolids<'a> {
    /// With the bounding radius, metres.
    near: Vec<(f64, &'a Solid)>,
}

impl<'a> NearSolids<'a> {
    /// Those within reach of a sensor whose sweep ends at `pose`.
    pub(crate) fn new(solids: &'a [Solid], pose: &SensorPose, reach_m: f64) -> Self {
        let near = solids
            .iter()
            .map(|solid| (solid.bounding_radius_m(), solid))
            .filter(|(radius_m, solid)| {
                solid.centre_m.distance(pose.position) - radius_m <= reach_m + SWEEP_M
            })
            .collect();
        Self { near }
    }

    /// Finds those that the beams of a fan from `pose` may meet.
    pub(crate) fn in_plane(&self, pose: &SensorPose, fan: &Fan<'_>, found: &mut Vec<&'a Solid>) {
        let (ahead, aside) = (fan.ahead(), fan.aside());
        found.clear();
        found.extend(self.near.iter().filter_map(|&(radius_m, solid)| {
            let offset_m = solid.centre_m - pose.position;
            (offset_m.dot(aside).abs() <= radius_m && offset_m.dot(ahead) >= -radius_m).then_some(solid)
        }));
    }

    /// Distance in metres to the first of these solids from `pose` along the unit vector `direction`.
    pub(crate) fn cast(
        solids: &[&Solid],
        pose: &SensorPose,
        direction: DVec3,
        max_range_m: f64,
    ) -> Option<f64> {
        solids.iter().fold(None, |first_m: Option<f64>, solid| {
            solid.cast(pose.position, direction, first_m.unwrap_or(max_range_m)).or(first_m)
        })
    }
}

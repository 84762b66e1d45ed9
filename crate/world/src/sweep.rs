//! Points of a revolution that were fired one column after the other.

use crate::lidar::Scan;
use crate::sensor_pose::SensorPose;

/// Moves the points of `scan`, which has `rings` rings and no points but its returns, from the sensor's pose
/// when their column was fired to that at `end`. `fired_from` gives the pose for the share of the revolution
/// that had passed, from above 0 to 1.
pub fn compensate(scan: &mut Scan, rings: usize, end: &SensorPose, fired_from: impl Fn(f64) -> SensorPose) {
    let columns = scan.ranges_m.len() / rings.max(1);
    let end_from_world = end.world_from_sensor.transpose();
    let mut points = scan.points.iter_mut();
    for (column, ranges_m) in scan.ranges_m.chunks(rings.max(1)).enumerate() {
        let returns = ranges_m.iter().filter(|range_m| !range_m.is_nan()).count();
        let fired = fired_from((column + 1) as f64 / columns as f64);
        let turn = end_from_world * fired.world_from_sensor;
        let shift = end_from_world * (fired.position - end.position);
        for point in points.by_ref().take(returns) {
            *point = (turn * point.as_dvec3() + shift).as_vec3();
        }
    }
}

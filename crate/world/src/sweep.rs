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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attitude::Attitude;
    use crate::caster::Caster;
    use crate::height_field::HeightField;
    use crate::lidar::{Lidar, Scene, SensorConfig};
    use glam::DVec2;

    const PERIOD_S: f64 = 0.1;

    /// A sensor that drives ahead, turns and nods over a sweep that ends at (50, 50).
    fn pose(config: &SensorConfig, share: f64) -> SensorPose {
        let ago_s = PERIOD_S * (1.0 - share);
        let attitude = Attitude { height_m: 1.0, roll_rad: 0.1 * ago_s, pitch_rad: 0.05 - 0.3 * ago_s };
        config.pose_on(DVec2::new(50.0 - 0.8 * ago_s, 50.0), 0.4 - 0.9 * ago_s, &attitude)
    }

    fn bowl() -> Caster {
        let height = |i: u32| {
            let (x, y) = (f64::from(i % 201) - 100.0, f64::from(i / 201) - 100.0);
            (0.0004 * (x * x + 2.0 * y * y)) as f32
        };
        Caster::new(HeightField::new(201, 201, 0.5, (0..201 * 201).map(height).collect()).unwrap())
    }

    /// Largest height of the points over the ground, taken to be in the frame of the sweep's end.
    fn worst_m(caster: &Caster, config: &SensorConfig, scan: &Scan) -> f64 {
        let end = pose(config, 1.0);
        let above = scan.points.iter().map(|point| {
            let world = end.position + end.world_from_sensor * point.as_dvec3();
            (world.z - caster.field().height_m(world.truncate()).unwrap()).abs()
        });
        above.fold(0.0, f64::max)
    }

    #[test]
    fn a_sweep_bends_the_ground_and_the_exact_motion_mends_it() {
        let config = SensorConfig { range_noise_m: 0.0, max_range_m: 20.0, ..SensorConfig::default() };
        let (caster, sensor) = (bowl(), Lidar::new(config.clone()).unwrap());
        let (mut swept, mut still) = (Scan::default(), Scan::default());
        sensor.scan_along(20.0, &Scene::bare(&caster), |share| pose(&config, share), 1, 2, &mut swept);
        sensor.scan(&caster, &pose(&config, 1.0), 1, 2, &mut still);
        assert!(worst_m(&caster, &config, &still) < 1e-3);
        // The first column looks back, 0.1 s early: nodding by 0.03 rad lifts what is some 9 m away.
        assert!(worst_m(&caster, &config, &swept) > 0.2);
        // The last column is fired at the end.
        let rings = config.rings;
        let last = swept.ranges_m.len() - rings;
        assert!(
            swept.ranges_m[last..]
                .iter()
                .zip(&still.ranges_m[last..])
                .all(|(a, b)| a.to_bits() == b.to_bits())
        );
        compensate(&mut swept, rings, &pose(&config, 1.0), |share| pose(&config, share));
        assert!(worst_m(&caster, &config, &swept) < 1e-3);
    }

    #[test]
    fn points_are_off_by_the_way_since_they_were_fired() {
        // Level ground, a sensor that only drives: every point is off by the way since its column was fired.
        let flat = Caster::new(HeightField::new(201, 201, 0.5, vec![0.0; 201 * 201]).unwrap());
        let config = SensorConfig { range_noise_m: 0.0, ..SensorConfig::default() };
        let drives = |share: f64| {
            let attitude = Attitude::default();
            config.pose_on(DVec2::new(50.0 - 0.8 * PERIOD_S * (1.0 - share), 50.0), 0.0, &attitude)
        };
        let sensor = Lidar::new(config.clone()).unwrap();
        let mut swept = Scan::default();
        sensor.scan_along(f64::INFINITY, &Scene::bare(&flat), drives, 1, 2, &mut swept);
        let raw = swept.points.clone();
        compensate(&mut swept, config.rings, &drives(1.0), drives);
        let shifts: Vec<f32> = raw.iter().zip(&swept.points).map(|(raw, moved)| raw.x - moved.x).collect();
        assert!((shifts[0] - 0.08).abs() < 1e-4, "{}", shifts[0]);
        assert!(
            shifts.windows(2).all(|pair| pair[1] <= pair[0] + 1e-5) && shifts.last().unwrap().abs() < 1e-6
        );
    }
}

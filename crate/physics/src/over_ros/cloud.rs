//! A scan as a Velodyne's driver publishes it: with the time of each point.

use std::f64::consts::{PI, TAU};

use glam::Vec3;
use mapless_node::messages::{Header, PointCloud2, Time, cloud_of_floats};
use mapless_world::SensorConfig;

/// The points of a sweep that ended at `stamp`; their times are seconds since then.
pub(crate) fn cloud(points_m: &[Vec3], sensor: &SensorConfig, stamp: Time) -> PointCloud2 {
    let columns = sensor.columns as f64;
    let points: Vec<[f32; 4]> = points_m
        .iter()
        .map(|point_m| {
            // The azimuth tells the column, and column k was fired a share (k + 1) / columns after the begin.
            let azimuth_rad = libm::atan2(f64::from(point_m.y), f64::from(point_m.x));
            let column = ((azimuth_rad + PI) / TAU * columns).round().rem_euclid(columns);
            let time_s = sensor.period_s * ((column + 1.0) / columns - 1.0);
            [point_m.x, point_m.y, point_m.z, time_s as f32]
        })
        .collect();
    let header = Header { stamp, frame_id: "lidar3d_0_laser".to_owned() };
    cloud_of_floats(header, ["x", "y", "z", "time"], 1, &points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use mapless_world::{Attitude, Caster, HeightField, Lidar, Scan, Scene};

    #[test]
    fn times_are_those_at_which_the_world_fires() {
        let flat = Caster::new(HeightField::new(201, 201, 0.5, vec![0.0; 201 * 201]).unwrap());
        let config = SensorConfig { range_noise_m: 0.0, ..SensorConfig::default() };
        // A sensor that drives ahead: where a point is tells from where it was fired.
        let pose =
            |share: f64| config.pose_on(DVec2::new(50.0 + 4.0 * share, 50.0), 0.0, &Attitude::default());
        let (mut swept, mut still) = (Scan::default(), Scan::default());
        let lidar = Lidar::new(config.clone()).unwrap();
        lidar.scan_along(f64::INFINITY, &Scene::bare(&flat), pose, 1, 1, &mut swept);
        lidar.scan(&flat, &pose(1.0), 1, 1, &mut still);
        let told = cloud(&swept.points, &config, Time::default());
        assert_eq!((told.width as usize, told.point_step), (swept.points.len(), 16));
        let time_s = |index: usize| {
            let at = 16 * index + 12;
            f64::from(f32::from_le_bytes(told.data[at..at + 4].try_into().unwrap()))
        };
        let mut index = 0;
        for (beam, range_m) in swept.ranges_m.iter().enumerate() {
            if !range_m.is_nan() {
                let share = (beam / config.rings + 1) as f64 / config.columns as f64;
                assert!((time_s(index) - 0.1 * (share - 1.0)).abs() < 1e-7, "beam {beam}");
                index += 1;
            }
        }
    }
}

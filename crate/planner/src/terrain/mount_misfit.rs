//! Whether the ground in a scan fits the mount of the sensor.

use core::fmt;

use glam::{DVec2, DVec3, Vec3};

use crate::sensor_model::SensorModel;
use crate::terrain::plane::Plane;

/// Ground within this many of the sensor's heights, but at least so far, is taken for one plane.
const NEAR_HEIGHTS: f64 = 9.0;
const NEAR_M: f64 = 7.0;
/// Returns this near to a plane belong to it.
const INLIER_M: f64 = 0.15;
const ROUNDS: usize = 12;
/// Fewer returns, or a smaller share of them on one plane, say nothing.
const FEWEST_RETURNS: usize = 100;
const LEAST_SHARE: f64 = 0.6;
/// The mount does not fit if the ground is farther off than this.
const HEIGHT_M: f64 = 0.25;
const TILT_RAD: f64 = 0.14;

/// The plane of the ground in a scan, which the mount does not explain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MountMisfit {
    /// Height of the sensor above the plane, metres; negative if the plane is above it.
    pub height_m: f64,
    /// Tilt of the plane against the level ground that the mount says, radians.
    pub tilt_rad: f64,
    /// Height that the mount says, metres.
    pub told_height_m: f64,
}

impl MountMisfit {
    /// The misfit of a scan in the sensor frame, metres, of a robot on level ground; `None` if the mount
    /// fits, or if no plane holds most of the scan.
    pub fn of(points_m: &[Vec3], sensor: &SensorModel) -> Option<Self> {
        let rotation = sensor.robot_from_sensor();
        let reach_m = (NEAR_HEIGHTS * sensor.height_m).max(NEAR_M);
        let near_m: Vec<DVec3> = points_m
            .iter()
            .map(|point_m| point_m.as_dvec3())
            .filter(|point_m| (sensor.min_range_m..=reach_m).contains(&point_m.length()))
            .map(|point_m| rotation.map_or(point_m, |rotation| rotation * point_m))
            .collect();
        if near_m.len() < FEWEST_RETURNS {
            return None;
        }
        let fit = |points_m: &[DVec3]| Plane::fit(DVec2::ZERO, points_m, 1.0);
        let mut plane = fit(&near_m)?;
        let mut on_plane = near_m.clone();
        for round in 0..ROUNDS {
            // From coarse to fine.
            let within_m = INLIER_M * f64::from(1 << (ROUNDS - 1 - round).min(3) as u32);
            let is_on = |point_m: &DVec3| {
                (point_m.z - plane.height_m - plane.gradient.dot(point_m.truncate())).abs() < within_m
            };
            on_plane = near_m.iter().copied().filter(is_on).collect();
            plane = fit(&on_plane)?;
        }
        let misfit = Self {
            height_m: -plane.height_m / (1.0 + plane.gradient.length_squared()).sqrt(),
            tilt_rad: libm::atan(plane.gradient.length()),
            told_height_m: sensor.height_m,
        };
        let is_ground = on_plane.len() as f64 >= LEAST_SHARE * near_m.len() as f64;
        let fits = (misfit.height_m - sensor.height_m).abs() <= HEIGHT_M && misfit.tilt_rad <= TILT_RAD;
        (is_ground && !fits).then_some(misfit)
    }
}

impl fmt::Display for MountMisfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { height_m, tilt_rad, told_height_m } = *self;
        if height_m < 0.0 {
            return write!(
                f,
                "the ground in this scan lies {:.2} m above the sensor: upside down? Set sensor.roll_rad",
                -height_m
            );
        }
        write!(
            f,
            "the ground in this scan lies {height_m:.2} m below the sensor and is tilted by {:.0}°, where the mount \
             says {told_height_m:.2} m and level: set sensor.height_m, roll_rad and pitch_rad",
            tilt_rad.to_degrees()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    /// The scan of level ground with undulations, by a sensor with this mount.
    fn scan(mount: &SensorModel) -> Vec<Vec3> {
        let robot_from_sensor = mount.robot_from_sensor();
        let mut points_m = Vec::new();
        for i in -60..=60 {
            for j in -60..=60 {
                let place_m = 0.1 * DVec2::new(f64::from(i), f64::from(j));
                let height_m = 0.1 * libm::sin(place_m.x) * libm::cos(place_m.y) - mount.height_m;
                let along_robot_m = place_m.extend(height_m);
                let point_m =
                    robot_from_sensor.map_or(along_robot_m, |turned| turned.transpose() * along_robot_m);
                points_m.push(point_m.as_vec3());
            }
        }
        points_m
    }

    #[test]
    fn the_mount_that_was_told_fits_and_another_one_does_not() {
        let vlp16 = SensorModel::vlp16();
        let mounts = [
            vlp16,
            SensorModel { height_m: 1.73, ..vlp16 },
            SensorModel { pitch_rad: -0.26, ..vlp16 },
            SensorModel { roll_rad: PI, ..vlp16 },
        ];
        for (told, mount) in mounts.iter().enumerate() {
            for (real, other) in mounts.iter().enumerate() {
                let misfit = MountMisfit::of(&scan(other), mount);
                assert_eq!(misfit.is_some(), told != real, "{told} {real} {misfit:?}");
            }
        }
        let found = MountMisfit::of(&scan(&mounts[1]), &vlp16).unwrap();
        assert!((found.height_m - 1.73).abs() < 0.05 && found.tilt_rad < 0.05, "{found:?}");
        let message = MountMisfit::of(&scan(&mounts[3]), &vlp16).unwrap().to_string();
        assert!(message.contains("0.80 m above the sensor: upside down?"), "{message}");
    }

    #[test]
    fn walls_and_few_returns_say_nothing() {
        let vlp16 = SensorModel::vlp16();
        assert_eq!(MountMisfit::of(&[Vec3::new(1.0, 0.0, 2.0); 50], &vlp16), None);
        let wall: Vec<Vec3> = (0..4000)
            .map(|i| Vec3::new(3.0, (i % 60) as f32 * 0.1 - 3.0, (i / 60) as f32 * 0.06 - 2.0))
            .collect();
        assert_eq!(MountMisfit::of(&wall, &vlp16), None);
    }
}

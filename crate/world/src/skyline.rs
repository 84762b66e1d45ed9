//! The true elevation profile of the ground around a sensor, the reference for perception.

use crate::caster::{Caster, Fan};
use crate::sensor_pose::SensorPose;
use std::f64::consts::PI;

/// The true skyline at one azimuth: what infinitely dense beams would show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Skyline {
    /// No ground within the radius at any elevation of the sensor: a crest or a drop.
    Unknown,
    /// The highest elevation in the sensor frame, in radians, at which there is ground within the radius.
    Ground {
        /// That elevation.
        elevation_rad: f64,
    },
    /// Ground up to the sensor's highest elevation and perhaps beyond.
    Wall,
}

/// A quarter of a degree, 3 cm at 7 m: nothing narrower than this stands free before the sky.
const COARSE_STEP_RAD: f64 = PI / 720.0;
/// Halvings of a coarse step; they leave half a microradian.
const HALVINGS: usize = 13;

/// The skyline at an azimuth in the sensor frame, from ground within `radius_m` metres of the sensor and
/// elevations from that of the lowest ring to that of the highest.
#[must_use]
pub fn true_skyline(
    caster: &Caster,
    pose: &SensorPose,
    radius_m: f64,
    azimuth_rad: f64,
    between_rad: [f64; 2],
) -> Skyline {
    let (sin_azimuth, cos_azimuth) = libm::sincos(azimuth_rad);
    let mut fan = Fan::new(caster, pose, sin_azimuth, cos_azimuth);
    let hits = |fan: &mut Fan, elevation_rad: f64| {
        let (sin, cos) = libm::sincos(elevation_rad);
        fan.cast(sin, cos, radius_m).is_some()
    };
    let [lowest, highest] = between_rad;
    let steps = ((highest - lowest) / COARSE_STEP_RAD).round().max(1.0) as usize;
    let step = (highest - lowest) / steps as f64;
    let mut last_hit = None;
    for index in 0..=steps {
        if hits(&mut fan, lowest + index as f64 * step) {
            last_hit = Some((index, fan.clone()));
        }
    }
    let Some((index, fan)) = last_hit else { return Skyline::Unknown };
    if index == steps {
        return Skyline::Wall;
    }
    let mut ground = lowest + index as f64 * step;
    let mut sky = ground + step;
    for _ in 0..HALVINGS {
        let middle = (ground + sky) / 2.0;
        if hits(&mut fan.clone(), middle) { ground = middle } else { sky = middle }
    }
    Skyline::Ground { elevation_rad: ground }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Attitude, HeightField, SensorConfig};
    use glam::DVec2;

    fn skyline(caster: &Caster, pose: &SensorPose, radius_m: f64, azimuth_rad: f64) -> Skyline {
        true_skyline(caster, pose, radius_m, azimuth_rad, [-PI / 12.0, PI / 12.0])
    }

    fn pose(height_m: f64, pitch_rad: f64) -> SensorPose {
        let attitude = Attitude { height_m, roll_rad: 0.0, pitch_rad };
        SensorConfig::default().pose_on(DVec2::splat(20.0), 0.0, &attitude)
    }

    fn elevation(skyline: Skyline) -> f64 {
        match skyline {
            Skyline::Ground { elevation_rad } => elevation_rad,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn level_ground_ends_where_the_radius_meets_it() {
        let caster = Caster::new(HeightField::new(81, 81, 0.5, vec![0.0; 81 * 81]).unwrap());
        for azimuth_rad in [0.0, 1.0, -2.5] {
            let found = elevation(skyline(&caster, &pose(0.0, 0.0), 7.0, azimuth_rad));
            assert!((found + libm::asin(0.8 / 7.0)).abs() < 1e-6, "{found}");
        }
        // Pitched up by 0.1 rad, the ground ahead appears lower and the ground behind higher.
        let pitched = pose(0.0, 0.1);
        let above = libm::asin(pitched.position.z / 7.0);
        assert!((elevation(skyline(&caster, &pitched, 7.0, 0.0)) + above + 0.1).abs() < 1e-6);
        let behind = skyline(&caster, &pitched, 7.0, std::f64::consts::PI);
        assert!((elevation(behind) + above - 0.1).abs() < 1e-6);
    }

    #[test]
    fn a_drop_is_unknown_and_a_cliff_is_a_wall() {
        let step = |low: f32, high: f32| {
            let heights = (0..81 * 81).map(|i| if i % 81 < 44 { low } else { high }).collect();
            Caster::new(HeightField::new(81, 81, 0.5, heights).unwrap())
        };
        assert_eq!(skyline(&step(0.0, 9.0), &pose(0.0, 0.0), 7.0, 0.0), Skyline::Wall);
        let rise = elevation(skyline(&step(0.0, 1.2), &pose(0.0, 0.0), 7.0, 0.0));
        assert!((rise - libm::atan2(0.4, 2.0)).abs() < 1e-4, "the edge of the step at 2 m: {rise}");
        let drop = step(0.0, -20.0);
        let ahead = SensorConfig::default().pose_on(
            DVec2::new(21.0, 20.0),
            0.0,
            &Attitude { height_m: 0.0, roll_rad: 0.0, pitch_rad: 0.4 },
        );
        assert_eq!(skyline(&drop, &ahead, 7.0, 0.0), Skyline::Unknown);
    }
}

//! Whether a beam's return is noticed: its power after range, incidence and wetness.

use crate::height_field::HeightField;
use crate::random;
use crate::sensing_config::SensingConfig;
use glam::DVec3;

/// Range of the return to whose power others are compared.
const REFERENCE_M: f64 = 10.0;
/// What lies this far above the ground is not the ground; its faces are taken to face the sensor.
const ABOVE_GROUND_M: f64 = 0.05;

/// Whether the return of a beam from `origin` along the unit vector `beam` is noticed after `range_m`.
///
/// The radar equation of a matt surface larger than the beam: power falls with the square of the range and
/// with the cosine of the incidence. Speckle lets it vary by half from beam to beam.
pub(crate) fn is_noticed(
    config: &SensingConfig,
    ground: &HeightField,
    origin: DVec3,
    beam: DVec3,
    range_m: f64,
    key: u64,
) -> bool {
    let place = origin + beam * range_m;
    let is_ground = |height_m: f64| place.z - height_m < ABOVE_GROUND_M;
    let normal = ground.normal(place.truncate());
    let normal = normal.filter(|_| ground.height_m(place.truncate()).is_some_and(is_ground));
    let facing = normal.map_or(1.0, |normal| -normal.dot(beam)).max(0.0);
    let nearness = REFERENCE_M / range_m;
    let power = facing * (1.0 - config.wetness) * nearness * nearness;
    power * (0.5 + random::uniform(key)) >= config.weakest_return
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share of 1000 returns that are noticed, of a beam that meets level ground so far away with this cosine
    /// of the incidence.
    fn noticed(config: &SensingConfig, range_m: f64, facing: f64) -> f64 {
        let ground = HeightField::new(101, 101, 2.0, vec![0.0; 101 * 101]).unwrap();
        let beam = DVec3::new(libm::sqrt(1.0 - facing * facing), 0.0, -facing);
        let origin = DVec3::new(100.0, 100.0, 0.0) - beam * range_m;
        let count = (0..1000)
            .filter(|&beam_key| is_noticed(config, &ground, origin, beam, range_m, random::key(3, beam_key)))
            .count();
        count as f64 / 1000.0
    }

    #[test]
    fn returns_fade_with_range_incidence_and_wetness() {
        let dry = SensingConfig { weakest_return: 0.04, ..SensingConfig::default() };
        let wet = SensingConfig { wetness: 0.75, ..dry.clone() };
        // Half of them at the range where the mean power is the weakest: 50 m, or where cosine or wetness
        // take a quarter, 25 m.
        for (config, range_m, facing) in [(&dry, 50.0, 1.0), (&dry, 25.0, 0.25), (&wet, 25.0, 1.0)] {
            let share = noticed(config, range_m, facing);
            assert!((share - 0.5).abs() < 0.06, "{share}");
            let (nearer, farther) =
                (noticed(config, 0.7 * range_m, facing), noticed(config, 1.5 * range_m, facing));
            assert!((nearer, farther) == (1.0, 0.0), "{nearer} {farther}");
        }
        assert!(noticed(&SensingConfig::default(), 90.0, 0.01) >= 1.0, "by default nothing is lost");
    }

    #[test]
    fn what_stands_on_the_ground_is_seen_as_facing_the_sensor() {
        let config = SensingConfig { weakest_return: 0.04, ..SensingConfig::default() };
        let ground = HeightField::new(101, 101, 1.0, vec![0.0; 101 * 101]).unwrap();
        let from =
            |height_m: f64| is_noticed(&config, &ground, DVec3::new(50.0, 50.0, height_m), DVec3::X, 20.0, 7);
        assert!(from(0.5) && !from(0.0), "a post, and ground that is grazed");
    }
}

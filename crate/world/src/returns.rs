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

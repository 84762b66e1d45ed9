//! Ground for tests.

use glam::DVec2;
use mapless::Pose;
use mapless_world::HeightField;

/// A square of ground of this side, sampled every 0.2 m.
pub(crate) fn field(side_m: f64, height_m: impl Fn(DVec2) -> f64) -> HeightField {
    let samples = (side_m / 0.2).round() as usize + 1;
    let heights = (0..samples * samples)
        .map(|index| height_m(DVec2::new((index % samples) as f64, (index / samples) as f64) * 0.2) as f32)
        .collect();
    HeightField::new(samples, samples, 0.2, heights).unwrap()
}

/// Gentle undulation: 10° at most.
pub(crate) fn undulating(place: DVec2) -> f64 {
    0.25 * libm::sin(0.5 * place.x) * libm::cos(0.4 * place.y)
}

/// A wall across the middle of a square of 20 m, 3 m high, with undulation elsewhere.
pub(crate) fn walled(place: DVec2) -> f64 {
    if (9.5..=10.5).contains(&place.x) { 3.0 } else { undulating(place) }
}

/// A pose at a place seen from above, heading east.
pub(crate) fn at(place_m: DVec2) -> Pose {
    Pose::from_roll_pitch_yaw(place_m.extend(0.0), 0.0, 0.0, 0.0)
}

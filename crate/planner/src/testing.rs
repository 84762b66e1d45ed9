//! Scans for unit tests.

use glam::Vec3;

/// Returns of an undulating skyline over the columns `from..to`.
pub(crate) fn undulating_scan(from: usize, to: usize) -> Vec<Vec3> {
    (from..to)
        .flat_map(|column| {
            let azimuth = crate::occupancy::column_azimuth_rad(column);
            let top = 5 + (3.0 * libm::sin(3.0 * azimuth)).round() as i32;
            (0..top).map(move |ring| {
                let elevation = (-15.0 + 2.0 * f64::from(ring)).to_radians();
                let range = 3.0 + 0.5 * f64::from(ring);
                let (sin_a, cos_a) = libm::sincos(azimuth);
                let (sin_e, cos_e) = libm::sincos(elevation);
                Vec3::new(
                    (range * cos_e * cos_a) as f32,
                    (range * cos_e * sin_a) as f32,
                    (range * sin_e) as f32,
                )
            })
        })
        .collect()
}

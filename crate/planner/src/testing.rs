//! Scans and ground for unit tests.

use core::time::Duration;

use glam::{DVec2, Vec3};

use crate::config::PlannerConfig;
use crate::sensor_model::SensorModel;
use crate::skyline::beam_grid::BeamGrid;
use crate::skyline::occupancy::OccupancySurface;
use crate::terrain::elevation_window::{ElevationWindow, TerrainQuery};
use crate::terrain::headings::AXES;
use crate::terrain::plane::Plane;

/// Time between two scans.
pub(crate) const STEP: Duration = Duration::from_millis(100);

/// Returns on the ground all around, up to two metres away; none where it has no height.
pub(crate) fn strewn(height_m: impl Fn(DVec2) -> Option<f64>) -> ElevationWindow {
    let mut ground = ElevationWindow::new(&PlannerConfig::default());
    ground.advance(STEP);
    for i in -40..=40 {
        for j in -40..=40 {
            let place_m = DVec2::new(f64::from(i), f64::from(j)) * 0.05;
            if let Some(height_m) = height_m(place_m) {
                ground.add_return(place_m.extend(height_m));
            }
        }
    }
    ground
}

/// Level ground on which something upright stands, for a body that is a point. All of it may be a negative
/// obstacle.
pub(crate) struct Standing {
    pub(crate) at_m: DVec2,
    pub(crate) radius_m: f64,
    pub(crate) is_void: bool,
}

impl TerrainQuery for Standing {
    fn plane_at(&self, _: DVec2) -> Option<Plane> {
        Some(Plane { height_m: 0.0, gradient: DVec2::ZERO, gradient_deviation: 0.0 })
    }

    fn lacks_ground(&self, _: DVec2, _: DVec2, _: bool) -> bool {
        self.is_void
    }

    fn room_m(&self, place_m: DVec2, _: Option<&Plane>, most_m: f64) -> [f64; AXES] {
        [(place_m.distance(self.at_m) - self.radius_m).min(most_m); AXES]
    }
}

/// An empty surface of a VLP-16 within 7 m.
pub(crate) fn vlp16_surface() -> OccupancySurface {
    OccupancySurface::new(7.0, BeamGrid::new(&SensorModel::vlp16()))
}

/// Returns of an undulating skyline over the columns `from..to`.
pub(crate) fn undulating_scan(from: usize, to: usize) -> Vec<Vec3> {
    (from..to)
        .flat_map(|column| {
            let azimuth = crate::skyline::columns::column_azimuth_rad(column);
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

//! The truncated occupancy surface (paper, section V-A): every return within r_oc becomes a point (α, β) with
//! occupancy r_oc - r.
//!
//! The surface has one cell for each degree of azimuth and each of the sixteen VLP-16 rings; a cell's occupancy is the
//! mean over its returns, so that every return of a full 28 800-beam scan counts.

use core::f64::consts::{PI, TAU};
use core::ops::Range;

use glam::{DVec2, Vec3};

use crate::math::elementary::floor;

/// Columns of the surfaces, one degree each; column `c` is centred on azimuth -π + c · 1°.
pub const COLUMNS: usize = 360;
/// Rings of the sensor; ring `r` is centred on elevation -15° + r · 2°.
pub const RINGS: usize = 16;
/// Elevation of the lowest ring, and minus that of the highest.
pub const LOWEST_ELEVATION_RAD: f64 = -PI / 12.0;

pub(crate) const COLUMN_STEP_RAD: f64 = TAU / COLUMNS as f64;
pub(crate) const RING_STEP_RAD: f64 = PI / 90.0;

/// Azimuth of the centre of a column, in the sensor frame, in [-π, π).
pub fn column_azimuth_rad(column: usize) -> f64 {
    -PI + COLUMN_STEP_RAD * column as f64
}

/// The column an azimuth falls into.
pub fn column_of(azimuth_rad: f64) -> usize {
    floor((azimuth_rad + PI) / COLUMN_STEP_RAD + 0.5).rem_euclid(COLUMNS as i32) as usize
}

/// One occupied cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Azimuth column, 0 to 359.
    pub column: usize,
    /// Ring, 0 (-15°) to 15 (+15°).
    pub ring: usize,
    /// Mean occupancy r_oc - r over the cell's returns, metres, at least 0.
    pub occupancy_m: f64,
}

impl Cell {
    /// (azimuth, elevation) of the cell's centre, radians.
    pub fn direction_rad(&self) -> DVec2 {
        DVec2::new(column_azimuth_rad(self.column), LOWEST_ELEVATION_RAD + RING_STEP_RAD * self.ring as f64)
    }
}

/// The observed occupancy surface of one scan.
#[derive(Clone, Debug)]
pub struct OccupancySurface {
    radius_m: f64,
    sums_m: Vec<f64>,
    counts: Vec<u32>,
    cells: Vec<Cell>,
    column_starts: Vec<usize>,
}

impl OccupancySurface {
    /// An empty surface of radius r_oc.
    pub fn new(radius_m: f64) -> Self {
        Self {
            radius_m,
            sums_m: vec![0.0; COLUMNS * RINGS],
            counts: vec![0; COLUMNS * RINGS],
            cells: Vec::with_capacity(COLUMNS * RINGS),
            column_starts: vec![0; COLUMNS + 1],
        }
    }

    /// Projects a scan: points in the sensor frame, metres. Points beyond r_oc, at the origin, outside the sensor's
    /// ±16° of elevation or not finite do not belong to the surface and are passed over.
    pub fn project(&mut self, points_m: &[Vec3]) {
        self.sums_m.fill(0.0);
        self.counts.fill(0);
        let radius_squared = self.radius_m * self.radius_m;
        for point in points_m {
            let point = point.as_dvec3();
            let range_squared = point.length_squared();
            if !(range_squared > 0.0 && range_squared <= radius_squared) {
                continue;
            }
            let plan = (point.x * point.x + point.y * point.y).sqrt();
            let elevation = libm::atan2(point.z, plan);
            let ring = floor((elevation - LOWEST_ELEVATION_RAD) / RING_STEP_RAD + 0.5);
            if !(0..RINGS as i32).contains(&ring) {
                continue;
            }
            let index = column_of(libm::atan2(point.y, point.x)) * RINGS + ring as usize;
            self.sums_m[index] += self.radius_m - range_squared.sqrt();
            self.counts[index] += 1;
        }
        self.collect();
    }

    fn collect(&mut self) {
        self.cells.clear();
        for column in 0..COLUMNS {
            self.column_starts[column] = self.cells.len();
            for ring in 0..RINGS {
                let index = column * RINGS + ring;
                if self.counts[index] > 0 {
                    let occupancy_m = self.sums_m[index] / f64::from(self.counts[index]);
                    self.cells.push(Cell { column, ring, occupancy_m });
                }
            }
        }
        self.column_starts[COLUMNS] = self.cells.len();
    }

    /// r_oc.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// The occupied cells, by column, then by ring.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The occupied cells of one column, lowest ring first.
    pub fn column(&self, column: usize) -> &[Cell] {
        &self.cells[self.column_span(column)]
    }

    /// Where a column's cells are among [`OccupancySurface::cells`].
    pub(crate) fn column_span(&self, column: usize) -> Range<usize> {
        self.column_starts[column]..self.column_starts[column + 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beam(azimuth_deg: f64, elevation_deg: f64, range_m: f64) -> Vec3 {
        let (sin_a, cos_a) = libm::sincos(azimuth_deg.to_radians());
        let (sin_e, cos_e) = libm::sincos(elevation_deg.to_radians());
        Vec3::new(
            (range_m * cos_e * cos_a) as f32,
            (range_m * cos_e * sin_a) as f32,
            (range_m * sin_e) as f32,
        )
    }

    #[test]
    fn returns_of_a_cell_are_averaged_and_far_ones_left_out() {
        let mut surface = OccupancySurface::new(7.0);
        surface.project(&[
            beam(0.2, -11.0, 4.0),
            beam(-0.2, -11.0, 5.0),
            beam(10.0, -11.0, 7.1),
            Vec3::ZERO,
            Vec3::splat(f32::NAN),
            beam(20.0, 30.0, 3.0),
        ]);
        assert_eq!(surface.cells().len(), 1);
        let cell = surface.cells()[0];
        assert_eq!((cell.column, cell.ring), (180, 2));
        assert!((cell.occupancy_m - 2.5).abs() < 1e-6);
        assert_eq!(surface.column(180), surface.cells());
    }

    #[test]
    fn the_seam_falls_inside_column_zero() {
        let mut surface = OccupancySurface::new(7.0);
        surface.project(&[beam(179.8, -1.0, 3.0), beam(-179.8, -1.0, 3.0), beam(180.0, -1.0, 3.0)]);
        assert_eq!(surface.cells().len(), 1);
        assert_eq!(surface.cells()[0].column, 0);
    }

    #[test]
    fn every_vlp16_beam_has_its_cell_and_a_cell_has_five() {
        let mut surface = OccupancySurface::new(7.0);
        let points: Vec<Vec3> = (0..16)
            .flat_map(|ring| (0..1800).map(move |k| (ring, k)))
            .map(|(ring, k)| beam(-180.0 + 0.2 * f64::from(k), -15.0 + 2.0 * f64::from(ring), 3.0))
            .collect();
        surface.project(&points);
        assert_eq!(surface.cells().len(), COLUMNS * RINGS);
        assert!(surface.counts.iter().all(|&count| count == 5));
    }
}

//! The truncated occupancy surface (paper, section V-A): every return within r_oc becomes a point (α, β) with
//! occupancy r_oc - r.
//!
//! The surface has one cell for each degree of azimuth and each row of the sensor's [`BeamGrid`]; a cell's
//! occupancy is the mean over its returns, so that every return of a scan counts, in any order.

use core::f64::consts::PI;
use core::ops::Range;

use glam::{DVec2, Vec3};

use crate::skyline::beam_grid::{BeamGrid, RING_STEP_RAD};
use crate::skyline::columns::{COLUMNS, column_azimuth_rad, column_of};

/// Elevation of the lowest row in the Gaussian process, whatever its true elevation: the process depends on
/// differences only.
pub(crate) const LOWEST_ROW_RAD: f64 = -PI / 12.0;

/// One occupied cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Azimuth column, 0 to 359.
    pub column: usize,
    /// Row of the grid, the lowest is 0.
    pub ring: usize,
    /// Mean occupancy r_oc - r over the cell's returns, metres, at least 0.
    pub occupancy_m: f64,
}

impl Cell {
    /// (azimuth, elevation) of the cell's centre in the Gaussian process, radians: as if rows were 2° apart
    /// and the lowest at -15°, as with a VLP-16.
    pub fn direction_rad(&self) -> DVec2 {
        DVec2::new(column_azimuth_rad(self.column), LOWEST_ROW_RAD + RING_STEP_RAD * self.ring as f64)
    }
}

/// The observed occupancy surface of one scan.
#[derive(Clone, Debug)]
pub struct OccupancySurface {
    radius_m: f64,
    grid: BeamGrid,
    sums_m: Vec<f64>,
    counts: Vec<u32>,
    cells: Vec<Cell>,
    column_starts: Vec<usize>,
}

impl OccupancySurface {
    /// An empty surface of radius r_oc.
    pub fn new(radius_m: f64, grid: BeamGrid) -> Self {
        let cells = COLUMNS * grid.rings();
        Self {
            radius_m,
            grid,
            sums_m: vec![0.0; cells],
            counts: vec![0; cells],
            cells: Vec::with_capacity(cells),
            column_starts: vec![0; COLUMNS + 1],
        }
    }

    /// Projects a scan: points in the sensor frame, metres, in any order. Points beyond r_oc, at the origin,
    /// outside the grid's elevations or not finite are skipped.
    pub fn project(&mut self, points_m: &[Vec3]) {
        self.clear();
        for point_m in points_m {
            if let Some((cell, range_m)) = cell_of(&self.grid, *point_m) {
                self.add(cell, range_m);
            }
        }
        self.collect();
    }

    /// Projects returns whose cell, column × rings + ring, and range are known. Those beyond r_oc are
    /// skipped.
    pub(crate) fn project_cells(&mut self, returns: impl Iterator<Item = (usize, f64)>) {
        self.clear();
        for (cell, range_m) in returns {
            self.add(cell, range_m);
        }
        self.collect();
    }

    fn clear(&mut self) {
        self.sums_m.fill(0.0);
        self.counts.fill(0);
    }

    fn add(&mut self, cell: usize, range_m: f64) {
        if range_m <= self.radius_m {
            self.sums_m[cell] += self.radius_m - range_m;
            self.counts[cell] += 1;
        }
    }

    fn collect(&mut self) {
        self.cells.clear();
        for column in 0..COLUMNS {
            self.column_starts[column] = self.cells.len();
            for ring in 0..self.grid.rings() {
                let index = column * self.grid.rings() + ring;
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

    /// The grid of its cells.
    pub fn grid(&self) -> &BeamGrid {
        &self.grid
    }

    /// Rows of the grid.
    pub fn rings(&self) -> usize {
        self.grid.rings()
    }

    /// The occupied cells, by column, then by ring.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The occupied cells of one column, lowest ring first.
    pub fn column(&self, column: usize) -> &[Cell] {
        &self.cells[self.column_span(column)]
    }

    /// The range of a column's cells in [`OccupancySurface::cells`].
    pub(crate) fn column_span(&self, column: usize) -> Range<usize> {
        self.column_starts[column]..self.column_starts[column + 1]
    }
}

/// The cell and the range of a return in the sensor frame; `None` for what is no return or out of view.
fn cell_of(grid: &BeamGrid, point_m: Vec3) -> Option<(usize, f64)> {
    let point_m = grid.along_robot(point_m.as_dvec3());
    let range_m = point_m.length();
    // Also false for NaN.
    if !(range_m > 0.0 && range_m >= grid.min_range_m) {
        return None;
    }
    let plan_m = (point_m.x * point_m.x + point_m.y * point_m.y).sqrt();
    let ring = grid.ring_of(libm::atan2(point_m.z, plan_m))?;
    Some((column_of(libm::atan2(point_m.y, point_m.x)) * grid.rings() + ring, range_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor_model::SensorModel;

    fn surface() -> OccupancySurface {
        OccupancySurface::new(7.0, BeamGrid::new(&SensorModel::vlp16()))
    }

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
        let mut surface = surface();
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
        let mut surface = surface();
        surface.project(&[beam(179.8, -1.0, 3.0), beam(-179.8, -1.0, 3.0), beam(180.0, -1.0, 3.0)]);
        assert_eq!(surface.cells().len(), 1);
        assert_eq!(surface.cells()[0].column, 0);
    }

    #[test]
    fn every_vlp16_beam_has_its_cell_and_a_cell_has_five() {
        let mut surface = surface();
        let points: Vec<Vec3> = (0..16)
            .flat_map(|ring| (0..1800).map(move |k| (ring, k)))
            .map(|(ring, k)| beam(-180.0 + 0.2 * f64::from(k), -15.0 + 2.0 * f64::from(ring), 3.0))
            .collect();
        surface.project(&points);
        assert_eq!(surface.cells().len(), COLUMNS * 16);
        assert!(surface.counts.iter().all(|&count| count == 5));
    }

    #[test]
    fn a_turned_mount_shows_the_ground_where_the_robot_has_it() {
        let level = SensorModel::vlp16();
        let mount = SensorModel { roll_rad: 0.1, pitch_rad: -0.2, yaw_rad: 1.0, ..level };
        let sensor_from_robot = mount.robot_from_sensor().unwrap().transpose();
        let points = [beam(40.0, -11.0, 4.0), beam(-100.0, -3.0, 5.0)];
        let mut upright = surface();
        upright.project(&points);
        let mut turned = OccupancySurface::new(7.0, BeamGrid::new(&mount));
        turned.project(&points.map(|point| (sensor_from_robot * point.as_dvec3()).as_vec3()));
        let elevation_rad =
            |surface: &OccupancySurface, cell: &Cell| surface.grid().row_elevation_rad(2 * cell.ring);
        assert_eq!(turned.cells().len(), 2);
        for (a, b) in upright.cells().iter().zip(turned.cells()) {
            assert_eq!(a.column, b.column);
            assert!((a.occupancy_m - b.occupancy_m).abs() < 1e-6);
            assert!((elevation_rad(&upright, a) - elevation_rad(&turned, b)).abs() <= RING_STEP_RAD);
        }
    }
}

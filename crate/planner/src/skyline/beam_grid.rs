//! The grid of directions for scans: 360 columns of one degree, and rows of elevation that follow the sensor.

use core::f64::consts::{FRAC_PI_2, PI};

use glam::{DMat3, DVec3};

use crate::math::elementary::floor;
use crate::sensor_model::SensorModel;
use crate::skyline::columns::{COLUMNS, column_azimuth_rad};

/// Rings nearer to each other than this share a row. The Gaussian process works on rows as if all were this
/// far apart, so its hyperparameters, which hold for this spacing, serve every sensor.
pub(crate) const RING_STEP_RAD: f64 = PI / 90.0;
/// Rows of the predicted surfaces for each row of the grid.
pub(crate) const ROWS_PER_RING: usize = 2;
/// Rows are marked in a mask of 64 bits.
pub(crate) const MOST_RINGS: usize = 64;
/// The VLP-16 has its rings 2° apart but for rounding.
const TOLERANCE: f64 = 1e-9;
/// Ground that rises out of view is a wall from this elevation on. Below it, the hidden skyline may still be
/// climbable.
const LEAST_WALL_RAD: f64 = 0.2;

/// The directions of a sensor, seen from its origin along the robot's axes: a tilted sensor's rings cross the
/// rows.
#[derive(Clone, Debug)]
pub struct BeamGrid {
    rings: usize,
    lowest_elevation_rad: f64,
    ring_step_rad: f64,
    /// How far the middle of the elevations that belong to a row lies above the row's own. The skyline is
    /// half a spacing of rings above the highest beam that meets ground, and half a row above the highest
    /// occupied row: with this, both are the same place where rings share rows.
    row_shift_rad: f64,
    /// Nearer than this nothing is measured.
    pub(crate) min_range_m: f64,
    /// `None` if the sensor's axes are the robot's.
    robot_from_sensor: Option<DMat3>,
    /// Rows of the predicted surfaces up to the highest in view, for each column.
    rows_in_view: Vec<usize>,
}

impl BeamGrid {
    /// The grid of a sensor.
    pub fn new(sensor: &SensorModel) -> Self {
        let robot_from_sensor = sensor.robot_from_sensor();
        let [lowest, highest] = match &robot_from_sensor {
            None => [sensor.lowest_elevation_rad, sensor.highest_elevation_rad],
            Some(rotation) => elevations_of(sensor, rotation),
        };
        let spacing = (sensor.highest_elevation_rad - sensor.lowest_elevation_rad)
            / sensor.rings.saturating_sub(1).max(1) as f64;
        let finest = if spacing <= RING_STEP_RAD * (1.0 + TOLERANCE) { RING_STEP_RAD } else { spacing };
        let ring_step_rad = finest.max((highest - lowest) / (MOST_RINGS - 1) as f64);
        let rings = floor((highest - lowest) / ring_step_rad + 0.5) as usize + 1;
        let is_shared = spacing < ring_step_rad * (1.0 - TOLERANCE);
        let mut grid = Self {
            row_shift_rad: if is_shared { 0.5 * (ring_step_rad - spacing) } else { 0.0 },
            rings: rings.min(MOST_RINGS),
            lowest_elevation_rad: lowest,
            ring_step_rad,
            min_range_m: sensor.min_range_m,
            robot_from_sensor,
            rows_in_view: Vec::new(),
        };
        grid.rows_in_view = (0..COLUMNS).map(|column| grid.count_rows_in_view(sensor, column)).collect();
        grid
    }

    /// Number of rows. A level sensor whose rings are 2° apart or more has one for each ring.
    pub fn rings(&self) -> usize {
        self.rings
    }

    /// Number of rows of the predicted surfaces.
    pub fn rows(&self) -> usize {
        ROWS_PER_RING * (self.rings - 1) + 1
    }

    /// Elevation of a row of the predicted surfaces.
    pub fn row_elevation_rad(&self, row: usize) -> f64 {
        self.lowest_elevation_rad + self.row_step_rad() * row as f64
    }

    /// Spacing of the rows of the predicted surfaces.
    pub fn row_step_rad(&self) -> f64 {
        self.ring_step_rad / ROWS_PER_RING as f64
    }

    /// Spacing of the rows, as a multiple of the 2° of a VLP-16.
    pub fn coarseness(&self) -> f64 {
        self.ring_step_rad / RING_STEP_RAD
    }

    /// The row of an elevation; `None` outside the sensor's view.
    pub(crate) fn ring_of(&self, elevation_rad: f64) -> Option<usize> {
        let (ring, is_in_view) = self.nearest_ring(elevation_rad);
        is_in_view.then_some(ring)
    }

    /// The highest row whose beams are all below an elevation; `None` if there is none.
    pub(crate) fn ring_below(&self, elevation_rad: f64) -> Option<usize> {
        let ring = floor((elevation_rad - self.lowest_beam_rad()) / self.ring_step_rad - 0.5);
        (ring >= 0).then(|| (ring as usize).min(self.rings - 1))
    }

    /// The row that an elevation belongs to or is nearest to, and whether it is within the sensor's view.
    pub(crate) fn nearest_ring(&self, elevation_rad: f64) -> (usize, bool) {
        let ring = floor((elevation_rad - self.lowest_beam_rad()) / self.ring_step_rad + 0.5);
        let nearest = ring.clamp(0, self.rings as i32 - 1);
        (nearest as usize, nearest == ring)
    }

    /// The middle of the elevations that belong to the lowest row.
    fn lowest_beam_rad(&self) -> f64 {
        self.lowest_elevation_rad + self.row_shift_rad
    }

    /// A point of a scan, with the robot's axes.
    pub(crate) fn along_robot(&self, point_m: DVec3) -> DVec3 {
        self.robot_from_sensor.map_or(point_m, |rotation| rotation * point_m)
    }

    /// Number of rows of the predicted surfaces that may show the skyline, in a column with its highest
    /// return in row `highest_ring` of the grid.
    pub(crate) fn rows_in_view(&self, column: usize, highest_ring: usize) -> usize {
        self.rows_in_view[column].max(ROWS_PER_RING * highest_ring + 1)
    }

    /// Whether ground that is in view up to the highest of `rows` is a wall.
    pub(crate) fn is_wall(&self, rows: usize) -> bool {
        self.row_elevation_rad(rows - 1) >= LEAST_WALL_RAD
    }

    fn count_rows_in_view(&self, sensor: &SensorModel, column: usize) -> usize {
        let Some(robot_from_sensor) = &self.robot_from_sensor else { return self.rows() };
        let sensor_from_robot = robot_from_sensor.transpose();
        let (sin_a, cos_a) = libm::sincos(column_azimuth_rad(column));
        let is_in_view = |ring: &usize| {
            let (sin_e, cos_e) = libm::sincos(self.row_elevation_rad(ROWS_PER_RING * ring));
            let beam = sensor_from_robot * DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
            sensor.has_in_view(beam, 0.5 * self.ring_step_rad)
        };
        (0..self.rings).rfind(is_in_view).map_or(0, |ring| ROWS_PER_RING * ring + 1)
    }
}

/// The lowest and the highest elevation over the robot's x-y plane that a full turn of a tilted sensor
/// reaches.
fn elevations_of(sensor: &SensorModel, robot_from_sensor: &DMat3) -> [f64; 2] {
    let tilt = libm::acos(robot_from_sensor.z_axis.z.clamp(-1.0, 1.0));
    // Angles from the sensor's axis, which is tilted from the robot's.
    let from_axis = [FRAC_PI_2 - sensor.highest_elevation_rad, FRAC_PI_2 - sensor.lowest_elevation_rad];
    let holds = |angle: f64| (from_axis[0]..=from_axis[1]).contains(&angle);
    let nearest = from_axis.map(|angle| (angle - tilt).abs()).into_iter().fold(f64::INFINITY, f64::min);
    let farthest =
        from_axis.map(|angle| PI - (PI - angle - tilt).abs()).into_iter().fold(f64::NEG_INFINITY, f64::max);
    let nearest = if holds(tilt) { 0.0 } else { nearest };
    let farthest = if holds(PI - tilt) { PI } else { farthest };
    [FRAC_PI_2 - farthest, FRAC_PI_2 - nearest]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sensor(rings: usize, lowest_deg: f64, highest_deg: f64) -> SensorModel {
        SensorModel {
            rings,
            lowest_elevation_rad: lowest_deg.to_radians(),
            highest_elevation_rad: highest_deg.to_radians(),
            ..SensorModel::vlp16()
        }
    }

    #[test]
    fn the_grid_of_a_vlp16_has_its_rings_to_the_last_bit() {
        let grid = BeamGrid::new(&SensorModel::vlp16());
        assert_eq!((grid.rings(), grid.rows()), (16, 31));
        assert_eq!(grid.lowest_elevation_rad.to_bits(), (-PI / 12.0).to_bits());
        assert_eq!(grid.ring_step_rad.to_bits(), (PI / 90.0).to_bits());
        assert_eq!(grid.row_step_rad().to_bits(), (PI / 180.0).to_bits());
        assert_eq!(grid.coarseness().to_bits(), 1.0_f64.to_bits());
        assert!((0..COLUMNS).all(|column| grid.rows_in_view(column, 0) == 31));
        assert!(grid.is_wall(31));
    }

    #[test]
    fn fine_rings_share_rows_and_coarse_ones_keep_theirs() {
        for (rings, lowest, highest, rows, step_deg) in [
            (8, -15.0, 15.0, 8, 30.0 / 7.0),
            (32, -30.67, 10.67, 22, 2.0),
            (32, -45.0, 45.0, 32, 90.0 / 31.0),
            (64, -45.0, 45.0, 46, 2.0),
            (64, -24.9, 2.0, 14, 2.0),
            (128, -45.0, 45.0, 46, 2.0),
            (40, -90.0, 90.0, 40, 180.0 / 39.0),
            (128, -90.0, 90.0, 64, 180.0 / 63.0),
        ] {
            let grid = BeamGrid::new(&sensor(rings, lowest, highest));
            assert_eq!(grid.rings(), rows, "{rings} rings from {lowest}° to {highest}°");
            assert!((grid.ring_step_rad.to_degrees() - step_deg).abs() < 1e-9);
            for ring in 0..rings {
                let elevation = lowest + (highest - lowest) * ring as f64 / (rings - 1) as f64;
                assert!(grid.ring_of(elevation.to_radians()).is_some(), "{elevation}°");
            }
            assert_eq!(grid.ring_of((lowest - step_deg).to_radians()), None);
            assert_eq!(grid.ring_of((highest + 1.51 * step_deg).to_radians()), None);
        }
    }

    #[test]
    fn the_skyline_over_fine_rings_is_as_far_above_their_row_as_over_coarse_ones() {
        // The skyline is anywhere between the highest ring that meets ground and the next; half a row above
        // the occupied row must be its mean.
        for (rings, half_view_deg) in [(16, 15.0), (32, 15.5), (64, 22.5), (128, 45.0)] {
            let grid = BeamGrid::new(&sensor(rings, -half_view_deg, half_view_deg));
            let spacing = (2.0 * half_view_deg / (rings - 1) as f64).to_radians();
            let lowest = (-half_view_deg).to_radians();
            let missed = |ring: usize| {
                let elevation = lowest + spacing * ring as f64;
                let row = grid.row_elevation_rad(ROWS_PER_RING * grid.ring_of(elevation + 1e-9).unwrap());
                elevation + 0.5 * spacing - (row + 0.5 * grid.ring_step_rad)
            };
            let mean_deg = ((0..rings).map(missed).sum::<f64>() / rings as f64).to_degrees();
            assert!(mean_deg.abs() < 0.15, "{rings} rings: {mean_deg}°");
        }
    }

    #[test]
    fn what_a_low_view_ends_in_is_no_wall() {
        let grid = BeamGrid::new(&sensor(64, -24.9, 2.0));
        assert!(!grid.is_wall(grid.rows()));
    }

    #[test]
    fn a_tilted_sensor_spans_more_and_sees_less_of_it_in_each_column() {
        let nose_down = SensorModel { pitch_rad: -15_f64.to_radians(), ..SensorModel::vlp16() };
        let grid = BeamGrid::new(&nose_down);
        assert_eq!(grid.rings(), 31);
        assert!((grid.lowest_elevation_rad + 30_f64.to_radians()).abs() < 1e-9);
        let highest_deg =
            |column: usize| grid.row_elevation_rad(grid.rows_in_view(column, 0) - 1).to_degrees();
        let (ahead, left, behind) = (COLUMNS / 2, 3 * COLUMNS / 4, 0);
        assert!(highest_deg(ahead).abs() < 1.1 && (highest_deg(behind) - 30.0).abs() < 1.1);
        assert!((highest_deg(left) - 15.0).abs() < 2.1, "{}", highest_deg(left));
        assert!(!grid.is_wall(grid.rows_in_view(ahead, 0)));
        assert!(grid.is_wall(grid.rows_in_view(behind, 0)));
    }

    #[test]
    fn upside_down_the_lowest_ring_is_the_highest() {
        let upside_down = SensorModel { roll_rad: PI, ..sensor(32, -25.0, 15.0) };
        let grid = BeamGrid::new(&upside_down);
        assert!((grid.lowest_elevation_rad + 15_f64.to_radians()).abs() < 1e-9);
        assert_eq!(grid.rings(), 21);
        let beam = grid.along_robot(DVec3::new(0.8, 0.1, -0.3));
        assert!((beam - DVec3::new(0.8, -0.1, 0.3)).length() < 1e-12);
    }

    #[test]
    fn a_view_over_the_zenith_ends_there() {
        let up = SensorModel { pitch_rad: 60_f64.to_radians(), ..sensor(46, -45.0, 45.0) };
        let [lowest, highest] = elevations_of(&up, &up.robot_from_sensor().unwrap());
        assert!((highest - FRAC_PI_2).abs() < 1e-12 && (lowest + FRAC_PI_2).abs() < 1e-12);
    }
}

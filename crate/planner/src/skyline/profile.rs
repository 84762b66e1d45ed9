//! The elevation profile: the border between occupied (low variance) and free (high variance) directions, one
//! column of azimuth at a time (paper, section V-B).

use crate::skyline::beam_grid::{BeamGrid, ROWS_PER_RING};
use crate::skyline::columns::COLUMNS;
use crate::skyline::occupancy::OccupancySurface;
use crate::skyline::surface::PredictedSurface;

/// The content of one column of the variance surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Column {
    /// Terrain up to an elevation angle.
    Ground {
        /// The skyline, seen from the sensor's origin, over the robot's x-y plane.
        elevation_rad: f64,
    },
    /// No return within r_oc: a crest or a drop hides the ground, or the ground rises out of the view of a
    /// sensor that does not see far up.
    Unknown,
    /// Occupied up to the highest elevation in view.
    Wall,
}

impl Column {
    /// The content of a column that is occupied in all of its `rows` in view.
    pub(crate) fn occupied_throughout(grid: &BeamGrid, rows: usize) -> Self {
        if grid.is_wall(rows) { Self::Wall } else { Self::Unknown }
    }
}

/// The profile of one scan, [`COLUMNS`] columns.
pub type ElevationProfile = Vec<Column>;

/// Reads the profile off the variance surface: in each column the highest row where the relative variance
/// falls below `threshold`, interpolated between rows.
pub(crate) fn read_profile(
    observed: &OccupancySurface,
    predicted: &PredictedSurface,
    threshold: f64,
    profile: &mut ElevationProfile,
) {
    profile.clear();
    profile.extend((0..COLUMNS).map(|column| match observed.column(column).last() {
        None => Column::Unknown,
        Some(highest) => {
            let rows = observed.grid().rows_in_view(column, highest.ring);
            read_column(&predicted.variance_column(column)[..rows], threshold, observed.grid())
        }
    }));
}

/// Reads the profile half a ring above the highest return of each column: the next ring has none, so ground
/// ends there on average.
pub(crate) fn read_highest_returns(observed: &OccupancySurface, profile: &mut ElevationProfile) {
    let grid = observed.grid();
    profile.clear();
    profile.extend((0..COLUMNS).map(|column| match observed.column(column).last() {
        None => Column::Unknown,
        Some(highest) => {
            let (row, rows) = (ROWS_PER_RING * highest.ring, grid.rows_in_view(column, highest.ring));
            if row + 1 == rows {
                Column::occupied_throughout(grid, rows)
            } else {
                Column::Ground { elevation_rad: grid.row_elevation_rad(row + ROWS_PER_RING / 2) }
            }
        }
    }));
}

fn read_column(variance: &[f64], threshold: f64, grid: &BeamGrid) -> Column {
    let Some(row) = variance.iter().rposition(|&v| v < threshold) else {
        return Column::Unknown;
    };
    if row + 1 == variance.len() {
        return Column::occupied_throughout(grid, variance.len());
    }
    let share = (threshold - variance[row]) / (variance[row + 1] - variance[row]);
    Column::Ground { elevation_rad: grid.row_elevation_rad(row) + share * grid.row_step_rad() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor_model::SensorModel;
    use proptest::prelude::*;

    const ROWS: usize = 31;

    proptest! {
        #[test]
        fn the_edge_lies_between_an_occupied_and_a_free_row(
            variance in prop::collection::vec(0.0..1.0_f64, ROWS),
            threshold in 0.05..0.95_f64,
        ) {
            let grid = BeamGrid::new(&SensorModel::vlp16());
            match read_column(&variance, threshold, &grid) {
                Column::Unknown => prop_assert!(variance.iter().all(|&v| v >= threshold)),
                Column::Wall => prop_assert!(variance[ROWS - 1] < threshold),
                Column::Ground { elevation_rad } => {
                    let row = variance.iter().rposition(|&v| v < threshold).unwrap();
                    prop_assert!(variance[row + 1..].iter().all(|&v| v >= threshold));
                    let low = grid.row_elevation_rad(row);
                    prop_assert!(elevation_rad >= low && elevation_rad <= low + grid.row_step_rad());
                }
            }
        }
    }
}

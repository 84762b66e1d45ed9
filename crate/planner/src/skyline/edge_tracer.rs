//! The edge of the variance surface, traced without predicting the rest.
//!
//! The kernel decays within a few length-scales, so the edge depends only on returns near the highest return
//! of a nearby column; in front of a wall that excludes most of them. Each column is followed from its
//! highest return up to the first free row.

use crate::config::PerceptionConfig;
use crate::gp::jitter::GpError;
use crate::skyline::beam_gp::{BeamGp, Query, RingMask, occupied_rings};
use crate::skyline::beam_grid::{BeamGrid, RING_STEP_RAD, ROWS_PER_RING};
use crate::skyline::columns::{COLUMN_STEP_RAD, COLUMNS};
use crate::skyline::occupancy::OccupancySurface;
use crate::skyline::profile::{Column, ElevationProfile};
use crate::skyline::surface::{GpDiagnostics, REACH_LENGTH_SCALES, SECTOR_COLUMNS, SECTORS};

/// Rows of a column predicted together.
const ROWS_AT_ONCE: usize = 4;

/// Follows the edge around the circle.
#[derive(Clone, Debug)]
pub(crate) struct EdgeTracer {
    threshold: f64,
    /// Rings within the kernel's reach at each distance in columns.
    reach_rings: Vec<usize>,
    masks: Vec<RingMask>,
    searches: Vec<Search>,
    queries: Vec<Query>,
    variances: Vec<f64>,
    /// Variances of the sector's predicted rows, column by column.
    seen: Vec<f64>,
}

impl EdgeTracer {
    pub(crate) fn new(config: &PerceptionConfig, grid: &BeamGrid) -> Self {
        let rings = grid.rings();
        let [azimuth_scale, elevation_scale] = config.kernel.length_scales_rad;
        let most = REACH_LENGTH_SCALES * azimuth_scale / COLUMN_STEP_RAD;
        let reach_rings = (0..=(most as usize).min(COLUMNS / 2))
            .map(|columns| {
                let across = COLUMN_STEP_RAD * columns as f64 / azimuth_scale;
                let along = (REACH_LENGTH_SCALES * REACH_LENGTH_SCALES - across * across).max(0.0).sqrt();
                ((along * elevation_scale / RING_STEP_RAD).ceil() as usize).min(rings)
            })
            .collect();
        Self {
            threshold: config.variance_threshold,
            reach_rings,
            masks: Vec::new(),
            searches: Vec::new(),
            queries: Vec::new(),
            variances: Vec::new(),
            seen: vec![0.0; SECTOR_COLUMNS * grid.rows()],
        }
    }

    /// The profile of the observed surface, and its diagnostics.
    ///
    /// # Errors
    /// [`GpError::IllConditioned`].
    pub(crate) fn trace(
        &mut self,
        observed: &OccupancySurface,
        gp: &mut BeamGp,
        profile: &mut ElevationProfile,
    ) -> Result<GpDiagnostics, GpError> {
        self.mark_cells(observed);
        gp.observe(observed, &self.masks);
        let mut diagnostics =
            GpDiagnostics { inducing_inputs: gp.inducing_inputs(), ..GpDiagnostics::default() };
        profile.clear();
        profile.resize(COLUMNS, Column::Unknown);
        for sector in 0..SECTORS {
            self.searches.clear();
            for (in_sector, column) in gp.sector_columns(sector).enumerate() {
                if let Some(cell) = observed.column(column).last() {
                    let rows = observed.grid().rows_in_view(column, cell.ring);
                    self.searches.push(Search::new(column, in_sector, ROWS_PER_RING * cell.ring, rows));
                }
            }
            if self.searches.is_empty() || !gp.enter(sector)? {
                continue;
            }
            diagnostics.jitter = diagnostics.jitter.max(gp.jitter());
            self.search_sector(sector, gp, observed.grid(), profile);
        }
        Ok(diagnostics)
    }

    /// Predicts a few rows of every unfinished column, until all are finished.
    fn search_sector(&mut self, sector: usize, gp: &mut BeamGp, grid: &BeamGrid, profile: &mut [Column]) {
        let all_rows = grid.rows();
        while !self.searches.is_empty() {
            self.queries.clear();
            for search in &self.searches {
                let column = search.in_sector;
                self.queries.extend(search.next_rows().map(|row| Query { column, row }));
            }
            gp.relative_variances(sector, &self.queries, &mut self.variances);
            for (query, &variance) in self.queries.iter().zip(&self.variances) {
                self.seen[query.column * all_rows + query.row] = variance;
            }
            let (seen, threshold) = (&self.seen, self.threshold);
            self.searches.retain_mut(|search| {
                let variances = &seen[search.in_sector * all_rows..][..all_rows];
                match search.advance(variances, threshold, grid) {
                    Some(found) => {
                        profile[search.column] = found;
                        false
                    }
                    None => true,
                }
            });
        }
    }

    /// Marks the cells within the kernel's reach of the highest return of some column.
    fn mark_cells(&mut self, observed: &OccupancySurface) {
        self.masks.clear();
        self.masks.resize(COLUMNS, 0);
        let rings = observed.grid().rings();
        for column in 0..COLUMNS {
            let Some(highest) = observed.column(column).last().map(|cell| cell.ring) else { continue };
            for (apart, &reach) in self.reach_rings.iter().enumerate() {
                let near = rings_between(highest.saturating_sub(reach), (highest + reach).min(rings - 1));
                self.masks[(column + apart) % COLUMNS] |= near;
                self.masks[(column + COLUMNS - apart) % COLUMNS] |= near;
            }
        }
        for (column, mask) in self.masks.iter_mut().enumerate() {
            *mask &= occupied_rings(observed, column);
        }
    }
}

/// The rings from `low` to `high`, both included.
fn rings_between(low: usize, high: usize) -> RingMask {
    (RingMask::MAX << low) & (RingMask::MAX >> (RingMask::BITS as usize - 1 - high))
}

/// The search for the edge in one column: up from its highest return to the first free row, or down to the
/// first occupied one.
#[derive(Clone, Debug)]
struct Search {
    column: usize,
    /// The column within the sector.
    in_sector: usize,
    start: usize,
    /// Rows in view.
    rows: usize,
    /// Rows predicted so far, `begin..end`.
    begin: usize,
    end: usize,
    next: (usize, usize),
}

impl Search {
    fn new(column: usize, in_sector: usize, start: usize, rows: usize) -> Self {
        let next = (start, (start + ROWS_AT_ONCE).min(rows));
        Self { column, in_sector, start, rows, begin: start, end: start, next }
    }

    fn next_rows(&self) -> core::ops::Range<usize> {
        self.next.0..self.next.1
    }

    /// Takes the rows just predicted from the column's `variances`; returns the answer, or sets the next
    /// rows.
    fn advance(&mut self, variances: &[f64], threshold: f64, grid: &BeamGrid) -> Option<Column> {
        self.begin = self.begin.min(self.next.0);
        self.end = self.end.max(self.next.1);
        let occupied = |row: &usize| variances[*row] < threshold;
        // Between an occupied row and the free one above it.
        let edge = |row: usize| {
            let (below, above) = (variances[row], variances[row + 1]);
            let share = (threshold - below) / (above - below);
            Column::Ground { elevation_rad: grid.row_elevation_rad(row) + share * grid.row_step_rad() }
        };
        if occupied(&self.start) {
            if let Some(free) = (self.start..self.end).find(|row| !occupied(row)) {
                return Some(edge(free - 1));
            }
            if self.end == self.rows {
                return Some(Column::occupied_throughout(grid, self.rows));
            }
            self.next = (self.end, (self.end + ROWS_AT_ONCE).min(self.rows));
        } else {
            if let Some(highest) = (self.begin..self.start).rev().find(occupied) {
                return Some(edge(highest));
            }
            if self.begin == 0 {
                return Some(Column::Unknown);
            }
            self.next = (self.begin.saturating_sub(ROWS_AT_ONCE), self.begin);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::skyline::perception::Perception;
    use crate::skyline::profile::read_profile;
    use crate::testing::{undulating_scan, vlp16_surface};
    use glam::Vec3;

    fn trace(points_m: &[Vec3]) -> (ElevationProfile, ElevationProfile) {
        let config = PlannerConfig::default().perception;
        let mut observed = vlp16_surface();
        observed.project(points_m);
        let mut perception = Perception::new(config, observed.grid());
        let (mut traced, mut read) = (Vec::new(), Vec::new());
        perception.profile(&observed, &mut traced).unwrap();
        let surface = perception.surface(&observed).unwrap();
        read_profile(&observed, surface, config.variance_threshold, &mut read);
        (traced, read)
    }

    fn assert_same(traced: &[Column], read: &[Column], tolerance_deg: f64) {
        for (column, pair) in traced.iter().zip(read).enumerate() {
            match pair {
                (Column::Ground { elevation_rad: a }, Column::Ground { elevation_rad: b }) => {
                    assert!((a - b).abs().to_degrees() < tolerance_deg, "column {column}: {a} {b}");
                }
                (traced, read) => assert_eq!(traced, read, "column {column}"),
            }
        }
    }

    #[test]
    fn the_traced_edge_is_that_of_the_whole_surface() {
        for (from, to) in [(0, 360), (90, 270), (10, 40)] {
            let (traced, read) = trace(&undulating_scan(from, to));
            assert_same(&traced, &read, 0.05);
        }
    }

    #[test]
    fn a_turned_scan_gives_the_turned_profile() {
        let scan = undulating_scan(100, 200);
        let (here, _) = trace(&scan);
        for columns in [1, 7, 90, 180, 263] {
            let (sin, cos) = libm::sincos(COLUMN_STEP_RAD * columns as f64);
            let (sin, cos) = (sin as f32, cos as f32);
            let turned: Vec<Vec3> =
                scan.iter().map(|p| Vec3::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y, p.z)).collect();
            let (mut there, _) = trace(&turned);
            there.rotate_left(columns);
            assert_eq!(here, there, "turned by {columns} columns");
        }
    }
}

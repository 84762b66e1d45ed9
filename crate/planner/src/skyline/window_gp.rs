//! The sparse Gaussian process at freely placed inducing inputs, sector by sector.
//!
//! The kernel decays within a few length-scales, so each sector of the surface is predicted from the returns
//! and inducing inputs of a window around it; docs/design/perception.md gives the difference from the whole
//! surface. Azimuths are relative to the sector's centre, so the seam at ±π is like any other place.

use core::ops::Range;

use glam::DVec2;

use crate::config::PerceptionConfig;
use crate::gp::{jitter::GpError, sparse::SparseGp};
use crate::math::angle::difference_rad;
use crate::skyline::columns::{COLUMN_STEP_RAD, COLUMNS, column_azimuth_rad};
use crate::skyline::inducing::FarthestPoints;
use crate::skyline::occupancy::OccupancySurface;
use crate::skyline::surface::{PredictedSurface, REACH_LENGTH_SCALES, SECTOR_COLUMNS, SECTORS, row_rad};

/// The process with its workspace.
#[derive(Clone, Debug)]
pub(crate) struct WindowGp {
    config: PerceptionConfig,
    rows: usize,
    gp: SparseGp,
    farthest_points: FarthestPoints,
    chosen: Vec<usize>,
    is_inducing: Vec<bool>,
    /// Learned inducing inputs, in place of the farthest points.
    learned: Vec<DVec2>,
    window_inputs: Vec<DVec2>,
    window_targets: Vec<f64>,
    window_inducing: Vec<DVec2>,
    window_queries: Vec<DVec2>,
    window_mean: Vec<f64>,
    window_variance: Vec<f64>,
    /// Directions of one sector's part of the surfaces, azimuths relative to the sector's centre.
    queries: Vec<DVec2>,
}

impl WindowGp {
    /// A process that predicts this many rows.
    pub(crate) fn new(config: PerceptionConfig, rows: usize) -> Self {
        let queries = (0..SECTOR_COLUMNS)
            .flat_map(|column| (0..rows).map(move |row| (column, row)))
            .map(|(column, row)| {
                let azimuth = COLUMN_STEP_RAD * (column as f64 - 0.5 * (SECTOR_COLUMNS - 1) as f64);
                DVec2::new(azimuth, row_rad(row))
            })
            .collect();
        Self {
            config,
            rows,
            gp: SparseGp::new(config.kernel, config.noise_variance_m2),
            farthest_points: FarthestPoints::default(),
            chosen: Vec::new(),
            is_inducing: Vec::new(),
            learned: Vec::new(),
            window_inputs: Vec::new(),
            window_targets: Vec::new(),
            window_inducing: Vec::new(),
            window_queries: Vec::new(),
            window_mean: Vec::new(),
            window_variance: Vec::new(),
            queries,
        }
    }

    /// Sets learned inducing inputs for the next prediction; none for farthest points.
    pub(crate) fn set_inducing_inputs(&mut self, learned: Vec<DVec2>) {
        self.learned = learned;
    }

    /// Predicts both surfaces from the observed one.
    pub(crate) fn predict(
        &mut self,
        observed: &OccupancySurface,
        surface: &mut PredictedSurface,
    ) -> Result<(), GpError> {
        self.chosen.clear();
        if self.learned.is_empty() {
            self.farthest_points.choose_cells(observed, &self.config, &mut self.chosen);
        }
        self.is_inducing.clear();
        self.is_inducing.resize(observed.cells().len(), false);
        for &index in &self.chosen {
            self.is_inducing[index] = true;
        }
        surface.diagnostics.inducing_inputs = self.chosen.len() + self.learned.len();
        surface.diagnostics.jitter = 0.0;
        (0..SECTORS).try_for_each(|sector| self.predict_sector(sector, observed, surface))
    }

    fn predict_sector(
        &mut self,
        sector: usize,
        observed: &OccupancySurface,
        surface: &mut PredictedSurface,
    ) -> Result<(), GpError> {
        let margin = REACH_LENGTH_SCALES * self.config.kernel.length_scales_rad[0];
        // Beyond half a turn the window would overlap itself.
        let margin_columns = ((margin / COLUMN_STEP_RAD) as usize).min((COLUMNS - SECTOR_COLUMNS) / 2);
        let first_column = sector * SECTOR_COLUMNS + COLUMNS - margin_columns;
        let first_azimuth = self.queries[0].x - COLUMN_STEP_RAD * margin_columns as f64;

        self.window_inputs.clear();
        self.window_targets.clear();
        self.window_inducing.clear();
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        for offset in 0..SECTOR_COLUMNS + 2 * margin_columns {
            let azimuth = first_azimuth + COLUMN_STEP_RAD * offset as f64;
            let span = observed.column_span((first_column + offset) % COLUMNS);
            for (cell, inducing) in observed.cells()[span.clone()].iter().zip(&self.is_inducing[span]) {
                let local = DVec2::new(azimuth, cell.direction_rad().y);
                lowest = local.y.min(lowest);
                highest = local.y.max(highest);
                self.window_inputs.push(local);
                self.window_targets.push(cell.occupancy_m);
                if *inducing {
                    self.window_inducing.push(local);
                }
            }
        }

        let half_width = COLUMN_STEP_RAD * (0.5 * SECTOR_COLUMNS as f64 + margin_columns as f64);
        let centre = column_azimuth_rad(sector * SECTOR_COLUMNS) - self.queries[0].x;
        let local = |z: &DVec2| DVec2::new(difference_rad(z.x, centre), z.y);
        self.window_inducing.extend(self.learned.iter().map(local).filter(|z| z.x.abs() <= half_width));

        let span = sector * SECTOR_COLUMNS * self.rows..(sector + 1) * SECTOR_COLUMNS * self.rows;
        let mean = &mut surface.mean_m[span.clone()];
        let variance = &mut surface.relative_variance[span];
        mean.fill(0.0);
        variance.fill(1.0);
        if self.window_inducing.is_empty() {
            return Ok(());
        }
        self.gp.fit(&self.window_inputs, &self.window_targets, &self.window_inducing)?;
        surface.diagnostics.jitter = surface.diagnostics.jitter.max(self.gp.jitter());

        // Rows far above and below every return keep the prior.
        let margin = REACH_LENGTH_SCALES * self.config.kernel.length_scales_rad[1];
        let near = |row: &usize| (lowest - margin..=highest + margin).contains(&row_rad(*row));
        let rows: Range<usize> = match ((0..self.rows).find(near), (0..self.rows).rfind(near)) {
            (Some(first), Some(last)) => first..last + 1,
            _ => return Ok(()),
        };
        self.window_queries.clear();
        for column in self.queries.chunks_exact(self.rows) {
            self.window_queries.extend_from_slice(&column[rows.clone()]);
        }
        let count = self.window_queries.len();
        self.window_mean.resize(count, 0.0);
        self.window_variance.resize(count, 0.0);
        self.gp.predict(&self.window_queries, &mut self.window_mean, &mut self.window_variance);
        let scale = 1.0 / self.config.kernel.variance;
        for column in 0..SECTOR_COLUMNS {
            let from = column * rows.len()..(column + 1) * rows.len();
            let to = column * self.rows + rows.start..column * self.rows + rows.end;
            mean[to.clone()].copy_from_slice(&self.window_mean[from.clone()]);
            for (value, predicted) in variance[to].iter_mut().zip(&self.window_variance[from]) {
                *value = predicted * scale;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::skyline::profile::{Column, read_profile};
    use crate::testing::{undulating_scan, vlp16_surface};
    use glam::Vec3;

    const ROWS: usize = 31;

    /// The default with inducing inputs so dense that their choice hardly matters.
    fn dense() -> PerceptionConfig {
        PerceptionConfig { inducing_spacing_length_scales: 0.6, ..PlannerConfig::default().perception }
    }

    fn profile(observed: &OccupancySurface, surface: &PredictedSurface) -> Vec<Column> {
        let mut profile = Vec::new();
        let threshold = PlannerConfig::default().perception.variance_threshold;
        read_profile(observed, surface, threshold, &mut profile);
        profile
    }

    #[test]
    fn the_windows_give_the_profile_of_the_whole_surface() {
        // Half the circle, so that the process over the whole surface has no seam.
        let mut observed = vlp16_surface();
        observed.project(&undulating_scan(90, 270));
        let config = dense();
        let mut windows = WindowGp::new(config, ROWS);
        let mut windowed = PredictedSurface::new(ROWS);
        windows.predict(&observed, &mut windowed).unwrap();

        let inputs: Vec<DVec2> = observed.cells().iter().map(|c| c.direction_rad()).collect();
        let targets: Vec<f64> = observed.cells().iter().map(|c| c.occupancy_m).collect();
        let inducing: Vec<DVec2> = windows.chosen.iter().map(|&index| inputs[index]).collect();
        let queries: Vec<DVec2> = (0..COLUMNS)
            .flat_map(|column| (0..ROWS).map(move |row| (column, row)))
            .map(|(c, row)| DVec2::new(crate::skyline::columns::column_azimuth_rad(c), row_rad(row)))
            .collect();
        let mut whole = PredictedSurface::new(ROWS);
        let mut gp = SparseGp::new(config.kernel, config.noise_variance_m2);
        gp.fit(&inputs, &targets, &inducing).unwrap();
        gp.predict(&queries, &mut whole.mean_m, &mut whole.relative_variance);

        let difference = windowed.relative_variance.iter().zip(&whole.relative_variance);
        let most = difference.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(most < 0.01, "relative variance differs by {most}");
        for (ours, theirs) in profile(&observed, &windowed).iter().zip(profile(&observed, &whole)) {
            match (ours, theirs) {
                (Column::Ground { elevation_rad: a }, Column::Ground { elevation_rad: b }) => {
                    assert!((a - b).abs().to_degrees() < 0.05, "{a} {b}");
                }
                (ours, theirs) => assert_eq!(*ours, theirs),
            }
        }
    }

    #[test]
    fn the_seam_is_like_any_other_place() {
        // Half a turn moves the surface; only the inducing inputs are chosen from another first return.
        let (mut here, mut there) = (vlp16_surface(), vlp16_surface());
        here.project(&undulating_scan(100, 160));
        let turned: Vec<Vec3> =
            undulating_scan(100, 160).iter().map(|p| Vec3::new(-p.x, -p.y, p.z)).collect();
        there.project(&turned);
        let config = dense();
        let mut gp = WindowGp::new(config, ROWS);
        let (mut a, mut b) = (PredictedSurface::new(ROWS), PredictedSurface::new(ROWS));
        gp.predict(&here, &mut a).unwrap();
        gp.predict(&there, &mut b).unwrap();
        for column in 0..COLUMNS {
            let opposite = (column + COLUMNS / 2) % COLUMNS;
            let (ours, turned) = (a.variance_column(column), b.variance_column(opposite));
            for (x, y) in ours.iter().zip(turned) {
                assert!((x - y).abs() < 0.04, "column {column}: {x} {y}");
            }
        }
    }
}

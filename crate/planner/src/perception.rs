//! The perception model (paper, section V-A): a sparse Gaussian process over the occupancy surface, its mean (the
//! reconstructed occupancy) and its variance (the variance surface).
//!
//! The kernel decays within a few length-scales, so the surface is predicted sector by sector, each from the returns
//! and inducing inputs of a window around it; DESIGN.md gives the difference from the whole surface. Azimuths are taken
//! relative to the sector's centre, so the seam at ±π is like any other place.

use core::f64::consts::PI;
use core::ops::Range;

use glam::DVec2;

use crate::config::PerceptionConfig;
use crate::inducing::FarthestPoints;
use crate::occupancy::{COLUMN_STEP_RAD, COLUMNS, LOWEST_ELEVATION_RAD, OccupancySurface};
use crate::sparse_gp::{GpError, SparseGp};

/// Elevation rows of the predicted surfaces: -15° to +15°, one degree apart.
pub const ROWS: usize = 31;
/// Spacing of the elevation rows.
pub const ROW_STEP_RAD: f64 = PI / 180.0;

const SECTORS: usize = 18;
const SECTOR_COLUMNS: usize = COLUMNS / SECTORS;
/// How far beyond its sector a window reaches. At 3.5 length-scales the kernel is below 1 % of its peak.
const WINDOW_MARGIN_LENGTH_SCALES: f64 = 3.5;

/// Elevation of a row of the predicted surfaces.
pub fn row_elevation_rad(row: usize) -> f64 {
    LOWEST_ELEVATION_RAD + ROW_STEP_RAD * row as f64
}

/// The two surfaces the process predicts, [`COLUMNS`] × [`ROWS`], column by column, lowest row first.
#[derive(Clone, Debug)]
pub struct PredictedSurface {
    /// Predicted occupancy, metres.
    pub mean_m: Vec<f64>,
    /// Predictive variance of the occupancy, as a share of the signal variance: 1 where nothing was observed.
    pub relative_variance: Vec<f64>,
    /// Inducing inputs used.
    pub inducing_inputs: usize,
    /// Largest jitter any sector needed.
    pub jitter: f64,
}

impl PredictedSurface {
    /// The relative variances of one column, lowest row first.
    pub fn variance_column(&self, column: usize) -> &[f64] {
        &self.relative_variance[column * ROWS..(column + 1) * ROWS]
    }
}

/// The process with its workspace.
#[derive(Clone, Debug)]
pub(crate) struct Perception {
    config: PerceptionConfig,
    gp: SparseGp,
    farthest_points: FarthestPoints,
    directions: Vec<DVec2>,
    chosen: Vec<usize>,
    is_inducing: Vec<bool>,
    window_inputs: Vec<DVec2>,
    window_targets: Vec<f64>,
    window_inducing: Vec<DVec2>,
    window_queries: Vec<DVec2>,
    window_mean: Vec<f64>,
    window_variance: Vec<f64>,
    /// Directions of one sector's part of the surfaces, azimuths relative to the sector's centre.
    queries: Vec<DVec2>,
    surface: PredictedSurface,
}

impl Perception {
    pub(crate) fn new(config: PerceptionConfig) -> Self {
        let queries = (0..SECTOR_COLUMNS)
            .flat_map(|column| (0..ROWS).map(move |row| (column, row)))
            .map(|(column, row)| {
                let azimuth = COLUMN_STEP_RAD * (column as f64 - 0.5 * (SECTOR_COLUMNS - 1) as f64);
                DVec2::new(azimuth, row_elevation_rad(row))
            })
            .collect();
        Self {
            config,
            gp: SparseGp::new(config.kernel, config.noise_variance_m2),
            farthest_points: FarthestPoints::default(),
            directions: Vec::new(),
            chosen: Vec::new(),
            is_inducing: Vec::new(),
            window_inputs: Vec::new(),
            window_targets: Vec::new(),
            window_inducing: Vec::new(),
            window_queries: Vec::new(),
            window_mean: Vec::new(),
            window_variance: Vec::new(),
            queries,
            surface: PredictedSurface {
                mean_m: vec![0.0; COLUMNS * ROWS],
                relative_variance: vec![1.0; COLUMNS * ROWS],
                inducing_inputs: 0,
                jitter: 0.0,
            },
        }
    }

    pub(crate) fn surface(&self) -> &PredictedSurface {
        &self.surface
    }

    /// Predicts both surfaces from the observed one.
    pub(crate) fn predict(&mut self, observed: &OccupancySurface) -> Result<(), GpError> {
        self.directions.clear();
        self.directions.extend(observed.cells().iter().map(|cell| cell.direction_rad()));
        self.farthest_points.choose(
            &self.directions,
            self.config.kernel.length_scales_rad,
            self.config.inducing_spacing_length_scales,
            self.config.max_inducing_inputs,
            &mut self.chosen,
        );
        self.is_inducing.clear();
        self.is_inducing.resize(self.directions.len(), false);
        for &index in &self.chosen {
            self.is_inducing[index] = true;
        }
        self.surface.inducing_inputs = self.chosen.len();
        self.surface.jitter = 0.0;
        (0..SECTORS).try_for_each(|sector| self.predict_sector(sector, observed))
    }

    fn predict_sector(&mut self, sector: usize, observed: &OccupancySurface) -> Result<(), GpError> {
        let margin = WINDOW_MARGIN_LENGTH_SCALES * self.config.kernel.length_scales_rad[0];
        // Beyond half a turn the window would meet itself.
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

        let span = sector * SECTOR_COLUMNS * ROWS..(sector + 1) * SECTOR_COLUMNS * ROWS;
        let mean = &mut self.surface.mean_m[span.clone()];
        let variance = &mut self.surface.relative_variance[span];
        mean.fill(0.0);
        variance.fill(1.0);
        if self.window_inducing.is_empty() {
            return Ok(());
        }
        self.gp.fit(&self.window_inputs, &self.window_targets, &self.window_inducing)?;
        self.surface.jitter = self.surface.jitter.max(self.gp.jitter());

        // Rows far above and below every return keep the prior.
        let margin = WINDOW_MARGIN_LENGTH_SCALES * self.config.kernel.length_scales_rad[1];
        let near = |row: &usize| (lowest - margin..=highest + margin).contains(&row_elevation_rad(*row));
        let rows: Range<usize> = match ((0..ROWS).find(near), (0..ROWS).rfind(near)) {
            (Some(first), Some(last)) => first..last + 1,
            _ => return Ok(()),
        };
        self.window_queries.clear();
        for column in self.queries.chunks_exact(ROWS) {
            self.window_queries.extend_from_slice(&column[rows.clone()]);
        }
        let count = self.window_queries.len();
        self.window_mean.resize(count, 0.0);
        self.window_variance.resize(count, 0.0);
        self.gp.predict(&self.window_queries, &mut self.window_mean, &mut self.window_variance);
        let scale = 1.0 / self.config.kernel.variance;
        for column in 0..SECTOR_COLUMNS {
            let from = column * rows.len()..(column + 1) * rows.len();
            let to = column * ROWS + rows.start..column * ROWS + rows.end;
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
    use crate::profile::{Column, read_profile};
    use glam::Vec3;

    /// Returns of an undulating skyline over the columns `from..to`.
    fn scan(from: usize, to: usize) -> Vec<Vec3> {
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

    fn profile(observed: &OccupancySurface, surface: &PredictedSurface) -> Vec<Column> {
        let mut profile = Vec::new();
        let threshold = PlannerConfig::default().perception.variance_threshold;
        read_profile(observed, surface, threshold, &mut profile);
        profile
    }

    #[test]
    fn the_windows_give_the_profile_of_the_whole_surface() {
        // Half the circle, so that the process over the whole surface has no seam.
        let mut observed = OccupancySurface::new(7.0);
        observed.project(&scan(90, 270));
        let config = PlannerConfig::default().perception;
        let mut perception = Perception::new(config);
        perception.predict(&observed).unwrap();

        let inputs: Vec<DVec2> = observed.cells().iter().map(|c| c.direction_rad()).collect();
        let targets: Vec<f64> = observed.cells().iter().map(|c| c.occupancy_m).collect();
        let inducing: Vec<DVec2> = perception.chosen.iter().map(|&index| inputs[index]).collect();
        let queries: Vec<DVec2> = (0..COLUMNS)
            .flat_map(|column| (0..ROWS).map(move |row| (column, row)))
            .map(|(c, row)| DVec2::new(crate::occupancy::column_azimuth_rad(c), row_elevation_rad(row)))
            .collect();
        let mut whole = perception.surface().clone();
        let mut gp = SparseGp::new(config.kernel, config.noise_variance_m2);
        gp.fit(&inputs, &targets, &inducing).unwrap();
        gp.predict(&queries, &mut whole.mean_m, &mut whole.relative_variance);

        let windowed = perception.surface();
        let difference = windowed.relative_variance.iter().zip(&whole.relative_variance);
        let most = difference.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(most < 0.01, "relative variance differs by {most}");
        for (ours, theirs) in profile(&observed, windowed).iter().zip(profile(&observed, &whole)) {
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
        let (mut here, mut there) = (OccupancySurface::new(7.0), OccupancySurface::new(7.0));
        here.project(&scan(100, 160));
        let turned: Vec<Vec3> = scan(100, 160).iter().map(|p| Vec3::new(-p.x, -p.y, p.z)).collect();
        there.project(&turned);
        let config = PlannerConfig::default().perception;
        let (mut a, mut b) = (Perception::new(config), Perception::new(config));
        a.predict(&here).unwrap();
        b.predict(&there).unwrap();
        for column in 0..COLUMNS {
            let opposite = (column + COLUMNS / 2) % COLUMNS;
            let (ours, turned) = (a.surface().variance_column(column), b.surface().variance_column(opposite));
            for (x, y) in ours.iter().zip(turned) {
                assert!((x - y).abs() < 0.02, "column {column}: {x} {y}");
            }
        }
    }
}

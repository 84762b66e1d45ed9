//! The sparse Gaussian process on the lattice of the sensor's beams: the same posterior as
//! [`crate::gp::sparse`], far faster.
//!
//! Cells lie on a lattice of degrees and rings, and so do the inducing inputs here, every few columns and
//! rings where there are returns. Hence:
//! - every covariance is one of a few thousand values, tabulated once;
//! - the products Φ = K_uf K_fu are summed once around the circle, a column of cells at a time, only between
//!   inducing inputs that share returns within the kernel's reach;
//! - each sector takes its part of Φ and factors L Lᵀ = K_uu and S Sᵀ = K_uu + Φ / σₙ². At a direction with
//!   covariances k: variance = k_** - |L⁻¹k|² + |S⁻¹k|², mean = (S⁻¹k)ᵀ S⁻¹ K_uf y / σₙ².
//!
//! Azimuths run on past the circle's end ("unrolled"), so that every window is one stretch of inducing
//! inputs. They begin at a column that the returns themselves choose, so that a turned scan gives the turned
//! result to the last bit.

use core::ops::Range;

use crate::config::PerceptionConfig;
use crate::gp::jitter::{GpError, with_rising_jitter};
use crate::math::cholesky::{NotPositiveDefinite, cholesky};
use crate::math::linalg;
use crate::math::panels::{self, Row, WIDTH};
use crate::skyline::beam_grid::{BeamGrid, RING_STEP_RAD, ROWS_PER_RING};
use crate::skyline::columns::{COLUMN_STEP_RAD, COLUMNS};
use crate::skyline::occupancy::OccupancySurface;
use crate::skyline::surface::{
    GpDiagnostics, PredictedSurface, REACH_LENGTH_SCALES, ROW_STEP_RAD, SECTOR_COLUMNS, SECTORS,
};

/// The cells of one column that the process is to be fitted to, one bit for each ring.
pub(crate) type RingMask = u64;

/// The kernel on the lattice.
#[derive(Clone, Debug)]
struct Covariances {
    values: Vec<f64>,
    rows: usize,
}

impl Covariances {
    fn new(config: &PerceptionConfig, rows: usize) -> Self {
        let values = (0..=COLUMNS / 2)
            .flat_map(|columns| (0..rows).map(move |row| (columns, row)))
            .map(|(columns, row)| {
                let apart = glam::DVec2::new(COLUMN_STEP_RAD * columns as f64, ROW_STEP_RAD * row as f64);
                config.kernel.covariance(glam::DVec2::ZERO, apart)
            })
            .collect();
        Self { values, rows }
    }

    /// Covariances at this many columns apart, by rows apart. Half a turn is the farthest.
    #[inline]
    fn at(&self, columns: usize) -> &[f64] {
        let columns = columns.min(COLUMNS - columns.min(COLUMNS));
        &self.values[columns * self.rows..(columns + 1) * self.rows]
    }
}

/// A direction on the lattice of predictions: column within the sector, and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Query {
    pub(crate) column: usize,
    pub(crate) row: usize,
}

/// The process and its workspace.
#[derive(Clone, Debug)]
pub(crate) struct BeamGp {
    rings: usize,
    covariances: Covariances,
    noise_variance: f64,
    signal_variance: f64,
    stride_columns: usize,
    stride_rings: usize,
    /// Columns beyond which the kernel counts as zero, and by which a window exceeds its sector on either
    /// side.
    margin_columns: usize,
    /// The column where the first sector and the lattice begin.
    origin: usize,
    /// Rows of the inducing inputs in each column, where somebody else has placed them.
    placed: Option<Vec<Vec<usize>>>,
    /// Row of each inducing input, position by position.
    rows: Vec<usize>,
    /// Where each position's inducing inputs begin; one more than positions.
    starts: Vec<usize>,
    /// Position of each inducing input; its unrolled column is this times the stride.
    positions: Vec<usize>,
    /// Φ below the diagonal: row i holds its entries from `first[i]` to i, at `offsets[i]`.
    products: Vec<f64>,
    first: Vec<usize>,
    offsets: Vec<usize>,
    /// K_uf y.
    projections: Vec<f64>,
    /// Covariances of one column's cells with the inducing inputs in reach, an even number of rows.
    column_covariances: Vec<f64>,
    window: Range<usize>,
    l: Vec<f64>,
    s: Vec<f64>,
    /// S⁻¹ K_uf y / σₙ².
    c: Vec<f64>,
    /// L⁻¹ k of one panel of queries, and S⁻¹ k of all of them.
    prior: Vec<Row>,
    posterior: Vec<Row>,
    jitter: f64,
}

impl BeamGp {
    pub(crate) fn new(config: &PerceptionConfig, grid: &BeamGrid) -> Self {
        let rings = grid.rings();
        let [azimuth_scale, elevation_scale] = config.kernel.length_scales_rad;
        let spacing = config.inducing_spacing_length_scales;
        // A stride that does not divide the circle would leave a seam.
        let widest = ((spacing * azimuth_scale / COLUMN_STEP_RAD) as usize).clamp(1, COLUMNS);
        let stride_columns = (1..=widest).rev().find(|s| COLUMNS.is_multiple_of(*s)).unwrap_or(1);
        let stride_rings = ((spacing * elevation_scale / RING_STEP_RAD) as usize).clamp(1, rings);
        let reach = (REACH_LENGTH_SCALES * azimuth_scale / COLUMN_STEP_RAD) as usize;
        // Beyond half a turn a window would overlap itself.
        let margin_columns = reach.min((COLUMNS - SECTOR_COLUMNS) / 2);
        let positions = (COLUMNS + 2 * margin_columns) / stride_columns + 1;
        let most_inputs = positions * (rings / stride_rings + 1);
        Self {
            rings,
            covariances: Covariances::new(config, grid.rows() + ROWS_PER_RING * stride_rings),
            noise_variance: config.noise_variance_m2,
            signal_variance: config.kernel.variance,
            stride_columns,
            stride_rings,
            margin_columns,
            origin: 0,
            placed: None,
            rows: Vec::with_capacity(most_inputs),
            starts: Vec::with_capacity(positions + 1),
            positions: Vec::with_capacity(most_inputs),
            products: Vec::new(),
            first: Vec::with_capacity(most_inputs),
            offsets: Vec::with_capacity(most_inputs),
            projections: Vec::new(),
            column_covariances: Vec::new(),
            window: 0..0,
            l: Vec::new(),
            s: Vec::new(),
            c: Vec::new(),
            prior: Vec::new(),
            posterior: Vec::new(),
            jitter: 0.0,
        }
    }

    /// Places the inducing inputs at these columns and rows from now on, instead of every few of both. Rows
    /// lie where [`BeamGp::directions`] may give them.
    pub(crate) fn place(&mut self, inputs: impl Iterator<Item = (usize, usize)>) {
        self.stride_columns = 1;
        let mut placed = vec![Vec::new(); COLUMNS];
        for (column, row) in inputs {
            placed[column].push(row);
        }
        for rows in &mut placed {
            rows.sort_unstable();
        }
        self.placed = Some(placed);
    }

    /// Column and row of each inducing input of the last scan.
    pub(crate) fn directions(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.inducing_inputs()).map(|input| {
            (self.column_at((self.positions[input] * self.stride_columns) as i64), self.rows[input])
        })
    }

    /// Takes the cells in `masks` (one for each column), and places the inducing inputs among them.
    pub(crate) fn observe(&mut self, observed: &OccupancySurface, masks: &[RingMask]) {
        self.origin = least_rotation(masks);
        self.place_inducing_inputs(masks);
        self.reserve_products();
        let from = -(self.margin_columns as i64);
        let to = (COLUMNS + 3 * self.margin_columns) as i64;
        for unrolled in from..=to {
            let column = self.column_at(unrolled);
            if masks[column] != 0 {
                self.add_column(unrolled, masks[column], observed, column);
            }
        }
    }

    /// Inducing inputs around the circle, none counted twice.
    pub(crate) fn inducing_inputs(&self) -> usize {
        self.starts[COLUMNS / self.stride_columns]
    }

    /// The column of the circle at a place of the unrolled one.
    fn column_at(&self, unrolled: i64) -> usize {
        (self.origin as i64 + unrolled - self.margin_columns as i64).rem_euclid(COLUMNS as i64) as usize
    }

    /// The columns of a sector.
    pub(crate) fn sector_columns(&self, sector: usize) -> impl Iterator<Item = usize> + use<> {
        let first = self.origin + sector * SECTOR_COLUMNS;
        (first..first + SECTOR_COLUMNS).map(|column| column % COLUMNS)
    }

    fn place_inducing_inputs(&mut self, masks: &[RingMask]) {
        self.rows.clear();
        self.starts.clear();
        self.positions.clear();
        let stride = self.stride_columns as i64;
        let last = (COLUMNS + 2 * self.margin_columns) / self.stride_columns;
        for position in 0..=last {
            self.starts.push(self.rows.len());
            if let Some(placed) = &self.placed {
                let rows = &placed[self.column_at(position as i64)];
                self.rows.extend_from_slice(rows);
                self.positions.extend(core::iter::repeat_n(position, rows.len()));
                continue;
            }
            let middle = position as i64 * stride;
            let near = middle - stride / 2..middle + (stride + 1) / 2;
            let rings = near.fold(0, |rings, unrolled| rings | masks[self.column_at(unrolled)]);
            let mut last_row = None;
            for ring in (0..self.rings).filter(|ring| rings >> ring & 1 == 1) {
                let nearest = (ring + self.stride_rings / 2) / self.stride_rings;
                let row = ROWS_PER_RING * self.stride_rings * nearest;
                if last_row != Some(row) {
                    last_row = Some(row);
                    self.rows.push(row);
                    self.positions.push(position);
                }
            }
        }
        self.starts.push(self.rows.len());
    }

    /// Zeroes Φ and K_uf y, with room for the pairs that share returns.
    fn reserve_products(&mut self) {
        self.first.clear();
        self.offsets.clear();
        let mut size = 0;
        for (input, &position) in self.positions.iter().enumerate() {
            let column = position * self.stride_columns;
            let farthest = column.saturating_sub(2 * self.margin_columns).div_ceil(self.stride_columns);
            let first = self.starts[farthest];
            self.first.push(first);
            self.offsets.push(size);
            size += input + 1 - first;
        }
        self.products.clear();
        self.products.resize(size, 0.0);
        self.projections.clear();
        self.projections.resize(self.rows.len(), 0.0);
    }

    fn add_column(&mut self, unrolled: i64, mask: RingMask, observed: &OccupancySurface, column: usize) {
        let margin = self.margin_columns as i64;
        let positions = self.starts.len() - 1;
        let (low, high) = ((unrolled - margin).max(0) as usize, (unrolled + margin) as usize);
        let from = low.div_ceil(self.stride_columns);
        let to = (high / self.stride_columns + 1).min(positions);
        if from >= to {
            return;
        }
        let inputs = self.starts[from]..self.starts[to];
        let count = inputs.len();
        if count == 0 {
            return;
        }
        self.column_covariances.clear();
        for cell in observed.column(column).iter().filter(|cell| mask >> cell.ring & 1 == 1) {
            let begin = self.column_covariances.len();
            for position in from..to {
                let apart = ((position * self.stride_columns) as i64).abs_diff(unrolled) as usize;
                let values = self.covariances.at(apart);
                let rows = &self.rows[self.starts[position]..self.starts[position + 1]];
                self.column_covariances
                    .extend(rows.iter().map(|row| values[row.abs_diff(ROWS_PER_RING * cell.ring)]));
            }
            let row = &self.column_covariances[begin..];
            for (sum, covariance) in self.projections[inputs.clone()].iter_mut().zip(row) {
                *sum += covariance * cell.occupancy_m;
            }
        }
        // Rows are added two by two.
        if !(self.column_covariances.len() / count).is_multiple_of(2) {
            self.column_covariances.resize(self.column_covariances.len() + count, 0.0);
        }
        let (first, offsets) = (&self.first, &self.offsets);
        let begin = inputs.start;
        let place = |input: usize| offsets[input] + begin - first[input];
        linalg::add_products(&self.column_covariances, inputs, place, &mut self.products);
    }

    /// Factors the window around a sector. Returns whether there is anything in it.
    ///
    /// # Errors
    /// [`GpError::IllConditioned`].
    pub(crate) fn enter(&mut self, sector: usize) -> Result<bool, GpError> {
        debug_assert!(sector < SECTORS, "there are no more sectors");
        let begin = sector * SECTOR_COLUMNS;
        let end = begin + SECTOR_COLUMNS + 2 * self.margin_columns;
        self.window =
            self.starts[begin.div_ceil(self.stride_columns)]..self.starts[end / self.stride_columns + 1];
        let m = self.window.len();
        if m == 0 {
            return Ok(false);
        }
        self.l.resize(m * m, 0.0);
        self.s.resize(m * m, 0.0);
        let Self { l, s, window, positions, rows, covariances, stride_columns, prior, .. } = self;
        self.jitter = with_rising_jitter(m, |jitter| {
            for (i, row) in l.chunks_exact_mut(m).enumerate() {
                let here = window.start + i;
                for (j, value) in row[..=i].iter_mut().enumerate() {
                    let there = window.start + j;
                    let apart = (positions[here] - positions[there]) * *stride_columns;
                    *value = covariances.at(apart)[rows[here].abs_diff(rows[there])];
                }
                row[i] += jitter;
            }
            s.copy_from_slice(l);
            cholesky(l, m, prior)
        })?;
        let inverse_noise = 1.0 / self.noise_variance;
        for (i, row) in self.s.chunks_exact_mut(m).enumerate() {
            let here = self.window.start + i;
            let first = self.first[here].max(self.window.start);
            let offset = self.offsets[here] + first - self.first[here];
            let products = &self.products[offset..=offset + here - first];
            for (value, product) in row[first - self.window.start..].iter_mut().zip(products) {
                *value += product * inverse_noise;
            }
        }
        cholesky(&mut self.s, m, &mut self.prior)
            .map_err(|NotPositiveDefinite| GpError::IllConditioned { inducing: m, jitter: self.jitter })?;
        Ok(true)
    }

    /// Jitter that the last window needed.
    pub(crate) fn jitter(&self) -> f64 {
        self.jitter
    }

    /// Variance, as a share of the signal variance, at directions of the sector entered last.
    pub(crate) fn relative_variances(&mut self, sector: usize, queries: &[Query], variances: &mut Vec<f64>) {
        variances.clear();
        self.posterior.clear();
        for queries in queries.chunks(WIDTH) {
            self.fill_covariances(sector, queries);
            let begin = self.posterior.len();
            self.posterior.extend_from_slice(&self.prior);
            let posterior = &mut self.posterior[begin..];
            panels::solve_lower(&self.l, 0, &mut self.prior);
            panels::solve_lower(&self.s, 0, posterior);
            let mut sums = [self.signal_variance; WIDTH];
            for (t, s) in self.prior.iter().zip(posterior.iter()) {
                for lane in 0..WIDTH {
                    sums[lane] += s[lane] * s[lane] - t[lane] * t[lane];
                }
            }
            variances.extend(sums[..queries.len()].iter().map(|sum| sum / self.signal_variance));
        }
    }

    /// Mean occupancy at the directions of the last call of `relative_variances`, as many as `means` holds.
    pub(crate) fn means(&mut self, means: &mut [f64]) {
        let m = self.window.len();
        self.c.clear();
        self.c.extend(self.projections[self.window.clone()].iter().map(|p| p / self.noise_variance));
        linalg::solve_lower_vector(&self.s, m, &mut self.c);
        for (panel, means) in self.posterior.chunks_exact(m).zip(means.chunks_mut(WIDTH)) {
            let mut sums = [0.0; WIDTH];
            for (s, c) in panel.iter().zip(&self.c) {
                for lane in 0..WIDTH {
                    sums[lane] += s[lane] * c;
                }
            }
            means.copy_from_slice(&sums[..means.len()]);
        }
    }

    /// Both surfaces, from all cells of the observed one.
    ///
    /// # Errors
    /// [`GpError::IllConditioned`].
    pub(crate) fn predict(
        &mut self,
        observed: &OccupancySurface,
        surface: &mut PredictedSurface,
    ) -> Result<(), GpError> {
        self.observe(observed, &all_cells(observed));
        surface.diagnostics =
            GpDiagnostics { inducing_inputs: self.inducing_inputs(), ..GpDiagnostics::default() };
        surface.mean_m.fill(0.0);
        surface.relative_variance.fill(1.0);
        let rows = surface.rows();
        let queries: Vec<Query> =
            (0..SECTOR_COLUMNS).flat_map(|column| (0..rows).map(move |row| Query { column, row })).collect();
        let mut values = Vec::new();
        for sector in 0..SECTORS {
            if !self.enter(sector)? {
                continue;
            }
            surface.diagnostics.jitter = surface.diagnostics.jitter.max(self.jitter());
            self.relative_variances(sector, &queries, &mut values);
            scatter(&values, rows, self.sector_columns(sector), &mut surface.relative_variance);
            self.means(&mut values);
            scatter(&values, rows, self.sector_columns(sector), &mut surface.mean_m);
        }
        Ok(())
    }

    /// Covariances of the window's inducing inputs with a panel of queries; zero beyond the last.
    fn fill_covariances(&mut self, sector: usize, queries: &[Query]) {
        self.prior.clear();
        let begin = sector * SECTOR_COLUMNS + self.margin_columns;
        for input in self.window.clone() {
            let (column, row) = (self.positions[input] * self.stride_columns, self.rows[input]);
            let mut lanes = [0.0; WIDTH];
            for (lane, query) in lanes.iter_mut().zip(queries) {
                *lane = self.covariances.at(column.abs_diff(begin + query.column))[row.abs_diff(query.row)];
            }
            self.prior.push(lanes);
        }
    }
}

/// Copies whole columns of a sector to their places.
fn scatter(values: &[f64], rows: usize, columns: impl Iterator<Item = usize>, surface: &mut [f64]) {
    for (values, column) in values.chunks_exact(rows).zip(columns) {
        surface[column * rows..(column + 1) * rows].copy_from_slice(values);
    }
}

/// Every cell of every column.
pub(crate) fn all_cells(observed: &OccupancySurface) -> Vec<RingMask> {
    (0..COLUMNS).map(|column| occupied_rings(observed, column)).collect()
}

/// The rings with a cell in this column.
pub(crate) fn occupied_rings(observed: &OccupancySurface, column: usize) -> RingMask {
    observed.column(column).iter().fold(0, |mask, cell| mask | 1 << cell.ring)
}

/// The begin of the smallest rotation of a circular sequence.
fn least_rotation(masks: &[RingMask]) -> usize {
    let (mut best, mut other, mut same) = (0, 1, 0);
    while other < masks.len() && same < masks.len() {
        let (a, b) = (masks[(best + same) % masks.len()], masks[(other + same) % masks.len()]);
        match a.cmp(&b) {
            core::cmp::Ordering::Equal => {
                same += 1;
                continue;
            }
            core::cmp::Ordering::Less => other += same + 1,
            core::cmp::Ordering::Greater => {
                // No rotation that begins before the difference is smaller.
                best = (best + same + 1).max(other);
                other = best + 1;
            }
        }
        same = 0;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::gp::sparse::SparseGp;
    use crate::skyline::columns::column_azimuth_rad;
    use crate::skyline::surface::row_rad;
    use crate::testing::{undulating_scan, vlp16_surface};
    use glam::DVec2;

    proptest::proptest! {
        #[test]
        fn the_least_rotation_is_the_smallest(masks in proptest::collection::vec(0..3_u64, 1..12)) {
            let rotated = |by: usize| {
                let mut rotated = masks.clone();
                rotated.rotate_left(by);
                rotated
            };
            let smallest = (0..masks.len()).map(rotated).min().unwrap();
            proptest::prop_assert_eq!(rotated(least_rotation(&masks)), smallest);
        }
    }

    #[test]
    fn the_lattice_gives_the_posterior_of_the_dense_process() {
        // Half the circle, so that the process over the whole surface has no seam.
        let mut observed = vlp16_surface();
        observed.project(&undulating_scan(90, 270));
        let config = PlannerConfig::default().perception;
        let mut gp = BeamGp::new(&config, observed.grid());
        gp.observe(&observed, &all_cells(&observed));

        let inducing: Vec<DVec2> = (0..gp.inducing_inputs())
            .map(|i| {
                let column = gp.column_at((gp.positions[i] * gp.stride_columns) as i64);
                DVec2::new(column_azimuth_rad(column), row_rad(gp.rows[i]))
            })
            .collect();
        let inputs: Vec<DVec2> = observed.cells().iter().map(|c| c.direction_rad()).collect();
        let targets: Vec<f64> = observed.cells().iter().map(|c| c.occupancy_m).collect();
        let mut dense = SparseGp::new(config.kernel, config.noise_variance_m2);
        dense.fit(&inputs, &targets, &inducing).unwrap();

        let (mut variances, mut means) = (Vec::new(), Vec::new());
        for sector in 0..SECTORS {
            if !gp.sector_columns(sector).all(|column| (60..300).contains(&column)) {
                continue;
            }
            let queries: Vec<Query> = (0..SECTOR_COLUMNS)
                .flat_map(|column| (0..31).map(move |row| Query { column, row }))
                .collect();
            let directions: Vec<DVec2> = queries
                .iter()
                .map(|q| {
                    let azimuth =
                        column_azimuth_rad((gp.origin + sector * SECTOR_COLUMNS + q.column) % COLUMNS);
                    DVec2::new(azimuth, row_rad(q.row))
                })
                .collect();
            let (mut mean, mut variance) = (vec![0.0; queries.len()], vec![0.0; queries.len()]);
            dense.predict(&directions, &mut mean, &mut variance);
            assert!(gp.enter(sector).unwrap());
            gp.relative_variances(sector, &queries, &mut variances);
            means.resize(queries.len(), 0.0);
            gp.means(&mut means);
            for (index, query) in queries.iter().enumerate() {
                let ours = variances[index] * config.kernel.variance;
                let tolerance = if ours < 0.5 { 0.01 } else { 0.03 };
                assert!(
                    (ours - variance[index]).abs() < tolerance,
                    "{sector} {query:?}: {ours} {}",
                    variance[index]
                );
                // Far from the returns the dense mean still has the tail of the kernel.
                assert!(
                    ours > 0.5 || (means[index] - mean[index]).abs() < 0.2,
                    "{sector} {query:?}: {} {}",
                    means[index],
                    mean[index]
                );
            }
        }
    }
}

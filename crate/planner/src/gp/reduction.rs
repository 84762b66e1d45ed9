//! The reduction of the prior variance by a posterior: the quadratic form kᵀ W k with W = (L Lᵀ)⁻¹ - (M Mᵀ)⁻¹
//! and M = L L_B, in the symbols of [`crate::gp::sparse`].
//!
//! Two triangular solves for every test input become one symmetric product, over fewer inducing inputs if
//! only some of them are in reach.

use core::ops::Range;

use multiversion::multiversion;

use crate::math::panels::{self, Row, TALL, WIDTH, accumulate, add_tile};

/// The lower triangle of W with its off-diagonal part doubled, so that half the products give the form; zero
/// above.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reduction {
    doubled: Vec<f64>,
    /// Transposes of L⁻¹ and M⁻¹.
    inverse_l: Vec<f64>,
    inverse_m: Vec<f64>,
}

impl Reduction {
    /// Sets W from L and L_B (m × m each); `panel` is scratch.
    pub(crate) fn set(&mut self, l: &[f64], l_b: &[f64], m: usize, panel: &mut Vec<Row>) {
        let Self { doubled, inverse_l, inverse_m } = self;
        for matrix in [&mut *doubled, &mut *inverse_l, &mut *inverse_m] {
            matrix.clear();
            matrix.resize(m * m, 0.0);
        }
        // From the last columns on: the rows that a strip is multiplied with are computed before it.
        for first in (0..m).step_by(WIDTH).rev() {
            panel.clear();
            panel.resize(m, [0.0; WIDTH]);
            let columns = first..m.min(first + WIDTH);
            for (lane, row) in columns.clone().enumerate() {
                panel[row][lane] = 1.0;
            }
            panels::solve_lower(l, first, panel);
            transpose_strip(panel, columns.clone(), inverse_l);
            add_strip(inverse_l, panel, columns.clone(), doubled);
            panels::solve_lower(l_b, first, panel);
            transpose_strip(panel, columns.clone(), inverse_m);
            for value in panel.as_flattened_mut() {
                *value = -*value;
            }
            add_strip(inverse_m, panel, columns, doubled);
        }
        for (i, row) in doubled.chunks_exact_mut(m).enumerate() {
            for value in &mut row[..i] {
                *value *= 2.0;
            }
            row[i + 1..].fill(0.0);
        }
    }

    /// kᵀ W k for each column of a panel of covariances with the inducing inputs `reach`; covariances with
    /// the others count as zero.
    pub(crate) fn of(&self, covariances: &[Row], reach: Range<usize>, m: usize) -> Row {
        quadratic_form(&self.doubled, covariances, reach, m)
    }
}

/// Writes the columns of a strip of n rows as rows of `out` (n × n).
fn transpose_strip(strip: &[Row], columns: Range<usize>, out: &mut [f64]) {
    let n = strip.len();
    for (lane, row) in out[columns.start * n..columns.end * n].chunks_exact_mut(n).enumerate() {
        for (value, values) in row.iter_mut().zip(strip) {
            *value = values[lane];
        }
    }
}

/// Adds the columns of Tᵀ U to `out` (n × n), from the diagonal down; `transposed` is the lower triangular
/// T's transpose and `strip` the columns of the lower triangular U.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn add_strip(transposed: &[f64], strip: &[Row], columns: Range<usize>, out: &mut [f64]) {
    let n = strip.len();
    let full = n - (n - columns.start) % TALL;
    for i in (columns.start..full).step_by(TALL) {
        add_tile(&products::<TALL>(transposed, strip, i), i, columns.clone(), n, out);
    }
    for i in full..n {
        add_tile(&products::<1>(transposed, strip, i), i, columns.clone(), n, out);
    }
}

/// The products of R rows of `transposed` with a strip; all of them are zero before column `first`.
#[inline(always)]
fn products<const R: usize>(transposed: &[f64], strip: &[Row], first: usize) -> [Row; R] {
    let n = strip.len();
    let factors: [&[f64]; R] =
        core::array::from_fn(|r| &transposed[(first + r) * n + first..(first + r + 1) * n]);
    let mut sums = [[0.0; WIDTH]; R];
    accumulate(&factors, &strip[first..], &mut sums);
    sums
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn quadratic_form(lower: &[f64], covariances: &[Row], reach: Range<usize>, n: usize) -> Row {
    let mut form = [0.0; WIDTH];
    let full = reach.end - reach.len() % TALL;
    for i in (reach.start..full).step_by(TALL) {
        add_form::<TALL>(lower, covariances, reach.start, i, n, &mut form);
    }
    for i in full..reach.end {
        add_form::<1>(lower, covariances, reach.start, i, n, &mut form);
    }
    form
}

/// Adds the contribution of R rows from `first` on to the form; the covariances begin with row `begin`.
#[inline(always)]
fn add_form<const R: usize>(
    lower: &[f64],
    covariances: &[Row],
    begin: usize,
    first: usize,
    n: usize,
    form: &mut Row,
) {
    let factors: [&[f64]; R] =
        core::array::from_fn(|r| &lower[(first + r) * n + begin..(first + r) * n + first + R]);
    let mut sums = [[0.0; WIDTH]; R];
    accumulate(&factors, &covariances[..first + R - begin], &mut sums);
    for (sum, row) in sums.iter().zip(&covariances[first - begin..]) {
        for lane in 0..WIDTH {
            form[lane] += sum[lane] * row[lane];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    fn lower(n: usize, values: &[f64]) -> DMatrix<f64> {
        let mut l = 0.3 * DMatrix::from_row_slice(n, n, values).lower_triangle();
        l.fill_diagonal(2.0);
        l
    }

    fn row_major(matrix: &DMatrix<f64>) -> Vec<f64> {
        matrix.transpose().as_slice().to_vec()
    }

    proptest! {
        #[test]
        fn the_form_agrees_with_nalgebra(
            (n, l, l_b, k) in (1..23_usize).prop_flat_map(|n| {
                let values = || prop::collection::vec(-1.0..1.0_f64, n * n);
                (Just(n), values(), values(), prop::collection::vec(-1.0..1.0_f64, n))
            }),
            ends in (0.0..1.0_f64, 0.0..1.0_f64),
        ) {
            let (l, l_b) = (lower(n, &l), lower(n, &l_b));
            let mut reduction = Reduction::default();
            reduction.set(&row_major(&l), &row_major(&l_b), n, &mut Vec::new());
            let ends = [ends.0, ends.1].map(|share| (share * n as f64) as usize);
            let reach = ends[0].min(ends[1])..ends[0].max(ends[1]);

            let mut vector = DMatrix::zeros(n, 1);
            vector.view_mut((reach.start, 0), (reach.len(), 1)).copy_from_slice(&k[reach.clone()]);
            let t = l.solve_lower_triangular(&vector).unwrap();
            let s = l_b.solve_lower_triangular(&t).unwrap();
            let expected = t.norm_squared() - s.norm_squared();

            let covariances: Vec<Row> = k[reach.clone()].iter().map(|k| core::array::from_fn(|lane| k * lane as f64)).collect();
            for (lane, form) in reduction.of(&covariances, reach, n).into_iter().enumerate() {
                prop_assert!((form - expected * (lane * lane) as f64).abs() < 1e-9);
            }
        }
    }
}

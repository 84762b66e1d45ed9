//! The dense kernels of the sparse Gaussian process, on row-major slices.
//!
//! Every sum runs in a fixed order over a fixed number of lanes and no multiplication is fused with an addition, so
//! the bits are the same on every target and at every vector width. They are ours because the libraries choose
//! their kernels at run time. Tests compare them with nalgebra.

use core::ops::Range;

use multiversion::multiversion;

/// A pivot was not positive: the matrix is not numerically positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotPositiveDefinite;

const LANES: usize = 4;

/// The dot products of R rows with C others, each with the bits it has alone; together they hide the latency of the sums.
#[inline(always)]
fn dots<const R: usize, const C: usize>(a: [&[f64]; R], b: [&[f64]; C]) -> [[f64; C]; R] {
    let length = b[0].len();
    let whole = length - length % LANES;
    let mut sums = [[[0.0; LANES]; C]; R];
    for k in (0..whole).step_by(LANES) {
        let x: [[f64; LANES]; R] = core::array::from_fn(|r| load(a[r], k));
        let y: [[f64; LANES]; C] = core::array::from_fn(|c| load(b[c], k));
        for r in 0..R {
            for c in 0..C {
                for lane in 0..LANES {
                    sums[r][c][lane] += x[r][lane] * y[c][lane];
                }
            }
        }
    }
    let mut totals = [[0.0; C]; R];
    for r in 0..R {
        for c in 0..C {
            let mut rest = 0.0;
            for k in whole..length {
                rest += a[r][k] * b[c][k];
            }
            let s = &sums[r][c];
            totals[r][c] = (s[0] + s[2]) + (s[1] + s[3]) + rest;
        }
    }
    totals
}

#[inline(always)]
fn load(values: &[f64], from: usize) -> [f64; LANES] {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&values[from..from + LANES]);
    lanes
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    dots([a], [b])[0][0]
}

/// Factors the symmetric `a` (n × n) as L Lᵀ, reading and writing its lower triangle, and leaves zeros above.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn cholesky(a: &mut [f64], n: usize) -> Result<(), NotPositiveDefinite> {
    let mut i = 0;
    // Four rows at a time, against two of the finished ones.
    while i + 4 <= n {
        let (above, rows_on) = a.split_at_mut(i * n);
        let finished = |j: usize| &above[j * n..j * n + j + 1];
        for j in (0..i).step_by(2) {
            let (first, second) = (finished(j), finished(j + 1));
            let row = |r: usize| &rows_on[r * n..r * n + j];
            let sums = dots([row(0), row(1), row(2), row(3)], [&first[..j], &second[..j]]);
            for (r, [a, b]) in sums.into_iter().enumerate() {
                let row = &mut rows_on[r * n..r * n + j + 2];
                row[j] = (row[j] - a) / first[j];
                row[j + 1] = (row[j + 1] - (b + row[j] * second[j])) / second[j + 1];
            }
        }
        for r in i..i + 4 {
            finish_row(a, n, r, i)?;
        }
        i += 4;
    }
    for r in i..n {
        finish_row(a, n, r, 0)?;
    }
    Ok(())
}

/// Finishes row `i`, of which the first `done` entries are finished.
#[inline(always)]
fn finish_row(a: &mut [f64], n: usize, i: usize, done: usize) -> Result<(), NotPositiveDefinite> {
    let (above, row_on) = a.split_at_mut(i * n);
    let row = &mut row_on[..n];
    for j in done..i {
        let other = &above[j * n..j * n + j + 1];
        row[j] = (row[j] - dot(&row[..j], &other[..j])) / other[j];
    }
    let pivot = row[i] - dot(&row[..i], &row[..i]);
    // Also refuses NaN.
    if !(pivot > 0.0 && pivot.is_finite()) {
        return Err(NotPositiveDefinite);
    }
    row[i] = pivot.sqrt();
    row[i + 1..].fill(0.0);
    Ok(())
}

/// Solves L x = b in place for one right-hand side.
pub(crate) fn solve_lower_vector(l: &[f64], n: usize, b: &mut [f64]) {
    for i in 0..n {
        let row = &l[i * n..i * n + i + 1];
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
}

/// Adds K Kᵀ to the lower triangle of a matrix, between the rows and columns `inputs`. `covariances` is Kᵀ, an even number of rows
/// over `inputs`; `place(i)` is where the matrix has the entry of row i and the first of the columns.
#[inline(always)]
pub(crate) fn add_products(
    covariances: &[f64],
    inputs: Range<usize>,
    place: impl Fn(usize) -> usize,
    matrix: &mut [f64],
) {
    for (i, input) in inputs.clone().enumerate() {
        let begin = place(input);
        add_row(covariances, inputs.len(), i, &mut matrix[begin..=begin + i]);
    }
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn add_row(covariances: &[f64], count: usize, i: usize, row: &mut [f64]) {
    for pair in covariances.chunks_exact(2 * count) {
        let (a, b) = pair.split_at(count);
        let (of_a, of_b) = (a[i], b[i]);
        for ((sum, x), y) in row.iter_mut().zip(a).zip(b) {
            *sum += of_a * x + of_b * y;
        }
    }
}

/// Writes A v (rows) of `a` (rows × columns) to `out`.
pub(crate) fn multiply_vector(a: &[f64], columns: usize, v: &[f64], out: &mut [f64]) {
    for (row, value) in a.chunks_exact(columns).zip(out) {
        *value = dot(row, v);
    }
}

/// Solves Lᵀ x = b in place for one right-hand side.
pub(crate) fn solve_lower_transposed_vector(l: &[f64], n: usize, b: &mut [f64]) {
    for i in (0..n).rev() {
        let row = &l[i * n..i * n + i + 1];
        b[i] /= row[i];
        let solved = b[i];
        for (value, factor) in b[..i].iter_mut().zip(row) {
            *value -= factor * solved;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    fn matrix(rows: usize, columns: usize) -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(-2.0..2.0_f64, rows * columns)
    }

    fn sizes() -> impl Strategy<Value = (usize, Vec<f64>, Vec<f64>)> {
        (1..14_usize).prop_flat_map(|n| (Just(n), matrix(n, n + 3), matrix(n, 1)))
    }

    proptest! {
        #[test]
        fn the_kernels_agree_with_nalgebra((n, a, b) in sizes()) {
            let na_a = DMatrix::from_row_slice(n, n + 3, &a);
            let na_spd = &na_a * na_a.transpose() + DMatrix::identity(n, n);
            let mut spd = vec![0.0; n * n];
            // Two rows of Kᵀ at a time; an odd last one is paired with zeros.
            let transposed: Vec<f64> = (0..n + 4).flat_map(|k| {
                let a = &a;
                (0..n).map(move |i| if k < n + 3 { a[i * (n + 3) + k] } else { 0.0 })
            }).collect();
            let even = &transposed[..(n + 3).next_multiple_of(2) * n];
            add_products(even, 0..n, |i| i * n, &mut spd);
            for i in 0..n {
                spd[i * n + i] += 1.0;
            }
            let lower = DMatrix::from_row_slice(n, n, &spd).lower_triangle();
            prop_assert!((lower - na_spd.lower_triangle()).amax() < 1e-12);

            cholesky(&mut spd, n).unwrap();
            let na_l = na_spd.cholesky().unwrap().l();
            prop_assert!((DMatrix::from_row_slice(n, n, &spd) - &na_l).amax() < 1e-10);

            let na_b = DVector::from_row_slice(&b);
            let na_x = na_l.solve_lower_triangular(&na_b).unwrap();
            let mut x = b.clone();
            solve_lower_vector(&spd, n, &mut x);
            prop_assert!(x.iter().zip(na_x.iter()).all(|(p, q)| (p - q).abs() < 1e-9));

            let mut back = b.clone();
            solve_lower_transposed_vector(&spd, n, &mut back);
            let na_back = na_l.transpose().solve_upper_triangular(&na_b).unwrap();
            prop_assert!(back.iter().zip(na_back.iter()).all(|(p, q)| (p - q).abs() < 1e-9));
        }
    }

    #[test]
    fn an_indefinite_matrix_and_nan_are_refused() {
        assert_eq!(cholesky(&mut [1.0, 2.0, 2.0, 1.0], 2), Err(NotPositiveDefinite));
        assert_eq!(cholesky(&mut [f64::NAN], 1), Err(NotPositiveDefinite));
    }
}

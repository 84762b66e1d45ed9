//! The dense kernels of the sparse Gaussian process, on row-major slices.
//!
//! Every sum runs in a fixed order over a fixed number of lanes and no multiplication is fused with an
//! addition, so the bits are the same on every target and at every vector width. Libraries choose their
//! kernels at run time, so these are written here. Tests compare them with nalgebra.

use core::ops::Range;

use multiversion::multiversion;

const LANES: usize = 4;

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_lanes, a_rest) = a.as_chunks::<LANES>();
    let (b_lanes, b_rest) = b.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (x, y) in a_lanes.iter().zip(b_lanes) {
        for lane in 0..LANES {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

/// Solves L x = b in place for one right-hand side.
pub(crate) fn solve_lower_vector(l: &[f64], n: usize, b: &mut [f64]) {
    for i in 0..n {
        let row = &l[i * n..i * n + i + 1];
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
}

/// Adds K Kᵀ to the lower triangle of a matrix, between the rows and columns `inputs`. `covariances` is Kᵀ,
/// an even number of rows over `inputs`; `place(i)` is the index of the matrix's entry in row i and the first
/// of the columns.
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

            let na_l = na_spd.cholesky().unwrap().l();
            let spd = na_l.transpose().as_slice().to_vec();
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
}

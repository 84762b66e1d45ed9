//! The Cholesky factor of a matrix, eight rows at a time: a row of L is the solution of a triangular system
//! in the rows above it, and [`crate::math::panels`] solves eight of them at once.

use multiversion::multiversion;

use crate::math::panels::{Row, TALL, WIDTH, accumulate, solve_leading};

/// A pivot was not positive: the matrix is not numerically positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotPositiveDefinite;

/// Factors the symmetric `a` (n × n) as L Lᵀ, reading and writing its lower triangle, and leaves zeros above.
/// `panel` is scratch.
pub(crate) fn cholesky(a: &mut [f64], n: usize, panel: &mut Vec<Row>) -> Result<(), NotPositiveDefinite> {
    panel.clear();
    panel.resize(n, [0.0; WIDTH]);
    for first in (0..n).step_by(WIDTH) {
        let (above, rows_on) = a.split_at_mut(first * n);
        let count = WIDTH.min(n - first);
        finish_rows(above, &mut rows_on[..count * n], n, &mut panel[..first])?;
    }
    Ok(())
}

/// Finishes up to eight `rows` of L, given those `above`.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn finish_rows(
    above: &[f64],
    rows: &mut [f64],
    n: usize,
    panel: &mut [Row],
) -> Result<(), NotPositiveDefinite> {
    let first = panel.len();
    for (lane, row) in rows.chunks_exact(n).enumerate() {
        for (values, value) in panel.iter_mut().zip(row) {
            values[lane] = *value;
        }
    }
    solve_leading(above, n, panel);
    for (lane, row) in rows.chunks_exact_mut(n).enumerate() {
        for (values, value) in panel.iter().zip(row) {
            *value = values[lane];
        }
    }
    let products = products(rows, n, panel);
    for (i, products) in products.iter().enumerate().take(rows.len() / n) {
        let (finished, row_on) = rows.split_at_mut(i * n);
        let row = &mut row_on[first..n];
        for (value, product) in row[..=i].iter_mut().zip(products) {
            *value -= product;
        }
        for j in 0..i {
            let other = &finished[j * n + first..j * n + first + j + 1];
            let sum: f64 = row[..j].iter().zip(other).map(|(a, b)| a * b).sum();
            row[j] = (row[j] - sum) / other[j];
        }
        let sum: f64 = row[..i].iter().map(|value| value * value).sum();
        let pivot = row[i] - sum;
        // Also refuses NaN.
        if !(pivot > 0.0 && pivot.is_finite()) {
            return Err(NotPositiveDefinite);
        }
        row[i] = pivot.sqrt();
        row[i + 1..].fill(0.0);
    }
    Ok(())
}

/// The products of the rows with each other, over the columns of the panel, which has the same values
/// transposed.
#[inline(always)]
fn products(rows: &[f64], n: usize, panel: &[Row]) -> [Row; WIDTH] {
    let mut products = [[0.0; WIDTH]; WIDTH];
    let count = rows.len() / n;
    for (tile, sums) in products.as_chunks_mut::<TALL>().0.iter_mut().enumerate() {
        // Rows beyond the last are replaced by the last one; their products are not used.
        let row = |r: usize| (tile * TALL + r).min(count - 1) * n;
        let factors: [&[f64]; TALL] = core::array::from_fn(|r| &rows[row(r)..row(r) + panel.len()]);
        accumulate(&factors, panel, sums);
    }
    products
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_factor_agrees_with_nalgebra(
            (n, values) in (1..40_usize).prop_flat_map(|n| (Just(n), prop::collection::vec(-2.0..2.0_f64, n * (n + 3)))),
        ) {
            let root = DMatrix::from_row_slice(n, n + 3, &values);
            let matrix = &root * root.transpose() + DMatrix::identity(n, n);
            // The upper triangle is not read.
            let mut a: Vec<f64> =
                (0..n * n).map(|k| if k % n > k / n { f64::NAN } else { matrix[(k / n, k % n)] }).collect();
            cholesky(&mut a, n, &mut Vec::new()).unwrap();
            let l = matrix.cholesky().unwrap().l();
            prop_assert!((DMatrix::from_row_slice(n, n, &a) - l).amax() < 1e-10);
        }
    }

    #[test]
    fn an_indefinite_matrix_and_nan_are_refused() {
        let mut panel = Vec::new();
        assert_eq!(cholesky(&mut [1.0, 2.0, 2.0, 1.0], 2, &mut panel), Err(NotPositiveDefinite));
        assert_eq!(cholesky(&mut [f64::NAN], 1, &mut panel), Err(NotPositiveDefinite));
    }
}

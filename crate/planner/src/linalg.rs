//! The dense kernels of the sparse Gaussian process, on row-major slices.
//!
//! Every sum runs in a fixed order over a fixed number of lanes and no multiplication is fused with an addition, so
//! the bits are the same on every target and at every vector width. They are ours because the libraries choose
//! their kernels at run time. Tests compare them with nalgebra.

use multiversion::multiversion;

/// A pivot was not positive: the matrix is not numerically positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotPositiveDefinite;

const LANES: usize = 4;

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_chunks, a_rest) = a.as_chunks::<LANES>();
    let (b_chunks, b_rest) = b.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (x, y) in a_chunks.iter().zip(b_chunks) {
        for lane in 0..LANES {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let mut rest = 0.0;
    for (x, y) in a_rest.iter().zip(b_rest) {
        rest += x * y;
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

/// Factors the symmetric `a` (n × n) as L Lᵀ and leaves L in its lower triangle, zeros above.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn cholesky(a: &mut [f64], n: usize) -> Result<(), NotPositiveDefinite> {
    for i in 0..n {
        let (above, row_on) = a.split_at_mut(i * n);
        let row = &mut row_on[..n];
        for j in 0..i {
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
    }
    Ok(())
}

/// Columns solved together, so that the panel stays in registers and first-level cache.
const PANEL: usize = 8;

/// Solves L X = B in place for lower triangular `l` (n × n) and `b` (n × columns).
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn solve_lower(l: &[f64], n: usize, b: &mut [f64], columns: usize) {
    let full = columns - columns % PANEL;
    for start in (0..full).step_by(PANEL) {
        solve_panel(l, n, b, columns, start);
    }
    for column in full..columns {
        for i in 0..n {
            let mut value = b[i * columns + column];
            for j in 0..i {
                value -= l[i * n + j] * b[j * columns + column];
            }
            b[i * columns + column] = value / l[i * n + i];
        }
    }
}

#[inline(always)]
fn solve_panel(l: &[f64], n: usize, b: &mut [f64], columns: usize, start: usize) {
    let panel_row = |row: usize| row * columns + start..row * columns + start + PANEL;
    let load = |b: &[f64], row: usize| -> [f64; PANEL] {
        let mut values = [0.0; PANEL];
        values.copy_from_slice(&b[panel_row(row)]);
        values
    };
    let mut i = 0;
    // Two rows at a time: each row above is loaded once for both.
    while i + 1 < n {
        let (first, second) = (&l[i * n..i * n + i + 1], &l[(i + 1) * n..(i + 1) * n + i + 2]);
        let (mut upper, mut lower) = (load(b, i), load(b, i + 1));
        for j in 0..i {
            let above = &b[panel_row(j)];
            let (first_factor, second_factor) = (first[j], second[j]);
            for lane in 0..PANEL {
                upper[lane] -= first_factor * above[lane];
                lower[lane] -= second_factor * above[lane];
            }
        }
        for lane in 0..PANEL {
            upper[lane] /= first[i];
            lower[lane] = (lower[lane] - second[i] * upper[lane]) / second[i + 1];
        }
        b[panel_row(i)].copy_from_slice(&upper);
        b[panel_row(i + 1)].copy_from_slice(&lower);
        i += 2;
    }
    if i < n {
        let mut last = load(b, i);
        for j in 0..i {
            let above = &b[panel_row(j)];
            let factor = l[i * n + j];
            for lane in 0..PANEL {
                last[lane] -= factor * above[lane];
            }
        }
        for value in &mut last {
            *value /= l[i * n + i];
        }
        b[panel_row(i)].copy_from_slice(&last);
    }
}

/// Solves L x = b in place for one right-hand side.
pub(crate) fn solve_lower_vector(l: &[f64], n: usize, b: &mut [f64]) {
    for i in 0..n {
        let row = &l[i * n..i * n + i + 1];
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
}

/// Writes A Aᵀ (rows × rows) of `a` (rows × columns) to `out`.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn outer_product(a: &[f64], rows: usize, columns: usize, out: &mut [f64]) {
    let row = |i: usize| &a[i * columns..(i + 1) * columns];
    let mut i = 0;
    while i < rows {
        let tall = (rows - i).min(2);
        let mut j = 0;
        while j <= i {
            if tall == 2 && j < i {
                let block = dot_2x2(row(i), row(i + 1), row(j), row(j + 1));
                for (r, pair) in block.iter().enumerate() {
                    for (c, &value) in pair.iter().enumerate() {
                        out[(i + r) * rows + j + c] = value;
                        out[(j + c) * rows + i + r] = value;
                    }
                }
            } else {
                for r in i..i + tall {
                    for c in j..(j + 2).min(r + 1) {
                        let value = dot(row(r), row(c));
                        out[r * rows + c] = value;
                        out[c * rows + r] = value;
                    }
                }
            }
            j += 2;
        }
        i += 2;
    }
}

/// The four dot products of two pairs of rows; each has the bits of [`dot`].
#[inline(always)]
fn dot_2x2(a0: &[f64], a1: &[f64], b0: &[f64], b1: &[f64]) -> [[f64; 2]; 2] {
    let mut sums = [[[0.0; LANES]; 2]; 2];
    let (a0_chunks, a0_rest) = a0.as_chunks::<LANES>();
    let (a1_chunks, a1_rest) = a1.as_chunks::<LANES>();
    let (b0_chunks, b0_rest) = b0.as_chunks::<LANES>();
    let (b1_chunks, b1_rest) = b1.as_chunks::<LANES>();
    for (((x0, x1), y0), y1) in a0_chunks.iter().zip(a1_chunks).zip(b0_chunks).zip(b1_chunks) {
        for lane in 0..LANES {
            sums[0][0][lane] += x0[lane] * y0[lane];
            sums[0][1][lane] += x0[lane] * y1[lane];
            sums[1][0][lane] += x1[lane] * y0[lane];
            sums[1][1][lane] += x1[lane] * y1[lane];
        }
    }
    let mut rest = [[0.0; 2]; 2];
    for (((x0, x1), y0), y1) in a0_rest.iter().zip(a1_rest).zip(b0_rest).zip(b1_rest) {
        rest[0][0] += x0 * y0;
        rest[0][1] += x0 * y1;
        rest[1][0] += x1 * y0;
        rest[1][1] += x1 * y1;
    }
    let total = |r: usize, c: usize| {
        let s = &sums[r][c];
        (s[0] + s[2]) + (s[1] + s[3]) + rest[r][c]
    };
    [[total(0, 0), total(0, 1)], [total(1, 0), total(1, 1)]]
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
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    fn matrix(rows: usize, columns: usize) -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(-2.0..2.0_f64, rows * columns)
    }

    fn sizes() -> impl Strategy<Value = (usize, usize, Vec<f64>, Vec<f64>)> {
        (1..14_usize, 1..30_usize)
            .prop_flat_map(|(n, columns)| (Just(n), Just(columns), matrix(n, n + 3), matrix(n, columns)))
    }

    proptest! {
        #[test]
        fn the_kernels_agree_with_nalgebra((n, columns, a, b) in sizes()) {
            let na_a = DMatrix::from_row_slice(n, n + 3, &a);
            let na_spd = &na_a * na_a.transpose() + DMatrix::identity(n, n);
            let mut spd = vec![0.0; n * n];
            outer_product(&a, n, n + 3, &mut spd);
            for i in 0..n {
                spd[i * n + i] += 1.0;
            }
            prop_assert!((DMatrix::from_row_slice(n, n, &spd) - &na_spd).amax() < 1e-12);

            cholesky(&mut spd, n).unwrap();
            let na_l = na_spd.cholesky().unwrap().l();
            prop_assert!((DMatrix::from_row_slice(n, n, &spd) - &na_l).amax() < 1e-10);

            let na_b = DMatrix::from_row_slice(n, columns, &b);
            let na_x = na_l.solve_lower_triangular(&na_b).unwrap();
            let mut x = b.clone();
            solve_lower(&spd, n, &mut x, columns);
            prop_assert!((DMatrix::from_row_slice(n, columns, &x) - &na_x).amax() < 1e-9);

            let mut first: Vec<f64> = na_b.column(0).iter().copied().collect();
            solve_lower_vector(&spd, n, &mut first);
            prop_assert!(first.iter().zip(na_x.column(0).iter()).all(|(p, q)| (p - q).abs() < 1e-9));

            let mut back: Vec<f64> = na_b.column(0).iter().copied().collect();
            solve_lower_transposed_vector(&spd, n, &mut back);
            let na_back = na_l.transpose().solve_upper_triangular(&na_b.column(0)).unwrap();
            prop_assert!(back.iter().zip(na_back.iter()).all(|(p, q)| (p - q).abs() < 1e-9));
        }
    }

    #[test]
    fn an_indefinite_matrix_and_nan_are_refused() {
        assert_eq!(cholesky(&mut [1.0, 2.0, 2.0, 1.0], 2), Err(NotPositiveDefinite));
        assert_eq!(cholesky(&mut [f64::NAN], 1), Err(NotPositiveDefinite));
    }
}

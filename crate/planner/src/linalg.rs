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

/// Solves L X = B in place for lower triangular `l` (n × n) and `b` (n × columns).
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn solve_lower(l: &[f64], n: usize, b: &mut [f64], columns: usize) {
    let mut start = 0;
    while start < columns {
        start += match columns - start {
            8.. => solve_panel::<8>(l, n, b, columns, start),
            4.. => solve_panel::<4>(l, n, b, columns, start),
            _ => solve_panel::<1>(l, n, b, columns, start),
        };
    }
}

/// Solves for PANEL columns, which stay in registers and first-level cache; gives their number.
#[inline(always)]
fn solve_panel<const PANEL: usize>(
    l: &[f64],
    n: usize,
    b: &mut [f64],
    columns: usize,
    start: usize,
) -> usize {
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
    PANEL
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
    let mut set = |i: usize, j: usize, value: f64| {
        out[i * rows + j] = value;
        out[j * rows + i] = value;
    };
    let mut i = 0;
    while i + 4 <= rows {
        for j in (0..i + 4).step_by(2) {
            let block = dots([row(i), row(i + 1), row(i + 2), row(i + 3)], [row(j), row(j + 1)]);
            for (r, [first, second]) in block.into_iter().enumerate() {
                set(i + r, j, first);
                set(i + r, j + 1, second);
            }
        }
        i += 4;
    }
    for i in i..rows {
        for j in 0..=i {
            set(i, j, dot(row(i), row(j)));
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

//! Dense kernels on panels: a matrix stored as strips of eight columns, each strip row by row.
//!
//! A strip of a few hundred rows stays in the first-level cache while a triangular solve or a product runs
//! over it, four rows at a time, so that eight sums are in flight. As in [`crate::math::linalg`] every sum
//! has a fixed order and nothing is fused, so the widest registers of the machine change no bit.

use core::ops::Range;

use multiversion::multiversion;

/// Columns of a panel.
pub(crate) const WIDTH: usize = crate::math::elementary::LANES;
/// One row of a panel.
pub(crate) type Row = [f64; WIDTH];
/// The sum of a row.
pub(crate) fn total(row: &Row) -> f64 {
    let half = |i: usize| (row[i] + row[i + 2]) + (row[i + 1] + row[i + 3]);
    half(0) + half(4)
}

/// Rows handled together.
pub(crate) const TALL: usize = 4;

/// Solves L X = P in place for lower triangular `l` (n × n, row by row) and one panel of n rows, of which
/// those before `first` are zero.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
pub(crate) fn solve_lower(l: &[f64], first: usize, panel: &mut [Row]) {
    let n = panel.len();
    let full = n - (n - first) % TALL;
    for i in (first..full).step_by(TALL) {
        solve_rows::<TALL>(l, n, first, panel, i);
    }
    for i in full..n {
        solve_rows::<1>(l, n, first, panel, i);
    }
}

/// Solves L X = P in place for a panel of a multiple of [`TALL`] rows, where L leads the rows of `l`, of
/// length `n`.
#[inline(always)]
pub(crate) fn solve_leading(l: &[f64], n: usize, panel: &mut [Row]) {
    for i in (0..panel.len()).step_by(TALL) {
        solve_rows::<TALL>(l, n, 0, panel, i);
    }
}

/// Solves the R rows from `at` on; the rows of `l` have length `n`.
#[inline(always)]
fn solve_rows<const R: usize>(l: &[f64], n: usize, first: usize, panel: &mut [Row], at: usize) {
    let (solved, rest) = panel.split_at_mut(at);
    let factors: [&[f64]; R] = core::array::from_fn(|r| &l[(at + r) * n + first..(at + r) * n + at + r + 1]);
    let mut sums = [[0.0; WIDTH]; R];
    accumulate(&factors, &solved[first..], &mut sums);
    for r in 0..R {
        let mut row = rest[r];
        for lane in 0..WIDTH {
            row[lane] -= sums[r][lane];
        }
        let (beside, pivot) = factors[r][at - first..].split_at(r);
        for (above, factor) in rest[..r].iter().zip(beside) {
            for lane in 0..WIDTH {
                row[lane] -= factor * above[lane];
            }
        }
        for value in &mut row {
            *value /= pivot[0];
        }
        rest[r] = row;
    }
}

/// Adds the products of R rows of factors with the rows of `panel` to `sums`.
#[inline(always)]
pub(crate) fn accumulate<const R: usize>(factors: &[&[f64]; R], panel: &[Row], sums: &mut [Row; R]) {
    let factors: [&[f64]; R] = core::array::from_fn(|r| &factors[r][..panel.len()]);
    let mut local = *sums;
    for (j, row) in panel.iter().enumerate() {
        for r in 0..R {
            let factor = factors[r][j];
            for lane in 0..WIDTH {
                local[r][lane] += factor * row[lane];
            }
        }
    }
    *sums = local;
}

/// Writes M P of `matrix` (rows of `panel` each, row by row) to `out`, one panel row for each row of the
/// matrix.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
pub(crate) fn multiply(matrix: &[f64], panel: &[Row], out: &mut [Row]) {
    let n = panel.len();
    let (tall, single) = out.as_chunks_mut::<TALL>();
    let full = tall.len() * TALL;
    for (block, out) in tall.iter_mut().enumerate() {
        let factors: [&[f64]; TALL] =
            core::array::from_fn(|r| &matrix[(block * TALL + r) * n..(block * TALL + r + 1) * n]);
        *out = [[0.0; WIDTH]; TALL];
        accumulate(&factors, panel, out);
    }
    for (r, out) in single.iter_mut().enumerate() {
        let mut sums = [[0.0; WIDTH]];
        accumulate(&[&matrix[(full + r) * n..(full + r + 1) * n]], panel, &mut sums);
        *out = sums[0];
    }
}

/// Columns gathered before they are added to a product of a matrix with its transpose: a transposed panel of
/// them and four rows fit the first-level cache, a few hundred rows the second.
pub(crate) const BLOCK_COLUMNS: usize = 256;

/// Adds B Bᵀ to the lower triangle of `out` (n × n), where B is `block`: n rows of [`BLOCK_COLUMNS`], of
/// which those before `from`, a multiple of [`WIDTH`], are zero.
///
/// Some values above the diagonal are written too; [`mirror_lower`] puts them right.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
pub(crate) fn add_outer_product(block: &[f64], n: usize, from: usize, out: &mut [f64]) {
    let (rows, _) = block.as_chunks::<BLOCK_COLUMNS>();
    let full = n - n % TALL;
    let mut panel = [[0.0; WIDTH]; BLOCK_COLUMNS];
    for first in (from..n).step_by(WIDTH) {
        let columns = WIDTH.min(n - first);
        for (lane, row) in rows[first..first + columns].iter().enumerate() {
            for (transposed, value) in panel.iter_mut().zip(row) {
                transposed[lane] = *value;
            }
        }
        // The rows of a tile begin at a multiple of four, as `first` does.
        for i in (first..full).step_by(TALL) {
            let tile = products::<TALL>(rows, i, &panel);
            add_tile(&tile, i, first..first + columns, n, out);
        }
        for i in full.max(first)..n {
            add_tile(&products::<1>(rows, i, &panel), i, first..first + columns, n, out);
        }
    }
}

#[inline(always)]
fn products<const R: usize>(rows: &[[f64; BLOCK_COLUMNS]], first: usize, panel: &[Row]) -> [Row; R] {
    let factors: [&[f64]; R] = core::array::from_fn(|r| rows[first + r].as_slice());
    let mut sums = [[0.0; WIDTH]; R];
    accumulate(&factors, panel, &mut sums);
    sums
}

/// Adds a tile to the rows from `first_row` on and some columns of `out` (n × n).
#[inline(always)]
pub(crate) fn add_tile(tile: &[Row], first_row: usize, columns: Range<usize>, n: usize, out: &mut [f64]) {
    for (row, out) in tile.iter().zip(out[first_row * n..].chunks_exact_mut(n)) {
        for (value, sum) in out[columns.clone()].iter_mut().zip(row) {
            *value += sum;
        }
    }
}

/// Copies the lower triangle of `matrix` (n × n) to the upper one.
pub(crate) fn mirror_lower(matrix: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..i {
            matrix[j * n + i] = matrix[i * n + j];
        }
    }
}

/// Turns Lᵀ X = B into a lower triangular problem: writes the matrix with rows and columns in reverse order,
/// transposed.
pub(crate) fn reverse_transpose(l: &[f64], n: usize, out: &mut [f64]) {
    for i in 0..n {
        for j in 0..n {
            out[i * n + j] = l[(n - 1 - j) * n + n - 1 - i];
        }
    }
}

/// Solves Lᵀ X = M in place for a whole `matrix` (n × n), given L's [`reverse_transpose`]; `panel` is
/// scratch.
pub(crate) fn solve_transposed(reversed: &[f64], n: usize, matrix: &mut [f64], panel: &mut Vec<Row>) {
    panel.clear();
    panel.resize(n, [0.0; WIDTH]);
    for first in (0..n).step_by(WIDTH) {
        let columns = WIDTH.min(n - first);
        for (row, values) in panel.iter_mut().rev().zip(matrix.chunks_exact(n)) {
            row[..columns].copy_from_slice(&values[first..first + columns]);
        }
        solve_lower(reversed, 0, panel);
        for (row, values) in panel.iter().rev().zip(matrix.chunks_exact_mut(n)) {
            values[first..first + columns].copy_from_slice(&row[..columns]);
        }
    }
}

/// Writes (L Lᵀ)⁻¹ (n × n) to `inverse`; `reversed` (n × n) and `panel` are scratch.
pub(crate) fn invert(l: &[f64], n: usize, inverse: &mut [f64], reversed: &mut [f64], panel: &mut Vec<Row>) {
    reverse_transpose(l, n, reversed);
    for first in (0..n).step_by(WIDTH) {
        let columns = WIDTH.min(n - first);
        panel.clear();
        panel.resize(n, [0.0; WIDTH]);
        for lane in 0..columns {
            panel[first + lane][lane] = 1.0;
        }
        solve_lower(l, first, panel);
        panel.reverse();
        solve_lower(reversed, 0, panel);
        for (row, values) in panel.iter().rev().zip(inverse.chunks_exact_mut(n)) {
            values[first..first + columns].copy_from_slice(&row[..columns]);
        }
    }
}

/// Transposes `matrix` (n × n) in place.
pub(crate) fn transpose(matrix: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..i {
            matrix.swap(i * n + j, j * n + i);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    /// A well-conditioned lower triangle and another matrix, n × n.
    fn problem() -> impl Strategy<Value = (usize, Vec<f64>, Vec<f64>)> {
        (1..23_usize).prop_flat_map(|n| {
            let values = || prop::collection::vec(-1.0..1.0_f64, n * n);
            (Just(n), values(), values()).prop_map(|(n, mut l, m)| {
                for i in 0..n {
                    for j in 0..n {
                        l[i * n + j] *= if j > i { 0.0 } else { 0.3 };
                    }
                    l[i * n + i] += 2.0;
                }
                (n, l, m)
            })
        })
    }

    fn first_columns(m: &[f64], n: usize) -> Vec<Row> {
        (0..n).map(|i| core::array::from_fn(|lane| m[i * n + lane % n])).collect()
    }

    proptest! {
        #[test]
        fn the_kernels_agree_with_nalgebra((n, l, m) in problem()) {
            let (na_l, na_m) = (DMatrix::from_row_slice(n, n, &l), DMatrix::from_row_slice(n, n, &m));
            let panel = first_columns(&m, n);
            let na_panel = DMatrix::from_row_slice(n, WIDTH, panel.as_flattened());

            let mut solved = panel.clone();
            solve_lower(&l, 0, &mut solved);
            let na_solved = na_l.solve_lower_triangular(&na_panel).unwrap();
            prop_assert!((DMatrix::from_row_slice(n, WIDTH, solved.as_flattened()) - na_solved).amax() < 1e-10);

            let mut product = panel.clone();
            multiply(&m, &panel, &mut product);
            let na_product = &na_m * &na_panel;
            prop_assert!((DMatrix::from_row_slice(n, WIDTH, product.as_flattened()) - na_product).amax() < 1e-12);

            let (mut reversed, mut transposed_solve) = (vec![0.0; n * n], m.clone());
            reverse_transpose(&l, n, &mut reversed);
            solve_transposed(&reversed, n, &mut transposed_solve, &mut Vec::new());
            let na_solve = na_l.transpose().solve_upper_triangular(&na_m).unwrap();
            prop_assert!((DMatrix::from_row_slice(n, n, &transposed_solve) - na_solve).amax() < 1e-10);

            let (mut inverse, mut scratch) = (vec![0.0; n * n], vec![0.0; n * n]);
            invert(&l, n, &mut inverse, &mut scratch, &mut Vec::new());
            let na_inverse = (&na_l * na_l.transpose()).try_inverse().unwrap();
            prop_assert!((DMatrix::from_row_slice(n, n, &inverse) - na_inverse).amax() < 1e-10);

            let mut swapped = m.clone();
            transpose(&mut swapped, n);
            prop_assert_eq!(DMatrix::from_row_slice(n, n, &swapped), na_m.transpose());

            let block: Vec<f64> = (0..n * BLOCK_COLUMNS).map(|k| m[k * 7 % (n * n)]).collect();
            let na_block = DMatrix::from_row_slice(n, BLOCK_COLUMNS, &block);
            let mut outer = vec![0.0; n * n];
            add_outer_product(&block, n, 0, &mut outer);
            add_outer_product(&block, n, 0, &mut outer);
            mirror_lower(&mut outer, n);
            let na_outer = 2.0 * &na_block * na_block.transpose();
            prop_assert!((DMatrix::from_row_slice(n, n, &outer) - na_outer).amax() < 1e-11);
        }
    }
}

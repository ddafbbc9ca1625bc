//! Symmetric band matrices and their factorisation `A = L D Lᵀ`, and sparse ones with faer.
//!
//! A chain of nodes numbered along the cable fills nothing outside its band, so the factor has the
//! shape of the matrix and needs no symbolic part. Row j of L and d_j follow from the rows before
//! it (v_k = L_jk d_k, k from j − b on; G. Golub, C. Van Loan, *Matrix Computations*, Johns Hopkins
//! University Press, section on symmetric band systems):
//! ```text
//! v_i = a_ji − Σ_{k<i} v_k L_ik,     L_ji = v_i / d_i,     d_j = a_jj − Σ_i v_i L_ji
//! ```
//! [`BandFactor::factor`] and [`BandFactor::solve_in_place`] allocate nothing. There is no
//! pivoting, so a pivot ≤ 0 (or NaN) means "not positive definite" and is reported with its row,
//! which tells the node where a structure is not stable. What couples nodes far apart is left to
//! faer's sparse Cholesky with a fill-reducing order ([`solve_coupled`]).

use faer::prelude::Solve;
use faer::sparse::linalg::LltError;
use faer::sparse::{SparseColMat, Triplet};
use faer::{MatMut, Side};
use thiserror::Error;

/// Half-bandwidth of two coordinates a node when each node sees its neighbours (bars).
pub const BARS_HALF_BANDWIDTH: usize = 3;
/// Half-bandwidth of two coordinates a node when each node sees two neighbours on each side
/// (bending).
pub const BENDING_HALF_BANDWIDTH: usize = 5;

/// Widest half-bandwidth there is.
pub const WIDEST: usize = 8;

/// Why a matrix could not be factorised.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FactorError {
    /// The matrix is not positive definite, or holds a number that is not finite.
    #[error("pivot {pivot:.3e} in row {row} is not positive")]
    NotPositive {
        /// First row whose pivot is not positive.
        row: usize,
        /// Its pivot (0 if the factorisation stopped there).
        pivot: f64,
    },
    /// There is no memory for it, or its band is wider than [`WIDEST`].
    #[error("no room for a matrix of {rows} rows")]
    TooLarge {
        /// Its rows.
        rows: usize,
    },
}

/// A symmetric matrix with entries up to `half_bandwidth` b away from the diagonal. The upper
/// triangle is stored, b + 1 numbers a column with the diagonal last; those above the first row are
/// zeros.
#[derive(Clone, Debug)]
pub struct BandMatrix {
    rows: usize,
    half_bandwidth: usize,
    values: Vec<f64>,
}

impl BandMatrix {
    /// A zero matrix.
    #[must_use]
    pub fn new(rows: usize, half_bandwidth: usize) -> Self {
        let half_bandwidth = half_bandwidth.min(rows.saturating_sub(1));
        Self { rows, half_bandwidth, values: vec![0.0; rows * (half_bandwidth + 1)] }
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Furthest entry from the diagonal.
    #[must_use]
    pub fn half_bandwidth(&self) -> usize {
        self.half_bandwidth
    }

    fn index(&self, i: usize, j: usize) -> usize {
        let (i, j) = (i.min(j), i.max(j));
        debug_assert!(j - i <= self.half_bandwidth && j < self.rows, "({i}, {j}) lies outside the band");
        (j + 1) * self.half_bandwidth + i
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// The entry in row `i`, column `j` (either triangle), which must lie in the band.
    #[must_use]
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.values[self.index(i, j)]
    }

    /// Adds `value` to entry (i, j) and, by symmetry, (j, i). Call once for each pair.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let k = self.index(i, j);
        self.values[k] += value;
    }

    /// Adds `value` to the entries (i, i) and (i + 1, i + 1).
    pub fn add_diagonal(&mut self, i: usize, value: f64) {
        let b = self.half_bandwidth;
        let Some(w) = self.values.get_mut((i + 1) * b + i..).and_then(|w| w.get_mut(..b + 2)) else { return };
        w[0] += value;
        w[b + 1] += value;
    }

    /// Adds a 2×2 block in rows i, i + 1 and columns j, j + 1 with i ≤ j and, by symmetry, its
    /// mirror; of a block on the diagonal (i = j) the entry below it is not read.
    pub fn add_block(&mut self, i: usize, j: usize, block: [[f64; 2]; 2]) {
        for c in 0..2 {
            let first = (j + c + 1) * self.half_bandwidth + i;
            self.values[first] += block[0][c];
            if i < j || c == 1 {
                self.values[first + 1] += block[1][c];
            }
        }
    }

    /// Adds the 2×2 block [xx, xy; xy, yy] in rows i, i + 1 and again in rows i + 2, i + 3 on the
    /// diagonal, and its negative between them: a spring between two neighbouring nodes.
    pub fn add_spring(&mut self, i: usize, [xx, xy, yy]: [f64; 3]) {
        let b = self.half_bandwidth;
        let Some(w) = self.values.get_mut((i + 1) * b + i..).and_then(|w| w.get_mut(..3 * b + 4)) else { return };
        w[0] += xx;
        w[b] += xy;
        w[b + 1] += yy;
        w[2 * b] -= xx;
        w[2 * b + 1] -= xy;
        w[2 * b + 2] += xx;
        w[3 * b] -= xy;
        w[3 * b + 1] -= yy;
        w[3 * b + 2] += xy;
        w[3 * b + 3] += yy;
    }

    /// Makes row and column `i` those of the identity: unknown `i` is prescribed.
    pub fn pin(&mut self, i: usize) {
        let b = self.half_bandwidth;
        for j in i.saturating_sub(b)..(i + b + 1).min(self.rows) {
            let k = self.index(i, j);
            self.values[k] = if i == j { 1.0 } else { 0.0 };
        }
    }

    /// `out = A x`.
    pub fn multiply(&self, x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for j in 0..self.rows {
            let first = j.saturating_sub(self.half_bandwidth);
            let column = &self.values[self.index(first, j)..=self.index(j, j)];
            let mut sum = 0.0;
            for (i, &a) in (first..j).zip(column) {
                out[i] += a * x[j];
                sum += a * x[i];
            }
            out[j] += sum + column[j - first] * x[j];
        }
    }
}

/// The factor of a [`BandMatrix`], with everything needed to factorise again and again.
#[derive(Clone, Debug)]
pub struct BandFactor {
    rows: usize,
    half_bandwidth: usize,
    /// Rows of L, b numbers each up to the diagonal of ones, after b rows of zeros.
    lower: Vec<f64>,
    /// 1/d of each row, after b zeros.
    inverse: Vec<f64>,
}

impl BandFactor {
    /// Makes room for matrices of this size and band.
    ///
    /// # Errors
    /// `TooLarge` when there is no memory for it, or the band is wider than [`WIDEST`].
    pub fn new(rows: usize, half_bandwidth: usize) -> Result<Self, FactorError> {
        let too_large = FactorError::TooLarge { rows };
        let b = half_bandwidth.min(rows.saturating_sub(1));
        if b > WIDEST {
            return Err(too_large);
        }
        let (mut lower, mut inverse) = (Vec::new(), Vec::new());
        let size = rows.checked_add(b).and_then(|n| n.checked_mul(b)).ok_or(too_large)?;
        lower.try_reserve_exact(size).map_err(|_| too_large)?;
        inverse.try_reserve_exact(rows + b).map_err(|_| too_large)?;
        lower.resize(size, 0.0);
        inverse.resize(rows + b, 0.0);
        Ok(Self { rows, half_bandwidth: b, lower, inverse })
    }

    /// Number of rows it was made for.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Factorises `a`, which must have the rows and band this was made for.
    ///
    /// # Errors
    /// `NotPositive` with the first row whose pivot is not positive. If only the sign was wrong the
    /// factor is still there and [`Self::solve_in_place`] solves with it (a saddle); after a zero
    /// or NaN pivot it is not.
    pub fn factor(&mut self, a: &BandMatrix) -> Result<(), FactorError> {
        debug_assert!(a.rows == self.rows && a.half_bandwidth == self.half_bandwidth);
        // With the band known when this is compiled its loops are unrolled: three times as fast.
        match self.half_bandwidth {
            BARS_HALF_BANDWIDTH => factor(BARS_HALF_BANDWIDTH, &a.values, &mut self.lower, &mut self.inverse),
            BENDING_HALF_BANDWIDTH => factor(BENDING_HALF_BANDWIDTH, &a.values, &mut self.lower, &mut self.inverse),
            b => factor(b, &a.values, &mut self.lower, &mut self.inverse),
        }
    }

    /// Number of negative pivots of the last factorisation: how many directions the matrix bends
    /// down in.
    #[must_use]
    pub fn negative_pivots(&self) -> usize {
        self.inverse.iter().skip(self.half_bandwidth).filter(|&&d| !(d > 0.0)).count()
    }

    /// Factorises `a` and solves `a x = b`; `b` becomes `x`. The same as [`Self::factor`] and
    /// [`Self::solve_in_place`], but the processor substitutes while it waits for the pivots.
    ///
    /// # Errors
    /// `NotPositive` with the first row whose pivot is not positive; then neither the factor nor
    /// `b` is of use.
    pub fn factor_and_solve(&mut self, a: &BandMatrix, b: &mut [f64]) -> Result<(), FactorError> {
        debug_assert!(a.rows == self.rows && a.half_bandwidth == self.half_bandwidth && b.len() == self.rows);
        let (lower, inverse) = (&mut self.lower, &mut self.inverse);
        match self.half_bandwidth {
            BARS_HALF_BANDWIDTH => factor_and_solve(BARS_HALF_BANDWIDTH, &a.values, lower, inverse, b),
            BENDING_HALF_BANDWIDTH => factor_and_solve(BENDING_HALF_BANDWIDTH, &a.values, lower, inverse, b),
            half => factor_and_solve(half, &a.values, lower, inverse, b),
        }
    }

    /// Solves `A x = b` with the last factorisation; `b` becomes `x`.
    pub fn solve_in_place(&mut self, b: &mut [f64]) {
        match self.half_bandwidth {
            BARS_HALF_BANDWIDTH => solve(BARS_HALF_BANDWIDTH, &self.lower, &self.inverse, b),
            BENDING_HALF_BANDWIDTH => solve(BENDING_HALF_BANDWIDTH, &self.lower, &self.inverse, b),
            half => solve(half, &self.lower, &self.inverse, b),
        }
    }
}

/// L and 1/d of a matrix of half-bandwidth `b`.
#[inline(always)]
fn factor(b: usize, values: &[f64], lower: &mut [f64], inverse: &mut [f64]) -> Result<(), FactorError> {
    let mut done = Ok(());
    for (j, column) in values.chunks_exact(b + 1).enumerate() {
        let d = eliminate(b, j, column, lower, inverse);
        if !(d > 0.0) {
            done = done.and(Err(FactorError::NotPositive { row: j, pivot: d }));
            if !(d < 0.0) {
                return done;
            }
        }
    }
    done
}

/// Row `j` of L and of 1/d from column `j` of the matrix and the rows before it; returns d.
#[inline(always)]
fn eliminate(b: usize, j: usize, column: &[f64], lower: &mut [f64], inverse: &mut [f64]) -> f64 {
    let (before, here) = lower[j * b..].split_at_mut(b * b);
    let (scales, pivot) = inverse[j..].split_at_mut(b);
    let row = &mut here[..b];
    // Into `row` first v, then L.
    for i in 0..b {
        let mut v = column[i];
        for k in 0..i {
            v -= row[k] * before[i * b + b + k - i];
        }
        row[i] = v;
    }
    let mut d = column[b];
    for i in 0..b {
        let l = row[i] * scales[i];
        d -= row[i] * l;
        row[i] = l;
    }
    pivot[0] = 1.0 / d;
    d
}

/// What the rows of a lower triangle with ones take from the `b` unknowns before them.
#[inline(always)]
fn substitute(b: usize, row: &[f64], x: &mut f64, last: &mut [f64; WIDEST]) {
    let mut sum = *x;
    for k in 0..b {
        sum -= row[k] * last[k];
    }
    *x = sum;
    for k in 1..b {
        last[k - 1] = last[k];
    }
    if b > 0 {
        last[b - 1] = sum;
    }
}

/// Factorises and solves in one pass, and one back.
#[inline(always)]
fn factor_and_solve(
    b: usize,
    values: &[f64],
    lower: &mut [f64],
    inverse: &mut [f64],
    x: &mut [f64],
) -> Result<(), FactorError> {
    let mut last = [0.0; WIDEST];
    for ((j, column), x) in values.chunks_exact(b + 1).enumerate().zip(x.iter_mut()) {
        let d = eliminate(b, j, column, lower, inverse);
        if !(d > 0.0) {
            return Err(FactorError::NotPositive { row: j, pivot: d });
        }
        substitute(b, &lower[(j + b) * b..][..b], x, &mut last);
    }
    substitute_back(b, lower, inverse, x);
    Ok(())
}

/// Solves L D Lᵀ x = x for a half-bandwidth `b`. What the next row needs stays in registers.
#[inline(always)]
fn solve(b: usize, lower: &[f64], inverse: &[f64], x: &mut [f64]) {
    let mut last = [0.0; WIDEST];
    for (j, x) in x.iter_mut().enumerate() {
        substitute(b, &lower[(j + b) * b..][..b], x, &mut last);
    }
    substitute_back(b, lower, inverse, x);
}

/// Solves D Lᵀ x = x.
#[inline(always)]
fn substitute_back(b: usize, lower: &[f64], inverse: &[f64], x: &mut [f64]) {
    // What the rows after take from the b rows before them, nearest first.
    let mut taken = [0.0; WIDEST];
    for (j, (x, scale)) in x.iter_mut().zip(&inverse[b..]).enumerate().rev() {
        let row = &lower[(j + b) * b..][..b];
        let found = *x * scale - taken[0];
        *x = found;
        for k in 0..b {
            let before = if k + 1 < b { taken[k + 1] } else { 0.0 };
            taken[k] = before + row[b - 1 - k] * found;
        }
    }
}

/// Solves `(A + C) x = b`, where C are symmetric entries outside the band, each given once for (i,
/// j) with i ≠ j; `b` becomes `x`. Sparse Cholesky with a fill-reducing order; it allocates.
///
/// # Errors
/// `NotPositive` when the sum is not positive definite, `TooLarge` when there is no memory for it.
pub fn solve_coupled(a: &BandMatrix, coupling: &[(usize, usize, f64)], b: &mut [f64]) -> Result<(), FactorError> {
    let too_large = FactorError::TooLarge { rows: a.rows };
    let mut entries = Vec::with_capacity(a.values.len() + coupling.len());
    for j in 0..a.rows {
        for i in j.saturating_sub(a.half_bandwidth)..=j {
            entries.push(Triplet::new(j, i, a.get(i, j)));
        }
    }
    // Lower triangle: rows at or below the diagonal.
    entries.extend(coupling.iter().map(|&(i, j, value)| Triplet::new(i.max(j), i.min(j), value)));
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(a.rows, a.rows, &entries).map_err(|_| too_large)?;
    if entries.iter().any(|t| !t.val.is_finite()) {
        return Err(FactorError::NotPositive { row: 0, pivot: f64::NAN });
    }
    let factor = matrix.sp_cholesky(Side::Lower).map_err(|error| match error {
        LltError::Numeric(faer::linalg::cholesky::llt::factor::LltError::NonPositivePivot { index }) => {
            FactorError::NotPositive { row: index.saturating_sub(1), pivot: 0.0 }
        }
        LltError::Generic(_) => too_large,
    })?;
    let rows = a.rows;
    factor.solve_in_place(MatMut::from_column_major_slice_mut(b, rows, 1));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A random symmetric band matrix with `shift` on the diagonal.
    fn matrix(rows: usize, half_bandwidth: usize, numbers: &[f64], shift: f64) -> BandMatrix {
        let mut a = BandMatrix::new(rows, half_bandwidth);
        let mut next = numbers.iter().copied().cycle();
        for j in 0..rows {
            for i in j.saturating_sub(half_bandwidth)..=j {
                a.add(i, j, next.next().unwrap_or(0.0));
            }
            a.add(j, j, shift);
        }
        a
    }

    proptest! {
        #[test]
        fn solves_what_it_multiplies(
            rows in 1usize..30, band in 0usize..6, numbers in prop::collection::vec(-1.0..1.0f64, 37),
        ) {
            let a = matrix(rows, band, &numbers, 2.0 * band as f64 + 3.0);
            let x: Vec<f64> = (0..rows).map(|i| numbers[i % 37]).collect();
            let mut b = vec![0.0; rows];
            a.multiply(&x, &mut b);
            let mut factor = BandFactor::new(rows, band).unwrap();
            for _ in 0..2 {
                factor.factor(&a).unwrap();
                let mut y = b.clone();
                factor.solve_in_place(&mut y);
                for (x, y) in x.iter().zip(&y) {
                    prop_assert!((x - y).abs() < 1e-12);
                }
                let mut at_once = b.clone();
                factor.factor_and_solve(&a, &mut at_once).unwrap();
                prop_assert_eq!(at_once, y);
            }
        }

        /// faer's sparse Cholesky is the reference.
        #[test]
        fn solves_as_faer_does(
            rows in 1usize..60, band in 0usize..7, numbers in prop::collection::vec(-1.0..1.0f64, 37), shift in 0.0..8.0f64,
        ) {
            let a = matrix(rows, band, &numbers, shift);
            let mut expected: Vec<f64> = (0..rows).map(|i| numbers[(5 * i) % 37]).collect();
            let mut x = expected.clone();
            let mut factor = BandFactor::new(rows, band).unwrap();
            let definite = factor.factor(&a).is_ok();
            prop_assert_eq!(definite, solve_coupled(&a, &[], &mut expected).is_ok());
            if definite {
                factor.solve_in_place(&mut x);
                let size = expected.iter().fold(1.0, |m: f64, e| m.max(e.abs()));
                for (x, e) in x.iter().zip(&expected) {
                    prop_assert!((x - e).abs() < 1e-9 * size * size, "{} {}", x, e);
                }
            }
        }

        #[test]
        fn counts_negative_eigenvalues(numbers in prop::collection::vec(-1.0..1.0f64, 37), shift in -3.0..3.0f64) {
            let a = matrix(9, 3, &numbers, shift);
            let dense = nalgebra::DMatrix::from_fn(9, 9, |i, j| if i.abs_diff(j) <= 3 { a.get(i, j) } else { 0.0 });
            let eigenvalues = dense.symmetric_eigen().eigenvalues;
            prop_assume!(eigenvalues.iter().all(|e| e.abs() > 1e-6));
            let mut factor = BandFactor::new(9, 3).unwrap();
            let definite = factor.factor(&a).is_ok();
            prop_assert_eq!(definite, eigenvalues.iter().all(|&e| e > 0.0));
            prop_assert_eq!(factor.negative_pivots(), eigenvalues.iter().filter(|&&e| e < 0.0).count());
        }
    }

    #[test]
    fn a_block_is_its_entries() {
        let block = [[1.0, 2.0], [3.0, 4.0]];
        for (i, j) in [(0, 0), (0, 2), (2, 2), (2, 4), (6, 6), (4, 6)] {
            let (mut a, mut b) = (BandMatrix::new(8, 3), BandMatrix::new(8, 3));
            a.add_block(i, j, block);
            for (r, c) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().filter(|&(r, c)| i < j || r <= c) {
                b.add(i + r, j + c, block[r][c]);
            }
            assert_eq!(a.values, b.values, "{i}, {j}");
        }
    }

    #[test]
    fn a_spring_is_its_blocks() {
        let [xx, xy, yy] = [2.0, 0.3, 5.0];
        for band in [3, 5] {
            for i in [0, 2, 4] {
                let (mut a, mut b) = (BandMatrix::new(8, band), BandMatrix::new(8, band));
                a.add_spring(i, [xx, xy, yy]);
                a.add_diagonal(i, 0.25);
                b.add(i, i, 0.25);
                b.add(i + 1, i + 1, 0.25);
                b.add_block(i, i, [[xx, xy], [xy, yy]]);
                b.add_block(i + 2, i + 2, [[xx, xy], [xy, yy]]);
                b.add_block(i, i + 2, [[-xx, -xy], [-xy, -yy]]);
                assert_eq!(a.values, b.values, "{band}, {i}");
            }
        }
    }

    #[test]
    fn names_the_row_of_the_first_bad_pivot() {
        let mut a = BandMatrix::new(6, 3);
        for i in 0..6 {
            a.add(i, i, if i == 4 { -2.0 } else { 1.0 });
        }
        let mut factor = BandFactor::new(6, 3).unwrap();
        assert_eq!(factor.factor(&a), Err(FactorError::NotPositive { row: 4, pivot: -2.0 }));
        a.add(2, 3, f64::NAN);
        assert!(matches!(factor.factor(&a), Err(FactorError::NotPositive { row: 3, .. })));
    }

    #[test]
    fn a_pinned_unknown_keeps_its_right_hand_side() {
        let mut a = matrix(8, 3, &[0.3, -0.2, 0.5], 6.0);
        a.pin(5);
        let mut factor = BandFactor::new(8, 3).unwrap();
        factor.factor(&a).unwrap();
        let mut b = vec![1.0; 8];
        b[5] = 0.25;
        factor.solve_in_place(&mut b);
        assert_eq!(b[5], 0.25);
    }
}

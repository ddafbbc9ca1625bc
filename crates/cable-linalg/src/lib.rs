//! Symmetric band matrices and their factorisation `A = L D Lᵀ` on faer's simplicial sparse Cholesky.
//!
//! The order is kept (`SymmetricOrdering::Identity`): a chain of nodes numbered along the cable fills nothing
//! outside its band. The symbolic part, the factor and the scratch memory are made once; [`BandFactor::factor`]
//! and [`BandFactor::solve_in_place`] allocate nothing. There is no pivoting, so a pivot ≤ 0 (or NaN) means "not
//! positive definite" and is reported with its row, which tells the node where a structure is not stable.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::prelude::Solve;
use faer::sparse::linalg::LltError;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, SparseColMatRef, SymbolicSparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side};
use thiserror::Error;

/// Half-bandwidth of two coordinates a node when each node sees its neighbours (bars).
pub const BARS_HALF_BANDWIDTH: usize = 3;
/// Half-bandwidth of two coordinates a node when each node sees two neighbours on each side (bending).
pub const BENDING_HALF_BANDWIDTH: usize = 5;

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
    /// There is no memory for it.
    #[error("no memory for a matrix of {rows} rows")]
    TooLarge {
        /// Its rows.
        rows: usize,
    },
}

/// A symmetric matrix with entries up to `half_bandwidth` away from the diagonal; the upper triangle is stored.
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
        let mut m = Self { rows, half_bandwidth, values: Vec::new() };
        m.values = vec![0.0; m.column_start(rows)];
        m
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

    /// Where column `j` starts in `values`: columns grow from 1 to `half_bandwidth + 1` entries.
    fn column_start(&self, j: usize) -> usize {
        let b = self.half_bandwidth;
        if j <= b { j * (j + 1) / 2 } else { b * (b + 1) / 2 + (j - b) * (b + 1) }
    }

    fn index(&self, i: usize, j: usize) -> usize {
        let (i, j) = (i.min(j), i.max(j));
        debug_assert!(j - i <= self.half_bandwidth && j < self.rows, "({i}, {j}) lies outside the band");
        self.column_start(j) + i - j.saturating_sub(self.half_bandwidth)
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

    /// Adds a 2×2 block in rows i, i + 1 and columns j, j + 1 with i ≤ j and, by symmetry, its mirror; of a block on the
    /// diagonal (i = j) the entry below it is not read.
    pub fn add_block(&mut self, i: usize, j: usize, block: [[f64; 2]; 2]) {
        for c in 0..2 {
            let column = j + c;
            let row = self.column_start(column) + i - column.saturating_sub(self.half_bandwidth);
            self.values[row] += block[0][c];
            if i < j || c == 1 {
                self.values[row + 1] += block[1][c];
            }
        }
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
            let column = &self.values[self.column_start(j)..self.column_start(j + 1)];
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
pub struct BandFactor {
    rows: usize,
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    memory: MemBuffer,
}

impl BandFactor {
    /// Makes room for matrices of this size and band.
    ///
    /// # Errors
    /// `TooLarge` when there is no memory for it.
    pub fn new(rows: usize, half_bandwidth: usize) -> Result<Self, FactorError> {
        let too_large = FactorError::TooLarge { rows };
        let shape = BandMatrix { rows, half_bandwidth: half_bandwidth.min(rows.saturating_sub(1)), values: Vec::new() };
        let column_starts = (0..=rows).map(|j| shape.column_start(j)).collect();
        let row_indices = (0..rows).flat_map(|j| j.saturating_sub(shape.half_bandwidth)..=j).collect();
        let pattern = SymbolicSparseColMat::new_checked(rows, rows, column_starts, None, row_indices);
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..CholeskySymbolicParams::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(pattern.as_ref(), Side::Upper, SymmetricOrdering::Identity, parameters)
                .map_err(|_| too_large)?;
        let need = StackReq::or(
            symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, faer::Spec::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        );
        let memory = MemBuffer::try_new(need).map_err(|_| too_large)?;
        Ok(Self { rows, values: vec![0.0; symbolic.len_val()], pattern, symbolic, memory })
    }

    /// Number of rows it was made for.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Factorises `a`, which must have the rows and band this was made for.
    ///
    /// # Errors
    /// `NotPositive` with the first row whose pivot is not positive. If only the sign was wrong the factor is
    /// still there and [`Self::solve_in_place`] solves with it (a saddle); after a zero or NaN pivot it is not.
    pub fn factor(&mut self, a: &BandMatrix) -> Result<(), FactorError> {
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), &a.values);
        let regularization = LdltRegularization::default();
        let stack = MemStack::new(&mut self.memory);
        let done = self.symbolic.factorize_numeric_ldlt(
            &mut self.values,
            matrix,
            Side::Upper,
            regularization,
            Par::Seq,
            stack,
            faer::Spec::default(),
        );
        if let Err(error) = done {
            let faer::linalg::cholesky::ldlt::factor::LdltError::ZeroPivot { index } = error;
            return Err(FactorError::NotPositive { row: index.saturating_sub(1), pivot: 0.0 });
        }
        if let SymbolicCholeskyRaw::Simplicial(symbolic) = self.symbolic.raw() {
            for (row, &start) in symbolic.col_ptr().iter().take(self.rows).enumerate() {
                let pivot = self.values[start];
                if !(pivot > 0.0) {
                    return Err(FactorError::NotPositive { row, pivot });
                }
            }
        }
        Ok(())
    }

    /// Number of negative pivots of the last factorisation: how many directions the matrix bends down in.
    #[must_use]
    pub fn negative_pivots(&self) -> usize {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(s) => {
                s.col_ptr().iter().take(self.rows).filter(|&&k| !(self.values[k] > 0.0)).count()
            }
            SymbolicCholeskyRaw::Supernodal(_) => 0,
        }
    }

    /// Solves `A x = b` with the last factorisation; `b` becomes `x`.
    pub fn solve_in_place(&mut self, b: &mut [f64]) {
        let rows = self.rows;
        LdltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(b, rows, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }
}

/// Solves `(A + C) x = b`, where C are symmetric entries outside the band, each given once for (i, j) with i ≠ j; `b`
/// becomes `x`. Sparse Cholesky with a fill-reducing order; it allocates.
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

impl std::fmt::Debug for BandFactor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BandFactor").field("rows", &self.rows).finish_non_exhaustive()
    }
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

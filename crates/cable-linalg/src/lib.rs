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

/// The reason why a matrix could not be factorised.
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

    #[inline]
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
    #[inline]
    #[must_use]
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.values[self.index(i, j)]
    }

    /// Adds `value` to entry (i, j) and, by symmetry, (j, i). Call once for each pair.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let k = self.index(i, j);
        self.values[k] += value;
    }

    /// Adds `value` to the entries (i, i) and (i + 1, i + 1).
    #[inline]
    pub fn add_diagonal(&mut self, i: usize, value: f64) {
        let b = self.half_bandwidth;
        let Some(w) = self.values.get_mut((i + 1) * b + i..).and_then(|w| w.get_mut(..b + 2)) else { return };
        w[0] += value;
        w[b + 1] += value;
    }

    /// Adds a 2×2 block in rows i, i + 1 and columns j, j + 1 with i ≤ j and, by symmetry, its
    /// mirror; of a block on the diagonal (i = j) the entry below it is not read.
    #[inline]
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
    #[inline]
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
    #[inline]
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

/// Rows of a factor, one after the other.
#[derive(Clone, Debug)]
struct Chain {
    /// Rows of L, b numbers each up to the diagonal of ones, after b rows of zeros.
    lower: Vec<f64>,
    /// 1/d of each row, after b zeros.
    inverse: Vec<f64>,
}

impl Chain {
    /// Room for so many rows; None where there is no memory for it.
    fn new(rows: usize, b: usize) -> Option<Self> {
        let (mut lower, mut inverse) = (Vec::new(), Vec::new());
        let size = rows.checked_add(b)?.checked_mul(b)?;
        lower.try_reserve_exact(size).ok()?;
        inverse.try_reserve_exact(rows + b).ok()?;
        lower.resize(size, 0.0);
        inverse.resize(rows + b, 0.0);
        Some(Self { lower, inverse })
    }
}

/// The factor of a [`BandMatrix`], with everything needed to factorise again and again.
#[derive(Clone, Debug)]
pub struct BandFactor {
    rows: usize,
    half_bandwidth: usize,
    /// From the first row to the last.
    whole: Chain,
    /// From both ends to the b rows in the middle, which are the last of each.
    halves: [Chain; 2],
    /// L of the rows in the middle, and 1/d on its diagonal.
    middle: [[f64; WIDEST]; WIDEST],
    /// True if the last factor is the one from both ends.
    from_both_ends: bool,
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
        let chain = |rows| Chain::new(rows, b).ok_or(too_large);
        let [first, second] = rows_beside_middle(rows, b);
        Ok(Self {
            rows,
            half_bandwidth: b,
            whole: chain(rows)?,
            halves: [chain(first + b)?, chain(second + b)?],
            middle: [[0.0; WIDEST]; WIDEST],
            from_both_ends: false,
        })
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
        self.from_both_ends = false;
        // With the band known when this is compiled its loops are unrolled: three times as fast.
        match self.half_bandwidth {
            BARS_HALF_BANDWIDTH => factor(BARS_HALF_BANDWIDTH, &a.values, &mut self.whole),
            BENDING_HALF_BANDWIDTH => factor(BENDING_HALF_BANDWIDTH, &a.values, &mut self.whole),
            b => factor(b, &a.values, &mut self.whole),
        }
    }

    /// Number of negative pivots of the last factorisation: how many directions the matrix bends
    /// down in.
    #[must_use]
    pub fn negative_pivots(&self) -> usize {
        self.whole.inverse.iter().skip(self.half_bandwidth).filter(|&&d| !(d > 0.0)).count()
    }

    /// Factorises `a` and solves `a x = b`; `b` becomes `x`. The elimination goes from both ends to
    /// the middle, and substitutes on the way: each pivot waits for the one before it, and while
    /// one end waits the processor works at the other (the "burn at both ends" of LINPACK's
    /// tridiagonal solvers: J. Dongarra and others, LINPACK Users' Guide, SIAM 1979, chapter 7).
    ///
    /// # Errors
    /// `NotPositive` with the first row whose pivot was not positive; then neither the factor nor
    /// `b` is of use.
    pub fn factor_and_solve(&mut self, a: &BandMatrix, b: &mut [f64]) -> Result<(), FactorError> {
        debug_assert!(a.rows == self.rows && a.half_bandwidth == self.half_bandwidth && b.len() == self.rows);
        self.from_both_ends = self.rows >= 4 * self.half_bandwidth;
        let (halves, middle) = (&mut self.halves, &mut self.middle);
        match self.half_bandwidth {
            BARS_HALF_BANDWIDTH if self.from_both_ends => {
                meet_in_the_middle::<BARS_HALF_BANDWIDTH>(&a.values, halves, middle, b)
            }
            BENDING_HALF_BANDWIDTH if self.from_both_ends => {
                meet_in_the_middle::<BENDING_HALF_BANDWIDTH>(&a.values, halves, middle, b)
            }
            _ => {
                self.factor(a)?;
                self.solve_in_place(b);
                Ok(())
            }
        }
    }

    /// Solves `A x = b` with the last factorisation; `b` becomes `x`.
    pub fn solve_in_place(&mut self, b: &mut [f64]) {
        let (halves, middle) = (&self.halves, &self.middle);
        match self.half_bandwidth {
            BARS_HALF_BANDWIDTH if self.from_both_ends => {
                solve_from_both_ends::<BARS_HALF_BANDWIDTH>(halves, middle, b);
            }
            BENDING_HALF_BANDWIDTH if self.from_both_ends => {
                solve_from_both_ends::<BENDING_HALF_BANDWIDTH>(halves, middle, b);
            }
            BARS_HALF_BANDWIDTH => solve::<BARS_HALF_BANDWIDTH>(&self.whole, b),
            BENDING_HALF_BANDWIDTH => solve::<BENDING_HALF_BANDWIDTH>(&self.whole, b),
            0 => solve::<0>(&self.whole, b),
            1 => solve::<1>(&self.whole, b),
            2 => solve::<2>(&self.whole, b),
            4 => solve::<4>(&self.whole, b),
            6 => solve::<6>(&self.whole, b),
            7 => solve::<7>(&self.whole, b),
            _ => solve::<WIDEST>(&self.whole, b),
        }
    }
}

/// L and 1/d of a matrix of half-bandwidth `b`.
#[inline(always)]
fn factor(b: usize, values: &[f64], chain: &mut Chain) -> Result<(), FactorError> {
    let mut done = Ok(());
    for (j, column) in values.chunks_exact(b + 1).enumerate() {
        let d = eliminate(b, j, column, column[b], chain);
        if !(d > 0.0) {
            done = done.and(Err(FactorError::NotPositive { row: j, pivot: d }));
            if !(d < 0.0) {
                return done;
            }
        }
    }
    done
}

/// Row `j` of L and of 1/d from the `b` entries of column `j` of the matrix above the diagonal, the
/// one on it, and the rows before it; returns d.
#[inline(always)]
fn eliminate(b: usize, j: usize, column: &[f64], diagonal: f64, chain: &mut Chain) -> f64 {
    let (before, here) = chain.lower[j * b..].split_at_mut(b * b);
    let (scales, pivot) = chain.inverse[j..].split_at_mut(b);
    let row = &mut here[..b];
    // Into `row` first v, then L.
    for i in 0..b {
        let mut v = column[i];
        for k in 0..i {
            v -= row[k] * before[i * b + b + k - i];
        }
        row[i] = v;
    }
    let mut d = diagonal;
    for i in 0..b {
        let l = row[i] * scales[i];
        d -= row[i] * l;
        row[i] = l;
    }
    pivot[0] = 1.0 / d;
    d
}

/// Takes from an unknown what its row of L takes of the B before it.
#[inline(always)]
fn substitute<const B: usize>(row: &[f64], x: &mut f64, last: &mut [f64; B]) {
    let mut sum = *x;
    for k in 0..B {
        sum -= row[k] * last[k];
    }
    *x = sum;
    for k in 1..B {
        last[k - 1] = last[k];
    }
    if B > 0 {
        last[B - 1] = sum;
    }
}

/// Adds what row `j` of a chain, whose unknown is `found`, takes from the B before it, nearest
/// first.
#[inline(always)]
fn pass_back<const B: usize>(j: usize, chain: &Chain, found: f64, taken: &mut [f64; B]) {
    let row = &chain.lower[(j + B) * B..][..B];
    for k in 0..B {
        let before = if k + 1 < B { taken[k + 1] } else { 0.0 };
        taken[k] = before + row[B - 1 - k] * found;
    }
}

/// The unknown of row `j` of a chain from Lᵀ, when those after it are known.
#[inline(always)]
fn substitute_back<const B: usize>(j: usize, chain: &Chain, x: &mut f64, taken: &mut [f64; B]) {
    let found = *x * chain.inverse[j + B] - taken.first().unwrap_or(&0.0);
    *x = found;
    pass_back(j, chain, found, taken);
}

/// Solves L D Lᵀ x = x for a half-bandwidth B. What the next row needs stays in registers.
#[inline(always)]
fn solve<const B: usize>(chain: &Chain, x: &mut [f64]) {
    let mut last = [0.0; B];
    for (j, x) in x.iter_mut().enumerate() {
        substitute(&chain.lower[(j + B) * B..][..B], x, &mut last);
    }
    let mut taken = [0.0; B];
    for (j, x) in x.iter_mut().enumerate().rev() {
        substitute_back(j, chain, x, &mut taken);
    }
}

/// Rows before and after the `b` rows in the middle.
fn rows_beside_middle(rows: usize, b: usize) -> [usize; 2] {
    let outside = rows.saturating_sub(b);
    [outside / 2, outside - outside / 2]
}

/// Column `j` of a matrix of half-bandwidth B, as it is read from the last row to the first.
#[inline(always)]
fn column_from_below<const B: usize>(values: &[f64], j: usize) -> [f64; B] {
    let mut column = [0.0; B];
    for i in 0..B {
        column[i] = values.get((j + B - i) * (B + 1) + i).copied().unwrap_or(0.0);
    }
    column
}

/// Factorises from both ends and solves.
///
/// With the unknowns of the first part T, of the middle M and of the last part B,
/// ```text
/// S = A_MM − L_MT D_T L_MTᵀ − L_MB D_B L_MBᵀ,      S x_M = f_M − L_MT y_T − L_MB y_B
/// ```
/// where L y = f in T and B, which do not see each other.
#[inline(always)]
fn meet_in_the_middle<const B: usize>(
    values: &[f64],
    halves: &mut [Chain; 2],
    middle: &mut [[f64; WIDEST]; WIDEST],
    x: &mut [f64],
) -> Result<(), FactorError> {
    let rows = x.len();
    let [first, second] = rows_beside_middle(rows, B);
    let [top, bottom] = halves;
    let (mut above, mut below) = ([0.0; B], [0.0; B]);
    // The last part has as many rows as the first, or one more.
    for r in 0..second {
        let j = rows - 1 - r;
        let column = column_from_below::<B>(values, j);
        let d = eliminate(B, r, &column, values[j * (B + 1) + B], bottom);
        if !(d > 0.0) {
            return Err(FactorError::NotPositive { row: j, pivot: d });
        }
        substitute(&bottom.lower[(r + B) * B..][..B], &mut x[j], &mut below);
        if r < first {
            let column = &values[r * (B + 1)..][..B + 1];
            let d = eliminate(B, r, column, column[B], top);
            if !(d > 0.0) {
                return Err(FactorError::NotPositive { row: r, pivot: d });
            }
            substitute(&top.lower[(r + B) * B..][..B], &mut x[r], &mut above);
        }
    }
    // S, its upper triangle; row t of the middle is row B − 1 − t as seen from below.
    for t in 0..B {
        let column = &values[(first + t) * (B + 1)..][..B + 1];
        for u in 0..=t {
            middle[u][t] = column[B - t + u];
        }
    }
    for t in 0..B {
        let column = &values[(first + t) * (B + 1)..][..B + 1];
        let scaled = eliminate_middle::<B>(first, t, column, top);
        for u in 0..=t {
            middle[u][t] -= share(&scaled, t, &top.lower[(first + u + B) * B..][..B], u);
        }
        let j = first + B - 1 - t;
        let scaled = eliminate_middle::<B>(second, t, &column_from_below::<B>(values, j), bottom);
        for u in 0..=t {
            middle[B - 1 - t][B - 1 - u] -= share(&scaled, t, &bottom.lower[(second + u + B) * B..][..B], u);
        }
    }
    for t in 0..B {
        for u in 0..=t {
            let mut v = middle[u][t];
            for k in 0..u {
                v -= middle[k][t] * middle[k][u] / middle[k][k];
            }
            middle[u][t] = v;
        }
        if !(middle[t][t] > 0.0) {
            return Err(FactorError::NotPositive { row: first + t, pivot: middle[t][t] });
        }
    }
    solve_middle([first, second], halves, middle, [above, below], x);
    Ok(())
}

/// Row `t` of the middle in the `rows` before it: L, and v = L D, which it returns.
#[inline(always)]
fn eliminate_middle<const B: usize>(rows: usize, t: usize, column: &[f64], chain: &mut Chain) -> [f64; B] {
    let j = rows + t;
    let mut v = [0.0; B];
    for i in 0..B - t {
        v[i] = column[i];
        for k in 0..i {
            v[i] -= v[k] * chain.lower[(j + i) * B + B + k - i];
        }
    }
    let (scales, row) = (&chain.inverse[j..j + B], &mut chain.lower[(j + B) * B..][..B]);
    for i in 0..B {
        row[i] = v[i] * scales[i];
    }
    v
}

/// The part of an entry of S: v of row `t` of the middle times L of row `u` ≤ `t`.
#[inline(always)]
fn share<const B: usize>(v: &[f64; B], t: usize, row: &[f64], u: usize) -> f64 {
    // The row of t begins t − u columns after that of u.
    (0..B - t).map(|i| v[i] * row[i + t - u]).sum()
}

/// Solves with a factor from both ends.
#[inline(always)]
fn solve_from_both_ends<const B: usize>(halves: &[Chain; 2], middle: &[[f64; WIDEST]; WIDEST], x: &mut [f64]) {
    let rows = x.len();
    let [first, second] = rows_beside_middle(rows, B);
    let [top, bottom] = halves;
    let (mut above, mut below) = ([0.0; B], [0.0; B]);
    for r in 0..second {
        substitute(&bottom.lower[(r + B) * B..][..B], &mut x[rows - 1 - r], &mut below);
        if r < first {
            substitute(&top.lower[(r + B) * B..][..B], &mut x[r], &mut above);
        }
    }
    solve_middle([first, second], halves, middle, [above, below], x);
}

/// The rest of a solution, when L is solved before and after the middle: `above` and `below` are
/// the unknowns beside it.
#[inline(always)]
fn solve_middle<const B: usize>(
    [first, second]: [usize; 2],
    halves: &[Chain; 2],
    middle: &[[f64; WIDEST]; WIDEST],
    [above, below]: [[f64; B]; 2],
    x: &mut [f64],
) {
    let rows = x.len();
    let [top, bottom] = halves;
    for t in 0..B {
        // L of the middle ends with columns of the middle, which are zeros.
        let row = &top.lower[(first + t + B) * B..][..B];
        let up: f64 = (0..B - t).map(|i| row[i] * above[i + t]).sum();
        x[first + t] -= up;
        let row = &bottom.lower[(second + t + B) * B..][..B];
        let down: f64 = (0..B - t).map(|i| row[i] * below[i + t]).sum();
        x[first + B - 1 - t] -= down;
    }
    for t in 0..B {
        for k in 0..t {
            x[first + t] -= middle[k][t] / middle[k][k] * x[first + k];
        }
    }
    for t in (0..B).rev() {
        x[first + t] /= middle[t][t];
        for k in t + 1..B {
            x[first + t] -= middle[t][k] / middle[t][t] * x[first + k];
        }
    }
    let mut taken = [[0.0; B]; 2];
    for t in (0..B).rev() {
        pass_back(first + t, top, x[first + t], &mut taken[0]);
        pass_back(second + t, bottom, x[first + B - 1 - t], &mut taken[1]);
    }
    for r in (0..second).rev() {
        if r < first {
            substitute_back(r, top, &mut x[r], &mut taken[0]);
        }
        substitute_back(r, bottom, &mut x[rows - 1 - r], &mut taken[1]);
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
                let mut again = b.clone();
                factor.solve_in_place(&mut again);
                for ((x, y), z) in x.iter().zip(&at_once).zip(&again) {
                    prop_assert!((x - y).abs() < 1e-12 && (x - z).abs() < 1e-12, "{} {} {}", x, y, z);
                }
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
            let mut at_once = x.clone();
            prop_assert_eq!(definite, factor.factor_and_solve(&a, &mut at_once).is_ok());
            if definite {
                factor.factor(&a).unwrap();
                factor.solve_in_place(&mut x);
                let size = expected.iter().fold(1.0, |m: f64, e| m.max(e.abs()));
                for ((x, y), e) in x.iter().zip(&at_once).zip(&expected) {
                    prop_assert!((x - e).abs() < 1e-9 * size * size, "{} {}", x, e);
                    prop_assert!((y - e).abs() < 1e-9 * size * size, "{} {}", y, e);
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

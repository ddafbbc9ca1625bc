//! These functions factorise a symmetric band matrix and substitute row by row, from its first row
//! to its last.

use crate::FactorError;

/// Rows of the factors L and D, in the order of elimination. Room for rows of zeros before the
/// first lets every row be computed alike.
#[derive(Clone, Debug)]
pub(super) struct FactorRows {
    /// Rows of L, b numbers each up to the diagonal of ones, after b rows of zeros.
    pub(super) lower: Vec<f64>,
    /// 1/d of each row, after b zeros.
    pub(super) inverse: Vec<f64>,
}

impl FactorRows {
    /// Room for so many rows; None where there is no memory for it.
    pub(super) fn new(rows: usize, b: usize) -> Option<Self> {
        let (mut lower, mut inverse) = (Vec::new(), Vec::new());
        let size = rows.checked_add(b)?.checked_mul(b)?;
        lower.try_reserve_exact(size).ok()?;
        inverse.try_reserve_exact(rows + b).ok()?;
        lower.resize(size, 0.0);
        inverse.resize(rows + b, 0.0);
        Some(Self { lower, inverse })
    }
}

/// Computes L and 1/d of a matrix of half-bandwidth `b`.
#[inline(always)]
pub(super) fn factor(b: usize, values: &[f64], factors: &mut FactorRows) -> Result<(), FactorError> {
    let mut done = Ok(());
    for (j, column) in values.chunks_exact(b + 1).enumerate() {
        let d = eliminate(b, j, column, column[b], factors);
        if !(d > 0.0) {
            done = done.and(Err(FactorError::NotPositive { row: j, pivot: d }));
            if !(d < 0.0) {
                return done;
            }
        }
    }
    done
}

/// Computes row `j` of L and of 1/d from column `j` of the matrix (`b` entries above the diagonal,
/// and the diagonal) and from the rows before it; returns d.
#[inline(always)]
pub(super) fn eliminate(b: usize, j: usize, column: &[f64], diagonal: f64, factors: &mut FactorRows) -> f64 {
    let (before, here) = factors.lower[j * b..].split_at_mut(b * b);
    let (scales, pivot) = factors.inverse[j..].split_at_mut(b);
    let row = &mut here[..b];
    // `row` holds v first, and L after that.
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

/// One step of forward substitution: subtracts from `x` the product of its row of L with the B
/// unknowns before it, which `last` holds.
#[inline(always)]
pub(super) fn substitute<const B: usize>(row: &[f64], x: &mut f64, last: &mut [f64; B]) {
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

/// Adds the product of row `j` of L with its unknown, `found`, to the sums `taken` that back
/// substitution will subtract from the B unknowns before it, nearest first.
#[inline(always)]
pub(super) fn pass_back<const B: usize>(j: usize, factors: &FactorRows, found: f64, taken: &mut [f64; B]) {
    let row = &factors.lower[(j + B) * B..][..B];
    for k in 0..B {
        let before = if k + 1 < B { taken[k + 1] } else { 0.0 };
        taken[k] = before + row[B - 1 - k] * found;
    }
}

/// One step of back substitution with Lᵀ: the unknown of row `j`, if those after it are known.
#[inline(always)]
pub(super) fn substitute_back<const B: usize>(j: usize, factors: &FactorRows, x: &mut f64, taken: &mut [f64; B]) {
    let found = *x * factors.inverse[j + B] - taken.first().unwrap_or(&0.0);
    *x = found;
    pass_back(j, factors, found, taken);
}

/// Solves L D Lᵀ y = x for a half-bandwidth B, with y in place of x. The unknowns that the next row
/// needs stay in registers.
#[inline(always)]
pub(super) fn solve<const B: usize>(factors: &FactorRows, x: &mut [f64]) {
    let mut last = [0.0; B];
    for (j, x) in x.iter_mut().enumerate() {
        substitute(&factors.lower[(j + B) * B..][..B], x, &mut last);
    }
    let mut taken = [0.0; B];
    for (j, x) in x.iter_mut().enumerate().rev() {
        substitute_back(j, factors, x, &mut taken);
    }
}

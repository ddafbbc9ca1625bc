//! Elimination and substitution row by row from one end of a band matrix to the other.

use crate::FactorError;

/// Rows of a factor, one after the other.
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

/// L and 1/d of a matrix of half-bandwidth `b`.
#[inline(always)]
pub(super) fn factor(b: usize, values: &[f64], chain: &mut FactorRows) -> Result<(), FactorError> {
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
pub(super) fn eliminate(b: usize, j: usize, column: &[f64], diagonal: f64, chain: &mut FactorRows) -> f64 {
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

/// Adds what row `j` of a chain, whose unknown is `found`, takes from the B before it, nearest
/// first.
#[inline(always)]
pub(super) fn pass_back<const B: usize>(j: usize, chain: &FactorRows, found: f64, taken: &mut [f64; B]) {
    let row = &chain.lower[(j + B) * B..][..B];
    for k in 0..B {
        let before = if k + 1 < B { taken[k + 1] } else { 0.0 };
        taken[k] = before + row[B - 1 - k] * found;
    }
}

/// The unknown of row `j` of a chain from Lᵀ, when those after it are known.
#[inline(always)]
pub(super) fn substitute_back<const B: usize>(j: usize, chain: &FactorRows, x: &mut f64, taken: &mut [f64; B]) {
    let found = *x * chain.inverse[j + B] - taken.first().unwrap_or(&0.0);
    *x = found;
    pass_back(j, chain, found, taken);
}

/// Solves L D Lᵀ x = x for a half-bandwidth B. What the next row needs stays in registers.
#[inline(always)]
pub(super) fn solve<const B: usize>(chain: &FactorRows, x: &mut [f64]) {
    let mut last = [0.0; B];
    for (j, x) in x.iter_mut().enumerate() {
        substitute(&chain.lower[(j + B) * B..][..B], x, &mut last);
    }
    let mut taken = [0.0; B];
    for (j, x) in x.iter_mut().enumerate().rev() {
        substitute_back(j, chain, x, &mut taken);
    }
}

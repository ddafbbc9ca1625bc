//! These functions factorise a symmetric band matrix from both ends to its middle, and substitute.

use crate::one_way_elimination::{FactorRows, eliminate, pass_back, substitute, substitute_back};
use crate::{FactorError, WIDEST_HALF_BANDWIDTH};

/// Number of rows before and after the `b` rows in the middle.
pub(super) fn rows_beside_middle(rows: usize, b: usize) -> [usize; 2] {
    let outside = rows.saturating_sub(b);
    [outside / 2, outside - outside / 2]
}

/// Column `j` of a matrix of half-bandwidth B as elimination from the last row to the first reads
/// it.
#[inline(always)]
pub(super) fn column_from_below<const B: usize>(values: &[f64], j: usize) -> [f64; B] {
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
/// where L y = f in T and B, which have no entries in common.
#[inline(always)]
pub(super) fn meet_in_the_middle<const B: usize>(
    values: &[f64],
    halves: &mut [FactorRows; 2],
    middle: &mut [[f64; WIDEST_HALF_BANDWIDTH]; WIDEST_HALF_BANDWIDTH],
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
    schur_complement::<B>(values, halves, middle, [first, second]);
    factor_middle::<B>(middle, first)?;
    solve_middle([first, second], halves, middle, [above, below], x);
    Ok(())
}

/// Sets the upper triangle of the middle to S, from both parts with their numbers of rows.
#[inline(always)]
fn schur_complement<const B: usize>(
    values: &[f64],
    [top, bottom]: &mut [FactorRows; 2],
    middle: &mut [[f64; WIDEST_HALF_BANDWIDTH]; WIDEST_HALF_BANDWIDTH],
    [first, second]: [usize; 2],
) {
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
        // Row t of the middle is row B − 1 − t counted from below.
        let j = first + B - 1 - t;
        let scaled = eliminate_middle::<B>(second, t, &column_from_below::<B>(values, j), bottom);
        for u in 0..=t {
            middle[B - 1 - t][B - 1 - u] -= share(&scaled, t, &bottom.lower[(second + u + B) * B..][..B], u);
        }
    }
}

/// Factorises S in place into D and D Lᵀ; `first` is the number of rows before the middle.
#[inline(always)]
fn factor_middle<const B: usize>(
    middle: &mut [[f64; WIDEST_HALF_BANDWIDTH]; WIDEST_HALF_BANDWIDTH],
    first: usize,
) -> Result<(), FactorError> {
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
    Ok(())
}

/// Computes row `t` of the middle in the columns of the `rows` before it: stores L, and returns
/// v = L D.
#[inline(always)]
pub(super) fn eliminate_middle<const B: usize>(
    rows: usize,
    t: usize,
    column: &[f64],
    factors: &mut FactorRows,
) -> [f64; B] {
    let j = rows + t;
    let mut v = [0.0; B];
    for i in 0..B - t {
        v[i] = column[i];
        for k in 0..i {
            v[i] -= v[k] * factors.lower[(j + i) * B + B + k - i];
        }
    }
    let (scales, row) = (&factors.inverse[j..j + B], &mut factors.lower[(j + B) * B..][..B]);
    for i in 0..B {
        row[i] = v[i] * scales[i];
    }
    v
}

/// The term that elimination subtracts from entry (u, t) of S: v of row `t` of the middle times L
/// of row `u` ≤ `t`.
#[inline(always)]
pub(super) fn share<const B: usize>(v: &[f64; B], t: usize, row: &[f64], u: usize) -> f64 {
    // The row of t begins t − u columns after that of u.
    (0..B - t).map(|i| v[i] * row[i + t - u]).sum()
}

/// Solves with the factors that [`meet_in_the_middle`] made.
#[inline(always)]
pub(super) fn solve_from_both_ends<const B: usize>(
    halves: &[FactorRows; 2],
    middle: &[[f64; WIDEST_HALF_BANDWIDTH]; WIDEST_HALF_BANDWIDTH],
    x: &mut [f64],
) {
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

/// Completes a solution once forward substitution has reached the middle from both ends: `above`
/// and `below` are the unknowns beside it.
#[inline(always)]
pub(super) fn solve_middle<const B: usize>(
    [first, second]: [usize; 2],
    halves: &[FactorRows; 2],
    middle: &[[f64; WIDEST_HALF_BANDWIDTH]; WIDEST_HALF_BANDWIDTH],
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

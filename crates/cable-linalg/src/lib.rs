//! This crate solves linear systems with a banded matrix: symmetric ones by `A = L D Lᵀ`, those
//! that also couple nodes far apart by faer, and those without symmetry by LU with pivoting.
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
//! which tells the node where a structure is not stable. A matrix that also couples nodes far apart
//! is solved by faer's sparse Cholesky with a fill-reducing order ([`solve_coupled`]). A matrix
//! that is not symmetric, or that may become singular on the way, is a [`PivotingBand`]. Three
//! diagonals with few rows are eliminated by [`solve_tridiagonal`], which shows each pivot to its
//! caller.

mod band_factor;
mod band_matrix;
mod one_way_elimination;
mod pivoting_band;
mod sparse_cholesky;
#[cfg(test)]
mod tests;
mod tridiagonal;
mod two_way_elimination;

pub use band_factor::BandFactor;
pub use band_matrix::BandMatrix;
pub use pivoting_band::PivotingBand;
pub use sparse_cholesky::solve_coupled;
pub use tridiagonal::{TridiagonalRow, solve_tridiagonal};

use thiserror::Error;

/// Half-bandwidth of two coordinates a node when each node sees its neighbours (bars).
pub const BARS_HALF_BANDWIDTH: usize = 3;
/// Half-bandwidth of two coordinates a node when each node sees two neighbours on each side
/// (bending).
pub const BENDING_HALF_BANDWIDTH: usize = 5;

/// Widest half-bandwidth there is.
pub const WIDEST_HALF_BANDWIDTH: usize = 8;

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
    /// There is no memory for it, or its band is wider than [`WIDEST_HALF_BANDWIDTH`].
    #[error("no room for a matrix of {rows} rows")]
    TooLarge {
        /// Its rows.
        rows: usize,
    },
}

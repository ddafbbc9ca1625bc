//! This function solves a system that also couples nodes far apart, by sparse Cholesky.

use faer::prelude::Solve;
use faer::sparse::linalg::LltError;
use faer::sparse::{SparseColMat, Triplet};
use faer::{MatMut, Side};

use crate::FactorError;
use crate::band_matrix::BandMatrix;

/// Solves `(A + C) x = b`, where C are symmetric entries outside the band, each given once for (i,
/// j) with i ≠ j; `b` becomes `x`. It uses sparse Cholesky with a fill-reducing order, and
/// allocates.
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

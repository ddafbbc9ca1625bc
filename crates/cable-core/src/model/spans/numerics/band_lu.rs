//! This file holds the LU factorisation with partial pivoting of a matrix with a narrow band: G. H.
//! Golub and C. F. Van Loan, *Matrix Computations*, Johns Hopkins, 4th ed. 2013, §4.3. The
//! cable equilibrium's Jacobian is neither symmetric nor definite.

/// Entries left and right of the diagonal.
pub(in crate::model::spans) const BAND: usize = 4;
/// Entries of a stored row: pivoting fills as many again on the right.
const WIDTH: usize = 3 * BAND + 1;

/// A band matrix that is factorised in place.
#[derive(Clone, Debug, Default)]
pub(in crate::model::spans) struct Band {
    rows: Vec<[f64; WIDTH]>,
    /// True if the determinant of the last factorised matrix is negative.
    negative: bool,
}

impl Band {
    /// All zero, of a size.
    pub fn reset(&mut self, n: usize) {
        self.rows.resize(n, [0.0; WIDTH]);
        self.rows.iter_mut().for_each(|row| *row = [0.0; WIDTH]);
    }

    /// Adds to an entry; entries outside the band or the matrix must not be asked for and are left
    /// out.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        if let Some(entry) = self.rows.get_mut(row).and_then(|r| r.get_mut((column + BAND).wrapping_sub(row))) {
            *entry += value;
        }
    }

    /// Makes a row zero.
    pub fn clear(&mut self, row: usize) {
        if let Some(row) = self.rows.get_mut(row) {
            *row = [0.0; WIDTH];
        }
    }

    /// An entry as it was added.
    #[cfg(test)]
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        self.rows[row].get((column + BAND).wrapping_sub(row)).copied().unwrap_or(0.0)
    }

    /// Divides a row and its right-hand side by its largest entry.
    pub fn scale(&mut self, rhs: &mut [f64]) {
        for (row, r) in self.rows.iter_mut().zip(rhs) {
            // As it was added: nothing has filled the right.
            let row = &mut row[..=2 * BAND];
            let largest = row.iter().fold(0.0f64, |m, v| if v.abs() > m { v.abs() } else { m });
            if largest > 0.0 {
                let inverse = 1.0 / largest;
                row.iter_mut().for_each(|v| *v *= inverse);
                *r *= inverse;
            }
        }
    }

    /// True if the determinant of the last solved matrix is negative.
    pub fn is_negative(&self) -> bool {
        self.negative
    }

    /// Solves A x = b in place of b; false where A is singular or not finite.
    pub fn solve(&mut self, b: &mut Vec<f64>) -> bool {
        let n = self.rows.len();
        self.negative = false;
        // Rows of nothing after the last, so that each has as many below it.
        self.rows.resize(n + BAND, [0.0; WIDTH]);
        b.resize(n + BAND, 0.0);
        let found = (0..n).all(|k| self.eliminate(k, b));
        self.rows.truncate(n);
        if !found {
            return false;
        }
        for k in (0..n).rev() {
            let (Some(row), Some([own, after @ ..])) = (self.rows.get(k), b.get_mut(k..)) else { return false };
            let known = row[BAND + 1..].iter().zip(after).fold(*own, |sum, (a, x)| sum - a * *x);
            *own = known / row[BAND];
        }
        b.truncate(n);
        b.iter().all(|v| v.is_finite())
    }

    /// Column k goes from the rows below row k; false where it has no pivot.
    fn eliminate(&mut self, k: usize, b: &mut [f64]) -> bool {
        let windows = (self.rows.get_mut(k..), b.get_mut(k..));
        let (Some(rows), Some(b)) = windows else { return false };
        let (Some([pivot, below @ ..]), Some([right, b @ ..])) =
            (rows.first_chunk_mut::<{ BAND + 1 }>(), b.first_chunk_mut::<{ BAND + 1 }>())
        else {
            return false;
        };
        let (mut best, mut size) = (None, pivot[BAND].abs());
        for (d, row) in below.iter().enumerate() {
            let v = row[BAND - 1 - d].abs();
            if v > size || v.is_nan() {
                (best, size) = (Some(d), v);
            }
        }
        if !(size > 0.0 && size.is_finite()) {
            return false;
        }
        if let Some(d) = best {
            // Both rows in the columns k … k + 2 BAND, each at its own place.
            let other = &mut below[d][BAND - 1 - d..];
            pivot[BAND..].iter_mut().zip(other).for_each(|(a, b)| std::mem::swap(a, b));
            std::mem::swap(right, &mut b[d]);
            self.negative = !self.negative;
        }
        self.negative ^= pivot[BAND] < 0.0;
        let [inverse, right] = [1.0 / pivot[BAND], *right];
        let known: [f64; 2 * BAND] = std::array::from_fn(|i| pivot[BAND + 1 + i]);
        for d in 0..BAND {
            let row = &mut below[d];
            let factor = row[BAND - 1 - d] * inverse;
            if factor == 0.0 {
                continue;
            }
            // The columns k + 1 … k + 2 BAND; those beyond the matrix hold zeros.
            for i in 0..2 * BAND {
                row[BAND - d + i] -= factor * known[i];
            }
            b[d] -= factor * right;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn solves_what_a_dense_solver_solves(n in 1usize..14, seed in prop::collection::vec(-1.0f64..1.0, 14 * 15)) {
            let mut band = Band::default();
            band.reset(n);
            let mut dense = nalgebra::DMatrix::<f64>::zeros(n, n);
            let mut b = vec![0.0; n];
            for i in 0..n {
                for j in i.saturating_sub(BAND)..(i + BAND + 1).min(n) {
                    // Every third diagonal entry is zero: pivoting must be there.
                    let v = if i == j && i % 3 == 0 { 0.0 } else { seed[i * 15 + j] };
                    band.add(i, j, v);
                    dense[(i, j)] = v;
                }
                b[i] = seed[i * 15 + 14];
            }
            let rhs = nalgebra::DVector::from_vec(b.clone());
            let Some(expected) = dense.clone().lu().solve(&rhs) else { return Ok(()) };
            prop_assume!(expected.amax() < 1e6);
            prop_assert!(band.solve(&mut b));
            for i in 0..n {
                prop_assert!((b[i] - expected[i]).abs() < 1e-7 * (1.0 + expected.amax()), "{} {}", b[i], expected[i]);
            }
        }
    }
}

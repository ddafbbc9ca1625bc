//! LU factorisation with partial pivoting of a matrix with a narrow band: G. H. Golub and C. F. Van Loan, *Matrix
//! Computations*, Johns Hopkins, 4th ed. 2013, §4.3. The network's Jacobian is neither symmetric nor definite.

/// Entries left and right of the diagonal.
pub(super) const BAND: usize = 4;
/// Entries of a stored row: pivoting fills as many again on the right.
const WIDTH: usize = 3 * BAND + 1;

/// A band matrix that is factorised in place.
#[derive(Clone, Debug, Default)]
pub(super) struct Band {
    rows: Vec<[f64; WIDTH]>,
    /// Whether the determinant of what was factorised last is negative.
    negative: bool,
}

impl Band {
    /// All zero, of a size.
    pub fn reset(&mut self, n: usize) {
        self.rows.clear();
        self.rows.resize(n, [0.0; WIDTH]);
    }

    /// Adds to an entry; entries outside the band or the matrix must not be asked for and are left out.
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

    /// Whether the determinant of what was solved last is negative.
    pub fn is_negative(&self) -> bool {
        self.negative
    }

    /// Solves A x = b in place of b; false where A is singular or not finite.
    pub fn solve(&mut self, b: &mut [f64]) -> bool {
        let n = self.rows.len();
        self.negative = false;
        for k in 0..n {
            let last = (k + BAND + 1).min(n);
            let (Some((pivot_row, below)), Some((right, b))) =
                (self.rows[k..last].split_first_mut(), b[k..last].split_first_mut())
            else {
                return false;
            };
            let (mut best, mut size) = (None, pivot_row[BAND].abs());
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
                pivot_row[BAND..].iter_mut().zip(other).for_each(|(a, b)| std::mem::swap(a, b));
                std::mem::swap(right, &mut b[d]);
                self.negative = !self.negative;
            }
            self.negative ^= pivot_row[BAND] < 0.0;
            let [inverse, right] = [1.0 / pivot_row[BAND], *right];
            let known: &[f64; 2 * BAND] = pivot_row.last_chunk().unwrap_or(&[0.0; 2 * BAND]);
            for (d, (row, b)) in below.iter_mut().zip(b).enumerate() {
                let row = &mut row[BAND - 1 - d..];
                let factor = row[0] * inverse;
                if factor == 0.0 {
                    continue;
                }
                // The columns k + 1 … k + 2 BAND; those beyond the matrix hold zeros.
                if let Some(row) = row[1..].first_chunk_mut::<{ 2 * BAND }>() {
                    for (v, p) in row.iter_mut().zip(known) {
                        *v -= factor * p;
                    }
                }
                *b -= factor * right;
            }
        }
        for k in (0..n).rev() {
            let row = &self.rows[k];
            let known = row[BAND + 1..].iter().zip(&b[k + 1..]).fold(b[k], |sum, (a, x)| sum - a * x);
            b[k] = known / row[BAND];
        }
        b.iter().all(|v| v.is_finite())
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

//! A pivoting band matrix is solved by LU factorisation with partial pivoting within its band: G.
//! H. Golub and C. F. Van Loan, *Matrix Computations*, Johns Hopkins, 4th ed. 2013, §4.3. It is for
//! Jacobians that are neither symmetric nor definite.

/// A band matrix that is factorised in place: `HALF` entries on either side of the diagonal, and
/// `WIDTH` = 3 `HALF` + 1 in a stored row, as pivoting fills as many again on the right.
#[derive(Clone, Debug, Default)]
pub struct PivotingBand<const HALF: usize, const WIDTH: usize> {
    rows: Vec<[f64; WIDTH]>,
    /// True if the determinant of the last factorised matrix is negative.
    negative: bool,
}

impl<const HALF: usize, const WIDTH: usize> PivotingBand<HALF, WIDTH> {
    /// A row has room for what pivoting fills.
    const ROOM: () = assert!(WIDTH == 3 * HALF + 1, "a row has 3 HALF + 1 entries");

    /// All zero, of a size.
    #[must_use]
    pub fn new(n: usize) -> Self {
        let () = Self::ROOM;
        Self { rows: vec![[0.0; WIDTH]; n], negative: false }
    }

    /// All zero, of a size, in the same memory.
    pub fn reset(&mut self, n: usize) {
        let () = Self::ROOM;
        self.rows.clear();
        self.rows.resize(n, [0.0; WIDTH]);
    }

    /// Adds to an entry. Entries outside the band or the matrix are ignored; the caller must not
    /// add to them.
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        if let Some(entry) = self.rows.get_mut(row).and_then(|r| r.get_mut((column + HALF).wrapping_sub(row))) {
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
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        self.rows.get(row).and_then(|r| r.get((column + HALF).wrapping_sub(row))).copied().unwrap_or(0.0)
    }

    /// Divides each row and its right-hand side by its largest entry: equations of different
    /// quantities stand side by side.
    pub fn scale(&mut self, rhs: &mut [f64]) {
        for (row, r) in self.rows.iter_mut().zip(rhs) {
            // No pivoting has filled the right of the row yet.
            let row = &mut row[..=2 * HALF];
            let largest = row.iter().fold(0.0f64, |m, v| if v.abs() > m { v.abs() } else { m });
            if largest > 0.0 {
                let inverse = 1.0 / largest;
                row.iter_mut().for_each(|v| *v *= inverse);
                *r *= inverse;
            }
        }
    }

    /// True if the determinant of the last solved matrix is negative.
    #[must_use]
    pub fn is_negative(&self) -> bool {
        self.negative
    }

    /// Solves A x = b in place of b; false where A is singular or not finite.
    pub fn solve(&mut self, b: &mut Vec<f64>) -> bool {
        let n = self.rows.len();
        self.negative = false;
        // Rows of zeros after the last give every row the same number of rows below it.
        self.rows.resize(n + HALF, [0.0; WIDTH]);
        b.resize(n + HALF, 0.0);
        let found = (0..n).all(|k| self.eliminate(k, b));
        self.rows.truncate(n);
        if !found {
            return false;
        }
        for k in (0..n).rev() {
            let (Some(row), Some([own, after @ ..])) = (self.rows.get(k), b.get_mut(k..)) else { return false };
            let known = row[HALF + 1..].iter().zip(after).fold(*own, |sum, (a, x)| sum - a * *x);
            *own = known / row[HALF];
        }
        b.truncate(n);
        b.iter().all(|v| v.is_finite())
    }

    /// Eliminates column k from the rows below row k; false if it has no pivot.
    #[inline]
    fn eliminate(&mut self, k: usize, b: &mut [f64]) -> bool {
        let windows = (self.rows.get_mut(k..=k + HALF), b.get_mut(k..=k + HALF));
        let (Some([pivot, below @ ..]), Some([right, b @ ..])) = windows else { return false };
        let (mut best, mut size) = (None, pivot[HALF].abs());
        for (d, row) in below.iter().enumerate() {
            let v = row[HALF - 1 - d].abs();
            if v > size || v.is_nan() {
                (best, size) = (Some(d), v);
            }
        }
        if !(size > 0.0 && size.is_finite()) {
            return false;
        }
        if let Some(d) = best {
            // Each row stores the columns k … k + 2 HALF at a place of its own.
            let other = &mut below[d][HALF - 1 - d..];
            pivot[HALF..].iter_mut().zip(other).for_each(|(a, b)| std::mem::swap(a, b));
            std::mem::swap(right, &mut b[d]);
            self.negative = !self.negative;
        }
        self.negative ^= pivot[HALF] < 0.0;
        let [inverse, right] = [1.0 / pivot[HALF], *right];
        let known = &pivot[HALF + 1..];
        for (d, (row, b)) in below.iter_mut().zip(b).enumerate() {
            let factor = row[HALF - 1 - d] * inverse;
            if factor == 0.0 {
                continue;
            }
            // The columns k + 1 … k + 2 HALF; those beyond the matrix hold zeros.
            row[HALF - d..].iter_mut().zip(known).for_each(|(v, known)| *v -= factor * known);
            *b -= factor * right;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Solves a matrix of this band beside nalgebra's dense solver.
    fn compare<const HALF: usize, const WIDTH: usize>(n: usize, seed: &[f64]) -> Result<(), TestCaseError> {
        let mut band = PivotingBand::<HALF, WIDTH>::new(n);
        let mut dense = nalgebra::DMatrix::<f64>::zeros(n, n);
        let mut b = vec![0.0; n];
        for i in 0..n {
            for j in i.saturating_sub(HALF)..(i + HALF + 1).min(n) {
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
        prop_assert_eq!(band.is_negative(), dense.determinant() < 0.0);
        for i in 0..n {
            prop_assert!((b[i] - expected[i]).abs() < 1e-7 * (1.0 + expected.amax()), "{} {}", b[i], expected[i]);
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn solves_what_a_dense_solver_solves(n in 1usize..14, seed in prop::collection::vec(-1.0f64..1.0, 14 * 15)) {
            compare::<1, 4>(n, &seed)?;
            compare::<4, 13>(n, &seed)?;
            compare::<5, 16>(n, &seed)?;
        }
    }

    #[test]
    fn a_singular_matrix_and_one_with_nan_have_no_answer() {
        let mut band = PivotingBand::<1, 4>::new(2);
        band.add(0, 0, 1.0);
        band.add(1, 0, 1.0);
        assert!(!band.solve(&mut vec![1.0, 2.0]));
        band.reset(1);
        band.add(0, 0, f64::NAN);
        assert!(!band.solve(&mut vec![1.0]));
    }
}

//! This solver factorises a matrix whose band width is known at run time, LU with partial pivoting
//! (G. H. Golub and C. F. Van Loan, *Matrix Computations*, Johns Hopkins, 4th ed. 2013, §4.3).

/// A band matrix with as many entries on either side of the diagonal, factorised in place.
#[derive(Clone, Debug)]
pub(super) struct BandLu {
    half: usize,
    rows: Vec<f64>,
    size: usize,
}

impl BandLu {
    /// All zero.
    pub fn new(size: usize, half: usize) -> Self {
        // Pivoting fills as many again on the right.
        Self { half, size, rows: vec![0.0; size * (3 * half + 1)] }
    }

    fn place(&self, row: usize, column: usize) -> Option<usize> {
        let offset = (column + self.half).checked_sub(row)?;
        (offset <= 3 * self.half && row < self.size && column < self.size).then_some(row * (3 * self.half + 1) + offset)
    }

    /// Sets an entry; what lies outside the band is left out.
    pub fn set(&mut self, row: usize, column: usize, value: f64) {
        if let Some(k) = self.place(row, column) {
            self.rows[k] = value;
        }
    }

    /// Adds to an entry; what lies outside the band is left out.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        if let Some(k) = self.place(row, column) {
            self.rows[k] += value;
        }
    }

    fn get(&self, row: usize, column: usize) -> f64 {
        self.place(row, column).map_or(0.0, |k| self.rows[k])
    }

    /// Solves A x = b in place of b; false where A is singular or not finite.
    pub fn solve(&mut self, b: &mut [f64]) -> bool {
        let (n, half) = (self.size, self.half);
        for (row, b) in b.iter_mut().enumerate().take(n) {
            // Rows are brought to one size, as equations of length, angle and force stand side by
            // side.
            let width = 3 * half + 1;
            let entries = &mut self.rows[row * width..(row + 1) * width];
            let largest = entries.iter().fold(0.0f64, |m, v| if v.abs() > m { v.abs() } else { m });
            if !(largest > 0.0 && largest.is_finite()) {
                return false;
            }
            entries.iter_mut().for_each(|v| *v /= largest);
            *b /= largest;
        }
        for k in 0..n {
            let below = (k + half).min(n - 1);
            let right = (k + 2 * half).min(n - 1);
            let (mut best, mut size) = (k, self.get(k, k).abs());
            for i in k + 1..=below {
                let v = self.get(i, k).abs();
                if v > size || v.is_nan() {
                    (best, size) = (i, v);
                }
            }
            if !(size > 0.0 && size.is_finite()) {
                return false;
            }
            if best != k {
                for j in k..=right {
                    let (a, z) = (self.get(k, j), self.get(best, j));
                    self.set(k, j, z);
                    self.set(best, j, a);
                }
                b.swap(k, best);
            }
            let pivot = self.get(k, k);
            for i in k + 1..=below {
                let factor = self.get(i, k) / pivot;
                if factor == 0.0 {
                    continue;
                }
                let (Some(from), Some(to)) = (self.place(k, k), self.place(i, k)) else { return false };
                let count = right - k;
                let (upper, lower) = self.rows.split_at_mut(to);
                for (l, u) in lower[1..=count].iter_mut().zip(&upper[from + 1..=from + count]) {
                    *l -= factor * u;
                }
                lower[0] = 0.0;
                b[i] -= factor * b[k];
            }
        }
        for k in (0..n).rev() {
            let right = (k + 2 * half).min(n - 1);
            let mut sum = b[k];
            for j in k + 1..=right {
                sum -= self.get(k, j) * b[j];
            }
            b[k] = sum / self.get(k, k);
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
            let mut band = BandLu::new(n, 3);
            let mut dense = nalgebra::DMatrix::<f64>::zeros(n, n);
            let mut b = vec![0.0; n];
            for i in 0..n {
                for j in i.saturating_sub(3)..(i + 4).min(n) {
                    // Every third diagonal entry is zero: pivoting must be there.
                    let v = if i == j && i % 3 == 0 { 0.0 } else { seed[i * 15 + j] };
                    band.set(i, j, v);
                    dense[(i, j)] = v;
                }
                b[i] = seed[i * 15 + 14];
            }
            let rhs = nalgebra::DVector::from_vec(b.clone());
            let expected = dense.clone().lu().solve(&rhs);
            prop_assume!(expected.is_some() && dense.determinant().abs() > 1e-6);
            prop_assert!(band.solve(&mut b));
            let off = (nalgebra::DVector::from_vec(b) - expected.unwrap_or(rhs)).amax();
            prop_assert!(off < 1e-6, "{off}");
        }
    }
}

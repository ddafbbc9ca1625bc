//! A band matrix stores the entries of a symmetric matrix near its diagonal.

/// A symmetric matrix with entries up to `half_bandwidth` b away from the diagonal. The upper
/// triangle is stored, b + 1 numbers a column with the diagonal last; those above the first row are
/// zeros.
#[derive(Clone, Debug)]
pub struct BandMatrix {
    pub(crate) rows: usize,
    pub(crate) half_bandwidth: usize,
    pub(crate) values: Vec<f64>,
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

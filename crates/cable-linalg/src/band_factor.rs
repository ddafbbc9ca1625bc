//! A band factor factorises a symmetric band matrix and solves with it, again and again in the same
//! memory.

use crate::band_matrix::BandMatrix;
use crate::one_way_elimination::{FactorRows, factor, solve};
use crate::two_way_elimination::{meet_in_the_middle, rows_beside_middle, solve_from_both_ends};
use crate::{BARS_HALF_BANDWIDTH, BENDING_HALF_BANDWIDTH, FactorError, WIDEST_HALF_BANDWIDTH};

/// The factor of a [`BandMatrix`], with everything needed to factorise again and again.
#[derive(Clone, Debug)]
pub struct BandFactor {
    rows: usize,
    half_bandwidth: usize,
    /// Factors by elimination from the first row to the last.
    whole: FactorRows,
    /// Factors by elimination from both ends to the b rows in the middle, which are the last of
    /// each.
    halves: [FactorRows; 2],
    /// L of the rows in the middle, and 1/d on its diagonal.
    middle: [[f64; WIDEST_HALF_BANDWIDTH]; WIDEST_HALF_BANDWIDTH],
    /// True if the last factor is the one from both ends.
    from_both_ends: bool,
}

impl BandFactor {
    /// Makes room for matrices of this size and band.
    ///
    /// # Errors
    /// `TooLarge` when there is no memory for it, or the band is wider than
    /// [`WIDEST_HALF_BANDWIDTH`].
    pub fn new(rows: usize, half_bandwidth: usize) -> Result<Self, FactorError> {
        let too_large = FactorError::TooLarge { rows };
        let b = half_bandwidth.min(rows.saturating_sub(1));
        if b > WIDEST_HALF_BANDWIDTH {
            return Err(too_large);
        }
        let factors = |rows| FactorRows::new(rows, b).ok_or(too_large);
        let [first, second] = rows_beside_middle(rows, b);
        Ok(Self {
            rows,
            half_bandwidth: b,
            whole: factors(rows)?,
            halves: [factors(first + b)?, factors(second + b)?],
            middle: [[0.0; WIDEST_HALF_BANDWIDTH]; WIDEST_HALF_BANDWIDTH],
            from_both_ends: false,
        })
    }

    /// Number of rows it was made for.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Factorises `a`, which must have the rows and band this was made for.
    ///
    /// # Errors
    /// `NotPositive` with the first row whose pivot is not positive. If only the sign was wrong the
    /// factor is still there and [`Self::solve_in_place`] solves with it (a saddle); after a zero
    /// or NaN pivot it is not.
    pub fn factor(&mut self, a: &BandMatrix) -> Result<(), FactorError> {
        debug_assert!(a.rows == self.rows && a.half_bandwidth == self.half_bandwidth);
        self.from_both_ends = false;
        // A half-bandwidth known at compile time lets the loops be unrolled: three times as fast.
        match self.half_bandwidth {
            BARS_HALF_BANDWIDTH => factor(BARS_HALF_BANDWIDTH, &a.values, &mut self.whole),
            BENDING_HALF_BANDWIDTH => factor(BENDING_HALF_BANDWIDTH, &a.values, &mut self.whole),
            b => factor(b, &a.values, &mut self.whole),
        }
    }

    /// Number of negative pivots of the last factorisation: the number of negative eigenvalues of
    /// the matrix (Sylvester).
    #[must_use]
    pub fn negative_pivots(&self) -> usize {
        self.whole.inverse.iter().skip(self.half_bandwidth).filter(|&&d| !(d > 0.0)).count()
    }

    /// Factorises `a` and solves `a x = b`; `b` becomes `x`. The elimination goes from both ends to
    /// the middle, and substitutes on the way: each pivot waits for the one before it, and while
    /// one end waits the processor works at the other (the "burn at both ends" of LINPACK's
    /// tridiagonal solvers: J. Dongarra and others, LINPACK Users' Guide, SIAM 1979, chapter 7).
    ///
    /// # Errors
    /// `NotPositive` with the first row whose pivot was not positive; then neither the factor nor
    /// `b` is of use.
    pub fn factor_and_solve(&mut self, a: &BandMatrix, b: &mut [f64]) -> Result<(), FactorError> {
        debug_assert!(a.rows == self.rows && a.half_bandwidth == self.half_bandwidth && b.len() == self.rows);
        self.from_both_ends = self.rows >= 4 * self.half_bandwidth;
        let (halves, middle) = (&mut self.halves, &mut self.middle);
        match self.half_bandwidth {
            BARS_HALF_BANDWIDTH if self.from_both_ends => {
                meet_in_the_middle::<BARS_HALF_BANDWIDTH>(&a.values, halves, middle, b)
            }
            BENDING_HALF_BANDWIDTH if self.from_both_ends => {
                meet_in_the_middle::<BENDING_HALF_BANDWIDTH>(&a.values, halves, middle, b)
            }
            _ => {
                self.factor(a)?;
                self.solve_in_place(b);
                Ok(())
            }
        }
    }

    /// Solves `A x = b` with the last factorisation; `b` becomes `x`.
    pub fn solve_in_place(&mut self, b: &mut [f64]) {
        let (halves, middle) = (&self.halves, &self.middle);
        match self.half_bandwidth {
            BARS_HALF_BANDWIDTH if self.from_both_ends => {
                solve_from_both_ends::<BARS_HALF_BANDWIDTH>(halves, middle, b);
            }
            BENDING_HALF_BANDWIDTH if self.from_both_ends => {
                solve_from_both_ends::<BENDING_HALF_BANDWIDTH>(halves, middle, b);
            }
            BARS_HALF_BANDWIDTH => solve::<BARS_HALF_BANDWIDTH>(&self.whole, b),
            BENDING_HALF_BANDWIDTH => solve::<BENDING_HALF_BANDWIDTH>(&self.whole, b),
            0 => solve::<0>(&self.whole, b),
            1 => solve::<1>(&self.whole, b),
            2 => solve::<2>(&self.whole, b),
            4 => solve::<4>(&self.whole, b),
            6 => solve::<6>(&self.whole, b),
            7 => solve::<7>(&self.whole, b),
            _ => solve::<WIDEST_HALF_BANDWIDTH>(&self.whole, b),
        }
    }
}

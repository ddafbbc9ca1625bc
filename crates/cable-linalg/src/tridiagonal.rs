//! Small systems with three diagonals are solved by elimination in one function, which shows each
//! pivot to the caller before it is used.

/// A row of a tridiagonal matrix: the entries before, on and after the diagonal.
pub type TridiagonalRow = [f64; 3];

/// Solves a tridiagonal system without exchanges of rows; `right` becomes the solution.
///
/// `judge` sees each pivot and returns the one to divide by. If it returns None, the elimination
/// ends there: then false is returned, and `right` is of no use.
#[must_use]
pub fn solve_tridiagonal(
    rows: &[TridiagonalRow],
    right: &mut [f64],
    mut judge: impl FnMut(f64) -> Option<f64>,
) -> bool {
    debug_assert_eq!(rows.len(), right.len(), "one value a row");
    let mut pivots: Vec<f64> = Vec::with_capacity(rows.len());
    for (k, [lower, diagonal, _]) in rows.iter().enumerate() {
        let mut pivot = *diagonal;
        if k > 0 {
            let factor = lower / pivots[k - 1];
            pivot -= factor * rows[k - 1][2];
            right[k] -= factor * right[k - 1];
        }
        let Some(pivot) = judge(pivot) else { return false };
        pivots.push(pivot);
    }
    for k in (0..rows.len()).rev() {
        let after = if k + 1 < rows.len() { rows[k][2] * right[k + 1] } else { 0.0 };
        right[k] = (right[k] - after) / pivots[k];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::solve_tridiagonal;

    /// Entries that would belong to a column before the first or after the last do not count.
    #[test]
    fn the_solution_satisfies_every_row() {
        let rows = [[9.0, 4.0, -1.0], [2.0, 5.0, 1.5], [-0.5, 3.0, 2.0], [1.0, 6.0, 7.0]];
        let wanted = [1.0, -2.0, 3.0, 0.5];
        let value = |k: Option<usize>| k.and_then(|k| wanted.get(k)).copied().unwrap_or(0.0);
        let product = |k: usize| {
            let [lower, diagonal, upper] = rows[k];
            lower * value(k.checked_sub(1)) + diagonal * value(Some(k)) + upper * value(Some(k + 1))
        };
        let mut right: Vec<f64> = (0..4).map(product).collect();
        assert!(solve_tridiagonal(&rows, &mut right, Some));
        assert!(right.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-14), "{right:?}");
    }

    /// The second pivot of this matrix is 1 − 4.
    #[test]
    fn a_caller_sees_each_pivot_and_may_give_up() {
        let (rows, mut seen) = ([[0.0, 1.0, 2.0], [2.0, 1.0, 0.0]], Vec::new());
        let solved = solve_tridiagonal(&rows, &mut [1.0, 1.0], |pivot| {
            seen.push(pivot);
            (pivot > 0.0).then_some(pivot)
        });
        assert_eq!((solved, seen), (false, vec![1.0, -3.0]));
    }
}

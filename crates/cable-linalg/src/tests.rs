//! These tests compare the solvers with dense ones, on random matrices.

use super::*;
use proptest::prelude::*;

/// A random symmetric band matrix with `shift` on the diagonal.
fn matrix(rows: usize, half_bandwidth: usize, numbers: &[f64], shift: f64) -> BandMatrix {
    let mut a = BandMatrix::new(rows, half_bandwidth);
    let mut next = numbers.iter().copied().cycle();
    for j in 0..rows {
        for i in j.saturating_sub(half_bandwidth)..=j {
            a.add(i, j, next.next().unwrap_or(0.0));
        }
        a.add(j, j, shift);
    }
    a
}

proptest! {
    #[test]
    fn solves_what_it_multiplies(
        rows in 1usize..30, band in 0usize..6, numbers in prop::collection::vec(-1.0..1.0f64, 37),
    ) {
        let a = matrix(rows, band, &numbers, 2.0 * band as f64 + 3.0);
        let x: Vec<f64> = (0..rows).map(|i| numbers[i % 37]).collect();
        let mut b = vec![0.0; rows];
        a.multiply(&x, &mut b);
        let mut factor = BandFactor::new(rows, band).unwrap();
        for _ in 0..2 {
            factor.factor(&a).unwrap();
            let mut y = b.clone();
            factor.solve_in_place(&mut y);
            for (x, y) in x.iter().zip(&y) {
                prop_assert!((x - y).abs() < 1e-12);
            }
            let mut at_once = b.clone();
            factor.factor_and_solve(&a, &mut at_once).unwrap();
            let mut again = b.clone();
            factor.solve_in_place(&mut again);
            for ((x, y), z) in x.iter().zip(&at_once).zip(&again) {
                prop_assert!((x - y).abs() < 1e-12 && (x - z).abs() < 1e-12, "{} {} {}", x, y, z);
            }
        }
    }

    /// faer's sparse Cholesky is the reference.
    #[test]
    fn solves_as_faer_does(
        rows in 1usize..60, band in 0usize..7, numbers in prop::collection::vec(-1.0..1.0f64, 37), shift in 0.0..8.0f64,
    ) {
        let a = matrix(rows, band, &numbers, shift);
        let mut expected: Vec<f64> = (0..rows).map(|i| numbers[(5 * i) % 37]).collect();
        let mut x = expected.clone();
        let mut factor = BandFactor::new(rows, band).unwrap();
        let definite = factor.factor(&a).is_ok();
        prop_assert_eq!(definite, solve_coupled(&a, &[], &mut expected).is_ok());
        let mut at_once = x.clone();
        prop_assert_eq!(definite, factor.factor_and_solve(&a, &mut at_once).is_ok());
        if definite {
            factor.factor(&a).unwrap();
            factor.solve_in_place(&mut x);
            let size = expected.iter().fold(1.0, |m: f64, e| m.max(e.abs()));
            for ((x, y), e) in x.iter().zip(&at_once).zip(&expected) {
                prop_assert!((x - e).abs() < 1e-9 * size * size, "{} {}", x, e);
                prop_assert!((y - e).abs() < 1e-9 * size * size, "{} {}", y, e);
            }
        }
    }

    #[test]
    fn counts_negative_eigenvalues(numbers in prop::collection::vec(-1.0..1.0f64, 37), shift in -3.0..3.0f64) {
        let a = matrix(9, 3, &numbers, shift);
        let dense = nalgebra::DMatrix::from_fn(9, 9, |i, j| if i.abs_diff(j) <= 3 { a.get(i, j) } else { 0.0 });
        let eigenvalues = dense.symmetric_eigen().eigenvalues;
        prop_assume!(eigenvalues.iter().all(|e| e.abs() > 1e-6));
        let mut factor = BandFactor::new(9, 3).unwrap();
        let definite = factor.factor(&a).is_ok();
        prop_assert_eq!(definite, eigenvalues.iter().all(|&e| e > 0.0));
        prop_assert_eq!(factor.negative_pivots(), eigenvalues.iter().filter(|&&e| e < 0.0).count());
    }
}

#[test]
fn a_block_is_its_entries() {
    let block = [[1.0, 2.0], [3.0, 4.0]];
    for (i, j) in [(0, 0), (0, 2), (2, 2), (2, 4), (6, 6), (4, 6)] {
        let (mut a, mut b) = (BandMatrix::new(8, 3), BandMatrix::new(8, 3));
        a.add_block(i, j, block);
        for (r, c) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().filter(|&(r, c)| i < j || r <= c) {
            b.add(i + r, j + c, block[r][c]);
        }
        assert_eq!(a.values, b.values, "{i}, {j}");
    }
}

#[test]
fn a_spring_is_its_blocks() {
    let [xx, xy, yy] = [2.0, 0.3, 5.0];
    for band in [3, 5] {
        for i in [0, 2, 4] {
            let (mut a, mut b) = (BandMatrix::new(8, band), BandMatrix::new(8, band));
            a.add_spring(i, [xx, xy, yy]);
            a.add_diagonal(i, 0.25);
            b.add(i, i, 0.25);
            b.add(i + 1, i + 1, 0.25);
            b.add_block(i, i, [[xx, xy], [xy, yy]]);
            b.add_block(i + 2, i + 2, [[xx, xy], [xy, yy]]);
            b.add_block(i, i + 2, [[-xx, -xy], [-xy, -yy]]);
            assert_eq!(a.values, b.values, "{band}, {i}");
        }
    }
}

#[test]
fn names_the_row_of_the_first_bad_pivot() {
    let mut a = BandMatrix::new(6, 3);
    for i in 0..6 {
        a.add(i, i, if i == 4 { -2.0 } else { 1.0 });
    }
    let mut factor = BandFactor::new(6, 3).unwrap();
    assert_eq!(factor.factor(&a), Err(FactorError::NotPositive { row: 4, pivot: -2.0 }));
    a.add(2, 3, f64::NAN);
    assert!(matches!(factor.factor(&a), Err(FactorError::NotPositive { row: 3, .. })));
}

#[test]
fn a_pinned_unknown_keeps_its_right_hand_side() {
    let mut a = matrix(8, 3, &[0.3, -0.2, 0.5], 6.0);
    a.pin(5);
    let mut factor = BandFactor::new(8, 3).unwrap();
    factor.factor(&a).unwrap();
    let mut b = vec![1.0; 8];
    b[5] = 0.25;
    factor.solve_in_place(&mut b);
    assert_eq!(b[5], 0.25);
}

//! The energies of a cable's nodes are given as value (J), gradient (N) and Hessian (N/m).
//!
//! | room | content |
//! |---|---|
//! | `axial.rs` | pull of a straight bar; its energy in `axial_tests.rs` |
//! | `bending.rs` | turn between two bars or out of a clamp: energy, gradient, Hessian |
//!
//! Every energy is a function of the positions of `N` neighbouring nodes. The force on a node is
//! minus the gradient. Each comes with its derivation above the code and finite-difference tests on
//! random and degenerate input.

pub mod axial;
#[cfg(test)]
mod axial_tests;
pub mod bending;

use crate::math::{Mat2, Vec2};

/// Treatment of the Hessian's indefinite part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curvature {
    /// As it is: needed to judge stability and for quadratic convergence.
    Exact,
    /// Clipped so that the element's Hessian has no negative eigenvalue: a Newton step then
    /// descends.
    Clipped,
}

/// The Hessian of an energy of `N` nodes: blocks `[i][j]` = ∂²E/∂xᵢ∂xⱼ, N/m.
pub type Blocks<const N: usize> = [[Mat2; N]; N];

/// An energy of `N` neighbouring nodes.
pub trait ElementEnergy<const N: usize> {
    /// Energy, J. Positions in m.
    fn value(&self, x: &[Vec2; N]) -> f64;

    /// ∂E/∂xᵢ, N.
    fn gradient(&self, x: &[Vec2; N]) -> [Vec2; N];

    /// ∂²E/∂xᵢ∂xⱼ, N/m.
    fn hessian(&self, x: &[Vec2; N], curvature: Curvature) -> Blocks<N>;
}

#[cfg(test)]
pub(crate) mod check {
    //! Central differences against gradient and Hessian.

    use super::*;

    /// Asserts both derivatives at `x`, relative to the given force scale (N) and length scale (m).
    pub fn derivatives<const N: usize>(energy: &impl ElementEnergy<N>, x: &[Vec2; N], force: f64, length: f64) {
        let h = 1e-6 * length;
        let (gradient, hessian) = (energy.gradient(x), energy.hessian(x, Curvature::Exact));
        for i in 0..N {
            for c in 0..2 {
                let (mut plus, mut minus) = (*x, *x);
                plus[i][c] += h;
                minus[i][c] -= h;
                let slope = (energy.value(&plus) - energy.value(&minus)) / (2.0 * h);
                assert!(
                    (slope - gradient[i][c]).abs() < 1e-6 * force,
                    "∂E/∂x[{i}][{c}]: {slope} by differences, {} by formula",
                    gradient[i][c]
                );
                let (gp, gm) = (energy.gradient(&plus), energy.gradient(&minus));
                for j in 0..N {
                    for d in 0..2 {
                        let bend = (gp[j][d] - gm[j][d]) / (2.0 * h);
                        let formula = hessian[j][i][(d, c)];
                        assert!(
                            (bend - formula).abs() < 1e-5 * force / length,
                            "∂²E/∂x[{j}][{d}]∂x[{i}][{c}]: {bend} by differences, {formula} by formula"
                        );
                    }
                }
            }
        }
    }

    /// The smallest eigenvalue of the whole Hessian, N/m.
    pub(crate) fn smallest_eigenvalue<const N: usize>(blocks: &Blocks<N>) -> f64 {
        let dense = nalgebra::DMatrix::from_fn(2 * N, 2 * N, |i, j| blocks[i / 2][j / 2][(i % 2, j % 2)]);
        dense.symmetric_eigen().eigenvalues.min()
    }
}

//! The axial energy is that of stretching a straight bar. Tests alone assemble it: the solvers have
//! energies of bars that only pull.
//!
//! A bar of unstretched length `l₀` and stiffness EA between `x₀` and `x₁`, with d = x₁ − x₀,
//! l = |d|, t = d/l:
//! ```text
//! E      = EA (l − l₀)² / 2 l₀
//! T      = EA (l/l₀ − 1)                       tension
//! ∂E/∂d  = T t
//! ∂²E/∂d² = (EA/l₀) t tᵀ + (T/l)(I − t tᵀ)     material + geometric stiffness
//! ```
//! A bar in compression has a negative geometric stiffness, which buckles it sideways. A cable has
//! none: [`Curvature::Clipped`] sets it to zero there (reducing it is not enough, the tangent stays
//! indefinite).

use proptest::prelude::*;

use super::axial::Bar;
use super::{Blocks, Curvature, ElementEnergy, check};
use crate::math::{Mat2, Vec2};

impl Bar {
    /// ∂²E/∂d² for the vector `d` from the first node to the second, N/m.
    #[must_use]
    pub(crate) fn stiffness_block(&self, d: Vec2, curvature: Curvature) -> Mat2 {
        let length = d.norm();
        if !(length > 0.0) {
            // With both nodes in one place the bar has no direction. The material part is averaged
            // over all directions.
            return Mat2::identity() * (0.5 * self.stiffness / self.rest_length);
        }
        let t = d / length;
        let along = t * t.transpose();
        let mut geometric = self.tension(length) / length;
        if curvature == Curvature::Clipped && geometric < 0.0 {
            geometric = 0.0;
        }
        along * (self.stiffness / self.rest_length) + (Mat2::identity() - along) * geometric
    }
}

impl ElementEnergy<2> for Bar {
    fn value(&self, x: &[Vec2; 2]) -> f64 {
        let stretch = (x[1] - x[0]).norm() - self.rest_length;
        0.5 * self.stiffness * stretch * stretch / self.rest_length
    }

    fn gradient(&self, x: &[Vec2; 2]) -> [Vec2; 2] {
        let d = x[1] - x[0];
        let length = d.norm();
        // Nodes in one place exert no force, which is the mean over all directions.
        let force = if length > 0.0 { d * (self.tension(length) / length) } else { d };
        [-force, force]
    }

    fn hessian(&self, x: &[Vec2; 2], curvature: Curvature) -> Blocks<2> {
        let k = self.stiffness_block(x[1] - x[0], curvature);
        [[k, -k], [-k, k]]
    }
}

proptest! {
    #[test]
    fn derivatives_match_differences(
        angle in -3.2..3.2f64, stretch in 0.5..2.0f64, log_stiffness in 0.0..9.0f64, x in -5.0..5.0f64,
    ) {
        let bar = Bar { rest_length: 0.7, stiffness: 10f64.powf(log_stiffness) };
        let a = Vec2::new(x, 1.0);
        let b = a + Vec2::new(angle.cos(), angle.sin()) * (0.7 * stretch);
        check::derivatives(&bar, &[a, b], bar.stiffness, 0.7);
    }

    #[test]
    fn clipped_is_never_indefinite(angle in -3.2..3.2f64, stretch in 0.01..2.0f64) {
        let bar = Bar { rest_length: 1.0, stiffness: 1e6 };
        let x = [Vec2::zeros(), Vec2::new(angle.cos(), angle.sin()) * stretch];
        let clipped = check::smallest_eigenvalue(&bar.hessian(&x, Curvature::Clipped));
        prop_assert!(clipped > -1e-6 * bar.stiffness);
        if stretch < 0.99 {
            prop_assert!(check::smallest_eigenvalue(&bar.hessian(&x, Curvature::Exact)) < 0.0);
        }
    }
}

#[test]
fn nodes_in_one_place_give_finite_numbers() {
    let bar = Bar { rest_length: 1.0, stiffness: 1e3 };
    let x = [Vec2::new(2.0, 3.0); 2];
    assert_eq!(bar.gradient(&x), [Vec2::zeros(); 2]);
    assert!(bar.hessian(&x, Curvature::Exact).iter().flatten().all(|b| b.iter().all(|v| v.is_finite())));
}

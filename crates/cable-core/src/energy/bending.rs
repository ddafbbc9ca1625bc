//! The bending energy depends on the angle between two bars, or between a clamp and a bar.
//!
//! The turn at a node between the vectors `a` (into it) and `b` (out of it) is ψ = angle(b) −
//! angle(a). With the length l̄ that belongs to the node the curvature is κ = ψ/l̄
//! (d(angle)/d(unstretched length)), the moment EI κ:
//! ```text
//! E = EI ψ² / 2 l̄,       ∇E = (EI/l̄) ψ ∇ψ,       ∇²E = (EI/l̄)(∇ψ ∇ψᵀ + ψ ∇²ψ)
//! angle(v) = atan2(v_y, v_x):   ∇ = (−v_y, v_x)/v²,
//!                               ∇² = [[2 v_x v_y, v_y² − v_x²], [v_y² − v_x², −2 v_x v_y]] / v⁴
//! ```
//! Inside the cable l̄ is half the sum of both rest lengths. At a clamp the angle of the clamp
//! takes the place of angle(a), and the bent length is from the clamp to the middle of the first
//! bar: **l̄ = l₀/2**. With l₀ instead the clamp would stand half a bar away, an error of 1 % of
//! the clamp moment on a usual mesh. [`Curvature::Clipped`] leaves the term with ψ out.

use super::{Blocks, Curvature, ElementEnergy};
use crate::math::{Mat2, Vec2, cross};

/// The bend at a node between two bars.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendingEnergy {
    /// EI, N·m².
    pub stiffness: f64,
    /// Half the sum of both bars' rest lengths, m.
    pub length: f64,
    /// Reference turn, rad: 0 for the elastic energy, and for a loss the turn at which it has no
    /// moment.
    pub from: f64,
}

/// The bend between a clamp and the bar that leaves it (or arrives at it).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClampBend {
    /// EI, N·m².
    pub stiffness: f64,
    /// Half the bar's rest length, m.
    pub length: f64,
    /// Unit vector of the clamp, pointing to growing arc length.
    pub direction: Vec2,
    /// Reference turn, rad.
    pub from: f64,
}

/// The angle from `a` to `b`, rad in (−π, π]; 0 if one of them is zero.
#[must_use]
pub fn turn(a: Vec2, b: Vec2) -> f64 {
    cross(a, b).atan2(a.dot(&b))
}

/// ∇ angle(v), 1/m; 0 for the zero vector.
pub(crate) fn angle_gradient(v: Vec2) -> Vec2 {
    let square = v.norm_squared();
    if square > 0.0 { Vec2::new(-v.y, v.x) / square } else { Vec2::zeros() }
}

/// ∇² angle(v), 1/m²; 0 for the zero vector.
fn angle_hessian(v: Vec2) -> Mat2 {
    let square = v.norm_squared();
    if !(square > 0.0) {
        return Mat2::zeros();
    }
    let (mixed, twice) = (v.y * v.y - v.x * v.x, 2.0 * v.x * v.y);
    Mat2::new(twice, mixed, mixed, -twice) / (square * square)
}

impl ElementEnergy<3> for BendingEnergy {
    fn value(&self, x: &[Vec2; 3]) -> f64 {
        let psi = turn(x[1] - x[0], x[2] - x[1]) - self.from;
        0.5 * self.stiffness * psi * psi / self.length
    }

    fn gradient(&self, x: &[Vec2; 3]) -> [Vec2; 3] {
        let (a, b) = (x[1] - x[0], x[2] - x[1]);
        let moment = self.stiffness * (turn(a, b) - self.from) / self.length;
        turn_gradient(a, b).map(|g| g * moment)
    }

    fn hessian(&self, x: &[Vec2; 3], curvature: Curvature) -> Blocks<3> {
        let (a, b) = (x[1] - x[0], x[2] - x[1]);
        let c = self.stiffness / self.length;
        let g = turn_gradient(a, b);
        let mut blocks = [[Mat2::zeros(); 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                blocks[i][j] = g[i] * g[j].transpose() * c;
            }
        }
        if curvature == Curvature::Exact {
            let moment = c * (turn(a, b) - self.from);
            let (ha, hb) = (angle_hessian(a) * moment, angle_hessian(b) * moment);
            // ψ = angle(x₂ − x₁) − angle(x₁ − x₀)
            blocks[0][0] -= ha;
            blocks[0][1] += ha;
            blocks[1][0] += ha;
            blocks[1][1] += hb - ha;
            blocks[1][2] -= hb;
            blocks[2][1] -= hb;
            blocks[2][2] += hb;
        }
        blocks
    }
}

/// ∂ψ/∂xᵢ of the turn between `a` = x₁ − x₀ and `b` = x₂ − x₁.
pub(crate) fn turn_gradient(a: Vec2, b: Vec2) -> [Vec2; 3] {
    let (ga, gb) = (angle_gradient(a), angle_gradient(b));
    [ga, -ga - gb, gb]
}

impl ElementEnergy<2> for ClampBend {
    fn value(&self, x: &[Vec2; 2]) -> f64 {
        let psi = turn(self.direction, x[1] - x[0]) - self.from;
        0.5 * self.stiffness * psi * psi / self.length
    }

    fn gradient(&self, x: &[Vec2; 2]) -> [Vec2; 2] {
        let d = x[1] - x[0];
        let g = angle_gradient(d) * (self.stiffness * (turn(self.direction, d) - self.from) / self.length);
        [-g, g]
    }

    fn hessian(&self, x: &[Vec2; 2], curvature: Curvature) -> Blocks<2> {
        let d = x[1] - x[0];
        let (c, g) = (self.stiffness / self.length, angle_gradient(d));
        let mut k = g * g.transpose() * c;
        if curvature == Curvature::Exact {
            k += angle_hessian(d) * (c * (turn(self.direction, d) - self.from));
        }
        [[k, -k], [-k, k]]
    }
}

#[cfg(test)]
mod tests {
    use super::super::check;
    use super::*;
    use proptest::prelude::*;

    fn polar(length: f64, angle: f64) -> Vec2 {
        Vec2::new(angle.cos(), angle.sin()) * length
    }

    proptest! {
        #[test]
        fn bend_derivatives_match_differences(
            first in -3.1..3.1f64, psi in -2.9..2.9f64, l1 in 0.2..2.0f64, l2 in 0.2..2.0f64,
        ) {
            let bend = BendingEnergy { stiffness: 5.0, length: 0.5, from: 0.1 };
            let x0 = Vec2::new(1.0, -2.0);
            let x1 = x0 + polar(l1, first);
            check::derivatives(&bend, &[x0, x1, x1 + polar(l2, first + psi)], 500.0, 1.0);
        }

        #[test]
        fn clamp_derivatives_match_differences(clamp in -3.1..3.1f64, psi in -2.9..2.9f64, l in 0.2..2.0f64) {
            let bend = ClampBend { stiffness: 5.0, length: 0.25, direction: polar(1.0, clamp), from: 0.1 };
            let x0 = Vec2::new(0.3, 0.4);
            check::derivatives(&bend, &[x0, x0 + polar(l, clamp + psi)], 500.0, 1.0);
        }

        #[test]
        fn clipped_is_never_indefinite(psi in -3.0..3.0f64) {
            let bend = BendingEnergy { stiffness: 5.0, length: 1.0, from: 0.0 };
            let x = [Vec2::zeros(), Vec2::new(1.0, 0.0), Vec2::new(1.0, 0.0) + polar(1.0, psi)];
            prop_assert!(check::smallest_eigenvalue(&bend.hessian(&x, Curvature::Clipped)) > -1e-9);
        }
    }

    #[test]
    fn a_circle_of_bars_has_its_curvature() {
        // n bars inscribed in a circle of radius R: Σ E = EI/2 · (2π/n)²/l · n with l = 2R
        // sin(π/n).
        let (radius, n) = (0.5, 64);
        let points: Vec<Vec2> =
            (0..n + 2).map(|k| polar(radius, std::f64::consts::TAU * f64::from(k) / f64::from(n))).collect();
        let length = (points[1] - points[0]).norm();
        let bend = BendingEnergy { stiffness: 2.0, length, from: 0.0 };
        let energy: f64 = (0..n as usize).map(|k| bend.value(&[points[k], points[k + 1], points[k + 2]])).sum();
        let exact = 0.5 * 2.0 * std::f64::consts::TAU / radius;
        assert!((energy / exact - 1.0).abs() < 5e-4, "{energy} against {exact}");
    }

    #[test]
    fn nodes_in_one_place_give_finite_numbers() {
        let bend = BendingEnergy { stiffness: 1.0, length: 1.0, from: 0.0 };
        let x = [Vec2::zeros(), Vec2::zeros(), Vec2::new(1.0, 0.0)];
        assert!(bend.gradient(&x).iter().all(|g| g.iter().all(|v| v.is_finite())));
        assert!(bend.hessian(&x, Curvature::Exact).iter().flatten().all(|b| b.iter().all(|v| v.is_finite())));
    }
}

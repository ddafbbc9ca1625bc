//! The corrected bar is one element of a free cable; it gives the chord as a function of the force.
//!
//! The body force q (N per metre of arc length, any direction) acts between two nodes, so the
//! tension force varies as F(s) = F − q s about the middle. A perfectly flexible cable has its
//! direction:
//! ```text
//! chord = ∂Ψ/∂F,   Ψ(F) = ∫ θ (|F(s)| + |F(s)|²/2EA) ds       (complementary energy, convex)
//! ```
//! A straight bar takes |F(s)| at the middle, and its chord is 2nd order. The *corrected* bar takes
//! the two Gauss points s = ±Δs/(2√3):
//! ```text
//! g = q Δs/(2√3),   l₀ = θ Δs,   u(F) = F/|F|
//! chord = l₀/2 [u(F+g) + u(F−g)] + (l₀/EA) F
//! ∂chord/∂F = l₀/2 Σ (I − u uᵀ)/|F±g| + (l₀/EA) I
//! ```
//! Expanded in Δs its first term is the shift −(l₀³/24T²)[q_n² t + 2 q_t q_n n] of the straight
//! chord, so it is 4th order at the cost of two square roots. Unlike that shift it stays bounded as
//! T → 0: the chord of a slack element is never longer than its material, at any mesh.
//!
//! The whole of Ψ is the dual of the cable's potential energy (M. Irvine, *Cable Structures*, MIT
//! Press 1981, for the exact chord below).

use crate::math::{GAUSS_2_HALF_DISTANCE, Mat2, Vec2, cross};

/// Ratio of an element's load to the tensions at its ends below which artanh r / r is its series to
/// the second order: the next term is 2e-13. Smaller: the quotient loses digits; larger: so does
/// the series.
const MAX_SERIES_RATIO: f64 = 1e-3;
/// Greatest such ratio, one rounding below 1, where artanh is infinite. Smaller: vertical elements
/// are too short; larger: infinity.
const MAX_LOAD_RATIO: f64 = 1.0 - 1e-15;

/// The values that all elements of a cable share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// EA, N.
    pub axial_stiffness: f64,
    /// Length factor by temperature, 1 + αΔT.
    pub thermal_stretch: f64,
    /// Weight and wind, N per metre of arc length.
    pub body: Vec2,
    /// Tension below which directions are smoothed, N. Larger: sharp bends become round; 0: a fold
    /// of the cable in one Gauss point divides by zero.
    pub smoothing: f64,
}

/// Chord, compliance and energy of an element under a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementResponse {
    /// From the first node to the second, m.
    pub chord: Vec2,
    /// ∂chord/∂F, m/N.
    pub compliance: Mat2,
    /// Ψ, J.
    pub energy: f64,
}

impl Material {
    /// |F| and u = F/|F|, smoothed.
    fn direction(&self, force: Vec2) -> (f64, Vec2) {
        let size = (force.norm_squared() + self.smoothing * self.smoothing).sqrt();
        (size, force / size)
    }

    /// Chord (m), compliance and energy of `ds` metres of cable whose middle carries the tension
    /// force `force` (N).
    #[must_use]
    pub fn respond(&self, ds: f64, force: Vec2) -> ElementResponse {
        let rest = self.thermal_stretch * ds;
        let g = self.body * (GAUSS_2_HALF_DISTANCE * ds);
        let ((t1, u1), (t2, u2)) = (self.direction(force + g), self.direction(force - g));
        let (half, elastic) = (0.5 * rest, rest / self.axial_stiffness);
        let (c1, c2) = (half / t1, half / t2);
        // I − u uᵀ, written out: this is the innermost loop.
        let xx = c1 * (1.0 - u1.x * u1.x) + c2 * (1.0 - u2.x * u2.x) + elastic;
        let yy = c1 * (1.0 - u1.y * u1.y) + c2 * (1.0 - u2.y * u2.y) + elastic;
        let xy = -c1 * u1.x * u1.y - c2 * u2.x * u2.y;
        ElementResponse {
            chord: (u1 + u2) * half + force * elastic,
            compliance: Mat2::new(xx, xy, xy, yy),
            energy: half * (t1 + t2) + 0.5 * elastic * force.norm_squared(),
        }
    }

    /// ∂chord/∂(ds), m/m, at a constant tension force in the middle (N).
    #[must_use]
    pub fn chord_rate(&self, ds: f64, force: Vec2) -> Vec2 {
        let g = self.body * GAUSS_2_HALF_DISTANCE;
        let half = 0.5 * self.thermal_stretch;
        let side = |sign: f64| {
            let (t, u) = self.direction(force + g * (sign * ds));
            u + (g - u * u.dot(&g)) * (sign * ds / t)
        };
        (side(1.0) + side(-1.0)) * half + force * (self.thermal_stretch / self.axial_stiffness)
    }

    /// Difference of the chord from that of the exact elastic catenary, m: the element's local
    /// error. With e = −q/|q|, H = F across e, V = F along e and both ends a, b:
    /// ```text
    /// across: (H/|q|)(asinh(V_b/H) − asinh(V_a/H)) = H Δs · 2/(T_a + T_b) · atanh(r)/r,   r = |q| Δs/(T_a + T_b)
    /// along:  (T_b − T_a)/|q|                      = Δs (V_a + V_b)/(T_a + T_b)
    /// ```
    #[must_use]
    pub fn chord_error(&self, ds: f64, force: Vec2) -> Vec2 {
        let q = self.body.norm();
        let (rest, elastic) = (self.thermal_stretch * ds, force * (self.thermal_stretch * ds / self.axial_stiffness));
        let ends = (force + self.body * (0.5 * ds)).norm() + (force - self.body * (0.5 * ds)).norm();
        if !(q > 0.0 && ends > 0.0) {
            return Vec2::zeros();
        }
        let (up, ratio) = (-self.body / q, q * ds / ends);
        let across = Vec2::new(up.y, -up.x);
        let (h, v) = (force.dot(&across), force.dot(&up));
        // For a vertical element r is 1 and H = 0, and their product 0·∞ is avoided.
        let stretch = if ratio < MAX_SERIES_RATIO {
            1.0 + ratio * ratio / 3.0
        } else {
            ratio.min(MAX_LOAD_RATIO).atanh() / ratio
        };
        let exact = (across * (h * 2.0 * stretch) + up * (2.0 * v)) * (rest / ends) + elastic;
        exact - self.respond(ds, force).chord
    }
}

/// The angle from one tension force to another, rad, and how it changes with each: ∂φ/∂F =
/// perp(F)/|F|².
#[must_use]
pub fn turn_between(before: Vec2, after: Vec2) -> f64 {
    cross(before, after).atan2(before.dot(&after))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn material() -> Material {
        Material { axial_stiffness: 1e5, thermal_stretch: 1.001, body: Vec2::new(3.0, -9.0), smoothing: 1e-8 }
    }

    proptest! {
        #[test]
        fn derivatives_match_differences(fx in -50.0..50.0f64, fy in -50.0..50.0f64, ds in 0.1..2.0f64) {
            let (m, f, h) = (material(), Vec2::new(fx, fy), 1e-5);
            prop_assume!(f.norm() > 12.0);
            let at = m.respond(ds, f);
            for c in 0..2 {
                let mut e = Vec2::zeros();
                e[c] = h;
                let (plus, minus) = (m.respond(ds, f + e), m.respond(ds, f - e));
                prop_assert!(((plus.energy - minus.energy) / (2.0 * h) - at.chord[c]).abs() < 1e-6);
                let slope = (plus.chord - minus.chord) / (2.0 * h);
                prop_assert!((slope - at.compliance.column(c)).norm() < 1e-6);
            }
            let slope = (m.respond(ds + h, f).chord - m.respond(ds - h, f).chord) / (2.0 * h);
            prop_assert!((slope - m.chord_rate(ds, f)).norm() < 1e-6);
        }

        #[test]
        fn first_term_of_the_correction_is_the_known_shift(angle in -3.1..3.1f64) {
            let m = Material { smoothing: 0.0, ..material() };
            let (tension, ds) = (100.0, 0.05);
            let t = Vec2::new(angle.cos(), angle.sin());
            let n = Vec2::new(-t.y, t.x);
            let (qt, qn) = (m.body.dot(&t), m.body.dot(&n));
            let rest = m.thermal_stretch * ds;
            let shift = (t * (qn * qn) + n * (2.0 * qt * qn)) * (-ds * ds * rest / (24.0 * tension * tension));
            let straight = t * (rest * (1.0 + tension / m.axial_stiffness));
            let found = m.respond(ds, t * tension).chord - straight;
            prop_assert!((found - shift).norm() < 1e-4 * shift.norm() + 1e-16, "{found} {shift}");
        }
    }

    #[test]
    fn local_error_is_of_fifth_order() {
        let m = Material { smoothing: 0.0, ..material() };
        let f = Vec2::new(10.0, 4.0);
        let errors: Vec<f64> = [0.4, 0.2, 0.1].iter().map(|&ds| m.chord_error(ds, f).norm()).collect();
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((4.8..5.2).contains(&order), "{errors:?}");
        }
    }

    #[test]
    fn a_slack_element_is_never_longer_than_its_material() {
        let m = material();
        for f in [Vec2::zeros(), Vec2::new(1e-9, 0.0), Vec2::new(0.0, 1e-3)] {
            let r = m.respond(1.0, f);
            assert!(r.chord.norm() <= 1.0011 && r.compliance.iter().all(|c| c.is_finite()));
        }
    }
}

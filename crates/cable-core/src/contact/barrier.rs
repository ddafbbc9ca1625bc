//! A logarithmic barrier keeps gaps open.
//!
//! With u = g/d̂, for 0 < u < 1 (Li, Ferguson, Schneider et al., "Incremental Potential Contact",
//! ACM TOG 2020; here made dimensionless, so that the stiffness κ is a force):
//! ```text
//! B(g)  = κ d̂ φ(u),     φ(u)  = −(u − 1)² ln u
//! B'(g) = κ φ'(u),      φ'(u) = −2(u − 1) ln u − (u − 1)²/u           ≤ 0, −B' is the normal force
//! B''   = κ/d̂ φ''(u),   φ''(u) = −2 ln u − 4(u − 1)/u + (u − 1)²/u²    ≥ 0
//! ```
//! φ, φ' and φ'' are 0 at u = 1: the barrier is C². It is infinite at u = 0.

/// The logarithmic barrier, with its reach and its force scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrier {
    /// Gap at which contact begins (d̂), m.
    pub reach: f64,
    /// Force scale κ, N. The gap of a node at rest under weight κ/20 is 0.88 d̂.
    pub stiffness: f64,
}

/// The value of a barrier and its first and second derivative with respect to the gap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BarrierAt {
    /// Energy, J; infinite for a gap ≤ 0.
    pub value: f64,
    /// dB/dg, N; minus the normal force.
    pub slope: f64,
    /// d²B/dg², N/m.
    pub curvature: f64,
}

impl Barrier {
    /// The barrier at a gap (m).
    #[inline]
    #[must_use]
    pub fn at(&self, gap: f64) -> BarrierAt {
        let u = gap / self.reach;
        if u >= 1.0 {
            return BarrierAt::default();
        }
        if u <= 0.0 {
            return BarrierAt { value: f64::INFINITY, slope: f64::NEG_INFINITY, curvature: f64::INFINITY };
        }
        let (d, ln) = (u - 1.0, u.ln());
        BarrierAt {
            value: -self.stiffness * self.reach * d * d * ln,
            slope: self.stiffness * (-2.0 * d * ln - d * d / u),
            curvature: self.stiffness / self.reach * (-2.0 * ln - 4.0 * d / u + d * d / (u * u)),
        }
    }

    /// Returns by how much the normal force decreases (N) if a gap (m) widens by `by` (m). The
    /// curvature times `by` overestimates it, as the barrier is convex, and many times over where
    /// the gap is less than `by`.
    #[must_use]
    pub(crate) fn relief(&self, gap: f64, by: f64) -> f64 {
        let closed = self.at(gap).slope;
        if closed.is_finite() { self.at(gap + by).slope - closed } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_below_its_rounding_relieves_no_more_than_its_force() {
        let barrier = Barrier { reach: 1e-4, stiffness: 24.0 };
        let by = 7e-15;
        for gap in [1e-15, 1e-14, 1e-12, 1e-9, 1e-6, 5e-5] {
            let b = barrier.at(gap);
            let relief = barrier.relief(gap, by);
            assert!(
                relief >= 0.0 && relief < -b.slope && relief <= b.curvature * by * (1.0 + 1e-6),
                "{gap} m: {relief} N"
            );
            if gap > 1e4 * by {
                assert!((relief / (b.curvature * by) - 1.0).abs() < 0.05, "{gap} m: {relief} N");
            }
        }
    }

    #[test]
    fn derivatives_match_differences() {
        let barrier = Barrier { reach: 1e-3, stiffness: 7.0 };
        for k in 1..100 {
            let g = 1e-5 * f64::from(k);
            let h = 1e-5 * g;
            let (p, m, c) = (barrier.at(g + h), barrier.at(g - h), barrier.at(g));
            assert!(((p.value - m.value) / (2.0 * h) - c.slope).abs() < 1e-6 * (c.slope.abs() + 1e-3));
            assert!(((p.slope - m.slope) / (2.0 * h) - c.curvature).abs() < 1e-6 * (c.curvature + 1.0));
            assert!(c.value > 0.0 && c.slope < 0.0 && c.curvature > 0.0);
        }
    }

    #[test]
    fn it_ends_smoothly_and_never_lets_through() {
        let barrier = Barrier { reach: 1e-3, stiffness: 7.0 };
        let near = barrier.at(1e-3 * (1.0 - 1e-9));
        assert!(near.slope.abs() < 1e-15 * 7.0 * 1e3 && near.curvature.abs() < 1e-4);
        assert_eq!(barrier.at(1e-3), BarrierAt::default());
        assert_eq!(barrier.at(0.0).value, f64::INFINITY);
        assert_eq!(barrier.at(-1.0).value, f64::INFINITY);
        assert!(barrier.at(f64::NAN).value.is_nan());
    }

    #[test]
    fn a_node_rests_inside_the_barrier() {
        let barrier = Barrier { reach: 1.0, stiffness: 20.0 };
        assert!(barrier.at(0.88).slope > -1.0 && barrier.at(0.86).slope < -1.0);
    }
}

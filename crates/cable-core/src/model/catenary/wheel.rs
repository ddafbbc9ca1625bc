//! This module integrates the tension round a wheel, and the material on it.
//!
//! The centre line runs on a circle of radius R, ψ the angle turned since it arrived, t its
//! direction, n the outward normal, b the load per unstretched metre, λ = (1 + αΔT)(1 + T/EA) the
//! stretch, ds/dψ = R/λ. Balance along n gives the normal force per unstretched metre N = T dψ/ds −
//! b·n, balance along t
//!
//! ```text
//! dT/dψ = −(R/λ) b·t + m (T − (R/λ) b·n),      −μ ≤ m ≤ μ
//! ```
//!
//! with m the mobilised friction: 0 on a frictionless wheel, ±μ if all of the arc slides. For a
//! sticking wheel one m along the whole arc is assumed. That is exact at both ends of the range and
//! for points; in between it misplaces material by at most (ΔT/EA)·(arc length), because the
//! distribution of friction along an arc that has not slid is unknown.

use super::supports_and_loads::{SupportNode, direction};
use crate::catenary::Chain;
use crate::math::perp;

/// Steps of the classical Runge–Kutta method (order 4) round one wheel: at 32 the error is below
/// 1e-8 of the tension for a full turn at μ = 0.5.
const STEPS: usize = 32;

/// Result of an integration of the tension round a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WheelTraverse {
    /// Tension where the cable leaves, N.
    pub tension: f64,
    /// Unstretched material on the arc, m.
    pub material: f64,
}

/// Follows the tension round a wheel from `tension` where the cable arrives at angle `from`, over
/// `turn` rad.
pub(super) fn traverse_wheel(
    chain: &Chain<'_>,
    a: &SupportNode,
    tension: f64,
    from: f64,
    turn: f64,
    m: f64,
) -> WheelTraverse {
    if a.radius == 0.0 {
        return WheelTraverse { tension: tension * (m * turn).exp(), material: 0.0 };
    }
    let rate = |psi: f64, t: f64| {
        let along = direction(from - a.facing * psi);
        let ds = a.radius / (chain.thermal_stretch * (1.0 + t / chain.axial_stiffness));
        let out = perp(along) * a.facing;
        (-ds * chain.weight.dot(&along) + m * (t - ds * chain.weight.dot(&out)), ds)
    };
    let h = turn / STEPS as f64;
    let (mut t, mut s) = (tension, 0.0);
    for i in 0..STEPS {
        let psi = i as f64 * h;
        let a1 = rate(psi, t);
        let a2 = rate(psi + 0.5 * h, t + 0.5 * h * a1.0);
        let a3 = rate(psi + 0.5 * h, t + 0.5 * h * a2.0);
        let a4 = rate(psi + h, t + h * a3.0);
        t += h / 6.0 * (a1.0 + 2.0 * (a2.0 + a3.0) + a4.0);
        s += h / 6.0 * (a1.1 + 2.0 * (a2.1 + a3.1) + a4.1);
    }
    WheelTraverse { tension: t, material: s }
}

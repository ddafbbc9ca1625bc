//! In plan view the floor has friction with the cable that slides round a corner or post.
//!
//! A material node gets the floor's friction on the straight halves of the bars beside it as a
//! force. The material of a sliding node lies before its round, on it and after it, and the floor's
//! friction f₀, f, f₂ on each part is not friction of the round. Let A and B be the tensions where
//! the cable meets and leaves the round, friction positive for a cable that runs towards its start,
//! and the floor's friction on the round spread evenly over its turn φ. Then
//! ```text
//! T₁ = A + f₀,   T₂ = B − f₂,   −dT/dφ = mT + f/φ,   A = B e^{mφ} + f (e^{mφ} − 1)/mφ,   |m| ≤ μ
//! ```
//! A slipping cable has m = ±μ: with γ = e^{±μφ}, T₁ = γT₂ + f₀ + γf₂ + f (γ − 1)/ln γ.

use crate::math::Vec2;
use crate::model::fem::mesh::{Mesh, mean_factor};
use crate::problem::Problem;

/// Exponent below which functions of it are series of two terms, whose error is its square.
/// Smaller: the quotients lose digits; larger: the series do.
const MAX_SERIES_EXPONENT: f64 = 1e-4;

/// Iterations for the rate at which tension grows over a round: Newton's method on a convex
/// function that is close to an exponential.
const RATE_ITERATIONS: usize = 30;

/// Material of a bar (m): on the round at its start, in half of the straight part, and on the round
/// at its end.
fn shares(mesh: &Mesh, e: usize, x: &[Vec2], slide: Option<&[f64]>) -> [f64; 3] {
    let path = mesh.path(e, x);
    let rest = slide.map_or(mesh.rest_length[e], |s| crate::model::fem::system::bar_energy::rest_length(mesh, e, s))
        / mesh.thermal_stretch;
    let on_round = |j: usize| {
        let end = &mesh.sliding[e + j];
        let lap = end.map_or(0.0, |s| s.end.radius * path.arcs[j]);
        if lap > 0.0 { lap } else { 0.0 }
    };
    let laps = [on_round(0), on_round(1)];
    let whole = path.straight + laps[0] + laps[1];
    if !(whole > 0.0) {
        return [0.0, 0.5 * rest, 0.0];
    }
    [rest * laps[0] / whole, 0.5 * rest * path.straight / whole, rest * laps[1] / whole]
}

/// Material before, on and after the round of a node whose floor friction acts at the node, m: half
/// of the straight part of each bar beside it, and all material on its round.
pub(in crate::model::fem) fn reaches(mesh: &Mesh, k: usize, x: &[Vec2], slide: Option<&[f64]>) -> [f64; 3] {
    let [_, before, on] = if k > 0 { shares(mesh, k - 1, x, slide) } else { [0.0; 3] };
    let [leaving, after, _] = if k + 1 < mesh.nodes() { shares(mesh, k, x, slide) } else { [0.0; 3] };
    [before, on + leaving, after]
}

/// Factor of the floor's friction in the derivative of the scaled energy by the slide.
pub(in crate::model::fem) fn factor([before, on, after]: [f64; 3], ratio: f64) -> f64 {
    let whole = before + on + after;
    if whole > 0.0 { (before + on * mean_factor(ratio) + after * ratio) / whole } else { 1.0 }
}

/// Tension over a round of a cable with friction on it and on the floor.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct RoundFloorFriction {
    /// Tension where it leaves the round, N.
    leaves: f64,
    /// The floor's friction on the round, N.
    floor: f64,
    /// The exponent mφ.
    exponent: f64,
}

impl RoundFloorFriction {
    /// The tension between two given ones, N; None if friction cannot connect them because the
    /// cable is slack.
    pub fn between([comes, leaves]: [f64; 2], floor: f64) -> Option<Self> {
        if !(comes > 0.0 && leaves > 0.0 && comes - floor > 0.0) {
            return None;
        }
        let mut z = ((comes - floor) / leaves).ln();
        for _ in 0..RATE_ITERATIONS {
            let k = mean_factor(z.exp());
            let miss = leaves * z.exp() + floor * k - comes;
            // dk/dz = (e^z − k)/z.
            let bend = if z.abs() < MAX_SERIES_EXPONENT { 0.5 + z / 3.0 } else { (z.exp() - k) / z };
            let step = miss / (leaves * z.exp() + floor * bend);
            z -= step;
            if !(step.abs() > 4.0 * f64::EPSILON * z.abs()) {
                break;
            }
        }
        z.is_finite().then_some(Self { leaves, floor, exponent: z })
    }

    /// Tension with the fraction `part` of the turn behind it, N.
    pub fn at(&self, part: f64) -> f64 {
        let left = 1.0 - part;
        let ratio = (self.exponent * left).exp();
        self.leaves * ratio + self.floor * left * mean_factor(ratio)
    }

    /// ∫T dφ over its turn (rad), N.
    pub fn normal(&self, turn: f64) -> f64 {
        let z = self.exponent;
        // The integral is ∫ B e^{zu} + f (e^{zu} − 1)/z du from 0 to 1; that of the second term is
        // f (k(z) − 1)/z.
        let k = mean_factor(z.exp());
        let rest = if z.abs() < MAX_SERIES_EXPONENT { 0.5 + z / 6.0 } else { (k - 1.0) / z };
        turn * (self.leaves * k + self.floor * rest)
    }
}

/// Slide (m) of a sliding node with the same floor friction as a material node that was moved by
/// `slid` (m), on a path in direction `along`.
pub(in crate::model::fem) fn as_slide(slid: Vec2, along: Vec2) -> Vec2 {
    Vec2::new(-slid.dot(&along), 0.0)
}

/// Displacement (m) of a material node with the same floor friction as a sliding node with this
/// slide: the reverse of [`as_slide`].
pub(in crate::model::fem) fn as_move(slide: Vec2, along: Vec2) -> Vec2 {
    along * -slide.x
}

/// Relative change of the floor's friction limit of a node below which it has converged. Larger:
/// the friction cones of a report differ from those of the solve (the verification allows 1e-3);
/// smaller: rounds for changes by round-off.
const FLOOR_FRICTION_TOLERANCE: f64 = 1e-6;

/// Plan view: renews the floor's friction limit of each node for the present shape, with that of
/// the lumped mass of a support there; returns whether any of them changed.
pub(in crate::model::fem) fn renew_limits(
    limits: &mut Vec<f64>,
    problem: &Problem,
    mesh: &Mesh,
    support_node: &[Option<usize>],
    x: &[Vec2],
    slide: Option<&[f64]>,
) -> bool {
    if problem.floor_friction.is_none() {
        limits.clear();
        return false;
    }
    let mut changed = limits.len() != mesh.nodes();
    limits.resize(mesh.nodes(), 0.0);
    for (k, limit) in limits.iter_mut().enumerate() {
        let reach: f64 = reaches(mesh, k, x, slide).iter().sum();
        let now = problem.max_floor_friction(reach, Mesh::lumped_mass(problem, support_node, k));
        changed |= !((now - *limit).abs() <= FLOOR_FRICTION_TOLERANCE * (now + *limit));
        *limit = now;
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tension_over_a_round_obeys_its_equation() {
        for (comes, leaves, floor) in
            [(120.0, 100.0, 3.0), (90.0, 100.0, -4.0), (103.0, 100.0, 3.0), (5.0, 4.0, -2.5), (2.0, 40.0, 1.0)]
        {
            let over = RoundFloorFriction::between([comes, leaves], floor).unwrap();
            let turn = 0.7;
            assert!((over.at(0.0) - comes).abs() < 1e-10 * comes && (over.at(1.0) - leaves).abs() < 1e-10 * leaves);
            let n = 2000;
            let h = 1.0 / f64::from(n);
            let mut sum = 0.0;
            for i in 0..n {
                let part = h * (f64::from(i) + 0.5);
                let slope = (over.at(part + 1e-5) - over.at(part - 1e-5)) / 2e-5;
                let expected = -over.exponent * over.at(part) - floor;
                assert!((slope - expected).abs() < 1e-5 * comes.max(leaves), "{slope} {expected}");
                sum += over.at(part) * h * turn;
            }
            assert!((over.normal(turn) - sum).abs() < 1e-6 * sum, "{} {sum}", over.normal(turn));
        }
        assert!(
            RoundFloorFriction::between([0.0, 3.0], 0.0).is_none()
                && RoundFloorFriction::between([f64::NAN, 3.0], 0.0).is_none()
        );
    }

    #[test]
    fn the_factor_of_the_floor_goes_from_one_side_to_the_other() {
        assert!((factor([1.0, 0.0, 0.0], 3.0) - 1.0).abs() < 1e-15);
        assert!((factor([0.0, 0.0, 1.0], 3.0) - 3.0).abs() < 1e-15);
        assert!((factor([0.0, 1.0, 0.0], 1.0) - 1.0).abs() < 1e-15);
        assert!((mean_factor(1.0 + 1e-4) - mean_factor(1.0 + 1.00001e-4)).abs() < 1e-9);
    }
}

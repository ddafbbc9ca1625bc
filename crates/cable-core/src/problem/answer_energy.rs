//! The energy of a cable is computed from its nodes, whichever model gave them.
//!
//! Everything is linear between two nodes, so that products are integrated exactly: ∫ a b ds = ds
//! (2 a₀b₀ + a₀b₁ + a₁b₀ + 2 a₁b₁)/6. A sagging bar drawn straight is second order. Lumps, pulleys
//! and loads are left out.

use super::definition::Problem;
use crate::solution::{CableSolution, Energy, Node};

/// ∫ a² ds between two nodes.
fn squared(a: f64, b: f64, ds: f64) -> f64 {
    ds * (a * a + a * b + b * b) / 3.0
}

impl Energy {
    /// The energy of one cable.
    #[must_use]
    pub fn of(problem: &Problem, answer: &CableSolution) -> Self {
        let elements = answer.pieces().flat_map(|piece| piece.windows(2));
        elements
            .filter_map(|pair| if let [a, b] = pair { Some((a, b)) } else { None })
            .map(|(a, b)| element(problem, answer.assumptions.bending_stiffness_n_m2, a, b))
            .sum()
    }
}

/// ∫ a b ds between two nodes.
fn product(a: [f64; 2], b: [f64; 2], ds: f64) -> f64 {
    ds * (2.0 * a[0] * b[0] + a[0] * b[1] + a[1] * b[0] + 2.0 * a[1] * b[1]) / 6.0
}

/// Energy of the cable between two nodes, whose figures are linear in between.
fn element(problem: &Problem, bending_stiffness: f64, a: &Node, b: &Node) -> Energy {
    let ds = b.arc_length_m - a.arc_length_m;
    let speed = squared(a.vx_m_per_s, b.vx_m_per_s, ds) + squared(a.vy_m_per_s, b.vy_m_per_s, ds);
    let stretch = squared(a.tension_n, b.tension_n, ds) / problem.axial_stiffness;
    // Of a spring T ε with ε = T/EA. Relaxation branches pull beside it, and what they hold is at
    // most their pull times the strain.
    let beside = [a, b].map(|n| n.tension_n / problem.axial_stiffness - n.strain);
    let relaxed = product([a.tension_n, b.tension_n], beside, ds);
    let height = 0.5 * ds * (a.y_m + b.y_m);
    Energy {
        kinetic_j: 0.5 * problem.linear_density * speed,
        gravity_j: -problem.weight.y * height,
        // Strain by tension is T/EA of a length that temperature has changed.
        stretch_j: 0.5 * problem.thermal_stretch * (stretch - relaxed),
        bending_j: 0.5 * bending_stiffness * squared(a.curvature_per_m, b.curvature_per_m, ds),
    }
}

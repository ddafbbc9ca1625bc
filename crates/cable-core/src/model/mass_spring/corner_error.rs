//! A bound of the error that a mesh makes in the tension beyond a corner.
//!
//! As the cable turns, forces along an element balance, not along the cable: with a and b the
//! angles of the strands to the element that lies on a smooth corner, T₁ cos a = T₂ cos b. As the
//! cable is drawn over it, a and b share the whole turn φ in any way, so T₂/T₁ runs between cos φ
//! and 1/cos φ: a sawtooth that is geometric. On a sharp corner no mesh removes it, as the turn
//! stays in one element; on a round of radius R with elements of l it falls with φ = l/2R. With
//! friction the turn that counts is uncertain by half of that of an element more, and at a corner
//! each jerk ends in slipping back, by μφ at most:
//!
//! ```text
//! a corner, whole turn φ:                       δT/T = 1/cos φ − 1 + μφ
//! a round, φₑ the largest turn at a node:       δT/T = 1/cos(φₑ/2) − 1 + μ φₑ/2
//! ```
//!
//! It bounds what was measured within a factor 6: corners of 30° and 45° with 60 to 240 elements,
//! posts with l/R from 0.74 to 0.08, μ up to 0.3. From 80° on nothing is known.

use std::ops::RangeInclusive;

use crate::energy::bending::turn;
use crate::model::mass_spring::mesh::Mesh;

/// The turn of the cable round an obstacle.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::mass_spring) struct Wrap {
    /// Whole turn, rad, with its sign.
    pub turn: f64,
    /// Relative uncertainty of the tension beyond it.
    pub uncertainty: f64,
}

/// The turn at `nodes` that touch one obstacle with friction `mu`.
pub(in crate::model::mass_spring) fn wrap(mesh: &Mesh, nodes: RangeInclusive<usize>, mu: f64) -> Wrap {
    let tuning = &mesh.tuning.estimate;
    let inner = (*nodes.start()).max(1)..=(*nodes.end()).min(mesh.position.len().saturating_sub(2));
    let turn_at = |n: usize| turn(mesh.position[n] - mesh.position[n - 1], mesh.position[n + 1] - mesh.position[n]);
    let (mut whole, mut sharpest) = (0.0, 0.0);
    for n in inner.clone() {
        let t = turn_at(n);
        whole += t;
        sharpest = if t.abs() > sharpest { t.abs() } else { sharpest };
    }
    if sharpest < tuning.min_turn_rad {
        return Wrap::default();
    }
    let nodes = inner.filter(|&n| turn_at(n).abs() > tuning.turn_share * sharpest).count();
    let angle = if nodes < tuning.round_nodes { whole.abs() } else { 0.5 * sharpest };
    let bounded = if angle > tuning.max_turn_rad { tuning.max_turn_rad } else { angle };
    Wrap { turn: whole, uncertainty: bounded.cos().recip() - 1.0 + mu * angle }
}

//! This module bounds what a mesh cannot know about tension beyond a corner.
//!
//! Where the cable turns, forces along an element balance, not along the cable: with a and b the
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

use crate::energy::bending::turn;
use crate::math::larger;
use crate::model::mass_spring::MassSpringModel;
use crate::solution::{ContactReport, Warning, WarningCause};

/// Nodes that share the turn of a round at least: fewer is a corner to this mesh.
const ROUND_NODES: usize = 3;
/// Part of the largest turn at a node that makes another one count.
const COUNTS: f64 = 0.2;
/// Turn that is none, rad: the nodes of a cable that lies on a flat floor differ by less.
const TURN_TOLERANCE: f64 = 1e-3;
/// Beyond this (rad, 80°) an angle is taken as this: the tangent says no more than that nothing is
/// known.
const STEEPEST_ANGLE: f64 = 1.4;

/// How the cable goes round what it touches.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::mass_spring) struct Wrap {
    /// Whole turn, rad, with its sign.
    pub turn: f64,
    /// Relative uncertainty of the tension beyond it.
    pub uncertain: f64,
}

impl MassSpringModel {
    /// The turn at the nodes `first..=last`, which touch one obstacle with friction `mu`.
    pub(in crate::model::mass_spring) fn wrap(&self, [first, last]: [usize; 2], mu: f64) -> Wrap {
        let inner = first.max(1)..=last.min(self.chain.x.len().saturating_sub(2));
        let turn_at = |n: usize| turn(self.chain.x[n] - self.chain.x[n - 1], self.chain.x[n + 1] - self.chain.x[n]);
        let (mut whole, mut sharpest) = (0.0, 0.0);
        for n in inner.clone() {
            let t = turn_at(n);
            whole += t;
            sharpest = if t.abs() > sharpest { t.abs() } else { sharpest };
        }
        if sharpest < TURN_TOLERANCE {
            return Wrap::default();
        }
        let nodes = inner.filter(|&n| turn_at(n).abs() > COUNTS * sharpest).count();
        let angle = if nodes < ROUND_NODES { whole.abs() } else { 0.5 * sharpest };
        let bounded = if angle > STEEPEST_ANGLE { STEEPEST_ANGLE } else { angle };
        Wrap { turn: whole, uncertain: bounded.cos().recip() - 1.0 + mu * angle }
    }

    /// The contact beyond which tension is least certain, if that is worse than the accuracy asked
    /// for.
    pub(in crate::model::mass_spring) fn least_certain(&self) -> Option<(ContactReport, f64)> {
        let worst = self.wraps().into_iter().reduce(|a, b| if b.1 > a.1 { b } else { a });
        worst.filter(|(_, uncertain)| *uncertain > self.settings.tolerance)
    }

    /// Returns how uncertain tension is, by corners or by what the floor holds, if that is worse
    /// than the accuracy asked for.
    pub(in crate::model::mass_spring) fn uncertain(&self) -> Option<f64> {
        let corner = self.least_certain().map_or(0.0, |(_, uncertain)| uncertain);
        let worst = larger(corner, self.held_by_floor());
        (worst > self.settings.tolerance).then_some(worst)
    }

    /// Says beyond which contact tension is least certain.
    pub(in crate::model::mass_spring) fn warn_of_corners(&mut self) {
        let Some((contact, uncertain)) = self.least_certain() else { return };
        let name = &self.problem.cable.name;
        let cause = WarningCause::CornerOfMesh {
            obstacle: contact.obstacle.clone(),
            turn_deg: contact.turn_deg.abs(),
            element_m: self.chain.even,
        };
        let warning = Warning::new(cause, name, contact.arc_length_m, [uncertain, self.settings.tolerance]);
        self.report.warnings.push(warning.at([contact.x_m, contact.y_m]));
    }
}

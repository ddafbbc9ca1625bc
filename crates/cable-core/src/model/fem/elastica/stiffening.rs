//! The elastica comes to its whole bending stiffness by continuation from a nearly flexible cable.

use crate::model::fem::elastica::boundary_value::{ANGLE, Elastica, LENGTH, MOST_WORK, Piece, tension};
use crate::model::fem::elastica::chain::CLAMPED_EULER;
use crate::problem::Problem;

/// Factor of the first rise of EI, and the greatest one.
const FIRST_RISE: f64 = 4.0;
/// See `FIRST_RISE`.
const MAX_RISE: f64 = 10.0;

/// Growth of the factor after a rise that was solved. After one that was not, the factor becomes
/// its root. Below the least factor the continuation is given up.
const EASY_RISE_GROWTH: f64 = 1.5;
/// See `EASY_RISE_GROWTH`.
const LEAST_RISE: f64 = 1.001;

/// Part of the whole stiffness from which a rise goes to all of it.
const LAST_RISE_FRACTION: f64 = 0.999;

/// Turn of a piece, rad, up to which it is straight. Larger: bows, which bear more than a strut,
/// are taken for struts.
const STRAIGHT_TURN: f64 = 0.5;

impl Elastica {
    /// Raises EI to that of the cable; returns false where that is not reached.
    pub fn stiffen(&mut self, problem: &Problem) -> bool {
        let whole = problem.bending_stiffness;
        if !self.settle(problem) || !self.is_sound() {
            return false;
        }
        let mut factor = FIRST_RISE;
        // Each rise costs work; from 1e-6 of EI by fours there are 10.
        while self.bending < whole {
            if self.work > MOST_WORK {
                return false;
            }
            let saved = self.clone();
            let next = self.bending * factor;
            self.bending = if next > LAST_RISE_FRACTION * whole { whole } else { next };
            // Moments of stretches in contact grow with the stiffness, those of layers with its
            // root: Newton's method begins with neither changed.
            self.regrid();
            if self.settle(problem) && self.is_sound() {
                factor = (factor * EASY_RISE_GROWTH).min(MAX_RISE);
            } else {
                let (steps, work) = (self.steps, self.work);
                *self = saved;
                (self.steps, self.work) = (steps, work);
                factor = factor.sqrt();
                if factor < LEAST_RISE {
                    return false;
                }
            }
        }
        true
    }

    /// True if the equations show how it bends, and nothing in it would give way at once.
    pub(super) fn is_sound(&self) -> bool {
        self.resolves_layers() && !self.pieces.iter().any(|p| self.is_crushed_column(p))
    }

    /// True if a free piece is straight and pressed with more than Euler's force of a strut that is
    /// clamped at both ends, 4π²EI/l²: none bears that, whatever holds its ends.
    fn is_crushed_column(&self, piece: &Piece) -> bool {
        if piece.contact.is_some() {
            return false;
        }
        let [mut least, mut most, mut pull] = [f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for u in &piece.nodes {
            (least, most, pull) = (least.min(u[ANGLE]), most.max(u[ANGLE]), pull.max(tension(u)));
        }
        let length = piece.nodes.first().map_or(0.0, |u| u[LENGTH]);
        most - least < STRAIGHT_TURN && -pull * length * length > CLAMPED_EULER * self.bending
    }
}

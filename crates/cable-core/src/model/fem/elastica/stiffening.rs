//! This module raises the bending stiffness of an elastica to that of the cable by continuation
//! from a nearly flexible one.

use crate::model::fem::elastica::boundary_value::{ANGLE, Elastica, ElasticaPiece, LENGTH, MOST_WORK, tension};
use crate::model::fem::elastica::chain::CLAMPED_EULER;
use crate::problem::Problem;

/// Factor of the first rise of EI, and the greatest factor.
const FIRST_RISE: f64 = 4.0;
/// See `FIRST_RISE`.
const MAX_RISE: f64 = 10.0;

/// Growth of the factor after a rise that was solved. After one that was not, the factor becomes
/// its square root. Below the least factor the continuation is given up.
const EASY_RISE_GROWTH: f64 = 1.5;
/// See `EASY_RISE_GROWTH`.
const LEAST_RISE: f64 = 1.001;

/// Fraction of the whole stiffness from which a rise goes to all of it.
const LAST_RISE_FRACTION: f64 = 0.999;

/// Turn of a piece (rad) up to which it counts as straight. Larger: bows, which bear more
/// compression than a strut, count as struts.
const STRAIGHT_TURN: f64 = 0.5;

impl Elastica {
    /// Raises EI to that of the cable; returns false if that is not reached.
    pub fn stiffen(&mut self, problem: &Problem) -> bool {
        let whole = problem.bending_stiffness;
        if !self.settle(problem) || !self.is_sound() {
            return false;
        }
        let mut factor = FIRST_RISE;
        // Each rise costs work; from 1e-6 EI there are 10 with a factor of 4.
        while self.bending < whole {
            if self.work > MOST_WORK {
                return false;
            }
            let saved = self.clone();
            let next = self.bending * factor;
            self.bending = if next > LAST_RISE_FRACTION * whole { whole } else { next };
            // The moments of stretches in contact grow with EI and those of boundary layers with
            // its root. Newton's method starts with both unchanged.
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

    /// True if the elements resolve its bends and no piece of it would buckle.
    pub(super) fn is_sound(&self) -> bool {
        self.resolves_layers() && !self.pieces.iter().any(|p| self.is_crushed_column(p))
    }

    /// True if a free piece is straight and under more compression than Euler's load of a strut
    /// clamped at both ends, 4π²EI/l²: no strut bears that, whatever holds its ends.
    fn is_crushed_column(&self, piece: &ElasticaPiece) -> bool {
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

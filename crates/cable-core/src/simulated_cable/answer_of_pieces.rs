//! The pieces of a cable are read as one cable again: arc lengths from its start, supports in the
//! scene's order.

use super::SimulatedCable;
use super::piece::CablePiece;
use crate::problem::SupportPoint;
use crate::solution::{Assumptions, CableSolution, MomentumAccount, SupportReaction};
use crate::state::State;

/// Part by which sums of times round.
const TIME_TOLERANCE: f64 = 1e-6;

impl SimulatedCable {
    /// The answer at this instant.
    pub fn answer(&self) -> CableSolution {
        if let ([whole], true) = (self.pieces.as_slice(), self.breaks.is_empty()) {
            return CableSolution { peaks: self.peaks, momentum: self.account(), ..whole.answer.clone() };
        }
        let assumptions = self.pieces.first().map_or_else(Default::default, |first| Assumptions {
            inertia: self.pieces.iter().any(|p| p.answer.assumptions.inertia),
            ..first.answer.assumptions
        });
        let name = self.problem.cable.name.clone();
        let mut out = CableSolution {
            name,
            assumptions,
            peaks: self.peaks,
            momentum: self.account(),
            energy_account: self.energy_account(),
            unstretched_length_m: match self.pieces.as_slice() {
                [whole] => whole.answer.unstretched_length_m,
                _ => None,
            },
            ..CableSolution::default()
        };
        for piece in &self.pieces {
            let from = piece.part.from;
            if !out.nodes.is_empty() || piece.part.supports.first() == Some(&None) {
                out.breaks.push(out.nodes.len());
            }
            let first = out.nodes.len();
            out.breaks.extend(piece.answer.breaks.iter().map(|node| first + node));
            out.nodes.extend(piece.answer.nodes.iter().map(|n| {
                let mut n = *n;
                n.arc_length_m += from;
                n
            }));
            out.contacts.extend(piece.answer.contacts.iter().map(|c| {
                let mut c = c.clone();
                c.arc_length_m += from;
                c.begins_m += from;
                c.ends_m += from;
                c.samples.iter_mut().for_each(|s| s.arc_length_m += from);
                c
            }));
        }
        if self.pieces.last().is_some_and(|p| p.part.supports.last() == Some(&None)) {
            out.breaks.push(out.nodes.len());
        }
        out.supports = (0..self.problem.supports.len()).map(|k| self.reaction(k)).collect();
        out
    }

    /// The account of all pieces over the whole of the caller's step, where there is one.
    fn account(&self) -> Option<MomentumAccount> {
        let over_s = self.time_s() - self.peaks_since_s;
        let whole = |p: &CablePiece| p.account.filter(|a| (a.over_s - over_s).abs() <= TIME_TOLERANCE * over_s);
        let accounts: Option<Vec<MomentumAccount>> = self.pieces.iter().map(whole).collect();
        accounts?.into_iter().reduce(|a, b| a.with(&b))
    }

    /// Returns where the cable is; the end of one piece and the start of the next have the same arc
    /// length.
    pub fn state(&self) -> State {
        let mut out = State { time_s: self.time_s(), ..State::default() };
        for piece in &self.pieces {
            let state = piece.mechanics.state();
            out.arc_length_m.extend(state.arc_length_m.iter().map(|s| s + piece.part.from));
            out.position_m.extend(state.position_m);
            out.velocity_m_per_s.extend(state.velocity_m_per_s);
        }
        out
    }

    /// Returns where each support sits, m on the whole cable.
    pub(super) fn support_arc_lengths(&self) -> Vec<f64> {
        (0..self.problem.supports.len()).map(|k| self.reaction(k).arc_length_m).collect()
    }

    /// Returns for each support of the scene whether it is a wheel that the cable hangs clear of.
    pub(super) fn cleared_wheels(&self) -> Vec<bool> {
        let nothing = |r: &SupportReaction| r.reaction_x_n == 0.0 && r.reaction_y_n == 0.0;
        let wheels = self.problem.supports.iter().map(|s| s.wheel_radius > 0.0).enumerate();
        wheels.map(|(k, wheel)| wheel && nothing(&self.reaction(k))).collect()
    }

    /// Returns what the cable does to a support of the scene: nothing, if it is off it.
    pub(super) fn reaction(&self, k: usize) -> SupportReaction {
        let reaction = self.pieces.iter().find_map(|p| {
            let own = p.part.supports.iter().position(|s| *s == Some(k))?;
            let mut r = p.answer.supports.get(own)?.clone();
            r.arc_length_m += p.part.from;
            Some(r)
        });
        reaction.unwrap_or_else(|| {
            self.problem.supports.get(k).map_or_else(SupportReaction::default, |s| self.unloaded_reaction(s))
        })
    }

    /// The reaction of a support that holds nothing.
    fn unloaded_reaction(&self, support: &SupportPoint) -> SupportReaction {
        let at = support.position_at(self.time_s()).map(|p| p.0).or(support.at).unwrap_or_default();
        SupportReaction {
            name: support.name.clone(),
            x_m: at.x,
            y_m: at.y,
            arc_length_m: support.arc_length.unwrap_or(0.0),
            ..SupportReaction::default()
        }
    }
}

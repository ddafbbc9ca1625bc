//! A piece that breaks is replaced by those it breaks into, and runs off pulleys at its new ends.

use std::sync::Arc;

use super::SimulatedCable;
use super::break_search::BreakPoint;
use super::piece::Piece;
use crate::breakage::{Break, CablePart, Cut, rupture};
use crate::error::SolveError;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{Inertia, Settings};
use crate::state::State;

/// Steps after a break in which a piece is not asked whether it breaks: the models start with a
/// first-order step, and the free end is met by a wave of its own. Fewer: false breaks beside the
/// first; more: true ones are late. In motion it is also not asked until that wave, at c = √(EA/ρ),
/// has crossed it there and back (once is too short: a mesh blurs its front): where the break is
/// not felt yet, a cable of exactly even strength that was pulled evenly would break everywhere at
/// once, which no cable does.
const UNWATCHED_STEPS: u32 = 2;

impl SimulatedCable {
    /// Replaces a piece by those it breaks into.
    pub(super) fn split(&mut self, k: usize, point: &BreakPoint, inertia: Inertia) -> Result<(), SolveError> {
        let (support_arc_lengths, cleared_wheels) = (self.support_arc_lengths(), self.cleared_wheels());
        // The pieces may come to obstacles that the whole cable could not reach.
        if let Some(problem) = self.problem.with_all_obstacles() {
            self.problem = problem;
        }
        let Some(piece) = self.pieces.get(k) else { return Ok(()) };
        let nodes = &piece.answer.nodes;
        let Some(node) = nodes.get(point.at.node) else { return Ok(()) };
        let tension = |i: Option<usize>| i.and_then(|i| nodes.get(i)).map_or(0.0, |n| n.tension_n);
        let cut = Cut {
            at: piece.part.from + node.arc_length_m,
            near: 0.5 * piece.element(),
            after: tension(Some(point.at.node + 1)) > tension(point.at.node.checked_sub(1)),
            support_arc_lengths: &support_arc_lengths,
            cleared_wheels: &cleared_wheels,
        };
        let parts = piece.part.cut(&self.problem, &cut);
        let detached = if parts.len() == 1 { piece.part.support_at_end(&cut) } else { None };
        let event = Break {
            time_s: point.time_s,
            arc_length_m: cut.at,
            at: point.state.position_at(node.arc_length_m).unwrap_or_default(),
            over_s: if inertia == Inertia::Dynamic { self.problem.cable.breaking_time_s } else { 0.0 },
            detached_from: detached.and_then(|k| self.problem.supports.get(k)).map(|s| s.name.clone()),
        };
        let from = piece.part.from;
        self.breaks.push(event);
        let new_pieces = parts.into_iter().map(|part| self.piece_after_break(part, from, point, inertia));
        let new_pieces = new_pieces.collect::<Result<Vec<_>, SolveError>>()?;
        self.pieces.splice(k..=k, new_pieces);
        Ok(())
    }

    /// Builds a piece of one that began at `from` (m on the whole cable) and broke.
    fn piece_after_break(
        &self,
        part: CablePart,
        from: f64,
        point: &BreakPoint,
        inertia: Inertia,
    ) -> Result<Piece, SolveError> {
        let mut state = rupture::section(&point.state, part.from - from, part.to - from);
        // A piece that broke at rest is not at rest any more.
        state.in_motion = inertia == Inertia::Dynamic;
        let there_and_back_s =
            2.0 * part.length() * (self.problem.linear_density / self.problem.axial_stiffness).sqrt();
        let mut piece = self.build_piece(part, &state)?;
        piece.unwatched_steps = UNWATCHED_STEPS;
        piece.unwatched_until_s = point.time_s + there_and_back_s;
        Ok(piece)
    }

    /// Builds a piece in a state, whose arc lengths are its own.
    pub(super) fn build_piece(&self, part: CablePart, state: &State) -> Result<Piece, SolveError> {
        let problem = Arc::new(part.problem(&self.problem, state));
        let mut mechanics = self.source.build(problem, Settings { segments: None, ..self.settings })?;
        self.targets.tell(&part, mechanics.as_mut());
        mechanics.set_state(state)?;
        Ok(Piece::new(mechanics, part, TensionGauge::over(self.problem.cable.breaking_time_s)))
    }

    /// Takes pieces off the pulleys that their new ends have come to.
    pub(super) fn detach_from_pulleys(&mut self, inertia: Inertia) -> Result<(), SolveError> {
        if self.breaks.is_empty() {
            return Ok(());
        }
        for k in 0..self.pieces.len() {
            while let Some(piece) = self.pieces.get(k)
                && let Some(support) = piece.pulley_at_new_end(&self.problem)
            {
                let mut state = piece.mechanics.state();
                state.in_motion = inertia == Inertia::Dynamic;
                let next = self.build_piece(piece.part.without(support), &state)?;
                if let Some(piece) = self.pieces.get_mut(k) {
                    *piece = next;
                }
            }
        }
        Ok(())
    }
}

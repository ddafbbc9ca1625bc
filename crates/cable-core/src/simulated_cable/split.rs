//! A piece that breaks is replaced by those it breaks into, and runs off pulleys at its new ends.

use std::sync::Arc;

use super::SimulatedCable;
use super::break_search::BreakPoint;
use super::former_energy::ReplacementReason;
use super::piece::CablePiece;
use crate::breakage::{Break, CablePart, Cut, rupture};
use crate::error::SolveError;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{BreakPlace, Inertia, Mechanics, Settings};
use crate::problem::Problem;
use crate::state::State;

/// Steps after a break in which a piece is not asked whether it breaks: the models start with a
/// first-order step, and the free end is met by a wave of its own. Fewer: false breaks beside the
/// first; more: true ones are late. In motion it is also not asked until that wave, at c = √(EA/ρ),
/// has crossed it there and back (once is too short: a mesh blurs its front): where the break is
/// not felt yet, a cable of exactly even strength that was pulled evenly would break everywhere at
/// once, which no cable does.
const UNWATCHED_STEPS: u32 = 2;

/// The division of a piece at a break.
struct Division<'a> {
    cut: &'a Cut<'a>,
    /// The pieces into which it breaks.
    parts: &'a [CablePart],
    /// The problem with obstacles that the whole cable could not reach, if there are any.
    grown: Option<Arc<Problem>>,
}

impl SimulatedCable {
    /// Replaces a piece by those it breaks into.
    pub(super) fn split(&mut self, k: usize, point: &BreakPoint, inertia: Inertia) -> Result<(), SolveError> {
        let (support_arc_lengths, cleared_wheels) = (self.support_arc_lengths(), self.cleared_wheels());
        // The pieces may come to obstacles that the whole cable could not reach.
        let grown = self.problem.with_all_obstacles();
        if let Some(problem) = grown.clone() {
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
        if let Some(broken) =
            self.break_in_model(k, Division { cut: &cut, parts: &parts, grown }, point.time_s, inertia)?
        {
            self.pieces.splice(k..=k, [broken]);
            return Ok(());
        }
        let new_pieces = parts.into_iter().map(|part| self.piece_after_break(part, from, point, inertia));
        let new_pieces = new_pieces.collect::<Result<Vec<_>, SolveError>>()?;
        let next: Vec<&dyn Mechanics> = new_pieces.iter().map(|p| &*p.mechanics).collect();
        self.replace_account(k, &next, ReplacementReason::Break);
        self.pieces.splice(k..=k, new_pieces);
        Ok(())
    }

    /// The piece after its model has broken it and goes on with what it broke into; None if the
    /// model cannot.
    fn break_in_model(
        &mut self,
        k: usize,
        division: Division<'_>,
        time_s: f64,
        inertia: Inertia,
    ) -> Result<Option<CablePiece>, SolveError> {
        let Division { cut, parts, grown } = division;
        let Some(piece) = self.pieces.get(k).filter(|p| p.mechanics.problem().cable.self_contact) else {
            return Ok(None);
        };
        let (mut broken, rebuilt) = (piece.clone(), grown.is_some());
        if let Some(problem) = grown {
            broken.mechanics = self.source.build(problem, self.settings)?;
            self.targets.tell(&broken.part, broken.mechanics.as_mut());
            let state = State { in_motion: inertia == Inertia::Dynamic, ..piece.mechanics.state() };
            broken.mechanics.set_state(&state)?;
        }
        let (from, length) = (broken.part.from, broken.part.length());
        let arc_length_m = match parts {
            [_] if cut.at - from <= cut.near => 0.0,
            [_] => length,
            _ => cut.at - from,
        };
        let place = BreakPlace { arc_length_m, gives_way_after: cut.after };
        let wave_s_per_m = (self.problem.linear_density / self.problem.axial_stiffness).sqrt();
        if !broken.break_in_model(place, time_s, wave_s_per_m) {
            return Ok(None);
        }
        if rebuilt {
            self.replace_account(k, &[&*broken.mechanics], ReplacementReason::Break);
        }
        if let [torn_off] = parts {
            broken.part = torn_off.clone();
        }
        broken.unwatched_steps = UNWATCHED_STEPS;
        broken.gauge = TensionGauge::over(self.problem.cable.breaking_time_s);
        Ok(Some(broken))
    }

    /// Builds a piece of one that began at `from` (m on the whole cable) and broke.
    fn piece_after_break(
        &self,
        part: CablePart,
        from: f64,
        point: &BreakPoint,
        inertia: Inertia,
    ) -> Result<CablePiece, SolveError> {
        let mut state = rupture::section(&point.state, part.from - from, part.to - from);
        // A piece that broke at rest is not at rest any more.
        state.in_motion = inertia == Inertia::Dynamic;
        let there_and_back_s =
            2.0 * part.length() * (self.problem.linear_density / self.problem.axial_stiffness).sqrt();
        let mut piece = self.build_piece(part, &state)?;
        piece.unwatched_steps = UNWATCHED_STEPS;
        piece.unwatched_until_s = vec![point.time_s + there_and_back_s];
        Ok(piece)
    }

    /// Builds a piece in a state, whose arc lengths are its own.
    pub(super) fn build_piece(&self, part: CablePart, state: &State) -> Result<CablePiece, SolveError> {
        let problem = Arc::new(part.problem(&self.problem, state));
        let mut mechanics = self.source.build(problem, Settings { segments: None, ..self.settings })?;
        self.targets.tell(&part, mechanics.as_mut());
        mechanics.set_state(state)?;
        Ok(CablePiece::new(mechanics, part, TensionGauge::over(self.problem.cable.breaking_time_s)))
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
                self.replace_account(k, &[&*next.mechanics], ReplacementReason::Edit);
                if let Some(piece) = self.pieces.get_mut(k) {
                    *piece = next;
                }
            }
        }
        Ok(())
    }
}

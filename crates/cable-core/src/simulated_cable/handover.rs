//! The same cable goes on in another state, by another model or after an edit.

use std::sync::Arc;

use super::SimulatedCable;
use super::piece::CablePiece;
use super::support_targets::{SupportGrip, SupportTarget};
use crate::breakage::{CablePart, Cut};
use crate::error::{SolveError, Unsupported};
use crate::math::{Vec2, larger};
use crate::model::smoothed_target::STILL_M_PER_S;
use crate::model::{Mechanics, Model, ModelSource, Settings};
use crate::problem::{Problem, SupportPoint};
use crate::scene::SupportKind;
use crate::state::State;

/// Part of a cable's length by which the places of a break and of a support, or two of a support,
/// differ by rounding.
const SAME_PLACE_FRACTION: f64 = 1e-6;

/// Lets a model continue with all that another one remembers of the same cable; returns whether it
/// does.
pub(super) fn continues(mechanics: &mut dyn Mechanics, before: &dyn Mechanics) -> bool {
    before.continuation().is_some_and(|before| mechanics.continue_from(&*before))
}

impl SimulatedCable {
    /// Returns the same cable by another model: in its present state, or on its route where no time
    /// has passed.
    pub fn rebuilt(&self, source: ModelSource) -> Result<Self, SolveError> {
        self.rebuilt_with(source, self.settings)
    }

    /// As [`Self::rebuilt`], with other settings.
    pub fn rebuilt_with(&self, source: ModelSource, settings: Settings) -> Result<Self, SolveError> {
        let mut next = Self::new(source, self.problem.clone(), settings)?;
        if self.time_s() > 0.0 {
            next.continue_from(self)?;
        }
        for (k, target) in self.targets.supports.iter().enumerate() {
            if let Some(target) = target {
                next.draw_support(k, *target);
            }
        }
        Ok(next)
    }

    /// Takes over a state of the whole cable.
    pub fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.leaves_reach |= self.problem.is_beyond_reach(&state.position_m);
        self.add_obstacles_in_reach()?;
        match self.pieces.as_mut_slice() {
            [whole] if self.breaks.is_empty() => {
                whole.mechanics.set_state(state)?;
                whole.gauge.forget();
                whole.refresh_answer();
                self.peaks = None;
                Ok(())
            }
            pieces => {
                let model = pieces.first().map_or(Model::Auto, |p| p.mechanics.model());
                let feature = Unsupported::StateOfWholeCable;
                Err(SolveError::Unsupported { model, feature })
            }
        }
    }

    /// A piece that goes on from one before an edit as it is; None if the model cannot.
    fn continued_piece(&self, old: &CablePiece, state: &State) -> Option<CablePiece> {
        let mut problem = old.part.problem(&self.problem, state);
        problem.cable.segments = old.mechanics.problem().cable.segments;
        let settings = Settings { segments: None, ..self.settings };
        let mut mechanics = self.source.build(Arc::new(problem), settings).ok()?;
        self.targets.tell(&old.part, mechanics.as_mut());
        continues(mechanics.as_mut(), old.mechanics.as_ref()).then(|| {
            let mut piece = CablePiece::new(mechanics, old.part.clone(), old.gauge.clone());
            piece.unwatched_steps = old.unwatched_steps;
            piece.unwatched_until_s.clone_from(&old.unwatched_until_s);
            piece
        })
    }

    /// Builds a piece like one of another model: in one mesh if this model can break, else as what
    /// it broke into.
    fn rebuilt_piece(&self, old: &CablePiece) -> Result<Vec<CablePiece>, SolveError> {
        let state = old.mechanics.state();
        if let Some(piece) = self.continued_piece(old, &state) {
            return Ok(vec![piece]);
        }
        let mut piece = self.build_piece(old.part.clone(), &state)?;
        if old.breaks.is_empty() {
            return Ok(vec![piece]);
        }
        if old.breaks.iter().all(|place| piece.break_in_model(*place, f64::NEG_INFINITY, 0.0)) {
            // The nodes on both sides of a break are told apart only now.
            piece.mechanics.set_state(&state)?;
            piece.refresh_answer();
            return Ok(vec![piece]);
        }
        let mut parts = vec![old.part.clone()];
        for place in &old.breaks {
            let at = old.part.from + place.arc_length_m;
            let cut = Cut {
                at,
                near: SAME_PLACE_FRACTION * old.part.length(),
                after: place.gives_way_after,
                support_arc_lengths: &self.support_arc_lengths(),
                cleared_wheels: &[],
            };
            if let Some(last) = parts.pop() {
                parts.extend(last.cut(&self.problem, &cut));
            }
        }
        let own = |(part, mut state): (CablePart, State)| {
            let from = state.arc_length_m.first().copied().unwrap_or(0.0);
            state.arc_length_m.iter_mut().for_each(|s| *s -= from);
            self.build_piece(part, &state)
        };
        parts.into_iter().zip(state.pieces()).map(own).collect()
    }

    /// Goes on from where the same whole cable was before an edit, by steps with inertia or
    /// without: as it is if the model can, else from its state.
    fn go_on_from(&mut self, before: &CablePiece, with_inertia: bool) -> Result<(), SolveError> {
        let state = before.mechanics.state();
        self.leaves_reach |= self.problem.is_beyond_reach(&state.position_m);
        self.add_obstacles_in_reach()?;
        if let [whole] = self.pieces.as_mut_slice()
            && continues(whole.mechanics.as_mut(), before.mechanics.as_ref())
        {
            whole.gauge.forget();
            whole.refresh_answer();
            self.peaks = None;
            return Ok(());
        }
        if !with_inertia {
            return self.set_state(&state);
        }
        let old = before.mechanics.problem();
        let [bodies, old_bodies] = [&self.problem, old].map(|problem| problem.world.geometry().bodies());
        let same_bodies = bodies.len() == old_bodies.len() && bodies.iter().zip(old_bodies).all(|(a, b)| a.is_where(b));
        // Bars of another mesh may cut corners, and a cable that lies still is not led round them.
        self.set_state(&State { in_motion: state.in_motion || !same_bodies, ..state.clone() })?;
        // On another mesh bars have other strains, and what an obstacle moves would be struck. A
        // cable that lies still is balanced at once, and so is one that has other obstacles or
        // another length; one that moves keeps its motion on other bars.
        let fastest = state.velocity_m_per_s.iter().map(|v| v.norm()).fold(0.0, larger);
        if fastest < STILL_M_PER_S || !same_bodies || self.problem.length != old.length {
            let pieces_before = self.pieces.clone();
            if self.settle().is_err() {
                self.pieces = pieces_before;
            }
        }
        Ok(())
    }

    /// Lets the supports that the scene holds elsewhere than they are go to their places in time:
    /// within a step, an end moved by 10 mm pulled with 4 kN.
    fn move_edited_supports(&mut self, old: &Self) {
        let problem = self.problem.clone();
        let same_number = problem.supports.len() == old.problem.supports.len();
        for (k, (support, before)) in problem.supports.iter().zip(&old.problem.supports).enumerate() {
            let stands = |s: &SupportPoint| s.motion.is_none() && s.kind != SupportKind::Robot;
            let same = same_number && support.kind == before.kind && stands(support) && stands(before);
            let now = old.reaction(k);
            let now = Vec2::new(now.x_m, now.y_m);
            if let (Some(to), true) = (support.at, same)
                && (to - now).norm() > SAME_PLACE_FRACTION * problem.length
            {
                self.draw_support(k, SupportTarget { place_m: now, grip: SupportGrip::Placed { to_m: to } });
            }
        }
    }

    /// Continues from where `old`, the same cable before an edit, is: broken where that one broke.
    pub fn continue_from(&mut self, old: &Self) -> Result<(), SolveError> {
        let (false, Some(first)) = (self.pieces.is_empty(), old.pieces.first()) else { return Ok(()) };
        if old.breaks.is_empty() {
            self.move_edited_supports(old);
            self.go_on_from(first, old.peaks.is_some())?;
            let same = |p: &Problem| (p.length, p.cable.breaking_time_s);
            if let (Some(own), true) = (self.pieces.first_mut(), same(&self.problem) == same(&old.problem)) {
                own.gauge.clone_from(&first.gauge);
            }
            return Ok(());
        }
        let model = self.model();
        let names = |s: &Self| s.problem.supports.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
        if names(self) != names(old)
            || self.problem.length != old.problem.length
            || self.problem.loads.len() != old.problem.loads.len()
        {
            let feature = Unsupported::EditOfBrokenCable;
            return Err(SolveError::Unsupported { model, feature });
        }
        self.targets.supports.clone_from(&old.targets.supports);
        // Pieces fall farther than the whole cable reached.
        if let Some(problem) = self.problem.with_all_obstacles() {
            self.problem = problem;
        }
        let mut pieces = Vec::with_capacity(old.pieces.len());
        for p in &old.pieces {
            pieces.extend(self.rebuilt_piece(p)?);
        }
        self.pieces = pieces;
        self.breaks.clone_from(&old.breaks);
        self.move_edited_supports(old);
        Ok(())
    }
}

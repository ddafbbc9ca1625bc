//! The same cable goes on in another state, by another model or after an edit.

use super::SimulatedCable;
use crate::error::{SolveError, Unsupported};
use crate::model::{Model, ModelSource, Settings};
use crate::problem::Problem;
use crate::state::State;

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

    /// Continues from where `old`, the same cable before an edit, is: broken where that one broke.
    pub fn continue_from(&mut self, old: &Self) -> Result<(), SolveError> {
        let (Some(own), Some(first)) = (self.pieces.first(), old.pieces.first()) else { return Ok(()) };
        if old.breaks.is_empty() {
            self.set_state(&first.mechanics.state())?;
            let same = |p: &Problem| (p.length, p.cable.breaking_time_s);
            if let (Some(own), true) = (self.pieces.first_mut(), same(&self.problem) == same(&old.problem)) {
                own.gauge.clone_from(&first.gauge);
            }
            return Ok(());
        }
        let model = own.mechanics.model();
        let names = |s: &Self| s.problem.supports.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
        if names(self) != names(old)
            || self.problem.length != old.problem.length
            || self.problem.loads.len() != old.problem.loads.len()
        {
            let feature = Unsupported::EditOfBrokenCable;
            return Err(SolveError::Unsupported { model, feature });
        }
        self.targets.supports.clone_from(&old.targets.supports);
        let mut pieces = Vec::with_capacity(old.pieces.len());
        for p in &old.pieces {
            pieces.push(self.build_piece(p.part.clone(), &p.mechanics.state())?);
        }
        self.pieces = pieces;
        self.breaks.clone_from(&old.breaks);
        Ok(())
    }
}

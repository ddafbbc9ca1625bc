//! Implicit dynamics and everything with contact (placeholder: refuses everything).

use std::sync::Arc;

use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::{Inertia, Model, Settings, StepReport};
use crate::problem::Problem;
use crate::solution::CableSolution;
use crate::state::State;

/// The moving cable, or the resting one where it can touch something.
#[derive(Clone, Debug)]
pub struct Dynamics {
    state: State,
}

fn refused() -> SolveError {
    SolveError::Unsupported { model: Model::Fem, feature: "obstacles and motion are not built yet".to_owned() }
}

impl Dynamics {
    /// Builds it at the route.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs what it lacks.
    pub fn new(_problem: Arc<Problem>, _settings: Settings) -> Result<Self, SolveError> {
        Ok(Self { state: State::default() })
    }

    /// Finds the resting place with contact at the present time; `dragged` are the hand-set support positions, m.
    ///
    /// # Errors
    /// A typed reason when there is none, or none was found.
    pub fn settle(&mut self, _dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        Err(refused())
    }

    /// Advances time.
    ///
    /// # Errors
    /// As `Mechanics::advance`.
    pub fn advance(
        &mut self,
        _dt_s: f64,
        _inertia: Inertia,
        _dragged: &[Option<Vec2>],
    ) -> Result<StepReport, SolveError> {
        Err(refused())
    }

    /// Takes over a state (from statics: at rest).
    ///
    /// # Errors
    /// When a number is not finite or the state does not fit the cable.
    pub fn adopt(&mut self, state: &State) -> Result<(), SolveError> {
        self.state = state.clone();
        Ok(())
    }

    /// Where the cable is.
    #[must_use]
    pub fn state(&self) -> State {
        self.state.clone()
    }

    /// The answer at this instant.
    #[must_use]
    pub fn solution(&self) -> CableSolution {
        CableSolution::default()
    }
}

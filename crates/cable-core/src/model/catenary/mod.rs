//! The `Catenary` model (placeholder: refuses everything).

use std::sync::Arc;

use super::{Inertia, Mechanics, Model, Settings, StepReport};
use crate::error::SolveError;
use crate::math::Vec2;
use crate::problem::Problem;
use crate::solution::CableSolution;
use crate::state::State;

/// The model's mechanics of one cable.
#[derive(Clone, Debug)]
pub struct CatenaryModel {
    problem: Arc<Problem>,
}

impl CatenaryModel {
    /// Builds it at the route.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs what the model lacks.
    pub fn new(problem: Arc<Problem>, _settings: Settings) -> Result<Self, SolveError> {
        Ok(Self { problem })
    }
}

impl Mechanics for CatenaryModel {
    fn model(&self) -> Model {
        Model::Catenary
    }
    fn settle(&mut self) -> Result<StepReport, SolveError> {
        Err(SolveError::Unsupported { model: Model::Catenary, feature: "not built yet".to_owned() })
    }
    fn advance(&mut self, _dt_s: f64, _inertia: Inertia) -> Result<StepReport, SolveError> {
        Err(SolveError::Unsupported { model: Model::Catenary, feature: "not built yet".to_owned() })
    }
    fn state(&self) -> State {
        State::default()
    }
    fn adopt(&mut self, _state: &State) -> Result<(), SolveError> {
        Ok(())
    }
    fn drag_support(&mut self, _support: usize, _target_m: Vec2) {}
    fn solution(&self) -> CableSolution {
        CableSolution::default()
    }
    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }
    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

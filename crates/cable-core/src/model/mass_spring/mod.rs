//! `mass_spring` is the model of lumped masses and springs: a preview of stiff cables, a second
//! opinion, and free motion whose energy must be kept. At equal error [`crate::model::fem`] is
//! cheaper (`docs/notes/choosing-models.md`).
//!
//! | room | what it holds |
//! |---|---|
//! | `settings` | the tuned constants |
//! | `mesh` | nodes, springs and pulleys; nodes that are added and removed beside pulleys |
//! | `forces` | springs, bending, weight, wind and loads; reactions of supports |
//! | `contact_memory` | the contacts of the last sub-step, and the anchors of friction |
//! | `preview_choice` | the choice of a dynamic step: explicit, or a preview |
//! | `dynamics` | one explicit sub-step: supports, sliding, impacts, momentum, limits, rollback |
//! | `xpbd` | the preview's sub-steps of compliant constraints |
//! | `equilibrium` | equilibria and steps without inertia |
//! | `chain_model` | all of these as one cable, which comes to rest and advances in time |
//! | `error_estimate` | errors beside `spans`, `fem` or a coarser mesh, at rest and without inertia |
//! | `results`, `corner_error` | the answer, and a bound of the error of tension beyond a corner |
//!
//! In the leapfrog scheme velocities are half a sub-step behind positions. The discretisation error
//! is of second order in the element; at equilibrium and without inertia it is estimated, in motion
//! only for corners.
//!
//! Sub-steps keep below the stability limit of a chain of springs, dt < 2/ω_max with ω_max =
//! 2√(EA(1 + Σ y)/(ρ l₀²)) (D. Baraff, A. Witkin, Physically based modeling, SIGGRAPH course notes,
//! 1997), in which no relaxation branch of the material's loss, of stiffness EA y each, relaxes; a
//! viscous loss of damping ratio ζ at that mode makes it 2/ω_max · (√(1+ζ²) − ζ). Equilibria
//! are found by Newton's method on the energy of springs, contacts and friction. They start from
//! the equilibrium of [`crate::model::fem`] if there is one, so both models select the same of the
//! many equilibria that a rough floor allows; the balance of forces is this model's own.

/// Declares a part of the model whose `clone_from` copies field by field into the memory of the
/// copy, so that a step stores the state before it without allocation.
macro_rules! part {
    ($(#[$doc:meta])* $name:ident { $($(#[$about:meta])* $field:ident: $kind:ty,)+ }) => {
        $(#[$doc])*
        #[derive(Debug)]
        pub(in crate::model::mass_spring) struct $name {
            $($(#[$about])* pub(in crate::model::mass_spring) $field: $kind,)+
        }

        impl Clone for $name {
            fn clone(&self) -> Self {
                Self { $($field: self.$field.clone(),)+ }
            }

            fn clone_from(&mut self, other: &Self) {
                $(self.$field.clone_from(&other.$field);)+
            }
        }
    };
}

mod chain_model;
mod contact_memory;
mod corner_error;
mod dynamics;
mod equilibrium;
mod error_estimate;
mod forces;
mod mesh;
mod preview_choice;
mod results;
mod settings;
mod xpbd;

use std::any::Any;
use std::sync::Arc;

use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::mass_spring::chain_model::ChainModel;
use crate::model::mass_spring::error_estimate::{CoarseMeshStart, Estimate};
use crate::model::tension_gauge::TensionGauge;
use crate::model::{Inertia, Mechanics, Model, Settings, StepReport};
use crate::problem::{Departure, Problem};
use crate::scene::SupportKind;
use crate::solution::CableSolution;
use crate::state::State;

pub use settings::{MeshTuning, PreviewTuning, SubStepTuning, Tuning};

/// The `mass-spring` model of one cable.
#[derive(Clone, Debug)]
pub struct MassSpringModel {
    cable: ChainModel,
    /// Errors, and what they are estimated beside.
    estimate: Estimate,
}

impl MassSpringModel {
    /// Builds the cable along its route.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs a feature that the model lacks.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        Self::with_tuning(problem, settings, Arc::new(Tuning::default()))
    }

    /// As [`Self::new`], with other tuned constants.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs a feature that the model lacks.
    pub fn with_tuning(problem: Arc<Problem>, settings: Settings, tuning: Arc<Tuning>) -> Result<Self, SolveError> {
        Ok(Self { cable: ChainModel::new(problem, settings, tuning)?, estimate: Estimate::default() })
    }
}

impl Mechanics for MassSpringModel {
    fn model(&self) -> Model {
        Model::MassSpring
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        let is_first = !self.cable.has_shape && self.cable.chain.clock.time_s == 0.0;
        self.cable.settle()?;
        let start = if is_first { CoarseMeshStart::Scene } else { CoarseMeshStart::Present };
        self.estimate = Estimate::at_rest(&self.cable, start);
        Ok(self.cable.step_report())
    }

    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        self.cable.advance(dt_s, inertia, gauge)?;
        let estimate = std::mem::take(&mut self.estimate);
        if inertia == Inertia::QuasiStatic {
            self.estimate = estimate.follow(&self.cable, dt_s);
        }
        Ok(self.cable.step_report())
    }

    fn state(&self) -> State {
        results::state(&self.cable.chain)
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.cable.set_state(state)?;
        self.estimate = Estimate::default();
        Ok(())
    }

    fn continuation(&self) -> Option<Box<dyn Any + Send>> {
        (self.time_s() > 0.0).then(|| Box::new(self.cable.clone()) as Box<dyn Any + Send>)
    }

    fn continue_from(&mut self, before: &(dyn Any + Send)) -> bool {
        let continues = before.downcast_ref().is_some_and(|before| self.cable.continue_from(before));
        if continues {
            self.estimate = Estimate::default();
        }
        continues
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        let drives = &mut self.cable.chain.drives;
        if target_m.iter().all(|c| c.is_finite())
            && let Some(d) = drives.targets.get_mut(support)
        {
            *d = Some(target_m);
            drives.by_spring[support] = false;
        }
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.drag_support(support, hand_m);
        let holds = |kind| matches!(kind, SupportKind::Fixed | SupportKind::Clamped);
        if self.problem().supports.get(support).is_some_and(|s| holds(s.kind)) {
            self.cable.chain.drives.by_spring[support] = true;
        }
    }

    fn change_wheels(&mut self, problem: Arc<Problem>) -> bool {
        let present = &mut self.cable.chain.mesh.problem;
        let left = |p: &Problem| p.supports.iter().filter(|s| s.departure == Departure::Done).count();
        let lets_go = left(&problem) > left(present);
        if lets_go {
            *present = problem;
        }
        lets_go
    }

    fn solution(&self) -> CableSolution {
        self.cable.answer(&self.estimate.errors)
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.cable.chain.mesh.problem
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests;

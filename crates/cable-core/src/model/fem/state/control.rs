//! The parts of a simulation beside the state of its cable: memory of the solver, hands, the
//! control of time, and rollback.

use crate::math::Vec2;
use crate::model::fem::newton::minimize::Workspace;
use crate::model::fem::newton::mixed_free::FreeStep;
use crate::model::fem::state::checkpoint::Checkpoint;
use crate::model::fem::state::stepping::{Sleep, StepSizeController};
use crate::model::fem::system::step_input::{Unknowns, WorkBudget};

/// The minimiser's memory; a copy of the model makes its own.
#[derive(Debug, Default)]
pub(in crate::model::fem) struct Memory(pub(in crate::model::fem) Option<Box<Workspace>>);

impl Clone for Memory {
    fn clone(&self) -> Self {
        Self(None)
    }
}

/// The memory in which a step is solved; it holds nothing of the state.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct SolverMemory {
    /// Room for the unknowns of a step.
    pub(in crate::model::fem) unknowns: Unknowns,
    /// Room of the solver in contact.
    pub(in crate::model::fem) memory: Memory,
    /// Room of the solver of a cable that touches nothing.
    pub(in crate::model::fem) free: FreeStep,
    /// Room for the part of each branch of the loss that a step leaves.
    pub(in crate::model::fem) decay: Vec<f64>,
    /// The work that the search for an equilibrium may still do.
    pub(in crate::model::fem) work_left: WorkBudget,
}

/// The hands that lead supports.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct HandDrive {
    /// Fastest hand, m/s.
    pub(in crate::model::fem) hand_speed: f64,
    /// Stiffness of its spring, N/m, where that was asked for.
    pub(in crate::model::fem) hand_stiffness: Option<f64>,
    /// True for dragged supports that a hand holds by a spring.
    pub(in crate::model::fem) pulled: Vec<bool>,
    /// Room for the points to which hands draw supports in a part of a step.
    pub(in crate::model::fem) aims: Vec<Option<Vec2>>,
}

/// The control of time.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct Pacing {
    /// The length of inner steps.
    pub(in crate::model::fem) pace: StepSizeController,
    /// The watch for a cable at rest.
    pub(in crate::model::fem) sleep: Sleep,
    /// Part of its frequency that a vibration may be off by.
    pub(in crate::model::fem) tolerance: f64,
    /// End of the present advance, s.
    pub(in crate::model::fem) due: f64,
}

/// The state to go back to where a step fails; a copy of the model saves its own.
#[derive(Debug, Default)]
pub(in crate::model::fem) struct Rollback {
    /// The last one that was saved, and its memory.
    pub(in crate::model::fem) saved: Option<Box<Checkpoint>>,
    /// True if it is of the present step.
    pub(in crate::model::fem) can_restore: bool,
}

impl Rollback {
    /// A copy with the state that is saved.
    pub(in crate::model::fem) fn with_saved(&self) -> Self {
        Self { saved: self.saved.clone(), can_restore: self.can_restore }
    }
}

impl Clone for Rollback {
    fn clone(&self) -> Self {
        Self::default()
    }
}

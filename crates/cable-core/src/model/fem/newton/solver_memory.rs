//! The memory in which a step is solved is kept from step to step, and holds nothing of the state.

use crate::model::fem::newton::minimize::Workspace;
use crate::model::fem::newton::mixed_free::MixedFreeSolver;
use crate::model::fem::system::{Unknowns, WorkBudget};

/// The minimiser's memory; a copy of the model makes its own.
#[derive(Debug, Default)]
pub(in crate::model::fem) struct WorkspaceMemory(pub(in crate::model::fem) Option<Box<Workspace>>);

impl Clone for WorkspaceMemory {
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
    pub(in crate::model::fem) memory: WorkspaceMemory,
    /// Room of the solver of a cable that touches nothing.
    pub(in crate::model::fem) free: MixedFreeSolver,
    /// Room for the part of each branch of the loss that a step leaves.
    pub(in crate::model::fem) decay: Vec<f64>,
    /// The work that the search for an equilibrium, or an advance, may still do.
    pub(in crate::model::fem) work_left: WorkBudget,
    /// The work that an advance may do.
    pub(in crate::model::fem) work_of_advance: WorkBudget,
}

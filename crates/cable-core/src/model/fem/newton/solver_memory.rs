//! The solver's working memory is kept from step to step and holds no state of the cable.

use crate::math::Vec2;
use crate::model::fem::newton::mixed_free::MixedFreeSolver;
use crate::model::fem::newton::step_potential::Workspace;
use crate::model::fem::system::{Unknowns, WorkBudget};

/// The minimiser's working memory; a copy of the model allocates its own.
#[derive(Debug, Default)]
pub(in crate::model::fem) struct WorkspaceMemory(pub(in crate::model::fem) Option<Box<Workspace>>);

impl Clone for WorkspaceMemory {
    fn clone(&self) -> Self {
        Self(None)
    }
}

/// The working memory in which a step is solved; it holds no state of the cable.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct SolverMemory {
    /// The unknowns of a step.
    pub(in crate::model::fem) unknowns: Unknowns,
    /// Working memory of the solver in contact.
    pub(in crate::model::fem) memory: WorkspaceMemory,
    /// Working memory of the solver without contact.
    pub(in crate::model::fem) free: MixedFreeSolver,
    /// Fraction of the force of each relaxation branch that is left after a step.
    pub(in crate::model::fem) decay: Vec<f64>,
    /// The motion of the nodes in a step, for the energy account.
    pub(in crate::model::fem) ways: NodalWays,
    /// The work that the search for an equilibrium, or a call of `advance`, may still do.
    pub(in crate::model::fem) work_left: WorkBudget,
    /// The work that a call of `advance` may do.
    pub(in crate::model::fem) work_of_advance: WorkBudget,
}

/// The motion of the nodes in a step, from which the work of forces is computed.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct NodalWays {
    /// Displacement of each node in the step, m; until the step is solved, its position at the
    /// start.
    pub(in crate::model::fem) ways: Vec<Vec2>,
    /// Velocity of each node at the start, m/s.
    pub(in crate::model::fem) velocities: Vec<Vec2>,
    /// Force of the cable on each node that is held at the start, N.
    pub(in crate::model::fem) reaction: Vec<Vec2>,
}

impl NodalWays {
    /// Records the start of a step: positions (m), velocities (m/s) and support forces (N).
    pub(in crate::model::fem) fn begin(&mut self, places: &[Vec2], velocities: &[Vec2], reaction: &[Vec2]) {
        for (mine, of) in [(&mut self.ways, places), (&mut self.velocities, velocities), (&mut self.reaction, reaction)]
        {
            mine.clear();
            mine.extend_from_slice(of);
        }
    }

    /// Records the end of a step at new positions, m.
    pub(in crate::model::fem) fn end(&mut self, places: &[Vec2]) {
        self.ways.iter_mut().zip(places).for_each(|(way, at)| *way = at - *way);
    }
}

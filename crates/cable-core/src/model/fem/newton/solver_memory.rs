//! The memory in which a step is solved is kept from step to step, and holds nothing of the state.

use crate::math::Vec2;
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
    /// The motion of the nodes in a step, for the energy account.
    pub(in crate::model::fem) ways: NodalWays,
    /// The work that the search for an equilibrium, or an advance, may still do.
    pub(in crate::model::fem) work_left: WorkBudget,
    /// The work that an advance may do.
    pub(in crate::model::fem) work_of_advance: WorkBudget,
}

/// The motion of the nodes in a step, as the work of forces needs it.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct NodalWays {
    /// Way of each node, m; before the step is balanced its place at the start.
    pub(in crate::model::fem) ways: Vec<Vec2>,
    /// Velocity of each node at the start, m/s.
    pub(in crate::model::fem) velocities: Vec<Vec2>,
    /// Force of the cable on each node that is held at the start, N.
    pub(in crate::model::fem) reaction: Vec<Vec2>,
}

impl NodalWays {
    /// A step of a cable begins that is at places (m) and has velocities (m/s) and forces on what
    /// holds it (N).
    pub(in crate::model::fem) fn begin(&mut self, places: &[Vec2], velocities: &[Vec2], reaction: &[Vec2]) {
        for (mine, of) in [(&mut self.ways, places), (&mut self.velocities, velocities), (&mut self.reaction, reaction)]
        {
            mine.clear();
            mine.extend_from_slice(of);
        }
    }

    /// It ends at other places, m.
    pub(in crate::model::fem) fn end(&mut self, places: &[Vec2]) {
        self.ways.iter_mut().zip(places).for_each(|(way, at)| *way = at - *way);
    }
}

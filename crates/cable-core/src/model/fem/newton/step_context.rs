//! The step context is what every part of the solve of one step reads.

use crate::math::larger;
use crate::model::fem::system::assembly::Mesh;
use crate::model::fem::system::friction_state::ContactSet;
use crate::model::fem::system::step_input::StepInput;
use crate::problem::Problem;

/// The input of the solve of a step: cable, mesh, contacts, and the input of the step.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct StepContext<'a> {
    /// The cable and its obstacles.
    pub problem: &'a Problem,
    /// Its nodes and bars.
    pub mesh: &'a Mesh,
    /// The barrier, and friction as it is frozen for the step.
    pub contacts: &'a ContactSet,
    /// Forces, inertia and targets of the step.
    pub input: &'a StepInput,
}

/// Longest move of a node in a step, m.
pub(in crate::model::fem) fn longest(step: &[f64]) -> f64 {
    step.chunks_exact(2).map(|d| d[0] * d[0] + d[1] * d[1]).fold(0.0, larger).sqrt()
}

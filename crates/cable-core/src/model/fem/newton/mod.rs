//! These modules solve one step: the choice of the solver, three Newton methods, their step bounds,
//! and their memory.
//!
//! | room | content |
//! |---|---|
//! | `step_solver.rs` | choice of free or contact solver; rounds until friction and forces agree |
//! | `step_potential.rs` | potential of a step with gradient and Hessian; unbalanced force, round-off |
//! | `minimize.rs` | minimiser of the step energy: banded Newton, line search, no crossing |
//! | `mixed_contact.rs` | Newton's method in contact with bar forces as unknowns, no line search |
//! | `mixed_iterate.rs` | bar forces and friction branches that the iteration in contact carries |
//! | `mixed_free.rs` | Newton's method without contact, with bar forces as unknowns |
//! | `active_set.rs` | contacts predicted ahead of a Newton step, as constraints of the step |
//! | `gap_constraint.rs` | one such constraint: linearised gap, second-order correction, stiff spring |
//! | `step_bound.rs` | longest collision-free part of a step (continuous collision detection) |
//! | `solver_memory.rs` | workspaces kept from step to step, without any state |

pub(in crate::model::fem) mod active_set;
pub(in crate::model::fem) mod gap_constraint;
pub(in crate::model::fem) mod minimize;
pub(in crate::model::fem) mod mixed_contact;
pub(in crate::model::fem) mod mixed_free;
pub(in crate::model::fem) mod mixed_iterate;
pub(in crate::model::fem) mod solver_memory;
pub(in crate::model::fem) mod step_bound;
pub mod step_potential;
pub(in crate::model::fem) mod step_solver;

pub(in crate::model::fem) use mixed_free::MixedFreeSolver;
pub(in crate::model::fem) use solver_memory::{NodalWays, SolverMemory, WorkspaceMemory};
pub(in crate::model::fem) use step_potential::Workspace;

//! These modules hold the input of one step and assemble its energies into value, gradient and
//! banded Hessian.
//!
//! | room | content |
//! |---|---|
//! | `step_input.rs` | input of a step (loads, inertia, tolerances), its unknowns and its outcome |
//! | `mesh.rs` | `Mesh`: nodes, bars, clamps, sliding nodes, masses and stiffnesses |
//! | `step_context.rs` | problem, mesh, contacts and input together, as every solver reads them |
//! | `assembly.rs` | energy, gradient and banded Hessian of the whole mesh; held nodes pinned |
//! | `bar_energy.rs` | energy of a bar: stretching, damping, weight carried over sliding nodes |
//! | `bar_weight.rs` | weight of a bar partly on a round, at the centroid of its path |
//! | `mass.rs` | mean of lumped and consistent mass matrix, fourth order in the frequencies |
//! | `loss_branches.rs` | generalised Maxwell branches of a loss factor constant over frequency |
//! | `contact/` | contacts in a step: search, barrier, friction and its memory, self-contact |

pub(in crate::model::fem) mod assembly;
pub(in crate::model::fem) mod bar_energy;
pub(in crate::model::fem) mod bar_weight;
pub(in crate::model::fem) mod contact;
pub(in crate::model::fem) mod loss_branches;
pub(in crate::model::fem) mod mass;
pub(in crate::model::fem) mod mesh;
pub(in crate::model::fem) mod step_context;
pub(in crate::model::fem) mod step_input;

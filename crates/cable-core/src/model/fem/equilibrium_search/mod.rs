//! These modules search for an equilibrium of the finite element model: by which solver, from which
//! start, on which mesh.
//!
//! | room | content |
//! |---|---|
//! | `solver_choice.rs` | the order in which solvers and starts are tried, and the checks of what they find |
//! | `easier_start.rs` | starts: the answer of `spans`, or an equilibrium under eased loads |
//! | `stiff_equilibrium.rs` | a stiff cable in contact, handed to `elastica` |
//! | `mesh_error.rs` | errors of the mesh beside `spans` or other meshes, and its refinement |

mod easier_start;
mod mesh_error;
mod solver_choice;
mod stiff_equilibrium;

pub(in crate::model::fem) use mesh_error::{MeshRefinement, TwoMeshes};

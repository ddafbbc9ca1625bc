//! These modules hold the nodes and springs of a cable, with the pulleys that it runs over.
//!
//! | room | content |
//! |---|---|
//! | `cable_mesh.rs` | `Mesh`: nodes and springs with masses and lengths, its construction |
//! | `node_placement.rs` | node arc lengths between supports and loads, and the first shape |
//! | `pulley.rs` | node fixed in space with sliding material σ; wheel arcs, element geometry |
//! | `edit.rs` | nodes inserted and removed beside pulleys; pulleys that let go become nodes |
//! | `relaxation_memory.rs` | forces in the relaxation branches of springs, moments in those of bends |

pub(in crate::model::mass_spring) mod cable_mesh;
pub(in crate::model::mass_spring) mod edit;
pub(in crate::model::mass_spring) mod node_placement;
pub(in crate::model::mass_spring) mod pulley;
mod relaxation_memory;

pub(in crate::model::mass_spring) use cable_mesh::Mesh;
pub(in crate::model::mass_spring) use edit::{even_out, least_straight_length, lifted_wheel, release_pulleys, remesh};
pub(in crate::model::mass_spring) use node_placement::first_support_arc_lengths;
pub(in crate::model::mass_spring) use pulley::{ElementGeometry, Pulley, angle_of, principal_angle};
pub(in crate::model::mass_spring) use relaxation_memory::RelaxationMemory;

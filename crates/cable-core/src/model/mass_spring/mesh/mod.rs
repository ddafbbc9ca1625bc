//! These modules hold the nodes and springs of a cable, with the pulleys that it runs over.

pub(in crate::model::mass_spring) mod cable_mesh;
pub(in crate::model::mass_spring) mod edit;
pub(in crate::model::mass_spring) mod node_placement;
pub(in crate::model::mass_spring) mod pulley;
mod spring_damping;

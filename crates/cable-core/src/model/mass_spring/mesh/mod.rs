//! These modules hold the nodes and springs of a cable, with the pulleys that it runs over.

pub(in crate::model::mass_spring) mod edit;
pub(in crate::model::mass_spring) mod nodes;
pub(in crate::model::mass_spring) mod pulley;

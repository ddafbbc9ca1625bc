//! These modules slide material through pulleys and edit the chain beside them.

pub(in crate::model::mass_spring) mod mesh_edit;
pub(in crate::model::mass_spring) mod pulley;

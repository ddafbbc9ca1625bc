//! These modules find the equilibrium of a stiff cable that touches nothing but its supports.

pub(in crate::model::fem) mod equilibrium;
pub(in crate::model::fem) mod mesh;
pub(in crate::model::fem) mod other_bows;
pub(in crate::model::fem) mod refinement;
pub(in crate::model::fem) mod results;

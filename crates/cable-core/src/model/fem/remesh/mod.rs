//! These modules change the nodes and bars of a cable between steps.

pub(in crate::model::fem) mod adapt;
pub(in crate::model::fem) mod arc_marks;
pub(in crate::model::fem) mod edit;
mod edit_criteria;

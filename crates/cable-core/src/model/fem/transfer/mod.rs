//! These modules continue from the state or the answer of another mesh or model.

pub(in crate::model::fem) mod from_solution;
pub(in crate::model::fem) mod from_state;

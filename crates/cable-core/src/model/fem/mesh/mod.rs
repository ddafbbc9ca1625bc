//! These modules hold the nodes and bars of one cable and change them between steps.

pub(in crate::model::fem) mod adapt;
pub(in crate::model::fem) mod arc_nodes;
pub(in crate::model::fem) mod edit;
pub(in crate::model::fem) mod sliding_node;
pub(in crate::model::fem) mod tangent_path;

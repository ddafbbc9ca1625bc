//! These modules hold the number of bars of a cable, its sliding nodes, and the paths of bars round
//! what these slide over.

pub(in crate::model::fem) mod bar_count;
pub(in crate::model::fem) mod sliding_node;
pub(in crate::model::fem) mod tangent_path;

//! These modules hold the sliding nodes of a cable and the paths of its bars round what they slide
//! over.

pub(in crate::model::fem) mod sliding_node;
pub(in crate::model::fem) mod tangent_path;

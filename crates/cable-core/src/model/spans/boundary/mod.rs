//! These modules describe the boundary of an obstacle and the tension of a cable that slides along
//! it.

pub(in crate::model::spans) mod arc;
pub(in crate::model::spans) mod capstan;
pub(in crate::model::spans) mod curve;
pub(in crate::model::spans) mod segment_cursor;

//! These modules describe the boundary of an obstacle, the tension of a cable that slides along it
//! and is remembered there, and cable that lies loose on it.

pub(in crate::model::spans) mod arc;
pub(in crate::model::spans) mod capstan;
pub(in crate::model::spans) mod curve;
pub(in crate::model::spans) mod friction_memory;
pub(in crate::model::spans) mod loose;
pub(in crate::model::spans) mod segment_cursor;

//! This module finds bracketed roots.
//!
//! | room | content |
//! |---|---|
//! | `root.rs` | root of one variable: Newton's method safeguarded by a bracket |

pub(in crate::model::spans) mod root;

pub(in crate::model::spans) use root::{TENSION_ROUNDING, crossing};

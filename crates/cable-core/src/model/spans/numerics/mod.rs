//! These modules solve banded linear systems and find bracketed roots.

pub(in crate::model::spans) mod band_lu;
pub(in crate::model::spans) mod root;

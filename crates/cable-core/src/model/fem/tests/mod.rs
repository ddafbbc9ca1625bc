//! These tests draw and drop cables against closed forms.

pub(in crate::model::fem) mod contact;
pub(in crate::model::fem) mod sliding;

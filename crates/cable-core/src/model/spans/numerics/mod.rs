//! These modules solve banded linear systems and find bracketed roots.
//!
//! | room | content |
//! |---|---|
//! | `band_lu.rs` | LU factorisation of a band matrix with partial pivoting |
//! | `root.rs` | root of one variable: Newton's method safeguarded by a bracket |

pub(in crate::model::spans) mod band_lu;
pub(in crate::model::spans) mod root;

//! These modules draw the panel of warnings.
//!
//! - `list`: the warnings as rows, the worst of them above the readouts, and their number
//! - `figures`: the numbers of a warning, and its title where there is little room

mod figures;
mod list;

pub use list::{has_more, places, summary, ui, worst, worst_in_strip};

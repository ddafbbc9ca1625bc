//! This wing writes numbers with their unit and reads them back; values are SI everywhere else.
//!
//! - `unit`: a unit, its size and what may be typed instead
//! - `system`: SI or US, and which unit of it stands for which
//! - `format`: figures with four digits, for panels and graphs
//! - `labels`: figures with three digits, for the canvas
//! - `parse`: typed text as a number
//! - `sentence`: sentences of the solver in the units on screen

pub mod format;
pub mod labels;
pub mod parse;
pub mod sentence;
pub mod system;
pub mod unit;

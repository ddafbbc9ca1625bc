//! These modules hold the state of a cable in motion, of which `dynamics` is made.

pub(in crate::model::fem) mod account;
pub(in crate::model::fem) mod cable;
pub(in crate::model::fem) mod control;
pub(in crate::model::fem) mod history;
pub(in crate::model::fem) mod moving_outline;
pub(in crate::model::fem) mod stepping;

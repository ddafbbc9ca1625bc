//! These modules hold the state of a cable in motion in its parts, what controls it, and the setup
//! of a step.

pub(in crate::model::fem) mod account;
pub(in crate::model::fem) mod cable;
pub(in crate::model::fem) mod checkpoint;
pub(in crate::model::fem) mod control;
pub(in crate::model::fem) mod fold_imperfection;
pub(in crate::model::fem) mod meshing;
pub(in crate::model::fem) mod momentum;
pub(in crate::model::fem) mod motion;
pub(in crate::model::fem) mod moving_outline;
pub(in crate::model::fem) mod step_setup;
pub(in crate::model::fem) mod stepping;
pub(in crate::model::fem) mod stick_slip;
pub(in crate::model::fem) mod support_stop;

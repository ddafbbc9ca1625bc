//! These modules hold the state of a cable in motion in its parts, and set up a step from it.

pub(in crate::model::fem) mod cable;
pub(in crate::model::fem) mod fold_imperfection;
pub(in crate::model::fem) mod meshing;
pub(in crate::model::fem) mod momentum_account;
pub(in crate::model::fem) mod motion;
pub(in crate::model::fem) mod moving_mass;
pub(in crate::model::fem) mod outline_path;
pub(in crate::model::fem) mod step_setup;
pub(in crate::model::fem) mod stick_slip;
pub(in crate::model::fem) mod support_stop;

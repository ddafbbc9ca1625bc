//! These modules hold the input of one step and assemble its energies into value, gradient and
//! banded Hessian.

pub(in crate::model::fem) mod assembly;
pub(in crate::model::fem) mod bar_energy;
pub(in crate::model::fem) mod bar_weight;
pub(in crate::model::fem) mod contact;
pub(in crate::model::fem) mod loss_branches;
pub mod mass;
pub(in crate::model::fem) mod mesh;
pub(in crate::model::fem) mod step_context;
pub(in crate::model::fem) mod step_input;

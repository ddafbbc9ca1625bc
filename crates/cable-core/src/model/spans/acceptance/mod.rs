//! These modules check an answer without the solver: equilibrium, clearance, penetration and
//! tunnelling.

pub(in crate::model::spans) mod clearance;
pub(in crate::model::spans) mod equilibrium;
pub(in crate::model::spans) mod penetration;
pub(in crate::model::spans) mod tension_loss;
pub(in crate::model::spans) mod tunnelling;

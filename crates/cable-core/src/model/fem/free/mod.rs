//! These modules find the equilibrium of a cable that touches nothing but its supports; `beam` that
//! of a stiff one.

pub(in crate::model::fem) mod beam;
pub(in crate::model::fem) mod dual_weighted_residual;
pub mod element;
pub(in crate::model::fem) mod pulley_balance;
pub(in crate::model::fem) mod pulley_friction;
pub(in crate::model::fem) mod pulley_state;
pub(in crate::model::fem) mod pulley_wheels;
pub(in crate::model::fem) mod results;
pub(in crate::model::fem) mod span;
pub mod statics;
pub(in crate::model::fem) mod stations;

//! These modules find the equilibrium of a cable that touches nothing but its supports; `beam` that
//! of a stiff one.

pub(in crate::model::fem) mod beam;
pub(in crate::model::fem) mod dual_weighted_residual;
pub mod element;
pub(in crate::model::fem) mod failure_report;
pub(in crate::model::fem) mod pulley_balance;
pub(in crate::model::fem) mod pulley_state;
pub(in crate::model::fem) mod results;
pub(in crate::model::fem) mod span;
pub mod statics;
pub(in crate::model::fem) mod stations;
pub(in crate::model::fem) mod straight_route;
pub(in crate::model::fem) mod weight_hint;
pub(in crate::model::fem) mod wheel_arcs;
pub(in crate::model::fem) mod wheel_friction_memory;
pub(in crate::model::fem) mod wheel_friction_newton;

//! These modules integrate in time: BDF2, step sizes, sleep, hands, momentum, loss and impacts.

pub(in crate::model::fem) mod bdf2;
pub(in crate::model::fem) mod checkpoint;
pub(in crate::model::fem) mod hands;
pub(in crate::model::fem) mod loss_memory;
pub(in crate::model::fem) mod momentum;
pub(in crate::model::fem) mod plastic_impact;
pub(in crate::model::fem) mod sleeping;
pub(in crate::model::fem) mod step_size;
pub(in crate::model::fem) mod step_solver;

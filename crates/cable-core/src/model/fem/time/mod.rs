//! These modules integrate in time: BDF2, step sizes, sleep, hands, impulses, loss, impacts, and
//! the return to the state before a step that failed.

pub(in crate::model::fem) mod bdf2;
pub(in crate::model::fem) mod hands;
pub(in crate::model::fem) mod loss_memory;
pub(in crate::model::fem) mod plastic_impact;
pub(in crate::model::fem) mod rollback;
pub(in crate::model::fem) mod sleeping;
pub(in crate::model::fem) mod step_impulses;
pub(in crate::model::fem) mod step_size;
pub(in crate::model::fem) mod step_solver;
pub(in crate::model::fem) mod time_control;

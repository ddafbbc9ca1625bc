//! These modules integrate in time: BDF2, its history, step sizes, sleep, hands and momentum.

pub(in crate::model::fem) mod bdf2;
pub(in crate::model::fem) mod hands;
pub(in crate::model::fem) mod history;
pub(in crate::model::fem) mod momentum;
pub(in crate::model::fem) mod sleeping;
pub(in crate::model::fem) mod step_size;

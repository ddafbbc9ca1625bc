//! The control of time chooses the length of inner steps and puts a cable at rest to sleep.

use crate::model::fem::time::sleeping::Sleep;
use crate::model::fem::time::step_size::StepSizeController;

/// The control of time.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct TimeControl {
    /// The length of inner steps.
    pub(in crate::model::fem) step_size: StepSizeController,
    /// The watch for a cable at rest.
    pub(in crate::model::fem) sleep: Sleep,
    /// Part of its frequency that a vibration may be off by.
    pub(in crate::model::fem) tolerance: f64,
    /// End of the present advance, s.
    pub(in crate::model::fem) due: f64,
}

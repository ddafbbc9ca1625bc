//! The time control chooses the length of inner steps and puts a cable at rest to sleep.

use crate::model::fem::time::sleeping::Sleep;
use crate::model::fem::time::step_size::StepSizeController;

/// The data of the time control.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct TimeControl {
    /// The length of inner steps.
    pub(in crate::model::fem) step_size: StepSizeController,
    /// The detector of a cable at rest.
    pub(in crate::model::fem) sleep: Sleep,
    /// Relative error of frequency that a vibration may have.
    pub(in crate::model::fem) tolerance: f64,
    /// End of the present `advance`, s.
    pub(in crate::model::fem) due: f64,
}

//! The solver part is what the worker is asked for, and how it is doing.

use cable_core::{Model, Settings};

/// The settings that the worker is asked for, and its state.
#[derive(Clone, Debug)]
pub struct Solver {
    /// The model asked for.
    pub model: Model,
    /// Mesh and accuracy asked for.
    pub settings: Settings,
    /// The state of the solver thread.
    pub status: WorkerStatus,
    /// Number of the last edit sent to the worker.
    pub edits_sent: u64,
    /// Time from the last edit to the first picture that shows it, s.
    pub edit_latency_s: Option<f64>,
    /// Time for which an answer has been sought, s; None: nothing is asked for.
    pub solving_s: Option<f64>,
    /// A support dragged farther than the cable reaches while time runs is pulled, not refused.
    pub pulls_past_length: bool,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            model: Model::Auto,
            settings: Settings::default(),
            status: WorkerStatus::Idle,
            edits_sent: 0,
            edit_latency_s: None,
            solving_s: None,
            pulls_past_length: false,
        }
    }
}

/// The state of the solver thread.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum WorkerStatus {
    /// Waiting for work.
    #[default]
    Idle,
    /// Working on an edit.
    Busy,
    /// Gone, with what it said last.
    Dead(String),
}

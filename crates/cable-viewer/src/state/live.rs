//! The live part is what the worker answered, and what is on screen of it.

use std::sync::Arc;

use cable_core::timeline::RunPeaks;
use cable_core::{Scene, Solution};

/// Whether and how fast time runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Time stands still.
    pub paused: bool,
    /// Simulated seconds per second, 0.01 to 4.
    pub speed: f64,
}

impl Playback {
    /// Slowest speed factor.
    pub const MIN_SPEED: f64 = 0.01;
    /// Fastest speed factor.
    pub const MAX_SPEED: f64 = 4.0;
}

/// The latest answer of the worker.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// The scene it answers, as it was then.
    pub scene: Option<Arc<Scene>>,
    /// The last good answer.
    pub solution: Option<Arc<Solution>>,
    /// The greatest tensions of each cable in the run so far; empty where it is not known from its start.
    pub peaks: Vec<RunPeaks>,
    /// Wall time of the solve or of the steps it took, s.
    pub solve_wall_s: f64,
    /// Why the present scene has no answer.
    pub error: Option<String>,
    /// `solution` is not of the present scene (it failed, or is still being solved).
    pub stale: bool,
    /// `solution` has few segments, to follow the hand; the answer comes once the hand rests.
    pub draft: bool,
    /// Simulated seconds per second actually reached; None while paused.
    pub real_speed: Option<f64>,
    /// Number of the last edit it includes.
    pub edit: u64,
}

/// How the solver thread is doing.
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

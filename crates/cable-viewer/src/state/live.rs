//! The live part is what the worker answered, and what is on screen of it.

use std::sync::Arc;

use cable_core::timeline::RunPeaks;
use cable_core::wording::Sentence;
use cable_core::{Error, Scene, Solution, UnitSystem};

use crate::record::recording::Recording;
use crate::record::samples::{History, Sample};

/// What the worker answered, and how time runs.
#[derive(Debug)]
pub struct Live {
    /// Whether and how fast time runs.
    pub playback: Playback,
    /// The answer on screen: the latest, or an earlier one of the recording.
    pub snapshot: Snapshot,
    /// The latest answer.
    pub latest: Snapshot,
    /// Every answer since the last start, and which of them is on screen.
    pub recording: Recording,
    /// Tension and reactions against time since the last start.
    pub history: History,
    /// Instants of a run that was opened, to be recorded once its scene is solved.
    pub reopened_run: Vec<Solution>,
    /// What was recorded before the last reset, until the next one or another scene.
    pub before_reset: Option<Box<BeforeReset>>,
    /// The reset is the last thing that was done: undo takes it back.
    pub reset_is_last: bool,
    /// The next history that restarts is that of a reset.
    pub resets: bool,
    /// Speed of the robot by hand, m/s, positive to the right; None: it follows its path.
    pub robot_order: Option<f64>,
    /// Speed the robot is driven with by hand, m/s; None: its greatest.
    pub robot_speed: Option<f64>,
}

impl Default for Live {
    fn default() -> Self {
        Self {
            playback: Playback { paused: true, speed: 1.0 },
            snapshot: Snapshot::default(),
            latest: Snapshot::default(),
            recording: Recording::default(),
            history: History::default(),
            reopened_run: Vec::new(),
            before_reset: None,
            reset_is_last: false,
            resets: false,
            robot_order: None,
            robot_speed: None,
        }
    }
}

impl Live {
    /// Takes in the latest answer, which is on screen unless an earlier one is.
    pub fn receive(&mut self, snapshot: Snapshot) {
        self.latest = snapshot;
        self.refresh();
    }

    /// Begins recording anew; what a reset ends is kept.
    pub fn restart_history(&mut self) {
        let (recording, history) = (std::mem::take(&mut self.recording), std::mem::take(&mut self.history));
        self.recording.looped = recording.looped;
        let moved = recording.span_s().is_some_and(|[first, last]| last > first);
        if !std::mem::take(&mut self.resets) {
            self.before_reset = None;
        } else if moved {
            self.before_reset = Some(Box::new(BeforeReset { recording, history }));
            self.reset_is_last = true;
        }
    }

    /// Puts back what was recorded before the last reset and shows its end; whether there was any.
    pub fn undo_reset(&mut self) -> bool {
        self.reset_is_last = false;
        let Some(before) = self.before_reset.take() else { return false };
        (self.recording, self.history) = (before.recording, before.history);
        let last_s = self.recording.span_s().map(|[_, last]| last);
        self.show_time(last_s);
        last_s.is_some()
    }

    /// Adds an instant to the recording and to the graphs.
    pub fn record(&mut self, answer: Solution) {
        self.history.push(Sample::of(&answer));
        self.recording.push(answer);
    }

    /// Shows an earlier time of the recording (s), or the present.
    pub fn show_time(&mut self, time_s: Option<f64>) {
        if self.recording.shown_s.is_some() || time_s.is_some() {
            self.recording.shown_s = time_s;
            self.refresh();
        }
    }

    /// Puts what is to be shown on screen.
    pub fn refresh(&mut self) {
        self.snapshot = self.latest.clone();
        if let Some(shown) = self.recording.displayed() {
            self.snapshot.solution = Some(shown);
            self.snapshot.real_speed = None;
        }
    }

    /// The latest time of the run, s.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.latest.solution.as_ref().map_or(0.0, |s| s.time_s)
    }
}

/// What was recorded before a reset.
#[derive(Debug)]
pub struct BeforeReset {
    recording: Recording,
    history: History,
}

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

/// Why a scene has no answer.
#[derive(Clone, Debug, PartialEq)]
pub enum NoAnswer {
    /// The model has none, or the scene cannot be solved.
    Error(Error),
    /// The user ended the search.
    Cancelled,
    /// The solver panicked.
    Panicked {
        /// The sentence as it was recorded.
        message: String,
    },
}

impl Sentence for NoAnswer {
    fn sentence(&self, units: UnitSystem) -> String {
        match self {
            Self::Error(e) => e.sentence(units),
            Self::Cancelled => "solving was cancelled".to_owned(),
            Self::Panicked { message } => format!(
                "the solver stopped by a fault of its own ({message}): the picture is the last good one; \
                 change the scene, choose another model, or reset"
            ),
        }
    }
}

impl std::fmt::Display for NoAnswer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.sentence(UnitSystem::Si))
    }
}

/// The latest answer of the worker.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// The scene it answers, as it was then.
    pub scene: Option<Arc<Scene>>,
    /// The last good answer.
    pub solution: Option<Arc<Solution>>,
    /// The greatest tensions of each cable in the run so far; empty where it is not known from its
    /// start.
    pub peaks: Vec<RunPeaks>,
    /// Wall time of the solve or of the steps it took, s.
    pub solve_wall_s: f64,
    /// Why the present scene has no answer.
    pub error: Option<NoAnswer>,
    /// `solution` is not of the present scene (it failed, or is still being solved).
    pub stale: bool,
    /// `solution` has few segments, to follow the hand; the answer comes once the hand rests.
    pub draft: bool,
    /// Simulated seconds per second actually reached; None while paused.
    pub real_speed: Option<f64>,
    /// Number of the last edit it includes.
    pub edit: u64,
}

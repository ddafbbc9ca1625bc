//! The live part is what the worker answered, and what is on screen of it.

use std::sync::Arc;

use cable_core::scene::SupportKind;
use cable_core::timeline::RunPeaks;
use cable_core::wording::Sentence;
use cable_core::{Error, Scene, Solution, UnitSystem};

use crate::record::recording::Recording;
use crate::record::sample::Sample;
use crate::record::sample_history::SampleHistory;
use crate::state::selection::Item;

/// A support that is farther than this from where it was has been moved since, m. Less: rounding
/// counts as moving.
pub const MIN_MOVE_M: f64 = 1e-6;

/// The answer of the worker, and how time runs.
#[derive(Debug, Default)]
pub struct Live {
    /// The playback: whether and how fast time runs.
    pub playback: Playback,
    /// The answer on screen: the latest, or an earlier one of the recording.
    pub snapshot: Snapshot,
    /// The latest answer.
    pub latest: Snapshot,
    /// Every answer since the last start, and which of them is on screen.
    pub recording: Recording,
    /// Tension and reactions against time since the last start.
    pub history: SampleHistory,
    /// Instants of a run that was opened, to be recorded once its scene is solved.
    pub reopened_run: Option<ReopenedRun>,
    /// The run that the last restart ended, until the next one or another scene; or the run since,
    /// where that restart was taken back.
    pub earlier_run: Option<Box<EarlierRun>>,
    /// The reset is the last thing that was done: undo takes it back.
    pub reset_is_last: bool,
    /// A reset whose answer has not come yet: the next history that restarts is its.
    pub reset_asked: Option<ResetOrigin>,
    /// The thing that was dragged, while time ran, to where a cable does not reach: time stands
    /// until a drag leads it back.
    pub stopped_by_drag: Option<Item>,
    /// Speed of the robot by hand, m/s, positive to the right; None: it follows its path.
    pub robot_speed_command: Option<f64>,
    /// Speed the robot is driven with by hand, m/s; None: its greatest.
    pub manual_robot_speed: Option<f64>,
}

impl Live {
    /// Takes in the latest answer, which is on screen unless an earlier one is.
    pub fn receive(&mut self, snapshot: Snapshot) {
        self.latest = snapshot;
        self.refresh();
    }

    /// Begins recording anew, for another scene or after a reset; what a reset ends is kept.
    pub fn restart_history(&mut self) {
        match self.reset_asked.take() {
            // A second reset finds nothing that has run, and the first can still be taken back.
            Some(origin) => self.reset_is_last |= self.end_run(RestartCause::Reset(origin)),
            None => {
                self.forget_run();
                self.earlier_run = None;
            }
        }
    }

    /// Puts the run so far away, if there is one, and begins recording anew; whether there was one.
    pub fn end_run(&mut self, cause: RestartCause) -> bool {
        let moved = self.has_run();
        let (recording, history) = self.forget_run();
        if moved {
            self.earlier_run = Some(Box::new(EarlierRun { recording, history, cause }));
        }
        moved
    }

    /// Begins recording anew; returns what was recorded.
    fn forget_run(&mut self) -> (Recording, SampleHistory) {
        let (recording, history) = (std::mem::take(&mut self.recording), std::mem::take(&mut self.history));
        self.recording.looped = recording.looped;
        (recording, history)
    }

    /// True if time has run since the last start.
    #[must_use]
    pub fn has_run(&self) -> bool {
        self.recording.span_s().is_some_and(|[first, last]| last > first)
    }

    /// Puts back what was recorded before the last restart and shows its end; returns what had
    /// ended it. What has run since is kept in its place. After an edit the end is that of the
    /// scene before it, while the cable was whole; after a reset it is the present, to which the
    /// worker goes back. `present`: the window as it is.
    pub fn undo_restart(&mut self, present: ResetOrigin) -> Option<RestartCause> {
        self.reset_is_last = false;
        let before = self.earlier_run.take()?;
        self.end_run(match before.cause {
            RestartCause::Reset(_) => RestartCause::Reset(present),
            RestartCause::Edit(_) => RestartCause::Edit(present.scene),
        });
        (self.recording, self.history) = (before.recording, before.history);
        match &before.cause {
            RestartCause::Edit(scene) => {
                let last_s = self.recording.span_s().map(|[_, last]| last);
                let of_scene = |a: &&Solution| a.cables.iter().all(|c| c.breaks.is_empty()) && supports_as_in(a, scene);
                let of_scene_s = self.recording.answers().iter().rev().find(of_scene).map(|a| a.time_s);
                self.show_time(of_scene_s.or(last_s));
            }
            RestartCause::Reset(_) => {
                self.latest.solution = self.recording.answers().last().map(|a| Arc::new(a.clone()));
                self.refresh();
            }
        }
        Some(before.cause)
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

/// The record of a run that was opened.
#[derive(Clone, Debug)]
pub struct ReopenedRun {
    /// Its instants, oldest first.
    pub answers: Vec<Solution>,
    /// Wall time that they took, s; None where it is not known.
    pub wall_time_s: Option<f64>,
}

/// A run that a restart ended.
#[derive(Debug)]
pub struct EarlierRun {
    recording: Recording,
    history: SampleHistory,
    /// The command that ended it.
    pub cause: RestartCause,
}

impl EarlierRun {
    /// The scene that it was of.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        match &self.cause {
            RestartCause::Reset(origin) => &origin.scene,
            RestartCause::Edit(scene) => scene,
        }
    }
}

/// The command that ended a run.
#[derive(Clone, Debug)]
pub enum RestartCause {
    /// A reset.
    Reset(ResetOrigin),
    /// An edit of this scene, after which nothing goes on from where the cable was.
    Edit(Scene),
}

/// The state of the window when a reset was asked for.
#[derive(Clone, Debug)]
pub struct ResetOrigin {
    /// The scene.
    pub scene: Scene,
    /// Speed of the robot by hand, m/s; None: along its path.
    pub robot_speed_command: Option<f64>,
}

/// Supports that stay where they are stand in an answer where the scene has them: the answer to the
/// first move of a drag has another place.
fn supports_as_in(answer: &Solution, scene: &Scene) -> bool {
    let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < MIN_MOVE_M;
    answer.cables.iter().zip(&scene.cables).all(|(then, cable)| {
        then.supports.iter().zip(&cable.supports).all(|(then, s)| {
            let fixed = s.kind == SupportKind::Fixed && s.motion.is_none();
            !fixed || s.at_m.is_none_or(|at| near(at, [then.x_m, then.y_m]))
        })
    })
}

/// The playback: whether and how fast time runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Time stands still.
    pub paused: bool,
    /// Simulated seconds per second, 0.01 to 4.
    pub speed: f64,
}

impl Default for Playback {
    fn default() -> Self {
        Self { paused: true, speed: 1.0 }
    }
}

impl Playback {
    /// Slowest speed factor.
    pub const MIN_SPEED: f64 = 0.01;
    /// Fastest speed factor.
    pub const MAX_SPEED: f64 = 4.0;
}

/// The reason why a scene has no answer.
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
    /// The reason why the present scene has no answer.
    pub error: Option<NoAnswer>,
    /// `solution` is not of the present scene (it failed, or is still being solved).
    pub stale: bool,
    /// `solution` has few segments, to follow the hand; the answer comes once the hand rests.
    pub draft: bool,
    /// `solution` says nothing yet of what other histories would have left: they are being sought.
    pub seeks_histories: bool,
    /// `solution` was in motion until the last edit, which brought it to rest.
    pub brought_to_rest: bool,
    /// Simulated seconds per second actually reached; None while paused.
    pub real_speed: Option<f64>,
    /// Number of the last edit it includes.
    pub edit: u64,
}

//! The engine owns the simulation, answers requests and steps time; it knows no threads.
//!
//! - `answer_edit`: the answer to an edit: a draft, a rest or a state that is carried over
//! - `motion`: frames of simulated time, and a hand that draws meanwhile
//! - `shown`: what the window gets of it

mod answer_edit;
mod motion;
mod shown;

use std::sync::Arc;
use std::time::Instant;

use cable_core::math::Point;
use cable_core::model::Inertia;
use cable_core::model::auto::Question;
use cable_core::timeline::{RunMonitor, RunPeaks};
use cable_core::{Error, Model, Scene, Simulation, Solution};

use crate::state::{NoAnswer, Playback, Snapshot};
use crate::worker::draft;
use crate::worker::request::{Edit, EditStart, Request, Resume};
use crate::worker::timing::FRAME_S;

/// The question to `auto` once time runs.
const MOTION: Question = Question::History(Inertia::Dynamic);

/// Owns the simulation.
#[derive(Debug)]
pub struct Engine {
    simulation: Option<Simulation>,
    /// The last edit, for rebuilding.
    edit: Option<Edit>,
    /// The state of `simulation` relative to the last edit.
    phase: Phase,
    /// The simulation that `auto` chose for rest, kept while one that can move has taken its place.
    before_motion: Option<Simulation>,
    playback: Playback,
    snapshot: Snapshot,
    /// The last answer that was no draft: what is shown of a scene that has none.
    last_answer: Option<LastAnswer>,
    /// Ways of cables that the scene is to keep, by the number of the cable: the last edit would
    /// have moved them through an obstacle.
    routes: Vec<(usize, Vec<Point>)>,
    answers: Vec<Solution>,
    /// The history starts again before the first of `answers`.
    history_restarts: bool,
    /// Speed of the robot by hand, m/s.
    robot_speed_command: Option<f64>,
    /// Drafts may be shown: there is a thread to replace them by the answer.
    drafts: bool,
    /// The figures of the run so far; None where it does not go on from a start that has settled:
    /// a change while time runs begins another.
    monitor: Option<RunMonitor>,
    /// The rest was laid without asking what other histories would have left, so that it is on
    /// screen sooner; [`Self::refine`] asks once the hand rests.
    histories_due: bool,
    /// Wall time of the last answer to an edit, s.
    solve_s: f64,
    /// Number of a drag while time runs that no frame shows yet.
    dragged: u64,
    /// Wall time of the last frame on the full mesh, s.
    frame_wall_s: f64,
    /// The support that a hand holds by a spring.
    hand: Option<Hand>,
}

/// The state of the simulation of an [`Engine`] relative to the last edit.
#[derive(Clone, Debug)]
enum Phase {
    /// The answer to the last edit, if there is any.
    Answer {
        /// The simulation, or `before_motion` if there is one, was settled from the present scene
        /// at t = 0: its `reset` is the start.
        start_kept: bool,
    },
    /// A draft of the last edit, with few segments; time stands still.
    Draft {
        /// It has not come to rest: it goes on falling frame by frame.
        settling: bool,
    },
    /// A coarse mesh that follows the hand while time runs.
    CoarseMotion {
        /// The time when the hand moved last.
        moved_at: Instant,
    },
    /// The answer to the scene before: the last edit has none, and time stands.
    Refused {
        /// Why.
        reason: NoAnswer,
    },
}

/// The last answer that was no draft.
#[derive(Clone, Debug)]
struct LastAnswer {
    scene: Option<Arc<Scene>>,
    solution: Arc<Solution>,
    peaks: Vec<RunPeaks>,
}

/// A hand that holds a support by a spring.
#[derive(Clone, Copy, Debug)]
struct Hand {
    /// Index of the cable.
    cable: usize,
    /// Index of the support.
    support: usize,
    /// The place where the hand is, m.
    at_m: Point,
}

/// A message to the window.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The latest answer.
    pub snapshot: Snapshot,
    /// Forget the history shown so far.
    pub history_restarts: bool,
    /// New answers; at most [`crate::worker::timing::MAX_ANSWERS`].
    pub answers: Vec<Solution>,
    /// Ways of cables (by number) that the scene of this answer is to keep.
    pub routes: Vec<(usize, Vec<Point>)>,
    /// The worker paused itself because a step failed.
    pub paused_itself: bool,
}

impl Default for Engine {
    fn default() -> Self {
        Self {
            simulation: None,
            edit: None,
            phase: Phase::Answer { start_kept: false },
            before_motion: None,
            playback: Playback { paused: true, speed: 1.0 },
            snapshot: Snapshot::default(),
            last_answer: None,
            routes: Vec::new(),
            answers: Vec::new(),
            robot_speed_command: None,
            history_restarts: false,
            drafts: false,
            monitor: None,
            histories_due: false,
            solve_s: 0.0,
            dragged: 0,
            frame_wall_s: 0.0,
            hand: None,
        }
    }
}

impl Engine {
    /// One that answers an edit of a slow scene with a draft first; [`Self::refine`] is to follow.
    #[must_use]
    pub fn with_drafts() -> Self {
        Self { drafts: true, ..Self::default() }
    }

    /// As it is now, to go on from where what follows is given up.
    #[must_use]
    pub fn checkpoint(&self) -> Self {
        Self {
            simulation: self.simulation.clone(),
            edit: self.edit.clone(),
            phase: self.phase.clone(),
            before_motion: self.before_motion.clone(),
            snapshot: self.snapshot.clone(),
            last_answer: self.last_answer.clone(),
            routes: self.routes.clone(),
            answers: self.answers.clone(),
            // Two coarser runs beside this one: they begin again with the next start.
            monitor: None,
            ..*self
        }
    }

    /// Returns whether a draft is shown.
    #[must_use]
    pub fn draft(&self) -> bool {
        matches!(self.phase, Phase::Draft { .. })
    }

    /// The last edit has no answer.
    fn refused(&self) -> bool {
        matches!(self.phase, Phase::Refused { .. })
    }

    /// A coarse mesh follows the hand.
    fn coarse(&self) -> bool {
        matches!(self.phase, Phase::CoarseMotion { .. })
    }

    /// Time runs.
    #[must_use]
    pub fn playing(&self) -> bool {
        !self.playback.paused && self.simulation.is_some() && !self.refused()
    }

    /// Does what is asked; returns what to show.
    pub fn handle(&mut self, request: Request) -> Report {
        if let Some(playback) = request.playback {
            self.playback = playback;
        }
        if let Some(order) = request.robot {
            self.robot_speed_command = order;
        }
        let began = Instant::now();
        let runs = !self.playback.paused;
        let resumed = request.resume.as_ref().map(|r| Arc::clone(&r.answer));
        let dragging = request.drag.is_some() && request.edit.is_none() && request.resume.is_none() && !request.reset;
        let mut solved = request.edit.is_some() || request.resume.is_some() || request.reset || request.steps > 0;
        let mut result = Ok(());
        if request.cancel {
            self.cancel(request.edit);
            solved = true;
        } else if let Some(edit) = request.edit {
            let stays = self.playback.paused && !request.reset && request.steps == 0;
            result =
                if stays && self.show_draft(&edit, request.came_during_solve) { Ok(()) } else { self.take_edit(edit) };
        } else if self.draft() && (request.reset || request.steps > 0 || !self.playback.paused) {
            // Time goes on from the answer, never from a draft of it.
            result = self.solve_draft();
            solved = true;
        }
        if let Some(resume) = request.resume {
            result = self.resume(*resume);
        }
        if let Some(drag) = request.drag {
            solved = true;
            result = result.and_then(|()| self.drag(drag));
        }
        if request.reset {
            result = result.and_then(|()| self.reset());
        }
        if !self.refused() {
            for _ in 0..request.steps {
                result = result.and_then(|()| self.step(FRAME_S));
            }
        }
        // Time must not run in a scene that is no longer the one on screen.
        let held_back = self.refused() && runs;
        self.playback.paused |= held_back;
        if dragging && self.playing() {
            // The next frame shows it, not this report.
            self.dragged = self.dragged.max(request.number);
            return self.report(held_back);
        }
        self.snapshot.edit = request.number.max(self.dragged).max(self.snapshot.edit);
        if solved {
            self.snapshot.solve_wall_s = began.elapsed().as_secs_f64();
            let resumed = resumed.filter(|_| result.is_ok() && request.steps == 0);
            self.show(result);
            if let Some(answer) = resumed {
                // No step was taken yet: what held the cable then is known from the recording only.
                self.answers.clear();
                self.answers.push((*answer).clone());
                self.snapshot.solution = Some(answer);
                self.keep_answer();
            }
        }
        self.report(held_back)
    }

    /// Returns whether a draft is shown that still moves.
    #[must_use]
    pub fn settling(&self) -> bool {
        matches!(self.phase, Phase::Draft { settling: true })
    }

    /// Lets a frame of a draft pass.
    pub fn settle_frame(&mut self) -> Report {
        let began = Instant::now();
        if let Some(simulation) = &mut self.simulation {
            // One that cannot go on stays as it is until the answer comes.
            self.phase = Phase::Draft { settling: draft::advance_frame(simulation).is_ok() };
        }
        self.snapshot.solve_wall_s = began.elapsed().as_secs_f64();
        self.show(Ok(()));
        self.report(false)
    }

    /// An answer at rest is shown whose other histories have not been sought yet.
    #[must_use]
    pub fn seeks_histories(&self) -> bool {
        let at_start = self.simulation.as_ref().is_some_and(|s| s.time_s() <= 0.0);
        let rests = self.playback.paused && matches!(self.phase, Phase::Answer { start_kept: true });
        self.histories_due && rests && at_start
    }

    /// Replaces a draft by the answer, or asks of an answer what other histories would have left.
    pub fn refine(&mut self) -> Report {
        if self.seeks_histories() {
            self.seek_histories();
            return self.report(false);
        }
        let began = Instant::now();
        let result = self.solve_draft();
        self.snapshot.solve_wall_s = began.elapsed().as_secs_f64();
        self.show(result);
        self.report(false)
    }

    /// The solver panicked: what it held cannot be trusted any more.
    pub fn abandon(&mut self, message: &str) -> Report {
        self.simulation = None;
        self.monitor = None;
        self.before_motion = None;
        if !self.refused() {
            self.phase = Phase::Answer { start_kept: false };
        }
        self.playback.paused = true;
        self.snapshot.error = Some(NoAnswer::Panicked { message: message.to_owned() });
        self.snapshot.stale = true;
        self.report(true)
    }

    /// The scene stays without an answer.
    fn cancel(&mut self, edit: Option<Edit>) {
        if let Some(edit) = edit {
            self.history_restarts |= edit.start == EditStart::NewScene;
            self.edit = Some(edit);
        }
        self.phase = Phase::Refused { reason: NoAnswer::Cancelled };
        self.playback.paused = true;
    }

    /// Goes on from an earlier answer.
    fn resume(&mut self, resume: Resume) -> Result<(), Error> {
        let Resume { edit, answer } = resume;
        let mut then = Simulation::for_question(edit.scene.clone(), edit.model, edit.settings, MOTION)?;
        then.resume(&answer)?;
        self.simulation = Some(then);
        self.monitor = None;
        self.before_motion = None;
        self.histories_due = false;
        self.edit = Some(edit);
        self.phase = Phase::Answer { start_kept: false };
        self.hand = None;
        self.sample();
        Ok(())
    }

    fn reset(&mut self) -> Result<(), Error> {
        self.history_restarts = true;
        if self.coarse() {
            self.phase = Phase::Answer { start_kept: false };
        }
        self.answers.clear();
        (self.monitor, self.hand) = (None, None);
        // At the start already: lay the cable anew, which forgets the friction of edits since.
        if matches!(self.phase, Phase::Answer { start_kept: true })
            && let Some(simulation) = &mut self.simulation
            && simulation.time_s() > 0.0
        {
            if let Some(start) = self.before_motion.take() {
                *simulation = start;
            }
            simulation.reset();
        } else if let Some(edit) = self.edit.clone() {
            let mut edit = edit;
            self.histories_due = self.drafts && edit.settings.histories;
            self.simulation = Some(self.settle_edit(&mut edit, None)?);
            self.before_motion = None;
            self.phase = Phase::Answer { start_kept: true };
        }
        self.sample();
        Ok(())
    }
}

/// Returns whether a model that was asked for by name lets time run without inertia: it has none.
#[must_use]
pub fn is_quasi_static(model: Model) -> bool {
    !model.capabilities().inertia
}

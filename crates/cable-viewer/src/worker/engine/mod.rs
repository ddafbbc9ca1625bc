//! The engine owns the simulation, answers requests and steps time; it knows no threads.
//!
//! - `answer_edit`: the answer to an edit: a draft, a rest or a state that is carried over
//! - `motion`: frames of simulated time, and a hand that draws meanwhile
//! - `outbox`: what waits for the window
//! - `reset`: the simulation taken back to its start, and back again
//! - `run`: the simulation in time, with its start, its whole steps and what is known of it
//! - `snapshot`: what of the engine's state goes there

mod answer_edit;
mod motion;
pub(super) mod outbox;
mod reset;
mod run;
mod snapshot;

use std::sync::Arc;
use std::time::Instant;

use cable_core::math::Point;
use cable_core::{Error, Simulation};

use self::outbox::Outbox;
pub use self::outbox::Report;
pub use self::run::is_quasi_static;
use self::run::{MOTION, Run, RunStart};
use crate::state::{NoAnswer, Playback, Snapshot};
use crate::worker::draft;
use crate::worker::request::{Edit, EditStart, Request, Resume};
use crate::worker::timing::FRAME_S;

/// Owns the simulation.
#[derive(Debug, Default)]
pub struct Engine {
    run: Option<Run>,
    /// The last edit, for rebuilding.
    edit: Option<Edit>,
    /// The run that the last reset ended, until another scene: the reset can be taken back.
    ended_run: Option<Box<EndedRun>>,
    /// The state of `run` relative to the last edit.
    phase: Phase,
    playback: Playback,
    steering: Steering,
    refinement: AnswerRefinement,
    wall_times: WallTimes,
    outbox: Outbox,
}

/// The state of the simulation of an [`Engine`] relative to the last edit.
#[derive(Clone, Debug, Default)]
enum Phase {
    /// The answer to the last edit, if there is any.
    #[default]
    Answer,
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

/// A run that a reset ended, as it was on screen.
#[derive(Debug)]
struct EndedRun {
    run: Run,
    edit: Option<Edit>,
    phase: Phase,
    snapshot: Snapshot,
}

impl EndedRun {
    /// A copy to go back to.
    fn checkpoint(&self) -> Self {
        Self {
            run: self.run.checkpoint(),
            edit: self.edit.clone(),
            phase: self.phase.clone(),
            snapshot: self.snapshot.clone(),
        }
    }
}

/// The requests of hands and of the robot's remote control.
#[derive(Clone, Copy, Debug, Default)]
struct Steering {
    /// The support that a hand holds by a spring.
    hand: Option<HeldSupport>,
    /// Number of a drag while time runs that no frame shows yet.
    drag_number: u64,
    /// Speed of the robot by hand, m/s.
    robot_speed_command: Option<f64>,
}

/// The instant when an answer is what it comes to in the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum AnswerRefinement {
    /// At once: nobody would replace a draft.
    #[default]
    AtOnce,
    /// Once the hand rests, by [`Engine::refine`]: drafts may be shown until then.
    Later {
        /// The rest was laid without asking what other histories would have left, so that it is on
        /// screen sooner.
        histories_due: bool,
    },
}

impl AnswerRefinement {
    fn is_later(self) -> bool {
        self != Self::AtOnce
    }

    fn histories_due(self) -> bool {
        self == Self::Later { histories_due: true }
    }

    /// Sets if other histories are to be asked for later, where something is done later.
    fn put_off(&mut self, histories_due: bool) {
        if self.is_later() {
            *self = Self::Later { histories_due };
        }
    }

    /// No other histories are to be asked for.
    fn drop_histories(&mut self) {
        if self.is_later() {
            *self = Self::Later { histories_due: false };
        }
    }
}

/// The outcome of a request.
struct RequestOutcome {
    /// There may be something new to show.
    solved: bool,
    result: Result<(), Error>,
}

/// Wall times, s.
#[derive(Clone, Copy, Debug, Default)]
struct WallTimes {
    /// Of the last answer to an edit.
    solve_s: f64,
    /// Of the last frame on the full mesh.
    frame_s: f64,
}

/// A hand that holds a support by a spring.
#[derive(Clone, Copy, Debug)]
struct HeldSupport {
    /// Index of the cable.
    cable: usize,
    /// Index of the support.
    support: usize,
    /// The place where the hand is, m.
    at_m: Point,
}

impl Engine {
    /// One that answers an edit of a slow scene with a draft first; [`Self::refine`] is to follow.
    #[must_use]
    pub fn with_drafts() -> Self {
        Self { refinement: AnswerRefinement::Later { histories_due: false }, ..Self::default() }
    }

    /// As it is now, to go on from where what follows is given up.
    #[must_use]
    pub fn checkpoint(&self) -> Self {
        Self {
            run: self.run.as_ref().map(Run::checkpoint),
            edit: self.edit.clone(),
            ended_run: self.ended_run.as_ref().map(|ended| Box::new(ended.checkpoint())),
            phase: self.phase.clone(),
            outbox: self.outbox.clone(),
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
        !self.playback.paused && self.run.is_some() && !self.refused()
    }

    /// Does what is asked; returns what to show.
    pub fn handle(&mut self, request: Request) -> Report {
        if let Some(playback) = request.playback {
            self.playback = playback;
        }
        if let Some(order) = request.robot {
            self.steering.robot_speed_command = order;
        }
        let began = Instant::now();
        let runs = !self.playback.paused;
        let resumed = request.resume.as_ref().map(|r| Arc::clone(&r.answer));
        let (number, steps) = (request.number, request.steps);
        let dragging = request.drag.is_some() && request.edit.is_none() && request.resume.is_none() && !request.reset;
        let RequestOutcome { solved, result } = self.carry_out(request);
        // Time must not run in a scene that is no longer the one on screen.
        let held_back = self.refused() && runs;
        self.playback.paused |= held_back;
        if dragging && self.playing() {
            // The next frame shows it, not this report.
            self.steering.drag_number = self.steering.drag_number.max(number);
            return Report { paused_itself: held_back, ..self.report() };
        }
        let snapshot = &mut self.outbox.snapshot;
        snapshot.edit = number.max(self.steering.drag_number).max(snapshot.edit);
        if solved {
            self.outbox.snapshot.solve_wall_s = began.elapsed().as_secs_f64();
            let resumed = resumed.filter(|_| result.is_ok() && steps == 0);
            let stepped = result.is_ok() && steps > 0;
            let between = if stepped { self.answer_between_steps() } else { None };
            self.show(result);
            self.outbox.show_between_steps(between);
            if let Some(answer) = resumed {
                // No step was taken yet: what held the cable then is known from the recording only.
                self.outbox.show_recorded(answer);
            }
        }
        Report { paused_itself: held_back, ..self.report() }
    }

    /// Carries out a request in the order of its parts: what is undone, cancelled or edited, a
    /// recorded instant to go on from, a drag, a reset, steps.
    fn carry_out(&mut self, request: Request) -> RequestOutcome {
        let mut solved = request.edit.is_some() || request.resume.is_some() || request.reset || request.steps > 0;
        let mut result = Ok(());
        if let Some(edit) = request.undo_reset {
            let changed = self.undo_reset(*edit);
            solved |= changed.is_some();
            result = changed.unwrap_or(Ok(()));
        }
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
            if result.is_ok() {
                self.drag(drag);
            }
        }
        if request.reset {
            result = result.and_then(|()| self.reset());
        }
        if !self.refused() {
            for _ in 0..request.steps {
                result = result.and_then(|()| self.let_pass(FRAME_S));
            }
        }
        RequestOutcome { solved, result }
    }

    /// Returns whether a draft is shown that still moves.
    #[must_use]
    pub fn settling(&self) -> bool {
        matches!(self.phase, Phase::Draft { settling: true })
    }

    /// Lets a frame of a draft pass.
    pub fn settle_frame(&mut self) -> Report {
        let began = Instant::now();
        if let Some(run) = &mut self.run {
            // One that cannot go on stays as it is until the answer comes.
            self.phase = Phase::Draft { settling: draft::advance_frame(run.simulation_mut()).is_ok() };
        }
        self.outbox.snapshot.solve_wall_s = began.elapsed().as_secs_f64();
        self.show(Ok(()));
        self.report()
    }

    /// An answer at rest is shown whose other histories have not been sought yet.
    #[must_use]
    pub fn seeks_histories(&self) -> bool {
        let at_start = self.run.as_ref().is_some_and(|run| run.keeps_start() && run.simulation().time_s() <= 0.0);
        let rests = self.playback.paused && matches!(self.phase, Phase::Answer);
        self.refinement.histories_due() && rests && at_start
    }

    /// Replaces a draft by the answer, or asks of an answer what other histories would have left.
    pub fn refine(&mut self) -> Report {
        if self.seeks_histories() {
            self.seek_histories();
            return self.report();
        }
        let began = Instant::now();
        let result = self.solve_draft();
        self.outbox.snapshot.solve_wall_s = began.elapsed().as_secs_f64();
        self.show(result);
        self.report()
    }

    /// The solver panicked: what it held cannot be trusted any more.
    pub fn abandon(&mut self, message: &str) -> Report {
        self.run = None;
        if !self.refused() {
            self.phase = Phase::Answer;
        }
        self.playback.paused = true;
        self.outbox.snapshot.error = Some(NoAnswer::Panicked { message: message.to_owned() });
        self.outbox.snapshot.stale = true;
        Report { paused_itself: true, ..self.report() }
    }

    /// Stores the edit whose solve was cancelled; the scene stays without an answer, and time
    /// stands.
    fn cancel(&mut self, edit: Option<Edit>) {
        if let Some(edit) = edit {
            self.outbox.history_restarts |= edit.start == EditStart::NewScene;
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
        self.run = Some(Run::new(then, RunStart::Lost));
        self.ended_run = None;
        self.refinement.drop_histories();
        self.edit = Some(edit);
        self.phase = Phase::Answer;
        self.steering.hand = None;
        self.sample();
        Ok(())
    }
}

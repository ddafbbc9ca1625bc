//! The engine owns the simulation, answers requests and steps time; it knows no threads.

use std::sync::Arc;
use std::time::Instant;

use cable_core::math::{Point, vec2};
use cable_core::model::Inertia;
use cable_core::model::auto::Question;
use cable_core::solution::Histories;
use cable_core::timeline::{RunMonitor, RunPeaks};
use cable_core::{Error, Model, Scene, Settings, Simulation, Solution};

use crate::state::{NoAnswer, Playback, Snapshot};
use crate::worker::draft::{self, Mesh};
use crate::worker::passing;
use crate::worker::request::{Drag, Edit, Request, Resume};
use crate::worker::timing::{COARSE_AFTER_S, DRAFT_AFTER_S, DRAFT_FIRST_S, FRAME_S, MAX_ANSWERS, QUIET_S};

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
    robot_order: Option<f64>,
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
    tick_s: f64,
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
    /// New answers; at most [`MAX_ANSWERS`].
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
            robot_order: None,
            history_restarts: false,
            drafts: false,
            monitor: None,
            histories_due: false,
            solve_s: 0.0,
            dragged: 0,
            tick_s: 0.0,
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
    pub fn spare(&self) -> Self {
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
            self.robot_order = order;
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
            result = if stays && self.show_draft(&edit, request.hurried) { Ok(()) } else { self.take_edit(edit) };
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

    /// Lays the scene on screen once more and asks what other histories would have left. The rest
    /// is a function of the scene alone, so no figure changes.
    fn seek_histories(&mut self) {
        self.histories_due = false;
        let sought = self.edit.as_ref().and_then(|e| laid(&e.scene, e.model, e.settings).ok());
        if let Some(sought) = sought {
            self.simulation = Some(sought);
        }
        self.sample();
        self.show(Ok(()));
    }

    /// Lets one frame (1/60 s of wall time) pass.
    pub fn tick(&mut self) -> Report {
        self.tick_part(1.0)
    }

    /// Lets a share of a frame pass.
    pub fn tick_part(&mut self, share: f64) -> Report {
        if let Phase::CoarseMotion { moved_at } = self.phase
            && moved_at.elapsed().as_secs_f64() > QUIET_S
        {
            self.leave_coarse();
        }
        let began = Instant::now();
        let speed = self.playback.speed.clamp(Playback::MIN_SPEED, Playback::MAX_SPEED);
        // Slow motion takes finer steps, fast motion several: a step never exceeds one frame.
        let steps = speed.ceil().max(1.0);
        let dt = FRAME_S * share * speed / steps;
        let mut result = Ok(());
        for _ in 0..steps as u32 {
            result = result.and_then(|()| self.step(dt));
        }
        let failed = result.is_err();
        if failed {
            self.playback.paused = true;
        }
        let wall = began.elapsed().as_secs_f64();
        self.snapshot.solve_wall_s = wall;
        self.snapshot.real_speed = (!failed).then(|| speed * (FRAME_S * share / wall.max(FRAME_S * share)));
        self.snapshot.edit = self.dragged.max(self.snapshot.edit);
        if !self.coarse() {
            self.tick_s = wall;
        }
        self.show(result);
        self.report(failed)
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
            self.history_restarts |= edit.fresh;
            self.edit = Some(edit);
        }
        self.phase = Phase::Refused { reason: NoAnswer::Cancelled };
        self.playback.paused = true;
    }

    /// Shows an edit with few segments, if answering it in full would take long; whether it did. A
    /// single edit is answered at once: a draft from an answer takes 0.1 s itself.
    fn show_draft(&mut self, edit: &Edit, hurried: bool) -> bool {
        let Some(last) = &self.edit else { return false };
        let same = !edit.fresh && last.model == edit.model && last.settings == edit.settings;
        let slow = self.solve_s > if hurried || self.draft() { DRAFT_AFTER_S } else { DRAFT_FIRST_S };
        let (true, Some(old)) = (self.drafts && same && slow, &self.simulation) else {
            return false;
        };
        let falls = draft::settling_draft(edit, old);
        let settling = falls.is_some();
        // Models without a mesh have no fewer segments to be asked with.
        let coarse = || Some(self.rebuild(&draft::coarse_edit(edit, old), Some(old)).ok()?.0);
        let draft = if is_quasi_static(old.model()) { falls } else { falls.or_else(coarse) };
        let Some(draft) = draft else { return false };
        self.simulation = Some(draft);
        self.monitor = None;
        self.before_motion = None;
        self.phase = Phase::Draft { settling };
        self.edit = Some(edit.clone());
        true
    }

    fn solve_draft(&mut self) -> Result<(), Error> {
        let (Phase::Draft { .. }, Some(edit)) = (&self.phase, self.edit.clone()) else { return Ok(()) };
        // The answer is one at rest even where time is to run next: what runs on from the draft
        // itself is still falling, and strikes what it falls on.
        let paused = std::mem::replace(&mut self.playback.paused, true);
        let result = self.take_edit(edit);
        self.playback.paused = paused || result.is_err();
        result
    }

    fn take_edit(&mut self, edit: Edit) -> Result<(), Error> {
        let began = Instant::now();
        let old = if edit.fresh { None } else { self.simulation.take() };
        if edit.fresh {
            self.simulation = None;
            self.snapshot.solution = None;
            self.last_answer = None;
            self.history_restarts = true;
            self.answers.clear();
        }
        self.hand = None;
        self.monitor = None;
        // Models are compared by what they answer for the scene as laid, not for where another
        // model left the cable.
        let same_model = self.edit.as_ref().is_some_and(|e| e.model == edit.model && e.settings == edit.settings);
        let from = old.as_ref().filter(|o| same_model || o.time_s() > 0.0);
        // Before time has run there is nothing to go on from, whether or not it is to run next.
        let at_rest = from.is_none_or(|o| o.time_s() <= 0.0);
        self.routes.clear();
        let mut edit = edit;
        // Other histories take longer than the rest itself: each is another rest. Where nobody
        // refines the answer they are asked for at once.
        self.histories_due = self.drafts && at_rest && edit.settings.histories;
        let rebuilt = if at_rest { self.lay(&mut edit, from).map(|s| (s, true)) } else { self.rebuild(&edit, from) };
        self.edit = Some(edit);
        self.solve_s = began.elapsed().as_secs_f64();
        match rebuilt {
            Ok((simulation, start_kept)) => {
                self.simulation = Some(simulation);
                self.before_motion = None;
                self.phase = Phase::Answer { start_kept };
                self.sample();
                Ok(())
            }
            Err(e) => {
                // The old one stays: undoing the edit goes on from it.
                self.simulation = old;
                self.playback.paused = true;
                self.phase = Phase::Refused { reason: NoAnswer::Error(e.clone()) };
                Err(e)
            }
        }
    }

    /// The simulation of a scene at rest: a function of the scene alone, so that typing, undo, load
    /// and reset give the same answer for the same scene. Where that would move a cable through an
    /// obstacle that stays where it is, the way the cable takes now becomes part of the scene.
    fn lay(&mut self, edit: &mut Edit, old: Option<&Simulation>) -> Result<Simulation, Error> {
        let histories = edit.settings.histories && !self.histories_due;
        let settings = Settings { histories, ..edit.settings };
        let of = |scene: &Scene| laid(scene, edit.model, settings);
        let laid = of(&edit.scene);
        let Some(old) = old.filter(|o| !edit.as_laid && draft::same_cables(edit, o)) else { return laid };
        let jumped = match &laid {
            Ok(laid) => passing::jumped(old, laid),
            // Only a scene that could be solved from where the cable is gets a second look.
            Err(_) if draft::buried(edit, old) => return laid,
            Err(_) => (0..edit.scene.cables.len()).collect(),
        };
        if jumped.is_empty() {
            return laid;
        }
        let mut scene = edit.scene.clone();
        let routes: Vec<(usize, Vec<Point>)> =
            jumped.iter().filter_map(|&k| Some((k, passing::way(old, k)?))).collect();
        for (k, way) in &routes {
            if let Some(cable) = scene.cables.get_mut(*k) {
                cable.route_m.clone_from(way);
            }
        }
        match of(&scene) {
            Ok(led) if laid.is_err() || passing::jumped(old, &led).len() < jumped.len() => {
                self.routes = routes;
                edit.scene = scene;
                Ok(led)
            }
            _ => laid,
        }
    }

    /// The simulation of an edited scene, carrying over where the cables are, and whether it is at
    /// its start.
    fn rebuild(&self, edit: &Edit, old: Option<&Simulation>) -> Result<(Simulation, bool), Error> {
        let time_s = old.map_or(0.0, Simulation::time_s);
        let moves = old.is_some() && (time_s > 0.0 || !self.playback.paused);
        let question = if moves { MOTION } else { Question::Rest };
        let mut fresh = Simulation::for_question(edit.scene.clone(), edit.model, edit.settings, question)?;
        if let Some(old) = old
            && draft::same_cables(edit, old)
            && !draft::buried(edit, old)
        {
            let mut carried = fresh.clone();
            if carried.carry(old).is_ok() {
                if !self.playback.paused {
                    return Ok((carried, false));
                }
                if carried.settle().is_ok() {
                    return Ok((carried, time_s <= 0.0));
                }
            }
        }
        fresh.settle()?;
        Ok((fresh, true))
    }

    fn drag(&mut self, drag: Drag) -> Result<(), Error> {
        if self.coarse() {
            self.phase = Phase::CoarseMotion { moved_at: Instant::now() };
        } else if self.drafts && self.playing() && self.tick_s > COARSE_AFTER_S {
            self.enter_coarse();
        }
        let Drag { cable, support, to_m, .. } = drag;
        let draw = |simulation: &mut Simulation| match drag.by_spring {
            true => simulation.pull_support(cable, support, vec2(to_m)),
            false => simulation.drag_support(cable, support, vec2(to_m)),
        };
        self.hand = drag.by_spring.then_some(Hand { cable, support, at_m: to_m });
        if let Some(simulation) = &mut self.simulation {
            draw(simulation);
        }
        if let Some(monitor) = &mut self.monitor {
            monitor.steer(draw);
        }
        if let Some(edit) = &mut self.edit {
            edit.scene = drag.scene;
        }
        if let Phase::Answer { start_kept } = &mut self.phase {
            *start_kept = false;
        }
        Ok(())
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

    /// A coarse mesh follows the hand while time runs, where the full one is late: it goes on where
    /// that is.
    fn enter_coarse(&mut self) {
        let (Some(edit), Some(old)) = (&self.edit, &self.simulation) else { return };
        if let Some(coarse) = draft::with_mesh(edit, old, Mesh::Coarse) {
            self.simulation = Some(coarse);
            self.monitor = None;
            self.phase = Phase::CoarseMotion { moved_at: Instant::now() };
        }
    }

    /// The hand rests: the full mesh goes on where the coarse one is.
    fn leave_coarse(&mut self) {
        self.phase = Phase::Answer { start_kept: false };
        if let (Some(edit), Some(old)) = (&self.edit, &self.simulation)
            && let Some(mut full) = draft::with_mesh(edit, old, Mesh::Full)
        {
            if let Some(hand) = self.hand {
                full.pull_support(hand.cable, hand.support, vec2(hand.at_m));
            }
            self.simulation = Some(full);
            self.monitor = None;
        }
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
            self.simulation = Some(self.lay(&mut edit, None)?);
            self.before_motion = None;
            self.phase = Phase::Answer { start_kept: true };
        }
        self.sample();
        Ok(())
    }

    fn step(&mut self, dt_s: f64) -> Result<(), Error> {
        let Some(simulation) = &mut self.simulation else {
            return Ok(());
        };
        let asked = self.edit.as_ref().map_or(Model::Auto, |e| e.model);
        let settings = self.edit.as_ref().map_or_else(Settings::default, |e| e.settings);
        let inertia = if is_quasi_static(asked) { Inertia::QuasiStatic } else { Inertia::Dynamic };
        let start_kept = matches!(self.phase, Phase::Answer { start_kept: true });
        let mut starts = start_kept && simulation.time_s() <= 0.0;
        if inertia == Inertia::Dynamic && is_quasi_static(simulation.model()) {
            let (moving, settled) = moving(simulation, settings)?;
            self.before_motion = Some(std::mem::replace(simulation, moving));
            starts &= settled;
        }
        if starts {
            self.monitor = Some(RunMonitor::with_errors(simulation, inertia));
        }
        let order = self.robot_order;
        simulation.command_robot(order);
        if let Some(monitor) = &mut self.monitor {
            monitor.steer(|simulation| simulation.command_robot(order));
        }
        match inertia {
            Inertia::QuasiStatic => simulation.step_quasi_static(dt_s)?,
            Inertia::Dynamic => simulation.step(dt_s)?,
        }
        if let Some(monitor) = &mut self.monitor {
            monitor.follow(simulation);
        }
        self.sample();
        Ok(())
    }

    /// Adds the present instant to the history: the start as well as every step.
    fn sample(&mut self) {
        if let Some(simulation) = &self.simulation
            && self.answers.len() < MAX_ANSWERS
        {
            self.answers.push(self.solution_of(simulation));
        }
    }

    /// The answer without what it says of other histories while these are being sought.
    fn solution_of(&self, simulation: &Simulation) -> Solution {
        let mut solution = simulation.solution();
        if self.seeks_histories() {
            solution.warnings.retain(|w| w.cause.histories() != Some(&Histories::NotSought));
        }
        solution
    }

    fn show(&mut self, result: Result<(), Error>) {
        let scene: Option<Arc<Scene>> = self.edit.as_ref().map(|e| Arc::new(e.scene.clone()));
        match (result, &self.simulation) {
            (Ok(()), Some(simulation)) => {
                let solution = self.solution_of(simulation);
                self.snapshot.solution = Some(Arc::new(solution));
                self.snapshot.seeks_histories = self.seeks_histories();
                self.snapshot.peaks = self.monitor.as_ref().map_or_else(Vec::new, |m| m.peaks().to_vec());
                self.snapshot.error = match &self.phase {
                    Phase::Refused { reason } => Some(reason.clone()),
                    _ => None,
                };
                self.snapshot.stale = self.refused();
                self.snapshot.draft = self.draft() || self.coarse();
                if self.refused() {
                    self.show_last_answer();
                } else {
                    self.snapshot.scene = scene;
                    self.keep_answer();
                }
            }
            (Ok(()), None) => {
                if let Phase::Refused { reason } = &self.phase {
                    self.snapshot.error = Some(reason.clone());
                    self.snapshot.stale = true;
                }
            }
            (Err(e), _) => {
                self.snapshot.error = Some(NoAnswer::Error(e));
                self.snapshot.stale = true;
                self.show_last_answer();
            }
        }
        if self.playback.paused {
            self.snapshot.real_speed = None;
        }
    }

    /// Keeps an answer that is on screen: it stays while later scenes have none.
    fn keep_answer(&mut self) {
        if let (false, Some(solution)) = (self.snapshot.draft, &self.snapshot.solution) {
            let Snapshot { scene, peaks, .. } = &self.snapshot;
            let (scene, solution, peaks) = (scene.clone(), Arc::clone(solution), peaks.clone());
            self.last_answer = Some(LastAnswer { scene, solution, peaks });
        }
    }

    /// A draft of a scene is no answer, least of all to another one.
    fn show_last_answer(&mut self) {
        self.snapshot.draft = false;
        self.snapshot.seeks_histories = false;
        if let Some(last) = &self.last_answer {
            self.snapshot.solution = Some(Arc::clone(&last.solution));
            self.snapshot.scene.clone_from(&last.scene);
            self.snapshot.peaks.clone_from(&last.peaks);
        }
    }

    fn report(&mut self, paused_itself: bool) -> Report {
        Report {
            snapshot: self.snapshot.clone(),
            history_restarts: std::mem::take(&mut self.history_restarts),
            answers: std::mem::take(&mut self.answers),
            routes: self.routes.clone(),
            paused_itself,
        }
    }
}

/// A scene laid at rest.
fn laid(scene: &Scene, model: Model, settings: Settings) -> Result<Simulation, Error> {
    let mut laid = Simulation::for_question(scene.clone(), model, settings, Question::Rest)?;
    laid.settle()?;
    Ok(laid)
}

/// Returns whether a model that was asked for by name lets time run without inertia: it has none.
#[must_use]
pub fn is_quasi_static(model: Model) -> bool {
    !model.capabilities().inertia
}

/// The simulation that moves from where the one stands that `auto` chose for rest, and whether it
/// has come to rest there on its own mesh.
fn moving(rest: &Simulation, settings: Settings) -> Result<(Simulation, bool), Error> {
    // Its warning of other histories would be gone with the first step.
    let settings = Settings { histories: false, ..settings };
    let mut moving = Simulation::for_question(rest.scene().clone(), Model::Auto, settings, MOTION)?;
    moving.carry(rest)?;
    let mut settled = moving.clone();
    match settled.settle() {
        Ok(_) => Ok((settled, true)),
        Err(_) => Ok((moving, false)),
    }
}

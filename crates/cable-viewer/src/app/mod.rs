//! The window takes in the worker's answers, lays out panels and canvas and applies what they push.
//!
//! - `layout`, `menu`, `keys`, `palette`, `palette_entries`: where panels are, and every command by
//!   menu, key or name
//! - `dialogs`, `path_picker`, `feedback_form`: what the user is asked
//! - `frame_pacing`: fewer frames where there is no GPU
//! - `headline`: the scene's name and the figures that always stand at the top
//! - `early_clicks`: clicks that come before the first frame, or are over within one
//! - `analysis_tools`: what is asked beside the answer, as verbs
//! - `guidance`: hints of the first minute, the welcome dialog, and tutorials
//! - `screenshot`, `documentation_pictures`: the window as a picture file, and in eight states
//! - `canvas_picture`: the canvas with its legend as a picture file

pub mod analysis_tools;
mod canvas_picture;
mod dialogs;
pub mod documentation_pictures;
mod early_clicks;
mod feedback_form;
mod frame_pacing;
pub mod guidance;
mod headline;
mod keys;
mod layout;
mod menu;
pub mod palette;
mod palette_entries;
mod path_picker;
pub mod screenshot;

use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use cable_core::Scene;

use crate::app::frame_pacing::{FramePacing, NextFrame, SOFTWARE_FRAME_INTERVAL, ShownMotion};
use crate::command::effects::{Effects, submit_new_scene};
use crate::command::{self, Command};
use crate::io::autosave::{Autosave, Changes};
use crate::io::{first_steps_mark, recent_files};
use crate::jobs::{friction_range, model_comparison, neglected_bending, safe_reach, work_precision};
use crate::render::theme;
use crate::state::analysis::pin_answers;
use crate::state::dialog::Dialog;
use crate::state::job_questions::{bending_query_fits, friction_query, friction_query_fits};
use crate::state::live::RestartCause;
use crate::state::{AppState, WorkerStatus};
use crate::units::system;
use crate::worker::Worker;
use crate::worker::engine::Report;

/// Most unanswered edits whose delay is measured; of more, those in between are not.
const MAX_PENDING_EDITS: usize = 64;

/// Time between two frames during a solve. With a longer time the displayed seconds would jump, and
/// a superseded solve would be given up late.
const SOLVING_REPAINT: Duration = Duration::from_millis(30);

/// The thread on which the worker solves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum WorkerKind {
    /// A thread of its own.
    Thread,
    /// The thread of the window, within each frame.
    Inline,
}

/// The eframe application.
pub struct ViewerApp {
    /// Everything on screen.
    pub state: AppState,
    worker: Worker,
    worker_kind: WorkerKind,
    frame_pacing: FramePacing,
    shown_motion: ShownMotion,
    /// As last sent to the window.
    title: String,
    /// Keeps unsaved changes on disk, in a window.
    autosave: Option<Autosave>,
    /// Numbers of the edits not yet answered and when they were sent, oldest first; at most
    /// [`MAX_PENDING_EDITS`].
    pending_edits: VecDeque<(u64, Instant)>,
    /// The file in which recent files are listed, and what stands there.
    recent_list: Option<(PathBuf, Vec<PathBuf>)>,
    /// The file in which it is noted that the first steps are done, until that is.
    first_steps_mark: Option<PathBuf>,
    /// Since when an answer has been sought.
    solving_since: Option<Instant>,
    /// The map of where the robot can go, while it is computed.
    safe_reach_job: Option<safe_reach::Job>,
    /// Every model being asked.
    model_comparison_job: Option<model_comparison::Job>,
    /// Every model and mesh being compared.
    work_precision_job: Option<work_precision::Job>,
    /// The effect of neglecting bending stiffness, computed or being computed.
    neglected_bending_job: Option<neglected_bending::NeglectedBendingJob>,
    /// The ribbon of less and more friction, computed or being computed.
    friction_range_job: Option<friction_range::FrictionRangeJob>,
}

impl ViewerApp {
    /// Opens a scene with a solver thread.
    #[must_use]
    pub fn new(ctx: &egui::Context, scene: Scene, path: Option<PathBuf>) -> Self {
        Self::start(ctx, scene, path, WorkerKind::Thread)
    }

    /// Opens a scene that is solved within each frame, for tests and still pictures.
    #[must_use]
    pub fn inline(ctx: &egui::Context, scene: Scene, path: Option<PathBuf>) -> Self {
        Self::start(ctx, scene, path, WorkerKind::Inline)
    }

    /// The application with a scene, which its worker begins to solve.
    fn start(ctx: &egui::Context, scene: Scene, path: Option<PathBuf>, worker_kind: WorkerKind) -> Self {
        theme::install(ctx);
        ctx.add_plugin(early_clicks::HeldClicks::default());
        // A press that stays where it is is a click, however long a frame takes meanwhile.
        ctx.options_mut(|o| o.input_options.max_click_duration = f64::INFINITY);
        let frame_pacing = FramePacing::default();
        let worker = new_worker(ctx, worker_kind, &frame_pacing);
        let mut app = Self {
            state: AppState::new(scene, path),
            worker,
            worker_kind,
            frame_pacing,
            shown_motion: ShownMotion::default(),
            title: String::new(),
            autosave: None,
            pending_edits: VecDeque::new(),
            solving_since: None,
            recent_list: None,
            first_steps_mark: None,
            safe_reach_job: None,
            model_comparison_job: None,
            work_precision_job: None,
            neglected_bending_job: None,
            friction_range_job: None,
        };
        let mut effects = Effects::default();
        submit_new_scene(&mut app.state, &mut effects);
        app.perform_effects(ctx, effects);
        app
    }

    /// From now on the window is drawn without a GPU.
    pub fn draw_in_software(&mut self) {
        self.frame_pacing.every(SOFTWARE_FRAME_INTERVAL);
    }

    /// From now on unsaved changes are kept in a file; if there are some from a window that died,
    /// they are offered.
    pub fn enable_autosave(&mut self, path: PathBuf) {
        let list = path.with_file_name("recent.txt");
        for path in recent_files::load(&list).into_iter().rev() {
            self.state.ui.add_recent(path);
        }
        if let Some(path) = self.state.document.path.clone() {
            self.state.ui.add_recent(path);
        }
        self.recent_list = Some((list, Vec::new()));
        let mark = path.with_file_name("first-steps.txt");
        if first_steps_mark::are_done(&mark) {
            self.state.ui.first_steps.hide();
        } else {
            self.first_steps_mark = Some(mark);
        }
        let autosave = Autosave::new(path);
        self.state.ui.dialog = match autosave.found() {
            None => None,
            Some(Ok(scene)) => Some(Dialog::Recover { scene: Box::new(scene) }),
            Some(Err(text)) => Some(Dialog::Message {
                title: "Unsaved changes could not be recovered".to_owned(),
                text: format!("The program closed unexpectedly, and the changes it had kept cannot be read: {text}"),
            }),
        };
        self.autosave = Some(autosave);
    }

    /// Keeps unsaved changes on disk; asks for a frame when the next copy is due.
    fn update_autosave(&mut self, ctx: &egui::Context) {
        let Some(autosave) = &mut self.autosave else { return };
        let state = &mut self.state;
        let changes = match (state.document.unsaved(), &state.document.fault) {
            (false, _) => Changes::None,
            (true, None) => Changes::Readable,
            (true, Some(_)) => Changes::Faulty,
        };
        let wait = autosave.update(&state.document.scene, changes, Instant::now());
        if let Some(wait) = wait {
            ctx.request_repaint_after(wait);
        }
        state.ui.autosave_fault = autosave.fault().map(str::to_owned);
    }

    /// Applies commands as if panels had pushed them.
    pub fn apply(&mut self, ctx: &egui::Context, commands: Vec<Command>) {
        let mut effects = Effects::default();
        for command in commands {
            command::apply(&mut self.state, command, &mut effects);
        }
        command::scene::resume_after_drag(&mut self.state, &mut effects);
        self.perform_effects(ctx, effects);
    }

    /// Number of solves that were given up for what was asked later.
    #[must_use]
    pub fn abandoned_solves(&self) -> u64 {
        self.worker.abandoned_solves()
    }

    /// Returns whether a solve has been running for longer than this.
    #[must_use]
    pub fn solves_for(&self, time: std::time::Duration) -> bool {
        self.worker.solves_for(time)
    }

    /// The worker has answered every edit.
    #[must_use]
    pub fn settled(&self) -> bool {
        self.pending_edits.is_empty()
    }

    /// Does what commands asked for outside the state: files, clipboard, jobs and requests to the
    /// worker.
    fn perform_effects(&mut self, ctx: &egui::Context, effects: Effects) {
        if let (true, Some(autosave)) = (effects.forget_recovery, &mut self.autosave) {
            autosave.forget();
        }
        if let Some(path) = effects.picture {
            let result = canvas_picture::save(&mut self.state, ctx.theme(), &path);
            command::file::exported(&mut self.state, path, result);
        }
        if let Some(text) = effects.copied {
            ctx.copy_text(text);
        }
        if let Some(order) = effects.reach {
            let shown = ctx.clone();
            self.safe_reach_job = order.map(|o| safe_reach::start(*o, move || shown.request_repaint()));
        }
        if let Some(scene) = effects.models {
            let (shown, settings) = (ctx.clone(), self.state.solver.settings);
            self.model_comparison_job =
                scene.map(|s| model_comparison::start(*s, settings, move || shown.request_repaint()));
        }
        if let Some(scene) = effects.work_precision {
            let (shown, solver) = (ctx.clone(), &self.state.solver);
            let (model, settings) = (solver.model, solver.settings);
            self.work_precision_job =
                scene.map(|s| work_precision::start(*s, model, settings, move || shown.request_repaint()));
        }
        if effects.restart_worker {
            self.worker = new_worker(ctx, self.worker_kind, &self.frame_pacing);
        }
        if !effects.request.is_empty() {
            if effects.request.number > 0 {
                if self.pending_edits.len() == MAX_PENDING_EDITS {
                    self.pending_edits.pop_back();
                }
                self.pending_edits.push_back((effects.request.number, Instant::now()));
            }
            self.worker.submit(effects.request);
            ctx.request_repaint();
        }
        if effects.quit {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    /// Takes in what the worker has done since the last frame.
    fn receive_reports(&mut self, ctx: &egui::Context) {
        if let Some(report) = self.worker.poll() {
            self.show(report);
        }
        if let Some(job) = &self.safe_reach_job {
            self.state.analysis.safe_reach.progress = job.progress();
            if !matches!(self.state.analysis.safe_reach.progress, safe_reach::Progress::Running(..)) {
                self.safe_reach_job = None;
            }
        }
        if let Some(job) = &self.model_comparison_job {
            self.state.analysis.models = job.progress();
            if let model_comparison::Progress::Done(found) = self.state.analysis.models.clone() {
                pin_answers(&mut self.state.analysis, &found, &self.state.document.saved);
            }
            if !matches!(self.state.analysis.models, model_comparison::Progress::Running(..)) {
                self.model_comparison_job = None;
            }
        }
        if let Some(job) = &self.work_precision_job {
            self.state.analysis.work_precision = job.progress();
            if !matches!(self.state.analysis.work_precision, work_precision::Progress::Running(..)) {
                self.work_precision_job = None;
            }
        }
        self.update_neglected_bending(ctx);
        self.update_friction_range(ctx);
        self.state.solver.status = self.worker.status();
        self.time_solve(ctx);
        if self.worker_kind == WorkerKind::Inline && !self.state.live.playback.paused {
            ctx.request_repaint();
        }
        if matches!(self.state.solver.status, WorkerStatus::Dead(_)) {
            self.state.live.latest.stale = true;
            self.state.live.snapshot.stale = true;
            self.pending_edits.clear();
        }
    }

    /// Counts the seconds for which an answer has been sought.
    fn time_solve(&mut self, ctx: &egui::Context) {
        let waits = !self.pending_edits.is_empty() || self.state.live.latest.draft;
        let dead = matches!(self.state.solver.status, WorkerStatus::Dead(_));
        // A draft that only follows the hand while time runs is not waited for.
        let coarse = self.state.live.latest.draft && !self.state.live.playback.paused;
        if !waits || dead || coarse {
            self.solving_since = None;
        } else {
            self.solving_since.get_or_insert_with(Instant::now);
            ctx.request_repaint_after(SOLVING_REPAINT);
        }
        self.state.solver.solving_s = self.solving_since.map(|since| since.elapsed().as_secs_f64());
    }

    /// Looks after what neglecting bending stiffness changes: a question about what is no longer on
    /// screen is forgotten.
    fn update_neglected_bending(&mut self, ctx: &egui::Context) {
        if !bending_query_fits(&self.state) {
            self.state.analysis.neglected_bending = neglected_bending::NeglectedBendingState::default();
        }
        let Some(ask) = self.state.analysis.neglected_bending.query.clone() else { return };
        let runs = |job: &neglected_bending::NeglectedBendingJob| {
            matches!(job.progress(), neglected_bending::Progress::Running(..))
        };
        // One that still runs cannot be stopped within its solve: the next waits for it.
        if self.neglected_bending_job.as_ref().is_none_or(|job| !job.is_of(&ask) && !runs(job)) {
            let shown = ctx.clone();
            self.neglected_bending_job =
                Some(neglected_bending::NeglectedBendingJob::start(ask.clone(), move || shown.request_repaint()));
        }
        let own = self.neglected_bending_job.as_ref().filter(|job| job.is_of(&ask));
        self.state.analysis.neglected_bending.progress = own
            .map_or(neglected_bending::Progress::Running(0.0, None), neglected_bending::NeglectedBendingJob::progress);
    }

    /// Looks after the ribbon of less and more friction: one of another question ends, a missing
    /// one begins.
    fn update_friction_range(&mut self, ctx: &egui::Context) {
        let state = &mut self.state;
        if self
            .friction_range_job
            .as_ref()
            .is_some_and(|job| !state.analysis.friction_range.on || !friction_query_fits(state, job.query()))
        {
            self.friction_range_job = None;
        }
        if self.friction_range_job.is_none()
            && let Some(ask) = friction_query(state)
        {
            let shown = ctx.clone();
            self.friction_range_job =
                Some(friction_range::FrictionRangeJob::start(ask, move || shown.request_repaint()));
        }
        state.analysis.friction_range.progress = self
            .friction_range_job
            .as_ref()
            .map_or(friction_range::Progress::None, friction_range::FrictionRangeJob::progress);
    }

    /// Lets what was recorded go on while it is replayed.
    fn replay(&mut self, ctx: &egui::Context) {
        let state = &mut self.state;
        if state.live.playback.paused || state.live.recording.shown_s.is_none() {
            return;
        }
        let ended = state.live.recording.replay(f64::from(ctx.input(|i| i.stable_dt)) * state.live.playback.speed);
        state.live.refresh();
        ctx.request_repaint();
        if ended {
            let mut effects = Effects::default();
            command::playback::send(state, &mut effects);
            self.perform_effects(ctx, effects);
        }
    }

    /// Draws a frame of the window and does what its panels push.
    pub fn frame(&mut self, ui: &mut egui::Ui) {
        let ctx = ui.ctx().clone();
        system::set_current(self.state.view.units);
        self.receive_reports(&ctx);
        self.replay(&ctx);
        ctx.set_theme(self.state.view.theme);
        let mut commands = Vec::new();
        keys::read(&ctx, &self.state, &mut commands);
        layout::ui(ui, &mut self.state, &mut commands);
        dialogs::ui(&ctx, &mut self.state, &mut commands);
        if ctx.input(|i| i.viewport().close_requested()) && self.state.document.unsaved() && !self.state.ui.closing {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            commands.push(Command::File(command::FileCommand::Quit));
        }
        self.apply(&ctx, commands);
        let runs = !self.state.live.playback.paused && self.pending_edits.is_empty();
        let now = Instant::now();
        let metres_per_s = self.shown_motion.speed(now, self.state.live.snapshot.solution.as_ref());
        let points_per_s = metres_per_s * self.state.view.camera.points_per_m;
        self.frame_pacing.drawn(now, if runs { NextFrame::Step { points_per_s } } else { NextFrame::Answer });
        self.update_autosave(&ctx);
        if let Some((list, written)) = &mut self.recent_list
            && *written != self.state.ui.recent
        {
            written.clone_from(&self.state.ui.recent);
            recent_files::save(list, written);
        }
        if self.state.ui.first_steps.open().is_empty()
            && let Some(mark) = self.first_steps_mark.take()
        {
            first_steps_mark::remember(&mark);
        }
        let title = format!("{} – Cable simulator", headline::title(&self.state));
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    /// Takes a report of the worker into the state.
    fn show(&mut self, report: Report) {
        let state = &mut self.state;
        if report.history_restarts {
            state.live.restart_history();
        } else if report.answers.first().is_some_and(|a| a.time_s <= 0.0)
            && state.live.has_run()
            && report.snapshot.scene != state.live.latest.scene
        {
            // An edit after which nothing goes on from where the cable was: another run begins.
            // Moves of a drag that were answered before belong to the same entry to undo.
            let of = state.live.latest.scene.as_deref();
            let [back, forward] = state.document.undo.neighbours();
            let scene = if forward == of { of } else { back.or(of) };
            if let Some(scene) = scene.cloned() {
                state.live.end_run(RestartCause::Edit(scene));
            }
        }
        if let (Some(wall_s), false) = (&mut state.live.recording.solve_wall_s, report.answers.is_empty()) {
            *wall_s += report.snapshot.solve_wall_s;
        }
        for answer in report.answers {
            state.live.record(answer);
        }
        if report.paused_itself {
            state.live.playback.paused = true;
        }
        state.live.receive(report.snapshot);
        // The way that the cable takes becomes part of the scene, but not of one that was edited
        // meanwhile.
        if state.live.latest.edit == state.solver.edits_sent {
            for (cable, way) in report.routes {
                if let Some(cable) = state.document.scene.cables.get_mut(cable) {
                    cable.route_m = way;
                }
            }
        }
        if report.history_restarts
            && let Some(run) = state.live.reopened_run.take()
        {
            let answers = run.answers;
            state.live.recording.solve_wall_s = run.wall_time_s;
            let last_s = answers.last().map(|a| a.time_s);
            for answer in answers {
                state.live.record(answer);
            }
            state.live.show_time(last_s);
        }
        // Several edits may be answered at once: the delay shown is that of the one that waited
        // longest.
        let answered = self.pending_edits.iter().take_while(|(number, _)| *number <= state.live.snapshot.edit).count();
        if let Some((_, began)) = self.pending_edits.drain(..answered).next() {
            // Without a thread a frame waits for its answer: that time says nothing of the
            // window's.
            state.solver.edit_latency_s =
                (self.worker_kind == WorkerKind::Thread).then(|| began.elapsed().as_secs_f64());
        }
    }
}

fn new_worker(ctx: &egui::Context, kind: WorkerKind, frame_pacing: &FramePacing) -> Worker {
    match kind {
        WorkerKind::Thread => {
            let (ctx, frame_pacing) = (ctx.clone(), frame_pacing.clone());
            Worker::thread(move || ctx.request_repaint_after(frame_pacing.wait(Instant::now())))
        }
        WorkerKind::Inline => Worker::inline(),
    }
}

impl eframe::App for ViewerApp {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.frame(ui);
    }

    fn on_exit(&mut self) {
        // The user closed the window on purpose, so unsaved changes are not wanted. Those that
        // another window left stay until they are decided on.
        if let Some(autosave) = &mut self.autosave {
            autosave.update(&self.state.document.saved, Changes::None, Instant::now());
        }
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}

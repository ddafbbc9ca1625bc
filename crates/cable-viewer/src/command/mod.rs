//! Every edit and action of the window. Panels, canvas, menus and keys only push commands;
//! [`apply`] is the one place that changes [`AppState`], split by group.

pub mod file;
pub mod scene;
pub mod view;

pub use file::FileCommand;
pub use scene::SceneCommand;
pub use view::ViewCommand;

use cable_core::{Model, Settings};

use crate::state::{AppState, Playback};
use crate::worker::request::{Edit, Request};

/// Something to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Changes the scene.
    Scene(SceneCommand),
    /// Time.
    Playback(PlaybackCommand),
    /// Solves with another model.
    SetModel(Model),
    /// Solves with another mesh or accuracy.
    SetSettings(Settings),
    /// Changes what is shown, not what is solved.
    View(ViewCommand),
    /// Files and the window.
    File(FileCommand),
}

/// Time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaybackCommand {
    /// Runs or stops.
    SetPaused(bool),
    /// Runs if it stands, stands if it runs.
    TogglePause,
    /// Simulated seconds per second; clamped to 0.01–4.
    SetSpeed(f64),
    /// One 1/60 s; pauses first.
    Step,
    /// Back to the start, bit for bit; pauses.
    Reset,
}

/// What applying commands asks of the world outside [`AppState`].
#[derive(Debug, Default)]
pub struct Effects {
    /// For the worker.
    pub request: Request,
    /// Close the window.
    pub quit: bool,
    /// Remove what was kept for recovery.
    pub forget_recovery: bool,
    /// Start the solver thread anew.
    pub restart_worker: bool,
}

/// Does one command.
pub fn apply(state: &mut AppState, command: Command, effects: &mut Effects) {
    match command {
        Command::Scene(c) => scene::apply(state, c, effects),
        Command::Playback(c) => playback(state, c, effects),
        Command::SetModel(model) => {
            state.model = model;
            submit_scene(state, false, effects);
        }
        Command::SetSettings(settings) => {
            state.settings = settings;
            submit_scene(state, false, effects);
        }
        Command::View(c) => view::apply(state, c),
        Command::File(c) => file::apply(state, c, effects),
    }
}

fn playback(state: &mut AppState, command: PlaybackCommand, effects: &mut Effects) {
    match command {
        PlaybackCommand::SetPaused(paused) => state.playback.paused = paused,
        PlaybackCommand::TogglePause => state.playback.paused = !state.playback.paused,
        PlaybackCommand::SetSpeed(speed) => {
            if speed.is_finite() {
                state.playback.speed = speed.clamp(Playback::MIN_SPEED, Playback::MAX_SPEED);
            }
        }
        PlaybackCommand::Step => {
            state.playback.paused = true;
            effects.request.merge(Request { steps: 1, number: next_number(state), ..Request::default() });
        }
        PlaybackCommand::Reset => {
            state.playback.paused = true;
            effects.request.merge(Request { reset: true, number: next_number(state), ..Request::default() });
        }
    }
    effects.request.merge(Request { playback: Some(state.playback), ..Request::default() });
}

/// Sends the scene to the worker; `fresh`: nothing of the present simulation is carried over.
pub(crate) fn submit_scene(state: &mut AppState, fresh: bool, effects: &mut Effects) {
    let edit = Edit { scene: state.scene.clone(), model: state.model, settings: state.settings, fresh };
    effects.request.merge(Request {
        edit: Some(edit),
        playback: Some(state.playback),
        number: next_number(state),
        ..Request::default()
    });
}

pub(crate) fn next_number(state: &mut AppState) -> u64 {
    state.edits_sent += 1;
    state.edits_sent
}

//! Every edit and action of the window. Panels, canvas, menus and keys only push commands;
//! [`apply`] is the one place that changes [`AppState`], split by group.

pub mod clipboard;
pub mod file;
mod import;
mod items;
pub mod playback;
mod route;
pub mod scene;
pub mod view;

pub use crate::command::file::FileCommand;
pub use crate::command::playback::PlaybackCommand;
pub use crate::command::scene::SceneCommand;
pub use crate::command::view::ViewCommand;

use cable_core::{Model, Scene, Settings};

use crate::jobs::safe_reach::Order;
use crate::state::AppState;
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
    /// Look for where the robot can go, or end that.
    pub reach: Option<Option<Box<Order>>>,
    /// Ask every model about a scene, or end that.
    pub models: Option<Option<Box<Scene>>>,
    /// Text for the clipboard of the system.
    pub copied: Option<String>,
}

/// Does one command.
pub fn apply(state: &mut AppState, command: Command, effects: &mut Effects) {
    match command {
        Command::Scene(c) => scene::apply(state, c, effects),
        Command::Playback(c) => playback::apply(state, c, effects),
        Command::SetModel(model) => {
            state.model = model;
            submit_scene(state, false, effects);
        }
        Command::SetSettings(settings) => {
            state.settings = settings;
            submit_scene(state, false, effects);
        }
        Command::View(c) => view::apply(state, c, effects),
        Command::File(c) => file::apply(state, c, effects),
    }
}

/// Sends the scene to the worker; `fresh`: nothing of the present simulation is carried over.
pub(crate) fn submit_scene(state: &mut AppState, fresh: bool, effects: &mut Effects) {
    // An edit is of the present.
    state.show_time(None);
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

//! Commands are every edit and action of the window. Panels, canvas, menus and keys only push them;
//! [`apply`] is the one place that changes [`AppState`], split by group.
//!
//! - `scene`, `view`, `playback`, `file`: the commands and what each does
//! - `effects`: what applying them asks of the worker and the window
//! - `move_item`, `surface_projection`, `remove_item`, `waypoint`, `robot_hitch`, `unique_name`,
//!   `support_kind`, `blocked_route`: rules of edits that several commands share
//! - `resume`: time that goes on from an earlier answer
//! - `clipboard`, `import`: copy, paste, and maps from tables and drawings

mod blocked_route;
pub mod clipboard;
pub mod effects;
pub mod file;
mod import;
mod move_item;
pub mod playback;
mod remove_item;
mod resume;
mod robot_hitch;
pub mod scene;
pub mod support_kind;
mod surface_projection;
mod unique_name;
pub mod view;
pub mod waypoint;

pub use crate::command::effects::{Effects, submit_edit, submit_new_scene, submit_undone};
pub use crate::command::file::FileCommand;
pub use crate::command::playback::PlaybackCommand;
pub use crate::command::scene::SceneCommand;
pub use crate::command::view::ViewCommand;

use cable_core::{Model, Settings};

use crate::state::{AppState, FirstStep, Item};

/// A command.
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

/// The first step that a command completes.
fn first_step(command: &Command) -> Option<FirstStep> {
    match command {
        Command::Scene(SceneCommand::Move { item: Item::Support { .. } | Item::Robot, .. }) => Some(FirstStep::Drag),
        Command::Scene(SceneCommand::MoveAll(moved)) if !moved.is_empty() => Some(FirstStep::Drag),
        Command::Playback(PlaybackCommand::TogglePause | PlaybackCommand::SetPaused(false) | PlaybackCommand::Step) => {
            Some(FirstStep::Play)
        }
        // Driving the robot makes time run, too.
        Command::Playback(PlaybackCommand::DriveRobot(Some(speed))) if *speed != 0.0 => Some(FirstStep::Play),
        Command::View(ViewCommand::Zoom { .. }) => Some(FirstStep::Zoom),
        _ => None,
    }
}

/// Applies one command.
pub fn apply(state: &mut AppState, command: Command, effects: &mut Effects) {
    if let Some(step) = first_step(&command) {
        state.ui.first_steps.done(step);
    }
    match command {
        Command::Scene(c) => scene::apply(state, c, effects),
        Command::Playback(c) => {
            let pulls = matches!(c, PlaybackCommand::PullPastLength(true));
            playback::apply(state, c, effects);
            if pulls && scene::is_refused_pull(state) {
                // The pull that was refused is undone, and can be made again: a hand pulls while
                // time runs.
                state.live.playback.paused = false;
                scene::apply(state, SceneCommand::Undo, effects);
            }
        }
        Command::SetModel(model) => {
            state.solver.model = model;
            submit_edit(state, effects);
        }
        Command::SetSettings(settings) => {
            state.solver.settings = settings;
            submit_edit(state, effects);
        }
        Command::View(c) => view::apply(state, c, effects),
        Command::File(c) => file::apply(state, c, effects),
    }
}

//! Effects are the requests of applied commands to the world outside [`AppState`]: the worker, jobs
//! and files.

use std::path::PathBuf;

use cable_core::Scene;

use crate::jobs::safe_reach::SafeReachQuery;
use crate::state::AppState;
use crate::worker::request::{Edit, EditStart, Request};

/// The requests of applied commands to the world outside [`AppState`].
#[derive(Debug, Default)]
pub struct Effects {
    /// The request for the worker.
    pub request: Request,
    /// Close the window.
    pub quit: bool,
    /// Remove the recovery file.
    pub forget_recovery: bool,
    /// Start the solver thread anew.
    pub restart_worker: bool,
    /// Begin or end the search for safe places.
    pub reach: Option<Option<Box<SafeReachQuery>>>,
    /// Ask every model about a scene, or end that.
    pub models: Option<Option<Box<Scene>>>,
    /// Compare every model and mesh about a scene, or end that.
    pub work_precision: Option<Option<Box<Scene>>>,
    /// Draw the canvas with its legend to a file.
    pub picture: Option<PathBuf>,
    /// Text for the clipboard of the system.
    pub copied: Option<String>,
}

/// Sends a change of the scene to the worker: the present simulation is carried over.
pub fn submit_edit(state: &mut AppState, effects: &mut Effects) {
    submit(state, EditStart::PresentState, effects);
}

/// Sends an earlier scene to the worker: the cable lies as it did then.
pub fn submit_undone(state: &mut AppState, effects: &mut Effects) {
    submit(state, EditStart::Route, effects);
}

/// Sends another scene to the worker, which discards the present simulation.
pub fn submit_new_scene(state: &mut AppState, effects: &mut Effects) {
    submit(state, EditStart::NewScene, effects);
}

/// Sends the scene as edited to the worker.
fn submit(state: &mut AppState, start: EditStart, effects: &mut Effects) {
    // Edits apply to the live state, so a replay ends first.
    state.live.show_time(None);
    state.live.stopped_by_drag = None;
    let (scene, model, settings) = (state.document.scene.clone(), state.solver.model, state.solver.settings);
    let edit = Edit { scene, model, settings, start };
    effects.request.merge(Request {
        edit: Some(edit),
        playback: Some(state.live.playback),
        number: next_number(state),
        ..Request::default()
    });
}

/// Numbers the next edit.
pub fn next_number(state: &mut AppState) -> u64 {
    state.solver.edits_sent += 1;
    state.solver.edits_sent
}

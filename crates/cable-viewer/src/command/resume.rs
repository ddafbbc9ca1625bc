//! Time goes on from an earlier answer, or from before a restart.

use cable_core::scene::SupportKind;

use crate::command::effects::{Effects, next_number, submit_undone};
use crate::state::AppState;
use crate::state::dialog::Dialog;
use crate::state::live::{MIN_MOVE_M, ResetOrigin, RestartCause};
use crate::state::undo::EditKind;
use crate::worker::request::{Edit, EditStart, Request, Resume};

/// Takes the last restart back.
pub(super) fn undo_restart(state: &mut AppState, effects: &mut Effects) {
    let Some(run) = &state.live.earlier_run else { return };
    let by_edit = matches!(run.cause, RestartCause::Edit(_));
    let robot_speed_command = state.live.robot_speed_command;
    let present = ResetOrigin { scene: state.document.scene.clone(), robot_speed_command };
    if present.scene != *run.scene() {
        state.document.scene = state.document.undo.go_to(present.scene.clone(), run.scene());
        state.document.validate();
    }
    if by_edit {
        submit_undone(state, effects);
    }
    match state.live.undo_restart(present) {
        Some(RestartCause::Edit(_)) => resume_from_shown(state, effects),
        Some(RestartCause::Reset(origin)) => undo_reset(state, origin, effects),
        None => {}
    }
}

/// The run that a reset ended goes on, broken or not: the worker has kept it.
fn undo_reset(state: &mut AppState, origin: ResetOrigin, effects: &mut Effects) {
    state.live.playback.paused = true;
    state.live.robot_speed_command = origin.robot_speed_command;
    let edit = edit_of(state);
    effects.request.merge(Request {
        undo_reset: Some(Box::new(edit)),
        robot: Some(origin.robot_speed_command),
        number: next_number(state),
        ..Request::default()
    });
}

/// The scene, to be solved from where the cables are.
fn edit_of(state: &AppState) -> Edit {
    let (scene, model, settings) = (state.document.scene.clone(), state.solver.model, state.solver.settings);
    Edit { scene, model, settings, start: EditStart::PresentState }
}

/// Takes the answer shown as the present one: supports stand where they stood then.
pub(super) fn resume_from_shown(state: &mut AppState, effects: &mut Effects) {
    let Some(answer) = state.live.recording.displayed() else { return };
    state.live.playback.paused = true;
    if answer.cables.iter().any(|c| !c.breaks.is_empty()) {
        let title = "Time does not go on from here".to_owned();
        let text = "The cable has broken by then: choose a time before it broke".to_owned();
        state.ui.dialog = Some(Dialog::Message { title, text });
        return;
    }
    let before = state.document.scene.clone();
    for (cable, then) in state.document.scene.cables.iter_mut().zip(&answer.cables) {
        for (s, then) in cable.supports.iter_mut().zip(&then.supports) {
            let moved = s.at_m.is_some_and(|at| (at[0] - then.x_m).hypot(at[1] - then.y_m) > MIN_MOVE_M);
            if moved && s.motion.is_none() && s.kind != SupportKind::Pulley {
                s.at_m = Some([then.x_m, then.y_m]);
            }
        }
    }
    if state.document.scene != before {
        state.document.undo.record(&before, EditKind::Single);
    }
    state.document.validate();
    state.live.show_time(None);
    let resume = Some(Box::new(Resume { edit: edit_of(state), answer }));
    effects.request.merge(Request { resume, number: next_number(state), ..Request::default() });
}

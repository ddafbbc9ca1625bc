//! Time goes on from an earlier answer, or from before a restart.

use cable_core::scene::SupportKind;

use crate::command::effects::{Effects, next_number, submit_undone};
use crate::state::AppState;
use crate::state::dialog::Dialog;
use crate::state::live::MIN_MOVE_M;
use crate::state::undo::EditKind;
use crate::worker::request::{Edit, EditStart, Request, Resume};

/// Takes the last restart back.
pub(super) fn undo_restart(state: &mut AppState, effects: &mut Effects) {
    let scene = state.live.earlier_run.as_ref().and_then(|run| run.scene.clone());
    if let Some(scene) = scene {
        let present = state.document.scene.clone();
        state.document.scene = state.document.undo.go_to(present, &scene);
        state.document.validate();
        submit_undone(state, effects);
    }
    if state.live.undo_restart() {
        resume_from_shown(state, effects);
    }
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
    let edit = Edit {
        scene: state.document.scene.clone(),
        model: state.solver.model,
        settings: state.solver.settings,
        start: EditStart::PresentState,
    };
    let resume = Some(Box::new(Resume { edit, answer }));
    effects.request.merge(Request { resume, number: next_number(state), ..Request::default() });
}

//! The questions that jobs are asked follow from what is on screen; an answer to another question
//! is not shown.

use std::sync::Arc;

use cable_core::Scene;
use cable_core::analysis::friction_range::FrictionQuery;

use crate::jobs::friction_range::{self, MAX_RUN_S, recorded_actions};
use crate::jobs::neglected_bending;
use crate::jobs::safe_reach::{ReachSubject, movable};
use crate::state::app_state::AppState;
use crate::state::selection::Item;

/// Returns whether a query is the one that what is on screen asks.
#[must_use]
pub fn friction_query_fits(state: &AppState, query: &FrictionQuery) -> bool {
    query.span_s == run_time_s(state)
        && query.factors == state.analysis.friction_range.factors
        && query.model == state.solver.model
        && query.settings == state.solver.settings
        && query.scene == *answered_scene(state)
}

/// Returns what is on screen asks; None while it moves or has no answer.
#[must_use]
pub fn friction_query(state: &AppState) -> Option<FrictionQuery> {
    let still = state.live.playback.paused && state.selection.grab.is_none() && state.document.fault.is_none();
    let answered =
        state.live.snapshot.solution.is_some() && state.live.snapshot.error.is_none() && !state.live.snapshot.draft;
    (state.analysis.friction_range.on && still && answered).then(|| FrictionQuery {
        scene: answered_scene(state).clone(),
        model: state.solver.model,
        settings: state.solver.settings,
        factors: state.analysis.friction_range.factors,
        span_s: run_time_s(state),
        hands: recorded_actions(answered_scene(state), state.live.recording.answers()),
    })
}

fn answered_scene(state: &AppState) -> &Scene {
    state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene)
}

/// Returns how long time has run.
fn run_time_s(state: &AppState) -> f64 {
    let now_s = state.live.latest.solution.as_ref().map_or(0.0, |s| s.time_s);
    now_s.min(MAX_RUN_S)
}

/// The ribbon, if there is one of what is on screen.
#[must_use]
pub fn friction_answer(state: &AppState) -> Option<&friction_range::Outcome> {
    match &state.analysis.friction_range.progress {
        friction_range::Progress::Done(found)
            if state.analysis.friction_range.on && friction_query_fits(state, &found.1) =>
        {
            Some(found)
        }
        _ => None,
    }
}

/// The question about what is on screen; None where that is no answer at rest.
#[must_use]
pub fn bending_query(state: &AppState) -> Option<neglected_bending::Query> {
    let answer = state.live.snapshot.solution.clone().filter(|s| s.time_s == 0.0)?;
    let settled = state.live.snapshot.error.is_none() && !state.live.snapshot.draft && !state.live.snapshot.stale;
    let scene = state.live.snapshot.scene.clone().filter(|_| settled)?;
    Some(neglected_bending::Query { scene, settings: state.solver.settings, answer })
}

/// Returns whether what was asked is of the answer on screen.
#[must_use]
pub fn bending_query_fits(state: &AppState) -> bool {
    let shown = state.live.snapshot.solution.as_ref();
    state
        .analysis
        .neglected_bending
        .query
        .as_ref()
        .zip(shown)
        .is_some_and(|(query, shown)| Arc::ptr_eq(&query.answer, shown))
}

/// Returns what is taken somewhere: what was chosen, if it is still there.
#[must_use]
pub fn reach_target(state: &AppState) -> Option<ReachSubject> {
    let all = movable(&state.document.scene);
    let chosen = state.analysis.safe_reach.choice.moved.filter(|m| all.contains(m));
    let robot = || all.first().copied().filter(|m| *m == ReachSubject::Robot);
    let picked = || match state.selection.selected {
        Some(Item::Support { cable, support }) => {
            Some(ReachSubject::Support { cable, support }).filter(|m| all.contains(m))
        }
        _ => None,
    };
    let driven = || {
        let moves = |m: &&ReachSubject| match m {
            ReachSubject::Robot => false,
            ReachSubject::Support { cable, support } => {
                let s = state.document.scene.cables.get(*cable).and_then(|c| c.supports.get(*support));
                s.is_some_and(|s| s.motion.is_some())
            }
        };
        all.iter().find(moves).copied()
    };
    chosen.or_else(robot).or_else(picked).or_else(driven).or_else(|| all.last().copied())
}

//! The supports of a scene have a position on screen: where they are put, or where the cable took
//! them.

use cable_core::math::Point;
use cable_core::scene::SupportKind;
use cable_core::solution::SupportReaction;

use crate::state::AppState;

/// Nearer than this to where it is drawn, a support is there, m.
pub const COINCIDENCE_M: f64 = 1e-3;

/// Returns what the answer says of a support.
pub fn reaction(state: &AppState, cable: usize, support: usize) -> Option<&SupportReaction> {
    state.live.snapshot.solution.as_ref()?.cables.get(cable)?.supports.get(support)
}

/// Returns whether a cable has broken.
#[must_use]
pub fn is_broken(state: &AppState, cable: usize) -> bool {
    let solution = state.live.snapshot.solution.as_ref();
    solution.and_then(|s| s.cables.get(cable)).is_some_and(|c| !c.breaks.is_empty())
}

/// Returns where a support is on screen now: where the scene puts it, or where the cable took it.
#[must_use]
pub fn support_position(state: &AppState, cable: usize, support: usize) -> Option<Point> {
    let s = state.document.scene.cables.get(cable)?.supports.get(support)?;
    if let Some([behind, _]) = hand_spring(state, cable, support) {
        return Some(behind);
    }
    if let Some(now) = reaction(state, cable, support).filter(|now| now.hand.is_some()) {
        return Some([now.x_m, now.y_m]);
    }
    // One that a piece hangs on is where that is, and one that is torn off where the cable last
    // reached it.
    let holds = |now: &&SupportReaction| now.reaction_x_n != 0.0 || now.reaction_y_n != 0.0;
    if let Some(now) = reaction(state, cable, support).filter(|now| is_broken(state, cable) && holds(now)) {
        return Some([now.x_m, now.y_m]);
    }
    let solved = state.live.snapshot.solution.as_ref().and_then(|x| x.cables.get(cable));
    let answer = solved.and_then(|c| c.supports.get(support)).map(|r| [r.x_m, r.y_m]);
    let held = matches!(s.kind, SupportKind::Fixed | SupportKind::Clamped) && !is_broken(state, cable);
    // A moving or free support is where the answer says, and so is a still one on its way; while an
    // edit has no answer it is where it is put.
    match (s.at_m, &s.motion) {
        (Some(at), None) if held && answers_the_scene(state) => answer.or(Some(at)),
        (Some(at), None) => Some(at),
        (Some(at), Some(_)) => answer.or(Some(at)),
        (None, _) => answer,
    }
}

/// The answer on screen is of the scene as it is.
fn answers_the_scene(state: &AppState) -> bool {
    let shown = &state.live.snapshot;
    state.is_answered() && shown.error.is_none() && !shown.stale
}

/// Returns where a support is that a hand draws while masses move, and where the spring between
/// them ends, or where it is drawn to without one, m; None where it is there.
#[must_use]
pub fn hand_spring(state: &AppState, cable: usize, support: usize) -> Option<[Point; 2]> {
    if let Some(now) = reaction(state, cable, support)
        && let Some(hand) = &now.hand
    {
        let ends = [[now.x_m, now.y_m], [hand.x_m, hand.y_m]];
        return ((ends[0][0] - ends[1][0]).hypot(ends[0][1] - ends[1][1]) > COINCIDENCE_M).then_some(ends);
    }
    let s = state.document.scene.cables.get(cable)?.supports.get(support)?;
    // Of a broken cable a hand takes pieces farther than a whole one reaches: nothing draws them
    // back.
    if is_broken(state, cable) {
        return None;
    }
    let has_place = matches!(s.kind, SupportKind::Fixed | SupportKind::Clamped | SupportKind::Pulley);
    let solution = state.live.snapshot.solution.as_ref()?;
    let solved = solution.cables.get(cable)?;
    // Moved by the scene it is drawn to where its motion has it now.
    let moved = s.motion.as_ref().map(|m| m.at(solution.time_s).0).map(|p| [p.x, p.y]);
    let to = moved.or(s.at_m).filter(|_| has_place && s.release_s.is_none())?;
    let at = solved.supports.get(support).map(|r| [r.x_m, r.y_m])?;
    let far = (at[0] - to[0]).hypot(at[1] - to[1]) > COINCIDENCE_M;
    (far && solved.assumptions.inertia && !state.live.playback.paused).then_some([at, to])
}

//! This module continues from a state of another mesh or model.

use crate::math::{Vec2, perp};
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::remesh::{even_out, insert, remove};
use crate::model::fem::state::CableState;

use crate::state::State;

/// Inserts nodes in bars that cut off a corner of the state by more than the cable's radius, at the
/// point of the state that is farthest from the bar. So deep inside, a bar no longer shows on which
/// side of the corner the cable was, and could not be pushed out.
pub(in crate::model::fem) fn follow_corners(cable: &mut CableState, state: &State) {
    let (mut e, mut left) = (0, state.arc_length_m.len());
    while e + 1 < cable.mesh.nodes() {
        let farthest =
            if left > 0 && !IntersectionCheck::of(cable).is_clear(e) { farthest(cable, e, state) } else { None };
        let Some((s, at)) = farthest else {
            e += 1;
            continue;
        };
        insert(cable, e + 1, s, None);
        cable.motion.positions[e + 1] = at;
        cable.motion.velocities[e + 1] = state.velocity_at(s).unwrap_or_default();
        left -= 1;
    }
}

/// Arc length and place (m) of the node of a state that is farthest from a bar, if that is more
/// than the cable's radius.
fn farthest(cable: &CableState, e: usize, state: &State) -> Option<(f64, Vec2)> {
    let (s, x) = (&cable.mesh.arc_length, &cable.motion.positions);
    let (from, along) = (x[e], (x[e + 1] - x[e]).try_normalize(0.0)?);
    let near = cable.mesh.tuning.start.min_part * (s[e + 1] - s[e]);
    let nodes = state.arc_length_m.iter().copied().zip(state.position_m.iter().copied());
    let inside = nodes.filter(|(a, _)| *a > s[e] + near && *a < s[e + 1] - near);
    let off = |p: &Vec2| perp(along).dot(&(p - from)).abs();
    let farthest = inside.reduce(|a, b| if off(&b.1) > off(&a.1) { b } else { a })?;
    (off(&farthest.1) > cable.problem.radius).then_some(farthest)
}

/// Removes all sliding nodes.
pub(in crate::model::fem) fn remove_all_sliding_nodes(cable: &mut CableState) {
    let mut k = 1;
    while k + 1 < cable.mesh.nodes() {
        if cable.mesh.sliding[k].is_some() {
            remove(cable, k);
        } else {
            k += 1;
        }
    }
    even_out(cable);
}

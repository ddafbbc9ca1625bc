//! This module continues from a state of another mesh or model, and threads the cable through its
//! pulleys.

use std::sync::Arc;

use crate::math::{Vec2, perp};
use crate::model::fem::free::{Restraint, StationLayout};
use crate::model::fem::mesh::{BarEnd, SlideOver, SlidingNode};
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::remesh::{even_out, insert, remove};
use crate::model::fem::state::{CableState, renew_input};
use crate::problem::wheel_passage::facing;
use crate::scene::PulleySide;
use crate::state::State;

/// Puts a sliding node at every pulley: where `state` has the cable nearest to it, else where
/// the layout lays it.
pub(in crate::model::fem) fn thread_pulleys(cable: &mut CableState, state: Option<&State>) {
    let problem = Arc::clone(&cable.problem);
    let layout = StationLayout::new(&problem, cable.motion.time, &[], &[]);
    for station in &layout.stations {
        let (Restraint::Pulley(wheel), Some(support)) = (station.restraint, station.support) else { continue };
        let s = state.and_then(|s| s.on_round(wheel.center, wheel.radius)).unwrap_or(station.arc_length);
        let k = cable.mesh.arc_length.partition_point(|&a| a <= s).clamp(1, cable.mesh.nodes() - 1);
        let room = 0.05 * problem.length / cable.meshing.even_bars as f64;
        let (low, high) = (cable.mesh.arc_length[k - 1] + room, cable.mesh.arc_length[k] - room);
        let at = if low < high { s.clamp(low, high) } else { 0.5 * (low + high) };
        let passing = cable.motion.positions[k] - cable.motion.positions[k - 1];
        let up = if wheel.side == PulleySide::Over { 1.0 } else { -1.0 };
        let sense = -facing(wheel.side, passing);
        let end = BarEnd { center: wheel.center, radius: wheel.radius, mark: Vec2::new(0.0, up), sense };
        insert(cable, k, at, Some(SlidingNode::new(end, wheel.friction, SlideOver::Pulley(support))));
    }
    even_out(cable);
    renew_input(cable);
}

/// Bars that cut off by more than the cable's radius what the state leads round get a node
/// where the state is farthest from them: from there inside nothing tells on which side of a
/// corner they were, and nothing could push them out.
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

/// Takes all sliding nodes out.
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

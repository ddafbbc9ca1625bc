//! This module threads the cable through its pulleys.

use std::sync::Arc;

use crate::math::Vec2;
use crate::model::fem::free::{Restraint, StationLayout};
use crate::model::fem::mesh::{BarEnd, SlideOver, SlidingNode};
use crate::model::fem::remesh::clear_of_nodes;
use crate::model::fem::remesh::{even_out, insert};
use crate::model::fem::state::{CableState, renew_input};
use crate::problem::wheel_passage::facing;
use crate::problem::{Departure, Problem};
use crate::scene::PulleySide;
use crate::state::State;

/// Least distance of a new sliding node from the nodes beside it, in even bars. Smaller: bars so
/// short that the system is badly conditioned; larger: the node begins farther from where the
/// material lies on the wheel. A choice, tuned on no campaign.
const LEAST_NODE_DISTANCE_BARS: f64 = 0.05;

/// Puts a sliding node at every pulley that has none: at the material that is nearest to it in
/// `state`, else at the arc length of the layout.
pub(in crate::model::fem) fn thread_pulleys(cable: &mut CableState, state: Option<&State>) {
    let problem = Arc::clone(&cable.problem);
    let layout = StationLayout::new(&problem, cable.motion.time, &[], &[]);
    for station in &layout.stations {
        let (Restraint::Pulley(wheel), Some(support)) = (station.restraint, station.support) else { continue };
        if cable.mesh.pulley_center(support).is_some() || support_has_left(&problem, support) {
            continue;
        }
        let lies = state.and_then(|s| s.on_round(wheel.center, wheel.radius)).unwrap_or([station.arc_length; 2]);
        // Material nodes on the wheel would have no contact there.
        clear_of_nodes(cable, lies);
        let s = 0.5 * (lies[0] + lies[1]);
        let k = cable.mesh.arc_length.partition_point(|&a| a <= s).clamp(1, cable.mesh.nodes() - 1);
        let room = LEAST_NODE_DISTANCE_BARS * problem.length / cable.meshing.even_bars as f64;
        let (low, high) = (cable.mesh.arc_length[k - 1] + room, cable.mesh.arc_length[k] - room);
        let at = if low < high { s.clamp(low, high) } else { 0.5 * (low + high) };
        let passing = cable.motion.positions[k] - cable.motion.positions[k - 1];
        let up = Vec2::new(0.0, if wheel.side == PulleySide::Over { 1.0 } else { -1.0 });
        let sense = -facing(wheel.side, passing);
        // The mark is placed where the state has its material. Elsewhere the cable would be fed
        // over the wheel, and friction would hold it there.
        let outward = state.and_then(|state| (state.position_at(at)? - wheel.center).try_normalize(0.0));
        let mark = outward.filter(|_| wheel.radius > 0.0).unwrap_or(up);
        let end = BarEnd { center: wheel.center, radius: wheel.radius, mark, sense };
        insert(cable, k, at, Some(SlidingNode::new(end, wheel.friction, SlideOver::Pulley(support))));
    }
    even_out(cable);
    renew_input(cable);
}

/// True if the cable has left the wheel of a pulley.
fn support_has_left(problem: &Problem, support: usize) -> bool {
    problem.supports.get(support).is_some_and(|s| s.departure == Departure::Done)
}

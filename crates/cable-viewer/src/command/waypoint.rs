//! A waypoint is a pulley that is put onto a cable at a point of it.

use cable_core::Support;
use cable_core::math::Point;

use crate::command::unique_name::unique;
use crate::state::{AppState, Item};

/// The node of the present answer next to an arc length, m.
pub fn position_at(state: &AppState, cable: usize, arc_length_m: f64) -> Option<Point> {
    let nodes = &state.live.snapshot.solution.as_ref()?.cables.get(cable)?.nodes;
    let k = nodes.partition_point(|n| n.arc_length_m < arc_length_m).min(nodes.len().checked_sub(1)?);
    nodes.get(k).map(|n| [n.x_m, n.y_m])
}

/// Puts a waypoint onto a cable: at an arc length, m, and a place, m.
pub(super) fn add_waypoint(state: &mut AppState, cable: usize, arc_length_m: f64, at_m: Point) {
    let place = waypoint_place(state, cable, arc_length_m);
    let Some(c) = state.document.scene.cables.get_mut(cable) else { return };
    if c.supports.len() < 2 {
        return;
    }
    let place = place.clamp(1, c.supports.len() - 1);
    let name = unique("waypoint", |n| c.supports.iter().any(|s| s.name == n));
    c.supports.insert(place, Support::pulley(name, at_m));
    // A route laid before the waypoint existed may pass it on the wrong side.
    c.route_m.clear();
    state.selection.selected = Some(Item::Support { cable, support: place });
}

/// Returns which place among the supports a point of the cable falls into: after those that sit
/// before it now.
pub(super) fn waypoint_place(state: &AppState, cable: usize, arc_length_m: f64) -> usize {
    let answer = state.live.snapshot.solution.as_ref().and_then(|s| s.cables.get(cable));
    let (Some(answer), Some(c)) = (answer, state.document.scene.cables.get(cable)) else {
        return 1;
    };
    if answer.supports.len() != c.supports.len() {
        return 1;
    }
    answer.supports.iter().take_while(|s| s.arc_length_m < arc_length_m).count()
}

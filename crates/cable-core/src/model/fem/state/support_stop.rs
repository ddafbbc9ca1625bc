//! This module stops a support that is driven against an obstacle, and leaves the cable on the
//! surface when a support that stood there releases it.

use crate::math::Vec2;
use crate::model::fem::mesh::{Mesh, PUSHED_OUT_REACHES};
use crate::model::fem::state::CableState;
use crate::numerics::backtrack;
use crate::problem::Problem;

/// Round-off of a gap, m.
const GAP_ROUNDING: f64 = 1e-9;

/// The target `to` if it is at most `most` (m) away, else the point at that distance on the way to
/// it.
pub(super) fn no_farther_than(from: Vec2, to: Vec2, most: f64) -> Vec2 {
    let (way, distance) = (to - from, (to - from).norm());
    if distance > most { from + way * (most / distance) } else { to }
}

/// The point that a held node can reach on its way to a target before an obstacle stops it, m.
pub(in crate::model::fem) fn stopped_by_obstacles(problem: &Problem, mesh: &Mesh, from: Vec2, to: Vec2) -> Vec2 {
    if problem.world.is_empty() || from == to {
        return to;
    }
    let least_gap = mesh.tuning.step.support_gap_reaches * mesh.tuning.contact.reach_m;
    let gap = |p: Vec2| problem.world.signed_gap(p, least_gap).map_or(least_gap, |g| g.gap_m);
    // A support that the scene puts on a surface may stay there, but not come nearer.
    let least = gap(from) - GAP_ROUNDING;
    let free = problem.world.free_fraction([from, from], [to, to], mesh.tuning.step.kept_support_gap_fraction);
    let place = |part: f64| {
        let at = if part >= 1.0 { to } else { from + (to - from) * part };
        (gap(at) >= least).then_some(at)
    };
    let longest = if free >= 1.0 { 1.0 } else { free };
    backtrack(longest, mesh.tuning.step.stand_off_tries, place).unwrap_or(from)
}

/// Places the nodes of supports that release the cable between two times (s) on the surfaces on
/// which they stood. A held node has no contact and may be nearer to a surface than any force could
/// press it.
pub(in crate::model::fem) fn place_released_supports(cable: &mut CableState, [from, to]: [f64; 2]) {
    let clear = PUSHED_OUT_REACHES * cable.contacts.barrier.reach;
    for (support, node) in cable.problem.supports.iter().zip(&cable.meshing.support_node) {
        let Some(node) = node.filter(|_| support.holds_from(from) && !support.holds_from(to)) else { continue };
        let at = cable.motion.positions[node];
        if let Some(gap) = cable.problem.world.signed_gap(at, clear).filter(|g| g.gap_m < clear) {
            cable.motion.positions[node] = at + gap.normal * (clear - gap.gap_m);
        }
    }
}

//! This check finds whether the cable is at the places of its supports, and passes its pulleys on
//! the right side.

use super::checked_cable::CheckedCable;
use super::support_hold::Role;
use super::surroundings::distance;
use super::tolerance::SUPPORT_TOLERANCE;
use crate::math::{cross, larger, smaller};
use crate::scene::PulleySide;
use crate::solution::Node;
use crate::verification_report::{Law, Verification};

/// Checks that the cable is at the places of its supports, and passes its pulleys on the right
/// side.
pub(super) fn check_supports(checked: &CheckedCable<'_>, found: &mut Verification) {
    found.ask(Law::Support);
    let nodes = &checked.answer.nodes;
    let limit = SUPPORT_TOLERANCE * checked.cable.length_m;
    for (k, hold) in checked.holds.iter().enumerate() {
        let to_bar = |p: &[Node]| distance(hold.at, hold.at, p[0].at(), p[1].at());
        // Most pulleys are at the place of their reported arc length.
        let to_cable = |enough: f64| {
            let here = nodes.partition_point(|n| n.arc_length_m < hold.arc_length).clamp(1, nodes.len() - 1);
            let off = to_bar(&nodes[here - 1..=here]);
            if off <= enough { off } else { nodes.windows(2).map(to_bar).fold(off, smaller) }
        };
        let (off, limit) = match hold.role {
            Role::Load | Role::Released => continue,
            Role::Pulley => (to_cable(limit), larger(limit, checked.reach())),
            Role::Wheel { radius } => (to_cable(radius + limit) - radius, larger(limit, checked.reach())),
            Role::Clear { radius } => {
                let inside = larger(radius - to_cable(0.0), 0.0);
                let passes = !checked.answer.breaks.is_empty() || passes_on_its_side(checked, k);
                (if passes { inside } else { radius + inside }, larger(limit, checked.reach()))
            }
            Role::Held => {
                let from = nodes.partition_point(|n| n.arc_length_m < hold.arc_length - limit);
                let here = nodes[from..].iter().take_while(|n| n.arc_length_m <= hold.arc_length + limit);
                (here.map(|n| (n.at() - hold.at).norm()).fold(f64::INFINITY, smaller), limit)
            }
        };
        if !(off <= limit) {
            let node = nodes.partition_point(|n| n.arc_length_m < hold.arc_length);
            let mut finding = checked.finding(Law::Support, node, off, limit);
            finding.with.clone_from(&hold.support.name);
            found.report(finding);
        }
    }
}

/// Returns whether the cable passes a wheel on the side that the scene says: seen from its
/// centre, the cable from the support before to the one after turns clockwise where it runs
/// over the wheel to the right. A cable of which a support beside the wheel has let go may slip off
/// to any side.
fn passes_on_its_side(checked: &CheckedCable<'_>, k: usize) -> bool {
    let beside = |k: Option<usize>| k.and_then(|k| checked.holds.get(k));
    let (Some(before), Some(after)) = (beside(k.checked_sub(1)), beside(Some(k + 1))) else { return true };
    if [before, after].iter().any(|hold| hold.role == Role::Released) {
        return true;
    }
    let (hold, nodes) = (&checked.holds[k], &checked.answer.nodes);
    let node_at = |s: f64| nodes.partition_point(|n| n.arc_length_m < s).min(nodes.len() - 1);
    let [first, last] = [before, after].map(|h| node_at(h.arc_length));
    let turn = |p: &[Node]| {
        let [a, b] = [p[0].at() - hold.at, p[1].at() - hold.at];
        cross(a, b).atan2(a.dot(&b))
    };
    let swept: f64 = nodes[first..=last.max(first)].windows(2).map(turn).sum();
    let over = hold.support.side.unwrap_or_default() == PulleySide::Over;
    let clockwise = over == (after.at.x >= before.at.x);
    if clockwise { swept < 0.0 } else { swept > 0.0 }
}

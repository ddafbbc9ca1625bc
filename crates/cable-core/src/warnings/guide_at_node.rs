//! A guide is what leads a cable at a node of its answer: a wheel, a post, a corner, a support.

use crate::contact::nearest_corner::nearest_wrap_body;
use crate::math::Vec2;
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{CableSolution, ContactReport};

/// Distance from the centre of a wheel up to which a node is on it, in radii, and what is added for
/// wheels of no radius, m. Smaller: nodes of chords round it count as free; larger: nodes beside it
/// count as led.
const WHEEL_REACH_RADII: f64 = 1.05;
const WHEEL_REACH_M: f64 = 1e-6;
/// Arc length between a support without a wheel and a node within which it holds the node, m.
/// Smaller: bends of a clamp count as free; larger: bends beside it as held.
const SUPPORT_REACH_M: f64 = 1e-3;
/// Distance within which a load hangs on a node, as a fraction of the cable's length. Smaller: the
/// bend at a load counts as free; larger: so does none beside it.
const LOAD_REACH_FRACTION: f64 = 1e-6;

/// Gap (m) within which an obstacle leads the cable. Smaller: a contact that a model holds a
/// barrier's width off is missed; larger: what passes close by leads it. The models keep up to 1
/// mm.
const CONTACT_GAP: f64 = 3e-3;

/// The body that leads the cable at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Guide {
    /// No guide.
    Free,
    /// Something round: radius of the centre line, m.
    Round(f64),
    /// A sharp corner: radius of the arc on which the centre line can pass it, m.
    Corner(f64),
    /// A point that holds it, or pulls at it: a flexible cable has a corner there by its nature.
    Held,
}

/// Returns what leads the cable at a node of its answer.
pub(super) fn guide_at_node(problem: &Problem, answer: &CableSolution, node: usize) -> Guide {
    let Some(n) = answer.nodes.get(node) else { return Guide::Free };
    let at = |k: usize| answer.nodes.get(k).map(|n| Vec2::new(n.x_m, n.y_m));
    let here = Vec2::new(n.x_m, n.y_m);
    for (s, r) in problem.supports.iter().zip(&answer.supports) {
        let off = (here - Vec2::new(r.x_m, r.y_m)).norm();
        // On a wheel, give or take its chords.
        if off <= WHEEL_REACH_RADII * s.wheel_radius + WHEEL_REACH_M
            && (s.wheel_radius > 0.0 || (r.arc_length_m - n.arc_length_m).abs() < SUPPORT_REACH_M)
        {
            return match s.kind {
                SupportKind::Pulley if s.wheel_radius > 0.0 => Guide::Round(s.wheel_radius),
                SupportKind::Pulley => Guide::Corner(problem.radius),
                _ => Guide::Held,
            };
        }
    }
    if problem.loads.iter().any(|l| (l.arc_length - n.arc_length_m).abs() < LOAD_REACH_FRACTION * problem.length) {
        return Guide::Held;
    }
    if on_outline(problem, answer, node) {
        return Guide::Corner(problem.radius);
    }
    if problem.world.is_empty() {
        return Guide::Free;
    }
    // A flat edge does not bend the cable: only corners and circles do.
    let chain = [node.checked_sub(1), Some(node), Some(node + 1)].map(|k| k.and_then(at));
    let chain = chain.map(|p| p.unwrap_or(here));
    nearest_wrap_body(problem.world.geometry(), &chain, CONTACT_GAP)
        .map_or(Guide::Free, |b| if b.center.is_some() { Guide::Round(b.offset) } else { Guide::Corner(b.offset) })
}

/// Returns whether the cable lies on the outline of the robot at a node or beside it: that moves,
/// and is not among the obstacles.
fn on_outline(problem: &Problem, answer: &CableSolution, node: usize) -> bool {
    let Some(outline) = &problem.outline else { return false };
    let arc = |k: usize| answer.nodes.get(k).or(answer.nodes.last()).map_or(f64::NAN, |n| n.arc_length_m);
    let (before, after) = (arc(node.saturating_sub(1)), arc(node + 1));
    let lies = |c: &ContactReport| c.ends_m.max(c.arc_length_m) >= before && c.begins_m.min(c.arc_length_m) <= after;
    answer.contacts.iter().any(|c| c.obstacle == outline.name && lies(c))
}

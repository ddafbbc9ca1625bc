//! This module finds the other equilibria of a compressed stiff cable: it may bow to either side of
//! its chord, and may touch obstacles there.
//!
//! For a cable that touches nothing they are those shapes of the free cable
//! (`free/beam/buckled_shapes.rs`) that keep clear of obstacles. If one of them does not, or the
//! cable already touches something, its mirror image is pushed out of obstacles and relaxed as a
//! chain of bars.

use crate::math::{Vec2, larger};
use crate::model::fem::elastica;
use crate::model::fem::free::{LEAST_BUCKLING_LOAD, SAME_SHAPE_FRACTION};
use crate::model::initial_equilibrium::is_buried;
use crate::problem::Problem;
use crate::solution::error_estimates::{greatest_tension, place};
use crate::solution::{CableSolution, Histories, Node};

/// Depth inside an obstacle up to which a mirror image is pushed out, as a fraction of the cable's
/// length. Larger: more time; smaller: buckled shapes that lie on the ground are not found.
const PUSHED_OUT_FRACTION: f64 = 0.5;

/// Returns the equilibria of a compressed cable other than `answer`, at a time (s). `free` finds
/// the shapes of the same cable without obstacles, and is called only if the compression suffices
/// to buckle it. None if there is no other.
pub(in crate::model::fem) fn other_equilibria(
    problem: &Problem,
    time_s: f64,
    dragged: &[Option<Vec2>],
    answer: &CableSolution,
    free: impl FnOnce() -> Vec<Vec<Node>>,
) -> Option<Histories> {
    let pushes = answer.nodes.iter().map(|n| -n.tension_n).fold(0.0, larger);
    if !(pushes > LEAST_BUCKLING_LOAD * problem.bending_stiffness / (problem.length * problem.length)) {
        return None;
    }
    let mut shapes = free();
    shapes.extend(if answer.contacts.is_empty() { None } else { mirrored(problem, answer) });
    let mut found: Vec<Vec<Node>> = vec![answer.nodes.to_vec()];
    for shape in shapes {
        let other = match is_buried(problem, &shape) {
            false if answer.contacts.is_empty() => Some(shape),
            _ => elastica::rest_near(problem, time_s, dragged, &answer.nodes, &pushed_out(problem, shape)),
        };
        found.extend(other.filter(|nodes| found.iter().all(|f| are_apart(problem, f, nodes))));
    }
    let tensions = |nodes: &[Node]| {
        let at = |n: Option<&Node>| n.map_or(f64::NAN, |n| n.tension_n);
        [at(nodes.first()), at(nodes.last()), greatest_tension(nodes)]
    };
    let others: Vec<[f64; 3]> = found.iter().skip(1).map(|nodes| tensions(nodes)).collect();
    Histories::bowed_elsewhere(tensions(&answer.nodes), &others)
}

/// Returns whether two shapes are far enough apart to be two different equilibria.
fn are_apart(problem: &Problem, some: &[Node], others: &[Node]) -> bool {
    let off = |n: &Node| place(others, n.arc_length_m).map_or(0.0, |at| (at - n.at()).norm());
    some.iter().map(off).fold(0.0, larger) > SAME_SHAPE_FRACTION * problem.length
}

/// The mirror image of each part of a cable about the chord between its supports; None if no part
/// lies between two supports.
fn mirrored(problem: &Problem, answer: &CableSolution) -> Option<Vec<Node>> {
    let supports_in_place = problem.supports.iter().zip(&answer.supports).filter(|(s, _)| s.at.is_some());
    let stops: Vec<(f64, Vec2)> = supports_in_place.map(|(_, r)| (r.arc_length_m, Vec2::new(r.x_m, r.y_m))).collect();
    let mut nodes = answer.nodes.to_vec();
    let mut any = false;
    for part in stops.windows(2) {
        let [(from, a), (to, b)] = [part[0], part[1]];
        let Some(along) = (b - a).try_normalize(SAME_SHAPE_FRACTION * problem.length) else { continue };
        any = true;
        for n in nodes.iter_mut().filter(|n| n.arc_length_m > from && n.arc_length_m < to) {
            let off = n.at() - a;
            let image = a + along * (2.0 * along.dot(&off)) - off;
            (n.x_m, n.y_m) = (image.x, image.y);
        }
    }
    any.then_some(nodes)
}

/// The nodes, with those inside an obstacle moved to its surface.
fn pushed_out(problem: &Problem, mut nodes: Vec<Node>) -> Vec<Node> {
    for n in &mut nodes {
        if let Some(gap) =
            problem.world.signed_gap(n.at(), PUSHED_OUT_FRACTION * problem.length).filter(|g| g.gap_m < 0.0)
        {
            let at = n.at() - gap.normal * gap.gap_m;
            (n.x_m, n.y_m) = (at.x, at.y);
        }
    }
    nodes
}

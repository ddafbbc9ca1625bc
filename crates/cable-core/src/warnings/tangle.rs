//! Tangles are loops, curls and wraps, found by the shape of the cable alone.
//!
//! In the plane nobody can tell which strand of a crossing lies on top, so a knot cannot be told
//! from a loop: crossings are named, knots are not.

use crate::math::{Vec2, angle};
use crate::problem::Problem;
use crate::solution::{CableSolution, Node, Warning, WarningCause};

use super::guide_at_node::{Guide, guide_at_node};
use crate::contact::self_crossings::{SelfCrossing, crossings};

/// Turn at a node, rad, below which it does not matter what leads the node. Smaller: straight cable
/// along an edge is no part of a loop; larger: gentle bends that an obstacle makes are.
const NEGLIGIBLE_TURN_RAD: f64 = 1e-3;

/// Least sine of the angle at which strands cross. Smaller: a cable that lies along itself, out and
/// back, crosses itself in every element; larger: flat loops are missed. 10° is above what element
/// ends stand out of a straight lay.
const CROSSING_SINE: f64 = 0.17;

/// Shortest loop, in diameters of the cable. Shorter ones are folds of single elements, and kinks.
const LOOP_DIAMETERS: f64 = 4.0;

/// Most loops named of one cable.
const MAX_LOOPS: usize = 8;

/// Turn of a free part that makes a curl, rad: 270°. A cable that hangs turns by less than 180°; a
/// loop that is about to close, and jump into a kink when pulled, by about 270°.
const CURL_TURN: f64 = 1.5 * std::f64::consts::PI;

/// Greatest mean radius of a curl, in smallest bend radii (or five diameters where none is stated).
/// Larger: a cable laid in a wide bow on a floor is a curl; smaller: only curls about to kink are.
const CURL_RADII: f64 = 10.0;

/// Turns round an obstacle from which it is wrapped: one whole turn, when pulling an end cannot
/// free it.
const WRAP_TURNS: f64 = 1.0;

/// Appends loops, the tightest curl and what it is wrapped round.
pub(super) fn warn(problem: &Problem, answer: &CableSolution, out: &mut Vec<Warning>) {
    loops(problem, answer, out);
    curl(problem, answer, out);
    wraps(problem, answer, out);
}

fn at(n: &Node) -> Vec2 {
    Vec2::new(n.x_m, n.y_m)
}

/// Appends the loops of a cable that crosses itself, the tightest first.
fn loops(problem: &Problem, answer: &CableSolution, out: &mut Vec<Warning>) {
    let points: Vec<Vec2> = answer.nodes.iter().map(at).collect();
    let found = crossings(&points, |k| !answer.breaks.contains(&(k + 1)));
    let arc = |k: usize, f: f64| {
        let s = |k: usize| answer.nodes.get(k).map_or(0.0, |n| n.arc_length_m);
        s(k) + (s(k + 1) - s(k)) * f
    };
    let name = &problem.cable.name;
    let least = LOOP_DIAMETERS * problem.cable.diameter_m;
    let spans = |c: &SelfCrossing| [arc(c.first, c.fractions[0]), arc(c.second, c.fractions[1])];
    let real = |c: &&SelfCrossing| c.sine >= CROSSING_SINE && spans(c)[1] - spans(c)[0] >= least;
    let mut all: Vec<&SelfCrossing> = found.iter().filter(real).collect();
    let count = all.len();
    // The tightest first; of loops in or across each other one is named: a heap would be a list of
    // almost the same.
    let length = |c: &SelfCrossing| spans(c)[1] - spans(c)[0];
    all.sort_by(|a, b| length(a).total_cmp(&length(b)));
    let mut named: Vec<[f64; 2]> = Vec::new();
    for c in all {
        let [s, t] = spans(c);
        if named.len() == MAX_LOOPS || named.iter().any(|[a, b]| s < *b && *a < t) {
            continue;
        }
        named.push([s, t]);
        let p = points[c.first] + (points[c.first + 1] - points[c.first]) * c.fractions[0];
        let cause = WarningCause::Crossing { other_arc_length_m: t, count };
        out.push(Warning::new(cause, name, s, [t - s, least]).at(p.into()));
    }
}

/// The turn of the cable at each node, rad, 0 at the ends of pieces; nodes on each other turn
/// together at the last.
pub(super) fn turns(nodes: &[Node]) -> Vec<f64> {
    let mut out = vec![0.0; nodes.len()];
    let mut before: Option<Vec2> = None;
    for k in 1..nodes.len() {
        let way = at(&nodes[k]) - at(&nodes[k - 1]);
        if way.norm_squared() > 0.0 {
            if let Some(b) = before {
                out[k - 1] = angle(b, way);
            }
            before = Some(way);
        }
    }
    out
}

/// Appends the tightest full turn of a free stretch.
fn curl(problem: &Problem, answer: &CableSolution, out: &mut Vec<Warning>) {
    let least = problem.cable.min_bend_radius_m;
    let radius = if least > 0.0 { least } else { 5.0 * problem.cable.diameter_m };
    let longest = CURL_TURN * CURL_RADII * radius;
    let mut tightest: Option<FullTurn> = None;
    let mut start = 0;
    for piece in answer.pieces() {
        let turns = turns(piece);
        for sign in [1.0, -1.0] {
            let all: f64 = turns.iter().map(|t| sign * t).filter(|t| *t > 0.0).sum();
            if all < CURL_TURN {
                continue;
            }
            let is_tightest = |f: &FullTurn| f.length <= longest && tightest.is_none_or(|t| f.length < t.length);
            if let Some(found) = shortest_turn(piece, |k| sign * turns[k]).filter(is_tightest) {
                // Only where nothing leads it: the turns of wheels, posts and corners are not its
                // own.
                let free = |k: usize| {
                    turns[k].abs() < NEGLIGIBLE_TURN_RAD
                        || matches!(guide_at_node(problem, answer, start + k), Guide::Free)
                };
                if (found.first..=found.last).all(free) {
                    let (first, last) = (start + found.first, start + found.last);
                    tightest = Some(FullTurn { first, last, ..found });
                }
            }
        }
        start += piece.len();
    }
    if let Some(FullTurn { length, first, last }) = tightest
        && let Some(middle) = answer.nodes.get((first + last) / 2)
    {
        let (name, turn) = (&problem.cable.name, CURL_TURN.to_degrees());
        let warning = Warning::new(WarningCause::TightTurn { within_m: length }, name, middle.arc_length_m, [turn; 2]);
        out.push(warning.at([middle.x_m, middle.y_m]));
    }
}

/// A run of nodes whose turns add up to [`CURL_TURN`].
#[derive(Clone, Copy)]
struct FullTurn {
    /// Length of cable, m.
    length: f64,
    /// Index of its first node.
    first: usize,
    /// Index of its last node.
    last: usize,
}

/// The shortest full turn of nodes with these turns (rad). Starts that a later, lower sum makes
/// useless are dropped, so each node is looked at twice at most.
fn shortest_turn(nodes: &[Node], turn: impl Fn(usize) -> f64) -> Option<FullTurn> {
    let mut best: Option<FullTurn> = None;
    let mut starts: std::collections::VecDeque<(usize, f64)> = std::collections::VecDeque::new();
    let mut sum = 0.0;
    for k in 0..nodes.len() {
        while starts.back().is_some_and(|(_, s)| *s >= sum) {
            starts.pop_back();
        }
        starts.push_back((k, sum));
        sum += turn(k);
        while let Some(&(i, s)) = starts.front()
            && sum - s >= CURL_TURN
        {
            let length = nodes[k].arc_length_m - nodes[i].arc_length_m;
            if best.is_none_or(|b| length < b.length) {
                best = Some(FullTurn { length, first: i, last: k });
            }
            starts.pop_front();
        }
    }
    best
}

/// Appends the obstacles round which the cable is wrapped.
fn wraps(problem: &Problem, answer: &CableSolution, out: &mut Vec<Warning>) {
    for body in problem.world.geometry().bodies().iter().filter(|b| !b.is_ground()) {
        let of_it = || answer.contacts.iter().filter(|c| c.obstacle == body.name);
        let turns = of_it().map(|c| c.turn_deg).sum::<f64>().abs() / 360.0;
        let hardest = of_it().max_by(|a, b| a.normal_n.total_cmp(&b.normal_n));
        if let Some(c) = hardest.filter(|_| turns >= WRAP_TURNS) {
            let name = &problem.cable.name;
            let cause = WarningCause::RoundObstacle { obstacle: body.name.clone() };
            out.push(Warning::new(cause, name, c.arc_length_m, [turns, WRAP_TURNS]).at([c.x_m, c.y_m]));
        }
    }
}

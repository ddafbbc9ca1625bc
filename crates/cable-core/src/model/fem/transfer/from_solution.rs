//! This module continues from a solution, of another model or an earlier instant, with its
//! friction.
//!
//! A [`State`] holds positions; an answer also holds tensions. Between two places of the cable with
//! forces F₁ = T₁t₁ and F₂ = T₂t₂ the obstacles exert the force C = F₁ − F₂ − bΔs: N = C·n is the
//! normal force there and C·t friction. Friction here is a spring of the length ε to an anchor
//! (`contact/friction.rs`) with the force μN(2y/ε − y|y|/ε²): each contact stores the slide y that
//! gives the friction of the answer. Corners and posts get their sliding nodes at once, with the
//! material that the answer has there.

use crate::math::{Vec2, larger, perp, smaller};
use crate::model::fem::mesh::{BarEnd, SlideOver, SlidingNode, angle_between, rotate, round_of};
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::remesh::{clear_of_nodes, insert, remove};
use crate::model::fem::state::CableState;
use crate::model::fem::system::ContactPair;
use crate::solution::Node;
use crate::state::State;

/// Distance over which directions are read, as a fraction of an even bar.
const DIRECTION_DISTANCE_BARS: f64 = 1e-3;

/// Distance from a round within which a node of an answer lies on it, as a fraction of its radius.
const ROUND_DISTANCE_RADII: f64 = 1e-3;

/// Tension below which a bar is slack, as a fraction of the greatest. Smaller: the round-off of an
/// answer counts as tension, and loose bars lose material; larger: taut bars are given too much
/// material.
const SLACK_TENSION_FRACTION: f64 = 1e-6;

/// The nodes of an answer, interpolated as a curve.
pub(in crate::model::fem) struct SolutionCurve<'a>(pub(in crate::model::fem) &'a [Node]);

impl SolutionCurve<'_> {
    /// The nodes on either side of a material point (m), and its place between them, 0 to 1.
    fn around(&self, s: f64) -> Option<(&Node, &Node, f64)> {
        let nodes = self.0;
        let k = nodes.partition_point(|n| n.arc_length_m <= s).clamp(1, nodes.len().max(2) - 1);
        let (a, b) = (nodes.get(k - 1)?, nodes.get(k)?);
        let d = b.arc_length_m - a.arc_length_m;
        Some((a, b, if d > 0.0 { ((s - a.arc_length_m) / d).clamp(0.0, 1.0) } else { 0.0 }))
    }

    fn tension(&self, s: f64) -> f64 {
        self.around(s).map_or(0.0, |(a, b, f)| a.tension_n + (b.tension_n - a.tension_n) * f)
    }

    /// Position (m) on the parabola with the curvature and strain between two nodes. Where an arc
    /// begins the curvature jumps, and the smaller value is used.
    fn place(&self, s: f64) -> Option<Vec2> {
        let (a, b, f) = self.around(s)?;
        let (from, to) = (a.at(), b.at());
        let (p, q) = (a.curvature_per_m, b.curvature_per_m);
        let curvature = match p * q > 0.0 {
            true if p.abs() < q.abs() => p,
            true => q,
            false => 0.0,
        };
        let chord = to - from;
        let bulge = 0.5 * f * (1.0 - f);
        let along = f - (b.strain - a.strain) * bulge;
        Some(from + chord * along - perp(chord) * (curvature * (b.arc_length_m - a.arc_length_m) * bulge))
    }

    /// Arc length (m) at an angle (rad) from the beginning of an arc.
    fn at_turn(&self, arc: &RoundArc, angle: f64) -> f64 {
        let center = arc.node.end.center;
        let mut turned = 0.0;
        for n in self.0[arc.nodes[0]..=arc.nodes[1]].windows(2) {
            let step = angle_between(n[0].at() - center, n[1].at() - center).abs();
            if turned + step >= angle && step > 0.0 {
                let part = (angle - turned) / step;
                return n[0].arc_length_m + part * (n[1].arc_length_m - n[0].arc_length_m);
            }
            turned += step;
        }
        arc.material[1]
    }

    fn direction(&self, s: f64, near: f64) -> Option<Vec2> {
        let d = self.place(s + near)? - self.place(s - near)?;
        (d.norm() > 0.0).then(|| d.normalize())
    }

    fn force(&self, s: f64, near: f64) -> Option<Vec2> {
        Some(self.direction(s, near)? * self.tension(s))
    }
}

/// A state with the nodes of this mesh at their positions in the answer.
pub(in crate::model::fem) fn state_of_solution(cable: &CableState, curve: &SolutionCurve<'_>, whole: &State) -> State {
    let mut s = whole.arc_length_m.clone();
    s.extend(&cable.mesh.arc_length);
    s.sort_by(f64::total_cmp);
    s.dedup();
    let at = |s: &f64| curve.place(*s).or_else(|| whole.position_at(*s)).unwrap_or_default();
    State {
        time_s: whole.time_s,
        position_m: s.iter().map(at).collect(),
        velocity_m_per_s: s.iter().map(|s| whole.velocity_at(*s).unwrap_or_default()).collect(),
        arc_length_m: s,
        in_motion: whole.in_motion,
    }
}

/// Restores the positions of nodes before they were pushed clear of obstacles.
pub(in crate::model::fem) fn restore_positions(cable: &mut CableState, state: &State) {
    for k in 0..cable.mesh.nodes() {
        if let (None, Some(at)) = (cable.mesh.sliding[k], state.position_at(cable.mesh.arc_length[k])) {
            cable.motion.positions[k] = at;
        }
    }
}

/// Puts sliding nodes on the rounds on which the answer lies.
pub(in crate::model::fem) fn adopt_sliding_nodes(cable: &mut CableState, curve: &SolutionCurve<'_>) {
    if !cable.meshing.slides {
        return;
    }
    for arc in arcs_of_solution(cable, curve) {
        let tension = curve.tension(0.5 * (arc.material[0] + arc.material[1]));
        if cable.meshing.bends_visibly(&cable.mesh, cable.mesh.bending_stiffness, tension) {
            continue;
        }
        let round = arc.node.end.radius * arc.turn;
        let many = 0.5 * arc.turn > cable.mesh.tuning.remesh.max_marked_arc_rad
            && 0.5 * round > cable.mesh.tuning.remesh.one_mark_bars * cable.even();
        let bars = if many { (cable.mesh.tuning.start.marks_per_bar * round / cable.even()).round() } else { 1.0 };
        let marks = (arc.turn
            / if many {
                cable.mesh.tuning.remesh.max_marked_arc_rad
            } else {
                2.0 * cable.mesh.tuning.remesh.max_tangent_half_turn_rad
            })
        .ceil()
        .max(bars);
        for i in 0..marks as usize {
            let part = (i as f64 + 0.5) / marks;
            let end = arc.node.end;
            let mark = rotate(end.mark, end.sense * part * arc.turn);
            let at = curve.at_turn(&arc, part * arc.turn);
            add_sliding_node(cable, at, SlidingNode { end: BarEnd { mark, ..end }, ..arc.node });
        }
        clear_of_nodes(cable, arc.material);
    }
}

/// Adds a sliding node at a material point (m).
fn add_sliding_node(cable: &mut CableState, s: f64, node: SlidingNode) {
    let near = cable.mesh.tuning.remesh.min_bar * cable.even();
    let k = cable.mesh.arc_length.partition_point(|&a| a <= s);
    for j in [k, k.wrapping_sub(1)] {
        let spare = cable.mesh.arc_length.get(j).is_some_and(|a| (a - s).abs() < near);
        if spare && cable.meshing.removable(&cable.mesh, j) && cable.mesh.sliding[j].is_none() {
            remove(cable, j);
        }
    }
    let k = cable.mesh.arc_length.partition_point(|&a| a <= s);
    if k > 0 && k < cable.mesh.nodes() {
        insert(cable, k, s, Some(node));
    }
}

/// The rounds on which the answer lies, in order.
fn arcs_of_solution(cable: &CableState, curve: &SolutionCurve<'_>) -> Vec<RoundArc> {
    let geometry = cable.problem.world.geometry();
    let mut out: Vec<RoundArc> = Vec::new();
    for (i, n) in curve.0.iter().enumerate() {
        let within = ROUND_DISTANCE_RADII * cable.problem.radius;
        let Some(gap) = cable.problem.world.signed_gap(n.at(), within).filter(|g| g.gap_m.abs() <= within) else {
            continue;
        };
        let slide_over = SlideOver::Obstacle { obstacle: gap.obstacle, feature: gap.feature };
        let clearance = IntersectionCheck::of(cable).clearance(gap.feature);
        let round = round_of(geometry, gap.feature, clearance, cable.mesh.tuning.remesh.min_turn_rad);
        let (Some((center, radius)), true) = (round, gap.feature % 2 == 1) else { continue };
        if out.last().is_some_and(|a| a.node.slide_over == slide_over && a.nodes[1] + 1 >= i) {
            continue;
        }
        let end = BarEnd { center, radius, mark: gap.normal, sense: 1.0 };
        let node = SlidingNode::new(end, gap.friction, slide_over);
        let mut arc = RoundArc { nodes: [i, i], turn: 0.0, material: [n.arc_length_m; 2], node };
        arc.grow(curve, radius - clearance);
        if arc.turn > cable.mesh.tuning.remesh.min_turn_rad {
            out.push(arc);
        }
    }
    out
}

/// Gives every bar between two nodes in contact the material with which it has the tension of the
/// answer: rounds are wider than the answer's by the barrier's reach, which would be a large strain
/// between two sticking corners. The spans on either side give that material: a loose end gives all
/// of it, two spans share it by their lengths.
pub(in crate::model::fem) fn adopt_stretch(cable: &mut CableState, curve: &SolutionCurve<'_>) {
    let on = |d: &CableState, k: usize| {
        d.mesh.sliding[k].is_some()
            || (d.meshing.removable(&d.mesh, k)
                && d.problem.world.signed_gap(d.motion.positions[k], 2.0 * d.contacts.barrier.reach).is_some())
    };
    let nodes = cable.mesh.nodes();
    let mut first = 1;
    while first + 1 < nodes {
        let last = (first..nodes - 1).take_while(|&k| on(cable, k)).last();
        let Some(last) = last else {
            first += 1;
            continue;
        };
        let next = (last + 1..nodes - 1).find(|&k| on(cable, k)).unwrap_or(nodes - 1);
        stretch_run(cable, curve, [first, last], next);
        first = last + 1;
    }
    for e in 0..cable.mesh.rest_length.len() {
        let length = cable.mesh.arc_length[e + 1] - cable.mesh.arc_length[e];
        cable.mesh.rest_length[e] = cable.mesh.thermal_stretch * length;
    }
    cable.motion.previous_arc_length.clone_from(&cable.mesh.arc_length);
}

/// Does this for a run of successive nodes in contact; `next` is the next node that is held or in
/// contact.
fn stretch_run(cable: &mut CableState, curve: &SolutionCurve<'_>, [first, last]: [usize; 2], next: usize) {
    let s = cable.mesh.arc_length.clone();
    let greatest = curve.0.iter().map(|n| n.tension_n).fold(0.0, larger);
    // A loose bar has no tension and more material than path: it keeps its material.
    let mut bars: Vec<BarMaterial> = (first..last)
        .map(|e| {
            let (material, tension) = (s[e + 1] - s[e], curve.tension(0.5 * (s[e] + s[e + 1])));
            let strained = cable.mesh.thermal_stretch * (1.0 + tension / cable.mesh.axial_stiffness);
            let taut = cable.mesh.path(e, &cable.motion.positions).length / strained;
            let loose = tension <= SLACK_TENSION_FRACTION * greatest && taut < material;
            BarMaterial {
                length: if loose { material } else { taut },
                spare: if loose { material - taut } else { 0.0 },
            }
        })
        .collect();
    let taken = share_with_loose_bars(&mut bars, s[last] - s[first]);
    let mut lengths = vec![0.0; last + 1 - first];
    for (k, bar) in bars.iter().enumerate() {
        lengths[k + 1] = lengths[k] + bar.length;
    }
    let before = (0..first).rev().find(|&k| k == 0 || !cable.meshing.removable(&cable.mesh, k)).unwrap_or(0);
    let give = |k: usize, length: f64| {
        if cable.mesh.fixity[k] || cable.mesh.sliding[k].is_some() { length } else { f64::INFINITY }
    };
    let [left, right] = [give(before, s[first] - s[before]), give(next, s[next] - s[last])];
    let share = match (left.is_finite(), right.is_finite()) {
        (true, true) => left / (left + right),
        (false, true) => 1.0,
        (true, false) => 0.0,
        (false, false) => 0.5,
    };
    let from = s[first] - taken * share;
    let least = DIRECTION_DISTANCE_BARS * cable.even();
    if from > s[first - 1] + least && from + lengths[last - first] < s[last + 1] - least {
        for (k, length) in lengths.iter().enumerate() {
            cable.mesh.arc_length[first + k] = from + length;
        }
    }
}

/// The material of a bar beside obstacles.
struct BarMaterial {
    /// Length of its material, m.
    length: f64,
    /// Length beyond that of the straight bar, m.
    spare: f64,
}

/// Changes the lengths of loose bars so that the sum over all bars is `length` (m), as far as
/// possible: loose bars give their spare material, and take a surplus. Returns the remaining
/// difference, m.
fn share_with_loose_bars(bars: &mut [BarMaterial], length: f64) -> f64 {
    let over = bars.iter().map(|b| b.length).sum::<f64>() - length;
    let spare: f64 = bars.iter().map(|b| b.spare).sum();
    if !(spare > 0.0) {
        return over;
    }
    let given = smaller(over, spare);
    for bar in bars {
        bar.length -= given * bar.spare / spare;
    }
    over - given
}

/// Plan view: stores the slide of every node with which the floor has the friction of the answer
/// there, as far as possible.
pub(in crate::model::fem) fn adopt_floor_friction(cable: &mut CableState, curve: &SolutionCurve<'_>) {
    if cable.problem.floor_friction.is_none() {
        return;
    }
    let s = &cable.mesh.arc_length;
    let near = DIRECTION_DISTANCE_BARS * cable.even();
    for (k, limit) in
        cable.input.loads.floor_limit.iter().enumerate().filter(|(k, l)| **l > 0.0 && !cable.mesh.fixity[*k])
    {
        let low = 0.5 * (s[k] + s[k.saturating_sub(1)]);
        let high = 0.5 * (s[k] + s[(k + 1).min(s.len() - 1)]);
        let asked = match cable.mesh.sliding[k] {
            // The floor's friction acts there first, and the round takes the rest.
            Some(_) => Some(Vec2::new(curve.tension(low) - curve.tension(high), 0.0)),
            None => match (curve.force(low, near), curve.force(high, near)) {
                (Some(before), Some(after)) => Some(after - before + cable.input.loads.body * (high - low)),
                _ => None,
            },
        };
        let Some((asked, way)) = asked.and_then(|a| Some((a.norm(), a.try_normalize(0.0)?))) else { continue };
        // The friction of the floor is R(2u − u²).
        let part = if asked < *limit { asked / limit } else { 1.0 };
        cable.contacts.floor_slip[k] = way * (cable.contacts.slip * (1.0 - (1.0 - part).sqrt()));
    }
}

/// Stores the slide of every contact that gives the friction of the answer.
pub(in crate::model::fem) fn adopt_friction(cable: &mut CableState, curve: &SolutionCurve<'_>) {
    let mut touches: Vec<ContactPair> = Vec::new();
    cable.contacts.find(&cable.problem, &cable.mesh, &cable.motion.positions, &mut touches);
    let s = &cable.mesh.arc_length;
    let near = DIRECTION_DISTANCE_BARS * cable.even();
    for touch in &touches {
        let k = touch.node;
        let (low, high) = if touch.on_segment {
            (s[k], s[k + 1])
        } else {
            (0.5 * (s[k] + s[k.saturating_sub(1)]), 0.5 * (s[k] + s[(k + 1).min(s.len() - 1)]))
        };
        let (Some(before), Some(after)) = (curve.force(low, near), curve.force(high, near)) else { continue };
        let pushed = before - after - cable.input.loads.body * (high - low);
        let normal = pushed.dot(&touch.pair.gap.normal);
        let limit = touch.pair.gap.friction * normal;
        if limit > 0.0 {
            // The force on the node is −μN(2u − u|u|) along the tangent.
            let part = (-pushed.dot(&touch.tangent()) / limit).clamp(-1.0, 1.0);
            let u = part.signum() * (1.0 - (1.0 - part.abs()).sqrt());
            cable.contacts.remember(touch, u * cable.contacts.slip);
        }
    }
}

/// A round on which an answer lies; the mark of its node is where the cable meets it.
struct RoundArc {
    /// First and last node of the answer on it.
    nodes: [usize; 2],
    /// Whole turn, rad.
    turn: f64,
    /// Material at both ends, m.
    material: [f64; 2],
    node: SlidingNode,
}

impl RoundArc {
    /// Extends the arc by all nodes before and after it that lie on a round of this radius (m).
    fn grow(&mut self, curve: &SolutionCurve<'_>, radius: f64) {
        let center = self.node.end.center;
        let is_on_round = |n: &Node| ((n.at() - center).norm() - radius).abs() <= ROUND_DISTANCE_RADII * radius;
        let before = curve.0[..self.nodes[0]].iter().rev().take_while(|n| is_on_round(n)).count();
        let after = curve.0[self.nodes[1]..].iter().skip(1).take_while(|n| is_on_round(n)).count();
        self.nodes = [self.nodes[0] - before, self.nodes[1] + after];
        let on = &curve.0[self.nodes[0]..=self.nodes[1]];
        let whole: f64 = on.windows(2).map(|n| angle_between(n[0].at() - center, n[1].at() - center)).sum();
        self.turn = whole.abs();
        self.material = [on[0].arc_length_m, on[on.len() - 1].arc_length_m];
        self.node.end.sense = if whole < 0.0 { -1.0 } else { 1.0 };
        // Nodes of the answer lie on the round within a fraction of its radius.
        self.node.end.mark = (on[0].at() - center).try_normalize(0.0).unwrap_or(self.node.end.mark);
    }
}

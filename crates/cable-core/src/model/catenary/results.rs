//! This module turns a solution into nodes, close enough for straight lines between them, and
//! support reactions.

use super::equilibrium::{Equilibrium, required_friction};
use super::sliding_problem::SlidingProblem;
use super::supports_and_loads::SupportLayout;
use super::wheel::traverse_wheel;
use crate::catenary::Catenary;
use crate::math::{Vec2, cross, perp};
use crate::model::arc_nodes;
use crate::model::auxiliary_weight::remove_auxiliary_weight;
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{Node, SupportReaction};

/// Difference of arc lengths within which two nodes are at one material point, as a fraction of the
/// cable's length: round-off. Smaller: nodes that round-off makes two; larger: near nodes are lost.
const SAME_POINT_FRACTION: f64 = 1e-12;

/// Greatest distance of the cable from the straight line between two nodes, as a fraction of its
/// length. Larger: a picture shows corners, and sag read between nodes is off by as much. Smaller:
/// thousands of nodes.
const MAX_CHORD_DISTANCE_FRACTION: f64 = 1e-5;
/// Between two nodes tension leaves a straight line by no more than this part of itself.
const TENSION_FLATNESS: f64 = 5e-5;
/// Tensions below this part of the greatest are not resolved further (a fold, where T → 0 in a
/// point).
const TENSION_FLOOR: f64 = 0.02;
/// Relative difference of the tensions on both sides of a point up to which they are equal: ten
/// times the balance accepted at a pulley. Smaller: two nodes after an inaccurate balance. Larger:
/// a light load on a taut cable shows no jump.
const TENSION_JUMP_TOLERANCE: f64 = 1e-8;
/// Nodes a catenary has at least: 2 to this power + 1.
const LEAST_DEPTH: u32 = 2;
/// Halvings of a catenary at most.
const MOST_DEPTH: u32 = 12;

/// A point of the answer.
#[derive(Clone, Copy, Debug)]
pub(in crate::model) struct ShapePoint {
    pub arc_length: f64,
    pub at: Vec2,
    /// Internal force, N.
    pub force: Vec2,
    pub curvature: f64,
}

/// Collects nodes of one cable.
pub(in crate::model) struct Nodes<'a> {
    problem: &'a Problem,
    flat: f64,
    least_tension: f64,
    /// True if the nodes are turned end for start afterwards: of two nodes that are one the first
    /// is that beyond the point then.
    pub turned: bool,
    pub out: Vec<Node>,
}

impl<'a> Nodes<'a> {
    /// None yet, for a cable with a greatest tension (N).
    pub fn new(problem: &'a Problem, greatest: f64) -> Self {
        let (flat, least_tension) = (MAX_CHORD_DISTANCE_FRACTION * problem.length, TENSION_FLOOR * greatest);
        Self { problem, flat, least_tension, turned: false, out: Vec::new() }
    }

    /// Adds a point.
    pub fn push(&mut self, p: ShapePoint) {
        let tension = p.force.norm();
        let strain = tension / self.problem.axial_stiffness;
        // At the point where a span meets a wheel, both have rounded the same arc length
        // differently.
        let before = self.out.last().map_or(p.arc_length, |n| n.arc_length_m);
        let node = Node {
            arc_length_m: if p.arc_length < before { before } else { p.arc_length },
            x_m: p.at.x,
            y_m: p.at.y,
            tension_n: tension,
            strain,
            stress_pa: tension / self.problem.cable.area_m2(),
            curvature_per_m: p.curvature,
            force_n: [p.force.x, p.force.y],
            ..Node::default()
        };
        // A node twice at the same material point only where the tension jumps (a load, a rubbing
        // pulley).
        if let Some(last) = self.out.last_mut()
            && node.arc_length_m - last.arc_length_m <= SAME_POINT_FRACTION * self.problem.length
            && (node.tension_n - last.tension_n).abs() <= TENSION_JUMP_TOLERANCE * node.tension_n
        {
            if !self.turned {
                last.curvature_per_m = node.curvature_per_m;
                last.force_n = node.force_n;
            }
            return;
        }
        self.out.push(node);
    }

    /// One catenary, from material point `s0` at position `at`.
    pub fn catenary(&mut self, s0: f64, at: Vec2, c: &Catenary) {
        let point = |s: f64| {
            let force = c.force_at(s);
            let square = force.norm_squared();
            // A fold is a point without tension: its direction turns at once, and no number says
            // how sharply.
            let curvature = if square > 0.0 { -cross(force, c.span().weight) / square } else { 0.0 };
            ShapePoint { arc_length: s0 + s, at: at + c.position_at(s), force, curvature }
        };
        let (a, b) = (point(0.0), point(c.span().length));
        self.push(a);
        self.refine(&point, [a, b], 0.0, c.span().length, 0);
        self.push(b);
    }

    /// Adds the nodes between two points at `s0` and `s1` (m) by bisection, until both the shape
    /// and the tension are straight between neighbours.
    fn refine(&mut self, point: &impl Fn(f64) -> ShapePoint, ends: [ShapePoint; 2], s0: f64, s1: f64, depth: u32) {
        let s = 0.5 * (s0 + s1);
        let middle = point(s);
        let off = ((ends[0].at + ends[1].at) * 0.5 - middle.at).norm();
        let [before, after, here] = [ends[0], ends[1], middle].map(|p| p.force.norm());
        let tension = (0.5 * (before + after) - here).abs();
        let scale = if here > self.least_tension { here } else { self.least_tension };
        // The error falls to a quarter with the node in the middle, which is known already.
        let rough = off > 4.0 * self.flat || tension > 4.0 * TENSION_FLATNESS * scale;
        let deeper = depth + 1 < LEAST_DEPTH || rough && depth + 1 < MOST_DEPTH;
        if deeper {
            self.refine(point, [ends[0], middle], s0, s, depth + 1);
        }
        self.push(middle);
        if deeper {
            self.refine(point, [middle, ends[1]], s, s1, depth + 1);
        }
    }
}

/// Nodes and reactions of a balance.
pub(super) fn report(p: &Problem, layout: &SupportLayout, e: &Equilibrium) -> (Vec<Node>, Vec<SupportReaction>) {
    let slide = SlidingProblem { problem: p, layout, arcs: &e.arcs };
    let greatest = e.stretches.all.iter().flatten().fold(0.0f64, |m, s| {
        let t = if s.start.norm() > s.end.norm() { s.start.norm() } else { s.end.norm() };
        if t > m { t } else { m }
    });
    let mut nodes = Nodes::new(p, greatest);
    let n = layout.anchors.len();
    for i in 0..=n {
        if let Some(s) = e.stretches.all[i] {
            let chain = slide.chain(s.from, s.to);
            // A dangling start is laid back from its anchor.
            let origin = if i > 0 {
                slide.touches(i - 1).1
            } else {
                let across =
                    chain.spans(s.start, Vec2::zeros()).fold(Vec2::zeros(), |_, (_, at, c)| at + c.span().chord);
                slide.touches(0).0 - across
            };
            for (s0, at, c) in chain.spans(s.start, origin) {
                nodes.catenary(s0, at, &c);
            }
        }
        if i < n && layout.anchors[i].radius > 0.0 {
            wheel_nodes(&mut nodes, &slide, e, i);
        }
    }
    let mut reactions = reactions(p, &slide, e, &nodes.out);
    if layout.hint > 0.0 {
        remove_auxiliary_weight(&mut nodes.out, &mut reactions, layout.hint);
    }
    (nodes.out, reactions)
}

/// Adds the nodes on the wheel of anchor `k`.
fn wheel_nodes(nodes: &mut Nodes<'_>, slide: &SlidingProblem<'_>, e: &Equilibrium, k: usize) {
    let (a, arc) = (&slide.layout.anchors[k], &e.arcs[k]);
    let (Some(before), Some(_)) = SlidingProblem::forces(&e.stretches, k) else { return };
    let m = required_friction(slide, &e.stretches, k, e.modes[k]);
    let chain = slide.chain(0.0, 1.0);
    let from = e.sigma[k] - arc.split(a.facing).0;
    let parts = arc_nodes::parts(a.radius, arc.turn, slide.problem.radius);
    for i in 0..=parts {
        let psi = arc.turn * i as f64 / parts as f64;
        let passed = traverse_wheel(&chain, a, before.norm(), arc.arrive, psi, m);
        let lambda = chain.thermal_stretch * (1.0 + passed.tension / chain.axial_stiffness);
        nodes.push(ShapePoint {
            arc_length: from + passed.material,
            at: a.touch(arc.arrive - a.facing * psi),
            force: perp(a.touch(arc.arrive - a.facing * psi) - a.at) * (-a.facing / a.radius * passed.tension),
            curvature: -a.facing * lambda / a.radius,
        });
    }
}

/// The reactions of all supports, in their order.
fn reactions(p: &Problem, slide: &SlidingProblem<'_>, e: &Equilibrium, nodes: &[Node]) -> Vec<SupportReaction> {
    let at_node = |s: f64| {
        let k = nodes.partition_point(|n| n.arc_length_m < s - SAME_POINT_FRACTION * p.length);
        nodes.get(k).map_or(Vec2::zeros(), |n| Vec2::new(n.x_m, n.y_m))
    };
    p.supports
        .iter()
        .enumerate()
        .map(|(k, s)| {
            let mut r = SupportReaction { name: s.name.clone(), ..SupportReaction::default() };
            let Some(i) = slide.layout.anchors.iter().position(|a| a.support == k) else {
                // A dead load or a free end: the reaction is minus the load.
                let arc_length = s.arc_length.unwrap_or(0.0);
                let at = at_node(arc_length);
                let load = if matches!(s.kind, SupportKind::Load | SupportKind::Free) {
                    slide.layout.loads_at(arc_length)
                } else {
                    Vec2::zeros()
                };
                (r.x_m, r.y_m, r.arc_length_m) = (at.x, at.y, arc_length);
                (r.reaction_x_n, r.reaction_y_n) = (-load.x, -load.y);
                return r;
            };
            let a = &slide.layout.anchors[i];
            let (before, after) = SlidingProblem::forces(&e.stretches, i);
            let (ahead, behind) = e.arcs[i].split(a.facing);
            let (from, to) = (e.sigma[i] - ahead, e.sigma[i] + behind);
            let own =
                if a.radius > 0.0 { slide.layout.load_between(from, to) } else { slide.layout.loads_at(e.sigma[i]) };
            let zero = Vec2::zeros();
            let force = after.unwrap_or(zero) - before.unwrap_or(zero) + own;
            (r.x_m, r.y_m, r.arc_length_m) = (a.at.x, a.at.y, 0.5 * (from + to));
            (r.reaction_x_n, r.reaction_y_n) = (force.x, force.y);
            if a.material_point.is_none() {
                r.tension_before_n = before.map(|f| f.norm());
                r.tension_after_n = after.map(|f| f.norm());
            }
            r
        })
        .collect()
}

/// Nodes before anything is solved: straight ways with the material spread evenly, dangling ends
/// straight along their load.
pub(super) fn straight(p: &Problem, layout: &SupportLayout, sigma: &[f64]) -> Vec<Node> {
    let hang = |force: Vec2| {
        let f = if force.norm() > 0.0 { force } else { layout.weight };
        if f.norm() > 0.0 { f / f.norm() } else { -perp(Vec2::x()) }
    };
    let mut out = Vec::with_capacity(sigma.len() + 2);
    let node = |s: f64, at: Vec2| Node { arc_length_m: s, x_m: at.x, y_m: at.y, ..Node::default() };
    if let (true, Some(a), Some(s)) = (layout.free[0], layout.anchors.first(), sigma.first()) {
        out.push(node(0.0, a.at + hang(layout.end_force[0]) * *s));
    }
    out.extend(layout.anchors.iter().zip(sigma).map(|(a, s)| node(*s, a.at)));
    if let (true, Some(a), Some(s)) = (layout.free[1], layout.anchors.last(), sigma.last()) {
        out.push(node(p.length, a.at + hang(layout.end_force[1]) * (p.length - s)));
    }
    out
}

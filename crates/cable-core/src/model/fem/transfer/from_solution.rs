//! This module continues from a solution, of another model or an earlier instant, and keeps what
//! friction holds.
//!
//! A [`State`] says where a cable is; an answer also says what tension it has. Between two places
//! of the cable with forces F₁ = T₁t₁ and F₂ = T₂t₂ the obstacles must push with C = F₁ − F₂ − bΔs:
//! N = C·n is the normal force there and C·t friction. Friction here is a spring of the length ε to
//! an anchor (`contact/friction.rs`), of the force μN(2y/ε − y|y|/ε²): the sliding y that gives the
//! friction the answer had is what a contact remembers from then on. Corners and posts get their
//! sliding nodes at once, with the material the answer has there.

use crate::error::SolveError;
use crate::math::{Vec2, perp};
use crate::model::fem::dynamics::Dynamics;

use crate::model::fem::mesh::sliding_node::{SlideOver, SlidingNode, round_of};
use crate::model::fem::mesh::tangent_path::rotate;
use crate::model::fem::mesh::tangent_path::{End, angle_between};
use crate::model::fem::newton::initial_guess::depenetrate;
use crate::model::fem::state::cable::CableState;
use crate::model::fem::system::friction_state::ContactPair;
use crate::solution::{CableSolution, Node};
use crate::state::State;

/// Part of an even bar over which directions are read.
const NEAR: f64 = 1e-3;

/// Part of its radius by which a node of an answer may be off a round and lie on it.
const ON_ROUND: f64 = 1e-3;

/// An answer's nodes read as a curve.
struct SolutionCurve<'a>(&'a [Node]);

impl SolutionCurve<'_> {
    /// The nodes on either side of a material point (m), and how far it is from the first to the
    /// second.
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

    /// Position, m: on the parabola of curvature and strain between two nodes. Where an arc begins
    /// the curvature jumps; the lesser counts.
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

    /// Material at an angle (rad) from the beginning of an arc, m.
    fn at_turn(&self, arc: &Arc, angle: f64) -> f64 {
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

impl CableState {
    /// A state with the nodes of this mesh where the answer has them.
    fn state_of_solution(&self, curve: &SolutionCurve<'_>, whole: &State) -> State {
        let mut s = whole.arc_length_m.clone();
        s.extend(&self.mesh.arc_length);
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

    /// Nodes of the cable where they were before they were pushed clear of obstacles.
    fn restore_positions(&mut self, state: &State) {
        for k in 0..self.mesh.nodes() {
            if let (None, Some(at)) = (self.mesh.sliding[k], state.position_at(self.mesh.arc_length[k])) {
                self.motion.x[k] = at;
            }
        }
    }

    /// Puts sliding nodes on the rounds that the answer lies on.
    fn adopt_sliding_nodes(&mut self, curve: &SolutionCurve<'_>) {
        if !self.meshing.slides {
            return;
        }
        for arc in self.arcs_of_solution(curve) {
            if self.bends_visibly(curve.tension(0.5 * (arc.material[0] + arc.material[1]))) {
                continue;
            }
            let round = arc.node.end.radius * arc.turn;
            let many = 0.5 * arc.turn > self.mesh.tuning.remesh.max_marked_arc_rad
                && 0.5 * round > self.mesh.tuning.remesh.one_mark_bars * self.even();
            let bars = if many { (self.mesh.tuning.start.marks_per_bar * round / self.even()).round() } else { 1.0 };
            let marks = (arc.turn
                / if many {
                    self.mesh.tuning.remesh.max_marked_arc_rad
                } else {
                    self.mesh.tuning.start.max_mark_turn_rad
                })
            .ceil()
            .max(bars);
            for i in 0..marks as usize {
                let part = (i as f64 + 0.5) / marks;
                let end = arc.node.end;
                let mark = rotate(end.mark, end.sense * part * arc.turn);
                let at = curve.at_turn(&arc, part * arc.turn);
                self.add_sliding_node(at, SlidingNode { end: End { mark, ..end }, ..arc.node });
            }
            self.clear_of_nodes(arc.material);
        }
    }

    /// A sliding node at a material point (m).
    fn add_sliding_node(&mut self, s: f64, node: SlidingNode) {
        let near = self.mesh.tuning.start.min_bar * self.even();
        let k = self.mesh.arc_length.partition_point(|&a| a <= s);
        for j in [k, k.wrapping_sub(1)] {
            let spare = self.mesh.arc_length.get(j).is_some_and(|a| (a - s).abs() < near);
            if spare && self.removable(j) && self.mesh.sliding[j].is_none() {
                self.remove(j);
            }
        }
        let k = self.mesh.arc_length.partition_point(|&a| a <= s);
        if k > 0 && k < self.mesh.nodes() {
            self.insert(k, s, Some(node));
        }
    }

    /// Takes the plain nodes out that would lie on a round, between two material points (m).
    fn clear_of_nodes(&mut self, [from, to]: [f64; 2]) {
        let mut k = 1;
        while k + 1 < self.mesh.nodes() {
            let s = self.mesh.arc_length[k];
            if s >= from && s <= to && self.removable(k) && self.mesh.sliding[k].is_none() {
                self.remove(k);
            } else {
                k += 1;
            }
        }
    }

    /// The rounds that the answer lies on, in order.
    fn arcs_of_solution(&self, curve: &SolutionCurve<'_>) -> Vec<Arc> {
        let geometry = self.problem.world.geometry();
        let mut out: Vec<Arc> = Vec::new();
        for (i, n) in curve.0.iter().enumerate() {
            let within = ON_ROUND * self.problem.radius;
            let Some(gap) = self.problem.world.signed_gap(n.at(), within).filter(|g| g.gap_m.abs() <= within) else {
                continue;
            };
            let slide_over = SlideOver::Obstacle { obstacle: gap.obstacle, feature: gap.feature };
            let clearance = self.clearance(gap.feature);
            let round = round_of(geometry, gap.feature, clearance, self.mesh.tuning.remesh.min_turn_rad);
            let (Some((center, radius)), true) = (round, gap.feature % 2 == 1) else { continue };
            if out.last().is_some_and(|a| a.node.slide_over == slide_over && a.nodes[1] + 1 >= i) {
                continue;
            }
            let end = End { center, radius, mark: gap.normal, sense: 1.0 };
            let node = SlidingNode::new(end, gap.friction, slide_over);
            let mut arc = Arc { nodes: [i, i], turn: 0.0, material: [n.arc_length_m; 2], node };
            arc.grow(curve, radius - clearance);
            if arc.turn > self.mesh.tuning.remesh.min_turn_rad {
                out.push(arc);
            }
        }
        out
    }

    /// Gives every bar between two nodes in contact the material that makes its tension that of the
    /// answer: rounds are the barrier's reach wider than the answer's, which between two corners
    /// that hold would be a great strain. What that takes is given by the spans on either side as
    /// they can: a loose end all of it, two spans by their lengths.
    fn adopt_stretch(&mut self, curve: &SolutionCurve<'_>) {
        let on = |d: &Self, k: usize| {
            d.mesh.sliding[k].is_some()
                || (d.removable(k)
                    && d.problem.world.signed_gap(d.motion.x[k], 2.0 * d.contacts.barrier.reach).is_some())
        };
        let nodes = self.mesh.nodes();
        let mut first = 1;
        while first + 1 < nodes {
            let last = (first..nodes - 1).take_while(|&k| on(self, k)).last();
            let Some(last) = last else {
                first += 1;
                continue;
            };
            let next = (last + 1..nodes - 1).find(|&k| on(self, k)).unwrap_or(nodes - 1);
            self.stretch_run(curve, [first, last], next);
            first = last + 1;
        }
        for e in 0..self.mesh.rest_length.len() {
            let length = self.mesh.arc_length[e + 1] - self.mesh.arc_length[e];
            self.mesh.rest_length[e] = self.mesh.thermal_stretch * length;
        }
        self.motion.s_before.clone_from(&self.mesh.arc_length);
    }

    /// The same for nodes in contact one after the other; `next` is the next that is held or in
    /// contact.
    fn stretch_run(&mut self, curve: &SolutionCurve<'_>, [first, last]: [usize; 2], next: usize) {
        let s = self.mesh.arc_length.clone();
        let mut lengths = vec![0.0; last + 1 - first];
        for e in first..last {
            let strain = curve.tension(0.5 * (s[e] + s[e + 1])) / self.mesh.axial_stiffness;
            let length = self.mesh.path(e, &self.motion.x).length / (self.mesh.thermal_stretch * (1.0 + strain));
            lengths[e + 1 - first] = lengths[e - first] + length;
        }
        let taken = lengths[last - first] - (s[last] - s[first]);
        let before = (0..first).rev().find(|&k| k == 0 || !self.removable(k)).unwrap_or(0);
        let give = |k: usize, length: f64| {
            if self.mesh.held[k] || self.mesh.sliding[k].is_some() { length } else { f64::INFINITY }
        };
        let [left, right] = [give(before, s[first] - s[before]), give(next, s[next] - s[last])];
        let share = match (left.is_finite(), right.is_finite()) {
            (true, true) => left / (left + right),
            (false, true) => 1.0,
            (true, false) => 0.0,
            (false, false) => 0.5,
        };
        let from = s[first] - taken * share;
        let least = NEAR * self.even();
        if from > s[first - 1] + least && from + lengths[last - first] < s[last + 1] - least {
            for (k, length) in lengths.iter().enumerate() {
                self.mesh.arc_length[first + k] = from + length;
            }
        }
    }

    /// Plan view: every node remembers the sliding with which the floor does what the answer asks
    /// for there, as far as it can.
    fn adopt_floor_friction(&mut self, curve: &SolutionCurve<'_>) {
        if self.problem.floor_friction.is_none() {
            return;
        }
        let s = &self.mesh.arc_length;
        let near = NEAR * self.even();
        for (k, limit) in self.input.floor_limit.iter().enumerate().filter(|(k, l)| **l > 0.0 && !self.mesh.held[*k]) {
            let low = 0.5 * (s[k] + s[k.saturating_sub(1)]);
            let high = 0.5 * (s[k] + s[(k + 1).min(s.len() - 1)]);
            let asked = match self.mesh.sliding[k] {
                // The floor holds there first, and the round the rest.
                Some(_) => Some(Vec2::new(curve.tension(low) - curve.tension(high), 0.0)),
                None => match (curve.force(low, near), curve.force(high, near)) {
                    (Some(before), Some(after)) => Some(after - before + self.input.body * (high - low)),
                    _ => None,
                },
            };
            let Some((asked, way)) = asked.and_then(|a| Some((a.norm(), a.try_normalize(0.0)?))) else { continue };
            // The floor resists with R(2u − u²).
            let part = if asked < *limit { asked / limit } else { 1.0 };
            self.contacts.floor_slid[k] = way * (self.contacts.slip * (1.0 - (1.0 - part).sqrt()));
        }
    }

    /// Every contact remembers the sliding that gives the friction of the answer.
    fn adopt_friction(&mut self, curve: &SolutionCurve<'_>) {
        let mut touches: Vec<ContactPair> = Vec::new();
        self.contacts.find(&self.problem, &self.mesh, &self.motion.x, &mut touches);
        let s = &self.mesh.arc_length;
        let near = NEAR * self.even();
        for touch in &touches {
            let k = touch.node;
            let (low, high) = if touch.on_segment {
                (s[k], s[k + 1])
            } else {
                (0.5 * (s[k] + s[k.saturating_sub(1)]), 0.5 * (s[k] + s[(k + 1).min(s.len() - 1)]))
            };
            let (Some(before), Some(after)) = (curve.force(low, near), curve.force(high, near)) else { continue };
            let pushed = before - after - self.input.body * (high - low);
            let normal = pushed.dot(&touch.pair.gap.normal);
            let limit = touch.pair.gap.friction * normal;
            if limit > 0.0 {
                // On the node acts −μN(2u − u|u|) along the tangent.
                let part = (-pushed.dot(&touch.tangent()) / limit).clamp(-1.0, 1.0);
                let u = part.signum() * (1.0 - (1.0 - part.abs()).sqrt());
                self.contacts.remember(touch, u * self.contacts.slip);
            }
        }
    }
}

impl Dynamics {
    /// Goes on from an answer of the same cable at rest, holding what friction held there.
    ///
    /// # Errors
    /// As [`Self::set_state`].
    pub fn warm_start(
        &mut self,
        answer: &CableSolution,
        time_s: f64,
        dragged: &[Option<Vec2>],
    ) -> Result<(), SolveError> {
        let curve = SolutionCurve(&answer.nodes);
        let state = self.cable.state_of_solution(&curve, &State::of_nodes(&answer.nodes, time_s));
        self.set_state(&state)?;
        let moves = answer.nodes.iter().any(|n| n.vx_m_per_s != 0.0 || n.vy_m_per_s != 0.0);
        let touches = !self.cable.problem.world.is_empty() || self.cable.problem.floor_friction.is_some();
        if moves || !touches || self.cable.contacts.own.shape.is_on() {
            return Ok(());
        }
        self.rollback.save(&self.cable);
        self.cable.restore_positions(&state);
        self.cable.adopt_sliding_nodes(&curve);
        let mut x = std::mem::take(&mut self.cable.motion.x);
        depenetrate(&self.cable.problem, &self.cable.mesh, &mut x, 0.9 * self.cable.contacts.barrier.reach);
        self.cable.motion.x = x;
        self.cable.adopt_stretch(&curve);
        self.cable.renew_input();
        self.cable.adopt_friction(&curve);
        self.cable.adopt_floor_friction(&curve);
        // Bars that stick from node to node are far from their balance by hardly any way: where
        // Newton's method alone does not find it, a resistance that fades leads there. From bars
        // that cut a corner it would lead to where they still do.
        let found = self.rest_step(time_s, dragged).or_else(|failed| match self.cable.cuts_nothing() {
            true => self.relax(time_s, dragged),
            false => Err(failed),
        });
        if found.is_ok() {
            self.rested = true;
        } else {
            self.rollback.restore(&mut self.cable);
        }
        Ok(())
    }
}

/// A round that an answer lies on; the mark of its node is where the cable comes on to it.
struct Arc {
    /// First and last node of the answer on it.
    nodes: [usize; 2],
    /// Whole turn, rad.
    turn: f64,
    /// Material at both ends, m.
    material: [f64; 2],
    node: SlidingNode,
}

impl Arc {
    /// Takes in all nodes before and after that lie on a round of this radius (m).
    fn grow(&mut self, curve: &SolutionCurve<'_>, radius: f64) {
        let center = self.node.end.center;
        let lies = |n: &Node| ((n.at() - center).norm() - radius).abs() <= ON_ROUND * radius;
        let before = curve.0[..self.nodes[0]].iter().rev().take_while(|n| lies(n)).count();
        let after = curve.0[self.nodes[1]..].iter().skip(1).take_while(|n| lies(n)).count();
        self.nodes = [self.nodes[0] - before, self.nodes[1] + after];
        let on = &curve.0[self.nodes[0]..=self.nodes[1]];
        let whole: f64 = on.windows(2).map(|n| angle_between(n[0].at() - center, n[1].at() - center)).sum();
        self.turn = whole.abs();
        self.material = [on[0].arc_length_m, on[on.len() - 1].arc_length_m];
        self.node.end.sense = if whole < 0.0 { -1.0 } else { 1.0 };
        // Nodes of the answer lie on the round within a part of its radius.
        self.node.end.mark = (on[0].at() - center).try_normalize(0.0).unwrap_or(self.node.end.mark);
    }
}

//! This module writes a chain at rest as an answer.
//!
//! Forces of contacts and weight act on the chain's nodes. In the answer a contact acts at its own
//! place: a bar that lies on a corner is divided there, its forces before and after differ by the
//! contact force, and its moment balances as before.

use crate::math::{Vec2, larger, perp};
use crate::model::fem::elastica::chain::{BarChain, ChainContact};
use crate::scene::SupportKind;
use crate::solution::{Assumptions, CableSolution, ContactReport, ContactSample, ContactState, Node, SupportReaction};

/// Difference of arc lengths within which a node is at a support, as a fraction of the cable's
/// length: round-off. Smaller: the node after it is taken; larger: the node before it.
const SAME_POINT_FRACTION: f64 = 1e-9;

/// Distance between two contacts with one obstacle, in bars, up to which they are merged.
const CONTACT_MERGE_BARS: f64 = 2.5;

impl BarChain<'_> {
    /// Force of a contact on the cable, N.
    fn force_of(&self, t: &ChainContact) -> Vec2 {
        t.gap.normal * t.push + self.direction(t.node) * (t.mobilised * t.push)
    }

    /// Moments at all nodes, N·m.
    fn moments(&self) -> Vec<f64> {
        self.curvatures()
            .iter()
            .map(|b| self.chain_input.problem.bending_stiffness * b / self.chain_input.problem.thermal_stretch)
            .collect()
    }

    /// Force in the middle of each bar, N: the part of the chain after it acts with it on the part
    /// before it.
    fn forces(&self, moments: &[f64]) -> Vec<Vec2> {
        (0..self.tension.len())
            .map(|e| {
                let d = self.positions[e + 1] - self.positions[e];
                let l = d.norm();
                (d * self.tension[e] - perp(d) * ((moments[e + 1] - moments[e]) / l)) / l
            })
            .collect()
    }

    /// The answer.
    pub(in crate::model::fem::elastica) fn solution(&self) -> CableSolution {
        let moments = self.moments();
        let forces = self.forces(&moments);
        let pushes = self.pushing_contacts();
        let nodes = self.answer_nodes(&moments, &forces, &pushes);
        CableSolution {
            name: self.chain_input.problem.cable.name.clone(),
            supports: self.supports(&forces, &nodes),
            contacts: self.reports(&pushes),
            nodes: nodes.into(),
            assumptions: Assumptions {
                bending_stiffness_n_m2: self.chain_input.problem.bending_stiffness,
                ..Assumptions::default()
            },
            ..CableSolution::default()
        }
    }

    /// The nodes of the answer, with one more at each contact inside a bar.
    fn answer_nodes(&self, moments: &[f64], forces: &[Vec2], pushes: &[ChainContact]) -> Vec<Node> {
        let p = self.chain_input.problem;
        let area = p.cable.area_m2();
        let last = self.positions.len() - 1;
        let mut out = Vec::with_capacity(self.positions.len() + pushes.len());
        let node = |s: f64, x: Vec2, pull: f64, moment: f64, force: Vec2| Node {
            arc_length_m: s,
            x_m: x.x,
            y_m: x.y,
            tension_n: pull,
            strain: pull / p.axial_stiffness,
            stress_pa: pull / area,
            curvature_per_m: p.thermal_stretch * moment / p.bending_stiffness,
            force_n: force.into(),
            ..Node::default()
        };
        for k in 0..last {
            let (a, b) = (self.positions[k], self.positions[k + 1]);
            let t = (b - a).normalize();
            let half = self.body * (0.5 * (self.arc[k + 1] - self.arc[k]));
            let mut inside: Vec<&ChainContact> =
                pushes.iter().filter(|t| t.node == k && t.gap.fraction > 0.0 && t.gap.fraction < 1.0).collect();
            inside.sort_by(|a, b| a.gap.fraction.total_cmp(&b.gap.fraction));
            // This is the force before the first contact on this bar.
            let mut force = inside.iter().fold(forces[k], |f, t| f + self.force_of(t) * (1.0 - t.gap.fraction));
            let before = if k > 0 { self.tension[k - 1] } else { force.dot(&t) };
            out.push(node(self.arc[k], a, larger(before, force.dot(&t)), moments[k], force + half));
            let (mut moment, mut way) = (moments[k], 0.0);
            for c in inside {
                let f = c.gap.fraction;
                moment -= (f - way) * (b - a).norm() * force.dot(&perp(t));
                way = f;
                let before = force.dot(&t);
                force -= self.force_of(c);
                let s = self.arc[k] + f * (self.arc[k + 1] - self.arc[k]);
                out.push(node(
                    s,
                    a + (b - a) * f,
                    larger(before, force.dot(&t)),
                    moment,
                    force + half * (1.0 - 2.0 * f),
                ));
            }
            if k + 1 == last {
                out.push(node(self.arc[last], b, force.dot(&t), moments[last], force - half));
            }
        }
        out
    }

    /// The reactions of all supports, in their order.
    fn supports(&self, forces: &[Vec2], nodes: &[Node]) -> Vec<SupportReaction> {
        let p = self.chain_input.problem;
        let last = self.positions.len() - 1;
        let ends = p.supports.len().saturating_sub(1);
        let reaction = |(k, s): (usize, &crate::problem::SupportPoint)| {
            let arc = if k == 0 { 0.0 } else { s.arc_length.filter(|_| k < ends).unwrap_or(p.length) };
            let i = self.arc.partition_point(|a| *a < arc - SAME_POINT_FRACTION * p.length).min(last);
            let before = if i > 0 { forces[i - 1] } else { Vec2::zeros() };
            let after = if i < last { forces[i] } else { Vec2::zeros() };
            let loaded = matches!(s.kind, SupportKind::Load | SupportKind::Free);
            // Forces that bars on corners pass on to this node are not its own contact forces.
            let near = self.contacts.iter().filter(|t| t.active);
            let led = near.flat_map(|t| t.shares().map(|(k, a)| (k, self.force_of(t) * a)));
            let led = led.filter(|(k, _)| *k == i).fold(Vec2::zeros(), |sum, (_, f)| sum + f);
            let f = if loaded { -p.hung_on(k, self.chain_input.time_s) } else { after - before + self.load[i] + led };
            SupportReaction {
                name: s.name.clone(),
                reaction_x_n: f.x,
                reaction_y_n: f.y,
                x_m: self.positions[i].x,
                y_m: self.positions[i].y,
                arc_length_m: if k == ends { nodes.last().map_or(arc, |n| n.arc_length_m) } else { arc },
                ..SupportReaction::default()
            }
        };
        p.supports.iter().enumerate().map(reaction).collect()
    }

    /// One report for each run of neighbouring contacts with one obstacle.
    fn reports(&self, pushes: &[ChainContact]) -> Vec<ContactReport> {
        let mut out = Vec::new();
        let mut left: Vec<&ChainContact> = pushes.iter().collect();
        while let Some(first) = left.first().copied() {
            let (mut group, mut rest, mut to) = (vec![first], Vec::new(), first.arc);
            for t in left.into_iter().skip(1) {
                if t.gap.obstacle == first.gap.obstacle && t.arc - to <= CONTACT_MERGE_BARS * self.bar {
                    to = t.arc;
                    group.push(t);
                } else {
                    rest.push(t);
                }
            }
            left = rest;
            let (Some(a), Some(b)) = (group.first(), group.last()) else { break };
            let middle = group[group.len() / 2];
            let at = |t: &ChainContact| {
                self.positions[t.node] + (self.positions[t.node + 1] - self.positions[t.node]) * t.gap.fraction
            };
            let x = at(middle);
            let normal_n: f64 = group.iter().map(|t| t.push).sum();
            let friction_n: f64 = group.iter().map(|t| t.mobilised * t.push).sum();
            let mut r = ContactReport {
                obstacle: self.chain_input.problem.world.obstacle_name(first.gap.obstacle).to_owned(),
                x_m: x.x,
                y_m: x.y,
                arc_length_m: 0.5 * (a.arc + b.arc),
                normal: middle.gap.normal.into(),
                normal_n,
                friction_n,
                state: if friction_n == 0.0 { ContactState::Slip } else { ContactState::Stick },
                tension_before_n: self.tension[a.node.saturating_sub(1)],
                tension_after_n: self.tension[(b.node + 1).min(self.tension.len() - 1)],
                begins_m: a.arc,
                ends_m: b.arc,
                ..ContactReport::default()
            };
            r.set_samples(group.iter().map(|t| ContactSample::new(t.arc, self.force_of(t))).collect());
            out.push(r);
        }
        out.sort_by(|a, b| a.begins_m.total_cmp(&b.begins_m));
        out
    }
}

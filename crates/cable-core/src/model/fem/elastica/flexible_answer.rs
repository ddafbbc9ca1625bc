//! These functions read the answer for a flexible cable, from which that of a stiff one begins.

use crate::math::Vec2;
use crate::model::fem::free::beam::equilibrium::nearest_turn;
use crate::problem::Problem;
use crate::solution::{CableSolution, ContactReport, ContactState, Node};

/// The nodes of an answer with their directions counted on.
pub(super) struct Curve<'a> {
    pub(super) nodes: &'a [Node],
    /// Direction of each chord, rad.
    pub(super) angles: Vec<f64>,
}

impl<'a> Curve<'a> {
    pub fn new(nodes: &'a [Node]) -> Self {
        let mut last: Option<f64> = None;
        let angles = nodes
            .windows(2)
            .map(|p| {
                let d = p[1].at() - p[0].at();
                let raw = if d.norm() > 0.0 { d.y.atan2(d.x) } else { last.unwrap_or(0.0) };
                let angle = last.map_or(raw, |l| nearest_turn(raw, l));
                last = Some(angle);
                angle
            })
            .collect();
        Self { nodes, angles }
    }

    /// Index of the chord at `s`, m.
    pub fn chord(&self, s: f64) -> usize {
        self.nodes.partition_point(|n| n.arc_length_m <= s).clamp(1, self.nodes.len() - 1) - 1
    }

    pub fn at(&self, s: f64) -> (Vec2, f64) {
        let k = self.chord(s);
        let (a, b) = (&self.nodes[k], &self.nodes[k + 1]);
        let d = b.arc_length_m - a.arc_length_m;
        let f = if d > 0.0 { ((s - a.arc_length_m) / d).clamp(0.0, 1.0) } else { 0.5 };
        (a.at() + (b.at() - a.at()) * f, a.tension_n + (b.tension_n - a.tension_n) * f)
    }

    /// Direction at `s` (m) as seen from inside `from` … `to` (m), rad.
    pub fn angle(&self, s: f64, [from, to]: [f64; 2]) -> f64 {
        let middle = |k: usize| 0.5 * (self.nodes[k].arc_length_m + self.nodes[k + 1].arc_length_m);
        let inside = |k: usize| middle(k) > from && middle(k) < to;
        let k = self.chord(s);
        let other = if s > middle(k) { k + 1 } else { k.wrapping_sub(1) };
        if other < self.angles.len() && inside(other) && inside(k) && middle(other) != middle(k) {
            return self.angles[k]
                + (self.angles[other] - self.angles[k]) * (s - middle(k)) / (middle(other) - middle(k));
        }
        if inside(k) || !(other < self.angles.len() && inside(other)) { self.angles[k] } else { self.angles[other] }
    }
}

/// Part of its friction that an obstacle mobilises at `s` (m) in an answer, and true if that is all
/// of it.
pub(super) fn mobilised(problem: &Problem, answer: &CableSolution, obstacle: usize, s: f64) -> (f64, bool) {
    let name = problem.world.obstacle_name(obstacle);
    let far = |c: &&ContactReport| {
        let [from, to] = c.extent_m();
        (from - s).max(s - to).max(0.0)
    };
    let reports = answer.contacts.iter().filter(|c| c.obstacle == name);
    let report = reports.min_by(|a, b| far(a).total_cmp(&far(b)));
    let friction = problem.world.geometry().bodies().iter().find(|b| b.obstacle == obstacle);
    let most = friction.map_or(0.0, |b| b.friction);
    let Some(r) = report.filter(|_| most > 0.0) else { return (0.0, false) };
    let part = if r.normal_n > 0.0 { (r.friction_n / r.normal_n).clamp(-most, most) } else { 0.0 };
    let slips = r.state == ContactState::Slip && part != 0.0;
    (if slips { most * part.signum() } else { part }, slips)
}

//! This module interpolates the shape, tension and friction of an answer at any arc length.

use crate::math::Vec2;
use crate::model::fem::free::nearest_turn;
use crate::problem::Problem;
use crate::solution::{CableSolution, ContactReport, ContactState, Node};

/// The nodes of an answer with their directions, which include whole turns.
pub(super) struct ReferenceCurve<'a> {
    pub(super) nodes: &'a [Node],
    /// Direction of each chord, rad.
    pub(super) angles: Vec<f64>,
}

impl<'a> ReferenceCurve<'a> {
    /// Computes the directions chord by chord, so that they do not jump by 2π.
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
    fn chord_at(&self, s: f64) -> usize {
        self.nodes.partition_point(|n| n.arc_length_m <= s).clamp(1, self.nodes.len() - 1) - 1
    }

    /// The nodes of the chord at `s` (m), and the place between them: 0 to 1.
    fn between(&self, s: f64) -> (&Node, &Node, f64) {
        let k = self.chord_at(s);
        let (a, b) = (&self.nodes[k], &self.nodes[k + 1]);
        let d = b.arc_length_m - a.arc_length_m;
        (a, b, if d > 0.0 { ((s - a.arc_length_m) / d).clamp(0.0, 1.0) } else { 0.5 })
    }

    /// Position at `s` (m), m.
    pub fn position_at(&self, s: f64) -> Vec2 {
        let (a, b, f) = self.between(s);
        a.at() + (b.at() - a.at()) * f
    }

    /// Tension at `s` (m), N.
    pub fn tension_at(&self, s: f64) -> f64 {
        let (a, b, f) = self.between(s);
        a.tension_n + (b.tension_n - a.tension_n) * f
    }

    /// Curvature at `s` (m), 1/m.
    pub fn curvature_at(&self, s: f64) -> f64 {
        let (a, b, f) = self.between(s);
        a.curvature_per_m + (b.curvature_per_m - a.curvature_per_m) * f
    }

    /// Direction at `s` (m), rad, interpolated between the chords whose middles are between `from`
    /// and `to` (m).
    pub fn angle_at(&self, s: f64, [from, to]: [f64; 2]) -> f64 {
        let middle = |k: usize| 0.5 * (self.nodes[k].arc_length_m + self.nodes[k + 1].arc_length_m);
        let inside = |k: usize| middle(k) > from && middle(k) < to;
        let k = self.chord_at(s);
        let other = if s > middle(k) { k + 1 } else { k.wrapping_sub(1) };
        if other < self.angles.len() && inside(other) && inside(k) && middle(other) != middle(k) {
            return self.angles[k]
                + (self.angles[other] - self.angles[k]) * (s - middle(k)) / (middle(other) - middle(k));
        }
        if inside(k) || !(other < self.angles.len() && inside(other)) { self.angles[k] } else { self.angles[other] }
    }
}

/// The friction that a contact mobilises in an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct MobilisedFriction {
    /// Force along growing arc length over normal force.
    pub(super) coefficient: f64,
    /// True if that is all the friction there is: the contact slips.
    pub(super) slips: bool,
}

/// The friction that an obstacle mobilises at `s` (m) in an answer.
pub(super) fn mobilised_friction(
    problem: &Problem,
    answer: &CableSolution,
    obstacle: usize,
    s: f64,
) -> MobilisedFriction {
    let name = problem.world.obstacle_name(obstacle);
    let distance = |c: &&ContactReport| {
        let [from, to] = c.extent_m();
        (from - s).max(s - to).max(0.0)
    };
    let reports = answer.contacts.iter().filter(|c| c.obstacle == name);
    let report = reports.min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let body = problem.world.geometry().bodies().iter().find(|b| b.obstacle == obstacle);
    let most = body.map_or(0.0, |b| b.friction);
    let Some(r) = report.filter(|_| most > 0.0) else { return MobilisedFriction::default() };
    let part = if r.normal_n > 0.0 { (r.friction_n / r.normal_n).clamp(-most, most) } else { 0.0 };
    let slips = r.state == ContactState::Slip && part != 0.0;
    MobilisedFriction { coefficient: if slips { most * part.signum() } else { part }, slips }
}

//! The laws of supports ask what supports do to the cable, and whether it is where they hold it.

use super::laws::{CheckedCable, series};
use super::surroundings::distance;
use super::tolerance::SUPPORT_TOLERANCE;
use super::{Law, Verification};
use crate::math::{Vec2, cross, larger, smaller};
use crate::scene::{Cable, PulleySide, Scene, Support, SupportKind, View};
use crate::solution::{CableSolution, Node, SupportReaction};

/// Present action of a support on the cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// It holds a point of the cable in its place.
    Held,
    /// The cable runs through a point.
    Pulley,
    /// The cable runs over a wheel.
    Wheel {
        /// Of the centre line, m.
        radius: f64,
    },
    /// The cable hangs clear of a wheel.
    Clear {
        /// Of the centre line round it, m.
        radius: f64,
    },
    /// A given force, or nothing.
    Load,
    /// It has let go.
    Released,
}

/// A support as the scene gives it and the answer reports it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SupportHold<'a> {
    pub support: &'a Support,
    pub role: Role,
    /// Place, m.
    pub at: Vec2,
    /// Arc length of the cable there, m.
    pub arc_length: f64,
    pub reaction: &'a SupportReaction,
}

/// The supports of a cable at a time, s.
pub(super) fn holds<'a>(cable: &'a Cable, answer: &'a CableSolution, time_s: f64) -> Vec<SupportHold<'a>> {
    let last = cable.supports.len().saturating_sub(1);
    let hold = |(k, (support, reaction)): (usize, (&'a Support, &'a SupportReaction))| {
        let released = support.release_s.is_some_and(|t| time_s >= t - 1e-9);
        let wheel = support.radius_m.filter(|r| *r > 0.0);
        let role = match support.kind {
            SupportKind::Load | SupportKind::Free => Role::Load,
            _ if released => Role::Released,
            SupportKind::Pulley => wheel.map_or(Role::Pulley, |r| {
                let radius = r + 0.5 * cable.diameter_m;
                let pressed = reaction.reaction_x_n != 0.0 || reaction.reaction_y_n != 0.0;
                if pressed { Role::Wheel { radius } } else { Role::Clear { radius } }
            }),
            SupportKind::Fixed | SupportKind::Clamped | SupportKind::Robot => Role::Held,
        };
        let arc_length = match k {
            0 => 0.0,
            k if k == last => cable.length_m,
            _ => reaction.arc_length_m,
        };
        SupportHold { support, role, at: Vec2::new(reaction.x_m, reaction.y_m), arc_length, reaction }
    };
    cable.supports.iter().zip(&answer.supports).enumerate().map(hold).collect()
}

impl SupportHold<'_> {
    /// Its force on the cable as it is reported, N.
    pub fn force(&self) -> Vec2 {
        -Vec2::new(self.reaction.reaction_x_n, self.reaction.reaction_y_n)
    }

    /// Returns what a dead load pulls with, N.
    pub(crate) fn dead_load(&self, scene: &Scene, time_s: f64) -> Vec2 {
        let gravity = match scene.view {
            View::Elevation => Vec2::new(0.0, -scene.environment.gravity_m_per_s2),
            View::Plan => Vec2::zeros(),
        };
        let s = self.support;
        series(s.force_n, &s.times_s, &s.forces_n, time_s) + gravity * s.mass_kg.unwrap_or(0.0)
    }
}

impl CheckedCable<'_> {
    /// The cable is where its supports hold it, and runs past its pulleys.
    pub fn supports(&self, found: &mut Verification) {
        found.ask(Law::Support);
        let nodes = &self.answer.nodes;
        let limit = SUPPORT_TOLERANCE * self.cable.length_m;
        for (k, hold) in self.holds.iter().enumerate() {
            let to_bar = |p: &[Node]| distance(hold.at, hold.at, p[0].at(), p[1].at());
            // Most are there where the cable says that it runs past them.
            let to_cable = |enough: f64| {
                let here = nodes.partition_point(|n| n.arc_length_m < hold.arc_length).clamp(1, nodes.len() - 1);
                let off = to_bar(&nodes[here - 1..=here]);
                if off <= enough { off } else { nodes.windows(2).map(to_bar).fold(off, smaller) }
            };
            let (off, limit) = match hold.role {
                Role::Load | Role::Released => continue,
                Role::Pulley => (to_cable(limit), larger(limit, self.reach())),
                Role::Wheel { radius } => (to_cable(radius + limit) - radius, larger(limit, self.reach())),
                Role::Clear { radius } => {
                    let inside = larger(radius - to_cable(0.0), 0.0);
                    let passes = !self.answer.breaks.is_empty() || self.passes_on_its_side(k);
                    (if passes { inside } else { radius + inside }, larger(limit, self.reach()))
                }
                Role::Held => {
                    let from = nodes.partition_point(|n| n.arc_length_m < hold.arc_length - limit);
                    let here = nodes[from..].iter().take_while(|n| n.arc_length_m <= hold.arc_length + limit);
                    (here.map(|n| (n.at() - hold.at).norm()).fold(f64::INFINITY, smaller), limit)
                }
            };
            if !(off <= limit) {
                let node = nodes.partition_point(|n| n.arc_length_m < hold.arc_length);
                let mut finding = self.finding(Law::Support, node, off, limit);
                finding.with.clone_from(&hold.support.name);
                found.report(finding);
            }
        }
    }

    /// Returns whether the cable passes a wheel on the side that the scene says: seen from its
    /// centre, the cable from the support before to the one after turns clockwise where it runs
    /// over the wheel to the right.
    fn passes_on_its_side(&self, k: usize) -> bool {
        let beside = |k: Option<usize>| k.and_then(|k| self.holds.get(k));
        let (Some(before), Some(after)) = (beside(k.checked_sub(1)), beside(Some(k + 1))) else { return true };
        let (hold, nodes) = (&self.holds[k], &self.answer.nodes);
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
}

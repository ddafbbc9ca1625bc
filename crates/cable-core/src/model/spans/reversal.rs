//! This module reverses a cable, so that it can be solved from its other end.
//!
//! With friction several equilibria are possible, and the one that is found must not depend on the
//! end from which a scene counts its cable. The cable is therefore solved and followed from its
//! *upper* end, and the solution is reversed afterwards.

use crate::math::Vec2;
use crate::model::spans::results::SpansAnswer;
use crate::model::spans::section::Failure;
use crate::problem::Problem;
use crate::scene::FrictionMobilised;
use crate::solution::{ContactPart, ContactReport, ContactSample, Node, SharedNodes, SupportReaction};

/// Difference of heights below which they are equal, as a fraction of the cable. Smaller:
/// round-off, which differs in a moved or mirrored scene, decides from which end it is counted.
/// Larger: a cable whose ends differ by so little is counted from either.
const HEIGHT_TOLERANCE: f64 = 1e-9;

/// True if a cable is solved from its end because that is the upper one; of two level ends the one
/// beside which the route is higher.
pub(in crate::model::spans) fn is_led_up(p: &Problem) -> bool {
    let places: Vec<Vec2> = if p.route.len() > 1 {
        p.route.clone()
    } else {
        p.supports.iter().filter_map(|s| s.position_at(0.0).map(|p| p.0)).collect()
    };
    let load = p.body_force(0.0);
    let height = |v: &Vec2| -v.dot(&load) / load.norm();
    let n = places.len();
    let pairs = places.iter().zip(places.iter().rev()).take(n / 2);
    let higher = pairs.map(|(a, b)| height(b) - height(a)).find(|d| d.abs() > HEIGHT_TOLERANCE * p.length);
    higher.is_some_and(|d| d > 0.0)
}

/// The same cable counted from its other end.
pub(in crate::model::spans) fn problem(p: &Problem) -> Problem {
    let mut out = p.clone();
    out.supports.reverse();
    for s in &mut out.supports {
        s.arc_length = s.arc_length.map(|a| p.length - a);
        s.angle = s.angle.map(|a| a + std::f64::consts::PI);
    }
    out.loads.reverse();
    for l in &mut out.loads {
        l.arc_length = p.length - l.arc_length;
    }
    out.route.reverse();
    out.cable.friction_mobilised = mobilised(p.cable.friction_mobilised);
    out
}

/// The friction of a cable drawn in the opposite direction.
pub(in crate::model::spans) fn mobilised(m: FrictionMobilised) -> FrictionMobilised {
    match m {
        FrictionMobilised::TowardsStart => FrictionMobilised::TowardsEnd,
        FrictionMobilised::TowardsEnd => FrictionMobilised::TowardsStart,
        other => other,
    }
}

/// Arc lengths of a cable counted from the other end.
pub(in crate::model::spans) struct Reversal<'a> {
    /// The cable as it is counted in the scene.
    pub problem: &'a Problem,
}

impl Reversal<'_> {
    /// An arc length counted from the other end, m; those of supports and loads are exactly as
    /// given.
    pub fn s(&self, s: f64) -> f64 {
        let p = self.problem;
        let marks = p.supports.iter().filter_map(|s| s.arc_length).chain(p.loads.iter().map(|l| l.arc_length));
        marks.into_iter().find(|mark| p.length - mark == s).unwrap_or(p.length - s)
    }

    /// Reverses nodes: the force of the cable after a node becomes that of the cable before it.
    pub fn nodes(&self, nodes: &[Node]) -> SharedNodes {
        let turned = |n: &Node| Node {
            arc_length_m: self.s(n.arc_length_m),
            curvature_per_m: 0.0 - n.curvature_per_m,
            force_n: n.force_n.map(|f| 0.0 - f),
            ..*n
        };
        nodes.iter().rev().map(turned).collect()
    }

    /// Reverses a report.
    pub fn report(&self, report: &SpansAnswer) -> SpansAnswer {
        let support = |r: &SupportReaction| SupportReaction {
            arc_length_m: self.s(r.arc_length_m),
            tension_before_n: r.tension_after_n,
            tension_after_n: r.tension_before_n,
            ..r.clone()
        };
        SpansAnswer {
            nodes: self.nodes(&report.nodes),
            supports: report.supports.iter().rev().map(support).collect(),
            contacts: report.contacts.iter().rev().map(|c| self.contact(c)).collect(),
        }
    }

    /// The contact as it is in the cable with its direction reversed.
    fn contact(&self, c: &ContactReport) -> ContactReport {
        let part =
            |p: &ContactPart| ContactPart { begins_m: self.s(p.ends_m), ends_m: self.s(p.begins_m), state: p.state };
        let sample = |s: &ContactSample| ContactSample { arc_length_m: self.s(s.arc_length_m), ..*s };
        ContactReport {
            arc_length_m: self.s(c.arc_length_m),
            friction_n: 0.0 - c.friction_n,
            turn_deg: 0.0 - c.turn_deg,
            tension_before_n: c.tension_after_n,
            tension_after_n: c.tension_before_n,
            begins_m: self.s(c.ends_m),
            ends_m: self.s(c.begins_m),
            parts: c.parts.iter().rev().map(part).collect(),
            samples: c.samples.iter().rev().map(sample).collect(),
            ..c.clone()
        }
    }

    /// Reverses a failure.
    pub fn failure(&self, failure: Failure) -> Failure {
        match failure {
            Failure::Stalled { iterations, residual, s } => Failure::Stalled { iterations, residual, s: self.s(s) },
            Failure::ContactCycling { s } => Failure::ContactCycling { s: self.s(s) },
            Failure::Compressed { s, at, tension } => Failure::Compressed { s: self.s(s), at, tension },
            Failure::OffWheel { support } => {
                Failure::OffWheel { support: (self.problem.supports.len() - 1).saturating_sub(support) }
            }
            Failure::LoadInContact { s } => Failure::LoadInContact { s: self.s(s) },
            Failure::ContactImpossible { s, at } => Failure::ContactImpossible { s: self.s(s), at },
            Failure::SlackDragged { s } => Failure::SlackDragged { s: self.s(s) },
            Failure::Unsound { what, s, at } => Failure::Unsound { what, s: self.s(s), at },
            same @ (Failure::Tunnelled { .. } | Failure::SupportInside { .. }) => same,
        }
    }
}

//! This module reads the contacts of a first guess from an answer: from its nodes, its contact
//! reports, or the contacts of a chain.

use crate::contact::Gap;
use crate::math::{Vec2, perp};
use crate::model::fem::elastica::boundary_value::{ContactSurface, Joint, Owner};
use crate::model::fem::elastica::chain::ChainContact;
use crate::model::fem::elastica::guess::{Attachment, ElasticaGuess, SAME_PLACE_FRACTION};
use crate::model::fem::elastica::reference_curve::{MobilisedFriction, mobilised_friction};
use crate::model::fem::free::place as support_place;
use crate::model::fem::mesh::round_of;
use crate::problem::Problem;
use crate::scene::{PulleySide, SupportKind};

/// Distance of a node of the flexible answer from a surface within which it touches it, as a
/// fraction of the cable's radius.
const CONTACT_DISTANCE_FRACTION: f64 = 1e-3;

/// Distance, in bars, up to which neighbouring contacts of a chain with one surface are merged, and
/// length beyond which the merged contact is a stretch.
const CHAIN_CONTACT_BARS: f64 = 2.5;

/// Length, in bars, from which a reported contact is a stretch.
const REPORTED_STRETCH_BARS: f64 = 3.0;

/// Distance, in bars, of a stretch of a chain's contacts from the cable's end up to which it
/// reaches that end.
const END_BARS: f64 = 2.0;

/// Fraction of a wheel's friction from which it counts as slipping: the rest is round-off.
const SLIPPING_FRACTION: f64 = 0.999;

/// The contact with the surface of a gap at `x`, where the cable has the direction `t`; None if no
/// cable can lie on that surface.
pub(in crate::model::fem::elastica) fn contact_at(
    problem: &Problem,
    gap: &Gap,
    x: Vec2,
    t: Vec2,
) -> Option<ContactSurface> {
    let line = ContactSurface {
        owner: Owner::Obstacle(gap.obstacle),
        at: x - gap.normal * gap.gap_m,
        radius: None,
        normal: gap.normal,
        sense: sense_of(gap.normal, t),
        mobilised: 0.0,
        slips: false,
    };
    if gap.feature.is_multiple_of(2) {
        return Some(line);
    }
    let (center, radius) = round_of(problem.world.geometry(), gap.feature, 0.0, 0.0)?;
    Some(ContactSurface { at: center, radius: Some(radius), ..line })
}

/// The sense in which a cable of direction `t` passes a surface: +1 anticlockwise, −1 clockwise.
fn sense_of(normal: Vec2, t: Vec2) -> f64 {
    if normal.dot(&perp(t)) > 0.0 { -1.0 } else { 1.0 }
}

impl ElasticaGuess<'_> {
    /// Attaches a contact between two arc lengths (m), which is a point contact if they are equal.
    /// Its friction is read at `middle` (m).
    fn attach_contact(&mut self, mut contact: ContactSurface, [from, to]: [f64; 2], middle: f64) {
        self.mobilise(&mut contact, middle);
        let k = self.elastica.contacts.len();
        self.elastica.contacts.push(contact);
        let joint = if to > from { Joint::ContactBegin(k) } else { Joint::PointContact(k) };
        self.attachments.push(Attachment { from, to, joint });
    }

    /// Mean direction of the cable within a bar to either side of `s`.
    fn direction_at(&self, s: f64, bar: f64) -> Vec2 {
        let angle = self.curve.angle_at(s, [s - bar, s + bar]);
        Vec2::new(angle.cos(), angle.sin())
    }

    /// Attaches the contacts of a chain. Those that follow each other on one surface are merged.
    pub(super) fn attach_chain_contacts(&mut self, bar: f64, contacts: &[ChainContact]) {
        let mut done = vec![false; contacts.len()];
        for i in 0..contacts.len() {
            if done[i] {
                continue;
            }
            let first = &contacts[i];
            let (mut to, mut push, mut moment) = (first.arc, first.push, first.push * first.arc);
            for (j, next) in contacts.iter().enumerate().skip(i + 1) {
                if next.arc - to > CHAIN_CONTACT_BARS * bar {
                    break;
                }
                if !done[j] && next.gap.feature == first.gap.feature && next.gap.obstacle == first.gap.obstacle {
                    done[j] = true;
                    to = next.arc;
                    push += next.push;
                    moment += next.push * next.arc;
                }
            }
            let is_stretch = to - first.arc > CHAIN_CONTACT_BARS * bar;
            let middle = if is_stretch { 0.5 * (first.arc + to) } else { moment / push };
            let x = self.curve.position_at(first.arc);
            let direction = self.direction_at(middle, bar);
            let Some(contact) = contact_at(self.problem, &first.gap, x, direction) else { continue };
            let extent = if is_stretch { self.to_lying_ends([first.arc, to], bar) } else { [middle, middle] };
            self.attach_contact(contact, extent, middle);
        }
    }

    /// The stretch of contact `from` … `to` (m), prolonged to an end of the cable that stands on a
    /// surface if it comes within two bars of that end: a chain has no contact where it is held.
    fn to_lying_ends(&self, [from, to]: [f64; 2], bar: f64) -> [f64; 2] {
        let within = CONTACT_DISTANCE_FRACTION * self.problem.radius;
        let lies = |s: f64| {
            let gap = self.problem.world.signed_gap(self.curve.position_at(s), within);
            gap.is_some_and(|g| g.gap_m <= within)
        };
        let length = self.elastica.length;
        let begins = from < END_BARS * bar && lies(0.0);
        let ends = length - to < END_BARS * bar && lies(length);
        [if begins { 0.0 } else { from }, if ends { length } else { to }]
    }

    /// Attaches the contacts that an answer of the contact mesh reports.
    pub(super) fn attach_reported_contacts(&mut self, bar: f64) {
        let (problem, length) = (self.problem, self.elastica.length);
        for report in &self.answer.contacts {
            let [from, to] = report.extent_m();
            let middle = report.arc_length_m;
            let x = Vec2::new(report.x_m, report.y_m);
            // The middle node of a wrap lies off its round.
            let gap =
                problem.world.signed_gap(x, bar).filter(|g| problem.world.obstacle_name(g.obstacle) == report.obstacle);
            let direction = self.direction_at(middle, bar);
            let Some(contact) = gap.and_then(|g| contact_at(problem, &g, x, direction)) else { continue };
            let extent = if to - from > REPORTED_STRETCH_BARS * bar {
                // A stretch that ends within a bar of the cable's end is prolonged to it.
                [if from < bar { 0.0 } else { from }, if length - to < bar { length } else { to }]
            } else {
                [middle, middle]
            };
            self.attach_contact(contact, extent, middle);
        }
    }

    /// Attaches the stretches of nodes that touch an obstacle or a pulley.
    pub(super) fn attach_touching_nodes(&mut self) {
        let within = CONTACT_DISTANCE_FRACTION * self.problem.radius + SAME_PLACE_FRACTION * self.problem.length;
        let mut open: Option<(ContactSurface, [f64; 2])> = None;
        let mut found = Vec::new();
        for (i, n) in self.answer.nodes.iter().enumerate() {
            let direction = self.direction_of_node(i);
            let gap = self.problem.world.signed_gap(n.at(), within).filter(|g| g.gap_m <= within);
            let touched = gap
                .and_then(|g| contact_at(self.problem, &g, n.at(), direction))
                .or_else(|| self.pulley_at(n.at(), direction, within));
            match (&mut open, touched) {
                (Some((contact, [_, to])), Some(new)) if contact.is_same_surface(&new) => *to = n.arc_length_m,
                (_, new) => {
                    found.extend(open.take());
                    open = new.map(|c| (c, [n.arc_length_m; 2]));
                }
            }
        }
        found.extend(open);
        let length = self.elastica.length;
        for (contact, [from, to]) in found {
            if to > SAME_PLACE_FRACTION * length && from < (1.0 - SAME_PLACE_FRACTION) * length {
                self.attach_contact(contact, [from, to], 0.5 * (from + to));
            }
        }
    }

    /// Sum of the unit vectors along the chords beside a node.
    fn direction_of_node(&self, i: usize) -> Vec2 {
        let chord = |k: usize| self.curve.angles.get(k).map_or(Vec2::zeros(), |a| Vec2::new(a.cos(), a.sin()));
        chord(i) + if i > 0 { chord(i - 1) } else { Vec2::zeros() }
    }

    /// The contact with the pulley at the place `x`, if there is one.
    fn pulley_at(&self, x: Vec2, t: Vec2, within: f64) -> Option<ContactSurface> {
        let pulleys = self.problem.supports.iter().enumerate().filter(|(_, s)| s.kind == SupportKind::Pulley);
        for (k, s) in pulleys {
            let Some(center) = support_place(self.problem, k, self.time_s, self.dragged) else { continue };
            if ((x - center).norm() - s.wheel_radius).abs() > within {
                continue;
            }
            let d = x - center;
            let up = if s.side == PulleySide::Over { Vec2::y() } else { -Vec2::y() };
            let normal = if d.norm() > 0.5 * s.wheel_radius && s.wheel_radius > 0.0 { d / d.norm() } else { up };
            return Some(ContactSurface {
                owner: Owner::Pulley(k),
                at: center,
                radius: Some(s.wheel_radius),
                normal,
                sense: sense_of(normal, t),
                mobilised: 0.0,
                slips: false,
            });
        }
        None
    }

    /// Gives a contact the friction mobilised at `s` (m) in the answer.
    fn mobilise(&self, contact: &mut ContactSurface, s: f64) {
        match contact.owner {
            Owner::Obstacle(obstacle) => {
                let MobilisedFriction { coefficient, slips } =
                    mobilised_friction(self.problem, self.answer, obstacle, s);
                (contact.mobilised, contact.slips) = (coefficient, slips);
            }
            Owner::Pulley(k) => {
                let (Some(support), Some(r)) = (self.problem.supports.get(k), self.answer.supports.get(k)) else {
                    return;
                };
                let (Some(a), Some(b)) = (r.tension_before_n, r.tension_after_n) else { return };
                if support.friction > 0.0 && a > 0.0 && b > 0.0 {
                    // A wheel holds or slips as a whole. The turn follows from the reaction.
                    let turn =
                        (Vec2::new(r.reaction_x_n, r.reaction_y_n).norm() / (a + b)).clamp(0.0, 1.0).asin() * 2.0;
                    let coefficient = if turn > 0.0 { (a / b).ln() / turn } else { 0.0 };
                    contact.mobilised = coefficient.clamp(-support.friction, support.friction);
                    contact.slips = coefficient.abs() >= SLIPPING_FRACTION * support.friction;
                }
            }
        }
    }
}

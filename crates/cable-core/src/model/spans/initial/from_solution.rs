//! This module sets up sections from another model's answer, with its friction.
//!
//! Consecutive nodes on one chain of a boundary form a contact. On an arc the contact extends from
//! its outer nodes to the points where the cable beside it is tangent, with the material of the
//! arc's length. The friction memory is set up from the tensions midway between the nodes, because
//! the tensions of bars jump at the nodes. Two neighbouring tensions are connected by a single
//! mobilised friction coefficient m, limited to the friction cone.

use std::f64::consts::TAU;

use crate::math::{Vec2, cross, perp};
use crate::model::spans::boundary::{
    Breakpoint, ChainRange, Curve, Ends, Mode, SUPPORT_CONTACT_DISTANCE_M, SweepDirection, TensionProfile,
};
use crate::model::spans::contact::LIFT_FRACTION;
use crate::model::spans::section::{BoundaryConditions, CableSection, Contact, EndCondition, SolveContext};
use crate::model::spans::section_layout::{SectionBounds, SectionLayout};
use crate::solution::Node;

/// Distance within which two nodes of an answer are at one place, as a fraction of the stretch:
/// round-off. Smaller: a jump of tension is two places; larger: near nodes are lost.
const SAME_POINT_FRACTION: f64 = 1e-9;

/// Least material between two contacts, as a fraction of the section.
const CONTACT_SPACING_FRACTION: f64 = 1e-6;

/// A place on a boundary.
#[derive(Clone, Copy, Debug)]
struct BoundaryPlace {
    /// Index of the boundary.
    curve: usize,
    chain_range: ChainRange,
    /// Boundary coordinate p.
    coordinate: f64,
}

/// A point of the cable, with the tensions before and after it.
#[derive(Clone, Copy, Debug)]
struct AnswerStation {
    /// Arc length, m.
    arc_length: f64,
    /// Position, m.
    at: Vec2,
    /// Tension before and after it, N.
    tension: [f64; 2],
    /// Where it lies, if it is on a boundary.
    boundary: Option<BoundaryPlace>,
    /// Index of the support that is a pulley here.
    wheel: Option<usize>,
}

impl AnswerStation {
    fn jumps(&self) -> bool {
        self.tension[0] != self.tension[1]
    }
}

/// The sections of a cable in the shape of an answer, with at most the fraction `within` of the
/// friction cone mobilised; None if the answer does not determine them.
pub(in crate::model::spans) fn sections_of(
    layout: &SectionLayout,
    context: &SolveContext,
    instant: &BoundaryConditions,
    nodes: &[Node],
    within: f64,
) -> Option<Vec<CableSection>> {
    let section = |part: &SectionBounds| {
        let mut stations = stations(nodes, part.material);
        if stations.len() < 2 {
            return None;
        }
        pulleys(part, context, instant, &mut stations);
        place_on_boundaries(layout, context, &mut stations);
        section_of(layout, part, context, instant, &stations, within)
    };
    layout.sections.iter().map(section).collect()
}

/// The nodes of a stretch of material; two nodes at one place give the tensions before and after
/// it.
fn stations(nodes: &[Node], [from, to]: [f64; 2]) -> Vec<AnswerStation> {
    let mut out: Vec<AnswerStation> = Vec::with_capacity(nodes.len());
    let rounding = SAME_POINT_FRACTION * (to - from);
    for n in nodes.iter().filter(|n| n.arc_length_m >= from - rounding && n.arc_length_m <= to + rounding) {
        match out.last_mut() {
            Some(last) if n.arc_length_m <= last.arc_length + rounding => last.tension[1] = n.tension_n,
            _ => out.push(AnswerStation {
                arc_length: n.arc_length_m,
                at: n.at(),
                tension: [n.tension_n; 2],
                boundary: None,
                wheel: None,
            }),
        }
    }
    out
}

/// Marks the station that each pulley holds, with the boundary of its wheel.
fn pulleys(part: &SectionBounds, context: &SolveContext, instant: &BoundaryConditions, stations: &mut [AnswerStation]) {
    for q in &part.pulleys {
        let center = instant.places[q.support];
        let far = |k: &usize| (stations[*k].at - center).norm();
        let inner = 1..stations.len() - 1;
        let Some(k) = inner.min_by(|a, b| far(a).total_cmp(&far(b))) else { continue };
        let (before, after) = (stations[k].at - stations[k - 1].at, stations[k + 1].at - stations[k].at);
        let clockwise = cross(before, after) <= 0.0;
        let back = q.facing < 0.0 || (q.facing == 0.0 && !clockwise);
        let curve = q.curve + usize::from(back);
        let chain_range = ChainRange { first: 0, last: 0 };
        let middle = before.normalize() + after.normalize();
        let coordinate = context.curves.get(curve).map_or(0.0, |c| c.with_tangent(0, middle));
        stations[k].boundary = Some(BoundaryPlace { curve, chain_range, coordinate });
        stations[k].wheel = Some(q.support);
    }
}

/// Finds the boundary that each station lies on.
fn place_on_boundaries(layout: &SectionLayout, context: &SolveContext, stations: &mut [AnswerStation]) {
    let near = layout.settings.initial.adopted_contact_distance_m;
    let world = &layout.problem.world;
    let n = stations.len();
    let mut before: Option<BoundaryPlace> = None;
    for k in 0..n {
        let along = stations[(k + 1).min(n - 1)].at - stations[k.saturating_sub(1)].at;
        let station = &mut stations[k];
        if station.wheel.is_some() {
            before = None;
            continue;
        }
        station.boundary = world.signed_gap(station.at, near).filter(|g| g.gap_m.abs() <= near).and_then(|gap| {
            let body = world.geometry().bodies().iter().position(|b| b.obstacle == gap.obstacle)?;
            let back = cross(along, gap.normal) < 0.0;
            let index = 2 * body + usize::from(back);
            let curve = context.curves.get(index)?;
            let (i, chain_range) = curve.chain(curve.piece_of(gap.feature, station.at)?, context.law.load)?;
            let mut p = curve.project(i, station.at);
            if let (true, Some(b)) = (curve.is_round(), before.filter(|b| b.curve == index)) {
                p += TAU * ((b.coordinate - p) / TAU).ceil().max(0.0);
            }
            Some(BoundaryPlace { curve: index, chain_range, coordinate: p })
        });
        before = station.boundary;
    }
}

/// A section with contacts where its stations lie on boundaries; None if its material does not
/// suffice for a span, or a span is not solved.
fn section_of(
    layout: &SectionLayout,
    part: &SectionBounds,
    context: &SolveContext,
    instant: &BoundaryConditions,
    stations: &[AnswerStation],
    within: f64,
) -> Option<CableSection> {
    let [from, to] = part.material;
    let end_conditions = [0, 1].map(|side| match part.supports[side] {
        Some(k) => EndCondition::Fixed(instant.places[k]),
        None => EndCondition::Hangs(layout.end_force(instant, part.material[side])),
    });
    let mut section = CableSection { from, to, end_conditions, contacts: Vec::new(), forces: Vec::new(), loose: None };
    let last = stations.len() - 1;
    let mut k = 0;
    while k <= last {
        let Some(BoundaryPlace { curve: index, chain_range, coordinate }) = stations[k].boundary else {
            k += 1;
            continue;
        };
        let (first, mut reached) = (k, coordinate);
        while stations[k].wheel.is_none()
            && let Some(next) = stations.get(k + 1).filter(|s| s.wheel.is_none()).and_then(|s| s.boundary)
            && (next.curve, next.chain_range) == (index, chain_range)
            && next.coordinate >= reached
        {
            (k, reached) = (k + 1, next.coordinate);
        }
        let curve = &context.curves[index];
        let run = TouchingRun { stations, curve, index, chain_range, first, last: k, within };
        if let Some(c) = run.contact(&mut section, context) {
            section.contacts.push(c);
        }
        k += 1;
    }
    separate_contacts(&mut section)?;
    section.forces = vec![Vec2::zeros(); section.contacts.len() + 1];
    for k in 0..section.spans() {
        if section.has_span(k) {
            section.forces[k] = section.solve_span(context, k)?;
        }
    }
    section.update_end_tensions(context);
    Some(section)
}

/// Brings the material of the contacts in order, with some of it in every span; None if the section
/// has too little.
fn separate_contacts(section: &mut CableSection) -> Option<()> {
    let least = CONTACT_SPACING_FRACTION * (section.to - section.from);
    let mut before = section.from;
    let mut spanned = section.end_conditions[0].has_span();
    for c in &mut section.contacts {
        if spanned && c.ends.material[0] < before + least {
            c.ends.material[0] = before + least;
        }
        if c.ends.material[1] < c.ends.material[0] {
            c.ends.material[1] = c.ends.material[0];
        }
        before = c.ends.material[1];
        spanned = true;
    }
    (before < section.to - least || !section.end_conditions[1].has_span()).then_some(())
}

/// Successive stations that lie on one chain.
struct TouchingRun<'a> {
    stations: &'a [AnswerStation],
    curve: &'a Curve,
    index: usize,
    chain_range: ChainRange,
    first: usize,
    last: usize,
    /// Fraction of the friction cone that may be mobilised.
    within: f64,
}

impl TouchingRun<'_> {
    /// The contact with its friction memory; the end conditions of the section on it become lying
    /// ends. None if a held end is above the boundary and nothing else touches it.
    fn contact(&self, section: &mut CableSection, context: &SolveContext) -> Option<Contact> {
        let mut ends = Ends::at([self.end(section, context, 0)?, self.end(section, context, 1)?]);
        if ends.place[1] < ends.place[0] {
            ends.place = [0.5 * (ends.place[0] + ends.place[1]); 2];
        }
        let mode = if self.curve.friction > 0.0 { Mode::Stick } else { Mode::Slip(0.0) };
        let mut contact = Contact::new(self.index, self.chain_range, ends, mode);
        contact.wheel = self.stations[self.first].wheel;
        self.remember_friction(section, context, &mut contact);
        Some(contact)
    }

    /// Marks the ends of the cable's section that are on the contact.
    fn is_tip(&self) -> [bool; 2] {
        [self.first == 0, self.last + 1 == self.stations.len()]
    }

    /// Sets the friction memory of the contact from the tensions along it.
    fn remember_friction(&self, section: &CableSection, context: &SolveContext, contact: &mut Contact) {
        let contact_path = context.contact_path(contact);
        let breakpoints = self.measured_tensions(&contact.ends);
        let going = self.sweep_direction(section);
        let (mut history, far_side) = match going {
            SweepDirection::Right => (TensionProfile::through(&contact_path, &breakpoints, self.within), 1),
            SweepDirection::Left => (TensionProfile::through_back(&contact_path, &breakpoints, self.within), 0),
        };
        // The material of other models' nodes follows from their bars, not from the strain between
        // nodes: the difference goes to the span beyond, if there is one.
        if !self.is_tip()[far_side] {
            history.measure(&contact_path, going);
            if let [first, .., last] = history.breakpoints() {
                contact.ends.material = [first.arc_length, last.arc_length];
            }
        }
        // The friction cone changes only the tension at a lying end.
        if let (Some(k), EndCondition::Lies(_)) = (history.breakpoints().last(), section.end_conditions[1]) {
            contact.ends.tension[1] = k.tension;
        }
        contact.history = history;
    }

    /// The direction in which the tensions are followed: a difference beyond the friction cone is
    /// moved to the end where the tension is known without friction, away from a lying end, to a
    /// free one.
    fn sweep_direction(&self, section: &CableSection) -> SweepDirection {
        let tied = section.end_conditions.map(|t| matches!(t, EndCondition::Lies(_)));
        let free = section.end_conditions.map(|t| matches!(t, EndCondition::Hangs(_) | EndCondition::Loose(_)));
        let tip = self.is_tip();
        if tied[1] && tip[1] && !(tied[0] && tip[0]) || free[0] && !free[1] {
            SweepDirection::Left
        } else {
            SweepDirection::Right
        }
    }

    /// The tensions of the answer between the ends of the contact, midway between stations at which
    /// they jump and at the others.
    fn measured_tensions(&self, ends: &Ends) -> Vec<Breakpoint> {
        let mut breakpoints = vec![ends.breakpoint(0)];
        for pair in self.stations[self.first..=self.last].windows(2) {
            let [a, b] = [&pair[0], &pair[1]];
            let (Some(a_place), Some(b_place)) = (a.boundary, b.boundary) else { continue };
            let (p, q) = (a_place.coordinate, b_place.coordinate);
            if a.jumps() || b.jumps() {
                let (middle, arc_length) = (0.5 * (p + q), 0.5 * (a.arc_length + b.arc_length));
                breakpoints.push(Breakpoint::frictionless(middle, arc_length, 0.5 * (a.tension[1] + b.tension[0])));
            }
            if !b.jumps() && q < ends.place[1] {
                breakpoints.push(Breakpoint::frictionless(q, b.arc_length, b.tension[0]));
            }
        }
        breakpoints.push(ends.breakpoint(1));
        breakpoints
    }

    /// The start of the contact (side 0) or its end.
    fn end(&self, section: &mut CableSection, context: &SolveContext, side: usize) -> Option<Breakpoint> {
        if self.is_tip()[side] {
            return self.tip(section, side);
        }
        let k = if side == 0 { self.first } else { self.last };
        let station = &self.stations[k];
        let p = station.boundary?.coordinate;
        let tension = station.tension[side];
        let at_node = Breakpoint::frictionless(p, station.arc_length, tension);
        if self.curve.place(p, self.chain_range).turn == 0.0 {
            return Some(at_node);
        }
        let beside = if side == 0 { self.stations[k - 1].at } else { self.stations[k + 1].at };
        let tangent = self.tangent_from(beside, p, side)?;
        let mut q = self.curve.with_tangent(self.curve.locate(p, self.chain_range), tangent);
        if self.curve.is_round() {
            q += TAU * ((p - q) / TAU).round();
        }
        let beyond = if side == 0 { q < p } else { q > p };
        if !beyond {
            return Some(at_node);
        }
        let way = self.curve.length(p, q, self.chain_range) / context.law.stretch(tension);
        Some(Breakpoint::frictionless(q, station.arc_length + way, tension))
    }

    /// The end of the contact at an end of the section, which becomes a lying end; None if it is
    /// held above the boundary and nothing else lies.
    fn tip(&self, section: &mut CableSection, side: usize) -> Option<Breakpoint> {
        let k = if side == 0 { self.first } else { self.last };
        let p = self.stations[k].boundary?.coordinate;
        let tension = self.stations[k].tension[side];
        let s = if side == 0 { section.from } else { section.to };
        match section.end_conditions[side] {
            EndCondition::Fixed(at) => match self.curve.on_chain(self.chain_range, at, SUPPORT_CONTACT_DISTANCE_M) {
                Some(p) => {
                    section.end_conditions[side] = EndCondition::Lies(p);
                    Some(Breakpoint::frictionless(p, s, tension))
                }
                // The end is held just above the boundary, so the next node is the first that lies.
                None if self.first < self.last => {
                    let next = &self.stations[if side == 0 { k + 1 } else { k - 1 }];
                    Some(Breakpoint::frictionless(next.boundary?.coordinate, next.arc_length, next.tension[side]))
                }
                None => None,
            },
            EndCondition::Hangs(force) => {
                section.end_conditions[side] = EndCondition::Loose(force);
                let place = self.curve.place(p, self.chain_range);
                // An end that is pressed down has friction of its own.
                let pressed = self.curve.friction > 0.0 && force.dot(&place.normal) < -LIFT_FRACTION * force.norm();
                let along = force.dot(&place.tangent);
                let drawn = if side == 0 { -along } else { along };
                Some(Breakpoint::frictionless(p, s, if pressed { tension } else { drawn }))
            }
            EndCondition::Lies(_) | EndCondition::Loose(_) => None,
        }
    }

    /// Direction of travel of the line that touches the arc at p and goes through a point beside
    /// it.
    fn tangent_from(&self, beside: Vec2, p: f64, side: usize) -> Option<Vec2> {
        let place = self.curve.place(p, self.chain_range);
        let center = place.at - place.normal * place.stretch;
        let way = if side == 0 { center - beside } else { beside - center };
        let far = way.norm();
        if !(far > place.stretch) {
            return None;
        }
        let aside = (place.stretch / far).asin() * self.curve.sense * if side == 0 { 1.0 } else { -1.0 };
        Some((way * aside.cos() + perp(way) * aside.sin()) / far)
    }
}

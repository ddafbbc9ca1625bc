//! This module sets up sections from another model's answer, with its friction.
//!
//! Consecutive nodes on one chain of a boundary form a contact. On an arc the contact extends from
//! its outer nodes to the points where the cable beside it is tangent, with the material of the
//! arc's length. The friction memory is set up from the tensions midway between the nodes, because
//! the tensions of bars jump at the nodes. Two neighbouring tensions are connected by a single
//! mobilised friction coefficient m, limited to the friction cone.

use crate::math::{Vec2, cross, perp};
use crate::model::spans::boundary::{
    Breakpoint, ChainRange, Curve, Ends, Mode, SUPPORT_CONTACT_DISTANCE_M, SweepDirection, TensionProfile,
};
use crate::model::spans::contact::LIFT_FRACTION;
use crate::model::spans::section::{BoundaryConditions, CableSection, Connection, Contact, EndCondition, SolveContext};
use crate::model::spans::section_layout::{SectionBounds, SectionLayout};
use crate::solution::Node;

/// Least material between two contacts, as a fraction of the section.
const CONTACT_SPACING_FRACTION: f64 = 1e-6;

/// A point of the cable, with the tensions before and after it.
#[derive(Clone, Copy, Debug)]
struct AnswerStation {
    arc_length: f64,
    at: Vec2,
    tension: [f64; 2],
    /// Boundary, chain and p, if it lies on one.
    boundary_point: Option<(usize, ChainRange, f64)>,
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
        laid(layout, part, context, instant, &stations, within)
    };
    layout.sections.iter().map(section).collect()
}

/// The nodes of a stretch of material; two nodes at one place give the tensions before and after
/// it.
fn stations(nodes: &[Node], [from, to]: [f64; 2]) -> Vec<AnswerStation> {
    let mut out: Vec<AnswerStation> = Vec::with_capacity(nodes.len());
    let rounding = 1e-9 * (to - from);
    for n in nodes.iter().filter(|n| n.arc_length_m >= from - rounding && n.arc_length_m <= to + rounding) {
        match out.last_mut() {
            Some(last) if n.arc_length_m <= last.arc_length + rounding => last.tension[1] = n.tension_n,
            _ => out.push(AnswerStation {
                arc_length: n.arc_length_m,
                at: n.at(),
                tension: [n.tension_n; 2],
                boundary_point: None,
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
        let p = context.curves.get(curve).map_or(0.0, |c| c.with_tangent(0, middle));
        stations[k].boundary_point = Some((curve, chain_range, p));
        stations[k].wheel = Some(q.support);
    }
}

/// Finds the boundary that each station lies on.
fn place_on_boundaries(layout: &SectionLayout, context: &SolveContext, stations: &mut [AnswerStation]) {
    let near = layout.settings.initial.adopted_contact_distance_m;
    let world = &layout.problem.world;
    let n = stations.len();
    let mut before: Option<(usize, ChainRange, f64)> = None;
    for k in 0..n {
        let along = stations[(k + 1).min(n - 1)].at - stations[k.saturating_sub(1)].at;
        let station = &mut stations[k];
        if station.wheel.is_some() {
            before = None;
            continue;
        }
        station.boundary_point = world.signed_gap(station.at, near).filter(|g| g.gap_m.abs() <= near).and_then(|gap| {
            let body = world.geometry().bodies().iter().position(|b| b.obstacle == gap.obstacle)?;
            let back = cross(along, gap.normal) < 0.0;
            let index = 2 * body + usize::from(back);
            let curve = context.curves.get(index)?;
            let (i, chain_range) = curve.chain(curve.piece_of(gap.feature, station.at)?, context.law.load)?;
            let mut p = curve.project(i, station.at);
            if let (true, Some(b)) = (curve.is_round(), before.filter(|b| b.0 == index)) {
                p += std::f64::consts::TAU * ((b.2 - p) / std::f64::consts::TAU).ceil().max(0.0);
            }
            Some((index, chain_range, p))
        });
        before = station.boundary_point;
    }
}

/// A section with contacts where its stations lie.
fn laid(
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
        let Some((index, chain_range, p)) = stations[k].boundary_point else {
            k += 1;
            continue;
        };
        let (first, mut reached) = (k, p);
        while stations[k].wheel.is_none()
            && let Some((i, h, p)) = stations.get(k + 1).filter(|s| s.wheel.is_none()).and_then(|s| s.boundary_point)
            && (i, h) == (index, chain_range)
            && p >= reached
        {
            (k, reached) = (k + 1, p);
        }
        let run = TouchingRun { curve: &context.curves[index], index, chain_range, first, last: k, within };
        if let Some(c) = run.contact(&mut section, context, stations) {
            section.contacts.push(c);
        }
        k += 1;
    }
    keep_apart(&mut section)?;
    section.forces = vec![Vec2::zeros(); section.contacts.len() + 1];
    for k in 0..section.spans() {
        if section.has_span(k) {
            section.forces[k] = section.solve_span(context, k)?;
        }
    }
    section.update_end_tensions(context);
    Some(section)
}

/// Keeps material in order, with some of it in every span.
fn keep_apart(section: &mut CableSection) -> Option<()> {
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
    curve: &'a Curve,
    index: usize,
    chain_range: ChainRange,
    first: usize,
    last: usize,
    /// Fraction of the friction cone that may be mobilised.
    within: f64,
}

impl TouchingRun<'_> {
    /// Makes the contact; the end conditions of the section on it become lying ends.
    fn contact(
        &self,
        section: &mut CableSection,
        context: &SolveContext,
        stations: &[AnswerStation],
    ) -> Option<Contact> {
        let mut contact = Contact {
            curve: self.index,
            chain_range: self.chain_range,
            ends: Ends { place: [0.0; 2], material: [0.0; 2], tension: [0.0; 2] },
            mode: if self.curve.friction > 0.0 { Mode::Stick } else { Mode::Slip(0.0) },
            history: TensionProfile::default(),
            wheel: stations[self.first].wheel,
            mode_changes: 0,
            held: None,
            smooth: false,
            next: Connection::Span,
            load: None,
        };
        for side in 0..2 {
            let (p, s, t) = self.end(section, context, stations, side)?;
            (contact.ends.place[side], contact.ends.material[side], contact.ends.tension[side]) = (p, s, t);
        }
        if contact.ends.place[1] < contact.ends.place[0] {
            let middle = 0.5 * (contact.ends.place[0] + contact.ends.place[1]);
            contact.ends.place = [middle; 2];
        }
        let breakpoint = |side: usize| Breakpoint {
            coordinate: contact.ends.place[side],
            arc_length: contact.ends.material[side],
            tension: contact.ends.tension[side],
            mobilised: 0.0,
        };
        let mut breakpoints = vec![breakpoint(0)];
        for pair in stations[self.first..=self.last].windows(2) {
            let [a, b] = [&pair[0], &pair[1]];
            let (Some((_, _, p)), Some((_, _, q))) = (a.boundary_point, b.boundary_point) else { continue };
            if a.jumps() || b.jumps() {
                let tension = 0.5 * (a.tension[1] + b.tension[0]);
                breakpoints.push(Breakpoint {
                    coordinate: 0.5 * (p + q),
                    arc_length: 0.5 * (a.arc_length + b.arc_length),
                    tension,
                    mobilised: 0.0,
                });
            }
            if !b.jumps() && q < contact.ends.place[1] {
                breakpoints.push(Breakpoint {
                    coordinate: q,
                    arc_length: b.arc_length,
                    tension: b.tension[0],
                    mobilised: 0.0,
                });
            }
        }
        breakpoints.push(breakpoint(1));
        let contact_path = context.contact_path(&contact);
        // A difference beyond the friction cone is moved to the end where the tension is known
        // without friction: away from a lying end, to a free one.
        let tied = [0, 1].map(|side| matches!(section.end_conditions[side], EndCondition::Lies(_)));
        let at_end = [self.first == 0, self.last + 1 == stations.len()];
        let free = section.end_conditions.map(|t| matches!(t, EndCondition::Hangs(_) | EndCondition::Loose(_)));
        let back = tied[1] && at_end[1] && !(tied[0] && at_end[0]) || free[0] && !free[1];
        contact.history = if back {
            TensionProfile::through_back(&contact_path, &breakpoints, self.within)
        } else {
            TensionProfile::through(&contact_path, &breakpoints, self.within)
        };
        // The material of other models' nodes follows from their bars, not from the strain between
        // nodes: the difference goes to the span beyond, if there is one.
        if !at_end[usize::from(!back)] {
            contact.history.measure(&contact_path, if back { SweepDirection::Left } else { SweepDirection::Right });
            if let [first, .., last] = contact.history.breakpoints() {
                contact.ends.material = [first.arc_length, last.arc_length];
            }
        }
        // The friction cone changes only the tension at a lying end.
        if let (Some(k), EndCondition::Lies(_)) = (contact.history.breakpoints().last(), section.end_conditions[1]) {
            contact.ends.tension[1] = k.tension;
        }
        Some(contact)
    }

    /// Boundary coordinate, material and tension at the start of the contact (side 0) or its end.
    fn end(
        &self,
        section: &mut CableSection,
        context: &SolveContext,
        stations: &[AnswerStation],
        side: usize,
    ) -> Option<(f64, f64, f64)> {
        let k = if side == 0 { self.first } else { self.last };
        let station = &stations[k];
        let (_, _, p) = station.boundary_point?;
        let tension = station.tension[side];
        let tip = if side == 0 { k == 0 } else { k + 1 == stations.len() };
        if tip {
            let s = if side == 0 { section.from } else { section.to };
            match section.end_conditions[side] {
                EndCondition::Fixed(at) => {
                    match self.curve.on_chain(self.chain_range, at, SUPPORT_CONTACT_DISTANCE_M) {
                        Some(p) => {
                            section.end_conditions[side] = EndCondition::Lies(p);
                            return Some((p, s, tension));
                        }
                        // The end is held just above the boundary, so the next node is the first
                        // that lies.
                        None if self.first < self.last => {
                            let next = &stations[if side == 0 { k + 1 } else { k - 1 }];
                            return Some((next.boundary_point?.2, next.arc_length, next.tension[side]));
                        }
                        None => return None,
                    }
                }
                EndCondition::Hangs(force) => {
                    section.end_conditions[side] = EndCondition::Loose(force);
                    let place = self.curve.place(p, self.chain_range);
                    let along = force.dot(&place.tangent);
                    // An end that is pressed down has friction of its own.
                    let pressed = self.curve.friction > 0.0 && force.dot(&place.normal) < -LIFT_FRACTION * force.norm();
                    return Some((
                        p,
                        s,
                        if pressed {
                            tension
                        } else if side == 0 {
                            -along
                        } else {
                            along
                        },
                    ));
                }
                _ => return None,
            }
        }
        let i = self.curve.locate(p, self.chain_range);
        if self.curve.place(p, self.chain_range).turn == 0.0 {
            return Some((p, station.arc_length, tension));
        }
        let beside = if side == 0 { stations[k - 1].at } else { stations[k + 1].at };
        let tangent = self.tangent_from(beside, p, side)?;
        let mut q = self.curve.with_tangent(i, tangent);
        if self.curve.is_round() {
            q += std::f64::consts::TAU * ((p - q) / std::f64::consts::TAU).round();
        }
        let beyond = if side == 0 { q < p } else { q > p };
        if !beyond {
            return Some((p, station.arc_length, tension));
        }
        let way = self.curve.length(p, q, self.chain_range) / context.law.stretch(tension);
        Some((q, station.arc_length + way, tension))
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

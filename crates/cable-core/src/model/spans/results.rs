//! This module makes the answer: nodes, forces on supports, forces on obstacles.

use crate::catenary::PointForce;
use crate::math::{GAUSS_3, GAUSS_5, Vec2, larger};
use crate::model::arc_nodes;
use crate::model::auxiliary_weight::remove_auxiliary_weight;
use crate::model::catenary::results::{Nodes, ShapePoint};
use crate::model::spans::boundary::{BoundaryPoint, CachedPiece, ContactPath, Mode, SegmentCursor, TensionProfile};
use crate::model::spans::contact::{load_balance, slack_pocket};
use crate::model::spans::section::{CableEquilibrium, CableSection, Connection, Contact, EndCondition, SolveContext};
use crate::model::spans::section_layout::SectionLayout;
use crate::solution::{ContactPart, ContactReport, ContactSample, ContactState, Node, SharedNodes, SupportReaction};

/// Difference of arc lengths within which a node is at a support, as a fraction of the cable's
/// length: round-off. Smaller: the node after it is taken; larger: the node before it.
const SAME_POINT_FRACTION: f64 = 1e-12;

/// Number of nodes on each stretch of an edge.
const EDGE_NODES: usize = 8;

/// Longest stretch of an arc over which forces are summed with one rule of 5 Gauss points, rad:
/// accurate to 1e-11.
const LONGEST_PANEL_RAD: f64 = 1.0;
/// Longest stretch for which 3 points are as accurate, rad.
const THREE_POINT_ARC: f64 = 0.1;

/// All data of an answer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::model::spans) struct SpansAnswer {
    pub nodes: SharedNodes,
    pub supports: Vec<SupportReaction>,
    pub contacts: Vec<ContactReport>,
}

/// Makes the report of a cable equilibrium.
pub(in crate::model::spans) fn report(layout: &SectionLayout, cable_equilibrium: &CableEquilibrium) -> SpansAnswer {
    let context = &cable_equilibrium.context;
    let mut nodes = Nodes::new(&layout.problem, greatest_tension(cable_equilibrium));
    nodes.turned = layout.is_reversed();
    let mut unfinished = ReportInProgress { layout, context, nodes, contacts: Vec::new() };
    for section in &cable_equilibrium.sections {
        unfinished.add_section(section);
    }
    let (mut nodes, mut contacts) = (unfinished.nodes.out, unfinished.contacts);
    let mut supports = supports(layout, cable_equilibrium, &nodes);
    let hint = cable_equilibrium.instant.hint;
    if hint > 0.0 {
        remove_auxiliary_weight(&mut nodes, &mut supports, hint);
        contacts.retain(|c: &ContactReport| Vec2::from(c.force_n).norm() > hint);
    }
    SpansAnswer { nodes: nodes.into(), supports, contacts }
}

/// The greatest tension at an end of a span, a contact or a loose section, N.
fn greatest_tension(cable_equilibrium: &CableEquilibrium) -> f64 {
    let context = &cable_equilibrium.context;
    let mut greatest = 0.0;
    for section in &cable_equilibrium.sections {
        for k in (0..section.spans()).filter(|&k| section.has_span(k)) {
            let (from, to) = section.material(k);
            for s in [from, to] {
                let t = section.force(context, k, s).norm();
                greatest = if t > greatest { t } else { greatest };
            }
        }
        for t in section.contacts.iter().flat_map(|c| c.ends.tension) {
            greatest = if t > greatest { t } else { greatest };
        }
        if let Some(loose) = &section.loose {
            greatest = [0, 1].iter().map(|side| loose.end_force(context, *side).norm()).fold(greatest, larger);
        }
    }
    greatest
}

/// The nodes and contacts of the sections that have been reported.
struct ReportInProgress<'a> {
    layout: &'a SectionLayout,
    context: &'a SolveContext,
    nodes: Nodes<'a>,
    contacts: Vec<ContactReport>,
}

impl ReportInProgress<'_> {
    /// Adds the nodes and contacts of a section.
    fn add_section(&mut self, section: &CableSection) {
        if let Some(loose) = &section.loose {
            let problem = &self.layout.problem;
            let found = loose.report(self.context, &mut self.nodes, problem.radius).into_iter();
            self.contacts.extend(found.map(|(obstacle, report)| {
                let obstacle = problem.world.obstacle_name(obstacle).to_owned();
                ContactReport { obstacle, ..report }
            }));
            return;
        }
        for k in 0..section.spans() {
            if section.has_span(k) {
                section.shapes(self.context, k, |s0, at, shape| self.nodes.catenary(s0, at, shape));
            }
            if let Some(c) = section.contacts.get(k) {
                self.add_contact(section, k, c);
            }
        }
    }

    /// Adds contact k.
    fn add_contact(&mut self, section: &CableSection, k: usize, c: &Contact) {
        let (context, problem) = (self.context, &self.layout.problem);
        let contact_path = context.contact_path(c).with_cached_piece(c.ends.place[0]);
        let stretches = stretches(&contact_path, problem.radius, &c.history, c.ends.place);
        if c.is_load() {
            load_nodes(&mut self.nodes, section, context, k, &contact_path);
        } else {
            contact_nodes(&mut self.nodes, &contact_path, c, &stretches);
        }
        let Some(obstacle) = contact_path.curve.obstacle else { return };
        let name = problem.world.obstacle_name(obstacle);
        self.contacts.push(match c.is_load() {
            true => load(section, context, k, &contact_path, name),
            false => contact(&contact_path, name, c, &stretches),
        });
        if c.next == Connection::Pocket {
            self.contacts.extend(heap(section, context, k, name));
        }
    }
}

/// A stretch of a contact on which tension has one law and the boundary one form.
#[derive(Clone, Copy)]
struct ContactStretch {
    from: f64,
    to: f64,
    /// Tension (N) and material (m) at its start.
    tension: f64,
    arc_length: f64,
    /// Mobilised friction coefficient.
    mobilised: f64,
    cached_piece: CachedPiece,
    /// Radius of the cable, m.
    cable_radius: f64,
}

impl ContactStretch {
    /// The stretch between two boundary coordinates.
    fn new(contact_path: &ContactPath<'_>, cable_radius: f64, history: &TensionProfile, [from, to]: [f64; 2]) -> Self {
        let middle = 0.5 * (from + to);
        let (tension, s) = history.at(contact_path, from);
        let cached_piece = match contact_path.cached_piece {
            Some(cached_piece) if cached_piece.reaches(from) && cached_piece.reaches(to) => cached_piece,
            _ => CachedPiece::new(contact_path.curve, contact_path.chain_range, &contact_path.law, middle),
        };
        Self {
            from,
            to,
            tension,
            arc_length: s,
            mobilised: history.required_friction(contact_path, middle),
            cached_piece,
            cable_radius,
        }
    }

    /// Number of parts into which nodes divide it.
    fn nodes(&self) -> usize {
        if self.cached_piece.turns() {
            arc_nodes::parts(self.cached_piece.at.stretch, self.to - self.from, self.cable_radius)
        } else {
            EDGE_NODES
        }
    }

    /// Tension and material at p.
    fn at(&self, contact_path: &ContactPath<'_>, p: f64) -> (f64, f64) {
        let piece =
            SegmentCursor { law: &contact_path.law, from: self.cached_piece.local_load(self.from), p0: self.from };
        let way = piece.slide(p, self.tension, self.mobilised);
        (way.tension, self.arc_length + way.material)
    }
}

/// The stretches of a contact, divided at breakpoints of its friction and at borders of pieces.
fn stretches(
    contact_path: &ContactPath<'_>,
    cable_radius: f64,
    history: &TensionProfile,
    [p1, p2]: [f64; 2],
) -> Vec<ContactStretch> {
    let breakpoints = history.breakpoints();
    let mut out = Vec::with_capacity(breakpoints.len() + 1);
    let (mut p, mut k) = (p1, 0);
    while p < p2 {
        let border = contact_path.next_border(p, p2);
        while breakpoints.get(k).is_some_and(|breakpoint| breakpoint.coordinate <= p) {
            k += 1;
        }
        let next = breakpoints
            .get(k)
            .map_or(border, |breakpoint| if breakpoint.coordinate < border { breakpoint.coordinate } else { border });
        out.push(ContactStretch::new(contact_path, cable_radius, history, [p, next]));
        p = next;
    }
    out
}

/// Adds the nodes of a contact.
fn contact_nodes(nodes: &mut Nodes<'_>, contact_path: &ContactPath<'_>, c: &Contact, stretches: &[ContactStretch]) {
    let mut push = |place: &BoundaryPoint, (tension, s): (f64, f64)| {
        let curvature =
            if place.stretch > 0.0 { place.turn * contact_path.law.stretch(tension) / place.stretch } else { 0.0 };
        nodes.push(ShapePoint { arc_length: s, at: place.at, force: place.tangent * tension, curvature });
    };
    push(&contact_path.place(c.ends.place[0]), (c.ends.tension[0], c.ends.material[0]));
    for stretch in stretches {
        let (a, b) = (stretch.from, stretch.to);
        let count = stretch.nodes();
        let last = if b < c.ends.place[1] { count } else { count - 1 };
        for i in 1..=last {
            let p = if i == count { b } else { a + (b - a) * i as f64 / count as f64 };
            push(&stretch.cached_piece.place(p), stretch.at(contact_path, p));
        }
    }
    push(&contact_path.place(c.ends.place[1]), (c.ends.tension[1], c.ends.material[1]));
}

/// Adds the nodes of the load of contact j: a span pulls in its own direction, a contact beside it
/// along the boundary.
fn load_nodes(
    nodes: &mut Nodes<'_>,
    section: &CableSection,
    context: &SolveContext,
    j: usize,
    contact_path: &ContactPath<'_>,
) {
    let c = &section.contacts[j];
    let place = contact_path.place(c.ends.place[0]);
    let pulls = |side: usize| section.force_at_contact(context, j, side);
    for side in 0..2 {
        // Beyond an end there is no cable, so it has the force on its inner side.
        let ends = (j + side == 0 || j + side == section.contacts.len()) && !section.has_span(j + side);
        let along = || place.tangent * c.ends.tension[side];
        let force = pulls(side).or_else(|| pulls(1 - side).filter(|_| ends)).unwrap_or_else(along);
        nodes.push(ShapePoint { arc_length: c.ends.material[side], at: place.at, force, curvature: 0.0 });
    }
}

/// Sums over a contact.
#[derive(Default)]
struct ContactSums {
    /// Normal force, N.
    normal_force: f64,
    /// Normal force as a vector, N.
    push: Vec2,
    /// Load along the cable, N.
    load_along: f64,
    /// Turn, rad.
    turn: f64,
}

/// The sums over a contact, by quadrature.
fn sums(contact_path: &ContactPath<'_>, stretches: &[ContactStretch]) -> ContactSums {
    let mut sums = ContactSums::default();
    for stretch in stretches {
        let (a, way, turns) = (stretch.from, stretch.to - stretch.from, stretch.cached_piece.turns());
        let panels = if turns { (way / LONGEST_PANEL_RAD).ceil().max(1.0) } else { 1.0 };
        let h = way / panels;
        let rule: &[(f64, f64)] = if turns && h <= THREE_POINT_ARC { &GAUSS_3 } else { &GAUSS_5 };
        for k in 0..panels as usize {
            for (u, weight) in rule {
                let p = a + (k as f64 + u) * h;
                let (t, place, weight) = (stretch.at(contact_path, p).0, stretch.cached_piece.place(p), weight * h);
                let press = contact_path.law.press(&place, t);
                sums.normal_force += weight * press;
                sums.push += place.normal * (weight * press);
                sums.load_along +=
                    weight * contact_path.law.load.dot(&place.tangent) * place.stretch / contact_path.law.stretch(t);
                sums.turn += weight * place.turn;
            }
        }
    }
    sums
}

/// The report of a contact.
fn contact(contact_path: &ContactPath<'_>, name: &str, c: &Contact, stretches: &[ContactStretch]) -> ContactReport {
    let friction = contact_path.friction;
    let ContactSums { normal_force, push, load_along, turn } = sums(contact_path, stretches);
    let middle = contact_path.place(0.5 * (c.ends.place[0] + c.ends.place[1]));
    let unit = if push.norm() > 0.0 { push.normalize() } else { middle.normal };
    let [t1, t2] = c.ends.tension;
    let slips = friction <= 0.0 || matches!(c.mode, Mode::Slip(_));
    let mut report = ContactReport {
        obstacle: name.to_owned(),
        x_m: middle.at.x,
        y_m: middle.at.y,
        arc_length_m: 0.5 * (c.ends.material[0] + c.ends.material[1]),
        normal: [unit.x, unit.y],
        normal_n: normal_force,
        friction_n: t1 - t2 - load_along,
        force_n: obstacle_force(contact_path, c).into(),
        state: if slips { ContactState::Slip } else { ContactState::Stick },
        turn_deg: turn.to_degrees(),
        tension_before_n: t1,
        tension_after_n: t2,
        begins_m: c.ends.material[0],
        ends_m: c.ends.material[1],
        parts: if slips { Vec::new() } else { parts(c, friction, stretches) },
        ..ContactReport::default()
    };
    report.set_samples(samples(contact_path, stretches));
    report
}

/// Forces of the obstacle on the cable between the nodes of a contact: N n on an edge or arc, less
/// the mobilised friction m N t.
fn samples(contact_path: &ContactPath<'_>, stretches: &[ContactStretch]) -> Vec<ContactSample> {
    let mut out = Vec::with_capacity(EDGE_NODES * stretches.len());
    for stretch in stretches {
        let count = stretch.nodes();
        let h = (stretch.to - stretch.from) / count as f64;
        for k in 0..count {
            let (mut force, mut middle) = (Vec2::zeros(), stretch.arc_length);
            for (u, weight) in GAUSS_3 {
                let p = stretch.from + (k as f64 + u) * h;
                let (t, s) = stretch.at(contact_path, p);
                let place = stretch.cached_piece.place(p);
                force += (place.normal - place.tangent * stretch.mobilised)
                    * (weight * h * contact_path.law.press(&place, t));
                middle = if u == 0.5 { s } else { middle };
            }
            out.push(ContactSample::new(middle, force));
        }
    }
    out
}

/// The force of an obstacle on a contact, N: it balances the load there and the difference of the
/// tensions at both ends.
pub(in crate::model::spans) fn obstacle_force(contact_path: &ContactPath<'_>, c: &Contact) -> Vec2 {
    let [before, after] = [0, 1].map(|side| contact_path.place(c.ends.place[side]).tangent * c.ends.tension[side]);
    before - after - contact_path.law.load * (c.ends.material[1] - c.ends.material[0])
}

/// The arc lengths between which material lies loose in the kink after contact j, m.
pub(in crate::model::spans) fn loose(section: &CableSection, j: usize) -> Option<[f64; 2]> {
    let (c, next) = (section.contacts.get(j)?, section.contacts.get(j + 1)?);
    (c.next == Connection::Pocket && next.ends.material[0] > c.ends.material[1])
        .then_some([c.ends.material[1], next.ends.material[0]])
}

/// Tensions at the start and at the end, and the greatest tension, N.
pub(in crate::model::spans) fn tensions(cable_equilibrium: &CableEquilibrium) -> [f64; 3] {
    let context = &cable_equilibrium.context;
    let end = |section: Option<&CableSection>, side: usize| {
        let section = section?;
        let outer = if side == 0 { section.contacts.first() } else { section.contacts.last() };
        Some(match (section.end_conditions[side], outer) {
            (EndCondition::Loose(_), Some(c)) => c.ends.tension[side],
            _ => end_force(cable_equilibrium, section, side).norm(),
        })
    };
    let [start, last] = [end(cable_equilibrium.sections.first(), 0), end(cable_equilibrium.sections.last(), 1)]
        .map(|t| t.unwrap_or(0.0));
    let mut greatest = larger(start, last);
    for section in &cable_equilibrium.sections {
        for k in (0..section.spans()).filter(|&k| section.has_span(k)) {
            let (from, to) = section.material(k);
            let ends = [from, to].map(|s| section.force(context, k, s).norm());
            greatest = larger(greatest, larger(ends[0], ends[1]));
        }
        let of_loose = section.loose.iter().flat_map(|l| &l.parts).flat_map(|part| part.tension);
        greatest = section.contacts.iter().flat_map(|c| c.ends.tension).chain(of_loose).fold(greatest, larger);
    }
    [start, last, greatest]
}

/// The report of the load of contact j.
fn load(
    section: &CableSection,
    context: &SolveContext,
    j: usize,
    contact_path: &ContactPath<'_>,
    name: &str,
) -> ContactReport {
    let c = &section.contacts[j];
    let load_balance = load_balance(section, context, j);
    let at = contact_path.place(c.ends.place[0]).at;
    // The obstacle balances all other forces on the point.
    let force =
        load_balance.normal * load_balance.press() - load_balance.tangent * load_balance.sum.dot(&load_balance.tangent);
    let slips = contact_path.friction <= 0.0 || matches!(c.mode, Mode::Slip(_));
    ContactReport {
        obstacle: name.to_owned(),
        x_m: at.x,
        y_m: at.y,
        arc_length_m: c.ends.material[0],
        normal: [load_balance.normal.x, load_balance.normal.y],
        normal_n: load_balance.press(),
        friction_n: -load_balance.sum.dot(&load_balance.tangent),
        state: if slips { ContactState::Slip } else { ContactState::Stick },
        turn_deg: 0.0,
        tension_before_n: c.ends.tension[0],
        tension_after_n: c.ends.tension[1],
        begins_m: c.ends.material[0],
        ends_m: c.ends.material[0],
        force_n: [force.x, force.y],
        samples: vec![ContactSample::new(c.ends.material[0], force)],
        ..ContactReport::default()
    }
}

/// The reports of the heap in the pocket after contact j: one for each edge that carries a part of
/// it.
fn heap(section: &CableSection, context: &SolveContext, j: usize, name: &str) -> Vec<ContactReport> {
    let ([before, after], at) = match (&section.contacts[j], section.contacts.get(j + 1)) {
        (c, Some(next)) => {
            ([c.ends.material[1], next.ends.material[0]], context.contact_path(c).place(c.ends.place[1]).at)
        }
        (_, None) => return Vec::new(),
    };
    let edge = |b: slack_pocket::BearingContact| {
        let middle = 0.5 * (before + after);
        let mut report = ContactReport {
            obstacle: name.to_owned(),
            x_m: at.x,
            y_m: at.y,
            arc_length_m: middle,
            normal: [b.normal.x, b.normal.y],
            normal_n: b.press,
            friction_n: b.friction,
            begins_m: before,
            ends_m: after,
            ..ContactReport::default()
        };
        report.set_samples(vec![ContactSample::new(middle, b.normal * b.press + b.tangent * b.friction)]);
        report
    };
    let borne = slack_pocket::heap(section, context, j + 1).into_iter().flatten();
    borne.filter(|b| b.press > 0.0).map(edge).collect()
}

/// Stretches that stick and stretches at the limit of friction, with equal neighbours merged; empty
/// if all are equal.
fn parts(c: &Contact, friction: f64, stretches: &[ContactStretch]) -> Vec<ContactPart> {
    /// Fraction of mobilised friction from which it counts as fully mobilised (round-off).
    const MOBILISED_FRACTION: f64 = 1.0 - 1e-9;
    let state = |s: &ContactStretch| {
        if s.mobilised.abs() >= MOBILISED_FRACTION * friction { ContactState::Slip } else { ContactState::Stick }
    };
    let Some(first) = stretches.first().map(state).filter(|f| stretches.iter().any(|s| state(s) != *f)) else {
        return Vec::new();
    };
    let mut out = vec![ContactPart { begins_m: c.ends.material[0], ends_m: c.ends.material[1], state: first }];
    for s in stretches {
        if let Some(last) = out.last_mut().filter(|last| last.state != state(s)) {
            last.ends_m = s.arc_length;
            out.push(ContactPart { begins_m: s.arc_length, ends_m: c.ends.material[1], state: state(s) });
        }
    }
    out
}

/// Force of the cable at an end of a section (pulling along growing arc length), N.
pub(in crate::model::spans) fn end_force(
    cable_equilibrium: &CableEquilibrium,
    section: &CableSection,
    side: usize,
) -> Vec2 {
    let context = &cable_equilibrium.context;
    if let Some(loose) = &section.loose {
        return loose.end_force(context, side);
    }
    let (k, s) = if side == 0 { (0, section.from) } else { (section.contacts.len(), section.to) };
    match section.end_conditions[side] {
        EndCondition::Fixed(_) | EndCondition::Hangs(_) => section.force(context, k, s),
        EndCondition::Lies(p) => {
            let c = if side == 0 { section.contacts.first() } else { section.contacts.last() };
            c.map_or(Vec2::zeros(), |c| context.contact_path(c).place(p).tangent * c.ends.tension[side])
        }
        EndCondition::Loose(_) => Vec2::zeros(),
    }
}

/// The reactions of all supports, in their order.
fn supports(layout: &SectionLayout, cable_equilibrium: &CableEquilibrium, nodes: &[Node]) -> Vec<SupportReaction> {
    let p = &layout.problem;
    let context = &cable_equilibrium.context;
    let loads_at = |s: f64| -> Vec2 {
        let here = context.loads.iter().filter(|l: &&PointForce| l.arc_length == s);
        here.fold(Vec2::zeros(), |sum, l| sum + l.force)
    };
    let mut out = Vec::with_capacity(p.supports.len());
    for (k, s) in p.supports.iter().enumerate() {
        let mut r = SupportReaction { name: s.name.clone(), ..SupportReaction::default() };
        let at = cable_equilibrium.instant.places[k];
        if let Some((c, section)) = cable_equilibrium
            .sections
            .iter()
            .find_map(|st| st.contacts.iter().find(|c| c.wheel == Some(k)).map(|c| (c, st)))
        {
            wheel(&mut r, cable_equilibrium, section, c);
            (r.x_m, r.y_m) = (at.x, at.y);
        } else if let Some(arc_length) = s.arc_length {
            r.arc_length_m = arc_length;
            let mut force = loads_at(arc_length);
            if s.at.is_some() {
                for (section, part) in cable_equilibrium.sections.iter().zip(&layout.sections) {
                    for side in 0..2 {
                        if part.supports[side] == Some(k) {
                            force += end_force(cable_equilibrium, section, side) * if side == 0 { 1.0 } else { -1.0 };
                        }
                    }
                }
                (r.x_m, r.y_m) = (at.x, at.y);
            } else {
                force = -force;
                let i = nodes.partition_point(|n| n.arc_length_m < arc_length - SAME_POINT_FRACTION * p.length);
                (r.x_m, r.y_m) = nodes.get(i).map_or((0.0, 0.0), |n| (n.x_m, n.y_m));
            }
            (r.reaction_x_n, r.reaction_y_n) = (force.x, force.y);
        }
        out.push(r);
    }
    out
}

fn wheel(r: &mut SupportReaction, cable_equilibrium: &CableEquilibrium, section: &CableSection, c: &Contact) {
    let j = section.contacts.iter().position(|d| std::ptr::eq(d, c)).unwrap_or(0);
    let (sum, [before, after]) = wheel_force(&cable_equilibrium.context, section, j);
    (r.reaction_x_n, r.reaction_y_n) = (sum.x, sum.y);
    r.arc_length_m = 0.5 * (c.ends.material[0] + c.ends.material[1]);
    (r.tension_before_n, r.tension_after_n) = (Some(before.norm()), Some(after.norm()));
}

/// The force of the cable on the wheel of contact j, and the forces in the cable before and after
/// it, N.
pub(in crate::model::spans) fn wheel_force(
    context: &SolveContext,
    section: &CableSection,
    j: usize,
) -> (Vec2, [Vec2; 2]) {
    let [before, after] = [0, 1].map(|side| section.force_at_contact(context, j, side).unwrap_or_default());
    let [from, to] = section.contacts[j].ends.material;
    (after - before + context.load_between(from, to), [before, after])
}

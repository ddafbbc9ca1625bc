//! The answer: nodes, what supports feel, what obstacles feel.

use super::drive::Network;
use super::history::{History, Mode};
use super::instant::Layout;
use super::law::Track;
use super::seek;
use super::strand::{Contact, Strand, Tie};
use crate::catenary::PointForce;
use crate::math::{GAUSS, Vec2};
use crate::model::catenary::report::{Nodes, Point};
use crate::solution::{ContactPart, ContactReport, ContactState, Node, SupportReaction};

/// Nodes on a contact: one at least every so many radians of an arc …
const ARC_STEP: f64 = 0.13;
/// … and as many on each stretch of an edge.
const EDGE_NODES: usize = 8;

/// Longest stretch of an arc over which forces are summed with one rule of 5 Gauss points, rad: exact to 1e-11.
const PANEL: f64 = 1.0;

/// Everything a solution shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Report {
    pub nodes: Vec<Node>,
    pub supports: Vec<SupportReaction>,
    pub contacts: Vec<ContactReport>,
}

/// The answer of a network.
pub(super) fn report(layout: &Layout, network: &Network) -> Report {
    let course = &network.course;
    let mut greatest = 0.0;
    for strand in &network.strands {
        for k in (0..strand.spans()).filter(|&k| strand.has_span(k)) {
            let (from, to) = strand.material(k);
            for s in [from, to] {
                let t = strand.force(course, k, s).norm();
                greatest = if t > greatest { t } else { greatest };
            }
        }
        for t in strand.contacts.iter().flat_map(|c| c.ends.t) {
            greatest = if t > greatest { t } else { greatest };
        }
    }
    let mut nodes = Nodes::new(&layout.problem, greatest);
    for strand in &network.strands {
        for k in 0..strand.spans() {
            if strand.has_span(k) {
                seek::shapes(strand, course, k, |s0, at, shape| nodes.catenary(s0, at, shape));
            }
            if let Some(c) = strand.contacts.get(k) {
                contact_nodes(&mut nodes, &course.track(c), c);
            }
        }
    }
    let nodes = nodes.out;
    let supports = supports(layout, network, &nodes);
    let contacts = network
        .strands
        .iter()
        .flat_map(|s| &s.contacts)
        .filter_map(|c| {
            let name = layout.problem.world.obstacle_name(course.curves[c.curve].obstacle?);
            Some(contact(&course.track(c), c, name, course.friction(c)))
        })
        .collect();
    Report { nodes, supports, contacts }
}

/// Stretches of a contact on which tension has one law and the boundary one form.
fn stretches(track: &Track<'_>, history: &History, [p1, p2]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut borders = vec![p1];
    let mut p = p1;
    while p < p2 {
        p = track.next_border(p, p2);
        borders.push(p);
    }
    borders.extend(history.knots().iter().map(|k| k.p).filter(|p| *p > p1 && *p < p2));
    borders.sort_by(f64::total_cmp);
    borders.dedup();
    borders.windows(2).map(|w| [w[0], w[1]]).collect()
}

fn contact_nodes(nodes: &mut Nodes<'_>, track: &Track<'_>, c: &Contact) {
    let push = |nodes: &mut Nodes<'_>, p: f64, (tension, s): (f64, f64)| {
        let place = track.place(p);
        let curvature = if place.stretch > 0.0 { place.turn * track.law.stretch(tension) / place.stretch } else { 0.0 };
        nodes.push(Point { s, at: place.at, tension, curvature });
    };
    push(nodes, c.ends.p[0], (c.ends.t[0], c.ends.s[0]));
    for [a, b] in stretches(track, &c.history, c.ends.p) {
        let arc = track.place(0.5 * (a + b)).turn != 0.0;
        let count = if arc { ((b - a) / ARC_STEP).ceil() as usize + 1 } else { EDGE_NODES };
        for i in 1..count {
            let p = a + (b - a) * i as f64 / count as f64;
            push(nodes, p, c.history.at(track, p));
        }
        if b < c.ends.p[1] {
            push(nodes, b, c.history.at(track, b));
        }
    }
    push(nodes, c.ends.p[1], (c.ends.t[1], c.ends.s[1]));
}

/// Normal force summed over a contact, its direction, the pull of the load along it, and how far it turns.
fn pressed(track: &Track<'_>, c: &Contact) -> (f64, Vec2, f64, f64) {
    let (mut normal, mut push, mut along, mut turned) = (0.0, Vec2::zeros(), 0.0, 0.0);
    for [a, b] in stretches(track, &c.history, c.ends.p) {
        let panels = if track.place(0.5 * (a + b)).turn == 0.0 { 1.0 } else { ((b - a) / PANEL).ceil().max(1.0) };
        let h = (b - a) / panels;
        for k in 0..panels as usize {
            for (u, weight) in GAUSS {
                let p = a + (k as f64 + u) * h;
                let (t, place, weight) = (c.history.at(track, p).0, track.place(p), weight * h);
                let press = track.law.press(&place, t);
                normal += weight * press;
                push += place.normal * (weight * press);
                along += weight * track.law.load.dot(&place.tangent) * place.stretch / track.law.stretch(t);
                turned += weight * place.turn;
            }
        }
    }
    (normal, push, along, turned)
}

fn contact(track: &Track<'_>, c: &Contact, name: &str, friction: f64) -> ContactReport {
    let (normal_n, push, along, turned) = pressed(track, c);
    let middle = track.place(0.5 * (c.ends.p[0] + c.ends.p[1]));
    let unit = if push.norm() > 0.0 { push.normalize() } else { middle.normal };
    let [t1, t2] = c.ends.t;
    let slips = friction <= 0.0 || matches!(c.mode, Mode::Slide(_));
    ContactReport {
        obstacle: name.to_owned(),
        x_m: middle.at.x,
        y_m: middle.at.y,
        arc_length_m: 0.5 * (c.ends.s[0] + c.ends.s[1]),
        normal: [unit.x, unit.y],
        normal_n,
        friction_n: t1 - t2 - along,
        state: if slips { ContactState::Slip } else { ContactState::Stick },
        turn_deg: turned.to_degrees(),
        tension_before_n: t1,
        tension_after_n: t2,
        begins_m: c.ends.s[0],
        ends_m: c.ends.s[1],
        parts: if slips { Vec::new() } else { parts(track, c, friction) },
    }
}

/// Stretches that stick and stretches at the limit of friction, neighbours alike joined; none where all is alike.
fn parts(track: &Track<'_>, c: &Contact, friction: f64) -> Vec<ContactPart> {
    /// What is called upon of friction counts as all of it from this share on: rounding.
    const LIMIT: f64 = 1.0 - 1e-9;
    let mut out: Vec<ContactPart> = Vec::new();
    for [a, b] in stretches(track, &c.history, c.ends.p) {
        let slid = c.history.called(track, 0.5 * (a + b)).abs() >= LIMIT * friction;
        let state = if slid { ContactState::Slip } else { ContactState::Stick };
        let [begins_m, ends_m] = [a, b].map(|p| c.history.at(track, p).1);
        match out.last_mut() {
            Some(last) if last.state == state => last.ends_m = ends_m,
            _ => out.push(ContactPart { begins_m, ends_m, state }),
        }
    }
    if out.len() > 1 { out } else { Vec::new() }
}

/// Force of the cable at an end of a strand (pulling along growing arc length), N.
fn end_force(network: &Network, strand: &Strand, side: usize) -> Vec2 {
    let course = &network.course;
    let (k, s) = if side == 0 { (0, strand.from) } else { (strand.contacts.len(), strand.to) };
    match strand.ties[side] {
        Tie::Held(_) | Tie::Hangs(_) => strand.force(course, k, s),
        Tie::Lies(p) => {
            let c = if side == 0 { strand.contacts.first() } else { strand.contacts.last() };
            c.map_or(Vec2::zeros(), |c| course.track(c).place(p).tangent * c.ends.t[side])
        }
        Tie::Loose(_) => Vec2::zeros(),
    }
}

fn supports(layout: &Layout, network: &Network, nodes: &[Node]) -> Vec<SupportReaction> {
    let p = &layout.problem;
    let course = &network.course;
    let loads_at = |s: f64| -> Vec2 {
        let here = course.loads.iter().filter(|l: &&PointForce| l.arc_length == s);
        here.fold(Vec2::zeros(), |sum, l| sum + l.force)
    };
    let mut out = Vec::with_capacity(p.supports.len());
    for (k, s) in p.supports.iter().enumerate() {
        let mut r = SupportReaction { name: s.name.clone(), ..SupportReaction::default() };
        let at = network.instant.places[k];
        if let Some((c, strand)) =
            network.strands.iter().find_map(|st| st.contacts.iter().find(|c| c.wheel == Some(k)).map(|c| (c, st)))
        {
            wheel(&mut r, network, strand, c);
            (r.x_m, r.y_m) = (at.x, at.y);
        } else if let Some(arc_length) = s.arc_length {
            r.arc_length_m = arc_length;
            let mut force = loads_at(arc_length);
            if s.at.is_some() {
                for (strand, part) in network.strands.iter().zip(&layout.strands) {
                    for side in 0..2 {
                        if part.supports[side] == Some(k) {
                            force += end_force(network, strand, side) * if side == 0 { 1.0 } else { -1.0 };
                        }
                    }
                }
                (r.x_m, r.y_m) = (at.x, at.y);
            } else {
                force = -force;
                let i = nodes.partition_point(|n| n.arc_length_m < arc_length - 1e-12 * p.length);
                (r.x_m, r.y_m) = nodes.get(i).map_or((0.0, 0.0), |n| (n.x_m, n.y_m));
            }
            (r.reaction_x_n, r.reaction_y_n) = (force.x, force.y);
        }
        out.push(r);
    }
    out
}

fn wheel(r: &mut SupportReaction, network: &Network, strand: &Strand, c: &Contact) {
    let course = &network.course;
    let j = strand.contacts.iter().position(|d| std::ptr::eq(d, c)).unwrap_or(0);
    let force = |side: usize| strand.force_at_contact(course, j, side).unwrap_or_default();
    let (before, after) = (force(0), force(1));
    let own = course.load_between(c.ends.s[0], c.ends.s[1]);
    let sum = after - before + own;
    (r.reaction_x_n, r.reaction_y_n) = (sum.x, sum.y);
    r.arc_length_m = 0.5 * (c.ends.s[0] + c.ends.s[1]);
    (r.tension_before_n, r.tension_after_n) = (Some(before.norm()), Some(after.norm()));
}

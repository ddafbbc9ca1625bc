//! A strand that lies without tension.
//!
//! With more cable than it takes to hang plumb from both supports down to the ground and to lie along it between the feet, no
//! part of it needs any tension but what hangs: F(s) = −b (s_foot − s) in the air, 0 on the ground, whose friction holds each metre
//! by itself where |t·b| ≤ μ |n·b|. What is over lies in folds. A plane cannot show where, nor in how many layers: they are spread
//! evenly over the way on the ground, which carries their weight where it carries the rest. Of a plumb end h long, stretched,
//!
//! ```text
//! h = λ (s + b s²/2EA)
//! ```
//!
//! Any other rest of the same cable is one that pulls or leans somewhere, and then only by what friction remembers.

use super::curve::{Curve, Form, Place};
use super::instant::{Instant, Layout};
use super::strand::{Course, Strand, Tie};
use super::way::way;
use crate::contact::World;
use crate::contact::geometry::Body;
use crate::math::{Vec2, cross, larger};
use crate::model::arc_nodes;
use crate::model::catenary::report::{Nodes, Point};
use crate::solution::{ContactReport, ContactSample, ContactState};

/// Part of the cone by which the ground may be steeper: rounding.
const CONE: f64 = 1e-9;
/// Part of the cable that there must be too much of: what is as long as its way lies along it, and remembers what friction does.
const OVER: f64 = 1e-9;
/// Depth (m) at which a support or the way along the ground still counts as clear: rounding of kilometres.
const ON: f64 = super::events::ON;
/// Nodes of a plumb end and of a straight stretch.
const NODES: usize = 8;

/// How a strand lies.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Loose {
    /// Index of the boundary it lies on.
    curve: usize,
    /// Stretches of it from foot to foot: piece, and p on it from where to where.
    stretches: Vec<(i64, [f64; 2])>,
    /// Supports, m.
    ends: [Vec2; 2],
    /// Material at both feet, m.
    feet: [f64; 2],
    /// Length of the way from foot to foot, m.
    way: f64,
    /// Dead loads on free ends, which lie, N.
    drawn: [Vec2; 2],
}

/// A point below a support.
#[derive(Clone, Copy, Debug)]
struct Foot {
    body: usize,
    height: f64,
    at: Vec2,
}

/// The strand as it lies loose at an instant; None where it does not.
pub(super) fn lay(layout: &Layout, index: usize, (course, instant): (&Course, &Instant)) -> Option<Strand> {
    let part = layout.strands.get(index)?;
    let (load, [from, to]) = (course.law.load, part.material);
    let loaded = course.loads.iter().any(|l| l.arc_length > from && l.arc_length < to && l.force.norm() > 0.0);
    if !(load.norm() > 0.0) || loaded || !part.pulleys.is_empty() {
        return None;
    }
    let world = &layout.problem.world;
    let held = part.supports.map(|s| s.and_then(|k| instant.places.get(k).copied()));
    let feet = held.map(|at| at.and_then(|at| foot(course, world, at)));
    // A free end lies in a heap below the support.
    let (before, after) = match (held, feet) {
        ([Some(_), Some(_)], [Some(a), Some(b)]) if a.body == b.body => (a, b),
        ([Some(_), None], [Some(a), _]) => (a, Foot { height: 0.0, ..a }),
        ([None, Some(_)], [_, Some(b)]) => (Foot { height: 0.0, ..b }, b),
        _ => return None,
    };
    let [a, b] = [held[0].unwrap_or(before.at), held[1].unwrap_or(after.at)];
    let hangs = [before, after].map(|f| plumb(course, f.height));
    let feet = [from + hangs[0], to - hangs[1]];
    let drawn = [0, 1].map(|side| match part.supports[side] {
        None => layout.end_force(instant, part.material[side]),
        Some(_) => Vec2::zeros(),
    });
    let laid = way(layout, part, instant).points;
    for index in [2 * before.body, 2 * before.body + 1] {
        let Some(stretches) = between(&course.curves[index], [before.at, after.at], load) else { continue };
        let curve = &course.curves[index];
        let length: f64 = stretches.iter().map(|s| stretch_length(curve, s)).sum();
        if !(course.law.stretch(0.0) * (feet[1] - feet[0]) - length > OVER * (to - from)) {
            continue;
        }
        let loose = Loose { curve: index, stretches, ends: [a, b], feet, way: length, drawn };
        if loose.holds_drawn(course) && loose.is_reached(course, world, (before.body, &laid)) {
            let ties = [0, 1].map(|k| held[k].map_or(Tie::Loose(drawn[k]), Tie::Held));
            return Some(Strand {
                from,
                to,
                ties,
                contacts: Vec::new(),
                forces: vec![Vec2::zeros()],
                loose: Some(loose),
            });
        }
    }
    None
}

/// Material that hangs plumb over a height, m.
fn plumb(course: &Course, height: f64) -> f64 {
    let law = &course.law;
    let free = height / law.thermal;
    2.0 * free / (1.0 + (1.0 + 2.0 * law.load.norm() * free / law.stiffness).sqrt())
}

/// The first that a plumb line from a point comes down on, if that carries what lies on it.
fn foot(course: &Course, world: &World, from: Vec2) -> Option<Foot> {
    if world.signed_gap(from, 1.0).is_some_and(|g| g.gap_m < -ON) {
        return None;
    }
    let down = course.law.load.normalize();
    let mut best: Option<Foot> = None;
    let bodies = world.geometry().bodies().len();
    for body in 0..bodies {
        let curve = course.curves.get(2 * body)?;
        for height in curve.pieces().filter_map(|i| meets(curve, i, (from, down))) {
            if best.is_none_or(|b| height < b.height) {
                let height = larger(height, 0.0);
                best = Some(Foot { body, height, at: from + down * height });
            }
        }
    }
    best
}

/// How far along a ray it comes down on piece i.
fn meets(curve: &Curve, i: i64, (from, down): (Vec2, Vec2)) -> Option<f64> {
    match curve.piece(i).form {
        Form::Edge { .. } => {
            let start = curve.place_on(i, 0.0);
            let faces = start.normal.dot(&down);
            let height = (start.at - from).dot(&start.normal) / faces;
            let x = (from + down * height - start.at).dot(&start.tangent);
            let on = x >= -ON && x <= curve.piece(i).extent + ON;
            (faces < 0.0 && on && height >= -ON).then_some(height)
        }
        Form::Arc { center, radius, .. } => {
            let c = center + curve.shift - from;
            let aside = cross(down, c);
            let square = radius * radius - aside * aside;
            if !(square >= 0.0) {
                return None;
            }
            let height = c.dot(&down) - square.sqrt();
            let at = from + down * height;
            let p = curve.project(i, at);
            let on = (curve.place_on(i, p - curve.origin(i)).at - at).norm() <= ON;
            (on && height >= -ON).then_some(height)
        }
    }
}

/// The stretches of a boundary from one point of it to another, all of which hold what lies on them; None where they do not.
fn between(curve: &Curve, [from, to]: [Vec2; 2], load: Vec2) -> Option<Vec<(i64, [f64; 2])>> {
    let nearest = |at: Vec2| {
        let far = |i: &i64| (curve.place_on(*i, curve.project(*i, at) - curve.origin(*i)).at - at).norm();
        curve.pieces().min_by(|i, j| far(i).total_cmp(&far(j)))
    };
    let [first, last] = [nearest(from)?, nearest(to)?];
    let ends = [curve.project(first, from), curve.project(last, to)];
    let count = curve.pieces().count() as i64;
    let ahead = first < last || (first == last && ends[0] <= ends[1]);
    if !ahead && !curve.is_closed() {
        return None;
    }
    let last = if ahead { last } else { last + count };
    let mut out = Vec::with_capacity((last - first + 1) as usize);
    for i in first..=last {
        let p = [
            if i == first { ends[0] } else { curve.origin(i) },
            if i == last { ends[1] + (curve.origin(i) - curve.origin(i.rem_euclid(count))) } else { curve.end(i) },
        ];
        let holds = |p: f64| {
            let place = curve.place_on(i, p - curve.origin(i));
            let press = -load.dot(&place.normal);
            press > 0.0 && load.dot(&place.tangent).abs() <= curve.friction * press + CONE * load.norm()
        };
        if p[1] > p[0] && !p.iter().all(|p| holds(*p)) {
            return None;
        }
        // What is round less than half a turn leans most at its ends.
        if curve.is_arc(i) && p[1] - p[0] >= std::f64::consts::PI {
            return None;
        }
        out.push((i, p));
    }
    Some(out)
}

fn stretch_length(curve: &Curve, (i, [a, b]): &(i64, [f64; 2])) -> f64 {
    (b - a) * curve.place_on(*i, 0.0).stretch
}

impl Loose {
    /// Whether the ground holds a heap with the load in it.
    fn holds_drawn(&self, course: &Course) -> bool {
        let drawn: Vec2 = self.drawn.iter().sum();
        let (Some((i, [p, _])), true) = (self.stretches.first(), drawn.norm() > 0.0) else { return true };
        let curve = &course.curves[self.curve];
        let place = curve.place_on(*i, p - curve.origin(*i));
        let force = drawn + course.law.load * (self.feet[1] - self.feet[0]);
        force.dot(&place.tangent).abs() <= -curve.friction * force.dot(&place.normal)
    }

    /// Whether the cable comes there from its route without passing through anything, and lies clear of all else.
    fn is_reached(&self, course: &Course, world: &World, (own, laid): (usize, &[Vec2])) -> bool {
        let curve = &course.curves[self.curve];
        let mut shape = vec![self.ends[0]];
        for (i, [a, b]) in &self.stretches {
            shape.extend([a, b].map(|p| curve.place_on(*i, p - curve.origin(*i)).at));
        }
        shape.push(self.ends[1]);
        let bodies = world.geometry().bodies();
        let mut gaps = Vec::new();
        for pair in shape.windows(2) {
            world.segment_gaps(pair[0], pair[1], 0.0, &mut gaps);
        }
        if gaps.iter().any(|g| g.gap_m < -ON && Some(g.obstacle) != bodies.get(own).map(|b| b.obstacle)) {
            return false;
        }
        shape.extend(laid.iter().rev());
        let inner = |(k, body): (usize, &Body)| match (k == own, body.is_ground()) {
            (true, true) => None,
            (true, false) => body.center.or_else(|| Some(mean(body))),
            (false, _) => body.center.or_else(|| body.edges.first().map(|e| e.p)),
        };
        bodies.iter().enumerate().filter_map(inner).all(|at| !encloses(&shape, at))
    }

    /// Adds its nodes and what it lies on.
    pub fn report(
        &self,
        (course, strand): (&Course, &Strand),
        nodes: &mut Nodes<'_>,
        cable_radius: f64,
    ) -> Option<(usize, ContactReport)> {
        let (law, [first, last]) = (&course.law, self.feet);
        let b = law.load.norm();
        let down = law.load / b;
        let hang = |side: usize, u: f64| {
            // u runs from the support down to the foot.
            let (end, foot) = if side == 0 { (strand.from, first) } else { (strand.to, last) };
            let whole = (foot - end).abs();
            let s = whole * u;
            let tension = b * (whole - s);
            let below = law.thermal * s * (1.0 + b * (whole - 0.5 * s) / law.stiffness);
            let sign = if side == 0 { 1.0 } else { -1.0 };
            Point {
                s: end + sign * s,
                at: self.ends[side] + down * below,
                force: down * (sign * tension),
                curvature: 0.0,
            }
        };
        let part = |k: usize| k as f64 / NODES as f64;
        let hung = [first > strand.from, last < strand.to];
        (0..=NODES).filter(|k| hung[0] || *k == 0).for_each(|k| nodes.push(hang(0, part(k))));
        let curve = &course.curves[self.curve];
        let density = if self.way > 0.0 { (last - first) / self.way } else { 0.0 };
        let (mut s, mut samples) = (first, Vec::new());
        let (mut normal, mut push, mut along, mut turned) = (0.0, Vec2::zeros(), 0.0, 0.0);
        let mut carry = |place: &Place, s: f64, carried: Vec2| {
            let held = -carried;
            normal += held.dot(&place.normal);
            push += place.normal * held.dot(&place.normal);
            along += held.dot(&place.tangent);
            samples.push(ContactSample::new(s, held));
        };
        for stretch in &self.stretches {
            let (i, [from, to]) = *stretch;
            let length = stretch_length(curve, stretch);
            let start = curve.place_on(i, from - curve.origin(i));
            turned += start.turn * (to - from);
            let count = if start.stretch > 0.0 && start.turn != 0.0 {
                arc_nodes::parts(start.stretch, to - from, cable_radius)
            } else {
                NODES
            };
            let material = density * length / count as f64;
            for k in 0..count {
                let place = |u: f64| curve.place_on(i, from + (to - from) * u / count as f64 - curve.origin(i));
                carry(&place(k as f64 + 0.5), s + 0.5 * material, law.load * material);
                s += material;
                let end = place(k as f64 + 1.0);
                let curvature = if end.stretch > 0.0 { end.turn * law.stretch(0.0) / end.stretch } else { 0.0 };
                nodes.push(Point { s, at: end.at, force: Vec2::zeros(), curvature });
            }
        }
        if self.way == 0.0
            && let Some((i, [p, _])) = self.stretches.first()
        {
            // All of it in one place.
            let place = curve.place_on(*i, p - curve.origin(*i));
            let drawn: Vec2 = self.drawn.iter().sum();
            carry(&place, 0.5 * (first + last), law.load * (last - first) + drawn);
        }
        (0..=NODES).rev().filter(|k| hung[1] || *k == 0).for_each(|k| nodes.push(hang(1, part(k))));
        let obstacle = curve.obstacle?;
        let middle = self.stretches.get(self.stretches.len() / 2);
        let at = middle.map_or(self.ends[0], |(i, [a, b])| curve.place_on(*i, 0.5 * (a + b) - curve.origin(*i)).at);
        let unit = push.try_normalize(0.0).unwrap_or(-down);
        let mut report = ContactReport {
            x_m: at.x,
            y_m: at.y,
            arc_length_m: 0.5 * (first + last),
            normal: [unit.x, unit.y],
            normal_n: normal,
            friction_n: along,
            state: if curve.friction > 0.0 { ContactState::Stick } else { ContactState::Slip },
            turn_deg: turned.to_degrees(),
            begins_m: first,
            ends_m: last,
            ..ContactReport::default()
        };
        report.set_samples(samples);
        Some((obstacle, report))
    }

    /// Force in the cable at a support, N.
    pub fn end_force(&self, (course, strand): (&Course, &Strand), side: usize) -> Vec2 {
        let end = if side == 0 { strand.from } else { strand.to };
        course.law.load * (self.feet[side] - end)
    }

    /// What the ground carries of it, N.
    pub fn held(&self, course: &Course) -> Vec2 {
        -course.law.load * (self.feet[1] - self.feet[0]) - self.drawn.iter().sum::<Vec2>()
    }

    /// The most that friction can hold of what lies, N.
    pub fn friction(&self, course: &Course) -> f64 {
        course.curves[self.curve].friction * self.held(course).norm()
    }

    /// Material that lies, and the length of ground it lies on, m.
    pub fn lies(&self) -> [f64; 2] {
        [self.feet[1] - self.feet[0], self.way]
    }
}

/// The middle of a body's edges.
fn mean(body: &Body) -> Vec2 {
    body.edges.iter().map(|e| (e.p + e.q) * 0.5).sum::<Vec2>() / larger(body.edges.len() as f64, 1.0)
}

/// Whether a closed polygon goes round a point: counted by the turns its sides make about it.
fn encloses(polygon: &[Vec2], at: Vec2) -> bool {
    let turns: f64 = (0..polygon.len())
        .map(|k| {
            let [a, b] = [polygon[k] - at, polygon[(k + 1) % polygon.len()] - at];
            cross(a, b).atan2(a.dot(&b))
        })
        .sum();
    turns.abs() > 1.0
}

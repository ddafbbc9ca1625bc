//! Whether the cable has passed through something on its way from one shape to another.
//!
//! The old shape and back along the new one is a closed way; what it goes round was passed through. Corners and posts
//! are looked at: nothing thinner is an obstacle.

use super::seek;
use super::strand::{Contact, Course, Strand};
use super::taut::Corner;
use crate::contact::World;
use crate::math::{Vec2, cross, larger, smaller};

/// Points of each catenary and contact.
const POINTS: usize = 24;

/// A contact's end that moves by more than this (m or rad) may have gone round something. Smaller: more is looked at closely.
const SMALL: f64 = 0.5;

/// A corner this near to a tangent is on it, m: rounding.
const TOUCHES: f64 = 1e-12;

/// Whether the ends of the spans alone tell that nothing was passed: contacts are the same, and every corner lies on the same
/// side of each span before and after. A span is convex: above its tangents and below its chord, seen against the load.
pub(super) fn clear(old: &Strand, new: &Strand, course: &Course, corners: &[Corner]) -> bool {
    let load = course.law.load;
    let same = |(a, b): (&Contact, &Contact)| {
        let moved = |side: usize| (a.ends.p[side] - b.ends.p[side]).abs();
        (a.curve, a.home, a.wheel, a.pocket, a.weight) == (b.curve, b.home, b.wheel, b.pocket, b.weight)
            && moved(0) < SMALL
            && moved(1) < SMALL
    };
    load.x == 0.0
        && load.y < 0.0
        && old.contacts.len() == new.contacts.len()
        && old.contacts.iter().zip(&new.contacts).all(same)
        && [0, 1].into_iter().all(|k| old.ties[k].has_span() == new.ties[k].has_span())
        && (0..new.spans()).filter(|&k| new.has_span(k)).all(|k| {
            let spans = [old, new].map(|strand| Bow::of(strand, course, k));
            let [Some(a), Some(b)] = spans else { return false };
            let (low, high) = (smaller(a.low, b.low), larger(a.high, b.high));
            let first = corners.partition_point(|c| c.at.x < low);
            corners[first..].iter().take_while(|c| c.at.x <= high).all(|c| {
                let inside = |bow: &Bow| c.at.x > bow.low && c.at.x < bow.high;
                inside(&a)
                    && inside(&b)
                    && (a.is_above(c.at) && b.is_above(c.at) || a.is_below(c.at) && b.is_below(c.at))
            })
        })
}

/// A span by its ends: from where to where in x, its tangents and its chord.
struct Bow {
    low: f64,
    high: f64,
    ends: [Vec2; 2],
    tangents: [Option<(Vec2, Vec2)>; 2],
}

impl Bow {
    /// None where an end hangs or loads act on the way.
    fn of(strand: &Strand, course: &Course, k: usize) -> Option<Self> {
        let (from, to) = strand.material(k);
        let [Some(a), Some(b)] = strand.ends_of(course, k) else { return None };
        if course.loads.iter().any(|l| l.arc_length > from && l.arc_length < to) {
            return None;
        }
        let side = |at: Vec2, s: f64| seek::tangent(at, strand.force(course, k, s), course.law.load);
        let (low, high) = (smaller(a.x, b.x), larger(a.x, b.x));
        Some(Self { low, high, ends: [a, b], tangents: [side(a, from), side(b, to)] })
    }

    /// Whether a point between its ends lies below it.
    fn is_above(&self, v: Vec2) -> bool {
        self.tangents.iter().flatten().any(|(at, normal)| (v - at).dot(normal) <= TOUCHES)
    }

    /// Whether a point between its ends lies above it.
    fn is_below(&self, v: Vec2) -> bool {
        let [a, b] = self.ends;
        let up = cross(b - a, v - a);
        if a.x < b.x { up >= 0.0 } else { up <= 0.0 }
    }
}

/// A shape of a strand as points.
pub(super) fn shape(strand: &Strand, course: &Course, out: &mut Vec<Vec2>) {
    out.clear();
    for k in 0..strand.spans() {
        if strand.has_span(k) {
            seek::shapes(strand, course, k, |_, at, c| {
                let h = c.span().length / POINTS as f64;
                out.extend((0..=POINTS).map(|i| at + c.position_at(i as f64 * h)));
            });
        }
        if let Some(c) = strand.contacts.get(k) {
            let track = course.track(c);
            let [a, b] = c.ends.p;
            out.extend((0..=POINTS).map(|i| track.place(a + (b - a) * i as f64 / POINTS as f64).at));
        }
    }
}

/// Convex corners and the middles of posts, in order of x.
pub(super) fn corners(world: &World) -> Vec<Corner> {
    let mut out = Vec::new();
    for (body, b) in world.geometry().bodies().iter().enumerate() {
        out.extend(b.center.map(|at| Corner { at, body, feature: b.first + 1 }));
        let jutting = (0..=b.edges.len()).filter_map(|k| b.corner(k)).filter(|c| b.juts_out(c));
        out.extend(jutting.map(|c| Corner { at: c.at, body, feature: c.feature }));
    }
    out.sort_by(|a, b| a.at.x.total_cmp(&b.at.x));
    out
}

/// A corner that lies between the old shape and the new one, the farthest from the new one. `turns`: memory.
///
/// How often the closed way goes round a corner is how often it passes above it to the right, less to the left.
pub(super) fn through(corners: &[Corner], old: &[Vec2], new: &[Vec2], turns: &mut Vec<i32>) -> Option<Corner> {
    let (low, high) = old.iter().chain(new).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
        (if p.x < low { p.x } else { low }, if p.x > high { p.x } else { high })
    });
    let first = corners.partition_point(|c| c.at.x < low);
    let corners = corners.get(first..corners.partition_point(|c| c.at.x <= high))?;
    turns.clear();
    turns.resize(corners.len(), 0);
    let mut pass = |a: Vec2, b: Vec2| {
        let (left, right, sign) = if a.x <= b.x { (a, b, 1) } else { (b, a, -1) };
        let from = corners.partition_point(|c| c.at.x < left.x);
        for (c, turns) in corners.iter().zip(turns.iter_mut()).skip(from).take_while(|(c, _)| c.at.x < right.x) {
            if cross(right - left, c.at - left) < 0.0 {
                *turns += sign;
            }
        }
    };
    let (Some(&start), Some(&end)) = (old.first(), old.last()) else { return None };
    old.windows(2).for_each(|w| pass(w[0], w[1]));
    new.windows(2).for_each(|w| pass(w[1], w[0]));
    // The ends, where they moved.
    if let (Some(&a), Some(&b)) = (new.first(), new.last()) {
        pass(end, b);
        pass(a, start);
    }
    let mut best: Option<(f64, Corner)> = None;
    for (c, _) in corners.iter().zip(turns.iter()).filter(|(_, t)| **t != 0) {
        let far = new.iter().map(|p| (p - c.at).norm()).fold(f64::INFINITY, |a, b| if b < a { b } else { a });
        if best.is_none_or(|b| far > b.0) {
            best = Some((far, *c));
        }
    }
    best.map(|b| b.1)
}

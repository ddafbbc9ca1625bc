//! The tunnelling check compares the cable's shapes before and after a step as points
//! (`contact/swept_corners.rs`), and decides when this is not necessary.

use crate::contact::swept_corners::ImpassableCorner;
use crate::math::{Vec2, cross, larger, perp, smaller};
use crate::model::spans::section::{CableSection, Connection, Contact, SolveContext};

/// Distance (m) from a tangent within which a corner is on it (round-off).
const TANGENCY_DISTANCE_M: f64 = 1e-12;

/// Angle of a cable's tangent with its load below which it hangs along the load. Smaller: round-off
/// decides on which side of the tangent the cable is. Larger: steep spans are compared as points
/// without need.
const HANGING_ANGLE: f64 = 1e-6;

/// A line with the side of it (a unit vector) on which the cable is.
pub(in crate::model::spans) type Side = (Vec2, Vec2);

/// The tangent of a cable at a point where its force is known.
pub(in crate::model::spans) fn tangent(at: Vec2, force: Vec2, load: Vec2) -> Option<Side> {
    let normal = perp(force) * -perp(force).dot(&load).signum() / force.norm();
    (normal.dot(&load) < -HANGING_ANGLE * load.norm()).then_some((at, normal))
}

/// True if the ends of the spans alone prove that no corner was passed: the contacts are the same,
/// and every corner lies on the same side of each span before and after. A span is convex: above
/// its tangents and below its chord, seen against the load.
pub(in crate::model::spans) fn is_clear(
    old: &CableSection,
    new: &CableSection,
    context: &SolveContext,
    corners: &[ImpassableCorner],
) -> bool {
    let (load, unchecked) = (context.law.load, context.settings.acceptance.unchecked_move);
    let same = |(a, b): (&Contact, &Contact)| {
        let moved = |side: usize| (a.ends.place[side] - b.ends.place[side]).abs();
        (a.curve, a.chain_range, a.wheel, a.next == Connection::Pocket, a.is_load())
            == (b.curve, b.chain_range, b.wheel, b.next == Connection::Pocket, b.is_load())
            && moved(0) < unchecked
            && moved(1) < unchecked
    };
    load.x == 0.0
        && load.y < 0.0
        && old.contacts.len() == new.contacts.len()
        && old.contacts.iter().zip(&new.contacts).all(same)
        && [0, 1].into_iter().all(|k| old.end_conditions[k].has_span() == new.end_conditions[k].has_span())
        && (0..new.spans()).filter(|&k| new.has_span(k)).all(|k| {
            let spans = [old, new].map(|section| SpanBound::of(section, context, k));
            let [Some(a), Some(b)] = spans else { return false };
            let (low, high) = (smaller(a.low, b.low), larger(a.high, b.high));
            let first = corners.partition_point(|c| c.at.x < low);
            corners[first..].iter().take_while(|c| c.at.x <= high).all(|c| {
                let inside = |bound: &SpanBound| c.at.x > bound.low && c.at.x < bound.high;
                inside(&a)
                    && inside(&b)
                    && (a.is_above(c.at) && b.is_above(c.at) || a.is_below(c.at) && b.is_below(c.at))
            })
        })
}

/// Bounds of a span from its ends: its range in x, its tangents and its chord.
struct SpanBound {
    low: f64,
    high: f64,
    ends: [Vec2; 2],
    tangents: [Option<Side>; 2],
}

impl SpanBound {
    /// The bounds of span `k`; None if an end hangs or loads act within it.
    fn of(section: &CableSection, context: &SolveContext, k: usize) -> Option<Self> {
        let (from, to) = section.material(k);
        let [Some(a), Some(b)] = section.span_ends(context, k) else { return None };
        if context.loads.iter().any(|l| l.arc_length > from && l.arc_length < to) {
            return None;
        }
        let side = |at: Vec2, s: f64| tangent(at, section.force(context, k, s), context.law.load);
        let (low, high) = (smaller(a.x, b.x), larger(a.x, b.x));
        Some(Self { low, high, ends: [a, b], tangents: [side(a, from), side(b, to)] })
    }

    /// True if a point between its ends lies below it.
    fn is_above(&self, v: Vec2) -> bool {
        self.tangents.iter().flatten().any(|(at, normal)| (v - at).dot(normal) <= TANGENCY_DISTANCE_M)
    }

    /// True if a point between its ends lies above it.
    fn is_below(&self, v: Vec2) -> bool {
        let [a, b] = self.ends;
        let up = cross(b - a, v - a);
        if a.x < b.x { up >= 0.0 } else { up <= 0.0 }
    }
}

/// A shape of a section as points.
pub(in crate::model::spans) fn shape(section: &CableSection, context: &SolveContext, out: &mut Vec<Vec2>) {
    let points = context.settings.acceptance.tunnelling_points;
    out.clear();
    for k in 0..section.spans() {
        if section.has_span(k) {
            section.shapes(context, k, |_, at, c| {
                let h = c.span().length / points as f64;
                out.extend((0..=points).map(|i| at + c.position_at(i as f64 * h)));
            });
        }
        if let Some(c) = section.contacts.get(k) {
            let contact_path = context.contact_path(c);
            let [a, b] = c.ends.place;
            out.extend((0..=points).map(|i| contact_path.place(a + (b - a) * i as f64 / points as f64).at));
        }
    }
}

//! This module moves ends of contacts over edges: along an edge the direction is constant, so
//! Newton's method cannot move an end across it.

use crate::math::{Vec2, smaller};
use crate::model::spans::boundary::{ChainRange, Curve};
use crate::model::spans::section::{CableSection, SolveContext};

/// Distance from the end of an arc within which an end of a contact counts as being there, as a
/// fraction of the arc: Newton's steps go beyond the end by less.
const ARC_END_FRACTION: f64 = 1e-8;

/// Moves contacts whose end is at the end of an arc, with the span turned into the edge behind it,
/// to the corner at the far end of the edge; and contacts whose end is at the start of an arc, with
/// the span lifted off the edge before it, back to the near corner. Returns whether there was one.
/// A stiff taut cable turns by only w/T per metre along an edge.
pub(super) fn follow_edges(section: &mut CableSection, context: &SolveContext) -> bool {
    let mut any = false;
    for j in 0..section.contacts.len() {
        for side in 0..2 {
            let c = &section.contacts[j];
            let curve = &context.curves[c.curve];
            let p = c.ends.place[side];
            let i = curve.locate(p, c.chain_range);
            let border = |q: f64| (p - q).abs() <= ARC_END_FRACTION * (1.0 + p.abs());
            if c.wheel.is_none()
                && !c.is_load()
                && section.has_span(j + side)
                && (border(curve.origin(i)) || border(curve.end(i)))
            {
                let s = section.contacts[j].ends.material[side];
                let leans = section.force(context, j + side, s).try_normalize(0.0);
                any |= move_end_over_edges(section, context, j, side, None)
                    || move_end_back_over_edge(section, context, j, side)
                    || move_end_over_edges(section, context, j, side, leans);
            }
        }
    }
    any
}
/// Moves the ends of the contacts beside contact k over the edges towards it.
pub(super) fn move_neighbours_over_edges(section: &mut CableSection, context: &SolveContext, k: usize) {
    for (j, side) in [(k.checked_sub(1), 1), (Some(k + 1), 0)] {
        if let Some(j) = j.filter(|&j| section.contacts.get(j).is_some_and(|c| c.wheel.is_none() && !c.is_load())) {
            move_end_over_edges(section, context, j, side, None);
        }
    }
}

/// Moves an end of contact j over edges; returns whether it moved.
fn move_end_over_edges(
    section: &mut CableSection,
    context: &SolveContext,
    j: usize,
    side: usize,
    leans: Option<Vec2>,
) -> bool {
    let far = section.span_ends(context, j + side)[side];
    let c = &mut section.contacts[j];
    let p = beyond_edges(&context.curves[c.curve], c.chain_range, c.ends.place[side], side, far, leans);
    if p == c.ends.place[side] {
        return false;
    }
    let way = context.curves[c.curve].length(c.ends.place[side], p, c.chain_range)
        / context.law.stretch(c.ends.tension[side]);
    (c.ends.place[side], c.ends.material[side]) = (p, c.ends.material[side] + way);
    true
}

/// Moves an end of contact j at the start of an arc (in the direction of the contact) back over the
/// edge before it if its span leaves that edge; returns whether it moved.
fn move_end_back_over_edge(section: &mut CableSection, context: &SolveContext, j: usize, side: usize) -> bool {
    let Some(far) = section.span_ends(context, j + side)[side] else { return false };
    let c = &mut section.contacts[j];
    let (curve, p) = (&context.curves[c.curve], c.ends.place[side]);
    let (back, forward) = if side == 0 { (1, -1.0) } else { (-1, 1.0) };
    let i = curve.locate(p, c.chain_range);
    let arc = if curve.is_arc(i) { i } else { i - back };
    let (edge, near) = (arc + back, arc + 2 * back);
    let inside = |i: i64| i >= c.chain_range.first && i <= c.chain_range.last;
    let way = (far - curve.place(p, c.chain_range).at) * forward;
    if ![arc, edge, near].into_iter().all(inside) || curve.is_arc(edge) || !curve.is_arc(arc) || !curve.is_arc(near) {
        return false;
    }
    if curve.beyond_arc(arc, way) != back {
        return false;
    }
    let q = curve.with_tangent(near, way);
    let other = c.ends.place[1 - side];
    let q = if (q - other) * forward > 0.0 { q } else { other };
    let moved = curve.length(p, q, c.chain_range) / context.law.stretch(c.ends.tension[side]);
    (c.ends.place[side], c.ends.material[side]) = (q, c.ends.material[side] + moved);
    moved != 0.0
}

/// The boundary coordinate to which a contact's end at p moves: over each edge into which the span
/// there leads, to the corner behind it.
///
/// `far` is the other end of the span; `leans` is its direction at the contact, if that is known
/// better than by its far end.
pub(super) fn beyond_edges(
    curve: &Curve,
    chain_range: ChainRange,
    mut p: f64,
    side: usize,
    far: Option<Vec2>,
    mut leans: Option<Vec2>,
) -> f64 {
    let (step, forward) = if side == 0 { (-1, -1.0) } else { (1, 1.0) };
    let Some(far) = far else { return p };
    let inside = |i: i64| i >= chain_range.first && i <= chain_range.last;
    let mut i = curve.locate(p, chain_range);
    for _ in chain_range.first..=chain_range.last {
        let edge = if curve.is_arc(i) { i + step } else { i };
        let arc = edge + step;
        if !inside(edge) || !inside(arc) || curve.is_arc(edge) || !curve.is_arc(arc) {
            break;
        }
        let way = leans.unwrap_or_else(|| (far - curve.place(p, chain_range).at) * forward);
        // If the cable becomes tangent on the arc itself, the arc does not lead on to its edge.
        if curve.is_arc(i) && curve.beyond_arc(i, way) != step {
            break;
        }
        let place = curve.place_on(edge, 0.0);
        let corner = curve.place_on(arc, if side == 0 { curve.piece(arc).extent } else { 0.0 }).at;
        // The span leads on beyond the end of the edge, and below it there.
        let on = (far - corner) * forward;
        let below = leans.take().map_or(far - corner, |way| way * forward);
        if below.dot(&place.normal) >= 0.0 || on.dot(&place.tangent) <= 0.0 {
            break;
        }
        // The place must be on the arc itself: its border with the edge before it counts as that
        // edge.
        let border = curve.end(arc) - ARC_END_FRACTION * curve.piece(arc).extent;
        (p, i) = (smaller(curve.with_tangent(arc, on), border), arc);
    }
    p
}

//! A heap is surplus cable folded in one place: if cable can rest without tension only at a foot or
//! in a kink, the whole surplus rests there.
//!
//! If its weight points between the normals of a kink's two edges, both carry it by pressure alone;
//! else the edge on which it rests carries it within its friction cone.

use crate::math::{Vec2, cross};
use crate::model::spans::boundary::{BearingEdge, BoundaryPoint, Heap, LyingStretch, SlackForm, SlackPart};
use crate::model::spans::section::SolveContext;
use crate::model::spans::slack::upper_surfaces::LoadFrame;

/// Excess of a crest over its friction cone that counts as round-off, as a fraction of the cable's
/// weight.
pub(super) const CREST_CONE_ROUNDING: f64 = 1e-9;

/// The lowest place that holds a heap drawn by a force (N), and the index of the part after it.
pub(super) fn heap(
    parts: &[SlackPart],
    context: &SolveContext,
    frame: LoadFrame,
    force: Vec2,
) -> Option<(usize, Heap)> {
    let side = |part: Option<&SlackPart>, end: usize| match part.map(|p| (p.form, p.tension[end])) {
        Some((SlackForm::Lies(s), 0.0)) => Some((s, s.place(context, s.coordinates[end]))),
        _ => None,
    };
    let slack = |part: Option<&SlackPart>, end: usize| part.is_none_or(|p| p.tension[end] == 0.0);
    let mut lowest: Option<(usize, Heap)> = None;
    for k in 0..=parts.len() {
        let [before, after] = [k.checked_sub(1).and_then(|j| parts.get(j)), parts.get(k)];
        if !(slack(before, 1) && slack(after, 0)) {
            continue;
        }
        let Some(found) = carried(context, [side(before, 1), side(after, 0)], -force) else { continue };
        let height = |heap: &Heap| heap.at.dot(&frame.up);
        if lowest.as_ref().is_none_or(|(_, heap)| height(&found) < height(heap)) {
            lowest = Some((k, found));
        }
    }
    lowest
}

/// A heap that one edge with its friction, or two without, can carry under a load (N); None if they
/// cannot.
fn carried(context: &SolveContext, sides: [Option<(LyingStretch, BoundaryPoint)>; 2], load: Vec2) -> Option<Heap> {
    let at = sides.iter().flatten().next()?.1.at;
    let borne = |(s, place): (LyingStretch, BoundaryPoint)| BearingEdge {
        curve: s.curve,
        normal: place.normal,
        tangent: place.tangent,
        press: load.dot(&place.normal),
        friction: load.dot(&place.tangent),
    };
    let holds = |side: &(LyingStretch, BoundaryPoint)| {
        let b = borne(*side);
        b.press >= 0.0 && b.friction.abs() <= side.0.friction(context) * b.press + CREST_CONE_ROUNDING * load.norm()
    };
    if let Some(one) = sides.iter().flatten().find(|s| holds(s)) {
        return Some(Heap { at, edges: [Some(borne(*one)), None] });
    }
    let [Some(a), Some(b)] = sides else { return None };
    let both = cross(a.1.normal, b.1.normal);
    let press = [cross(load, b.1.normal) / both, cross(a.1.normal, load) / both];
    let pressed =
        |side: (LyingStretch, BoundaryPoint), press: f64| Some(BearingEdge { press, friction: 0.0, ..borne(side) });
    press.iter().all(|n| *n >= 0.0).then(|| Heap { at, edges: [pressed(a, press[0]), pressed(b, press[1])] })
}

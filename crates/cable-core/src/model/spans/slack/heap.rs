//! A heap is surplus cable folded in one place: if cable can rest without tension only at a foot or
//! in a kink, all that is left over rests there.
//!
//! If its weight points between the normals of a kink's two edges, both carry it by pressure alone;
//! else the edge it rests on carries it within its friction cone.

use crate::math::{Vec2, cross};
use crate::model::spans::boundary::curve::Place;
use crate::model::spans::boundary::loose::{Borne, Heap, Line, Part, Stretch};
use crate::model::spans::cable_section::Course;
use crate::model::spans::initial::drained_route::Frame;

/// Part of the weight of the cable by which a crest may be beyond its cone: rounding.
pub(super) const CREST_CONE_ROUNDING: f64 = 1e-9;

/// The lowest place that holds a heap drawn by a force (N), and before which part that is.
pub(super) fn heap(parts: &[Part], course: &Course, frame: Frame, force: Vec2) -> Option<(usize, Heap)> {
    let side = |part: Option<&Part>, end: usize| match part.map(|p| (p.form, p.tension[end])) {
        Some((Line::Lies(s), 0.0)) => Some((s, s.place(course, s.coordinates[end]))),
        _ => None,
    };
    let slack = |part: Option<&Part>, end: usize| part.is_none_or(|p| p.tension[end] == 0.0);
    let mut best: Option<(f64, usize, Heap)> = None;
    for k in 0..=parts.len() {
        let [before, after] = [k.checked_sub(1).and_then(|j| parts.get(j)), parts.get(k)];
        if !(slack(before, 1) && slack(after, 0)) {
            continue;
        }
        let Some(found) = carried(course, [side(before, 1), side(after, 0)], -force) else { continue };
        let height = found.at.dot(&frame.up);
        if best.is_none_or(|b| height < b.0) {
            best = Some((height, k, found));
        }
    }
    best.map(|(_, k, found)| (k, found))
}

fn carried(course: &Course, sides: [Option<(Stretch, Place)>; 2], held: Vec2) -> Option<Heap> {
    let at = sides.iter().flatten().next()?.1.at;
    let borne = |(s, place): (Stretch, Place)| Borne {
        curve: s.curve,
        normal: place.normal,
        tangent: place.tangent,
        press: held.dot(&place.normal),
        friction: held.dot(&place.tangent),
    };
    let holds = |side: &(Stretch, Place)| {
        let b = borne(*side);
        b.press >= 0.0 && b.friction.abs() <= side.0.friction(course) * b.press + CREST_CONE_ROUNDING * held.norm()
    };
    if let Some(one) = sides.iter().flatten().find(|s| holds(s)) {
        return Some(Heap { at, edges: [Some(borne(*one)), None] });
    }
    let [Some(a), Some(b)] = sides else { return None };
    let both = cross(a.1.normal, b.1.normal);
    let press = [cross(held, b.1.normal) / both, cross(a.1.normal, held) / both];
    let pressed = |side: (Stretch, Place), press: f64| Some(Borne { press, friction: 0.0, ..borne(side) });
    press.iter().all(|n| *n >= 0.0).then(|| Heap { at, edges: [pressed(a, press[0]), pressed(b, press[1])] })
}

//! Whether the cable has passed through something on its way from one shape to another.
//!
//! The old shape and back along the new one is a closed way; what it goes round was passed through. Corners and posts
//! are looked at: nothing thinner is an obstacle.

use super::seek;
use super::strand::{Course, Strand};
use super::taut::Corner;
use crate::contact::World;
use crate::math::{Vec2, cross};

/// Points of each catenary and contact.
const POINTS: usize = 24;

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

/// A corner that lies between the old shape and the new one, the farthest from the new one.
pub(super) fn through(world: &World, old: &[Vec2], new: &[Vec2]) -> Option<Corner> {
    let (Some(&first), false) = (old.first(), world.is_empty()) else { return None };
    let (mut low, mut high) = (first, first);
    for p in old.iter().chain(new) {
        (low, high) = (low.inf(p), high.sup(p));
    }
    let mut best: Option<(f64, Corner)> = None;
    let mut look = |at: Vec2, body: usize, feature: usize| {
        let inside = at.x > low.x && at.x < high.x && at.y > low.y && at.y < high.y;
        if inside && winding(at, old.iter().chain(new.iter().rev())) != 0 {
            let far = new.iter().map(|p| (p - at).norm()).fold(f64::INFINITY, |a, b| if b < a { b } else { a });
            if best.is_none_or(|b| far > b.0) {
                best = Some((far, Corner { at, body, feature }));
            }
        }
    };
    for (index, body) in world.geometry().bodies().iter().enumerate() {
        if let Some(center) = body.center {
            look(center, index, body.first + 1);
        }
        for k in body.candidates(low, high) {
            for c in body.corners_of(k).filter(|c| body.juts_out(c)) {
                look(c.at, index, c.feature);
            }
        }
    }
    best.map(|b| b.1)
}

/// How often a closed way goes round a point (D. Sunday's crossings: up left of it, down right of it).
fn winding<'a>(at: Vec2, way: impl Iterator<Item = &'a Vec2> + Clone) -> i32 {
    let mut turns = 0;
    let mut last = way.clone().last().copied().unwrap_or(at);
    for &p in way {
        let side = cross(p - last, at - last);
        if last.y <= at.y && p.y > at.y && side > 0.0 {
            turns += 1;
        } else if last.y > at.y && p.y <= at.y && side < 0.0 {
            turns -= 1;
        }
        last = p;
    }
    turns
}

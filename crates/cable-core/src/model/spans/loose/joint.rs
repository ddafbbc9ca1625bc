//! Tensions along stretches, and the spans over concave kinks in which the cable has some.
//!
//! On slopes beyond their cone what lies draws at what lies above it, through every kink on the way. With slopes m₁ and m₂ of the edges on
//! either side, seen along the way, and H the force across the load, a span leaves the one and meets the other along its tangent:
//!
//! ```text
//! bσ = H (m₂ − m₁),   u = τ (Hσ/EA + H (asinh m₂ − asinh m₁)/b),   v = τ ((T₂ − T₁)/b + H² (m₂² − m₁²)/2bEA)
//! x₁ t₁ + x₂ t₂ = (u, v),   T₁(x₁) = H √(1 + m₁²)
//! ```
//!
//! with x₁ and x₂ the lengths of the edges that it does not touch and T₁(x₁) the tension that comes along the first: one equation for H.

use super::{Drape, HALVINGS, Line, Part, STRAIGHT, Stretch};
use crate::math::{Vec2, cross, larger};

/// Doublings of the force across the load in the search for one that is too large.
const MOST_DOUBLED: usize = 60;

/// A span over a kink, seen from where its tension comes.
#[derive(Clone, Copy, Debug)]
struct Over {
    /// Lengths before and after the kink that it does not touch, m.
    aside: [f64; 2],
    /// Tensions where it leaves and where it meets, N.
    tension: [f64; 2],
    material: f64,
}

/// The tensions along stretches as they come from one end.
pub(super) struct Profile {
    /// Stretches as the spans over kinks leave them.
    pub lies: Vec<Stretch>,
    /// Tension where each is entered, N.
    pub enters: Vec<f64>,
    /// The span over the kink behind each, as the cable goes.
    pub spans: Vec<Option<Part>>,
    /// Tension where the last one is left, N.
    pub leaves: f64,
}

impl Drape<'_> {
    /// Tensions along stretches from their start (side 0) or end, as little as friction lets them have, from a tension there (N). None where
    /// a kink cannot be bridged.
    pub(super) fn profile(&self, lies: &[Stretch], side: usize, begins: f64) -> Option<Profile> {
        let n = lies.len();
        let mut out = Profile { lies: lies.to_vec(), enters: vec![0.0; n], spans: vec![None; n], leaves: begins };
        for i in 0..n {
            let k = if side == 0 { i } else { n - 1 - i };
            let (s, enters) = (out.lies[k], out.leaves);
            out.enters[k] = enters;
            let friction = if side == 0 { -s.friction(self.course) } else { s.friction(self.course) };
            let tension = |p: f64| larger(s.slide(self.course, (s.p[side], p), enters, friction).tension, 0.0);
            out.leaves = tension(s.p[1 - side]);
            let first = if side == 0 { k } else { k.wrapping_sub(1) };
            let (Some(a), Some(b)) = (out.lies.get(first).copied(), out.lies.get(first.wrapping_add(1)).copied())
            else {
                continue;
            };
            if !(out.leaves > self.most && self.bends_in(&a, &b)) {
                continue;
            }
            let over =
                if side == 0 { self.over([&a, &b], 1.0, &tension)? } else { self.over([&b, &a], -1.0, &tension)? };
            let [aside, ends] = [over.aside, over.tension].map(|[x, y]| if side == 0 { [x, y] } else { [y, x] });
            out.lies[first].p[1] -= aside[0];
            out.lies[first + 1].p[0] += aside[1];
            let place = out.lies[first].place(self.course, out.lies[first].p[1]);
            let form = Line::Spans { from: place.at, force: place.tangent * ends[0] };
            out.spans[first] = Some(Part { s: [0.0, over.material], tension: ends, form });
            out.leaves = over.tension[1];
        }
        Some(out)
    }

    /// Whether a cable under tension would bridge what is between two stretches.
    pub(super) fn bends_in(&self, a: &Stretch, b: &Stretch) -> bool {
        let [before, after] = [a.place(self.course, a.p[1]), b.place(self.course, b.p[0])];
        cross(before.tangent, after.tangent) * self.course.curves[a.curve].sense > STRAIGHT
    }

    /// The span from one edge to the next, `way` being 1 where that is along the cable and −1 where it is against it; from the tension at each
    /// p of the first. None where it does not leave and meet them.
    fn over(&self, [from, to]: [&Stretch; 2], way: f64, tension: &dyn Fn(f64) -> f64) -> Option<Over> {
        let end = usize::from(way > 0.0);
        let (kink, next) = (from.place(self.course, from.p[end]), to.place(self.course, to.p[1 - end]));
        if kink.turn != 0.0 || next.turn != 0.0 {
            return None;
        }
        let law = &self.course.law;
        let (b, t) = (law.load.norm(), [kink.tangent, next.tangent].map(|t| self.frame.split(t * way)));
        let right = t[0].x.signum();
        let t = t.map(|t| Vec2::new(t.x * right, t.y));
        let det = cross(t[0], t[1]);
        if !(t[0].x > 0.0 && t[1].x > 0.0 && det > 0.0) {
            return None;
        }
        let [m1, m2] = t.map(|t| t.y / t.x);
        let span = |h: f64| {
            let material = h * (m2 - m1) / b;
            let ends = [h * 1.0f64.hypot(m1), h * 1.0f64.hypot(m2)];
            let u = law.thermal * (h * material * law.compliance + h * (m2.asinh() - m1.asinh()) / b);
            let v = law.thermal * ((ends[1] - ends[0]) / b + 0.5 * h * h * (m2 * m2 - m1 * m1) / b * law.compliance);
            let aside = [(u * t[1].y - v * t[1].x) / det, (t[0].x * v - t[0].y * u) / det];
            Over { aside, tension: ends, material }
        };
        let room = |s: &Stretch| s.p[1] - s.p[0];
        // Beyond the edge the tension is what it is at its start.
        let comes = |x: f64| tension(from.p[end] - way * if x < room(from) { x } else { room(from) });
        let lacks = |h: f64| {
            let over = span(h);
            over.tension[0] < comes(over.aside[0])
        };
        let (mut low, mut high) = (0.0, tension(from.p[end]));
        for _ in 0..MOST_DOUBLED {
            if !lacks(high) {
                break;
            }
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if lacks(middle) { low = middle } else { high = middle }
        }
        let found = span(0.5 * (low + high));
        (found.aside[0] < room(from) && found.aside[1] < room(to)).then_some(found)
    }
}

//! A contact remembers its friction as a profile of tension, in closed form.
//!
//! A cable that sticks keeps the tension that it had; one that slides follows the capstan law from
//! one end:
//!
//! ```text
//! T(p) = clamp(T_old(p), max(L₁, L₂), min(U₁, U₂))
//! ```
//!
//! with L and U the least and the greatest tension that sliding allows from the tension at either
//! end (1 at p₁, 2 at p₂). This is the exact minimiser of the energy and the incremental
//! dissipation: T − T_old has the sign that the law asks for wherever it slides. U₁ and L₂ follow
//! m = +μ, L₁ and U₂ m = −μ, so whatever happens T stays a curve made of stretches with one m each:
//! a knot where m changes is all there is to store, and nothing is ever interpolated. From each end
//! T leaves its envelope at most once, at the *front*; between the fronts it sticks, and the
//! material there is where it was. Material newly laid down beyond the old contact has the tension
//! of its end, as even as friction can keep it (m between −μ and μ on each edge).

use crate::math::smaller;
use crate::model::spans::boundary::capstan::{Step, Track};
use crate::model::spans::boundary::segment_cursor::Sliding;
use crate::model::spans::numerics::root::{TENSION_ROUNDING, crossing};

/// Part of the friction coefficient by which it is changed to see what that moves.
const DIFFERENCE_STEP: f64 = 1e-6;

/// A stretch of no more than this (m or rad) is none. Smaller: where friction goes to and fro over
/// the same stretch rounding leaves a knot more each time. Larger: tension is off by as much times
/// the slope of tension.
const SHORTEST_STRETCH: f64 = 1e-12;

/// A point from which the tension follows the law with m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct Knot {
    /// Boundary coordinate.
    pub coordinate: f64,
    /// Material there, m.
    pub arc_length: f64,
    /// Tension there, N.
    pub tension: f64,
    /// Friction coefficient mobilised from here to the next knot, the m of the law.
    pub mobilised: f64,
}

/// Tension and material along a contact as they were last.
#[derive(Debug, Default, PartialEq)]
pub(in crate::model::spans) struct TensionProfile {
    knots: Vec<Knot>,
}

/// Ends of a contact: place, material (m), tension (N).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct Ends {
    pub p: [f64; 2],
    pub s: [f64; 2],
    pub t: [f64; 2],
}

impl Ends {
    /// The end from which a contact that slides with m is drawn: without friction the one with the
    /// greater tension.
    pub fn drawn_side(&self, m: f64) -> usize {
        usize::from(if m == 0.0 { self.t[1] > self.t[0] } else { m > 0.0 })
    }
}

/// Direction along a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum Going {
    /// Towards greater p.
    Right,
    /// Towards smaller p.
    Left,
}

/// Change of a reached tension with m.
#[derive(Clone, Copy, Debug)]
enum Growth {
    Grows,
    Falls,
}

/// Mode of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) enum Mode {
    /// Some of it sticks.
    Hold,
    /// All of it slides with this m (0: smooth).
    Slide(f64),
}

/// The point at which sliding from an end stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct Front {
    pub coordinate: f64,
    /// The way from the end to it.
    pub way: Step,
    pub mobilised: f64,
    /// True if the old tension stopped it; else it came to the other end.
    pub met: bool,
    /// Old material at p, m.
    pub old: f64,
}

/// A contact that holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) enum Held {
    /// It sticks between two fronts (or at one point).
    Between([Front; 2]),
    /// Sliding from both ends meets in one point, which sticks.
    Meet([Front; 2]),
    /// The end tensions are too far apart: it slides with this m. The fronts have passed each
    /// other.
    Beyond(f64, [Front; 2]),
}

impl Clone for TensionProfile {
    fn clone(&self) -> Self {
        Self { knots: self.knots.clone() }
    }

    fn clone_from(&mut self, other: &Self) {
        self.knots.clone_from(&other.knots);
    }
}

impl TensionProfile {
    /// Material laid with one tension law from a point.
    pub fn new(start: Knot, end: Knot) -> Self {
        Self { knots: if end.coordinate > start.coordinate { vec![start, end] } else { vec![start] } }
    }

    /// Through these knots, as near as a part of the cone of friction allows.
    pub fn through(track: &Track<'_>, knots: &[Knot], within: f64) -> Self {
        let track = &Track { friction: track.friction * within, ..*track };
        let mut out = Self { knots: knots.first().copied().into_iter().collect() };
        out.append(track, &Self { knots: knots.get(1..).unwrap_or_default().to_vec() });
        out
    }

    /// The same, from the last knot back.
    pub fn through_back(track: &Track<'_>, knots: &[Knot], within: f64) -> Self {
        let friction = track.friction * within;
        let mut out: Vec<Knot> = Vec::with_capacity(knots.len());
        for knot in knots.iter().rev() {
            let mut knot = *knot;
            if let Some(next) = out.last() {
                if knot.coordinate >= next.coordinate {
                    continue;
                }
                let reach = |m: f64| track.slide(next.coordinate, knot.coordinate, next.tension, m).tension;
                knot.mobilised = Self::between(&mut knot.tension, friction, reach, Growth::Falls);
            }
            out.push(knot);
        }
        out.reverse();
        Self { knots: out }
    }

    /// The m with which sliding reaches a tension, which is brought to what it can reach; that
    /// grows with m, or falls.
    fn between(tension: &mut f64, friction: f64, reach: impl Fn(f64) -> f64, growth: Growth) -> f64 {
        let sign = match growth {
            Growth::Grows => 1.0,
            Growth::Falls => -1.0,
        };
        let (low, high) = (reach(-friction * sign), reach(friction * sign));
        if *tension >= high {
            *tension = high;
            return friction * sign;
        }
        if *tension <= low {
            *tension = low;
            return -friction * sign;
        }
        let by = DIFFERENCE_STEP * friction;
        let goal = *tension;
        sign * crossing(-friction, friction, TENSION_ROUNDING * goal.abs(), None, |m| {
            (goal - reach(m * sign), (reach((m - by) * sign) - reach((m + by) * sign)) / (2.0 * by))
        })
    }

    /// Material laid from `start` to p₁ and to p₂ with an even tension as far as friction holds
    /// that on every slope: what it is does not depend on the end from which the cable is counted.
    pub fn laid(track: &Track<'_>, start: Knot, [first, last]: [f64; 2]) -> Self {
        let way = |to: f64| {
            let mut knots = vec![Knot { mobilised: 0.0, ..start }];
            let (mut p, mut tension, mut s) = (start.coordinate, start.tension, start.arc_length);
            while p != to {
                let next = track.next_border(p, to);
                let (m, way) = (track.even(0.5 * (p + next)), track.lay(p, next, tension));
                // The law of a stretch stands at its left end.
                if let (Some(knot), true) = (knots.last_mut(), next > p) {
                    knot.mobilised = m;
                }
                (p, tension, s) = (next, way.tension, s + way.material);
                knots.push(Knot { coordinate: p, arc_length: s, tension, mobilised: m });
            }
            knots
        };
        let mut out = Self::default();
        way(first).into_iter().skip(1).rev().for_each(|knot| out.push(knot));
        let right = way(last);
        let end = right.len() - 1;
        right
            .into_iter()
            .enumerate()
            .for_each(|(k, knot)| out.push(if k == end { Knot { mobilised: 0.0, ..knot } } else { knot }));
        out
    }

    /// All of its material passed on along the boundary by a length, m.
    pub fn pass_on(&mut self, by_m: f64) {
        self.knots.iter_mut().for_each(|knot| knot.arc_length += by_m);
    }

    /// The same from the middle of its length with a tension there, N, what is missing or too much
    /// of its material at both ends alike; no end has less than that tension: weight that hangs
    /// down on both sides of a crest is held there.
    pub fn laid_from_middle(track: &Track<'_>, e: &Ends, tension: f64) -> Self {
        let middle =
            Knot { coordinate: track.middle(e.p), arc_length: 0.5 * (e.s[0] + e.s[1]), tension, mobilised: 0.0 };
        let mut laid = Self::laid(track, middle, e.p);
        let missing = tension - laid.ends().map_or(tension, |[a, b]| smaller(a.tension, b.tension));
        if missing > 0.0 {
            laid = Self::laid(track, Knot { tension: tension + missing, ..middle }, e.p);
        }
        let off = laid.ends().map_or(0.0, |[a, b]| middle.arc_length - 0.5 * (a.arc_length + b.arc_length));
        laid.knots.iter_mut().for_each(|knot| knot.arc_length += off);
        laid
    }

    /// Counts its material anew from its first knot on, or from its last one back, as its tensions
    /// strain it.
    pub fn measure(&mut self, track: &Track<'_>, going: Going) {
        let way = |a: &Knot, b: &Knot| track.slide(a.coordinate, b.coordinate, a.tension, a.mobilised).material;
        if going == Going::Left {
            for k in (1..self.knots.len()).rev() {
                self.knots[k - 1].arc_length = self.knots[k].arc_length - way(&self.knots[k - 1], &self.knots[k]);
            }
        } else {
            for k in 1..self.knots.len() {
                self.knots[k].arc_length = self.knots[k - 1].arc_length + way(&self.knots[k - 1], &self.knots[k]);
            }
        }
    }

    /// Its first and last knot.
    fn ends(&self) -> Option<[Knot; 2]> {
        Some([*self.knots.first()?, *self.knots.last()?])
    }

    /// The knots.
    pub fn knots(&self) -> &[Knot] {
        &self.knots
    }

    /// Takes over what another contact, joined to this one at its end, remembers. Between the two,
    /// and on as far as it must, tension is brought within the cone by the least change.
    pub fn append(&mut self, track: &Track<'_>, next: &Self) {
        let friction = track.friction;
        for knot in &next.knots {
            let mut knot = *knot;
            let mut tension = knot.tension;
            if let Some(last) = self.knots.last_mut() {
                if knot.coordinate <= last.coordinate {
                    continue;
                }
                let from = *last;
                let reach = |m: f64| track.slide(from.coordinate, knot.coordinate, from.tension, m).tension;
                last.mobilised = Self::between(&mut tension, friction, reach, Growth::Grows);
                knot.tension = tension;
            }
            self.knots.push(knot);
        }
    }

    /// The profile up to p, and from there on.
    pub fn split(&self, track: &Track<'_>, p: f64) -> (Self, Self) {
        let (tension, s) = self.at(track, p);
        let knot = Knot { coordinate: p, arc_length: s, tension, mobilised: self.called(track, p) };
        let before = self.knots.iter().filter(|k| k.coordinate < p).copied().chain([Knot { mobilised: 0.0, ..knot }]);
        let after = [knot].into_iter().chain(self.knots.iter().filter(|k| k.coordinate > p).copied());
        (Self { knots: before.collect() }, Self { knots: after.collect() })
    }

    /// Forgets everything but what is new; keeps the memory of the list.
    fn clear(&mut self) {
        self.knots.clear();
    }

    fn push(&mut self, k: Knot) {
        if let Some(last) = self.knots.last_mut() {
            if k.coordinate - last.coordinate <= SHORTEST_STRETCH {
                // A stretch of no extent.
                last.mobilised = k.mobilised;
                return;
            }
            if self.knots.len() > 1 {
                let n = self.knots.len();
                if self.knots[n - 2].mobilised == self.knots[n - 1].mobilised {
                    self.knots.pop();
                }
            }
        }
        self.knots.push(k);
    }

    /// The knot from which the tension at p follows, seen going on to the right or back to the
    /// left, and whether it lies beyond what was there.
    fn knot(&self, p: f64, going: Going) -> (Knot, bool) {
        let k =
            self.knots.partition_point(|k| if going == Going::Right { k.coordinate <= p } else { k.coordinate < p });
        match k.checked_sub(1).and_then(|j| self.knots.get(j)) {
            None => (
                self.knots.first().copied().unwrap_or(Knot {
                    coordinate: p,
                    arc_length: 0.0,
                    tension: 0.0,
                    mobilised: 0.0,
                }),
                true,
            ),
            Some(knot) => (*knot, k == self.knots.len()),
        }
    }

    /// Old tension and material at p.
    pub fn at(&self, track: &Track<'_>, p: f64) -> (f64, f64) {
        let (knot, beyond) = self.knot(p, Going::Right);
        let way = if beyond {
            track.lay(knot.coordinate, p, knot.tension)
        } else {
            track.slide(knot.coordinate, p, knot.tension, knot.mobilised)
        };
        (way.tension, knot.arc_length + way.material)
    }

    /// The friction coefficient called upon at p.
    pub fn called(&self, track: &Track<'_>, p: f64) -> f64 {
        let (knot, beyond) = self.knot(p, Going::Right);
        if beyond { track.even(p) } else { knot.mobilised }
    }

    /// From p towards `to`: how far the old tension has one law there, and its m.
    fn stretch(&self, track: &Track<'_>, p: f64, to: f64) -> (f64, f64) {
        let right = to > p;
        let (knot, beyond) = self.knot(p, if right { Going::Right } else { Going::Left });
        let k = self.knots.partition_point(|k| if right { k.coordinate <= p } else { k.coordinate < p });
        let border = if right { self.knots.get(k) } else { k.checked_sub(1).and_then(|j| self.knots.get(j)) };
        let mut next = track.next_border(p, to);
        if let Some(b) = border
            && (if right { b.coordinate < next } else { b.coordinate > next })
        {
            next = b.coordinate;
        }
        (next, if beyond { track.even(0.5 * (p + next)) } else { knot.mobilised })
    }

    /// dT/dp of the old tension at p.
    pub fn slope(&self, track: &Track<'_>, p: f64) -> f64 {
        track.law.slope(&track.place(p), self.at(track, p).0, self.called(track, p))
    }

    /// Slides from an end at p with tension `t` towards `to`, as far as the old tension lets it.
    pub fn front(&self, track: &Track<'_>, p: f64, t: f64, to: f64) -> Front {
        let right = to > p;
        let (mut old, mut s) = self.at(track, p);
        let sign = if t < old { 1.0 } else { -1.0 };
        let m = track.friction * sign * if right { 1.0 } else { -1.0 };
        let (mut at, mut way) = (p, Step::none(t));
        if (t - old).abs() <= TENSION_ROUNDING * t.abs() {
            return Front { coordinate: p, way, mobilised: m, met: true, old: s };
        }
        while at != to {
            let (next, old_m) = self.stretch(track, at, to);
            let (met, [there, here]) = track.on(at, next).crossing(
                next,
                [Sliding { tension: old, mobilised: old_m }, Sliding { tension: way.tension, mobilised: m }],
            );
            way = way.then(here);
            if let Some(x) = met {
                return Front { coordinate: x, way, mobilised: m, met: true, old: s + there.material };
            }
            (old, s) = (there.tension, s + there.material);
            at = next;
            if (old - way.tension) * sign <= 0.0 {
                return Front { coordinate: at, way, mobilised: m, met: true, old: s };
            }
        }
        Front { coordinate: to, way, mobilised: m, met: false, old: s }
    }

    /// The stick zone of a contact under its end tensions.
    pub fn hold(&self, track: &Track<'_>, e: &Ends) -> Held {
        let friction = track.friction;
        let [p1, p2] = e.p;
        let [t1, t2] = e.t;
        let left = self.front(track, p1, t1, p2);
        let right = self.front(track, p2, t2, p1);
        if left.met && right.met && left.coordinate <= right.coordinate {
            return Held::Between([left, right]);
        }
        // One has come past the other, or to the far end: either the tensions are too far apart …
        let beyond = |m: f64| Held::Beyond(m, [left, right]);
        if !(p2 > p1) {
            return beyond(if t2 > t1 { friction } else { -friction });
        }
        // (along a slope the load may make the tension behind the greater all the same) …
        if left.mobilised == right.mobilised {
            return beyond(left.mobilised);
        }
        if t2 > track.slide(p1, p2, t1, friction).tension {
            return beyond(friction);
        }
        if t2 < track.slide(p1, p2, t1, -friction).tension {
            return beyond(-friction);
        }
        // … or they slide towards or away from each other.
        let sign = if left.mobilised > 0.0 { 1.0 } else { -1.0 };
        let meet = crossing(p1, p2, TENSION_ROUNDING * (t1.abs() + t2.abs()), None, |x| {
            let (r, l) =
                (track.slide(p2, x, t2, right.mobilised).tension, track.slide(p1, x, t1, left.mobilised).tension);
            let place = track.place(x);
            let slope = track.law.slope(&place, r, right.mobilised) - track.law.slope(&place, l, left.mobilised);
            ((r - l) * sign, slope * sign)
        });
        let old = self.at(track, meet).1;
        let front = |p: f64, t: f64, m: f64| Front {
            coordinate: meet,
            way: track.slide(p, meet, t, m),
            mobilised: m,
            met: true,
            old,
        };
        Held::Meet([front(p1, t1, left.mobilised), front(p2, t2, right.mobilised)])
    }

    /// Takes what came of a step as the new past. `held`: where it sticks, where that is known;
    /// `old`: memory.
    pub fn commit(&mut self, track: &Track<'_>, e: &Ends, mode: Mode, held: Option<Held>, old: &mut Self) {
        let [first, last] =
            [0, 1].map(|k| Knot { coordinate: e.p[k], arc_length: e.s[k], tension: e.t[k], mobilised: 0.0 });
        if last.coordinate <= first.coordinate {
            self.clear();
            self.knots.push(first);
            return;
        }
        match mode {
            Mode::Slide(m) => {
                let drawn = e.drawn_side(m);
                let [from, to] = [[first, last][drawn], [first, last][1 - drawn]];
                let loose = match track.floored {
                    true => track.slide_floored(from.coordinate, to.coordinate, from.tension, m).1,
                    false => None,
                };
                self.clear();
                let Some(loose) = loose else {
                    self.knots.extend([Knot { mobilised: m, ..first }, last]);
                    return;
                };
                // Loose from there to the end that is not drawn, as even as friction keeps it.
                let end = Knot {
                    coordinate: loose.coordinate,
                    arc_length: from.arc_length + loose.material,
                    tension: loose.tension,
                    mobilised: m,
                };
                let [a, b] = if drawn == 1 { [first, end] } else { [end, last] };
                let bed = Track { friction: track.friction_of_loose, ..*track };
                let laid = Self::laid(
                    &bed,
                    Knot { tension: 0.0, ..if drawn == 1 { a } else { b } },
                    [a.coordinate, b.coordinate],
                );
                if drawn == 0 {
                    self.push(Knot { mobilised: m, ..first });
                }
                laid.knots.iter().for_each(|knot| self.push(*knot));
                if drawn == 1 {
                    self.push(end);
                    self.push(last);
                }
            }
            Mode::Hold => match held.unwrap_or_else(|| self.hold(track, e)) {
                Held::Between([left, right]) => {
                    old.clone_from(self);
                    self.clear();
                    if left.coordinate > first.coordinate {
                        self.push(Knot { mobilised: left.mobilised, ..first });
                    }
                    let mut p = left.coordinate;
                    while p < right.coordinate {
                        let (next, m) = old.stretch(track, p, right.coordinate);
                        let (tension, s) = old.at(track, p);
                        self.push(Knot { coordinate: p, arc_length: s, tension, mobilised: m });
                        p = next;
                    }
                    if right.coordinate < last.coordinate {
                        let (tension, s) = old.at(track, right.coordinate);
                        self.push(Knot {
                            coordinate: right.coordinate,
                            arc_length: s,
                            tension,
                            mobilised: right.mobilised,
                        });
                    }
                    self.push(last);
                }
                Held::Meet([left, right]) => {
                    let (tension, s) = (left.way.tension, e.s[0] + left.way.material);
                    self.clear();
                    self.push(Knot { mobilised: left.mobilised, ..first });
                    self.push(Knot { coordinate: left.coordinate, arc_length: s, tension, mobilised: right.mobilised });
                    self.push(last);
                }
                Held::Beyond(m, _) => {
                    self.clear();
                    self.knots.extend([Knot { mobilised: m, ..first }, last]);
                }
            },
        }
    }
}

//! A contact stores its friction memory as a profile of tension, in closed form.
//!
//! Sticking cable keeps its tension; sliding cable follows the capstan law from one end:
//!
//! ```text
//! T(p) = clamp(T_old(p), max(L₁, L₂), min(U₁, U₂))
//! ```
//!
//! with L and U the least and the greatest tension that sliding allows from the tension at either
//! end (1 at p₁, 2 at p₂). This is the exact minimiser of the energy and the incremental
//! dissipation: T − T_old has the sign that the law requires wherever the cable slides. U₁ and L₂
//! follow m = +μ, L₁ and U₂ m = −μ, so T always consists of stretches with one m each: only the
//! breakpoints where m changes are stored, and nothing is interpolated. From each end T leaves its
//! envelope at most once, at the *slip front*; between the fronts the cable sticks, and its
//! material does not move. Material newly laid down beyond the old contact has the tension of its
//! end, as constant as friction allows (m between −μ and μ on each edge).

use crate::math::smaller;
use crate::model::spans::boundary::capstan::{ContactPath, SlideResult, Sliding};
use crate::model::spans::bracketed_root::{TENSION_ROUNDING, crossing};

/// Relative step of the friction coefficient for a difference quotient.
const DIFFERENCE_STEP: f64 = 1e-6;

/// Length (m or rad) up to which a stretch is dropped. Smaller: if a contact slides back and forth
/// over the same stretch, round-off adds a breakpoint each time. Larger: the tension is off by this
/// length times its slope.
const SHORTEST_STRETCH: f64 = 1e-12;

/// A point from which the tension follows the capstan law with one m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct Breakpoint {
    /// Boundary coordinate.
    pub coordinate: f64,
    /// Material there, m.
    pub arc_length: f64,
    /// Tension there, N.
    pub tension: f64,
    /// Friction coefficient mobilised from here to the next breakpoint, the m of the law.
    pub mobilised: f64,
}

impl Breakpoint {
    /// A breakpoint from which no friction is mobilised.
    pub fn frictionless(coordinate: f64, arc_length: f64, tension: f64) -> Self {
        Self { coordinate, arc_length, tension, mobilised: 0.0 }
    }
}

/// Tension and material along a contact after the last step.
#[derive(Debug, Default, PartialEq)]
pub(in crate::model::spans) struct TensionProfile {
    breakpoints: Vec<Breakpoint>,
}

/// Ends of a contact: boundary coordinate, material (m), tension (N).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct Ends {
    pub place: [f64; 2],
    pub material: [f64; 2],
    pub tension: [f64; 2],
}

impl Ends {
    /// The ends at two points.
    pub fn at([a, b]: [Breakpoint; 2]) -> Self {
        Self {
            place: [a.coordinate, b.coordinate],
            material: [a.arc_length, b.arc_length],
            tension: [a.tension, b.tension],
        }
    }

    /// The breakpoint at an end, from which no friction is mobilised.
    pub fn breakpoint(&self, side: usize) -> Breakpoint {
        Breakpoint::frictionless(self.place[side], self.material[side], self.tension[side])
    }

    /// The end towards which a contact that slides with m is drawn; without friction the one with
    /// the greater tension.
    pub fn drawn_side(&self, m: f64) -> usize {
        usize::from(if m == 0.0 { self.tension[1] > self.tension[0] } else { m > 0.0 })
    }
}

/// Direction along a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum SweepDirection {
    /// Towards greater p.
    Right,
    /// Towards smaller p.
    Left,
}

/// Sense in which a reached tension changes with m.
#[derive(Clone, Copy, Debug)]
enum Growth {
    Grows,
    Falls,
}

/// Mode of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) enum Mode {
    /// Some of it sticks.
    Stick,
    /// All of it slides with this m (0: frictionless).
    Slip(f64),
}

/// The point at which sliding from an end stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct SlipFront {
    pub coordinate: f64,
    /// The result of sliding from the end to it.
    pub way: SlideResult,
    pub mobilised: f64,
    /// True if the old tension stopped it; false if it reached the other end.
    pub met: bool,
    /// Old material at p, m.
    pub old: f64,
}

/// The stick zone of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) enum StickZone {
    /// The contact sticks between two fronts (or at one point).
    Between([SlipFront; 2]),
    /// The fronts from both ends meet in one point, which sticks.
    Meet([SlipFront; 2]),
    /// The end tensions differ too much: the whole contact slides with this m. The fronts have
    /// passed each other.
    Beyond(f64, [SlipFront; 2]),
}

impl Clone for TensionProfile {
    fn clone(&self) -> Self {
        Self { breakpoints: self.breakpoints.clone() }
    }

    fn clone_from(&mut self, other: &Self) {
        self.breakpoints.clone_from(&other.breakpoints);
    }
}

impl TensionProfile {
    /// A profile with one tension law between two points.
    pub fn new(start: Breakpoint, end: Breakpoint) -> Self {
        Self { breakpoints: if end.coordinate > start.coordinate { vec![start, end] } else { vec![start] } }
    }

    /// A profile between the ends of a contact, from which no friction is mobilised.
    pub fn of_ends(ends: &Ends) -> Self {
        Self::new(ends.breakpoint(0), ends.breakpoint(1))
    }

    /// A profile through these breakpoints, as near as the fraction `within` of the friction cone
    /// allows.
    pub fn through(contact_path: &ContactPath<'_>, breakpoints: &[Breakpoint], within: f64) -> Self {
        let contact_path = &ContactPath { friction: contact_path.friction * within, ..*contact_path };
        let mut out = Self { breakpoints: breakpoints.first().copied().into_iter().collect() };
        out.append(contact_path, &Self { breakpoints: breakpoints.get(1..).unwrap_or_default().to_vec() });
        out
    }

    /// As [`Self::through`], from the last breakpoint back.
    pub fn through_back(contact_path: &ContactPath<'_>, breakpoints: &[Breakpoint], within: f64) -> Self {
        let friction = contact_path.friction * within;
        let mut out: Vec<Breakpoint> = Vec::with_capacity(breakpoints.len());
        for breakpoint in breakpoints.iter().rev() {
            let mut breakpoint = *breakpoint;
            if let Some(next) = out.last() {
                if breakpoint.coordinate >= next.coordinate {
                    continue;
                }
                let reach =
                    |m: f64| contact_path.slide(next.coordinate, breakpoint.coordinate, next.tension, m).tension;
                breakpoint.mobilised = Self::between(&mut breakpoint.tension, friction, reach, Growth::Falls);
            }
            out.push(breakpoint);
        }
        out.reverse();
        Self { breakpoints: out }
    }

    /// The m with which sliding reaches a tension. The tension is limited to the values that can be
    /// reached; `growth` tells whether these grow or fall with m.
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

    /// A profile of material laid from `start` to p₁ and to p₂ with a tension as constant as
    /// friction allows on every slope. It does not depend on the end from which the cable is
    /// counted.
    pub fn of_laying(contact_path: &ContactPath<'_>, start: Breakpoint, [first, last]: [f64; 2]) -> Self {
        let way = |to: f64| {
            let mut breakpoints = vec![Breakpoint { mobilised: 0.0, ..start }];
            let (mut p, mut tension, mut s) = (start.coordinate, start.tension, start.arc_length);
            while p != to {
                let next = contact_path.next_border(p, to);
                let (m, way) = (contact_path.even(0.5 * (p + next)), contact_path.flattest_slide(p, next, tension));
                // The law of a stretch is stored at its left end.
                if let (Some(breakpoint), true) = (breakpoints.last_mut(), next > p) {
                    breakpoint.mobilised = m;
                }
                (p, tension, s) = (next, way.tension, s + way.material);
                breakpoints.push(Breakpoint { coordinate: p, arc_length: s, tension, mobilised: m });
            }
            breakpoints
        };
        let mut out = Self::default();
        way(first).into_iter().skip(1).rev().for_each(|breakpoint| out.push(breakpoint));
        let right = way(last);
        let end = right.len() - 1;
        right.into_iter().enumerate().for_each(|(k, breakpoint)| {
            out.push(if k == end { Breakpoint { mobilised: 0.0, ..breakpoint } } else { breakpoint })
        });
        out
    }

    /// Shifts all of its material along the boundary by a length, m.
    pub fn shift_material(&mut self, by_m: f64) {
        self.breakpoints.iter_mut().for_each(|breakpoint| breakpoint.arc_length += by_m);
    }

    /// A profile laid from the middle of its length with a tension there, N. Missing or surplus
    /// material is shared by both ends, and no end has less than that tension: weight that hangs
    /// down on both sides of a crest is held there.
    pub fn of_laying_from_middle(contact_path: &ContactPath<'_>, e: &Ends, tension: f64) -> Self {
        let middle = Breakpoint {
            coordinate: contact_path.middle(e.place),
            arc_length: 0.5 * (e.material[0] + e.material[1]),
            tension,
            mobilised: 0.0,
        };
        let mut profile = Self::of_laying(contact_path, middle, e.place);
        let missing = tension - profile.ends().map_or(tension, |[a, b]| smaller(a.tension, b.tension));
        if missing > 0.0 {
            profile = Self::of_laying(contact_path, Breakpoint { tension: tension + missing, ..middle }, e.place);
        }
        let off = profile.ends().map_or(0.0, |[a, b]| middle.arc_length - 0.5 * (a.arc_length + b.arc_length));
        profile.breakpoints.iter_mut().for_each(|breakpoint| breakpoint.arc_length += off);
        profile
    }

    /// Recomputes its material from the strain of its tensions, from its first breakpoint on or
    /// from its last one back.
    pub fn measure(&mut self, contact_path: &ContactPath<'_>, going: SweepDirection) {
        let way = |a: &Breakpoint, b: &Breakpoint| {
            contact_path.slide(a.coordinate, b.coordinate, a.tension, a.mobilised).material
        };
        if going == SweepDirection::Left {
            for k in (1..self.breakpoints.len()).rev() {
                self.breakpoints[k - 1].arc_length =
                    self.breakpoints[k].arc_length - way(&self.breakpoints[k - 1], &self.breakpoints[k]);
            }
        } else {
            for k in 1..self.breakpoints.len() {
                self.breakpoints[k].arc_length =
                    self.breakpoints[k - 1].arc_length + way(&self.breakpoints[k - 1], &self.breakpoints[k]);
            }
        }
    }

    /// Its first and last breakpoint.
    fn ends(&self) -> Option<[Breakpoint; 2]> {
        Some([*self.breakpoints.first()?, *self.breakpoints.last()?])
    }

    /// The breakpoints.
    pub fn breakpoints(&self) -> &[Breakpoint] {
        &self.breakpoints
    }

    /// Appends the memory of another contact that follows this one. Between the two, and beyond as
    /// far as necessary, the tension is brought within the friction cone by the least change.
    pub fn append(&mut self, contact_path: &ContactPath<'_>, next: &Self) {
        let friction = contact_path.friction;
        for breakpoint in &next.breakpoints {
            let mut breakpoint = *breakpoint;
            let mut tension = breakpoint.tension;
            if let Some(last) = self.breakpoints.last_mut() {
                if breakpoint.coordinate <= last.coordinate {
                    continue;
                }
                let from = *last;
                let reach =
                    |m: f64| contact_path.slide(from.coordinate, breakpoint.coordinate, from.tension, m).tension;
                last.mobilised = Self::between(&mut tension, friction, reach, Growth::Grows);
                breakpoint.tension = tension;
            }
            self.breakpoints.push(breakpoint);
        }
    }

    /// The profile up to p, and the profile from p on.
    pub fn split(&self, contact_path: &ContactPath<'_>, p: f64) -> (Self, Self) {
        let (tension, s) = self.at(contact_path, p);
        let breakpoint =
            Breakpoint { coordinate: p, arc_length: s, tension, mobilised: self.required_friction(contact_path, p) };
        let before = self
            .breakpoints
            .iter()
            .filter(|k| k.coordinate < p)
            .copied()
            .chain([Breakpoint { mobilised: 0.0, ..breakpoint }]);
        let after = [breakpoint].into_iter().chain(self.breakpoints.iter().filter(|k| k.coordinate > p).copied());
        (Self { breakpoints: before.collect() }, Self { breakpoints: after.collect() })
    }

    /// Empties the profile, keeping the memory of its list.
    fn clear(&mut self) {
        self.breakpoints.clear();
    }

    /// Appends a breakpoint; stretches without extent and of equal friction are joined.
    fn push(&mut self, k: Breakpoint) {
        if let Some(last) = self.breakpoints.last_mut() {
            if k.coordinate - last.coordinate <= SHORTEST_STRETCH {
                // This stretch has no extent.
                last.mobilised = k.mobilised;
                return;
            }
            if self.breakpoints.len() > 1 {
                let n = self.breakpoints.len();
                if self.breakpoints[n - 2].mobilised == self.breakpoints[n - 1].mobilised {
                    self.breakpoints.pop();
                }
            }
        }
        self.breakpoints.push(k);
    }

    /// The breakpoint from which the tension at p follows in this direction, and true if p lies
    /// beyond the old contact.
    fn breakpoint(&self, p: f64, going: SweepDirection) -> (Breakpoint, bool) {
        let k = self
            .breakpoints
            .partition_point(|k| if going == SweepDirection::Right { k.coordinate <= p } else { k.coordinate < p });
        match k.checked_sub(1).and_then(|j| self.breakpoints.get(j)) {
            None => (
                self.breakpoints.first().copied().unwrap_or(Breakpoint {
                    coordinate: p,
                    arc_length: 0.0,
                    tension: 0.0,
                    mobilised: 0.0,
                }),
                true,
            ),
            Some(breakpoint) => (*breakpoint, k == self.breakpoints.len()),
        }
    }

    /// Old tension and material at p.
    pub fn at(&self, contact_path: &ContactPath<'_>, p: f64) -> (f64, f64) {
        let (breakpoint, beyond) = self.breakpoint(p, SweepDirection::Right);
        let way = if beyond {
            contact_path.flattest_slide(breakpoint.coordinate, p, breakpoint.tension)
        } else {
            contact_path.slide(breakpoint.coordinate, p, breakpoint.tension, breakpoint.mobilised)
        };
        (way.tension, breakpoint.arc_length + way.material)
    }

    /// The friction coefficient mobilised at p.
    pub fn required_friction(&self, contact_path: &ContactPath<'_>, p: f64) -> f64 {
        let (breakpoint, beyond) = self.breakpoint(p, SweepDirection::Right);
        if beyond { contact_path.even(p) } else { breakpoint.mobilised }
    }

    /// The end of the stretch from p towards `to` on which the old tension has one law, and its m.
    fn stretch(&self, contact_path: &ContactPath<'_>, p: f64, to: f64) -> (f64, f64) {
        let right = to > p;
        let (breakpoint, beyond) = self.breakpoint(p, if right { SweepDirection::Right } else { SweepDirection::Left });
        let k = self.breakpoints.partition_point(|k| if right { k.coordinate <= p } else { k.coordinate < p });
        let border =
            if right { self.breakpoints.get(k) } else { k.checked_sub(1).and_then(|j| self.breakpoints.get(j)) };
        let mut next = contact_path.next_border(p, to);
        if let Some(b) = border
            && (if right { b.coordinate < next } else { b.coordinate > next })
        {
            next = b.coordinate;
        }
        (next, if beyond { contact_path.even(0.5 * (p + next)) } else { breakpoint.mobilised })
    }

    /// dT/dp of the old tension at p.
    pub fn slope(&self, contact_path: &ContactPath<'_>, p: f64) -> f64 {
        contact_path.law.slope(
            &contact_path.place(p),
            self.at(contact_path, p).0,
            self.required_friction(contact_path, p),
        )
    }

    /// Slides from an end at p with tension `t` towards `to`, up to the slip front.
    pub fn front(&self, contact_path: &ContactPath<'_>, p: f64, t: f64, to: f64) -> SlipFront {
        let right = to > p;
        let (mut old, mut s) = self.at(contact_path, p);
        let sign = if t < old { 1.0 } else { -1.0 };
        let m = contact_path.friction * sign * if right { 1.0 } else { -1.0 };
        let (mut at, mut way) = (p, SlideResult::none(t));
        if (t - old).abs() <= TENSION_ROUNDING * t.abs() {
            return SlipFront { coordinate: p, way, mobilised: m, met: true, old: s };
        }
        while at != to {
            let (next, old_m) = self.stretch(contact_path, at, to);
            let (met, [there, here]) = contact_path.segment(at, next).crossing(
                next,
                [Sliding { tension: old, mobilised: old_m }, Sliding { tension: way.tension, mobilised: m }],
            );
            way = way.then(here);
            if let Some(x) = met {
                return SlipFront { coordinate: x, way, mobilised: m, met: true, old: s + there.material };
            }
            (old, s) = (there.tension, s + there.material);
            at = next;
            if (old - way.tension) * sign <= 0.0 {
                return SlipFront { coordinate: at, way, mobilised: m, met: true, old: s };
            }
        }
        SlipFront { coordinate: to, way, mobilised: m, met: false, old: s }
    }

    /// The stick zone of a contact under its end tensions.
    pub fn find_stick_zone(&self, contact_path: &ContactPath<'_>, e: &Ends) -> StickZone {
        let friction = contact_path.friction;
        let [p1, p2] = e.place;
        let [t1, t2] = e.tension;
        let left = self.front(contact_path, p1, t1, p2);
        let right = self.front(contact_path, p2, t2, p1);
        if left.met && right.met && left.coordinate <= right.coordinate {
            return StickZone::Between([left, right]);
        }
        // If one front has passed the other, or reached the far end, either the tensions differ too
        // much …
        let beyond = |m: f64| StickZone::Beyond(m, [left, right]);
        if !(p2 > p1) {
            return beyond(if t2 > t1 { friction } else { -friction });
        }
        // (along a slope the load may nevertheless make the tension behind the greater one) …
        if left.mobilised == right.mobilised {
            return beyond(left.mobilised);
        }
        if t2 > contact_path.slide(p1, p2, t1, friction).tension {
            return beyond(friction);
        }
        if t2 < contact_path.slide(p1, p2, t1, -friction).tension {
            return beyond(-friction);
        }
        // … or they slide towards or away from each other.
        let sign = if left.mobilised > 0.0 { 1.0 } else { -1.0 };
        let meet = crossing(p1, p2, TENSION_ROUNDING * (t1.abs() + t2.abs()), None, |x| {
            let (r, l) = (
                contact_path.slide(p2, x, t2, right.mobilised).tension,
                contact_path.slide(p1, x, t1, left.mobilised).tension,
            );
            let place = contact_path.place(x);
            let slope =
                contact_path.law.slope(&place, r, right.mobilised) - contact_path.law.slope(&place, l, left.mobilised);
            ((r - l) * sign, slope * sign)
        });
        let old = self.at(contact_path, meet).1;
        let front = |p: f64, t: f64, m: f64| SlipFront {
            coordinate: meet,
            way: contact_path.slide(p, meet, t, m),
            mobilised: m,
            met: true,
            old,
        };
        StickZone::Meet([front(p1, t1, left.mobilised), front(p2, t2, right.mobilised)])
    }

    /// Stores the outcome of a step. `held` is the stick zone if it is known; `old` is working
    /// memory for the previous profile.
    pub fn commit(
        &mut self,
        contact_path: &ContactPath<'_>,
        e: &Ends,
        mode: Mode,
        stick_zone: Option<StickZone>,
        old: &mut Self,
    ) {
        let [first, last] = [0, 1].map(|k| Breakpoint {
            coordinate: e.place[k],
            arc_length: e.material[k],
            tension: e.tension[k],
            mobilised: 0.0,
        });
        if last.coordinate <= first.coordinate {
            self.clear();
            self.breakpoints.push(first);
            return;
        }
        match mode {
            Mode::Slip(m) => self.commit_slip(contact_path, e, [first, last], m),
            Mode::Stick => match stick_zone.unwrap_or_else(|| self.find_stick_zone(contact_path, e)) {
                StickZone::Between(fronts) => {
                    old.clone_from(self);
                    self.commit_stick(contact_path, [first, last], fronts, old);
                }
                StickZone::Meet([left, right]) => {
                    let (tension, s) = (left.way.tension, e.material[0] + left.way.material);
                    self.clear();
                    self.push(Breakpoint { mobilised: left.mobilised, ..first });
                    self.push(Breakpoint {
                        coordinate: left.coordinate,
                        arc_length: s,
                        tension,
                        mobilised: right.mobilised,
                    });
                    self.push(last);
                }
                StickZone::Beyond(m, _) => {
                    self.clear();
                    self.breakpoints.extend([Breakpoint { mobilised: m, ..first }, last]);
                }
            },
        }
    }

    /// Stores a contact that slid from end to end with friction `m`. If its tension vanishes before
    /// the end that is not drawn, the rest lies loose.
    fn commit_slip(&mut self, contact_path: &ContactPath<'_>, e: &Ends, [first, last]: [Breakpoint; 2], m: f64) {
        let drawn = e.drawn_side(m);
        let [from, to] = [[first, last][drawn], [first, last][1 - drawn]];
        let loose = match contact_path.floored {
            true => contact_path.slide_floored(from.coordinate, to.coordinate, from.tension, m).1,
            false => None,
        };
        self.clear();
        let Some(loose) = loose else {
            self.breakpoints.extend([Breakpoint { mobilised: m, ..first }, last]);
            return;
        };
        // From there to the other end the cable lies loose, with a tension as constant as friction
        // allows.
        let end = Breakpoint {
            coordinate: loose.coordinate,
            arc_length: from.arc_length + loose.material,
            tension: loose.tension,
            mobilised: m,
        };
        let [a, b] = if drawn == 1 { [first, end] } else { [end, last] };
        let bed = ContactPath { friction: contact_path.friction_of_loose, ..*contact_path };
        let begin = Breakpoint { tension: 0.0, ..if drawn == 1 { a } else { b } };
        let profile = Self::of_laying(&bed, begin, [a.coordinate, b.coordinate]);
        if drawn == 0 {
            self.push(Breakpoint { mobilised: m, ..first });
        }
        profile.breakpoints.iter().for_each(|breakpoint| self.push(*breakpoint));
        if drawn == 1 {
            self.push(end);
            self.push(last);
        }
    }

    /// Stores a contact that slid from its ends up to two slip fronts and stuck between them:
    /// between the fronts it keeps its `old` memory.
    fn commit_stick(
        &mut self,
        contact_path: &ContactPath<'_>,
        [first, last]: [Breakpoint; 2],
        [left, right]: [SlipFront; 2],
        old: &Self,
    ) {
        self.clear();
        if left.coordinate > first.coordinate {
            self.push(Breakpoint { mobilised: left.mobilised, ..first });
        }
        let mut p = left.coordinate;
        while p < right.coordinate {
            let (next, m) = old.stretch(contact_path, p, right.coordinate);
            let (tension, s) = old.at(contact_path, p);
            self.push(Breakpoint { coordinate: p, arc_length: s, tension, mobilised: m });
            p = next;
        }
        if right.coordinate < last.coordinate {
            let (tension, s) = old.at(contact_path, right.coordinate);
            self.push(Breakpoint { coordinate: right.coordinate, arc_length: s, tension, mobilised: right.mobilised });
        }
        self.push(last);
    }
}

//! A cable round a post may hang free below it, where its tension is too small to bear it there.
//!
//! On an arc the pressure P = T − (c/λ) b·n obeys P' = mP − 2(c/λ) b·t, so that P e^{−mψ} falls up
//! to the *bottom* of the arc, where b·t = 0 with the load away from the centre, and grows behind
//! it: if P is not below nothing at a bottom it is so nowhere near it. What pulls is a stretch
//! about a bottom; the contact is parted there and a span hangs in its place. Two contacts of one
//! post with a bottom between them are two until they meet.

use crate::model::spans::boundary::capstan::Track;
use crate::model::spans::boundary::friction_memory::{Ends, Mode, TensionProfile};
use crate::model::spans::cable_section::{CableSection, Contact, Course, Next};
use crate::model::spans::numerics::root::{TENSION_ROUNDING, crossing};

/// Pull on a post that is none, of the tensions at the ends of the contact: rounding. Larger than
/// what the check lets pass: contacts that it refuses are not parted.
const PULL_ROUNDING: f64 = 1e-9;

/// True if a bottom of a round boundary lies between two places on it.
pub(in crate::model::spans) fn hangs_between(track: &Track<'_>, from: f64, to: f64) -> bool {
    let mut found = false;
    track.bottoms(from, to, |_| found = true);
    found
}

/// A place on a round boundary counted on the turn on which it is nearest to another.
pub(in crate::model::spans) fn nearest_turn(p: f64, to: f64) -> f64 {
    p + std::f64::consts::TAU * ((to - p) / std::f64::consts::TAU).round()
}

/// L: parts the contact that pulls most about the place where it does; whether there was one.
pub(in crate::model::spans) fn part(section: &mut CableSection, course: &Course) -> bool {
    let mut worst: Option<(f64, usize, f64, TensionProfile)> = None;
    for (j, c) in section.contacts.iter().enumerate() {
        let track = course.track(c);
        let [first, last] = c.ends.p;
        if c.is_load() || c.wheel.is_some() || !track.curve.is_round() || !hangs_between(&track, first, last) {
            continue;
        }
        let past = after(&track, c);
        let most = -PULL_ROUNDING * (c.ends.t[0].abs() + c.ends.t[1].abs());
        track.bottoms(first, last, |p| {
            let pressed = press(&track, &past, p).0;
            if pressed < most && worst.as_ref().is_none_or(|w| pressed < w.0) {
                worst = Some((pressed, j, p, past.clone()));
            }
        });
    }
    let Some((_, j, bottom, past)) = worst else { return false };
    let c = &section.contacts[j];
    let track = course.track(c);
    let floor = TENSION_ROUNDING * (c.ends.t[0].abs() + c.ends.t[1].abs());
    // Within half a turn P has one zero on either side.
    let edges = [0, 1].map(|side| {
        let half = if side == 0 { -std::f64::consts::PI } else { std::f64::consts::PI };
        let far = bottom + half;
        let far = if (c.ends.p[side] - far) * half < 0.0 { c.ends.p[side] } else { far };
        if press(&track, &past, far).0 > 0.0 {
            crossing(far, bottom, floor, None, |p| press(&track, &past, p))
        } else {
            far
        }
    });
    let [(t0, s0), (t1, s1)] = edges.map(|p| past.at(&track, p));
    let [before, behind] = [edges[0] > c.ends.p[0], edges[1] < c.ends.p[1]];
    let mode = if course.friction(c) > 0.0 { Mode::Hold } else { c.mode };
    let (e, history) = (c.ends, c.history.clone());
    let c = &mut section.contacts[j];
    (c.mode, c.held) = (mode, None);
    match (before, behind) {
        (true, true) => {
            let mut other = c.clone();
            c.ends = Ends { p: [e.p[0], edges[0]], s: [e.s[0], s0], t: [e.t[0], t0] };
            other.ends = Ends { p: [edges[1], e.p[1]], s: [s1, e.s[1]], t: [t1, e.t[1]] };
            c.history = history.split(&course.track(c), edges[0]).0;
            other.history = history.split(&course.track(&other), edges[1]).1;
            c.next = Next::Span;
            section.contacts.insert(j + 1, other);
            let g = section.forces[j + 1];
            section.forces.insert(j + 1, g);
            section.resolve_span(course, j + 1);
        }
        (true, false) => {
            c.ends = Ends { p: [e.p[0], edges[0]], s: [e.s[0], s0], t: [e.t[0], t0] };
            section.resolve_span(course, j + 1);
        }
        (false, true) => {
            c.ends = Ends { p: [edges[1], e.p[1]], s: [s1, e.s[1]], t: [t1, e.t[1]] };
            section.resolve_span(course, j);
        }
        (false, false) => return false,
    }
    true
}

/// The profile that the contact remembers after the present state.
fn after(track: &Track<'_>, c: &Contact) -> TensionProfile {
    let mut past = c.history.clone();
    past.commit(track, &c.ends, c.mode, c.held, &mut TensionProfile::default());
    past
}

/// P and dP/dp.
fn press(track: &Track<'_>, past: &TensionProfile, p: f64) -> (f64, f64) {
    let place = track.place(p);
    let tension = past.at(track, p).0;
    let pressed = track.law.press(&place, tension);
    let along = place.stretch / track.law.stretch(tension) * track.law.load.dot(&place.tangent);
    (pressed, past.called(track, p) * pressed - 2.0 * along)
}

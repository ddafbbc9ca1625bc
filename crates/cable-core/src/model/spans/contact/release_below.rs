//! This module parts a contact below a post, where the tension is too small to carry the cable and
//! it hangs free.
//!
//! On an arc the pressure P = T − (c/λ) b·n obeys P' = mP − 2(c/λ) b·t, so P e^{−mψ} falls up to
//! the *bottom* of the arc, where b·t = 0 with the load away from the centre, and grows behind it:
//! if P is not negative at a bottom, it is not negative near it. A pulling stretch lies about a
//! bottom; the contact is parted there and replaced by a span. Two contacts of one post with a
//! bottom between them remain separate until they meet.

use crate::model::spans::boundary::{ContactPath, Ends, Mode, TensionProfile};
use crate::model::spans::bracketed_root::{TENSION_ROUNDING, crossing};
use crate::model::spans::section::{CableSection, Connection, Contact, SolveContext};

/// Pull on a post that counts as round-off, as a fraction of the tensions at the ends of the
/// contact. If it were larger than the tolerance of the acceptance check, contacts that the check
/// refuses would not be parted.
const PULL_ROUNDING: f64 = 1e-9;

/// True if a bottom of a round boundary lies between two places on it.
pub(in crate::model::spans) fn hangs_between(contact_path: &ContactPath<'_>, from: f64, to: f64) -> bool {
    let mut found = false;
    contact_path.bottoms(from, to, |_| found = true);
    found
}

/// A place on a round boundary, counted on the turn on which it is nearest to another place.
pub(in crate::model::spans) fn nearest_turn(p: f64, to: f64) -> f64 {
    p + std::f64::consts::TAU * ((to - p) / std::f64::consts::TAU).round()
}

/// Parts the contact with the greatest pull about the place where it pulls; returns whether there
/// was one.
pub(in crate::model::spans) fn part(section: &mut CableSection, context: &SolveContext) -> bool {
    let mut worst: Option<(f64, usize, f64, TensionProfile)> = None;
    for (j, c) in section.contacts.iter().enumerate() {
        let contact_path = context.contact_path(c);
        let [first, last] = c.ends.place;
        if c.is_load()
            || c.wheel.is_some()
            || !contact_path.curve.is_round()
            || !hangs_between(&contact_path, first, last)
        {
            continue;
        }
        let past = after(&contact_path, c);
        let most = -PULL_ROUNDING * (c.ends.tension[0].abs() + c.ends.tension[1].abs());
        contact_path.bottoms(first, last, |p| {
            let pressed = press(&contact_path, &past, p).0;
            if pressed < most && worst.as_ref().is_none_or(|w| pressed < w.0) {
                worst = Some((pressed, j, p, past.clone()));
            }
        });
    }
    let Some((_, j, bottom, past)) = worst else { return false };
    let c = &section.contacts[j];
    let contact_path = context.contact_path(c);
    let floor = TENSION_ROUNDING * (c.ends.tension[0].abs() + c.ends.tension[1].abs());
    // Within half a turn P has one zero on either side.
    let edges = [0, 1].map(|side| {
        let half = if side == 0 { -std::f64::consts::PI } else { std::f64::consts::PI };
        let far = bottom + half;
        let far = if (c.ends.place[side] - far) * half < 0.0 { c.ends.place[side] } else { far };
        if press(&contact_path, &past, far).0 > 0.0 {
            crossing(far, bottom, floor, None, |p| press(&contact_path, &past, p))
        } else {
            far
        }
    });
    let [(t0, s0), (t1, s1)] = edges.map(|p| past.at(&contact_path, p));
    let [before, behind] = [edges[0] > c.ends.place[0], edges[1] < c.ends.place[1]];
    let mode = if context.friction(c) > 0.0 { Mode::Stick } else { c.mode };
    let (e, history) = (c.ends, c.history.clone());
    let c = &mut section.contacts[j];
    (c.mode, c.held) = (mode, None);
    match (before, behind) {
        (true, true) => {
            let mut other = c.clone();
            c.ends = Ends { place: [e.place[0], edges[0]], material: [e.material[0], s0], tension: [e.tension[0], t0] };
            other.ends =
                Ends { place: [edges[1], e.place[1]], material: [s1, e.material[1]], tension: [t1, e.tension[1]] };
            c.history = history.split(&context.contact_path(c), edges[0]).0;
            other.history = history.split(&context.contact_path(&other), edges[1]).1;
            c.next = Connection::Span;
            section.contacts.insert(j + 1, other);
            let g = section.forces[j + 1];
            section.forces.insert(j + 1, g);
            section.resolve_span(context, j + 1);
        }
        (true, false) => {
            c.ends = Ends { place: [e.place[0], edges[0]], material: [e.material[0], s0], tension: [e.tension[0], t0] };
            section.resolve_span(context, j + 1);
        }
        (false, true) => {
            c.ends = Ends { place: [edges[1], e.place[1]], material: [s1, e.material[1]], tension: [t1, e.tension[1]] };
            section.resolve_span(context, j);
        }
        (false, false) => return false,
    }
    true
}

/// The friction memory of the contact after the present state.
fn after(contact_path: &ContactPath<'_>, c: &Contact) -> TensionProfile {
    let mut past = c.history.clone();
    past.commit(contact_path, &c.ends, c.mode, c.held, &mut TensionProfile::default());
    past
}

/// P and dP/dp.
fn press(contact_path: &ContactPath<'_>, past: &TensionProfile, p: f64) -> (f64, f64) {
    let place = contact_path.place(p);
    let tension = past.at(contact_path, p).0;
    let pressed = contact_path.law.press(&place, tension);
    let along = place.stretch / contact_path.law.stretch(tension) * contact_path.law.load.dot(&place.tangent);
    (pressed, past.required_friction(contact_path, p) * pressed - 2.0 * along)
}

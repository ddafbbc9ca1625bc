//! This module parts a contact below a post, where the tension is too small to carry the cable and
//! it hangs free.
//!
//! On an arc the pressure P = T − (c/λ) b·n obeys P' = mP − 2(c/λ) b·t, so P e^{−mψ} falls up to
//! the *bottom* of the arc, where b·t = 0 with the load away from the centre, and grows behind it:
//! if P is not negative at a bottom, it is not negative near it. A pulling stretch lies about a
//! bottom; the contact is parted there and replaced by a span. Two contacts of one post with a
//! bottom between them remain separate until they meet.

use crate::model::spans::boundary::{Breakpoint, ContactPath, Ends, Mode, TensionProfile};
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

/// The place where a post pulls on a contact.
struct Pull {
    /// Index of the contact.
    contact: usize,
    bottom: f64,
    /// Pressure there, N; negative.
    pressure: f64,
    /// The friction memory of the contact after the present state.
    past: TensionProfile,
}

/// The place with the greatest pull.
fn greatest_pull(section: &CableSection, context: &SolveContext) -> Option<Pull> {
    let mut worst: Option<Pull> = None;
    for (contact, c) in section.contacts.iter().enumerate() {
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
        contact_path.bottoms(first, last, |bottom| {
            let pressure = press(&contact_path, &past, bottom).0;
            if pressure < most && worst.as_ref().is_none_or(|w| pressure < w.pressure) {
                worst = Some(Pull { contact, bottom, pressure, past: past.clone() });
            }
        });
    }
    worst
}

impl Pull {
    /// The ends of the stretch that pulls: within half a turn P has one zero on either side.
    fn stretch(&self, contact_path: &ContactPath<'_>, e: &Ends) -> [f64; 2] {
        let floor = TENSION_ROUNDING * (e.tension[0].abs() + e.tension[1].abs());
        [0, 1].map(|side| {
            let half = if side == 0 { -std::f64::consts::PI } else { std::f64::consts::PI };
            let far = self.bottom + half;
            let far = if (e.place[side] - far) * half < 0.0 { e.place[side] } else { far };
            if press(contact_path, &self.past, far).0 > 0.0 {
                crossing(far, self.bottom, floor, None, |p| press(contact_path, &self.past, p))
            } else {
                far
            }
        })
    }
}

/// Parts the contact with the greatest pull about the place where it pulls; returns whether there
/// was one.
pub(in crate::model::spans) fn part(section: &mut CableSection, context: &SolveContext) -> bool {
    let Some(pull) = greatest_pull(section, context) else { return false };
    let j = pull.contact;
    let c = &section.contacts[j];
    let contact_path = context.contact_path(c);
    let edges = pull.stretch(&contact_path, &c.ends);
    let [first, last] = edges.map(|p| {
        let (tension, s) = pull.past.at(&contact_path, p);
        Breakpoint::frictionless(p, s, tension)
    });
    let before = Ends::at([c.ends.breakpoint(0), first]);
    let behind = Ends::at([last, c.ends.breakpoint(1)]);
    let touches = [edges[0] > c.ends.place[0], edges[1] < c.ends.place[1]];
    let mode = if context.friction(c) > 0.0 { Mode::Stick } else { c.mode };
    let history = c.history.clone();
    let c = &mut section.contacts[j];
    (c.mode, c.stick_zone) = (mode, None);
    match touches {
        [true, true] => {
            let mut other = c.clone();
            (c.ends, other.ends) = (before, behind);
            c.history = history.split(&context.contact_path(c), edges[0]).0;
            other.history = history.split(&context.contact_path(&other), edges[1]).1;
            c.next = Connection::Span;
            section.contacts.insert(j + 1, other);
            let g = section.forces[j + 1];
            section.forces.insert(j + 1, g);
            section.resolve_span(context, j + 1);
        }
        [true, false] => {
            c.ends = before;
            section.resolve_span(context, j + 1);
        }
        [false, true] => {
            c.ends = behind;
            section.resolve_span(context, j);
        }
        [false, false] => return false,
    }
    true
}

/// The friction memory of the contact after the present state.
fn after(contact_path: &ContactPath<'_>, c: &Contact) -> TensionProfile {
    let mut past = c.history.clone();
    past.commit(contact_path, &c.ends, c.mode, c.stick_zone, &mut TensionProfile::default());
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

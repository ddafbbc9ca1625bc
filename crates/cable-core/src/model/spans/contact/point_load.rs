//! This module handles a dead load that lies on a boundary, inside the cable or at an end of it.
//!
//! Such a load P is a contact without extent: p₁ = p₂ = q, and its material is fixed (after it the
//! next floating-point number, so that sums up to there include the load, and sums up to the point
//! before it do not). With F₋ and F₊ the force of the cable before and after it, the normal force N
//! n and friction −mN t (see `capstan`), and V = F₊ − F₋ + P:
//!
//! ```text
//! V + N n − m N t = 0:      N = −V·n,      V·(t + m n) = 0  where it slides with m,      |V·t| ≤ μN  where it sticks
//! ```
//!
//! The cable beside it is a span that ends in q at any angle; or it lies on the same chain, F = T
//! t, without a span between the two: they are *joined*, and T is stored in the place of the force
//! of that span. At an end of the cable there is nothing beyond the load, and P draws the end.

use crate::catenary::PointForce;
use crate::error::EquilibriumFault;
use crate::math::{Vec2, larger, smaller};
use crate::model::spans::boundary::{ContactPath, Ends, Mode, TensionProfile};
use crate::model::spans::bracketed_root::{TENSION_ROUNDING, crossing};
use crate::model::spans::contact::kink_load;
use crate::model::spans::contact::load_balance::load_balance;
use crate::model::spans::section::{
    CableSection, Connection, Contact, EndCondition, Failure, RestingLoad, SolveContext,
};

/// Relative round-off of the forces at a load. Smaller: chatter at the edge of the friction cone.
/// Larger: creep.
const CONE_ROUNDING: f64 = 1e-12;
/// Relative difference of the material coordinate that is round-off and not slip.
const MATERIAL_ROUNDING: f64 = 1e-15;
/// Normal component of a dead force that lifts an end off its boundary, or presses it down, as a
/// fraction of the force.
pub(in crate::model::spans) const LIFT_FRACTION: f64 = 1e-9;
/// Relative error of the balance of forces; the solver stops at 1e-11.
const BALANCE_TOLERANCE: f64 = 1e-7;

/// The mode that the load of contact j requires.
pub(in crate::model::spans) fn next_mode(
    section: &CableSection,
    context: &SolveContext,
    j: usize,
    patience: f64,
) -> Mode {
    let c = &section.contacts[j];
    let friction = context.friction(c);
    if c.kink().is_some() {
        return Mode::Stick;
    }
    if friction <= 0.0 {
        return Mode::Slip(0.0);
    }
    let load_balance = load_balance(section, context, j);
    match c.mode {
        Mode::Stick => {
            let (along, press) = (load_balance.sum.dot(&load_balance.tangent), larger(load_balance.press(), 0.0));
            let beyond = along.abs() > friction * press + CONE_ROUNDING * patience * load_balance.size;
            if beyond { Mode::Slip(friction * along.signum()) } else { Mode::Stick }
        }
        Mode::Slip(m) => {
            let moved = c.ends.place[0] - place_before(c);
            let back = m * moved < 0.0 && moved.abs() > MATERIAL_ROUNDING * patience * c.ends.place[0].abs();
            if m == 0.0 || back { Mode::Stick } else { c.mode }
        }
    }
}

/// The missing friction of contacts that came down in this step, as a fraction of the force there:
/// loads have had none, and cable has friction as if it had come down where it was found.
pub(in crate::model::spans) fn unremembered_friction(section: &CableSection, context: &SolveContext) -> f64 {
    let missing = |j: usize| {
        let c = &section.contacts[j];
        if c.is_load() && c.smooth {
            let f = load_balance(section, context, j);
            return context.curves[c.curve].friction * larger(f.press(), 0.0) / larger(f.size, f64::MIN_POSITIVE);
        }
        let [t1, t2] = c.ends.tension;
        let new = !c.is_load()
            && c.wheel.is_none()
            && c.history.breakpoints().len() == 1
            && c.ends.place[1] > c.ends.place[0];
        if new { (t2 - t1).abs() / larger(larger(t1, t2), f64::MIN_POSITIVE) } else { 0.0 }
    };
    (0..section.contacts.len()).map(missing).fold(0.0, larger)
}

/// The place p of a load in the previous state.
pub(in crate::model::spans) fn place_before(c: &Contact) -> f64 {
    c.history.breakpoints().first().map_or(c.ends.place[0], |k| k.coordinate)
}

/// Checks the load of contact j against its laws.
pub(in crate::model::spans) fn verify(section: &CableSection, context: &SolveContext, j: usize) -> Result<(), Failure> {
    let c = &section.contacts[j];
    let f = load_balance(section, context, j);
    let unsound = |what: EquilibriumFault| Failure::Unsound {
        what,
        s: c.ends.material[0],
        at: context.contact_path(c).place(c.ends.place[0]).at,
    };
    let room = BALANCE_TOLERANCE * f.size;
    if !(kink_load::press(context, c, &f) >= -room) {
        return Err(unsound(EquilibriumFault::LoadHeldDown));
    }
    if let Some(kink) = c.kink() {
        if !kink_load::holds(context, c, kink, &f, BALANCE_TOLERANCE) {
            return Err(unsound(EquilibriumFault::LoadOutOfKink));
        }
    } else if !(f.sum.dot(&f.tangent).abs() <= context.friction(c) * f.press() + room) {
        return Err(unsound(EquilibriumFault::LoadSlides));
    }
    for side in (0..2).filter(|&side| section.is_joined(j, side)) {
        let beside = section.contacts[j + 2 * side - 1].ends;
        if !((beside.place[1 - side] - c.ends.place[side]).abs() <= BALANCE_TOLERANCE * (section.to - section.from)) {
            return Err(unsound(EquilibriumFault::LoadElsewhere));
        }
    }
    Ok(())
}

/// Releases loads that lift off, sets down loads within a contact, gives friction to ends that are
/// pressed down, and joins contacts on the chain of a load to it; returns whether anything changed.
pub(in crate::model::spans) fn settle(section: &mut CableSection, context: &SolveContext) -> Result<bool, Failure> {
    for j in 0..section.contacts.len() {
        if section.contacts[j].is_load() {
            let f = load_balance(section, context, j);
            if kink_load::press(context, &section.contacts[j], &f) < -CONE_ROUNDING * f.size {
                lift(section, context, j);
                return Ok(true);
            }
            if kink_load::leave_kink(section, context, j)? {
                return Ok(true);
            }
        } else if set_down(section, context, j) || press_end(section, context, j) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Releases the load of contact j.
fn lift(section: &mut CableSection, context: &SolveContext, j: usize) {
    for side in 0..2 {
        if section.is_joined(j, side) {
            kink_load::shorten_for_span(section, j + 2 * side - 1, 1 - side);
        }
    }
    let last = section.contacts.len() - 1;
    let before = j.checked_sub(1).is_some_and(|i| section.contacts[i].next.part());
    let after = section.contacts[j].next == Connection::Joined;
    for (side, end) in [(0, 0), (1, last)] {
        if let (true, EndCondition::Loose(force)) = (j == end, section.end_conditions[side]) {
            let stays = if side == 0 { after } else { before };
            section.contacts.remove(j);
            section.forces.remove(j + usize::from((side == 1) != stays));
            if !stays {
                section.end_conditions[side] = EndCondition::Hangs(force);
            }
            section.resolve_span(context, if side == 0 { 0 } else { section.contacts.len() });
            return;
        }
    }
    section.contacts.remove(j);
    section.forces.remove(j + usize::from(!before));
    section.resolve_span(context, j);
}

/// Joins loads to the contacts beside them on their chains.
pub(in crate::model::spans) fn join(section: &mut CableSection, context: &SolveContext) -> Result<(), Failure> {
    let mut j = 0;
    while j < section.contacts.len() {
        while section.contacts[j].is_load() && join_one(section, context, j)? {}
        j += 1;
    }
    Ok(())
}

/// Joins one more contact beside the load of contact j; returns whether there was one.
fn join_one(section: &mut CableSection, context: &SolveContext, j: usize) -> Result<bool, Failure> {
    let load = section.contacts[j].clone();
    for side in 0..2 {
        let Some(i) = (j + 2 * side).checked_sub(1).filter(|&i| i < section.contacts.len()) else { continue };
        let c = &section.contacts[i];
        let same = c.curve == load.curve && c.chain_range == load.chain_range && c.wheel.is_none();
        let here = same || kink_load::follows(context, &load, c, side);
        if !here || section.is_joined(j, side) || section.in_pocket(j, side) {
            continue;
        }
        let (k, first) = (j + side, if side == 0 { i } else { j });
        if c.is_load() {
            // Cable between two loads on one chain lies on it, too.
            let [a, b] = [first, first + 1].map(|k| section.contacts[k].ends);
            if !same || !(b.place[0] > a.place[0]) {
                return Err(Failure::LoadInContact { s: load.ends.material[side] });
            }
            let tension = section.force(context, k, a.material[1]).norm();
            let ends = Ends {
                place: [a.place[0], b.place[0]],
                material: [a.material[1], b.material[0]],
                tension: [tension; 2],
            };
            let history = TensionProfile::of_ends(&ends);
            let mode = Mode::Slip(0.0);
            let between = Contact { ends, history, mode, load: None, smooth: true, next: Connection::Joined, ..load };
            section.contacts[first].next = Connection::Joined;
            section.contacts.insert(first + 1, between);
            section.forces[k] = Vec2::new(tension, 0.0);
            section.forces.insert(k, Vec2::new(tension, 0.0));
            return Ok(true);
        }
        let tension = c.ends.tension[1 - side];
        let e = &mut section.contacts[i].ends;
        (e.place[1 - side], e.material[1 - side]) = (load.ends.place[0], load.ends.material[side]);
        section.forces[k] = Vec2::new(tension, 0.0);
        section.contacts[first].next = Connection::Joined;
        return Ok(true);
    }
    Ok(false)
}

/// A load that an end of a contact has come to.
struct LoadAtEnd {
    /// Material between the load and the end, m.
    distance: f64,
    /// Index of the contact.
    contact: usize,
    /// Its end, 0 or 1.
    side: usize,
    /// Arc length of the load, m.
    arc_length: f64,
}

/// The load nearest to an end of a contact, within the distance at which ends are looked for.
fn nearest_load_at_end(section: &CableSection, context: &SolveContext) -> Option<LoadAtEnd> {
    let reach = context.settings.changes.catch_distance_fraction * (section.to - section.from);
    let mut nearest: Option<LoadAtEnd> = None;
    let is_contact = |s: f64| section.contacts.iter().any(|c| c.is_load() && c.ends.material[0] == s);
    for (j, c) in section.contacts.iter().enumerate() {
        for side in (0..2).filter(|&side| section.has_span(j + side) && !c.is_load() && c.wheel.is_none()) {
            let [from, to] = [section.material(j + side).0, section.material(j + side).1];
            let inside = |l: &&PointForce| l.arc_length > section.from && l.arc_length < section.to;
            let near = |l: &&PointForce| l.force.norm() > 0.0 && inside(l) && !is_contact(l.arc_length);
            for l in context.loads.iter().filter(near) {
                let distance = (l.arc_length - c.ends.material[side]).abs();
                let beside = l.arc_length >= from && l.arc_length <= to;
                let turned = l.arc_length >= c.ends.material[1].min(c.ends.material[0])
                    && l.arc_length <= c.ends.material[0].max(c.ends.material[1]);
                if (beside || turned) && distance <= reach && nearest.as_ref().is_none_or(|n| distance < n.distance) {
                    nearest = Some(LoadAtEnd { distance, contact: j, side, arc_length: l.arc_length });
                }
            }
        }
    }
    nearest
}

/// If Newton's method stalls, an end of a contact may have come to a load: then the contact ends
/// there. Sets down the load that is nearest to an end; returns whether there was one.
pub(in crate::model::spans) fn set_down_at_end(section: &mut CableSection, context: &SolveContext) -> bool {
    let Some(LoadAtEnd { contact: j, side, arc_length: s, .. }) = nearest_load_at_end(section, context) else {
        return false;
    };
    let c = &section.contacts[j];
    let e = c.ends;
    let p =
        walk(&context.contact_path(c), e.place[side], (s - e.material[side]) * context.law.stretch(e.tension[side]));
    let load = resting_load(c, p, [s, s.next_up()], e.tension[side], FrictionPast::None);
    let left = if side == 0 { e.place[1] - p } else { p - e.place[0] };
    if left <= 0.0 {
        // Nothing else of it is left.
        section.contacts[j] = Contact { next: c.next, ..load };
        return true;
    }
    let c = &mut section.contacts[j];
    (c.ends.place[side], c.ends.material[side]) = (p, if side == 0 { s.next_up() } else { s });
    let joint = Vec2::new(e.tension[side], 0.0);
    if side == 0 {
        section.contacts.insert(j, Contact { next: Connection::Joined, ..load });
        section.forces.insert(j + 1, joint);
    } else {
        c.next = Connection::Joined;
        section.contacts.insert(j + 1, load);
        section.forces.insert(j + 1, joint);
    }
    true
}

/// The place at a distance `way` (m, in either direction) along a boundary from p, limited to its
/// chain.
fn walk(contact_path: &ContactPath<'_>, mut p: f64, way: f64) -> f64 {
    let (first, last) = (
        contact_path.curve.origin(contact_path.chain_range.first),
        contact_path.curve.end(contact_path.chain_range.last),
    );
    let end = if way > 0.0 { last } else { first };
    let mut left = way.abs();
    while p != end && left > 0.0 {
        let next = contact_path.next_border(p, end);
        let stretch = contact_path.place(0.5 * (p + next)).stretch;
        if !((next - p).abs() * stretch < left) {
            return p + left / stretch * way.signum();
        }
        left -= (next - p).abs() * stretch;
        p = next;
    }
    p
}

/// Sets a load within contact j down at its place.
fn set_down(section: &mut CableSection, context: &SolveContext, j: usize) -> bool {
    let c = &section.contacts[j];
    // A load at an end of the section belongs to that end.
    let [from, to] = [larger(c.ends.material[0], section.from), smaller(c.ends.material[1], section.to)];
    let Some(s) = context.loads.iter().find(|l| l.arc_length > from && l.arc_length < to && l.force.norm() > 0.0)
    else {
        return false;
    };
    let s = s.arc_length;
    let contact_path = context.contact_path(c);
    let [p0, p1] = c.ends.place;
    let floor = TENSION_ROUNDING * (section.to - section.from);
    let q = crossing(p0, p1, floor, None, |p| {
        let place = contact_path.place(p);
        let (tension, arc_length) = c.history.at(&contact_path, p);
        (s - arc_length, -place.stretch / contact_path.law.stretch(tension))
    });
    let tension = c.history.at(&contact_path, q).0;
    let breakpoints = c.history.breakpoints();
    // Cable that was laid before keeps its friction memory; cable that is only now coming down has
    // none yet.
    let fresh = c.smooth
        || !breakpoints.first().zip(breakpoints.last()).is_some_and(|(a, b)| q >= a.coordinate && q <= b.coordinate);
    let (first, second) = c.history.split(&contact_path, q);
    let after = s.next_up();
    let mut load = resting_load(c, q, [s, after], tension, FrictionPast::of(fresh));
    (load.next, load.smooth) = (Connection::Joined, fresh);
    let mut rest = c.clone();
    (rest.ends.place[0], rest.ends.material[0], rest.ends.tension[0], rest.history) = (q, after, tension, second);
    let c = &mut section.contacts[j];
    (c.ends.place[1], c.ends.material[1], c.ends.tension[1], c.history) = (q, s, tension, first);
    c.next = Connection::Joined;
    section.contacts.insert(j + 1, load);
    section.contacts.insert(j + 2, rest);
    for _ in 0..2 {
        section.forces.insert(j + 1, Vec2::new(tension, 0.0));
    }
    true
}

/// Gives an end on contact j that its load presses down its own friction; returns whether there was
/// one.
fn press_end(section: &mut CableSection, context: &SolveContext, j: usize) -> bool {
    for (side, end) in [(0, 0), (1, section.contacts.len() - 1)] {
        let EndCondition::Loose(force) = section.end_conditions[side] else { continue };
        let c = &section.contacts[j];
        let normal = context.contact_path(c).place(c.ends.place[side]).normal;
        if j != end || context.friction(c) <= 0.0 || force.dot(&normal) >= -LIFT_FRACTION * force.norm() {
            continue;
        }
        let (p, s, tension) = (c.ends.place[side], c.ends.material[side], c.ends.tension[side]);
        let load = resting_load(c, p, [s; 2], tension, FrictionPast::of(c.smooth));
        let k = j + side;
        section.contacts.insert(k, load);
        section.contacts[j].next = Connection::Joined;
        section.forces.insert(j + 1, Vec2::new(tension, 0.0));
        return true;
    }
    false
}

/// The past of a load on a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FrictionPast {
    /// There was no friction yet.
    None,
    /// Friction has held it.
    Held,
}

impl FrictionPast {
    fn of(smooth: bool) -> Self {
        if smooth { Self::None } else { Self::Held }
    }
}

/// A load at the coordinate `p` on the boundary of a contact, with material from `s[0]` to `s[1]`
/// (m) and a tension (N).
fn resting_load(on: &Contact, p: f64, s: [f64; 2], tension: f64, past: FrictionPast) -> Contact {
    let fresh = past == FrictionPast::None;
    let ends = Ends { place: [p; 2], material: s, tension: [tension; 2] };
    Contact {
        ends,
        mode: if fresh { Mode::Slip(0.0) } else { Mode::Stick },
        stick_zone: None,
        history: TensionProfile::of_ends(&ends),
        mode_changes: 0,
        next: Connection::Span,
        load: Some(RestingLoad::default()),
        smooth: fresh,
        ..on.clone()
    }
}

//! This module handles a load in a concave kink of a boundary, which is held by both its edges.
//!
//! A load that slides into a kink stays there as long as the force V on it lies between the
//! friction cones of the two edges. It leaves along its own edge if V·t away from the kink exceeds
//! μN, with N = −V·n of that edge alone, and likewise along the other. The cable beside it may lie
//! on either edge, joined to the load.

use crate::math::{Vec2, larger};
use crate::model::spans::boundary::{Mode, TensionProfile};
use crate::model::spans::contact::load_balance::{LoadBalance, load_balance};
use crate::model::spans::section::{CableSection, Contact, Failure, Kink, RestingLoad, SolveContext};

/// Distance (m or rad) beyond the end of its chain from which a load is in the kink there. Smaller:
/// round-off decides.
const CHAIN_END_ROUNDING: f64 = 1e-12;
/// Relative round-off of the forces.
const CONE_ROUNDING: f64 = 1e-12;
/// First displacement of a contact's end where a load leaves it, as a fraction of the section.
const GIVE_WAY_FRACTION: f64 = 1e-6;

/// The piece beyond the kink at an end of a contact's chain, and p of the kink.
fn beyond(context: &SolveContext, c: &Contact, kink: Kink) -> Option<(i64, f64)> {
    let curve = &context.curves[c.curve];
    let p = if kink == Kink::Back { curve.origin(c.chain_range.first) } else { curve.end(c.chain_range.last) };
    curve.beyond_kink(c.chain_range, kink.side()).map(|i| (i, p))
}

/// Direction and normal of the other edge where it begins.
fn other(context: &SolveContext, c: &Contact, kink: Kink) -> Option<(Vec2, Vec2)> {
    let curve = &context.curves[c.curve];
    let (i, _) = beyond(context, c, kink)?;
    let place = curve.place_on(i, if kink == Kink::Ahead { 0.0 } else { curve.piece(i).extent });
    Some((place.tangent, place.normal))
}

/// The direction in which V pushes the load out of its kink: along its own edge (`false`) or along
/// the other (`true`); None if it stays.
fn leaves(context: &SolveContext, c: &Contact, kink: Kink, f: &LoadBalance, room: f64) -> Option<bool> {
    let out = |along: f64, press: f64| along > context.friction(c) * larger(press, 0.0) + room * f.size;
    if out(-kink.sign() * f.sum.dot(&f.tangent), -f.sum.dot(&f.normal)) {
        return Some(false);
    }
    let (tangent, normal) = other(context, c, kink)?;
    out(kink.sign() * f.sum.dot(&tangent), -f.sum.dot(&normal)).then_some(true)
}

/// Sum of the normal forces of both edges, N.
pub(in crate::model::spans) fn press(context: &SolveContext, c: &Contact, f: &LoadBalance) -> f64 {
    match c.kink().and_then(|kink| other(context, c, kink)) {
        Some((_, normal)) => -f.sum.dot(&(f.normal + normal).normalize()),
        None => f.press(),
    }
}

/// True if the load stays in its kink, to a relative tolerance of its forces.
pub(in crate::model::spans) fn holds(
    context: &SolveContext,
    c: &Contact,
    kink: Kink,
    f: &LoadBalance,
    room: f64,
) -> bool {
    leaves(context, c, kink, f, room).is_none()
}

/// Attaches loads that have come into a kink to it; returns whether there was one.
pub(in crate::model::spans) fn enter(section: &mut CableSection, context: &SolveContext) -> bool {
    for c in section.contacts.iter_mut().filter(|c| c.load.is_some_and(|l| l.kink.is_none())) {
        for kink in [Kink::Back, Kink::Ahead] {
            let Some((_, p)) = beyond(context, c, kink) else { continue };
            if (c.ends.place[0] - p) * kink.sign() > CHAIN_END_ROUNDING {
                c.ends.place = [p; 2];
                c.history = TensionProfile::of_ends(&c.ends);
                c.load = Some(RestingLoad { kink: Some(kink) });
                (c.mode, c.smooth) = (Mode::Stick, false);
                return true;
            }
        }
    }
    false
}

/// Releases the load of contact j from its kink; returns whether it left.
pub(in crate::model::spans) fn leave_kink(
    section: &mut CableSection,
    context: &SolveContext,
    j: usize,
) -> Result<bool, Failure> {
    let f = load_balance(section, context, j);
    let c = &section.contacts[j];
    let Some(kink) = c.kink() else { return Ok(false) };
    let Some(on) = leaves(context, c, kink, &f, CONE_ROUNDING) else { return Ok(false) };
    let (curve, friction) = (&context.curves[c.curve], context.friction(c));
    let mut chain_range = c.chain_range;
    if on {
        let found = beyond(context, c, kink).and_then(|(i, _)| curve.chain(i, context.law.load));
        chain_range = found.ok_or(Failure::LoadInContact { s: c.ends.material[0] })?.1;
    }
    let p = match (kink, on) {
        (Kink::Ahead, true) => curve.origin(chain_range.first),
        (Kink::Back, true) => curve.end(chain_range.last),
        _ => c.ends.place[0],
    };
    let c = &mut section.contacts[j];
    (c.chain_range, c.ends.place) = (chain_range, [p; 2]);
    c.history = TensionProfile::of_ends(&c.ends);
    c.load = Some(RestingLoad::default());
    c.mode = Mode::Slip(friction * if on { kink.sign() } else { -kink.sign() });
    for side in 0..2 {
        part(section, context, j, side);
    }
    Ok(true)
}

/// Inserts a span between the load of contact j and a contact that is joined to it but lies on
/// another chain.
fn part(section: &mut CableSection, context: &SolveContext, j: usize, side: usize) {
    if !section.is_joined(j, side) {
        return;
    }
    let i = j + 2 * side - 1;
    if section.contacts[i].chain_range == section.contacts[j].chain_range {
        return;
    }
    section.contacts[if side == 0 { i } else { j }].next.part();
    shorten_for_span(section, i, 1 - side);
    section.resolve_span(context, j + side);
}

/// Shortens contact i a little at an end, so that a span can begin there.
pub(in crate::model::spans) fn shorten_for_span(section: &mut CableSection, i: usize, end: usize) {
    let gives = GIVE_WAY_FRACTION * (section.to - section.from);
    let e = &mut section.contacts[i].ends;
    let (most, sign) = (0.5 * (e.material[1] - e.material[0]), if end == 0 { 1.0 } else { -1.0 });
    let by = if gives < most { gives } else { most };
    e.material[end] += sign * by;
    e.place[end] += sign * 0.5 * (e.place[1] - e.place[0]) * if most > 0.0 { by / most } else { 0.0 };
}

/// True if contact `c` lies on the chain beyond the kink of a load, on that side.
pub(in crate::model::spans) fn follows(context: &SolveContext, load: &Contact, c: &Contact, side: usize) -> bool {
    load.kink().is_some_and(|kink| {
        kink.side() == side
            && c.curve == load.curve
            && beyond(context, load, kink).is_some_and(|(i, p)| {
                let curve = &context.curves[c.curve];
                let (first, at) = match kink {
                    Kink::Ahead => (c.chain_range.first, curve.origin(c.chain_range.first)),
                    Kink::Back => (c.chain_range.last, curve.end(c.chain_range.last)),
                };
                // For a closed boundary counted from another turn the answer is false.
                first == i && at == p
            })
    })
}

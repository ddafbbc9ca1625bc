//! This module releases contacts that would have to pull, or that have vanished.

use crate::model::spans::boundary::{Breakpoint, Mode, TensionProfile};
use crate::model::spans::section::{CableSection, Connection, Contact, EndCondition, Failure, SolveContext};

/// Negative extent (m or rad) of the interval of a contact from which it is released; smaller ones
/// are round-off of a point contact.
const RELEASE_OVERLAP: f64 = 1e-10;

/// Releases the contact whose interval has the most negative extent, because it would have to pull;
/// returns whether there was one.
pub(super) fn release_turned_contact(section: &mut CableSection, context: &mut SolveContext) -> Result<bool, Failure> {
    let turned = |c: &Contact| c.ends.place[1] - c.ends.place[0];
    let worst = (0..section.contacts.len())
        .filter(|&j| !is_round_wheel(&section.contacts[j], context))
        .min_by(|&a, &b| turned(&section.contacts[a]).total_cmp(&turned(&section.contacts[b])));
    let Some(j) = worst.filter(|&j| turned(&section.contacts[j]) < -RELEASE_OVERLAP) else {
        return Ok(false);
    };
    remove_contact(section, context, j)
}

/// True if a contact is a wheel with a radius, which the cable passes on one side. It may pass an
/// eye on either side.
fn is_round_wheel(c: &Contact, context: &SolveContext) -> bool {
    c.wheel.is_some() && context.contact_path(c).place(c.ends.place[0]).stretch > 0.0
}

/// The wheel whose interval has the most negative extent, if there is one: it would have to pull.
pub(super) fn lifted_wheel(section: &CableSection, context: &SolveContext) -> Option<usize> {
    let wheels = section.contacts.iter().filter(|c| is_round_wheel(c, context));
    let turned = |c: &&Contact| c.ends.place[1] - c.ends.place[0];
    wheels.min_by(|a, b| turned(a).total_cmp(&turned(b))).filter(|c| turned(c) < -RELEASE_OVERLAP)?.wheel
}

/// Releases a contact that has nearly vanished beside a load; a span that was reversed past the
/// load would count its weight. Returns whether there was any.
pub(super) fn release_vanishing_contact(
    section: &mut CableSection,
    context: &mut SolveContext,
) -> Result<bool, Failure> {
    let least = context.settings.changes.least_material_fraction * (section.to - section.from);
    let small = |c: &Contact| !c.is_load() && c.ends.material[1] - c.ends.material[0] < least;
    let beside = |j: usize| section.is_joined(j, 0) || section.is_joined(j, 1);
    let Some(j) = (0..section.contacts.len()).find(|&j| small(&section.contacts[j]) && beside(j)) else {
        return Ok(false);
    };
    remove_contact(section, context, j)
}

/// Removes contact j and merges the spans beside it. A wheel cannot be removed, and an eye is
/// passed on its other side.
fn remove_contact(section: &mut CableSection, context: &mut SolveContext, j: usize) -> Result<bool, Failure> {
    if let Some(support) = section.contacts[j].wheel {
        if is_round_wheel(&section.contacts[j], context) {
            return Err(Failure::OffWheel { support });
        }
        pass_eye_on_other_side(&mut section.contacts[j]);
        return Ok(true);
    }
    let contact = section.contacts.remove(j);
    let m = section.contacts.len();
    if let Some(before) = j.checked_sub(1).and_then(|i| section.contacts.get_mut(i)) {
        before.next.end_pocket();
    }
    // Beside a load there was no span; now it has the span that was on the other side.
    let before = j.checked_sub(1).is_some_and(|i| section.contacts[i].next.part());
    if before || contact.next == Connection::Joined {
        let (k, other) = if contact.next == Connection::Joined { (j + 1, j) } else { (j, j + 1) };
        let ends = (other == 0 && !section.end_conditions[0].has_span())
            || (other > m && !section.end_conditions[1].has_span());
        if ends {
            return Err(Failure::LoadInContact { s: contact.ends.material[0] });
        }
        section.forces.remove(k);
        section.resolve_span(context, j);
        return Ok(true);
    }
    // An end that rested on this contact becomes a fixed or a free end.
    for side in 0..2 {
        let outer = if side == 0 { j == 0 } else { j == m };
        if outer && !section.end_conditions[side].has_span() {
            section.end_conditions[side] = match section.end_conditions[side] {
                EndCondition::Lies(p) => EndCondition::Fixed(context.contact_path(&contact).place(p).at),
                EndCondition::Loose(force) => EndCondition::Hangs(force),
                other => other,
            };
            section.forces.remove(if side == 0 { 0 } else { m + 1 });
            if section.contacts.is_empty() && section.forces.len() > 1 {
                section.forces.truncate(1);
            }
            section.resolve_span(context, if side == 0 { 0 } else { m });
            return Ok(true);
        }
    }
    section.forces.remove(j);
    section.resolve_span(context, j);
    Ok(true)
}

/// Passes an eye on its other side.
fn pass_eye_on_other_side(c: &mut Contact) {
    // Its boundary in the other sense: p → −p.
    c.curve ^= 1;
    c.ends.place = [-c.ends.place[0], -c.ends.place[1]];
    let middle = || 0.5 * (c.ends.material[0] + c.ends.material[1]);
    // Its interval is a point: the friction memory keeps the material at it.
    let arc_length = c.history.breakpoints().first().map_or_else(middle, |k| k.arc_length);
    let [start, end] = [0, 1].map(|side| Breakpoint { arc_length, ..c.ends.breakpoint(side) });
    c.history = TensionProfile::new(start, end);
    if let Mode::Slip(m) = c.mode
        && m != 0.0
    {
        c.mode = Mode::Stick;
    }
}

//! This module handles a support that comes to lie on a boundary, slides along it, or lifts the
//! cable off it.

use crate::math::Vec2;
use crate::model::spans::boundary::SUPPORT_CONTACT_DISTANCE_M;
use crate::model::spans::section::{CableSection, EndCondition, SolveContext};

/// Moves a held end to `at`, m.
pub(in crate::model::spans) fn place(section: &mut CableSection, context: &SolveContext, side: usize, at: Vec2) {
    let outer = if side == 0 { 0 } else { section.contacts.len().wrapping_sub(1) };
    let on = section.contacts.get(outer).filter(|c| c.wheel.is_none() && !c.is_load()).and_then(|c| {
        let curve = context.contact_path(c).curve;
        curve.on_chain(c.chain_range, at, SUPPORT_CONTACT_DISTANCE_M)
    });
    match (section.end_conditions[side], on) {
        (EndCondition::Lies(_), Some(p)) => {
            section.end_conditions[side] = EndCondition::Lies(p);
            let c = &mut section.contacts[outer];
            let gap = p - c.ends.place[side];
            c.ends.place[side] = p;
            if gap != 0.0 {
                // The tension starts from the old one at its place.
                c.ends.tension[side] = c.history.at(&context.contact_path(c), p).0;
            }
        }
        (EndCondition::Lies(_), None) => lift(section, context, side, outer, at),
        (EndCondition::Fixed(_), Some(p)) if beyond(section, outer, side, p) => land_end(section, side, outer, p),
        (EndCondition::Fixed(_), _) => section.end_conditions[side] = EndCondition::Fixed(at),
        _ => {}
    }
}

/// True if p lies outside contact `j` on that side.
fn beyond(section: &CableSection, j: usize, side: usize, p: f64) -> bool {
    let e = &section.contacts[j].ends;
    if side == 0 { p <= e.place[0] } else { p >= e.place[1] }
}

/// Lays an end of the section on the boundary, which removes its span.
fn land_end(section: &mut CableSection, side: usize, j: usize, p: f64) {
    section.end_conditions[side] = EndCondition::Lies(p);
    let s = if side == 0 { section.from } else { section.to };
    let e = &mut section.contacts[j].ends;
    (e.place[side], e.material[side]) = (p, s);
}

/// Lifts an end off the boundary: a span begins where a parabola of the height h and tension T
/// there would, x = √(2Th/w_n).
fn lift(section: &mut CableSection, context: &SolveContext, side: usize, j: usize, at: Vec2) {
    let c = &mut section.contacts[j];
    let contact_path = context.contact_path(c);
    let curve = contact_path.curve;
    let i = curve.locate(c.ends.place[side], c.chain_range);
    let foot = curve.project(i, at);
    let place = contact_path.place(foot);
    let height = (at - place.at).dot(&place.normal).abs();
    let press = -context.law.load.dot(&place.normal) / context.law.stretch(c.ends.tension[side]);
    let reach = if press > 0.0 { (2.0 * c.ends.tension[side].abs() * height / press).sqrt() } else { 0.0 };
    let other = c.ends.place[1 - side];
    let sign = if side == 0 { 1.0 } else { -1.0 };
    let least = (foot - other).abs() * (1.0 - context.settings.changes.lying_fraction);
    let p = foot + sign * if reach < least { reach } else { least };
    let end = if side == 0 { section.from } else { section.to };
    // Some of the material must remain for the span.
    let span = ((at - contact_path.place(p).at).norm()) / context.law.stretch(c.ends.tension[side]);
    let s = end + sign * span;
    let inner = c.ends.material[1 - side];
    let s = if (s - inner) * sign < 0.0 { s } else { 0.5 * (end + inner) };
    let t = c.ends.tension[side];
    (c.ends.place[side], c.ends.material[side]) = (p, s);
    let force = contact_path.place(p).tangent * t;
    let k = if side == 0 { 0 } else { section.forces.len() - 1 };
    section.end_conditions[side] = EndCondition::Fixed(at);
    section.forces[k] = force + context.load_between(section.from, s);
}

//! This module distributes the material of a cable along its taut string.

use crate::math::smaller;
use crate::model::spans::boundary::{ContactPath, Ends, TensionProfile};
use crate::model::spans::section::{CableSection, Contact, EndCondition, SolveContext};

/// Rounds of moving a free end to the end of the material. Each multiplies the error by the strain:
/// six leave 1e-12 of it at a strain of 1 %, which is round-off.
const END_FIT_ROUNDS: usize = 6;

/// Sets the material along the taut string, strained by `stretch`, from the held end; if none is
/// held, from the first contact at its material of the route.
pub(in crate::model::spans) fn measure(
    section: &mut CableSection,
    context: &SolveContext,
    loose: [bool; 2],
    stretch: f64,
) {
    let n = section.contacts.len();
    let point = |section: &CableSection, k: usize, side: usize| section.span_ends(context, k)[side];
    let chord = |section: &CableSection, k: usize| match (point(section, k, 0), point(section, k, 1)) {
        (Some(a), Some(b)) => (b - a).norm() / stretch,
        _ => 0.0,
    };
    let own = |c: &Contact| context.curves[c.curve].length(c.ends.place[0], c.ends.place[1], c.chain_range) / stretch;
    if loose[1] {
        let mut s = if loose[0] { section.contacts.first().map_or(0.0, |c| c.ends.material[0]) } else { section.from };
        for j in 0..n {
            s += if loose[0] && j == 0 { 0.0 } else { chord(section, j) };
            let length = own(&section.contacts[j]);
            let last = j + 1 == n && !section.end_conditions[1].has_span();
            section.contacts[j].ends.material = [s, if last { section.to } else { s + length }];
            s += length;
        }
    } else {
        let mut s = section.to;
        for j in (0..n).rev() {
            s -= chord(section, j + 1);
            let length = own(&section.contacts[j]);
            let first = j == 0 && !section.end_conditions[0].has_span();
            section.contacts[j].ends.material = [if first { section.from } else { s - length }, s];
            s -= length;
        }
    }
}

/// Keeps the material in order, with some of it in each span.
pub(in crate::model::spans) fn spread(section: &mut CableSection, context: &SolveContext) {
    let least = context.settings.changes.least_material_fraction * (section.to - section.from);
    let n = section.contacts.len();
    let mut before = section.from;
    for j in 0..n {
        let is_end = j == 0 && !section.end_conditions[0].has_span();
        let room = section.to - least * (n - j) as f64;
        let e = &mut section.contacts[j].ends;
        if !is_end && e.material[0] < before + least {
            let shift = before + least - e.material[0];
            e.material = [e.material[0] + shift, e.material[1] + shift];
        }
        let last = j + 1 == n && !section.end_conditions[1].has_span();
        if !last && e.material[1] > room {
            let shift = room - e.material[1];
            e.material = [e.material[0] + shift, e.material[1] + shift];
        }
        before = e.material[1];
    }
    let loose = [0, 1].map(|side| matches!(section.end_conditions[side], EndCondition::Loose(_)));
    let tied = [0, 1].map(|side| matches!(section.end_conditions[side], EndCondition::Lies(_)));
    for (j, c) in section.contacts.iter_mut().enumerate() {
        let contact_path = context.contact_path(c);
        let free = [loose[0] && j == 0, loose[1] && j + 1 == n];
        let supported = [tied[0] && j == 0, tied[1] && j + 1 == n];
        for side in 0..2 {
            if let EndCondition::Loose(force) = section.end_conditions[side] {
                c.ends.tension[side] = if free[side] { context.pull(c, side, force) } else { c.ends.tension[side] };
            }
        }
        c.history = profile_of_new_contact(&contact_path, &c.ends, [free, supported]);
        // A free end lies where the material ends.
        for side in (0..2).filter(|&side| free[side]) {
            for _ in 0..END_FIT_ROUNDS {
                // A contact laid from a free end does not fit at its other end.
                let other = if free[1 - side] { side } else { 1 - side };
                let (tension, s) = c.history.at(&contact_path, c.ends.place[other]);
                let off = (s - c.ends.material[other]) * context.law.stretch(tension);
                c.ends.place[side] += if other == side { -off } else { off };
                c.history = profile_of_new_contact(&contact_path, &c.ends, [free, supported]);
            }
        }
    }
}

/// The profile of a newly laid contact: from its free end, where its tension is known, or its held
/// end, where its material is known; else from its middle. With two free ends it has the tension of
/// the one that draws less.
fn profile_of_new_contact(
    contact_path: &ContactPath<'_>,
    e: &Ends,
    [free, supported]: [[bool; 2]; 2],
) -> TensionProfile {
    let start = match (free, supported) {
        ([true, false], _) | ([false, false], [true, false]) => e.breakpoint(0),
        ([false, true], _) | ([false, false], [false, true]) => e.breakpoint(1),
        ([true, true], _) => {
            return TensionProfile::of_laying_from_middle(contact_path, e, smaller(e.tension[0], e.tension[1]));
        }
        ([false, false], _) => {
            return TensionProfile::of_laying_from_middle(contact_path, e, 0.5 * (e.tension[0] + e.tension[1]));
        }
    };
    TensionProfile::of_laying(contact_path, start, e.place)
}

//! This module lays a section along its shortest path.

use crate::model::spans::boundary::TensionProfile;
use crate::model::spans::initial::material_distribution::{measure, spread};
use crate::model::spans::section::{CableSection, Contact, SolveContext};

/// Length of the taut string through its contacts, m.
pub(in crate::model::spans) fn taut_length(section: &CableSection, context: &SolveContext) -> f64 {
    let own = |c: &Contact| context.curves[c.curve].length(c.ends.place[0], c.ends.place[1], c.chain_range);
    let spans: f64 = (0..section.spans())
        .filter_map(|k| match section.span_ends(context, k) {
            [Some(a), Some(b)] => Some((b - a).norm()),
            _ => None,
        })
        .sum();
    spans + section.contacts.iter().map(own).sum::<f64>()
}

/// Spreads the material of a section that is held at both ends evenly along its taut string.
pub(in crate::model::spans) fn tighten(section: &mut CableSection, context: &SolveContext) {
    let stretch = taut_length(section, context) / (section.to - section.from);
    if !(stretch > 0.0) {
        return;
    }
    measure(section, context, [false, true], stretch);
    spread(section, context);
    for k in 0..section.spans() {
        if section.has_span(k)
            && let Some(g) = section.solve_span(context, k)
        {
            section.forces[k] = g;
        }
    }
    section.update_end_tensions(context);
}

/// Lays a section along its taut string, with each contact at the tension of the spans beside it.
pub(in crate::model::spans) fn equalise_tensions(section: &mut CableSection, context: &SolveContext) {
    tighten(section, context);
    for c in &mut section.contacts {
        let even = 0.5 * (c.ends.tension[0] + c.ends.tension[1]);
        c.history = TensionProfile::of_laying_from_middle(&context.contact_path(c), &c.ends, even);
    }
}

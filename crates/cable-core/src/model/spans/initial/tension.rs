//! This module lays a run along its shortest path.

use crate::model::spans::boundary::friction_memory::TensionProfile;
use crate::model::spans::initial::material::{measure, spread};
use crate::model::spans::run::{CableRun, Contact, Course};

/// Length of the taut string through what it touches, m.
pub(in crate::model::spans) fn taut_length(strand: &CableRun, course: &Course) -> f64 {
    let own = |c: &Contact| course.curves[c.curve].length(c.ends.p[0], c.ends.p[1], c.chain_range);
    let spans: f64 = (0..strand.spans())
        .filter_map(|k| match strand.ends_of(course, k) {
            [Some(a), Some(b)] => Some((b - a).norm()),
            _ => None,
        })
        .sum();
    spans + strand.contacts.iter().map(own).sum::<f64>()
}

/// Spreads the material of a strand that is held at both ends evenly along its taut string.
pub(in crate::model::spans) fn tighten(strand: &mut CableRun, course: &Course) {
    let stretch = taut_length(strand, course) / (strand.to - strand.from);
    if !(stretch > 0.0) {
        return;
    }
    measure(strand, course, [false, true], stretch);
    spread(strand, course);
    for k in 0..strand.spans() {
        if strand.has_span(k)
            && let Some(g) = strand.solve_span(course, k)
        {
            strand.forces[k] = g;
        }
    }
    strand.take_tensions(course);
}

/// Along its taut string, what touches with the tension of the spans beside it.
pub(in crate::model::spans) fn relay(strand: &mut CableRun, course: &Course) {
    tighten(strand, course);
    for c in &mut strand.contacts {
        let even = 0.5 * (c.ends.t[0] + c.ends.t[1]);
        c.history = TensionProfile::laid_from_middle(&course.track(c), &c.ends, even);
    }
}

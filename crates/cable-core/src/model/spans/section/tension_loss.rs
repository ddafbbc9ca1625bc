//! This search finds the place where the cable lost its tension, if that is why a step failed.

use crate::error::TensionLoss;
use crate::math::{Vec2, cross};
use crate::model::spans::section::{CableSection, Failure, SolveContext};

/// The kind of loss, its place on the cable (m) and in the plane (m), in the last state that was
/// found.
pub(in crate::model::spans) fn find(
    sections: &[CableSection],
    context: &SolveContext,
    failure: &Failure,
) -> Option<(TensionLoss, f64, Vec2)> {
    if let Failure::Compressed { s, at, .. } = failure {
        return Some((TensionLoss::Lay, *s, *at));
    }
    if !matches!(failure, Failure::Stalled { .. } | Failure::ContactCycling { .. } | Failure::Unsound { .. }) {
        return None;
    }
    let b = context.law.load;
    // A cable without weight hangs in no bight.
    if b.norm() == 0.0 {
        return None;
    }
    for section in sections {
        for k in (0..section.spans()).filter(|&k| section.has_span(k)) {
            let (from, to) = section.material(k);
            let force = section.force(context, k, from);
            let across = cross(force, b).abs() / b.norm();
            if across > context.settings.acceptance.fold_force_fraction * b.norm() * (to - from) {
                continue;
            }
            let mut place = None;
            section.shapes(context, k, |s0, at, shape| {
                let s = shape.lowest_s();
                place = place.or(Some((s0 + s, at + shape.position_at(s))));
            });
            let (s, at) = place?;
            let end = k == 0 || k == section.contacts.len();
            return Some((if end { TensionLoss::Fold } else { TensionLoss::Span }, s, at));
        }
    }
    None
}

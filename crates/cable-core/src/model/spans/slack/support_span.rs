//! A bridge is a span from a support to a crest that draws it tight.
//!
//! If a support is close above a crest, the cable that hangs beyond the crest may pull more than
//! friction holds at the foot of the support's plumb leg. The cable has then slid until a free span
//! is tangent to the crest at p, with the tension that friction leaves there. From p, with H the
//! force across the load, V that against it and V₁ = V + bσ,
//!
//! ```text
//! u = Hτ (σ/EA + (asinh V₁/H − asinh V/H)/b),      v = τ ((T₁ − T)/b + (V₁² − V²)/2bEA)
//! ```
//!
//! σ follows from u, and p from v: at the foot the span has no length and ends too low; where the
//! crest falls plumb its end rises without bound.

use crate::math::{Vec2, larger};
use crate::model::spans::boundary::{SlackForm, SlackPart};
use crate::model::spans::slack::slack_parts::{HALVINGS, SlackSolver};
use crate::model::spans::slack::stretch_tensions::StretchTensions;
use crate::numerics::bisect;

/// Relative change of a length at which its iteration ends: some roundings. Smaller: it never ends;
/// larger: the span ends farther from its support.
const LENGTH_TOLERANCE_FRACTION: f64 = 1e-15;

/// Greatest distance from its support at which a span may end, as a fraction of its length and of
/// the size of coordinates: for a nearly plumb span the round-off of the touching point moves its
/// end a thousand times as much. Larger: a jump could pass for a root.
const END_DISTANCE_FRACTION: f64 = 1e-10;
/// Rounds of Newton's method for the length of a span, whose first error is its strain.
const ROUNDS: usize = 8;

/// A span and its touching point.
pub(super) struct SupportSpan {
    /// Number of the stretch, and p on it.
    pub line: usize,
    pub coordinate: f64,
    pub part: SlackPart,
}

/// A span computed from its touching point.
#[derive(Clone, Copy)]
struct Seen {
    length: f64,
    /// Height above the support at which it ends, m.
    over: f64,
    /// Tension at the touching point, N.
    tension: f64,
    /// Direction of the span there.
    towards: Vec2,
    at: Vec2,
}

impl SlackSolver<'_> {
    /// The span to a support at the start (side 0) or the end, from tensions computed from the
    /// other end.
    pub(super) fn bridge(&self, profile: &StretchTensions, support: Vec2, side: usize) -> Option<SupportSpan> {
        let (context, other, stretches, tensions) = (self.context, 1 - side, &profile.stretches, &profile.enters);
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let seen = |k: usize, p: f64| {
            let s = &stretches[k];
            let t = s.slide(context, s.coordinates[other], p, tensions[k], sign * s.friction(context)).tension;
            let place = s.place(context, p);
            self.span_to_plumb_line(place.at, -place.tangent * sign, t, support)
        };
        let order: Vec<usize> =
            if side == 0 { (0..stretches.len()).collect() } else { (0..stretches.len()).rev().collect() };
        for k in order {
            let [low, high] = [stretches[k].coordinates[side], stretches[k].coordinates[other]];
            if seen(k, high).is_some_and(|s| !(s.over > 0.0)) {
                continue;
            }
            let [low, _] = bisect([low, high], HALVINGS, |p| !seen(k, p).is_none_or(|s| s.over > 0.0));
            let found = seen(k, low)
                .filter(|s| s.over.abs() <= END_DISTANCE_FRACTION * (s.length + support.norm()) && s.tension > 0.0)?;
            let weight = context.law.load * found.length;
            // The force there is the pull of the rest of the cable; at the support the load of the
            // span is added.
            let (tension, form) = if side == 0 {
                let force = -found.towards * found.tension + weight;
                ([force.norm(), found.tension], SlackForm::Spans { from: support, force })
            } else {
                let force = found.towards * found.tension;
                ([found.tension, (force - weight).norm()], SlackForm::Spans { from: found.at, force })
            };
            let part = SlackPart { arc_lengths: [0.0, found.length], tension, form };
            return Some(SupportSpan { line: k, coordinate: low, part });
        }
        None
    }

    /// The span that leaves a point in a direction with a tension, up to the plumb line of the
    /// support; None if it never reaches that line.
    fn span_to_plumb_line(&self, at: Vec2, towards: Vec2, tension: f64, support: Vec2) -> Option<Seen> {
        let (law, frame) = (&self.context.law, self.frame);
        let b = law.load.norm();
        let away = frame.split(support - at);
        let goes = frame.split(towards);
        let (h, v) = (tension * goes.x.abs(), tension * goes.y);
        let far = away.x * goes.x.signum();
        let across = |length: f64| {
            let next = v + b * length;
            h * law.thermal * (length * law.compliance + ((next / h).asinh() - (v / h).asinh()) / b)
        };
        if !(h > 0.0) {
            return None;
        }
        // The first length neglects stretch; Newton's method corrects it.
        let mut length =
            if far > 0.0 { h / b * ((v / h).asinh() + far * b / (h * law.thermal)).sinh() - v / b } else { 0.0 };
        for _ in 0..ROUNDS {
            if !(length > 0.0 && length.is_finite()) {
                break;
            }
            let next = v + b * length;
            let by = (across(length) - far) / (h * law.thermal * (law.compliance + 1.0 / h.hypot(next)));
            length = larger(length - by, 0.0);
            if by.abs() <= LENGTH_TOLERANCE_FRACTION * length {
                break;
            }
        }
        if !length.is_finite() {
            return None;
        }
        let next = v + b * length;
        let rises = (h.hypot(next) - h.hypot(v)) / b + 0.5 * (next * next - v * v) / b * law.compliance;
        Some(Seen { length, over: law.thermal * rises - away.y, tension, towards, at })
    }
}

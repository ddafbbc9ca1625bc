//! A snag is an obstacle that holds the cable fast while the pull on it grows.

use super::Observed;
use crate::math::larger;
use crate::solution::{ContactReport, ContactState, Warning, WarningCause};

/// Growth of the ratio of tensions across a contact that is a snag. Smaller: every contact that
/// takes up load is one; larger: it is named when the cable is already near its limit. Half as much
/// again, because a wrap of a quarter turn at μ = 0.3 comes to a ratio of 1.6 from nothing.
const RATIO_GROWTH: f64 = 1.5;

/// Growth of the pull itself that goes with it: a ratio that rises because the slack side empties
/// is no snag.
const PULL_GROWTH: f64 = 1.2;

/// Time it must have held, s. Shorter: a cable that lands is snagged; longer: the warning comes
/// late.
const MIN_STICKING_S: f64 = 0.3;

/// Greatest ratio counted: beyond it the slack side has no tension left to measure.
const MAX_RATIO: f64 = 1e3;

/// Distance (in diameters) by which the middle of a contact that holds may move along the cable and
/// still be the same.
const MATCH_DIAMETERS: f64 = 10.0;

/// The contacts of a cable that hold, and since when.
#[derive(Clone, Debug, Default)]
pub(super) struct SnagDetector {
    sticking: Vec<StickingContact>,
}

#[derive(Clone, Debug)]
struct StickingContact {
    obstacle: String,
    arc_length: f64,
    since_s: f64,
    /// The least ratio since then, and the pull at that time, N.
    ratio: f64,
    pull: f64,
}

impl SnagDetector {
    /// Follows the contacts, and appends those that have become snags.
    pub(crate) fn update(&mut self, observed: &Observed<'_>, time_s: f64, out: &mut Vec<Warning>) {
        let near = MATCH_DIAMETERS * observed.problem.cable.diameter_m;
        let mut next = Vec::with_capacity(self.sticking.len());
        for c in observed.answer.contacts.iter().filter(|c| c.state == ContactState::Stick) {
            let weight = observed.problem.body_force(time_s).norm() * (c.ends_m - c.begins_m);
            let (ratio, pull) = tension_ratio(c, weight);
            let same = |h: &&StickingContact| h.obstacle == c.obstacle && (h.arc_length - c.arc_length_m).abs() <= near;
            let mut contact = self.sticking.iter().find(same).cloned().unwrap_or_else(|| StickingContact {
                obstacle: c.obstacle.clone(),
                arc_length: c.arc_length_m,
                since_s: time_s,
                ratio,
                pull,
            });
            contact.arc_length = c.arc_length_m;
            if ratio < contact.ratio {
                (contact.ratio, contact.pull) = (ratio, pull);
            }
            if ratio > RATIO_GROWTH * contact.ratio
                && pull > PULL_GROWTH * contact.pull
                && time_s - contact.since_s >= MIN_STICKING_S
            {
                out.push(warning(observed, c, ratio, contact.ratio));
            }
            next.push(contact);
        }
        self.sticking = next;
    }
}

/// Ratio of the tensions beside a contact, and the larger, N. The weight (N) of what lies there
/// rubs however hard the cable is pulled: up to that much more on one side is no sign of a snag.
fn tension_ratio(c: &ContactReport, weight: f64) -> (f64, f64) {
    let (a, b) = (c.tension_before_n, c.tension_after_n);
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    let caught = larger(high - weight, low);
    (if low * MAX_RATIO > caught { caught / low } else { MAX_RATIO }, high)
}

fn warning(observed: &Observed<'_>, c: &ContactReport, ratio: f64, first: f64) -> Warning {
    let name = &observed.problem.cable.name;
    let cause = WarningCause::Caught { obstacle: c.obstacle.clone(), first_ratio: first };
    Warning::new(cause, name, c.arc_length_m, [ratio, RATIO_GROWTH * first]).at([c.x_m, c.y_m])
}

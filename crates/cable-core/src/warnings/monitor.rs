//! The warning monitor keeps each warning for a while after its last cause, with the time at which
//! it began, so that none flickers.

use super::energy_growth::EnergyGrowth;
use super::snag::SnagDetector;
use super::{Observed, bend, speed, tangle, tension};
use crate::problem::Problem;
use crate::solution::{Warning, WarningCause, WarningKind};

/// A warning stays for this long (s) after its last cause. Shorter: a cable that swings about its
/// service tension makes the warning flicker, and `events.csv` long; longer: it stands when all is
/// well again. With it no warning comes and goes more than once a second.
pub(super) const HOLD_TIME_S: f64 = 1.0;
/// A tension warning that stands is held by tensions above this part of its limit. Closer to 1:
/// noise of the tension ends and begins it; further: the warning does not believe that the load was
/// lightened. Axial noise of a drag is under 5 %.
const RELEASE_FRACTION: f64 = 0.95;

/// History of all cables of a scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct WarningMonitor {
    active: Vec<ActiveWarning>,
    snags: Vec<SnagDetector>,
    energy_growth: Vec<EnergyGrowth>,
    /// Since when each cable has had a part without tension, s.
    slack_since_s: Vec<Option<f64>>,
    last_s: Option<f64>,
}

/// A warning that stands.
#[derive(Clone, Debug)]
struct ActiveWarning {
    cable: usize,
    /// Its number among those of its kind on its cable.
    number: usize,
    last_seen_s: f64,
    warning: Warning,
}

impl WarningMonitor {
    /// Updates the warnings of an answer at rest: the past does not count.
    pub fn at_rest(&mut self, observed: &[Observed<'_>], time_s: f64) {
        *self = Self::default();
        self.update(observed, time_s, None);
    }

    /// Updates the warnings at an instant of a motion.
    pub fn moving(&mut self, observed: &[Observed<'_>], time_s: f64) {
        if self.last_s.is_some_and(|last| time_s < last) {
            *self = Self::default();
        }
        self.update(observed, time_s, Some(time_s));
    }

    /// The warnings that stand, those of the first cable first.
    pub fn warnings(&self) -> impl Iterator<Item = &Warning> {
        self.active.iter().map(|s| &s.warning)
    }

    /// Finds the warnings of an instant and keeps those of before for their time.
    fn update(&mut self, observed: &[Observed<'_>], time_s: f64, since_s: Option<f64>) {
        self.snags.resize_with(observed.len(), SnagDetector::default);
        self.energy_growth.resize_with(observed.len(), EnergyGrowth::default);
        for (cable, observed) in observed.iter().enumerate() {
            let mut found = instantaneous(observed);
            if let Some(growth) = self.energy_growth.get_mut(cable) {
                growth.update(observed, time_s, &mut found);
            }
            if since_s.is_some()
                && let Some(snags) = self.snags.get_mut(cable)
            {
                snags.update(observed, time_s, &mut found);
            }
            self.hold_tension(cable, observed, time_s);
            if since_s.is_some() {
                self.drop_short_slack(cable, observed.problem, time_s, &mut found);
            }
            for (k, warning) in found.iter().enumerate() {
                let number = found[..k].iter().filter(|w| w.kind == warning.kind).count();
                self.raise(cable, number, warning, time_s, since_s);
            }
        }
        let holds =
            |s: &ActiveWarning| s.last_seen_s >= time_s || since_s.is_some() && time_s - s.last_seen_s < HOLD_TIME_S;
        self.active.retain(holds);
        self.active.sort_by_key(|s| s.cable);
        self.last_s = Some(time_s);
    }

    /// Renews a warning, or adds it.
    fn raise(&mut self, cable: usize, number: usize, warning: &Warning, time_s: f64, since_s: Option<f64>) {
        let same = |s: &&mut ActiveWarning| (s.cable, s.number, s.warning.kind) == (cable, number, warning.kind);
        if let Some(active) = self.active.iter_mut().find(same) {
            let since_s = warning.since_s.or(active.warning.since_s);
            active.warning = Warning { since_s, ..warning.clone() };
            active.last_seen_s = time_s;
        } else {
            let warning = Warning { since_s: warning.since_s.or(since_s), ..warning.clone() };
            self.active.push(ActiveWarning { cable, number, last_seen_s: time_s, warning });
        }
    }

    /// In motion a part that loses its tension for less time than a cable takes to fall by its own
    /// diameter, √(2d/g), has not gone anywhere: as when one sticks and slips. It is no warning.
    fn drop_short_slack(&mut self, cable: usize, problem: &Problem, time_s: f64, found: &mut Vec<Warning>) {
        let is_slack = |w: &Warning| matches!(w.cause, WarningCause::LowTension { .. });
        self.slack_since_s.resize(self.slack_since_s.len().max(cable + 1), None);
        let Some(since_s) = self.slack_since_s.get_mut(cable) else { return };
        if !found.iter().any(is_slack) {
            *since_s = None;
            return;
        }
        let began_s = *since_s.get_or_insert(time_s);
        let weight = problem.body_force(time_s).norm();
        let mass = problem.cable.linear_density_kg_per_m;
        let fall_s = if weight > 0.0 { (2.0 * problem.cable.diameter_m * mass / weight).sqrt() } else { 0.0 };
        if time_s - began_s < fall_s {
            found.retain(|w| !is_slack(w));
        }
    }

    /// A tension warning that stands stays while tension is just below its limit; after a break
    /// there is no such tension.
    fn hold_tension(&mut self, cable: usize, observed: &Observed<'_>, time_s: f64) {
        let broke = |s: &ActiveWarning| s.warning.kind == WarningKind::BreakingTension && !observed.breaks.is_empty();
        self.active.retain(|s| s.cable != cable || !broke(s));
        let top = tension::greatest(observed.answer);
        for s in self.active.iter_mut().filter(|s| s.cable == cable) {
            let of_tension = matches!(s.warning.kind, WarningKind::ServiceTension | WarningKind::BreakingTension);
            if of_tension && top > RELEASE_FRACTION * s.warning.limit {
                s.last_seen_s = time_s;
            }
        }
    }
}

/// Returns the warnings that one answer justifies on its own.
pub(super) fn instantaneous(observed: &Observed<'_>) -> Vec<Warning> {
    let Observed { problem, answer, bends, breaks, .. } = *observed;
    let mut out = Vec::new();
    tension::broken(&problem.cable, breaks, &mut out);
    tension::limits(&problem.cable, answer, breaks, &mut out);
    bend::warn(problem, &bends, &mut out);
    tension::slack(problem, answer, &mut out);
    tangle::warn(problem, answer, &mut out);
    speed::warn(&problem.cable.name, answer, &mut out);
    out
}

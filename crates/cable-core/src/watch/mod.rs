//! What becomes of a cable beyond its shape: limits it exceeds, breaks, bends, slack, tangles, snags, energy from nowhere.
//!
//! Each part looks at one answer of one cable ([`CableSolution`]) and says what it finds; [`Watch`] adds time: since when,
//! and no flicker. Models know nothing of it, so all of them get it.

mod bend;
mod crossing;
pub(crate) use crossing::crossings;
mod growth;
mod snag;
mod tangle;
mod tension;
#[cfg(test)]
mod tests;

use crate::breakage::Break;
use crate::problem::Problem;
use crate::solution::{CableSolution, Energy, Warning, WarningKind};
use growth::Growth;
use snag::Snags;

pub(crate) use bend::Bends;

/// A warning stays for this long (s) after its last cause. Shorter: a cable that swings about its service tension makes the
/// warning flicker, and `events.csv` long; longer: it stands when all is well again. With it no warning comes and goes more
/// than once a second.
const HOLD_S: f64 = 1.0;

/// A tension warning that stands is held by tensions above this part of its limit. Closer to 1: noise of the tension ends
/// and begins it; further: the warning does not believe that the load was lightened. Axial noise of a drag is under 5 %.
const RELEASE: f64 = 0.95;

/// One cable, what it is said to do now, and where it broke.
#[derive(Clone, Copy)]
pub(crate) struct Subject<'a> {
    /// The whole cable.
    pub problem: &'a Problem,
    /// Its answer.
    pub answer: &'a CableSolution,
    /// Its energy.
    pub energy: Energy,
    /// Its bends.
    pub bends: Bends,
    /// Its breaks.
    pub breaks: &'a [Break],
}

/// What was seen of all cables of a scene, over time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Watch {
    standing: Vec<Standing>,
    snags: Vec<Snags>,
    growth: Vec<Growth>,
    last_s: Option<f64>,
}

/// A warning that stands.
#[derive(Clone, Debug)]
struct Standing {
    cable: usize,
    /// Which of its kind on its cable.
    number: usize,
    seen_s: f64,
    warning: Warning,
}

impl Watch {
    /// What is to be said of an answer at rest: the past does not count.
    pub fn at_rest(&mut self, subjects: &[Subject<'_>], time_s: f64) {
        *self = Self::default();
        self.take(subjects, time_s, None);
    }

    /// What is to be said at an instant of a motion.
    pub fn moving(&mut self, subjects: &[Subject<'_>], time_s: f64) {
        if self.last_s.is_some_and(|last| time_s < last) {
            *self = Self::default();
        }
        self.take(subjects, time_s, Some(time_s));
    }

    /// The warnings that stand, those of the first cable first.
    pub fn warnings(&self) -> impl Iterator<Item = &Warning> {
        self.standing.iter().map(|s| &s.warning)
    }

    fn take(&mut self, subjects: &[Subject<'_>], time_s: f64, since_s: Option<f64>) {
        self.snags.resize_with(subjects.len(), Snags::default);
        self.growth.resize_with(subjects.len(), Growth::default);
        for (cable, subject) in subjects.iter().enumerate() {
            let mut found = look(subject);
            if let Some(growth) = self.growth.get_mut(cable) {
                growth.look(subject, time_s, &mut found);
            }
            if since_s.is_some()
                && let Some(snags) = self.snags.get_mut(cable)
            {
                snags.look(subject, time_s, &mut found);
            }
            self.hold_tension(cable, subject, time_s);
            for (k, warning) in found.iter().enumerate() {
                let number = found[..k].iter().filter(|w| w.kind == warning.kind).count();
                self.stand((cable, number), warning, time_s, since_s);
            }
        }
        let holds = |s: &Standing| s.seen_s >= time_s || since_s.is_some() && time_s - s.seen_s < HOLD_S;
        self.standing.retain(holds);
        self.standing.sort_by_key(|s| s.cable);
        self.last_s = Some(time_s);
    }

    fn stand(&mut self, (cable, number): (usize, usize), warning: &Warning, time_s: f64, since_s: Option<f64>) {
        let same = |s: &&mut Standing| (s.cable, s.number, s.warning.kind) == (cable, number, warning.kind);
        if let Some(standing) = self.standing.iter_mut().find(same) {
            let since_s = warning.since_s.or(standing.warning.since_s);
            standing.warning = Warning { since_s, ..warning.clone() };
            standing.seen_s = time_s;
        } else {
            let warning = Warning { since_s: warning.since_s.or(since_s), ..warning.clone() };
            self.standing.push(Standing { cable, number, seen_s: time_s, warning });
        }
    }

    /// A tension warning that stands stays while tension is just below its limit; after a break there is no such tension.
    fn hold_tension(&mut self, cable: usize, subject: &Subject<'_>, time_s: f64) {
        let broke = |s: &Standing| s.warning.kind == WarningKind::BreakingTension && !subject.breaks.is_empty();
        self.standing.retain(|s| s.cable != cable || !broke(s));
        let top = tension::greatest(subject.answer);
        for s in self.standing.iter_mut().filter(|s| s.cable == cable) {
            let of_tension = matches!(s.warning.kind, WarningKind::ServiceTension | WarningKind::BreakingTension);
            if of_tension && top > RELEASE * s.warning.limit {
                s.seen_s = time_s;
            }
        }
    }
}

/// What one answer shows by itself.
fn look(subject: &Subject<'_>) -> Vec<Warning> {
    let Subject { problem, answer, bends, breaks, .. } = *subject;
    let mut out = Vec::new();
    tension::broken(&problem.cable, breaks, &mut out);
    tension::limits(&problem.cable, answer, &mut out);
    bend::warn(problem, &bends, &mut out);
    tension::slack(problem, answer, &mut out);
    tangle::warn(problem, answer, &mut out);
    out
}

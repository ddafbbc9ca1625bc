//! The recording keeps what was seen since the last start: every answer within a memory budget, the
//! events in between, and which of it is shown.

use std::sync::Arc;

use cable_core::Solution;
use cable_core::record::History;
use cable_core::solution::{Warning, WarningKind};

/// Memory for answers, bytes: 512 MiB. Ten minutes of 200 nodes at 60 answers a second are 1 GB;
/// beyond the budget every second answer of the older half is left out, again and again, so that
/// the recent past keeps its full rate and nothing is forgotten altogether. More costs small
/// machines their memory; less makes old answers coarse.
pub const BUDGET_BYTES: usize = 512 << 20;

/// Most events kept: what trembles for hours must not fill the memory.
const MAX_EVENTS: usize = 5000;

/// A warning that began, or a break.
#[derive(Clone, Debug, PartialEq)]
pub struct TimelineEvent {
    /// Time, s.
    pub time_s: f64,
    /// The warning.
    pub warning: Warning,
}

/// Answers, events, and the place in them.
#[derive(Clone, Debug)]
pub struct Recording {
    frames: History,
    events: Vec<TimelineEvent>,
    active: Vec<(WarningKind, String)>,
    /// Time shown, s; None = the present.
    pub shown_s: Option<f64>,
    /// Wall time that the answers took, s; None: it is not known.
    pub solve_wall_s: Option<f64>,
    /// The replay begins anew at its end.
    pub looped: bool,
}

impl Default for Recording {
    fn default() -> Self {
        Self::with_budget(BUDGET_BYTES)
    }
}

impl Recording {
    /// An empty one of another size, bytes.
    #[must_use]
    pub fn with_budget(bytes: usize) -> Self {
        Self {
            frames: History::new(bytes),
            events: Vec::new(),
            active: Vec::new(),
            shown_s: None,
            solve_wall_s: Some(0.0),
            looped: false,
        }
    }

    /// Adds an answer; one at or before the last replaces what came after it.
    pub fn push(&mut self, solution: Solution) {
        self.forget_replaced_events(solution.time_s);
        for w in &solution.warnings {
            let known = match w.kind {
                // A break stays: each one is an event of its own.
                WarningKind::Broken => self.events.iter().any(|e| e.warning == *w),
                _ => self.active.iter().any(|(kind, cable)| *kind == w.kind && *cable == w.cable),
            };
            if !known && is_event(w.kind) && self.events.len() < MAX_EVENTS {
                self.events.push(TimelineEvent { time_s: began(w, solution.time_s), warning: w.clone() });
            }
        }
        self.active = solution.warnings.iter().map(|w| (w.kind, w.cable.clone())).collect();
        self.frames.push(solution);
    }

    /// Forgets the events after an instant (s), and those of the answer that another of the same
    /// instant replaces: it was of a scene that has been changed since.
    fn forget_replaced_events(&mut self, time_s: f64) {
        let replaced = self.frames.entries().last().is_some_and(|e| e.time_s >= time_s);
        let active = &mut self.active;
        self.events.retain(|e| {
            let of_replaced = replaced && e.time_s == time_s;
            if of_replaced {
                active.retain(|(kind, cable)| *kind != e.warning.kind || *cable != e.warning.cable);
            }
            e.time_s <= time_s && !of_replaced
        });
    }

    /// Forgets everything but whether it loops.
    pub fn clear(&mut self) {
        self.frames.clear();
        self.events.clear();
        self.active.clear();
        (self.shown_s, self.solve_wall_s) = (None, Some(0.0));
    }

    /// First and last time, s; None while there are not two.
    #[must_use]
    pub fn span_s(&self) -> Option<[f64; 2]> {
        match self.frames.entries() {
            [first, .., last] => Some([first.time_s, last.time_s]),
            _ => None,
        }
    }

    /// Returns what began when, oldest first.
    #[must_use]
    pub fn events(&self) -> &[TimelineEvent] {
        &self.events
    }

    /// Every answer kept, oldest first.
    #[must_use]
    pub fn answers(&self) -> &[Solution] {
        self.frames.entries()
    }

    /// The answer to show in the place of the present one.
    #[must_use]
    pub fn displayed(&self) -> Option<Arc<Solution>> {
        Some(Arc::new(self.frames.at(self.shown_s?)?.clone()))
    }

    /// Time of the answer one before (−1) or after (+1) the one shown, s; None where there is none.
    /// `now_s`: the present.
    #[must_use]
    pub fn neighbour_s(&self, now_s: f64, step: isize) -> Option<f64> {
        let at = self.shown_s.unwrap_or(now_s);
        let entries = self.frames.entries();
        let index = entries.partition_point(|e| e.time_s <= at).checked_sub(1)?;
        entries.get(index.checked_add_signed(step)?).map(|e| e.time_s)
    }

    /// Lets `dt_s` of what is replayed pass; whether its end was reached and the present is to go
    /// on.
    pub fn replay(&mut self, dt_s: f64) -> bool {
        let (Some(shown), Some([first, last])) = (self.shown_s, self.span_s()) else { return false };
        let next = shown + dt_s;
        let ended = !(next < last);
        self.shown_s = match (ended, self.looped) {
            (false, _) => Some(next),
            (true, true) => Some(first),
            (true, false) => None,
        };
        ended && !self.looped
    }

    /// Returns how much is kept, in words.
    #[must_use]
    pub fn about(&self) -> String {
        let megabytes = self.frames.bytes() as f64 / f64::from(1 << 20);
        let most = BUDGET_BYTES >> 20;
        let count = self.frames.entries().len();
        format!("{count} frames ({megabytes:.1} of {most} MiB). When full, older frames are thinned")
    }
}

/// Returns whether a kind is something that happens, not a remark on the answer.
fn is_event(kind: WarningKind) -> bool {
    !matches!(
        kind,
        WarningKind::NotUnique
            | WarningKind::Accuracy
            | WarningKind::Stabilised
            | WarningKind::EnergyGrows
            | WarningKind::SupportHeld
            | WarningKind::InitialPenetration
            | WarningKind::ClearOfWheel
    )
}

fn began(w: &Warning, now_s: f64) -> f64 {
    w.since_s.filter(|t| *t <= now_s).unwrap_or(now_s)
}

#[cfg(test)]
mod tests {
    use cable_core::Model;
    use cable_core::solution::{CableSolution, Cost, Energy, ModelReason, Node, WarningCause};

    use super::*;

    fn at(time_s: f64, nodes: usize) -> Solution {
        let cable = CableSolution { nodes: vec![Node::default(); nodes].into(), ..CableSolution::default() };
        Solution {
            time_s,
            model: Model::Fem,
            reason: ModelReason::Requested,
            next_cheaper: None,
            cables: vec![cable],
            warnings: Vec::new(),
            cost: Cost::default(),
            energy: Energy::default(),
            robot: None,
            verification: None,
        }
    }

    /// The same answer with a warning.
    fn with_warning_at(time_s: f64, nodes: usize) -> Solution {
        let warning = Warning::new(WarningCause::AboveService { time_s: None }, "a", 1.0, [9.0, 8.0]);
        Solution { warnings: vec![warning], ..at(time_s, nodes) }
    }

    #[test]
    fn ten_minutes_of_two_hundred_nodes_stay_within_a_budget() {
        // A sixteenth of the budget and of the nodes: the same thinning in less memory.
        let budget = BUDGET_BYTES / 16;
        let mut r = Recording::with_budget(budget);
        for k in 0..=36_000 {
            r.push(at(f64::from(k) / 60.0, 13));
            assert!(r.frames.bytes() <= budget);
        }
        assert_eq!(r.span_s(), Some([0.0, 600.0]));
        let times: Vec<f64> = r.answers().iter().map(|a| a.time_s).collect();
        let widest = times.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
        assert!(widest < 0.07, "{widest} s between two pictures");
        assert!(
            times[times.len() - 1] - times[times.len() - 100] < 1.7,
            "the last seconds are at full rate: {:?}",
            times.len()
        );
    }

    #[test]
    fn an_event_is_marked_once_while_it_lasts_and_again_when_it_comes_back() {
        let mut r = Recording::default();
        for (k, warned) in [false, true, true, false, true].into_iter().enumerate() {
            r.push(if warned { with_warning_at(k as f64, 1) } else { at(k as f64, 1) });
        }
        assert_eq!(r.events().iter().map(|e| e.time_s).collect::<Vec<_>>(), [1.0, 4.0]);
        r.push(with_warning_at(2.0, 1));
        assert_eq!(r.events().len(), 1, "what is wound back over is forgotten");
    }

    #[test]
    fn an_answer_that_replaces_another_takes_its_events_away() {
        let mut r = Recording::default();
        r.push(with_warning_at(0.0, 1));
        r.push(with_warning_at(0.0, 1));
        assert_eq!(r.events().len(), 1, "one that both have stays");
        r.push(at(0.0, 1));
        assert_eq!(r.events(), []);
        r.push(with_warning_at(1.0, 1));
        r.push(with_warning_at(2.0, 1));
        r.push(at(2.0, 1));
        assert_eq!(r.events().iter().map(|e| e.time_s).collect::<Vec<_>>(), [1.0], "what began before stays");
    }

    #[test]
    fn each_break_is_an_event() {
        let broken = |texts: &[&str], time_s: f64| {
            let one = |t: &&str| {
                let cause = WarningCause::Recorded { kind: WarningKind::Broken, message: (*t).to_owned() };
                Warning::new(cause, "a", 1.0, [9.0, 8.0])
            };
            Solution { warnings: texts.iter().map(one).collect(), ..at(time_s, 1) }
        };
        let mut r = Recording::default();
        for (k, texts) in [&["first"][..], &["first"], &["first", "second"], &["first", "second"]].iter().enumerate() {
            r.push(broken(texts, k as f64));
        }
        assert_eq!(r.events().iter().map(|e| e.time_s).collect::<Vec<_>>(), [0.0, 2.0]);
    }

    #[test]
    fn a_replay_ends_at_the_present_or_begins_anew() {
        let mut r = Recording::default();
        for k in 0..10 {
            r.push(at(f64::from(k), 1));
        }
        r.shown_s = Some(8.5);
        assert!(!r.replay(0.25) && r.displayed().unwrap().time_s == 8.0);
        assert!(r.replay(0.5) && r.shown_s.is_none());
        (r.shown_s, r.looped) = (Some(8.5), true);
        assert!(!r.replay(0.75) && r.shown_s == Some(0.0));
        assert_eq!(r.neighbour_s(9.0, 1), Some(1.0));
        assert_eq!(r.neighbour_s(9.0, -1), None);
        r.shown_s = None;
        assert_eq!(r.neighbour_s(9.0, -1), Some(8.0));
        assert_eq!(r.neighbour_s(9.0, 1), None);
    }
}

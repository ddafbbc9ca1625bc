//! The window and the thread share one slot for a request, one for the answer, and the solve that
//! runs.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use crate::worker::engine::{Engine, Report, outbox};
use crate::worker::request::Request;

/// The slots that window and thread share.
#[derive(Default)]
pub struct Shared {
    pub slots: Mutex<Slots>,
    pub wake: Condvar,
}

/// One request, one answer and one solve.
#[derive(Default)]
pub struct Slots {
    pub request: Option<Request>,
    /// The time when the waiting request came.
    pub asked_at: Option<Instant>,
    /// The time when the last request was merged into it.
    pub last_asked_at: Option<Instant>,
    pub report: Option<Report>,
    pub busy: bool,
    pub stop: bool,
    /// The running solve, where it may be given up.
    pub solve: Option<Solve>,
    /// Number of the thread whose reports are accepted; the others have been abandoned.
    pub thread: u64,
    /// Reports so far: a solve that ends starts the time to its abandonment anew.
    pub reports: u64,
}

/// A solve that may be given up.
pub struct Solve {
    pub began: Instant,
    /// The engine as it was before.
    pub engine: Box<Engine>,
    /// The request that is solved; None: the answer to a draft, or other histories of an answer.
    pub request: Option<Request>,
    /// True if it seeks other histories of the answer on screen.
    pub seeks_histories: bool,
}

impl Shared {
    /// A panic is caught outside the lock, so a poisoned lock still guards whole values.
    pub fn lock(&self) -> MutexGuard<'_, Slots> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Report {
    /// Takes in a later report that overtook this one.
    pub fn merge(&mut self, later: Self) {
        self.snapshot = later.snapshot;
        self.paused_itself |= later.paused_itself;
        if later.history_restarts {
            self.history_restarts = true;
            self.answers.clear();
        }
        self.answers.extend(later.answers);
        self.routes = later.routes;
        outbox::thin(&mut self.answers);
    }
}

/// Puts a report into its slot, with the one that waits there.
pub fn keep(slot: &mut Option<Report>, report: Report) {
    match slot {
        Some(waiting) => waiting.merge(report),
        None => *slot = Some(report),
    }
}

#[cfg(test)]
mod tests {
    use cable_core::solution::{CableSolution, Cost, Energy, ModelReason, TensionPeak, TensionPeaks};
    use cable_core::{Model, Solution};

    use super::*;
    use crate::worker::timing::MAX_ANSWERS;

    fn answer(time_s: f64, peak_n: f64) -> Solution {
        let greatest = TensionPeak { tension_n: peak_n, arc_length_m: 1.0, time_s };
        let peaks = Some(TensionPeaks { greatest, held: greatest, over_s: 0.01 });
        Solution {
            time_s,
            model: Model::Fem,
            reason: ModelReason::Requested,
            next_cheaper: None,
            cables: vec![CableSolution { peaks, ..CableSolution::default() }],
            warnings: Vec::new(),
            cost: Cost::default(),
            energy: Energy::default(),
            robot: None,
            verification: None,
        }
    }

    /// A window that stalled for half a minute had lost the greatest tension of its first 20 s, and
    /// the start of the run.
    #[test]
    fn answers_that_wait_for_a_stalled_window_are_thinned_and_keep_the_greatest_tension() {
        for spike in [0_u32, 1, 2, 3, 700, 1501, 1798, 1799] {
            let mut slot = None;
            for k in 0..1800 {
                let peak_n = if k == spike { 900.0 } else { 100.0 };
                let answers = vec![answer(f64::from(k) / 60.0, peak_n)];
                keep(&mut slot, Report { answers, ..Report::default() });
            }
            let answers = slot.unwrap().answers;
            assert!(answers.len() <= MAX_ANSWERS, "{} wait", answers.len());
            assert_eq!([answers[0].time_s, answers[answers.len() - 1].time_s], [0.0, 1799.0 / 60.0]);
            let largest_gap_s = answers.windows(2).map(|w| w[1].time_s - w[0].time_s).fold(0.0, f64::max);
            assert!(largest_gap_s < 0.3, "{largest_gap_s} s between two");
            let greatest = answers.iter().map(Solution::peaks).reduce(TensionPeaks::with).unwrap();
            let peak = TensionPeak { tension_n: 900.0, arc_length_m: 1.0, time_s: f64::from(spike) / 60.0 };
            assert_eq!((greatest.greatest, greatest.held), (peak, peak), "spike {spike}");
        }
    }
}

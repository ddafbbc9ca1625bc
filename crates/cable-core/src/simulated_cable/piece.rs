//! A piece is a part of the cable that holds together, with its model and its last answer.

use crate::breakage::CablePart;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{BreakPlace, Mechanics};
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{CableSolution, MomentumAccount, TensionPeak, TensionPeaks};

/// A pulley is off the cable when a new end is this near, in elements. Smaller: the end runs into
/// the pulley, where there is no element left on one side; larger: it drops off visibly early. 2
/// leaves a moving node beside the pulley.
const PULLEY_RELEASE_ELEMENTS: f64 = 2.0;

/// A part of the cable that holds together.
pub(super) struct CablePiece {
    pub mechanics: Box<dyn Mechanics>,
    pub part: CablePart,
    /// The answer at its present instant, in its own arc lengths.
    pub answer: CableSolution,
    /// Steps, of those after a break, in which it is still not asked whether it breaks …
    pub unwatched_steps: u32,
    /// … and for each of its stretches between breaks the time before which it is not asked, s.
    pub unwatched_until_s: Vec<f64>,
    /// Places, in its own arc lengths and in order, at which its model has broken it.
    pub breaks: Vec<BreakPlace>,
    /// Its tension in the inner steps of its model, in its own arc lengths.
    pub gauge: TensionGauge,
    /// Its momentum since the caller's step began, as far as there is an account of it.
    pub account: Option<MomentumAccount>,
}

impl CablePiece {
    /// A piece with the present answer of its model.
    pub fn new(mechanics: Box<dyn Mechanics>, part: CablePart, gauge: TensionGauge) -> Self {
        let answer = mechanics.solution();
        Self {
            answer,
            mechanics,
            part,
            unwatched_steps: 0,
            unwatched_until_s: vec![f64::NEG_INFINITY],
            breaks: Vec::new(),
            gauge,
            account: None,
        }
    }

    pub fn refresh_answer(&mut self) {
        self.answer = self.mechanics.solution();
    }

    /// Adds the account of the step just made.
    pub fn accumulate_momentum(&mut self) {
        self.account = match (self.account, self.answer.momentum) {
            (Some(before), Some(now)) => Some(before.then(&now)),
            (before, now) => now.or(before),
        };
    }

    /// Mean length of an element, m.
    pub fn element(&self) -> f64 {
        self.part.length() / self.answer.nodes.len().saturating_sub(1 + self.breaks.len()).max(1) as f64
    }

    /// The arc lengths (its own, m) between which each of its stretches lies.
    pub fn stretches(&self) -> impl Iterator<Item = [f64; 2]> {
        let places = || self.breaks.iter().map(|b| b.arc_length_m);
        std::iter::once(0.0).chain(places()).zip(places().chain([self.part.length()])).map(|(a, b)| [a, b])
    }

    /// The arc lengths (its own, m) between which each of its stretches may break: not at an end
    /// that is free since a break.
    pub fn breakable_ranges(&self) -> impl Iterator<Item = [f64; 2]> {
        let least = 0.5 * self.element();
        let (first, last) = (self.part.supports.first(), self.part.supports.last());
        let breaks = self.breaks.len();
        self.stretches().enumerate().map(move |(k, [from, to])| {
            let low = if k > 0 || first == Some(&None) { from + least } else { f64::NEG_INFINITY };
            let high = if k < breaks || last == Some(&None) { to - least } else { f64::INFINITY };
            [low, high]
        })
    }

    /// Lets its model break it and go on with both pieces; `wave_s_per_m` is the time (s/m) of a
    /// wave along the cable. Returns whether the model can.
    pub fn break_in_model(&mut self, place: BreakPlace, time_s: f64, wave_s_per_m: f64) -> bool {
        if !self.mechanics.break_at(&place) {
            return false;
        }
        let k = self.breaks.partition_point(|b| b.arc_length_m < place.arc_length_m);
        let inside = place.arc_length_m > 0.0 && place.arc_length_m < self.part.length();
        if inside {
            self.breaks.insert(k, place);
            self.unwatched_until_s.insert(k, f64::NEG_INFINITY);
        }
        let lengths: Vec<f64> = self.stretches().map(|[from, to]| to - from).collect();
        let new = self.unwatched_until_s.iter_mut().zip(lengths).skip(k).take(1 + usize::from(inside));
        for (until_s, length) in new {
            *until_s = time_s + 2.0 * length * wave_s_per_m;
        }
        self.refresh_answer();
        true
    }

    /// The greatest tensions of the last advance, with the nodes at its end where it did not break,
    /// in arc lengths of the whole cable.
    pub fn peaks(&self) -> Option<TensionPeaks> {
        let mut peaks = self.gauge.peaks()?;
        if self.gauge.reached().is_none() {
            let time_s = self.mechanics.time_s();
            for n in &self.answer.nodes {
                if n.tension_n > peaks.greatest.tension_n {
                    peaks.greatest = TensionPeak { tension_n: n.tension_n, arc_length_m: n.arc_length_m, time_s };
                }
            }
        }
        peaks.greatest.arc_length_m += self.part.from;
        peaks.held.arc_length_m += self.part.from;
        Some(peaks)
    }

    /// A pulley that a new end has come to.
    pub fn pulley_at_new_end(&self, whole: &Problem) -> Option<usize> {
        let supports = &self.part.supports;
        let [start, end] = [supports.first(), supports.last()].map(|s| s == Some(&None));
        let near = PULLEY_RELEASE_ELEMENTS * self.element();
        supports.iter().zip(&self.answer.supports).find_map(|(k, r)| {
            let k = (*k)?;
            let pulley = whole.supports.get(k)?.kind == SupportKind::Pulley;
            let off = (start && r.arc_length_m <= near) || (end && self.part.length() - r.arc_length_m <= near);
            (pulley && off).then_some(k)
        })
    }

    /// A copy to go back to.
    pub fn checkpoint(&self) -> Self {
        self.with(self.mechanics.copy_to_keep())
    }

    /// A copy with a copy of its mechanics.
    fn with(&self, mechanics: Box<dyn Mechanics>) -> Self {
        Self {
            mechanics,
            part: self.part.clone(),
            answer: self.answer.clone(),
            unwatched_steps: self.unwatched_steps,
            unwatched_until_s: self.unwatched_until_s.clone(),
            breaks: self.breaks.clone(),
            gauge: self.gauge.clone(),
            account: self.account,
        }
    }
}

impl Clone for CablePiece {
    fn clone(&self) -> Self {
        self.with(self.mechanics.boxed_clone())
    }
}

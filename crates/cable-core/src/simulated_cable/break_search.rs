//! A piece advances until its tension reaches the breaking tension, and the instant of that is
//! found between two of its steps.

use super::piece::CablePiece;
use crate::breakage::rupture::{self, Rupture};
use crate::error::SolveError;
use crate::math::larger;
use crate::model::tension_gauge::{Limit, TensionGauge};
use crate::model::{Inertia, Mechanics, StepReport};
use crate::solution::TensionPeaks;
use crate::state::State;

/// Part of a step by which a time may exceed a whole number of steps: round-off. Smaller: one more
/// step of nearly no length; larger: steps longer than the longest.
const STEP_COUNT_ROUNDING: f64 = 1e-9;

/// Longest step with inertia at whose end a break is looked for, s: a longer one in which the piece
/// breaks is taken again in parts. Longer: the place of the break is blurred; shorter: more steps
/// for each break. It is the inner step of `fem`.
const BREAK_SEARCH_STEP_S: f64 = 1.0 / 240.0;

/// Parts of a step without inertia that ends beyond the breaking tension. The moment of the break
/// is interpolated within one of them: with 16 the end of a cable pulled from slack to taut in one
/// step is found to 1e-2 of the step.
const QUASI_STATIC_SUBSTEPS: f64 = 16.0;

/// A break in the last such part of a step is put at its end, and one in the first such part at the
/// end of that: over a millionth of a step the forces of inertia would be rounding.
const MIN_STEP_REMAINDER: f64 = 0.1;

/// The next of equal steps of `step_s` (s): all that is left, if that is less than one and a half.
fn next_of_equal_steps(left_s: f64, step_s: f64) -> f64 {
    if left_s < 1.5 * step_s { left_s } else { step_s }
}

/// The break of a piece.
pub(super) struct BreakPoint {
    /// Time of the break, s.
    pub time_s: f64,
    /// The state of the piece then.
    pub state: State,
    /// The place on it.
    pub at: Rupture,
}

/// The outcome of a step of a piece.
pub(super) enum StepOutcome {
    Intact,
    Broke(Box<BreakPoint>),
}

impl CablePiece {
    /// Advances until it breaks, at most by `dt_s`.
    pub fn advance(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        breaking_n: Option<f64>,
        sum: &mut StepReport,
    ) -> Result<StepOutcome, SolveError> {
        match (inertia, breaking_n) {
            (Inertia::Dynamic, breaking_n) => self.advance_dynamic(dt_s, breaking_n, sum),
            (Inertia::QuasiStatic, Some(breaking_n)) => self.advance_quasi_static(dt_s, breaking_n, sum),
            (Inertia::QuasiStatic, None) => {
                self.gauge.forget();
                sum.add(self.mechanics.advance(dt_s, inertia)?);
                self.refresh_answer();
                Ok(StepOutcome::Intact)
            }
        }
    }

    /// Advances with inertia. The piece breaks where the gauge says so, which sees the inner steps;
    /// a step in which that happens is taken again in parts, to have the cable where it breaks.
    fn advance_dynamic(
        &mut self,
        dt_s: f64,
        breaking_n: Option<f64>,
        sum: &mut StepReport,
    ) -> Result<StepOutcome, SolveError> {
        let parts = (dt_s / BREAK_SEARCH_STEP_S - STEP_COUNT_ROUNDING).ceil().max(1.0);
        if parts > 1.0 && self.unwatched_steps == 0 {
            // A cable that cannot break never takes a step again, so no state is kept for it.
            let before = breaking_n.map(|_| (self.mechanics.boxed_clone(), self.gauge.clone()));
            let report = self.gauged_step(dt_s, breaking_n)?;
            let Some(before) = before.filter(|_| self.gauge.reached().is_some()) else {
                self.refresh_answer();
                self.accumulate_momentum();
                sum.add(report);
                return Ok(StepOutcome::Intact);
            };
            (self.mechanics, self.gauge) = before;
        }
        let (mut left_s, h) = (dt_s, dt_s / parts);
        let mut peaks: Option<TensionPeaks> = None;
        for _ in 0..parts as usize {
            let start = self.mechanics.state();
            let step_s = next_of_equal_steps(left_s, h);
            let breaking_n = breaking_n.filter(|_| self.unwatched_steps == 0);
            let before = breaking_n.map(|_| self.mechanics.boxed_clone());
            let done = self.gauged_step(step_s, breaking_n);
            let (reached, end_s) = (self.gauge.reached(), self.mechanics.time_s());
            if let (Ok(_), Some(reached), Some(before)) =
                (&done, reached, before.filter(|_| self.breaks_in_own_motion()))
            {
                self.step_to_break(before, [start.time_s, step_s, reached.time_s]);
            }
            self.refresh_answer();
            self.accumulate_momentum();
            sum.add(done?);
            self.gauge.add_peaks(peaks);
            peaks = self.gauge.peaks();
            left_s -= step_s;
            self.unwatched_steps = self.unwatched_steps.saturating_sub(1);
            if let Some(reached) = reached {
                let now = self.mechanics.state();
                let fraction = ((reached.time_s - start.time_s) / (end_s - start.time_s)).clamp(0.0, 1.0);
                let at = Rupture { node: rupture::nearest(&self.answer.nodes, reached.arc_length_m), fraction };
                let state = if self.breaks_in_own_motion() || 1.0 - fraction < MIN_STEP_REMAINDER {
                    now
                } else {
                    rupture::between(&start, &now, fraction)
                };
                return Ok(StepOutcome::Broke(Box::new(BreakPoint { time_s: reached.time_s, state, at })));
            }
        }
        Ok(StepOutcome::Intact)
    }

    /// True if the piece takes a step to the instant of a break, so that it breaks in a state of
    /// its own motion: an energy account goes on from there, and a mean of two states in which the
    /// cable does not run through itself may be one in which it does. Others break in the mean of
    /// two states.
    fn breaks_in_own_motion(&self) -> bool {
        self.mechanics.stored_energy().is_some() || self.mechanics.problem().cable.self_contact
    }

    /// After a step in which it breaks, the piece takes a shorter one from the state `before` to
    /// that time, with which a cable at rest begins to move. A break near the end of the step is
    /// put there, and one near its start a little later.
    fn step_to_break(&mut self, before: Box<dyn Mechanics>, [start_s, step_s, break_s]: [f64; 3]) {
        let part = larger((break_s - start_s) / step_s, MIN_STEP_REMAINDER);
        if 1.0 - part < MIN_STEP_REMAINDER {
            return;
        }
        let mut at_break = before;
        // The gauge has seen the step.
        if at_break.advance_gauged(part * step_s, Inertia::Dynamic, &mut TensionGauge::off()).is_ok() {
            self.mechanics = at_break;
        }
    }

    /// Takes a step with inertia in which the gauge looks for a mean tension of `breaking_n` (N);
    /// None for a cable that cannot break.
    fn gauged_step(&mut self, dt_s: f64, breaking_n: Option<f64>) -> Result<StepReport, SolveError> {
        let tension_n = breaking_n.unwrap_or(f64::INFINITY);
        let limit = |(within_m, from_s): ([f64; 2], f64)| Limit { tension_n, from_s, within_m };
        let limits: Vec<Limit> =
            self.breakable_ranges().zip(self.unwatched_until_s.iter().copied()).map(limit).collect();
        self.gauge.watch(limits);
        self.mechanics.advance_gauged(dt_s, Inertia::Dynamic, &mut self.gauge)
    }

    /// Advances without inertia, where a cable breaks as soon as its tension reaches `breaking_n`
    /// (N); a step that ends beyond that is taken again in parts. Returns whether and where it
    /// broke.
    fn advance_quasi_static(
        &mut self,
        dt_s: f64,
        breaking_n: f64,
        sum: &mut StepReport,
    ) -> Result<StepOutcome, SolveError> {
        let inertia = Inertia::QuasiStatic;
        self.gauge.forget();
        if rupture::greatest(&self.answer.nodes) < breaking_n {
            let before = (self.mechanics.boxed_clone(), std::mem::take(&mut self.answer));
            let report = match self.mechanics.advance(dt_s, inertia) {
                Ok(report) => report,
                Err(error) => {
                    self.answer = before.1;
                    return Err(error);
                }
            };
            self.refresh_answer();
            if rupture::greatest(&self.answer.nodes) < breaking_n {
                self.unwatched_steps = self.unwatched_steps.saturating_sub(QUASI_STATIC_SUBSTEPS as u32);
                sum.add(report);
                return Ok(StepOutcome::Intact);
            }
            (self.mechanics, self.answer) = before;
        }
        let (mut left_s, h) = (dt_s, dt_s / QUASI_STATIC_SUBSTEPS);
        for _ in 0..QUASI_STATIC_SUBSTEPS as usize {
            let (state, nodes) = (self.mechanics.state(), std::mem::take(&mut self.answer.nodes));
            let step_s = next_of_equal_steps(left_s, h);
            let done = self.mechanics.advance(step_s, inertia);
            self.refresh_answer();
            sum.add(done?);
            left_s -= step_s;
            let now = self.mechanics.state();
            let awake = self.unwatched_steps == 0;
            self.unwatched_steps = self.unwatched_steps.saturating_sub(1);
            let ranges: Vec<[f64; 2]> = self.breakable_ranges().collect();
            let breakable = |s: f64| ranges.iter().any(|[low, high]| *low <= s && s <= *high);
            if awake && let Some(at) = rupture::first(&nodes, &self.answer.nodes, breaking_n, breakable) {
                let time_s = state.time_s + (now.time_s - state.time_s) * at.fraction;
                let rest = 1.0 - at.fraction;
                let state = if rest < MIN_STEP_REMAINDER { now } else { rupture::between(&state, &now, at.fraction) };
                return Ok(StepOutcome::Broke(Box::new(BreakPoint { time_s, state, at })));
            }
        }
        Ok(StepOutcome::Intact)
    }
}

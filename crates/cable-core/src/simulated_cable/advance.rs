//! All pieces of a cable are settled together, and advance to the same instant.

use super::SimulatedCable;
use super::break_search::StepOutcome;
use crate::error::SolveError;
use crate::model::{Inertia, StepReport};

/// Rest of a step of a piece that counts as none, as a fraction of the step: round-off. Smaller: a
/// step of nearly no length; larger: a piece stays behind in time.
const NO_REST_FRACTION: f64 = 1e-9;

/// Most pieces of one cable. More are no longer a cable that breaks but a step that fails.
const MAX_PIECES: usize = 32;

impl SimulatedCable {
    /// Finds its equilibrium. Nothing breaks at rest: an overloaded cable is warned of.
    pub fn settle(&mut self) -> Result<StepReport, SolveError> {
        let mut sum = StepReport::default();
        self.peaks = None;
        self.place_supports(f64::INFINITY, Inertia::QuasiStatic);
        self.add_obstacles_in_reach()?;
        loop {
            for piece in &mut self.pieces {
                piece.gauge.forget();
                sum.add(piece.mechanics.settle()?);
                piece.refresh_answer();
            }
            self.note_reach();
            if !self.leaves_reach {
                break;
            }
            self.add_obstacles_in_reach()?;
        }
        sum.warnings.extend(self.problem.notes.iter().cloned());
        Ok(sum)
    }

    /// Begins a step of the caller: greatest tensions and the account of momentum are those of it
    /// from now on.
    pub(crate) fn begin_step(&mut self) {
        self.peaks = None;
        self.peaks_since_s = self.time_s();
        self.pieces.iter_mut().for_each(|p| p.account = None);
    }

    /// Advances time by exactly `dt_s`, breaking on the way where it must. Without inertia a step
    /// ends where a motion or load turns back: one step across a reversal would be another history
    /// of friction.
    pub fn advance(&mut self, dt_s: f64, inertia: Inertia) -> Result<StepReport, SolveError> {
        if let (Inertia::Dynamic, Some(feature)) = (inertia, &self.too_fast) {
            return Err(SolveError::Unsupported { model: self.model(), feature: feature.clone() });
        }
        let before = self.breaks.len();
        self.place_supports(dt_s, inertia);
        if inertia == Inertia::QuasiStatic {
            self.former_energy = None;
        }
        let done = self.advance_to_turns(dt_s, inertia);
        let broke_now = self.breaks.get(before..).and_then(<[_]>::last).filter(|_| inertia == Inertia::QuasiStatic);
        done.map_err(|why| match broke_now {
            Some(event) => SolveError::AfterBreak {
                cable: self.problem.cable.name.clone(),
                time_s: event.time_s,
                arc_length_m: event.arc_length_m,
                at_m: event.at,
                breaking_n: self.problem.cable.breaking_tension_n,
                why: Box::new(why),
            },
            None => why,
        })
    }

    /// Advances time by `dt_s`, without inertia from turn to turn of the motions and loads.
    fn advance_to_turns(&mut self, dt_s: f64, inertia: Inertia) -> Result<StepReport, SolveError> {
        let mut sum = StepReport::default();
        let (mut left, end_s) = (dt_s, self.time_s() + dt_s);
        while inertia == Inertia::QuasiStatic
            && let Some(at) = self.problem.turn_between(self.time_s(), end_s)
        {
            sum.add(self.advance_all_pieces(at - self.time_s(), inertia)?);
            left = end_s - self.time_s();
        }
        sum.add(self.advance_all_pieces(left, inertia)?);
        Ok(sum)
    }

    /// Advances every piece by `dt_s` (s); a piece that breaks is split, and its parts go on.
    fn advance_all_pieces(&mut self, dt_s: f64, inertia: Inertia) -> Result<StepReport, SolveError> {
        let mut sum = StepReport::default();
        self.add_obstacles_in_reach()?;
        self.detach_from_pulleys(inertia)?;
        let Some(end_s) = self.pieces.first().map(|p| p.mechanics.time_s() + dt_s) else { return Ok(sum) };
        let breaking_n = self.problem.cable.breaking_tension_n;
        let mut k = 0;
        while k < self.pieces.len() {
            let may_break = self.settings.breaks && self.count_pieces() < MAX_PIECES;
            let Some(piece) = self.pieces.get_mut(k) else { break };
            // A whole cable takes the very step it was asked for.
            let rest_s = if self.breaks.is_empty() { dt_s } else { end_s - piece.mechanics.time_s() };
            if !self.breaks.is_empty() && rest_s <= NO_REST_FRACTION * dt_s {
                k += 1;
                continue;
            }
            let done = piece.advance(rest_s, inertia, may_break.then_some(breaking_n), &mut sum)?;
            self.peaks = match (self.peaks, piece.peaks()) {
                (Some(a), Some(b)) => Some(a.with(b)),
                (a, b) => b.or(a),
            };
            match done {
                StepOutcome::Intact => k += 1,
                StepOutcome::Broke(at) => self.split(k, &at, inertia)?,
            }
        }
        self.note_reach();
        self.note_exchanged_energy();
        Ok(sum)
    }
}

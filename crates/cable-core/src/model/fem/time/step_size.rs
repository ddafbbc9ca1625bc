//! This module adapts the time step to the frequency at which a taut cable vibrates.
//!
//! BDF2 replaces ẋ by (3x₁ − 4x₀ + x₋)/2h = ẋ − h²/3 x⃛ + …, so a vibration of angular frequency ω
//! becomes slower by the fraction (ωh)²/3 and loses the fraction π(ωh)³/2 of its amplitude a period
//! (Hairer, Wanner, "Solving ordinary differential equations II", 1996, V.1). Even steps are
//! blended with BDF3 and have half of that error; the error of BDF2 is used because steps may
//! change. The frequency is observed from the motion, ω² = Σ m a² / Σ m v² as a moving average,
//! with a and v less the mean of the cable, which falls or is carried along.
//!
//! Steps also adapt to the difficulty of their solution. If one is refused, the next of the same
//! length mostly is as well, and the failure costs more than several shorter steps. So steps stay
//! as short as the one that was solved, until a frame takes few iterations (E. Ramm, "Strategies
//! for tracing the nonlinear response near limit points", in: Nonlinear finite element analysis in
//! structural mechanics, Springer 1981, has the same law for load steps).

use crate::math::{Vec2, bounded, larger, smaller};
use crate::model::fem::settings::StepTuning;
use crate::model::fem::state::CableState;

/// Chooses the step from the observed frequency of the motion.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct StepSizeController {
    /// ∫ Σ l |a|² dt, m³/s³, ∫ Σ l |v|² dt, m³/s, and ∫ dt, s.
    seen: [f64; 3],
    /// Longest step of the next frame, s.
    step: f64,
    /// Upper limit of the step, s.
    longest: f64,
    /// Longest step that is tried after a refusal, s.
    solvable: f64,
    /// Greatest number of Newton iterations of a step in the present frame.
    most_iterations: usize,
    /// True if a step of the present frame was refused.
    refused: bool,
}

impl StepSizeController {
    /// A controller without observations.
    pub(in crate::model::fem) fn new(longest: f64) -> Self {
        Self { seen: [0.0; 3], step: longest, longest, solvable: longest, most_iterations: 0, refused: false }
    }

    /// Continues from what another controller observed, with this one's upper limit.
    pub(in crate::model::fem) fn continue_from(&mut self, other: &Self) {
        if self.longest == other.longest {
            self.clone_from(other);
        }
    }

    /// Forgets the observed motion.
    pub(in crate::model::fem) fn forget(&mut self) {
        *self = Self::new(self.longest);
    }

    /// Longest step of the next frame, s.
    pub(in crate::model::fem) fn longest_step(&self) -> f64 {
        smaller(self.step, self.solvable)
    }

    /// Records a step that was solved in so many iterations.
    pub(in crate::model::fem) fn note_solved(&mut self, iterations: usize) {
        self.most_iterations = self.most_iterations.max(iterations);
    }

    /// Records a refused step, which is tried again with `size` (s). Events that need steps shorter
    /// than the shortest one of a frame pass within the frame.
    pub(in crate::model::fem) fn note_refused(&mut self, tuning: &StepTuning, size: f64) {
        self.solvable = smaller(self.solvable, larger(size, tuning.shortest_fraction * self.longest));
        self.refused = true;
    }

    /// Lets steps grow again after an easy frame.
    fn end_frame(&mut self, tuning: &StepTuning) {
        if !self.refused && self.most_iterations <= tuning.easy_iterations {
            self.solvable = smaller(tuning.max_change * self.solvable, self.longest);
        }
        (self.refused, self.most_iterations) = (false, 0);
    }

    /// Observes a step of `h` (s) just made. A cable that falls or lands does not vibrate.
    pub(in crate::model::fem) fn observe(&mut self, cable: &CableState, h: f64) {
        if !is_string(cable) {
            self.seen = [0.0; 3];
            return;
        }
        let (m, mesh) = (&cable.motion, &cable.mesh);
        let free = || (0..m.velocities.len()).filter(|&k| mesh.is_free(k)).map(|k| (k, mesh.tributary_length(k)));
        let (mut length, mut mean) = (0.0, [Vec2::zeros(); 2]);
        for (k, share) in free() {
            length += share;
            mean[0] += (m.velocities[k] - m.previous_velocities[k]) * share;
            mean[1] += (m.velocities[k] + m.previous_velocities[k]) * share;
        }
        for (k, share) in free() {
            let change = m.velocities[k] - m.previous_velocities[k] - mean[0] / length;
            let speed = m.velocities[k] + m.previous_velocities[k] - mean[1] / length;
            self.seen[0] += share * change.norm_squared() / h;
            self.seen[1] += share * speed.norm_squared() * 0.25 * h;
        }
        self.seen[2] += h;
    }

    /// Chooses the longest step of the next frame, after one of `dt` (s), for a cable of a length
    /// (m) with a relative frequency error of at most `tolerance`.
    pub(in crate::model::fem) fn choose(&mut self, tuning: &StepTuning, tolerance: f64, length: f64, dt: f64) {
        let [changes, speeds, time] = self.seen;
        let frequency = (changes / speeds).sqrt();
        let amplitude = (speeds / (time * length)).sqrt() / frequency;
        let matters = frequency.is_finite() && amplitude > tuning.vibration_fraction * length;
        let wanted = if matters { (3.0 * tolerance).sqrt() / frequency } else { self.longest };
        let near = bounded(wanted, self.step / tuning.max_change, self.step * tuning.max_change);
        self.step = near.clamp(tuning.shortest_fraction * self.longest, self.longest);
        let left = (-dt / tuning.memory_s).exp();
        self.seen = self.seen.map(|s| s * left);
        self.end_frame(tuning);
    }
}

/// True if the cable touches nothing and its tension exceeds its weight everywhere.
fn is_string(cable: &CableState) -> bool {
    let (problem, mesh, motion) = (&cable.problem, &cable.mesh, &cable.motion);
    let weight = problem.body_force(motion.time).norm() * problem.length;
    let taut = |e: usize| mesh.tension(e, mesh.path(e, &motion.positions).length) > weight;
    let alone =
        cable.contacts.friction_contacts.is_empty() && cable.contacts.self_contacts.friction_contacts.is_empty();
    alone && (0..mesh.rest_length.len()).all(taut)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::fem::settings::Tuning;

    const LONGEST_STEP_S: f64 = 1.0 / 240.0;

    fn frame(pace: &mut StepSizeController, iterations: usize) -> f64 {
        pace.note_solved(iterations);
        pace.choose(&Tuning::default().step, 1e-3, 1.0, LONGEST_STEP_S);
        pace.longest_step()
    }

    #[test]
    fn after_a_refused_step_the_next_ones_are_as_short_as_the_one_that_was_solved() {
        let mut pace = StepSizeController::new(LONGEST_STEP_S);
        pace.note_refused(&Tuning::default().step, 0.5 * LONGEST_STEP_S);
        pace.note_refused(&Tuning::default().step, 0.25 * LONGEST_STEP_S);
        // The frame of the refusal gives no evidence for a longer step, however easy its end was.
        assert_eq!(frame(&mut pace, 1), 0.25 * LONGEST_STEP_S);
        // A hard frame keeps the step.
        assert_eq!(frame(&mut pace, Tuning::default().step.easy_iterations + 1), 0.25 * LONGEST_STEP_S);
        // Easy ones lengthen it again, up to the longest.
        assert_eq!(frame(&mut pace, Tuning::default().step.easy_iterations), 0.5 * LONGEST_STEP_S);
        assert_eq!(frame(&mut pace, 2), LONGEST_STEP_S);
        assert_eq!(frame(&mut pace, 2), LONGEST_STEP_S);
    }

    #[test]
    fn no_frame_begins_with_steps_shorter_than_the_shortest() {
        let mut pace = StepSizeController::new(LONGEST_STEP_S);
        pace.note_refused(&Tuning::default().step, 1e-3 * LONGEST_STEP_S);
        assert_eq!(pace.longest_step(), Tuning::default().step.shortest_fraction * LONGEST_STEP_S);
    }

    #[test]
    fn hard_steps_alone_do_not_shorten_the_step() {
        let mut pace = StepSizeController::new(LONGEST_STEP_S);
        assert_eq!(frame(&mut pace, 100), LONGEST_STEP_S);
    }
}

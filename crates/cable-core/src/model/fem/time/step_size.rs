//! Steps follow how fast a taut cable vibrates.
//!
//! BDF2 puts (3x₁ − 4x₀ + x₋)/2h = ẋ − h²/3 x⃛ + … for ẋ, so that a vibration of angular frequency
//! ω comes out slower by (ωh)²/3 of it, and loses π(ωh)³/2 of its amplitude a period (Hairer,
//! Wanner, "Solving ordinary differential equations II", 1996, V.1). Even steps have a part of BDF3
//! and half of that error; it is BDF2's that is reckoned with, for steps that change. The frequency
//! of a motion is read off it, ω² = Σ m a² / Σ m v² over the last while, a and v without the mean
//! of the cable, which falls or is carried along.
//!
//! Steps also follow how hard they are to solve. Where one is refused, the next of the same length
//! mostly is as well, and to find that out costs more than several shorter steps. So steps stay as
//! short as the one that was solved, until a frame takes few iterations (E. Ramm, "Strategies for
//! tracing the nonlinear response near limit points", in: Nonlinear finite element analysis in
//! structural mechanics, Springer 1981, has the same law for load steps).

use crate::math::{Vec2, bounded, larger, smaller};
use crate::model::fem::state::cable::CableState;
use crate::model::fem::state::stepping::StepSizeController;

/// The shortest step is this part of the longest, 1/240 s: frequencies up to 17 Hz are exact to
/// 1e-3, those of 40 Hz to 6e-3. Smaller: a vibrating cable costs more than its vibration is worth;
/// larger: only lower frequencies are exact.
const SHORTEST_STEP_FRACTION: f64 = 0.125;

/// Vibrations of less than this part of the cable's length are left as they are: what is left over
/// from coming to rest rings at any frequency, and 0.1 mm in 10 m is no motion that a user sees.
const VIBRATION_FRACTION: f64 = 1e-5;

/// Change of the step from one frame to the next. BDF2 is stable up to 2.4.
const STEP_CHANGE_LIMIT: f64 = 2.0;

/// Time constant of the memory of a motion, s. Half a period of a motion that needs shorter steps
/// passes in it: with less the step would be short where a vibration turns and long where it is
/// fastest.
const MEMORY: f64 = 0.25;

/// Newton iterations of the hardest step of a frame up to which the next frame may take longer
/// steps again. Of a cable of 1000 bars that drops on rubble, fewer: 7 cost 1.7 times as many
/// iterations in all, in shorter steps; more: 40 have three times as many steps refused.
const EASY_STEP_ITERATIONS: usize = 10;

impl StepSizeController {
    /// Longest step of the next frame, s.
    pub(in crate::model::fem) fn longest_step(&self) -> f64 {
        smaller(self.step, self.solvable)
    }

    /// A step was solved in so many iterations.
    pub(in crate::model::fem) fn note_solved(&mut self, iterations: usize) {
        self.most_iterations = self.most_iterations.max(iterations);
    }

    /// A step was refused, and is tried again as one of `size` (s). What needs steps shorter than
    /// the shortest of a frame passes with its frame.
    pub(in crate::model::fem) fn note_refused(&mut self, size: f64) {
        self.solvable = smaller(self.solvable, larger(size, SHORTEST_STEP_FRACTION * self.longest));
        self.refused = true;
    }

    /// Lets steps grow again after a frame that was easy to solve.
    fn end_frame(&mut self) {
        if !self.refused && self.most_iterations <= EASY_STEP_ITERATIONS {
            self.solvable = smaller(STEP_CHANGE_LIMIT * self.solvable, self.longest);
        }
        (self.refused, self.most_iterations) = (false, 0);
    }

    /// Looks at a step of `h` (s) just made. A cable that falls or lands does not vibrate.
    pub(in crate::model::fem) fn observe(&mut self, cable: &CableState, h: f64) {
        if !is_string(cable) {
            self.seen = [0.0; 3];
            return;
        }
        let (m, mesh) = (&cable.motion, &cable.mesh);
        let free = || (0..m.v.len()).filter(|&k| mesh.is_free(k)).map(|k| (k, mesh.share(k)));
        let (mut length, mut mean) = (0.0, [Vec2::zeros(); 2]);
        for (k, share) in free() {
            length += share;
            mean[0] += (m.v[k] - m.v_before[k]) * share;
            mean[1] += (m.v[k] + m.v_before[k]) * share;
        }
        for (k, share) in free() {
            let change = m.v[k] - m.v_before[k] - mean[0] / length;
            let speed = m.v[k] + m.v_before[k] - mean[1] / length;
            self.seen[0] += share * change.norm_squared() / h;
            self.seen[1] += share * speed.norm_squared() * 0.25 * h;
        }
        self.seen[2] += h;
    }

    /// Chooses the longest step of the next frame, after one of `dt` (s), of a cable of a length
    /// (m) whose frequency may be off by a part `tolerance`.
    pub(in crate::model::fem) fn choose(&mut self, tolerance: f64, length: f64, dt: f64) {
        let [changes, speeds, time] = self.seen;
        let frequency = (changes / speeds).sqrt();
        let amplitude = (speeds / (time * length)).sqrt() / frequency;
        let matters = frequency.is_finite() && amplitude > VIBRATION_FRACTION * length;
        let wanted = if matters { (3.0 * tolerance).sqrt() / frequency } else { self.longest };
        let near = bounded(wanted, self.step / STEP_CHANGE_LIMIT, self.step * STEP_CHANGE_LIMIT);
        self.step = near.clamp(SHORTEST_STEP_FRACTION * self.longest, self.longest);
        let left = (-dt / MEMORY).exp();
        self.seen = self.seen.map(|s| s * left);
        self.end_frame();
    }
}

/// True if the cable touches nothing and is pulled all along by more than its weight.
fn is_string(cable: &CableState) -> bool {
    let (problem, mesh, motion) = (&cable.problem, &cable.mesh, &cable.motion);
    let weight = problem.body_force(motion.time).norm() * problem.length;
    let taut = |e: usize| mesh.bar(e).tension(mesh.path(e, &motion.x).length) > weight;
    let alone = cable.contacts.rubs.is_empty() && cable.contacts.own.rubs.is_empty();
    alone && (0..mesh.rest_length.len()).all(taut)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONGEST: f64 = 1.0 / 240.0;

    fn frame(pace: &mut StepSizeController, iterations: usize) -> f64 {
        pace.note_solved(iterations);
        pace.choose(1e-3, 1.0, LONGEST);
        pace.longest_step()
    }

    #[test]
    fn after_a_refused_step_the_next_ones_are_as_short_as_the_one_that_was_solved() {
        let mut pace = StepSizeController::new(LONGEST);
        pace.note_refused(0.5 * LONGEST);
        pace.note_refused(0.25 * LONGEST);
        // The frame of the refusal says nothing about a longer step, however easy its end was.
        assert_eq!(frame(&mut pace, 1), 0.25 * LONGEST);
        // A hard frame keeps the step.
        assert_eq!(frame(&mut pace, EASY_STEP_ITERATIONS + 1), 0.25 * LONGEST);
        // Easy ones lengthen it again, up to the longest.
        assert_eq!(frame(&mut pace, EASY_STEP_ITERATIONS), 0.5 * LONGEST);
        assert_eq!(frame(&mut pace, 2), LONGEST);
        assert_eq!(frame(&mut pace, 2), LONGEST);
    }

    #[test]
    fn no_frame_begins_with_steps_shorter_than_the_shortest() {
        let mut pace = StepSizeController::new(LONGEST);
        pace.note_refused(1e-3 * LONGEST);
        assert_eq!(pace.longest_step(), SHORTEST_STEP_FRACTION * LONGEST);
    }

    #[test]
    fn hard_steps_alone_do_not_shorten_the_step() {
        let mut pace = StepSizeController::new(LONGEST);
        assert_eq!(frame(&mut pace, 100), LONGEST);
    }
}

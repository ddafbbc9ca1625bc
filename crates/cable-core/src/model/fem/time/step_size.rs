//! Steps follow how fast a taut cable vibrates.
//!
//! BDF2 puts (3x₁ − 4x₀ + x₋)/2h = ẋ − h²/3 x⃛ + … for ẋ, so that a vibration of angular frequency
//! ω comes out slower by (ωh)²/3 of it, and loses π(ωh)³/2 of its amplitude a period (Hairer,
//! Wanner, "Solving ordinary differential equations II", 1996, V.1). Even steps have a part of BDF3
//! and half of that error; it is BDF2's that is reckoned with, for steps that change. The frequency
//! of a motion is read off it, ω² = Σ m a² / Σ m v² over the last while, a and v without the mean
//! of the cable, which falls or is carried along.

use crate::math::{Vec2, bounded};
use crate::model::fem::dynamics::Dynamics;

/// The shortest step is this part of the longest, 1/240 s: frequencies up to 17 Hz are exact to
/// 1e-3, those of 40 Hz to 6e-3. Smaller: a vibrating cable costs more than its vibration is worth;
/// larger: only lower frequencies are exact.
const SHORTEST_STEP_FRACTION: f64 = 0.125;

/// Vibrations of less than this part of the cable's length are left as they are: what is left over
/// from coming to rest rings at any frequency, and 0.1 mm in 10 m is no motion that a user sees.
const VIBRATION_FRACTION: f64 = 1e-5;

/// Change of the step from one frame to the next. BDF2 is stable up to 2.4.
const STEP_CHANGE_LIMIT: f64 = 2.0;

/// What was seen is forgotten with this time, s. Half a period of what needs shorter steps passes
/// in it: with less the step would be short where a vibration turns and long where it is fastest.
const MEMORY: f64 = 0.25;

impl Dynamics {
    /// Looks at a step of `h` (s) just made. What falls or lands is no vibration.
    pub(in crate::model::fem) fn note_pace(&mut self, h: f64) {
        if !self.is_string() {
            self.pacing.pace.seen = [0.0; 3];
            return;
        }
        let (m, pace) = (&self.motion, &mut self.pacing.pace);
        let free = || (0..m.v.len()).filter(|&k| self.mesh.is_free(k)).map(|k| (k, self.mesh.share(k)));
        let (mut length, mut mean) = (0.0, [Vec2::zeros(); 2]);
        for (k, share) in free() {
            length += share;
            mean[0] += (m.v[k] - m.v_before[k]) * share;
            mean[1] += (m.v[k] + m.v_before[k]) * share;
        }
        for (k, share) in free() {
            let change = m.v[k] - m.v_before[k] - mean[0] / length;
            let speed = m.v[k] + m.v_before[k] - mean[1] / length;
            pace.seen[0] += share * change.norm_squared() / h;
            pace.seen[1] += share * speed.norm_squared() * 0.25 * h;
        }
        pace.seen[2] += h;
    }

    /// Whether the cable touches nothing and is pulled all along by more than it weighs.
    fn is_string(&self) -> bool {
        let weight = self.problem.body_force(self.motion.time).norm() * self.problem.length;
        let taut = |e: usize| self.mesh.bar(e).tension(self.mesh.path(e, &self.motion.x).length) > weight;
        let alone = self.contacts.rubs.is_empty() && self.contacts.own.rubs.is_empty();
        alone && (0..self.mesh.rest_length.len()).all(taut)
    }

    /// Chooses the longest step of the next frame, after one of `dt` (s).
    pub(in crate::model::fem) fn set_pace(&mut self, dt: f64) {
        let (pace, length) = (&mut self.pacing.pace, self.problem.length);
        let [changes, speeds, time] = pace.seen;
        let frequency = (changes / speeds).sqrt();
        let amplitude = (speeds / (time * length)).sqrt() / frequency;
        let matters = frequency.is_finite() && amplitude > VIBRATION_FRACTION * length;
        let wanted = if matters { (3.0 * self.pacing.tolerance).sqrt() / frequency } else { pace.longest };
        let near = bounded(wanted, pace.step / STEP_CHANGE_LIMIT, pace.step * STEP_CHANGE_LIMIT);
        pace.step = near.clamp(SHORTEST_STEP_FRACTION * pace.longest, pace.longest);
        let left = (-dt / MEMORY).exp();
        pace.seen = pace.seen.map(|s| s * left);
    }
}

//! Steps follow how fast a taut cable vibrates.
//!
//! BDF2 puts (3x₁ − 4x₀ + x₋)/2h = ẋ − h²/3 x⃛ + … for ẋ, so that a vibration of angular frequency
//! ω comes out slower by (ωh)²/3 of it, and loses π(ωh)³/2 of its amplitude a period (Hairer,
//! Wanner, "Solving ordinary differential equations II", 1996, V.1). Even steps have a part of BDF3
//! and half of that error; it is BDF2's that is reckoned with, for steps that change. The frequency
//! of a motion is read off it, ω² = Σ m a² / Σ m v² over the last while, a and v without the mean
//! of the cable, which falls or is carried along.

use crate::math::{Vec2, bounded};
use crate::model::fem::settings::StepTuning;
use crate::model::fem::state::cable::CableState;
use crate::model::fem::state::stepping::StepSizeController;

impl StepSizeController {
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
    }
}

/// True if the cable touches nothing and is pulled all along by more than its weight.
fn is_string(cable: &CableState) -> bool {
    let (problem, mesh, motion) = (&cable.problem, &cable.mesh, &cable.motion);
    let weight = problem.body_force(motion.time).norm() * problem.length;
    let taut = |e: usize| mesh.bar(e).tension(mesh.path(e, &motion.x).length) > weight;
    let alone = cable.contacts.friction_contacts.is_empty() && cable.contacts.own.friction_contacts.is_empty();
    alone && (0..mesh.rest_length.len()).all(taut)
}

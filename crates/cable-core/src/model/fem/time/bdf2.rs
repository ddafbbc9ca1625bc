//! The time integrator is BDF2, blended with BDF3 for a cable that can touch nothing.
//!
//! BDF2 with a step ratio ω = h/h₋ (Hairer, Wanner, "Solving ordinary differential equations II",
//! 1996): with α₀ = (1 + 2ω)/(1 + ω) and the history x̂ = ((1 + ω) x₀ − ω²/(1 + ω) x₋)/α₀,
//! ```text
//! v = a (x − x̂),  a = α₀/h,   v̂ likewise,   m a² (x − x̃) + ∂E/∂x − f = 0,   x̃ = x̂ + v̂/a
//! ```
//! If the cable can touch nothing, even and smooth steps contain a fraction β of the next order,
//! BDF3: α₀ = (9 + 2β)/6 and x̂ = ((2 + β) x₀ − (½ + β) x₋ + (β/3) x₌)/α₀ at the same cost. BDF2
//! makes a vibration ω slower by a fraction (ωh)²/3, and it loses a fraction ω⁴h³/4 of its
//! amplitude a second; the blend has 1 − β and 1 − 2β of these errors.

use crate::math::Vec2;
use crate::model::fem::state::NodalMotion;

/// Fraction β of BDF3 in a step of a cable that can touch nothing. The scheme is A-stable up to ½;
/// 0.48 is the value of V. N. Vatsa, M. H. Carpenter and D. P. Lockard ("Re-evaluation of an
/// optimized second order backward difference (BDF2OPT) scheme for unsteady flow applications",
/// AIAA 2010-122). Smaller: the error of frequency grows up to twice, and damping up to 25 times;
/// larger: the ringing of bars is not damped at all.
const BDF3_PART: f64 = 0.48;

/// The weights of the history in a step: v = a (x − x̂), x̂ = now x₀ − past x₋ + older x₌.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct Weights {
    pub(in crate::model::fem) now: f64,
    pub(in crate::model::fem) past: f64,
    pub(in crate::model::fem) older: f64,
    /// The factor a of the velocity, 1/s.
    pub(in crate::model::fem) rate: f64,
}

impl Weights {
    /// The weights of a step of `h` after one of `before` (s); with 0 there is no history.
    fn bdf2(h: f64, before: f64) -> Self {
        let omega = if before > 0.0 { h / before } else { 0.0 };
        let alpha = (1.0 + 2.0 * omega) / (1.0 + omega);
        let past = omega * omega / (1.0 + omega) / alpha;
        Self { now: (1.0 + omega) / alpha, past, older: 0.0, rate: alpha / h }
    }

    /// The weights of a blended step after two more of the same size `h` (s).
    fn blended(h: f64) -> Self {
        let alpha = 1.5 + BDF3_PART / 3.0;
        Self {
            now: (2.0 + BDF3_PART) / alpha,
            past: (0.5 + BDF3_PART) / alpha,
            older: BDF3_PART / 3.0 / alpha,
            rate: alpha / h,
        }
    }

    pub(in crate::model::fem) fn place(self, m: &NodalMotion, k: usize) -> Vec2 {
        self.of([&m.positions, &m.previous_positions, &m.older_positions], k)
    }

    pub(in crate::model::fem) fn velocity(self, m: &NodalMotion, k: usize) -> Vec2 {
        self.of([&m.velocities, &m.previous_velocities, &m.older_velocities], k)
    }

    fn of(self, [now, before, older]: [&[Vec2]; 3], k: usize) -> Vec2 {
        let recent = now[k] * self.now - before[k] * self.past;
        if self.older > 0.0 { recent + older[k] * self.older } else { recent }
    }

    /// The weights of a step of `h` (s) after this motion.
    pub(in crate::model::fem) fn of_step(motion: &NodalMotion, h: f64) -> Self {
        if motion.looks_back_three(h) { Self::blended(h) } else { Self::bdf2(h, motion.history_s()) }
    }
}

//! A hand holds a support by a spring whose free end follows the pointer smoothly.
//!
//! A hand at h holds a support at x by a linear spring with a damper beside it,
//! ```text
//! F = k (h − x) + c (ḣ − ẋ)
//! ```
//! so the support is where this force and the cable's pull balance: a hand beyond the cable's
//! length pulls harder and harder but does not get the support there. The support is a node of the
//! cable like any other. With both velocities those of the step, the changes over its time, F = κ
//! (p − x) is a spring again, of stiffness κ = k + c/Δt to a place p, so it is one more term of the
//! energy that a step minimises, convex, and needs no exchange of forces and no limit of the step
//! (`Hand::pull`).

use super::smoothed_target::SmoothedTarget;
use crate::math::{Vec2, larger};
use crate::problem::Problem;
use crate::solution::{HandReport, Warning, WarningCause};

/// Default for the greatest speed of a hand, m/s: that of an arm. Larger: a flick of the mouse over
/// metres of scene, which no real hand could do, breaks the cable; smaller: the support lags behind
/// a deliberate fast motion.
pub(crate) const HAND_SPEED: f64 = 2.0;
/// Default distance of a hand ahead of a support when it carries the whole cable, as a fraction of
/// the cable's length. Smaller: a hand a little beyond the cable's length breaks it at once;
/// larger: the support hangs far below the pointer.
const HAND_GIVE_FRACTION: f64 = 0.01;
/// Damping ratio of the whole cable on a hand's spring; for half of it, which a hand carries, it is
/// 0.35. Less: a cable that was lifted goes on bobbing; more: a hand that starts at its greatest
/// speed pushes the cable by more than that weighs.
const HAND_DAMPING_RATIO: f64 = 0.25;
/// Stiffnesses a hand may have, N/m. Below: it moves nothing; above: its force is rounding.
pub const HAND_STIFFNESSES: std::ops::RangeInclusive<f64> = 1e-3..=1e9;

/// Stiffness of a hand's spring unless asked otherwise, N/m: with the whole load on a cable
/// (weight, wind, loads, what a floor rubs) it is a hundredth of the cable's length ahead, whatever
/// the cable.
#[must_use]
pub fn default_hand_stiffness(problem: &Problem) -> f64 {
    let stiffness =
        larger(problem.force_scale(), problem.max_whole_floor_friction()) / (HAND_GIVE_FRACTION * problem.length);
    stiffness.clamp(*HAND_STIFFNESSES.start(), *HAND_STIFFNESSES.end())
}

/// A hand that holds a support by a spring with a damper beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hand {
    end: SmoothedTarget,
    /// N/m.
    stiffness: f64,
    /// Damping coefficient, N s/m.
    damping: f64,
}

impl Hand {
    /// Grips a support at `at` (m) with the force (N, on the cable) that has held it so far, so
    /// nothing jerks; `stiffness` N/m, by default that of [`default_hand_stiffness`].
    #[must_use]
    pub fn grip(problem: &Problem, stiffness: Option<f64>, at: Vec2, force: Vec2) -> Self {
        let stiffness = stiffness.unwrap_or_else(|| default_hand_stiffness(problem));
        let mass = problem.linear_density * problem.length + problem.supports.iter().map(|s| s.mass).sum::<f64>();
        let damping = 2.0 * HAND_DAMPING_RATIO * (stiffness * mass).sqrt();
        Self { end: SmoothedTarget::at_rest(at + force / stiffness), stiffness, damping }
    }

    /// The free end moves towards `target` (m) for `dt_s`, at most at `fastest` (m/s).
    pub fn follow(&mut self, target: Vec2, dt_s: f64, fastest: f64) {
        self.end.follow(target, dt_s, fastest);
    }

    /// The free end.
    #[must_use]
    pub fn end(&self) -> &SmoothedTarget {
        &self.end
    }

    /// Its force on the cable at the end of a step of `dt_s` as that of a spring without a damper:
    /// stiffness (N/m) and place (m). The free end has made the step already; the support started
    /// from `from` (m).
    #[must_use]
    pub fn pull(&self, dt_s: f64, from: Vec2) -> (f64, Vec2) {
        let rate = self.damping / dt_s;
        let stiffness = self.stiffness + rate;
        let gone = from + self.end.velocity() * dt_s;
        (stiffness, (self.end.position() * self.stiffness + gone * rate) / stiffness)
    }

    /// The report of it in a solution, with its force on the cable, N.
    #[must_use]
    pub fn report(&self, force: Vec2) -> HandReport {
        let end = self.end.position();
        HandReport { x_m: end.x, y_m: end.y, stiffness_n_per_m: self.stiffness, force_x_n: force.x, force_y_n: force.y }
    }

    /// Returns a warning if the hand is behind its target, or the support, at `at` (m), behind the
    /// hand by more than a hundredth of the cable; `force` on the cable in N, `fastest` in m/s.
    #[must_use]
    pub fn warning(
        &self,
        problem: &Problem,
        support: usize,
        arc_length_m: f64,
        at: Vec2,
        force: Vec2,
        fastest: f64,
    ) -> Option<Warning> {
        let name = problem.supports.get(support).map_or("", |s| s.name.as_str());
        let (slow, behind) = (self.end.behind_m(), (self.end.position() - at).norm());
        let lags = behind > HAND_GIVE_FRACTION * problem.length;
        let cause = WarningCause::HandLags {
            support: name.to_owned(),
            behind_m: lags.then_some(behind),
            hand_behind_m: slow,
            pull_n: force.norm(),
            stiffness_n_per_m: self.stiffness,
        };
        let speeds = [self.end.velocity().norm(), fastest];
        (lags || slow > 0.0).then(|| Warning::new(cause, &problem.cable.name, arc_length_m, speeds))
    }
}

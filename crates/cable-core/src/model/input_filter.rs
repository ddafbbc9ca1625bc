//! A dragged support follows a filtered target: a point of limited speed behind three lags. A hand
//! holds a support by a spring whose free end is such a target; a robot leads its hitch exactly.
//!
//! The target comes 60 times a second and jumps. Fed straight into a stiff cable it shakes it:
//! piecewise linear input costs 52–330 % of tension error where a C² curve of the same input costs
//! 1e-4. So the target is followed by a point of limited speed and that through three equal lags,
//! p = (τ d/dt + 1)⁻³ q: position, velocity and acceleration are then continuous whatever the
//! target does.
//!
//! A hand at h holds a support at x by a linear spring with a damper beside it,
//! ```text
//! F = k (h − x) + c (ḣ − ẋ)
//! ```
//! so the support is where this and the cable's pull balance: what is beyond the cable's length is
//! pulled harder and harder, not reached. The support is a node of the cable like any other. With
//! both velocities those of the step, the changes over its time, F = κ (p − x) is a spring again,
//! of stiffness κ = k + c/Δt to a place p, so it is one more term of the energy that a step
//! minimises, convex, and needs no exchange of forces and no limit of the step ([`Hand::pull`]).

use crate::math::{Vec2, larger};
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{HandReport, Warning, WarningCause};

/// Time constant of each lag, s. Smaller: the cable feels the steps of the hand; larger: the
/// support trails the hand by 3τ. Chosen so that the trailing (45 ms) is under three frames.
const LAG_S: f64 = 0.015;

/// Time by which a support trails a target that moves evenly, s.
#[cfg(test)]
const TRAILING_S: f64 = 3.0 * LAG_S;

/// Fastest a hand draws a support unless asked otherwise, m/s: that of an arm. Faster: a flick of
/// the mouse over metres of scene, which no hand could do there, breaks the cable; slower: the
/// support trails a hand that means it.
pub(crate) const HAND_SPEED: f64 = 2.0;

/// The fastest a hand may be asked to be, and a support catches up with its motion after something
/// held it, m/s. Uncapped, a jump of 10 m in a frame loses 77 to 734 steps.
pub const MAX_SPEED: f64 = 20.0;

/// Part of the cable's length that a hand is ahead of a support where it carries the whole cable,
/// unless its stiffness is asked for. Smaller: a hand that is put a little beyond the cable's
/// length breaks it at once; larger: what is drawn hangs far below the pointer.
const HAND_GIVE_FRACTION: f64 = 0.01;

/// Damping ratio of the whole cable on a hand's spring; of half of it, which a hand carries, it is
/// 0.35. Less: a cable that was lifted goes on bobbing; more: a hand that starts at its greatest
/// speed pushes the cable by more than that weighs.
const HAND_DAMPING_RATIO: f64 = 0.25;

/// Stiffnesses a hand may have, N/m. Below: it moves nothing; above: its force is rounding.
pub const HAND_STIFFNESSES: std::ops::RangeInclusive<f64> = 1e-3..=1e9;

/// Below this distance (m) from the target the support is put on it.
const ARRIVED_M: f64 = 1e-9;

/// Returns whether a support is a robot's: it is where the robot is, and does not follow it.
#[must_use]
pub(crate) fn is_led(problem: &Problem, support: usize) -> bool {
    problem.supports.get(support).is_some_and(|s| s.kind == SupportKind::Robot)
}

/// Says that a support is behind the hand that draws it.
#[must_use]
pub(crate) fn held_warning(
    problem: &Problem,
    support: usize,
    arc_length_m: f64,
    f: &SmoothedTarget,
    fastest: f64,
) -> Warning {
    let name = problem.supports.get(support).map_or("", |s| s.name.as_str());
    let cause = WarningCause::Lags { support: name.to_owned(), behind_m: f.behind_m() };
    Warning::new(cause, &problem.cable.name, arc_length_m, [f.velocity().norm(), fastest])
}

/// Stiffness of a hand's spring unless asked otherwise, N/m: with the whole load on a cable
/// (weight, wind, loads, what a floor rubs) it is a hundredth of the cable's length ahead, whatever
/// the cable.
#[must_use]
pub fn default_hand_stiffness(problem: &Problem) -> f64 {
    let floor = problem.floor_friction.map_or(0.0, |(friction, normal)| friction * normal * problem.length);
    let stiffness = larger(problem.force_scale(), floor) / (HAND_GIVE_FRACTION * problem.length);
    stiffness.clamp(*HAND_STIFFNESSES.start(), *HAND_STIFFNESSES.end())
}

/// A hand that holds a support by a spring with a damper beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    end: SmoothedTarget,
    /// N/m.
    stiffness: f64,
    /// N s/m.
    damping: f64,
}

impl Hand {
    /// Takes hold of a support at `at` (m) with the force (N, on the cable) that has held it so
    /// far, so nothing jerks; `stiffness` N/m, by default that of [`default_hand_stiffness`].
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

    /// N/m.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Its force on the cable at the end of a step of `dt_s` that its free end has made, as that of
    /// a spring without a damper: stiffness (N/m) and place (m); the support comes from `from` (m).
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

    /// Returns what is to be said where the hand is behind its target, or the support, at `at` (m),
    /// behind the hand by more than a hundredth of the cable; `force` on the cable in N, `fastest`
    /// in m/s.
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
        let held = behind > HAND_GIVE_FRACTION * problem.length;
        let cause = WarningCause::HandLags {
            support: name.to_owned(),
            behind_m: held.then_some(behind),
            hand_behind_m: slow,
            pull_n: force.norm(),
            stiffness_n_per_m: self.stiffness,
        };
        let speeds = [self.end.velocity().norm(), fastest];
        (held || slow > 0.0).then(|| Warning::new(cause, &problem.cable.name, arc_length_m, speeds))
    }
}

/// The follower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothedTarget {
    stages: [Vec2; 4],
    velocity: Vec2,
    /// Distance to its target at which it was left because it may be no faster, m.
    behind_m: f64,
}

impl SmoothedTarget {
    /// At rest at a point, m.
    #[must_use]
    pub fn at_rest(at: Vec2) -> Self {
        Self { stages: [at; 4], velocity: Vec2::zeros(), behind_m: 0.0 }
    }

    /// At a point (m), moving evenly (m/s): it goes on, and slows down.
    #[must_use]
    pub fn moving(at: Vec2, velocity: Vec2) -> Self {
        let stages = [3.0, 2.0, 1.0, 0.0].map(|lags| at + velocity * (lags * LAG_S));
        Self { stages, velocity, behind_m: 0.0 }
    }

    /// Returns where it is, m.
    #[must_use]
    pub fn position(&self) -> Vec2 {
        self.stages[3]
    }

    /// Its velocity over the last step, m/s.
    #[must_use]
    pub fn velocity(&self) -> Vec2 {
        self.velocity
    }

    /// Returns how far from its target the last step left it because it may be no faster, m; 0
    /// where it was fast enough.
    #[must_use]
    pub(crate) fn behind_m(&self) -> f64 {
        self.behind_m
    }

    /// Moves towards `target` (m) for `dt_s`, at most at `fastest` (m/s).
    pub fn follow(&mut self, target: Vec2, dt_s: f64, fastest: f64) {
        let before = self.position();
        let way = target - self.stages[0];
        let (distance, most) = (way.norm(), fastest * dt_s);
        let capped = distance > most;
        self.stages[0] = if capped { self.stages[0] + way * (most / distance) } else { target };
        let share = 1.0 - (-dt_s / LAG_S).exp();
        for k in 1..4 {
            let step = (self.stages[k - 1] - self.stages[k]) * share;
            self.stages[k] += step;
        }
        if self.stages.iter().all(|s| (s - target).norm() < ARRIVED_M) {
            self.stages = [target; 4];
        }
        self.velocity = (self.position() - before) / dt_s;
        self.behind_m = if capped { (target - self.position()).norm() } else { 0.0 };
    }

    /// Goes this part of the way to `target` (m) in `dt_s`: led, it does not trail.
    pub fn lead(&mut self, target: Vec2, part: f64, dt_s: f64) {
        let before = self.position();
        let to = if part < 1.0 { before + (target - before) * part } else { target };
        *self = Self { stages: [to; 4], velocity: (to - before) / dt_s, behind_m: 0.0 };
    }

    /// Takes the point where it was stopped instead (m): it starts again from there, at rest.
    pub(crate) fn stop_at(&mut self, at: Vec2) {
        *self = Self::at_rest(at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_arrives_smoothly_and_never_too_fast() {
        let (target, dt) = (Vec2::new(10.0, 0.0), 1.0 / 240.0);
        let mut f = SmoothedTarget::at_rest(Vec2::zeros());
        let (mut v, mut capped) = (Vec2::zeros(), 0);
        for _ in 0..300 {
            f.follow(target, dt, MAX_SPEED);
            capped += usize::from(f.behind_m() > 0.0);
            assert!(f.velocity().norm() <= MAX_SPEED * (1.0 + 1e-12));
            // The acceleration of three lags of a 20 m/s ramp stays below 20/(e·τ).
            assert!((f.velocity() - v).norm() / dt < MAX_SPEED / LAG_S);
            v = f.velocity();
        }
        assert_eq!(f.position(), target);
        assert_eq!(capped, 119);
    }

    #[test]
    fn a_hand_is_as_fast_as_it_may_be() {
        let mut f = SmoothedTarget::at_rest(Vec2::zeros());
        for _ in 0..240 {
            f.follow(Vec2::new(10.0, 0.0), 1.0 / 240.0, HAND_SPEED);
            assert!(f.velocity().norm() <= HAND_SPEED * (1.0 + 1e-12));
        }
        // After a second, less what it trails.
        assert!((f.behind_m() - (8.0 + HAND_SPEED * TRAILING_S)).abs() < 0.02, "{}", f.behind_m());
    }
}

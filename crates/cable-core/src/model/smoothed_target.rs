//! A dragged support follows a smoothed target: a point of limited speed behind three lags.
//!
//! The target comes 60 times a second and jumps. Applied directly to a stiff cable it would shake
//! it: piecewise linear input costs 52–330 % of tension error where a C² curve of the same input
//! costs 1e-4. So the target is followed by a point of limited speed and that through three equal
//! lags, p = (τ d/dt + 1)⁻³ q: position, velocity and acceleration are then continuous whatever the
//! target does. A robot moves its hitch exactly.

use crate::math::Vec2;
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{Warning, WarningCause};

/// Time constant of each lag, s. Smaller: the cable feels the steps of the hand; larger: the
/// support trails the hand by 3τ. Chosen so that the trailing (45 ms) is under three frames.
const LAG_S: f64 = 0.015;

/// Time by which a support trails a target that moves evenly, s.
#[cfg(test)]
const TRAILING_S: f64 = 3.0 * LAG_S;
/// Greatest speed limit of a hand, and speed at which a support catches up with its motion after it
/// was held back, m/s. Without it a jump of 10 m in a frame loses 77 to 734 steps.
pub const MAX_SPEED: f64 = 20.0;
/// Greatest speed at which an edit of a moving cable takes effect, m/s: a support goes to its new
/// place, and the unstretched length changes, as a slow winch does it. Larger: taut cables are
/// jerked (1118 N for 93 N at 2 m/s), and a shallow span that is let out falls free. Smaller: an
/// edit takes long to show.
pub(crate) const EDIT_SPEED: f64 = 0.5;
/// Speed below which a cable lies still, m/s. Larger: an edit stops slow motion; smaller: one of a
/// cable that trembles leaves its bars out of balance.
pub(crate) const STILL_M_PER_S: f64 = 1e-3;
/// Below this distance (m) from the target the support is put on it.
const ARRIVED_M: f64 = 1e-9;

/// Returns whether a support is on the robot: it has the robot's position exactly, without lag.
#[must_use]
pub(crate) fn is_led(problem: &Problem, support: usize) -> bool {
    problem.supports.get(support).is_some_and(|s| s.kind == SupportKind::Robot)
}

/// A warning of a support that lags behind the hand that drags it.
#[must_use]
pub(crate) fn lag_warning(
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

/// The follower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothedTarget {
    stages: [Vec2; 4],
    velocity: Vec2,
    /// Distance to its target that remains because of its speed limit, m.
    behind_m: f64,
}

impl SmoothedTarget {
    /// A follower at rest at a point, m.
    #[must_use]
    pub fn at_rest(at: Vec2) -> Self {
        Self { stages: [at; 4], velocity: Vec2::zeros(), behind_m: 0.0 }
    }

    /// A follower at a point (m) with a velocity (m/s), from which it slows down.
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

    /// Returns the distance to its target after the last step that remains because of its speed
    /// limit, m; 0 if it was fast enough.
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

    /// Moves by this fraction of the way to `target` (m) in `dt_s`, without lag.
    pub fn lead(&mut self, target: Vec2, part: f64, dt_s: f64) {
        let before = self.position();
        let to = if part < 1.0 { before + (target - before) * part } else { target };
        *self = Self { stages: [to; 4], velocity: (to - before) / dt_s, behind_m: 0.0 };
    }

    /// Restarts it at rest from the point (m) where it was stopped.
    pub(crate) fn stop_at(&mut self, at: Vec2) {
        *self = Self::at_rest(at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Greatest speed of a hand, m/s.
    const GREATEST_HAND_SPEED_M_PER_S: f64 = 2.0;

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
            f.follow(Vec2::new(10.0, 0.0), 1.0 / 240.0, GREATEST_HAND_SPEED_M_PER_S);
            assert!(f.velocity().norm() <= GREATEST_HAND_SPEED_M_PER_S * (1.0 + 1e-12));
        }
        // After a second, less what it trails.
        assert!((f.behind_m() - (8.0 + GREATEST_HAND_SPEED_M_PER_S * TRAILING_S)).abs() < 0.02, "{}", f.behind_m());
    }
}

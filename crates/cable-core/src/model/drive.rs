//! A support dragged by hand: a smooth follower of a jumping target, no faster than a hand.
//!
//! The target comes 60 times a second and jumps. Fed straight into a stiff cable it shakes it: piecewise linear
//! input costs 52–330 % of tension error where a C² curve of the same input costs 1e-4. So the target is
//! followed by a point of limited speed and that through three equal lags, p = (τ d/dt + 1)⁻³ q: position,
//! velocity and acceleration are then continuous whatever the target does.

use crate::math::Vec2;
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{Warning, WarningKind};

/// Time constant of each lag, s. Smaller: the cable feels the steps of the hand; larger: the support trails the
/// hand by 3τ. Chosen so that the trailing (45 ms) is under three frames.
const LAG: f64 = 0.015;

/// How long a support trails a target that moves evenly, s.
pub const TRAILING_S: f64 = 3.0 * LAG;

/// Fastest a hand draws a support unless asked otherwise, m/s: that of an arm. Faster: a flick of the mouse over metres of scene, which no
/// hand could do there, breaks the cable; slower: the support trails a hand that means it.
pub const HAND_SPEED: f64 = 2.0;

/// The fastest a hand may be asked to be, a robot may be followed, and a support catches up with its motion after something held it, m/s.
/// Uncapped, a jump of 10 m in a frame loses 77 to 734 steps.
pub const MAX_SPEED: f64 = 20.0;

/// Below this distance (m) from the target the support is put on it.
const ARRIVED: f64 = 1e-9;

/// The fastest that a support follows what draws it, m/s: a hand, or a robot.
#[must_use]
pub fn fastest(problem: &Problem, support: usize, hand: f64) -> f64 {
    match problem.supports.get(support) {
        Some(s) if s.kind == SupportKind::Robot => MAX_SPEED,
        _ => hand,
    }
}

/// Says that a support is behind the hand that draws it.
#[must_use]
pub fn held_warning(problem: &Problem, support: usize, arc_length_m: f64, (f, fastest): (&Follower, f64)) -> Warning {
    let name = problem.supports.get(support).map_or("", |s| s.name.as_str());
    let behind = f.behind_m();
    let message =
        format!("support `{name}` is {behind:.2} m behind where it is drawn to: it follows at {fastest} m/s at most");
    let speeds = [f.velocity().norm(), fastest];
    Warning::new(WarningKind::SupportHeld, &problem.cable.name, arc_length_m, speeds, message)
}

/// The follower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follower {
    stages: [Vec2; 4],
    velocity: Vec2,
    /// How far from its target it was left because it may be no faster, m.
    behind_m: f64,
}

impl Follower {
    /// At rest at a point, m.
    #[must_use]
    pub fn at_rest(at: Vec2) -> Self {
        Self { stages: [at; 4], velocity: Vec2::zeros(), behind_m: 0.0 }
    }

    /// Where it is, m.
    #[must_use]
    pub fn position(&self) -> Vec2 {
        self.stages[3]
    }

    /// Its velocity over the last step, m/s.
    #[must_use]
    pub fn velocity(&self) -> Vec2 {
        self.velocity
    }

    /// How far from its target the last step left it because it may be no faster, m; 0 where it was fast enough.
    #[must_use]
    pub fn behind_m(&self) -> f64 {
        self.behind_m
    }

    /// Moves towards `target` (m) for `dt_s`, at most at `fastest` (m/s).
    pub fn follow(&mut self, target: Vec2, dt_s: f64, fastest: f64) {
        let before = self.position();
        let way = target - self.stages[0];
        let (distance, most) = (way.norm(), fastest * dt_s);
        let capped = distance > most;
        self.stages[0] = if capped { self.stages[0] + way * (most / distance) } else { target };
        let share = 1.0 - (-dt_s / LAG).exp();
        for k in 1..4 {
            let step = (self.stages[k - 1] - self.stages[k]) * share;
            self.stages[k] += step;
        }
        if self.stages.iter().all(|s| (s - target).norm() < ARRIVED) {
            self.stages = [target; 4];
        }
        self.velocity = (self.position() - before) / dt_s;
        self.behind_m = if capped { (target - self.position()).norm() } else { 0.0 };
    }

    /// Where it was stopped instead (m): it starts again from there, at rest.
    pub fn stop_at(&mut self, at: Vec2) {
        *self = Self::at_rest(at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_arrives_smoothly_and_never_too_fast() {
        let (target, dt) = (Vec2::new(10.0, 0.0), 1.0 / 240.0);
        let mut f = Follower::at_rest(Vec2::zeros());
        let (mut v, mut capped) = (Vec2::zeros(), 0);
        for _ in 0..300 {
            f.follow(target, dt, MAX_SPEED);
            capped += usize::from(f.behind_m() > 0.0);
            assert!(f.velocity().norm() <= MAX_SPEED * (1.0 + 1e-12));
            // The acceleration of three lags of a 20 m/s ramp stays below 20/(e·τ).
            assert!((f.velocity() - v).norm() / dt < MAX_SPEED / LAG);
            v = f.velocity();
        }
        assert_eq!(f.position(), target);
        assert_eq!(capped, 119);
    }

    #[test]
    fn a_hand_is_as_fast_as_it_may_be() {
        let mut f = Follower::at_rest(Vec2::zeros());
        for _ in 0..240 {
            f.follow(Vec2::new(10.0, 0.0), 1.0 / 240.0, HAND_SPEED);
            assert!(f.velocity().norm() <= HAND_SPEED * (1.0 + 1e-12));
        }
        // After a second, less what it trails.
        assert!((f.behind_m() - (8.0 + HAND_SPEED * TRAILING_S)).abs() < 0.02, "{}", f.behind_m());
    }
}

//! A support dragged by hand: a smooth, capped follower of a jumping target.
//!
//! The target comes 60 times a second and jumps. Fed straight into a stiff cable it shakes it: piecewise linear
//! input costs 52–330 % of tension error where a C² curve of the same input costs 1e-4. So the target is
//! followed by a point of limited speed and that through three equal lags, p = (τ d/dt + 1)⁻³ q: position,
//! velocity and acceleration are then continuous whatever the target does.

use crate::math::Vec2;

/// Time constant of each lag, s. Smaller: the cable feels the steps of the hand; larger: the support trails the
/// hand by 3τ. Chosen so that the trailing (45 ms) is under three frames.
const LAG: f64 = 0.015;

/// How long a support trails a target that moves evenly, s.
pub const TRAILING_S: f64 = 3.0 * LAG;

/// Largest speed of a dragged support, m/s. Uncapped, a jump of 10 m in a frame loses 77 to 734 steps.
pub const MAX_SPEED: f64 = 20.0;

/// Below this distance (m) from the target the support is put on it.
const ARRIVED: f64 = 1e-9;

/// The follower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follower {
    stages: [Vec2; 4],
    velocity: Vec2,
}

impl Follower {
    /// At rest at a point, m.
    #[must_use]
    pub fn at_rest(at: Vec2) -> Self {
        Self { stages: [at; 4], velocity: Vec2::zeros() }
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

    /// Moves towards `target` (m) for `dt_s`; returns whether the speed was capped.
    pub fn follow(&mut self, target: Vec2, dt_s: f64) -> bool {
        let before = self.position();
        let way = target - self.stages[0];
        let (distance, most) = (way.norm(), MAX_SPEED * dt_s);
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
        capped
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
            capped += usize::from(f.follow(target, dt));
            assert!(f.velocity().norm() <= MAX_SPEED * (1.0 + 1e-12));
            // The acceleration of three lags of a 20 m/s ramp stays below 20/(e·τ).
            assert!((f.velocity() - v).norm() / dt < MAX_SPEED / LAG);
            v = f.velocity();
        }
        assert_eq!(f.position(), target);
        assert_eq!(capped, 119);
    }
}

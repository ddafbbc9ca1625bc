//! The end speed of the robot at which robot and cables agree is a fixed point, which is sought by
//! regula falsi from trial steps.
//!
//! In a step the robot comes to the speed v'; the cables then pull with S(v'), and the balance of
//! the robot makes of that a speed V(S(v')). Sought is
//! ```text
//! v' = V(S(v'))
//! ```
//! A faster robot is pulled back harder, so V∘S falls as v' grows: there is one such speed, between
//! any that comes out too fast and any that comes out too slow. It is sought by the secant through
//! the last two trials, and halfway between where that leaves them (regula falsi with bisection: G.
//! Dahlquist and Å. Björck, "Numerical Methods", Prentice-Hall, 1974). What the governor
//! reaches anyway needs one trial, a cable that pulls evenly harder one or two.

/// Trials of a step. Fewer: a robot that squeezes its cable against a wall is stopped a little
/// early, out of balance, which is warned of; more: that takes longer.
const MAX_TRIALS: usize = 12;

/// Speeds that come out too slow and too fast are the same when they are this near to each other,
/// m/s: what presses between robot and wall jumps there.
const SPEED_TOLERANCE: f64 = 1e-4;

/// A trial of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    /// Speed at its end, m/s.
    pub speed: f64,
    /// Excess of the speed that comes out, m/s.
    pub excess_speed: f64,
}

/// The outcome of looking for the next speed to try.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NextTrial {
    /// This one, m/s.
    Speed(f64),
    /// Forces jump at the speed of the last trial: none lies between.
    Jump,
    /// No trial is left.
    RanOut,
}

/// Knowledge of the speed that is sought.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpeedSearch {
    left: usize,
    last: Option<Trial>,
    /// The fastest that comes out faster, and the slowest that comes out slower.
    low: Option<f64>,
    high: Option<f64>,
}

impl SpeedSearch {
    pub fn new() -> Self {
        Self { left: MAX_TRIALS, last: None, low: None, high: None }
    }

    /// Looks for the next speed to try after a trial.
    pub fn next(&mut self, now: Trial) -> NextTrial {
        let Some(left) = self.left.checked_sub(1) else { return NextTrial::RanOut };
        self.left = left;
        let before = self.last.replace(now);
        match now.excess_speed > 0.0 {
            true => self.low = Some(now.speed),
            false => self.high = Some(now.speed),
        }
        if let (Some(low), Some(high)) = (self.low, self.high)
            && high - low < SPEED_TOLERANCE
        {
            return NextTrial::Jump;
        }
        let slope = before.map_or(-1.0, |b| (now.excess_speed - b.excess_speed) / (now.speed - b.speed));
        let wanted = now.speed - now.excess_speed / if slope < -1.0 { slope } else { -1.0 };
        NextTrial::Speed(match (self.low, self.high) {
            (Some(low), Some(high)) if !(low < wanted && wanted < high) => 0.5 * (low + high),
            // A force that would throw it back stops it first.
            (None, Some(high)) if wanted < 0.0 && 0.0 < high => 0.0,
            (Some(low), None) if wanted > 0.0 && 0.0 > low => 0.0,
            _ => wanted,
        })
    }
}

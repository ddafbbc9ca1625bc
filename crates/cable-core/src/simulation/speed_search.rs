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
//! the last two trials where that leaves less than half of what lay between these two trials ago,
//! and halfway between otherwise (after R. P. Brent, "Algorithms for Minimization without
//! Derivatives", Prentice-Hall, 1973, chapter 4): where a cable is squeezed between robot and
//! ground a speed comes out that is flat on one side and steep on the other, and a secant alone
//! comes from one side for ever. What the governor reaches anyway needs one trial, a cable that
//! pulls evenly harder one or two.

/// Trials of a step. Halving alone takes two for each of the 30 halvings of a metre a second down
/// to [`SPEED_TOLERANCE`], and a trial between each two of them. Fewer: a robot that squeezes its
/// cable against a wall is out of balance, which is warned of; more: none is ever made.
const MAX_TRIALS: usize = 60;

/// Speeds that come out too slow and too fast are the same when they are this near to each other,
/// m/s: what presses between robot and wall jumps there. Greater: a cable that is squeezed is taken
/// for a wall; less: rounding of its forces is sought.
const SPEED_TOLERANCE: f64 = 1e-9;

/// A trial of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpeedTrial {
    /// Speed at its end, m/s.
    pub speed: f64,
    /// Excess of the speed that comes out, m/s.
    pub excess_speed: f64,
}

/// Knowledge of the speed that is sought.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpeedSearch {
    left: usize,
    last: Option<SpeedTrial>,
    /// The fastest that comes out faster, and the slowest that comes out slower.
    low: Option<f64>,
    high: Option<f64>,
    /// Distance between these before each of the last two trials, m/s.
    widths: [f64; 2],
}

impl SpeedSearch {
    pub fn new() -> Self {
        Self { left: MAX_TRIALS, last: None, low: None, high: None, widths: [f64::INFINITY; 2] }
    }

    /// The next speed to try after a trial, m/s; `None` if the force jumps between the remaining
    /// speeds, or no trial is left.
    pub fn next(&mut self, now: SpeedTrial) -> Option<f64> {
        self.left = self.left.checked_sub(1)?;
        let before = self.last.replace(now);
        match now.excess_speed > 0.0 {
            true => self.low = Some(now.speed),
            false => self.high = Some(now.speed),
        }
        let slope = before.map_or(-1.0, |b| (now.excess_speed - b.excess_speed) / (now.speed - b.speed));
        let wanted = now.speed - now.excess_speed / if slope < -1.0 { slope } else { -1.0 };
        Some(match (self.low, self.high) {
            (Some(low), Some(high)) => {
                let width = high - low;
                if width < SPEED_TOLERANCE {
                    return None;
                }
                let stalls = width > 0.5 * self.widths[0];
                self.widths = [self.widths[1], width];
                if low < wanted && wanted < high && !stalls { wanted } else { 0.5 * (low + high) }
            }
            // A force that would throw it back stops it first.
            (None, Some(high)) if wanted < 0.0 && 0.0 < high => 0.0,
            (Some(low), None) if wanted > 0.0 && 0.0 > low => 0.0,
            _ => wanted,
        })
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, clippy::panic)] // a failing test is meant to panic
mod tests {
    use super::*;

    /// Trials until the excess speed is below a part of the first, and the speed; None if there is
    /// none.
    fn trials(excess_speed: impl Fn(f64) -> f64, mut speed: f64) -> (usize, Option<f64>) {
        let (mut search, first) = (SpeedSearch::new(), excess_speed(speed).abs());
        for count in 1.. {
            let now = SpeedTrial { speed, excess_speed: excess_speed(speed) };
            if now.excess_speed.abs() < 1e-3 * first {
                return (count, Some(speed));
            }
            match search.next(now) {
                Some(next) => speed = next,
                None => return (count, None),
            }
        }
        unreachable!("trials run out")
    }

    #[test]
    fn an_even_pull_needs_two_or_three_trials() {
        let (count, found) = trials(|v| 0.5 - 4.0 * v - v, 0.6);
        let speed = found.expect("a speed");
        assert!(count <= 3 && (speed - 0.1).abs() < 1e-3, "{count}: {speed}");
    }

    /// A squeezed cable presses with the logarithm of a gap that closes from a certain speed on,
    /// and not at all below that speed. With twelve trials and the secant wherever it lay between
    /// the last two, such steps ended with unbalanced forces of kilonewtons.
    #[test]
    fn a_cable_that_is_squeezed_is_balanced() {
        for closes_at in [0.3, 0.011, 2.3e-3] {
            for stiffness in [1e-3, 1.0, 1e3] {
                let press = |v: f64| {
                    let gap = (closes_at - v) / 1e-3;
                    if gap >= 1.0 {
                        0.0
                    } else if gap <= 0.0 {
                        1e9
                    } else {
                        -stiffness * gap.ln() * (1.0 - gap)
                    }
                };
                let (count, found) = trials(|v| 0.6 - press(v) - v, 0.6);
                let speed = found.unwrap_or_else(|| panic!("{closes_at} {stiffness}"));
                assert!(count <= 45 && speed < closes_at, "{closes_at} {stiffness}: {count} trials, {speed} m/s");
            }
        }
    }

    /// A wall: no speed has a balance.
    #[test]
    fn forces_that_jump_end_where_they_do() {
        let (count, found) = trials(|v| if v < 0.2 { 0.4 } else { -3.0 }, 0.5);
        assert!(found.is_none() && count <= MAX_TRIALS, "{count}: {found:?}");
    }
}

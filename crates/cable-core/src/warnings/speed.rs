//! Speeds beyond those for which the models are made.

use crate::math::larger;
use crate::model::MAX_SPEED;
use crate::solution::{CableSolution, Warning, WarningCause};

/// Relative excess over the greatest speed that is rounding: a speed that was cut is that speed.
/// Smaller: every cut speed is warned of; larger: nothing else.
const SPEED_ROUNDING_FRACTION: f64 = 1e-9;

/// Warns of the fastest node of a cable that moves faster than any model stands for: a huge force
/// has thrown it about.
pub(super) fn warn(cable: &str, answer: &CableSolution, out: &mut Vec<Warning>) {
    let speed = |n: &crate::solution::Node| n.vx_m_per_s.hypot(n.vy_m_per_s);
    let fastest = answer.nodes.iter().map(speed).fold(0.0, larger);
    if fastest > MAX_SPEED * (1.0 + SPEED_ROUNDING_FRACTION)
        && let Some(n) = answer.nodes.iter().find(|n| speed(n) >= fastest)
    {
        let warning = Warning::new(WarningCause::TooFast, cable, n.arc_length_m, [fastest, MAX_SPEED]);
        out.push(warning.at([n.x_m, n.y_m]));
    }
}

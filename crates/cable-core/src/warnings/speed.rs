//! Speeds beyond those for which the models are made.

use crate::math::larger;
use crate::model::MAX_SPEED;
use crate::solution::{CableSolution, Warning, WarningCause};

/// Warns of the fastest node of a cable that moves faster than any model stands for: a huge force
/// has thrown it about.
pub(super) fn warn(cable: &str, answer: &CableSolution, out: &mut Vec<Warning>) {
    let speed = |n: &crate::solution::Node| n.vx_m_per_s.hypot(n.vy_m_per_s);
    let fastest = answer.nodes.iter().map(speed).fold(0.0, larger);
    // A speed that was cut is the limit to its rounding.
    if fastest > MAX_SPEED * (1.0 + 1e-9)
        && let Some(n) = answer.nodes.iter().find(|n| speed(n) >= fastest)
    {
        let warning = Warning::new(WarningCause::TooFast, cable, n.arc_length_m, [fastest, MAX_SPEED]);
        out.push(warning.at([n.x_m, n.y_m]));
    }
}

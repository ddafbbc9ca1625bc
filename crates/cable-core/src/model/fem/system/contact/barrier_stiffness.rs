//! The stiffness of the barrier follows the greatest tension of the cable from step to step: a
//! stiffer cable is pressed harder against an obstacle, and the gap must not drown in rounding.

use crate::contact::barrier::Barrier;
use crate::math::bounded;
use crate::model::fem::settings::ContactTuning;

/// Lets the barrier's stiffness follow the greatest tension (N) beside the normal force of an even
/// bar on flat ground, `bar_weight` (N). `up` and `down` bound the factor by which it changes; what
/// follows is multiplied by `ahead`.
pub(super) fn follow_tension(
    barrier: &mut Barrier,
    tuning: &ContactTuning,
    [tension, bar_weight]: [f64; 2],
    [up, down]: [f64; 2],
    ahead: f64,
) {
    let ContactTuning { stiffness_weights, stiffness_tensions, .. } = *tuning;
    let least = stiffness_weights * bar_weight;
    let wanted = if stiffness_tensions * tension > least { stiffness_tensions * tension } else { least };
    let now = barrier.stiffness;
    barrier.stiffness = bounded(wanted * ahead, now * down, now * up);
}

//! The stiffness of the barrier follows the greatest tension of the cable from step to step: a
//! tighter cable is pressed harder against an obstacle, and the gap must not be lost in round-off.

use crate::contact::barrier::Barrier;
use crate::math::bounded;
use crate::model::fem::settings::ContactTuning;

/// Adapts the barrier's stiffness to the greatest tension (N) and the normal force of an even bar
/// on flat ground, `bar_weight` (N), with the tension multiplied by `ahead`. `up` and `down` bound
/// the factor of the change.
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

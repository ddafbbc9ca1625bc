//! Motions of supports that are too fast to be followed while masses move are refused.

use crate::error::Unsupported;
use crate::problem::SupportPoint;

/// Fastest motion of a support that is followed while masses move, m/s. Slower: motions are refused
/// that every model follows; faster: `mass-spring` cuts velocities, and air, which no model has,
/// would rule.
const MAX_SUPPORT_SPEED: f64 = 300.0;

/// Returns what is to be said of a motion that is too fast.
pub(super) fn too_fast(support: &SupportPoint) -> Option<Unsupported> {
    let (speed_m_per_s, time_s) = support.motion.as_ref()?.fastest();
    (speed_m_per_s > MAX_SUPPORT_SPEED).then(|| Unsupported::MotionTooFast {
        support: support.name.clone(),
        speed_m_per_s,
        time_s,
        limit_m_per_s: MAX_SUPPORT_SPEED,
    })
}

//! Motions of supports that are too fast to be followed while masses move are refused.

use crate::error::Unsupported;
use crate::model::MAX_SPEED;
use crate::problem::SupportPoint;

/// Returns what is to be said of a motion that is too fast.
pub(super) fn too_fast(support: &SupportPoint) -> Option<Unsupported> {
    let (speed_m_per_s, time_s) = support.motion.as_ref()?.fastest();
    (speed_m_per_s > MAX_SPEED).then(|| Unsupported::MotionTooFast {
        support: support.name.clone(),
        speed_m_per_s,
        time_s,
        limit_m_per_s: MAX_SPEED,
    })
}

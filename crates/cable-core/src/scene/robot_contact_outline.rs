//! The outline of the robot as a cable meets it, which is not quite the one that is drawn.

use super::library::preset::RobotPreset;
use super::robot::Heading;
use crate::math::Vec2;

/// Distance in front of its hitch at which the outline of a robot begins that a cable meets, m: the
/// arm that the cable hangs on. Less: the cable bends round the edge of its own robot at the first
/// element; more: it hangs through what is drawn.
const HITCH_ROOM_M: f64 = 0.1;
/// Depth below its tracks to which the outline of a robot reaches, m. Less: a cable gets under an
/// end of it that lifts, and is squeezed there; more: what lies in a ditch that it bridges is
/// pushed along.
const BELOW_GROUND_M: f64 = 0.2;

impl RobotPreset {
    /// Corners of what a cable meets of it, in its own axes, m: the outline as drawn, but
    /// - cut back round the hitch, so that the cable leaves freely;
    /// - with its tracks as boxes that reach below the ground: a cable that lies there is pushed
    ///   along and not drawn in under their ramps, nor under an end that lifts where the ground is
    ///   hollow.
    #[must_use]
    pub fn meets_cable_m(&self, heading: Heading) -> Vec<Vec2> {
        let rear = HITCH_ROOM_M - self.hitch_back_m.value;
        let n = self.outline_m.len();
        let on_ground = |k: usize| self.outline_m.get(k % n.max(1)).is_some_and(|p| p[1] <= 1e-9);
        let corner = |k: usize| {
            let [x, y] = self.outline_m[k];
            let ramp = on_ground(k + 1) || on_ground(k + n - 1);
            let x = if x < rear { rear } else { x };
            let low = ramp || on_ground(k);
            Vec2::new(if heading == Heading::Left { -x } else { x }, if low { -BELOW_GROUND_M } else { y })
        };
        (0..n).map(corner).collect()
    }
}

//! On which side a cable passes a wheel, and how far its way turns about it: one rule for every
//! model.

use std::f64::consts::PI;

use crate::math::{Vec2, angle};
use crate::scene::PulleySide;

/// Rounding error of a turn, rad: a way straight back may lack so much of half a turn.
pub(crate) const TURN_ROUNDING: f64 = 1e-9;

/// Returns on which side of its wheel a cable runs, seen along it: 1 on the left (it turns
/// clockwise), −1 on the right. Over means above where it travels to the right; `travel` leads from
/// what holds it before to what holds it after.
pub(crate) fn facing(side: PulleySide, travel: Vec2) -> f64 {
    let right = if travel.x < 0.0 { -1.0 } else { 1.0 };
    match side {
        PulleySide::Over => right,
        PulleySide::Under => -right,
    }
}

/// Returns how far a way that arrives at the centre of a wheel along one vector and leaves it along
/// another turns about the wheel, passed on the side `facing`: rad in (−π, π]. Less than nothing
/// where the way turns away from the wheel, so that a cable pulled taut leaves it. Straight back is
/// half a turn round the wheel, as of two tails that hang from it.
///
/// The tangents of a cable that touches the wheel give its turn but for whole turns. Each is within
/// a quarter turn of the way here, so that this turn settles their number.
pub(crate) fn turn_through_centre(facing: f64, arrive: Vec2, leave: Vec2) -> f64 {
    let turn = -facing * angle(arrive, leave);
    if turn < TURN_ROUNDING - PI { turn + 2.0 * PI } else { turn }
}

/// An angle brought to the 2π around `near`, rad.
pub(crate) fn angle_near(angle: f64, near: f64) -> f64 {
    angle - 2.0 * PI * ((angle - near) / (2.0 * PI)).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_turns_about_a_wheel_or_away_from_it() {
        let way = |degrees: f64| Vec2::new(degrees.to_radians().cos(), degrees.to_radians().sin());
        let over = facing(PulleySide::Over, Vec2::x());
        for (arrive, leave, turn) in [
            (40.0, -70.0, 110.0),
            (-40.0, 70.0, -110.0),
            (90.0, -90.0, 180.0),
            (-89.0, 89.0, -178.0),
            (10.0, 10.0, 0.0),
        ] {
            let found = turn_through_centre(over, way(arrive), way(leave)).to_degrees();
            assert!((found - turn).abs() < 1e-9, "from {arrive}° to {leave}°: {found}°, not {turn}°");
            // Seen in a mirror, and from its other end.
            for other in [(180.0 - arrive, 180.0 - leave), (leave + 180.0, arrive + 180.0)] {
                let mirrored = turn_through_centre(-over, way(other.0), way(other.1)).to_degrees();
                assert!((mirrored - turn).abs() < 1e-9, "{other:?}: {mirrored}°, not {turn}°");
            }
        }
        // Straight back, whichever sign rounding gives the angle.
        for facing in [1.0, -1.0] {
            assert_eq!(turn_through_centre(facing, Vec2::y(), -Vec2::y()), PI);
        }
    }
}

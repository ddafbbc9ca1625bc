//! A support that changes its kind gets what the new kind needs and loses what it cannot have.

use cable_core::math::Point;
use cable_core::scene::SupportKind;
use cable_core::{Scene, Support};

/// The kinds in the order of the picker, with name and explanation.
pub const KINDS: [(SupportKind, &str, &str); 6] = [
    (SupportKind::Fixed, "Fixed", "Held at a point, free to turn"),
    (SupportKind::Clamped, "Clamped", "Held at a point and in a direction"),
    (SupportKind::Pulley, "Pulley", "The cable slides through a point or round a wheel"),
    (SupportKind::Load, "Load", "A free point with a dead load"),
    (SupportKind::Robot, "Robot", "Hangs on the robot's hitch"),
    (SupportKind::Free, "Free", "Nothing holds it"),
];

/// The part of a cable that a support holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupportPlace {
    /// Its start or its end.
    CableEnd,
    /// A point between them.
    Between,
}

/// Returns why a kind cannot be chosen here, if it cannot.
#[must_use]
pub fn refusal(kind: SupportKind, place: SupportPlace, scene: &Scene) -> Option<&'static str> {
    match kind {
        SupportKind::Pulley if place == SupportPlace::CableEnd => {
            Some("A pulley cannot hold an end: the cable slides through")
        }
        SupportKind::Free if place == SupportPlace::Between => Some("Only an end of the cable can be free"),
        SupportKind::Robot if scene.robot.is_none() => Some("The scene has no robot"),
        _ => None,
    }
}

/// Force a support gets when it becomes a load, N: shows in every scene and breaks no cable of the
/// presets.
const FIRST_LOAD_N: Point = [0.0, -10.0];

/// The support as another kind. `at_m` and `arc_length_m` are where it is at present.
#[must_use]
pub fn of_kind(support: &Support, kind: SupportKind, at_m: Point, arc_length_m: f64, place: SupportPlace) -> Support {
    let mut new = Support::new(support.name.clone(), kind);
    let has_place = matches!(kind, SupportKind::Fixed | SupportKind::Clamped | SupportKind::Pulley);
    if has_place {
        new.at_m = support.at_m.or(Some(at_m));
        new.motion.clone_from(&support.motion);
    }
    if has_place || kind == SupportKind::Robot {
        new.release_s = support.release_s;
    }
    // A support between the ends states its arc length; those at the ends have none.
    let grips = !matches!(kind, SupportKind::Pulley | SupportKind::Free);
    if grips && place == SupportPlace::Between {
        new.arc_length_m = support.arc_length_m.or(Some(arc_length_m));
    }
    match kind {
        SupportKind::Clamped => new.angle_deg = support.angle_deg.or(Some(0.0)),
        SupportKind::Pulley => {
            new.radius_m = support.radius_m;
            new.side = support.side;
            new.friction = support.friction;
        }
        SupportKind::Load => {
            new.times_s.clone_from(&support.times_s);
            new.forces_n.clone_from(&support.forces_n);
            let constant = support.force_n.or(Some(FIRST_LOAD_N));
            new.force_n = if new.times_s.is_empty() { constant } else { None };
            new.mass_kg = support.mass_kg;
        }
        SupportKind::Free => new.mass_kg = support.mass_kg,
        // Fixed ones, the robot, and kinds to come.
        _ => {}
    }
    new
}

#[cfg(test)]
mod tests {
    use cable_core::scene::catalog;

    use super::*;

    /// The hanging span with a support in the middle, or at its end, that went through two kinds.
    fn changed(through: [SupportKind; 2], part: SupportPlace) -> Scene {
        let mut scene = catalog::hanging_span();
        let supports = &mut scene.cables[0].supports;
        let end = part == SupportPlace::CableEnd;
        let place = if end { ([10.0, 5.0], 12.0) } else { ([5.0, 4.5], 6.0) };
        let mut support = if end { supports[1].clone() } else { Support::pulley("middle", place.0) };
        for kind in through {
            support = of_kind(&support, kind, place.0, place.1, part);
        }
        if end {
            supports[1] = support;
        } else {
            supports.insert(1, support);
        }
        scene
    }

    #[test]
    fn every_change_of_kind_leaves_a_scene_that_can_be_solved() {
        let (mut tried, scene) = (0, catalog::hanging_span());
        for place in [SupportPlace::Between, SupportPlace::CableEnd] {
            for (from, ..) in KINDS {
                for (to, ..) in KINDS {
                    if refusal(from, place, &scene).is_none() && refusal(to, place, &scene).is_none() {
                        assert_eq!(changed([from, to], place).validate(), Ok(()), "{from:?} to {to:?}: {place:?}");
                        tried += 1;
                    }
                }
            }
        }
        assert_eq!(tried, 4 * 4 + 4 * 4);
    }
}

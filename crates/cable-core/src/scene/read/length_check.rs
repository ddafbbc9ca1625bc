//! A cable is refused if it is too short for the straight way through its supports.

use super::key_path::Path;
use super::number_and_name_checks::CheckResult;
use crate::error::SceneFault;
use crate::math::{Vec2, vec2};
use crate::scene::{Cable, Scene, Support, SupportKind};

/// Refuses a cable that would have to break to reach its supports. Each stretch between two
/// supports that grip it is checked separately. Obstacles only make the way longer.
pub(super) fn check_length(scene: &Scene, cable: &Cable, at: &Path<'_>) -> CheckResult {
    let thermal = 1.0 + cable.thermal_expansion_per_k * scene.environment.temperature_change_k;
    let last = cable.supports.len().saturating_sub(1);
    let mut from: Option<Waypoint> = None;
    let mut gripped_at = 0.0;
    let mut way = 0.0;
    for (i, support) in cable.supports.iter().enumerate() {
        let Some(here) = Waypoint::of(scene, cable, support) else {
            // A load or free point: the way before it says nothing about the way after it, but a
            // gripping support beyond still bounds both together, so the way goes on from the last
            // known point.
            continue;
        };
        if let Some(before) = from {
            way += before.tangent_length(here);
        }
        from = Some(here);
        if support.kind == SupportKind::Pulley {
            continue;
        }
        let arc = match i {
            0 => 0.0,
            i if i == last => cable.length_m,
            _ => support.arc_length_m.unwrap_or(gripped_at),
        };
        let length_m = (arc - gripped_at) * thermal;
        let needed_n = cable.axial_stiffness_n * (way / length_m - 1.0);
        if way > length_m && !(needed_n <= cable.breaking_tension_n) {
            let breaking_n = cable.breaking_tension_n;
            return Err(at.fault(SceneFault::TooShort { length_m, way_m: way, needed_n, breaking_n }));
        }
        (gripped_at, way) = (arc, 0.0);
    }
    Ok(())
}

/// Part of the cable's length by which two supports beside each other on it must be clear of each
/// other where one slides or turns. Smaller: what lies between them is lost in rounding. Larger:
/// eyes set close together are refused.
const MIN_SEPARATION_FRACTION: f64 = 1e-9;

/// Refuses neighbours along the cable without a straight line that touches both: a support inside
/// the wheel beside it, a wheel inside the next one, an eye in the very place of what it stands
/// beside.
pub(super) fn check_tangents_exist(scene: &Scene, cable: &Cable, at: &Path<'_>) -> CheckResult {
    for (i, pair) in cable.supports.windows(2).enumerate() {
        let [from, to] = pair else { continue };
        let slides = from.kind == SupportKind::Pulley || to.kind == SupportKind::Pulley;
        let (Some(a), Some(b)) = (Waypoint::of(scene, cable, from), Waypoint::of(scene, cable, to)) else { continue };
        let apart_m = (b.at - a.at).norm();
        if !slides || apart_m - (a.radius - b.radius).abs() > MIN_SEPARATION_FRACTION * cable.length_m {
            continue;
        }
        let inner = if a.radius < b.radius { from } else { to };
        let name = |support: &Support| support.name.as_str().into();
        let inside = (a.radius.max(b.radius) > 0.0).then(|| name(inner));
        let fault = SceneFault::NoWay { from: name(from), to: name(to), apart_m, inside };
        return Err(at.key("supports").index(i + 1).key("at_m").fault(fault));
    }
    Ok(())
}

/// A known point of the way, with the radius the centre line turns about it.
#[derive(Clone, Copy)]
struct Waypoint {
    at: Vec2,
    radius: f64,
}

impl Waypoint {
    /// The anchor of a support, a wheel with the cable's radius added; None if it has no place.
    fn of(scene: &Scene, cable: &Cable, support: &Support) -> Option<Self> {
        let at = match support.kind {
            SupportKind::Robot => scene.hitch_m()?,
            _ => support.at_m?,
        };
        let radius = support.radius_m.filter(|&r| r > 0.0).map_or(0.0, |r| r + cable.diameter_m / 2.0);
        Some(Self { at: vec2(at), radius })
    }

    /// Tangent between two circles, the crossed one, which is the shorter: √(d² − (r₁ + r₂)²). The
    /// arcs on the wheels come on top, so this is never more than the cable needs.
    fn tangent_length(self, other: Self) -> f64 {
        let (d, r) = ((other.at - self.at).norm(), self.radius + other.radius);
        if d > r { ((d - r) * (d + r)).sqrt() } else { 0.0 }
    }
}

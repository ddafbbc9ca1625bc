//! A support that a scene puts onto a surface holds the centre line one radius off it; a support
//! inside something solid is refused.
//!
//! The centre line runs one cable radius off every obstacle. A point on the surface of one, or up
//! to a radius above it, is where a cable that lies there touches it: the centre line at that
//! support is a radius off. A point further in is a slip of the scene, as nobody can tell on which
//! side of the obstacle the cable was meant to be.

use super::definition::Problem;
use crate::error::{SceneError, SceneFault};
use crate::math::Vec2;
use crate::scene::SupportKind;
use crate::scene::read::key_path::Path;
use crate::solution::{Warning, WarningCause};

/// Depth inside a surface at which a point may be that was meant to be on it, of the radius:
/// rounding of coordinates and slopes.
const SURFACE_DEPTH_RADIUS_FRACTION: f64 = 1e-3;
/// The same in parts of the coordinates, for cables much thinner than their scene.
const COORDINATE_ROUNDING: f64 = 1e-9;
/// A support that is moved by more than this part of its coordinates (and of the radius, as above)
/// is spoken of. Larger: supports of thin cables far from (0, 0) are moved without a word.
const SILENT_MOVE_FRACTION: f64 = 1e-12;
/// Part of its coordinates by which a place that is clear may be inside: some roundings.
const CLEAR_ROUNDING: f64 = 1e-14;
/// Times a support is pushed out of one obstacle and into the next; in a corner of 30° twenty leave
/// a millionth of the way.
const MAX_PUSHES: usize = 40;

/// Puts the supports of a cable where their surfaces let them be, and says so.
///
/// # Errors
/// A support inside an obstacle, with the nearest place outside.
pub(super) fn clear_supports(problem: &mut Problem) -> Result<(), SceneError> {
    if problem.world.is_empty() {
        return Ok(());
    }
    for k in 0..problem.supports.len() {
        let support = &problem.supports[k];
        // A wheel may be mounted on what it stands in; the hitch goes with the robot.
        if support.wheel_radius > 0.0 || support.kind == SupportKind::Robot {
            continue;
        }
        let Some(at) = support.at else { continue };
        let Some((depth, obstacle)) = depth(problem, at) else { continue };
        let most = SURFACE_DEPTH_RADIUS_FRACTION * problem.radius + COORDINATE_ROUNDING * at.amax();
        let out = pushed_out(problem, at);
        let path =
            || Path::Root.key("cables").index(problem.cable_index).key("supports").index(k).key("at_m").to_string();
        if depth > most {
            let clear_m = out.map(|p| [p.x, p.y]);
            let fault = SceneFault::SupportInside {
                name: support.name.as_str().into(),
                obstacle: obstacle.into(),
                depth_m: depth,
                clear_m,
            };
            return Err(SceneError { path: path(), fault, at: None });
        }
        let Some(out) = out else {
            let fault = SceneFault::NoRoom { support: support.name.as_str().into() };
            return Err(SceneError { path: path(), fault, at: None });
        };
        let by = out - at;
        // Rounding is put right without a word.
        let is_notable = by.norm() > SURFACE_DEPTH_RADIUS_FRACTION * problem.radius + SILENT_MOVE_FRACTION * at.amax();
        let cause = WarningCause::SupportOnSurface { support: support.name.clone(), obstacle: obstacle.to_owned() };
        let s = support.arc_length.unwrap_or(0.0);
        let note = Warning::new(cause, &problem.cable.name, s, [by.norm(), problem.radius]).at(out.into());
        problem.notes.extend(is_notable.then_some(note));
        if let Some(support) = problem.supports.get_mut(k) {
            support.at = Some(out);
            if let Some(motion) = &mut support.motion {
                motion.shift(by);
            }
        }
        // A route that ends at the support ends there still.
        if let Some(end) = problem.route.iter_mut().find(|p| (**p - at).norm() <= most) {
            *end = out;
        }
    }
    Ok(())
}

/// Returns how far a point is inside the surface of the obstacle that it is deepest in (m, negative
/// outside but nearer than the cable's radius), and that obstacle; none where the centre line has
/// room.
fn depth(problem: &Problem, at: Vec2) -> Option<(f64, String)> {
    let gap = problem.world.signed_gap(at, f64::INFINITY).filter(|g| g.gap_m < 0.0)?;
    Some((-gap.gap_m - problem.radius, problem.world.obstacle_name(gap.obstacle).to_owned()))
}

/// The nearest place found where the centre line touches nothing, m.
fn pushed_out(problem: &Problem, from: Vec2) -> Option<Vec2> {
    let mut at = from;
    for _ in 0..MAX_PUSHES {
        match problem.world.signed_gap(at, f64::INFINITY) {
            Some(gap) if gap.gap_m < -CLEAR_ROUNDING * (problem.radius + at.amax()) => at -= gap.normal * gap.gap_m,
            _ => return Some(at),
        }
    }
    None
}

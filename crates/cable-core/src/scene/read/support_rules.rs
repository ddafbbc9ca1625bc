//! The rules of supports say which keys belong to which kind, and where along the cable each kind
//! may sit.

use super::key_path::Path;
use super::number_and_name_checks::{CheckResult, MAX_POINTS_ON_CABLE, at_most, force, motion, number, point, unique};
use super::range;
use crate::error::{DocumentFault, SceneFault};
use crate::scene::{Cable, Scene, Support, SupportKind};

use SupportKind::{Clamped, Fixed, Free, Load, Pulley, Robot};

/// Checks the supports of a cable.
pub(super) fn check(scene: &Scene, cable: &Cable, cable_at: &Path<'_>) -> CheckResult {
    let at = cable_at.key("supports");
    let supports = &cable.supports;
    at_most(&at, supports.len(), MAX_POINTS_ON_CABLE)?;
    if supports.len() < 2 {
        return Err(at.document_fault(DocumentFault::TooFewSupports));
    }
    unique(&at, supports.iter().map(|s| s.name.as_str()))?;
    let (mut before, last) = (0.0, supports.len() - 1);
    for (i, support) in supports.iter().enumerate() {
        let here = at.index(i);
        let is_end = i == 0 || i == last;
        check_keys(support, &here)?;
        check_numbers(support, &here)?;
        if support.kind == Robot && scene.robot.is_none() {
            return Err(here.key("kind").document_fault(DocumentFault::HitchWithoutRobot));
        }
        match (is_end, support.kind, support.arc_length_m) {
            (true, Pulley, _) => {
                return Err(here.key("kind").document_fault(DocumentFault::PulleyAtEnd));
            }
            (false, Free, _) => return Err(here.key("kind").document_fault(DocumentFault::FreeWithin)),
            (true, _, Some(_)) => {
                return Err(here.key("arc_length_m").document_fault(DocumentFault::ArcLengthAtEnd));
            }
            (false, Fixed | Clamped | Load | Robot, None) => {
                return Err(here.key("arc_length_m").document_fault(DocumentFault::MissingArcLength));
            }
            (false, _, Some(s)) => {
                if !(s > before && s < cable.length_m) {
                    let between_m = [before, cable.length_m];
                    return Err(here.key("arc_length_m").fault(SceneFault::OutOfOrder { arc_length_m: s, between_m }));
                }
                before = s;
            }
            _ => {}
        }
    }
    Ok(())
}

/// What the kind of a support says of one of its keys.
struct KeyRule {
    key: &'static str,
    is_given: bool,
    is_allowed: bool,
    is_needed: bool,
}

/// Keys that a kind must have, and must not.
fn check_keys(s: &Support, at: &Path<'_>) -> CheckResult {
    let kind = s.kind;
    let has_place = matches!(kind, Fixed | Clamped | Pulley);
    let forced = s.force_n.is_some() || !s.times_s.is_empty() || !s.forces_n.is_empty();
    let force_key = match (&s.force_n, s.times_s.is_empty()) {
        (Some(_), _) => "force_n",
        (None, false) => "times_s",
        _ => "forces_n",
    };
    let optional = |key, is_given, is_allowed| KeyRule { key, is_given, is_allowed, is_needed: false };
    let needed = |key, is_given, is_needed| KeyRule { key, is_given, is_allowed: is_needed, is_needed };
    let rules = [
        needed("at_m", s.at_m.is_some(), has_place),
        needed("angle_deg", s.angle_deg.is_some(), kind == Clamped),
        optional("arc_length_m", s.arc_length_m.is_some(), kind != Pulley),
        optional("radius_m", s.radius_m.is_some(), kind == Pulley),
        optional("side", s.side.is_some(), kind == Pulley),
        optional("friction", s.friction.is_some(), kind == Pulley),
        optional(force_key, forced, kind == Load),
        optional("mass_kg", s.mass_kg.is_some(), matches!(kind, Load | Free)),
        optional("motion", s.motion.is_some(), has_place),
        optional("release_s", s.release_s.is_some(), has_place || kind == Robot),
    ];
    for KeyRule { key, is_given, is_allowed, is_needed } in rules {
        if is_given && !is_allowed {
            return Err(at.key(key).document_fault(DocumentFault::NotForKind { kind: name(kind) }));
        }
        if is_needed && !is_given {
            return Err(at.key(key).document_fault(DocumentFault::MissingForKind { kind: name(kind) }));
        }
    }
    Ok(())
}

fn check_numbers(s: &Support, at: &Path<'_>) -> CheckResult {
    let numbers = [
        ("arc_length_m", s.arc_length_m, range::ARC_LENGTH),
        ("angle_deg", s.angle_deg, range::ANGLE),
        ("radius_m", s.radius_m, range::WHEEL_RADIUS),
        ("friction", s.friction, range::FRICTION),
        ("mass_kg", s.mass_kg, range::MASS),
        ("release_s", s.release_s, range::DURATION),
    ];
    for (key, value, range) in numbers {
        if let Some(value) = value {
            number(&at.key(key), value, range)?;
        }
    }
    if let Some(p) = s.at_m {
        point(&at.key("at_m"), p, range::COORDINATE)?;
    }
    if s.kind == Load {
        force(at, s.force_n, &s.times_s, &s.forces_n)?;
    }
    match (&s.motion, s.at_m) {
        (Some(m), Some(p)) => motion(&at.key("motion"), m, p),
        _ => Ok(()),
    }
}

/// The name of a kind as a file writes it.
fn name(kind: SupportKind) -> &'static str {
    match kind {
        Fixed => "fixed",
        Clamped => "clamped",
        Pulley => "pulley",
        Load => "load",
        Robot => "robot",
        Free => "free",
    }
}

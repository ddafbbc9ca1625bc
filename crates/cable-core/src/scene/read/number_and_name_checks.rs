//! The checks that every part of a scene shares: numbers in their ranges, series in time, and names
//! that are used once.

use super::key_path::Path;
use super::range::{self, Range};
use crate::error::{DocumentFault, SceneError, SceneFault};
use crate::math::Point;
use crate::scene::Motion;

/// Most supports of a cable, and most loads of a scene.
pub(super) const MAX_POINTS_ON_CABLE: usize = 10_000;

/// Most knots of a route, motion, series or robot path.
pub(super) const MAX_KNOTS: usize = 100_000;

/// Longest name, bytes.
const MAX_NAME: usize = 200;

pub(super) type CheckResult = Result<(), SceneError>;

/// A finite number in its range.
pub(super) fn number(at: &Path<'_>, value: f64, range: Range) -> CheckResult {
    if range.holds(value) {
        Ok(())
    } else {
        Err(at.fault(SceneFault::Range { value, allowed: range.limits(), quantity: range.quantity }))
    }
}

pub(super) fn point(at: &Path<'_>, value: Point, range: Range) -> CheckResult {
    number(&at.index(0), value[0], range)?;
    number(&at.index(1), value[1], range)
}

pub(super) fn points(at: &Path<'_>, values: &[Point], range: Range) -> CheckResult {
    values.iter().enumerate().try_for_each(|(i, p)| point(&at.index(i), *p, range))
}

/// No two neighbours in the same place.
pub(super) fn distinct_neighbours(at: &Path<'_>, line: &[Point]) -> CheckResult {
    match line.windows(2).position(|w| w[0] == w[1]) {
        Some(i) => Err(at.index(i + 1).document_fault(DocumentFault::RepeatedPoint)),
        None => Ok(()),
    }
}

pub(super) fn at_most(at: &Path<'_>, count: usize, most: usize) -> CheckResult {
    if count <= most { Ok(()) } else { Err(at.fault(SceneFault::TooMany { count, most })) }
}

/// Names that are there, short enough and each used once.
pub(super) fn unique<'a>(at: &Path<'_>, names: impl Iterator<Item = &'a str>) -> CheckResult {
    let mut seen = std::collections::BTreeSet::new();
    for (i, name) in names.enumerate() {
        let place = at.index(i);
        if name.trim().is_empty() {
            return Err(place.key("name").document_fault(DocumentFault::EmptyName));
        }
        if name.len() > MAX_NAME {
            return Err(place.key("name").document_fault(DocumentFault::LongName { most: MAX_NAME }));
        }
        if !seen.insert(name) {
            return Err(place.key("name").document_fault(DocumentFault::TakenName { name: name.to_owned() }));
        }
    }
    Ok(())
}

/// Checks times and values of a series.
pub(super) fn series(
    times_at: &Path<'_>,
    values_at: &Path<'_>,
    times: &[f64],
    values: &[Point],
    range: Range,
) -> CheckResult {
    at_most(times_at, times.len(), MAX_KNOTS)?;
    if times.is_empty() {
        return Err(times_at.document_fault(DocumentFault::NoTime));
    }
    if times.len() != values.len() {
        return Err(values_at.fault(SceneFault::UnequalCounts { values: values.len(), times: times.len() }));
    }
    for (i, &t) in times.iter().enumerate() {
        number(&times_at.index(i), t, range::TIME)?;
    }
    for (i, pair) in times.windows(2).enumerate() {
        // Closer knots than this make velocities overflow.
        if !(pair[1] - pair[0] >= range::MIN_INTERVAL_S) {
            let fault = SceneFault::TimesNotIncreasing { time_s: pair[1], before_s: pair[0] };
            return Err(times_at.index(i + 1).fault(fault));
        }
    }
    points(values_at, values, range)
}

/// Either a constant force or a series.
pub(super) fn force(at: &Path<'_>, constant: Option<Point>, times: &[f64], forces: &[Point]) -> CheckResult {
    let given = !times.is_empty() || !forces.is_empty();
    match constant {
        Some(_) if given => Err(at.key("force_n").document_fault(DocumentFault::TwoForces)),
        Some(f) => point(&at.key("force_n"), f, range::FORCE),
        None if given => series(&at.key("times_s"), &at.key("forces_n"), times, forces, range::FORCE),
        None => Err(at.key("force_n").document_fault(DocumentFault::NoForce)),
    }
}

/// A motion and that it starts where its support is.
pub(super) fn motion(at: &Path<'_>, motion: &Motion, start: Point) -> CheckResult {
    series(&at.key("times_s"), &at.key("points_m"), &motion.times_s, &motion.points_m, range::COORDINATE)?;
    /// Further apart than this the first instant would be a jump, m.
    const PLACE_TOLERANCE: f64 = 1e-6;
    let p = motion.at(0.0).0;
    if (p.x - start[0]).hypot(p.y - start[1]) <= PLACE_TOLERANCE {
        Ok(())
    } else {
        Err(at.key("points_m").fault(SceneFault::MotionStartsElsewhere { motion_m: p.into(), support_m: start }))
    }
}

//! This module spreads the material of a cable along a route that avoids obstacles.

use crate::math::{Vec2, cross, perp};
use crate::model::fem::mesh::Mesh;
use crate::numerics::bisect;
use crate::problem::Problem;
use crate::problem::ground_route::above_ground;
use crate::problem::way_over::{bodies_in_the_way, hull_over};
use crate::scene::SupportKind;

/// Width of a leg below which it is plumb and no hull over obstacles leads along it, m. Smaller:
/// hulls of no width; larger: steep legs are not lifted.
const LEAST_LEG_WIDTH_M: f64 = 1e-9;

/// Number of steps of the half turn by which an end is leaned to either side until it is clear of
/// obstacles below it. Larger: the same at more cost; smaller: it begins higher than it needs to.
const LEAN_STEPS: i32 = 36;

/// Number of halvings in the search for the angle of an arc: down to round-off.
const ARC_HALVINGS: usize = 52;

/// The corners of a cable's route, each with its arc length, m.
#[must_use]
pub fn route(problem: &Problem) -> Vec<(f64, Vec2)> {
    let points = if problem.route.len() >= 2 {
        problem.route.clone()
    } else {
        above_ground(problem, lifted(problem, &straight(problem)))
    };
    let mut along = vec![0.0; points.len()];
    for k in 1..points.len() {
        along[k] = along[k - 1] + (points[k] - points[k - 1]).norm();
    }
    let total = along.last().copied().unwrap_or(0.0);
    // Arc length is a function of the distance along the way, linear between supports whose arc
    // length is known.
    let mut knots = vec![(0.0, 0.0)];
    for s in &problem.supports {
        if let (Some(arc), Some(at)) = (s.arc_length, s.at)
            && arc > 0.0
            && arc < problem.length
        {
            let w = nearest_way(&points, &along, at);
            if knots.last().is_some_and(|k| w > k.0 && arc > k.1) && w < total {
                knots.push((w, arc));
            }
        }
    }
    knots.push((total, problem.length));
    let arc_at = |w: f64| {
        let k = knots.partition_point(|k| k.0 <= w).clamp(1, knots.len() - 1);
        let (a, b) = (knots[k - 1], knots[k]);
        if b.0 > a.0 { a.1 + (b.1 - a.1) * (w - a.0) / (b.0 - a.0) } else { a.1 }
    };
    points.iter().zip(&along).map(|(p, &w)| (arc_at(w), *p)).collect()
}

/// The corners of a stiff cable's route. A free end that would hang into an obstacle is turned
/// about the support it hangs from until its tip is clear: a flexible cable comes down in a heap
/// there, a stiff one leans.
#[must_use]
pub fn leaning_way(problem: &Problem) -> Vec<(f64, Vec2)> {
    let mut points = route(problem);
    let last = problem.supports.len().saturating_sub(1);
    if problem.route.len() >= 2 {
        return points;
    }
    for (end, from) in [(0, 1), (last, last.saturating_sub(1))] {
        let (Some(tip), Some(hinge)) = (problem.supports.get(end), problem.supports.get(from)) else { continue };
        let (Some(at), Some(hinged), Some(s)) = (hinge.at, hinge.arc_length, tip.arc_length) else { continue };
        if !matches!(tip.kind, SupportKind::Free | SupportKind::Load) {
            continue;
        }
        let reach = s - hinged;
        let pull = tip.force.at(0.0) + problem.body_force(0.0) * (0.5 * problem.length);
        let down = pull.try_normalize(0.0).unwrap_or_else(|| -Vec2::y());
        // A clamp determines the side to which it leans.
        let aside = hinge.angle.map_or(1.0, f64::cos) * reach;
        let step = std::f64::consts::PI / f64::from(LEAN_STEPS);
        let lean = if cross(down, Vec2::new(aside, 0.0)) < 0.0 { -step } else { step };
        let leaned = |k: i32| {
            let (sin, cos) = (lean * f64::from(k)).sin_cos();
            at + Vec2::new(cos * down.x - sin * down.y, sin * down.x + cos * down.y) * reach.abs()
        };
        let clear = |k: &i32| problem.world.signed_gap(leaned(*k), problem.length).is_none_or(|g| g.gap_m >= 0.0);
        let both = (1..=LEAN_STEPS).flat_map(|k| [k, -k]);
        let Some(k) = std::iter::once(0).chain(both).find(clear).filter(|k| *k != 0) else { continue };
        let leg = [(hinged, at), (s, leaned(k))];
        if reach < 0.0 {
            points.retain(|p| p.0 > hinged);
            points.splice(0..0, [leg[1], leg[0]]);
        } else {
            points.retain(|p| p.0 < hinged);
            points.extend(leg);
        }
    }
    points
}

/// Nodes on a circular arc as long as the cable, from the first to the last, bowed against its
/// weight: there a cable with much slack does not touch itself. None if the ends are in one place,
/// or farther apart than the cable is long.
#[must_use]
pub fn bow(problem: &Problem, mesh: &Mesh, x: &[Vec2]) -> Option<Vec<Vec2>> {
    let (from, to) = (*x.first()?, *x.last()?);
    let (chord, length) = ((to - from).norm(), mesh.thermal_stretch * problem.length);
    if !(chord > 0.0 && chord < length) {
        return None;
    }
    // Half of the angle u of the arc: sin u / u is chord over length.
    let [low, _] = bisect([0.0, std::f64::consts::PI], ARC_HALVINGS, |half| half.sin() * length > chord * half);
    let along = (to - from) / chord;
    let up = if perp(along).dot(&problem.body_force(0.0)) > 0.0 { -perp(along) } else { perp(along) };
    let radius = 0.5 * length / low;
    let center = (from + to) * 0.5 - up * (radius * low.cos());
    let place = |s: &f64| {
        let (sin, cos) = (low * (2.0 * s / problem.length - 1.0)).sin_cos();
        center + (along * sin + up * cos) * radius
    };
    Some(mesh.arc_length.iter().map(place).collect())
}

/// Distance along a line of points (m) of its point nearest to `at`.
fn nearest_way(points: &[Vec2], along: &[f64], at: Vec2) -> f64 {
    let mut best = (f64::INFINITY, 0.0);
    for k in 1..points.len() {
        let f = crate::contact::distance::nearest_fraction(at, points[k - 1], points[k]);
        let d = (points[k - 1] + (points[k] - points[k - 1]) * f - at).norm();
        if d < best.0 {
            best = (d, along[k - 1] + f * (along[k] - along[k - 1]));
        }
    }
    best.1
}

/// The straight way from support to support; a free end hangs from the nearest one along its load,
/// or down.
fn straight(problem: &Problem) -> Vec<Vec2> {
    let mut points: Vec<Vec2> = problem.supports.iter().filter_map(|s| s.position_at(0.0).map(|p| p.0)).collect();
    let used: f64 = points.windows(2).map(|p| (p[1] - p[0]).norm()).sum();
    let rest = problem.length - used;
    let loose = |s: Option<&crate::problem::SupportPoint>| {
        s.filter(|s| matches!(s.kind, SupportKind::Free | SupportKind::Load)).map(|s| {
            let pull = s.force.at(0.0) + problem.body_force(0.0) * (0.5 * problem.length);
            if pull.norm() > 0.0 { pull.normalize() } else { Vec2::new(0.0, -1.0) }
        })
    };
    let (start, end) = (loose(problem.supports.first()), loose(problem.supports.last()));
    let share = if start.is_some() && end.is_some() { 0.5 * rest } else { rest };
    if share > 0.0 {
        if let (Some(d), Some(&p)) = (start, points.first()) {
            points.insert(0, p + d * share);
        }
        if let (Some(d), Some(&p)) = (end, points.last()) {
            points.push(p + d * share);
        }
    }
    points
}

/// Replaces each leg that meets an obstacle by the upper hull of its ends and of the obstacles in
/// the way.
fn lifted(problem: &Problem, points: &[Vec2]) -> Vec<Vec2> {
    let mut out: Vec<Vec2> = points.first().copied().into_iter().collect();
    for leg in points.windows(2) {
        let (a, b) = (leg[0], leg[1]);
        let bodies = bodies_in_the_way(&problem.world, a, b);
        if !bodies.is_empty() && (b.x - a.x).abs() > LEAST_LEG_WIDTH_M {
            let hull = hull_over(&problem.world, &bodies, a, b);
            out.extend(hull.iter().skip(1));
        } else {
            out.push(b);
        }
    }
    out
}

/// Positions of the nodes of a mesh along a way, m.
#[must_use]
pub fn place_nodes(mesh: &Mesh, way: &[(f64, Vec2)]) -> Vec<Vec2> {
    let at = |s: f64| {
        let k = way.partition_point(|w| w.0 <= s).clamp(1, way.len().max(2) - 1);
        match (way.get(k - 1), way.get(k)) {
            (Some(a), Some(b)) if b.0 > a.0 => a.1 + (b.1 - a.1) * ((s - a.0) / (b.0 - a.0)),
            (Some(a), _) => a.1,
            _ => Vec2::zeros(),
        }
    };
    mesh.arc_length.iter().map(|&s| at(s)).collect()
}

//! A route that leads through the ground is lifted onto it.
//!
//! Ground is solid below its line, and of its line there is one outside only. A part of a route
//! that is inside says that the cable lies on the ground there: it is led along the surface from
//! where it goes in to where it comes out. Beams and posts have two sides; what leads through them
//! is refused ([`super::route_check`]).

use super::definition::Problem;
use super::route_check::allowed_depth;
use crate::contact::geometry::Body;
use crate::math::{Vec2, cross};
use crate::solution::{Warning, WarningCause};

/// Bodies of ground that a route is lifted over one after the other: each lift may lead into the
/// next.
const MAX_GROUNDS: usize = 100;

/// A place where a leg of the route crosses the surface: part of the leg, and coordinate of the
/// surface (edge + part of it).
#[derive(Clone, Copy, Debug, PartialEq)]
struct SurfaceCrossing {
    part: f64,
    along: f64,
}

/// A stretch of the route inside a ground: the leg and part of it where it begins and ends, and
/// where on the surface.
#[derive(Clone, Copy, Debug)]
struct BuriedStretch {
    from: (usize, SurfaceCrossing),
    to: (usize, SurfaceCrossing),
    depth: f64,
    deepest: Vec2,
}

/// Lifts a route that is drawn below the ground, and says so.
pub(super) fn lift_route(problem: &mut Problem) {
    if problem.route.len() < 2 {
        return;
    }
    let geometry = problem.world.geometry().clone();
    for body in geometry.bodies().iter().filter(|b| b.is_ground()).take(MAX_GROUNDS) {
        let stretches: Vec<BuriedStretch> =
            buried(&problem.route, body).into_iter().filter(|b| b.depth > allowed_depth(problem)).collect();
        let Some(worst) = stretches.iter().copied().reduce(|a, b| if b.depth > a.depth { b } else { a }) else {
            continue;
        };
        problem.route = reroute_along_surface(&problem.route, &stretches, body);
        let cause = WarningCause::RouteBuried { obstacle: body.name.clone() };
        let warning = Warning::new(cause, &problem.cable.name, 0.0, [worst.depth, 0.0]);
        problem.notes.push(warning.at(worst.deepest.into()));
    }
}

/// A way with what of it is below the ground led along the surface.
#[must_use]
pub(crate) fn above_ground(problem: &Problem, way: Vec<Vec2>) -> Vec<Vec2> {
    let geometry = problem.world.geometry();
    geometry.bodies().iter().filter(|b| b.is_ground()).take(MAX_GROUNDS).fold(way, |way, body| {
        let stretches = buried(&way, body);
        if stretches.is_empty() { way } else { reroute_along_surface(&way, &stretches, body) }
    })
}

/// The stretches of a route inside a ground, in order.
fn buried(route: &[Vec2], body: &Body) -> Vec<BuriedStretch> {
    let inside = |p: Vec2| body.signed_gap(p, f64::INFINITY).is_some_and(|g| g.gap_m + body.offset < 0.0);
    let mut out: Vec<BuriedStretch> = Vec::new();
    let mut open: Option<BuriedStretch> = None;
    for (leg, w) in route.windows(2).enumerate() {
        let mut stops = crossings(body, w[0], w[1]);
        stops.insert(0, SurfaceCrossing { part: 0.0, along: nearest(body, w[0]) });
        stops.push(SurfaceCrossing { part: 1.0, along: nearest(body, w[1]) });
        for pair in stops.windows(2) {
            let at = |part: f64| w[0] + (w[1] - w[0]) * part;
            let is_inside = pair[1].part > pair[0].part && inside(at(0.5 * (pair[0].part + pair[1].part)));
            if !is_inside {
                if pair[1].part > pair[0].part {
                    out.extend(open.take());
                }
                continue;
            }
            let mut now = open.take().unwrap_or(BuriedStretch {
                from: (leg, pair[0]),
                to: (leg, pair[1]),
                depth: 0.0,
                deepest: at(pair[0].part),
            });
            now.to = (leg, pair[1]);
            for k in 0..=8 {
                let p = at(pair[0].part + (pair[1].part - pair[0].part) * f64::from(k) / 8.0);
                let depth = body.signed_gap(p, f64::INFINITY).map_or(0.0, |g| -g.gap_m - body.offset);
                if depth > now.depth {
                    (now.depth, now.deepest) = (depth, p);
                }
            }
            open = Some(now);
        }
    }
    out.extend(open);
    out
}

/// Returns where the straight line from `a` to `b` crosses the surface, in order along it.
fn crossings(body: &Body, a: Vec2, b: Vec2) -> Vec<SurfaceCrossing> {
    let d = b - a;
    let mut out: Vec<SurfaceCrossing> = body
        .candidates(a.inf(&b), a.sup(&b))
        .filter_map(|k| {
            let e = body.edges.get(k)?;
            let f = e.to - e.from;
            let turn = cross(d, f);
            let (part, along) = (cross(e.from - a, f) / turn, cross(e.from - a, d) / turn);
            let meets = (0.0..=1.0).contains(&part) && (0.0..=1.0).contains(&along);
            meets.then_some(SurfaceCrossing { part, along: k as f64 + along })
        })
        .collect();
    out.sort_by(|x, y| x.part.total_cmp(&y.part));
    out
}

/// The coordinate of the surface nearest to a point.
fn nearest(body: &Body, p: Vec2) -> f64 {
    let Some(gap) = body.signed_gap(p, f64::INFINITY) else { return 0.0 };
    let local = gap.feature.saturating_sub(body.first);
    if local % 2 == 1 {
        return (local / 2) as f64;
    }
    let k = local / 2;
    body.edges.get(k).map_or(k as f64, |e| k as f64 + (gap.point - e.from).dot(&e.tangent) / e.length())
}

/// The route with its buried stretches led along the surface, the centre line's distance off it.
fn reroute_along_surface(route: &[Vec2], stretches: &[BuriedStretch], body: &Body) -> Vec<Vec2> {
    let mut out: Vec<Vec2> = Vec::with_capacity(route.len());
    let mut put = |p: Vec2| {
        if out.last() != Some(&p) {
            out.push(p);
        }
    };
    let mut next = 0;
    for b in stretches {
        let point = |(leg, c): (usize, SurfaceCrossing)| route[leg] + (route[leg + 1] - route[leg]) * c.part;
        let starts_inside = b.from.1.part == 0.0 && b.from.0 == 0;
        for p in route.get(next..=b.from.0).unwrap_or_default() {
            put(*p);
        }
        if !starts_inside {
            put(point(b.from));
        }
        let (low, high) = (b.from.1.along, b.to.1.along);
        let corners: Vec<usize> = if low <= high {
            (low.floor() as usize + 1..=high.ceil().max(1.0) as usize - 1).collect()
        } else {
            (high.floor() as usize + 1..=low.ceil().max(1.0) as usize - 1).rev().collect()
        };
        for corner in corners.into_iter().filter_map(|k| body.corner(k)) {
            let out = corner.outward();
            put(corner.at + out.try_normalize(0.0).unwrap_or_else(Vec2::y) * body.offset);
        }
        let ends_inside = b.to.1.part == 1.0 && b.to.0 + 2 == route.len();
        if !ends_inside {
            put(point(b.to));
        }
        next = b.to.0 + 1;
    }
    for p in route.get(next..).unwrap_or_default() {
        put(*p);
    }
    // Ends that nothing holds lie on the surface; those that are held are never inside.
    for end in [0, out.len().saturating_sub(1)] {
        if let Some(p) = out.get_mut(end)
            && let Some(gap) = body.signed_gap(*p, f64::INFINITY).filter(|g| g.gap_m + body.offset < 0.0)
        {
            *p -= gap.normal * gap.gap_m;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

    use crate::problem::problems;
    use crate::scene::{Obstacle, Scene, Shape, Support, catalog};
    use crate::solution::WarningCause;

    fn over(ground: &[[f64; 2]], route_m: &[[f64; 2]]) -> Scene {
        let mut scene = catalog::hanging_span();
        scene.loads.clear();
        let shape = Shape::Terrain { points_m: ground.to_vec() };
        scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape, friction: None }];
        let c = &mut scene.cables[0];
        (c.length_m, c.diameter_m, c.route_m) = (40.0, 0.02, route_m.to_vec());
        c.supports = vec![Support::fixed("A", route_m[0]), Support::fixed("B", route_m[route_m.len() - 1])];
        scene
    }

    #[test]
    fn a_route_below_ground_is_led_along_the_surface_with_a_word() {
        let hills =
            [[-5.0, 0.0], [3.0, 0.0], [5.0, 4.0], [7.0, 0.0], [9.0, 0.0], [11.0, 3.0], [13.0, 0.0], [30.0, 0.0]];
        let deep: [&[[f64; 2]]; 4] = [
            &[[0.0, 1.0], [18.0, 1.0]],
            &[[18.0, 1.0], [0.0, 1.0]],
            &[[0.0, 1.0], [2.0, -3.0], [10.0, -5.0], [18.0, 1.0]],
            &[[0.0, 1.0], [4.0, -1.0], [5.0, 9.0], [11.0, -2.0], [18.0, 1.0]],
        ];
        for route in deep {
            let problem = problems(&over(&hills, route)).unwrap().remove(0);
            assert!(problem.notes.iter().all(|n| matches!(n.cause, WarningCause::RouteBuried { .. })));
            assert_eq!(problem.notes.len(), 1, "{:?}", problem.notes);
            for w in problem.route.windows(2) {
                for k in 0..=20 {
                    let at = w[0] + (w[1] - w[0]) * (f64::from(k) / 20.0);
                    let gap = problem.world.signed_gap(at, 1e3).unwrap().gap_m;
                    assert!(gap > -0.03, "{route:?}: {gap} m at {at}, {:?}", problem.route);
                }
            }
            assert_eq!(problem.route[0], crate::math::vec2(route[0]));
        }
        let clear = problems(&over(&hills, &[[0.0, 1.0], [5.0, 4.2], [11.0, 3.2], [18.0, 1.0]])).unwrap().remove(0);
        assert!(clear.notes.is_empty() && clear.route.len() == 4);
    }
}

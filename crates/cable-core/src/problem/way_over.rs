//! The route between two places is straight, or leads over the obstacles that are in the way.
//!
//! An obstacle is in the way if the route without it would meet it. A beam high above a hill is
//! not: a cable that is led over the hill passes below the beam. The obstacles in the way are
//! therefore found step by step: those that the straight route meets, then those that the route
//! over these meets, and so on. That route touches those over which it leads, so a gap above them
//! that is narrower than the cable is in the way.

use crate::contact::World;
use crate::contact::geometry::Body;
use crate::contact::sweep::WayEnd;
use crate::math::{Vec2, cross};

/// Clearance of a route over a corner or circle, as a multiple of the distance of the centre line
/// of a touching cable. Smaller: the route is pushed out of the obstacle once more; larger: it
/// begins farther from its equilibrium. A choice, tuned on no campaign, as are the two below.
const TOP_CLEARANCE: f64 = 1.05;
/// Additional clearance, m, for cables so thin that the factor has no effect. Smaller and larger:
/// as above.
const TOP_CLEARANCE_M: f64 = 2e-3;
/// Radius of the polygon round a circle, as a multiple of the clearance, so that its sides are
/// clear as well: 1/cos of half a side, 5.6°, is 1.005. Smaller: sides cut into the circle; larger:
/// as for the clearance.
const CIRCLE_POLYGON: f64 = 1.02;

/// Returns the bodies of a world that are in the way from `a` to `b` (m), in order. The route over
/// them may still meet one of them, if an end is below its overhang.
pub(crate) fn bodies_in_the_way(world: &World, a: Vec2, b: Vec2) -> Vec<usize> {
    let geometry = world.geometry();
    let count = geometry.bodies().len();
    let mut found: Vec<usize> = Vec::new();
    let mut way = vec![a, b];
    for _ in 0..=count {
        let end = |k: usize| if k == 0 || k + 1 == way.len() { WayEnd::Support } else { WayEnd::Bend };
        let legs = way.windows(2).enumerate();
        let met: Vec<usize> =
            legs.flat_map(|(k, leg)| geometry.bodies_between([leg[0], leg[1]], [end(k), end(k + 1)])).collect();
        let before = found.len();
        for body in met {
            if !found.contains(&body) {
                found.push(body);
            }
        }
        if found.len() == before {
            break;
        }
        way = hull(world, &found, [a, b], |body| body.offset);
    }
    found.sort_unstable();
    found
}

/// Returns the upper convex hull of `a`, `b` (m) and the tops of `bodies` between them, from `a` to
/// `b`.
pub(crate) fn hull_over(world: &World, bodies: &[usize], a: Vec2, b: Vec2) -> Vec<Vec2> {
    hull(world, bodies, [a, b], |body| TOP_CLEARANCE * body.offset + TOP_CLEARANCE_M)
}

/// The same, with the distance (m) of the hull from each body.
fn hull(world: &World, bodies: &[usize], [a, b]: [Vec2; 2], clearance: impl Fn(&Body) -> f64) -> Vec<Vec2> {
    let (low, high) = (a.x.min(b.x), a.x.max(b.x));
    let bodies = bodies.iter().filter_map(|k| world.geometry().bodies().get(*k));
    let mut corners: Vec<Vec2> =
        bodies.flat_map(|body| tops(body, clearance(body))).filter(|p| p.x > low && p.x < high).collect();
    corners.extend([a, b]);
    corners.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    let mut hull: Vec<Vec2> = Vec::new();
    for p in corners {
        while let [.., u, v] = hull[..] {
            if cross(v - u, p - u) < 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(p);
    }
    if a.x > b.x {
        hull.reverse();
    }
    hull
}

/// Returns points at a distance (m) above every corner of a body, or around its circle.
fn tops(body: &Body, clear: f64) -> Vec<Vec2> {
    let mut out = Vec::new();
    for k in 0..=body.edges.len() {
        if let Some(c) = body.corner(k) {
            out.extend([-clear, 0.0, clear].map(|dx| c.at + Vec2::new(dx, clear)));
        }
    }
    if let Some(c) = body.center {
        out.extend((0..=16).map(|k| {
            let angle = std::f64::consts::PI * f64::from(k) / 16.0;
            c + Vec2::new(angle.cos(), angle.sin()) * (CIRCLE_POLYGON * clear)
        }));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::scene::{Obstacle, Shape};

    const RADIUS: f64 = 0.015;

    /// A pipe that lay on a box was not in the way over that box, and the cable was laid between.
    #[test]
    fn issue_016_a_gap_narrower_than_the_cable_is_in_the_way() {
        let body = |shape: Shape| Obstacle { name: String::new(), shape, friction: None };
        for (gap, narrow) in [(0.0, true), (0.9, true), (-3.0, true), (1.2, false), (4.0, false)] {
            let box_m = vec![[3.0, -0.3], [3.5, -0.3], [3.5, 0.3], [3.0, 0.3]];
            let pipe_radius = 0.28;
            let center_m = [3.4, 0.3 + gap * 2.0 * RADIUS + pipe_radius];
            let obstacles =
                [body(Shape::Polygon { points_m: box_m }), body(Shape::Circle { center_m, radius_m: pipe_radius })];
            let world = World::new(&obstacles, 0.5, RADIUS);
            for (a, b) in [([0.0, 0.2], [7.0, 0.015]), ([7.0, 0.015], [0.0, 0.2])] {
                let found = bodies_in_the_way(&world, vec2(a), vec2(b));
                let wanted = if narrow { vec![0, 1] } else { vec![0] };
                assert_eq!(found, wanted, "a gap of {gap} diameters, {a:?} to {b:?}");
            }
        }
    }
}

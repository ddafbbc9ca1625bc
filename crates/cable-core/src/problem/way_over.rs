//! The route between two places is straight, or leads over the obstacles that are in the way.
//!
//! An obstacle is in the way if the route without it would meet it. A beam high above a hill is
//! not: a cable that is led over the hill passes below the beam. The obstacles in the way are
//! therefore found step by step: those that the straight route meets, then those that the route
//! over these meets, and so on.

use crate::contact::World;
use crate::contact::geometry::Body;
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
        let met: Vec<usize> = way.windows(2).flat_map(|leg| geometry.bodies_between(leg[0], leg[1])).collect();
        let before = found.len();
        for body in met {
            if !found.contains(&body) {
                found.push(body);
            }
        }
        if found.len() == before {
            break;
        }
        way = hull_over(world, &found, a, b);
    }
    found.sort_unstable();
    found
}

/// Returns the upper convex hull of `a`, `b` (m) and the tops of `bodies` between them, from `a` to
/// `b`.
pub(crate) fn hull_over(world: &World, bodies: &[usize], a: Vec2, b: Vec2) -> Vec<Vec2> {
    let (low, high) = (a.x.min(b.x), a.x.max(b.x));
    let bodies = bodies.iter().filter_map(|k| world.geometry().bodies().get(*k));
    let mut corners: Vec<Vec2> = bodies.flat_map(tops).filter(|p| p.x > low && p.x < high).collect();
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

/// Returns points just above every corner of a body, or around its circle.
fn tops(body: &Body) -> Vec<Vec2> {
    let clear = TOP_CLEARANCE * body.offset + TOP_CLEARANCE_M;
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

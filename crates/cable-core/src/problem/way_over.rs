//! The way from one place to another goes straight, or over what is in the way.
//!
//! Over everything that stands between the two places would be too much: a beam high above a hill
//! has nothing to do with how a cable is led over the hill. What is in the way is therefore found
//! step by step: what the straight way meets, then what the way over that meets, and so on.

use crate::contact::World;
use crate::contact::geometry::Body;
use crate::math::{Vec2, cross};

/// Clearance of a way over a corner or circle, in distances of the centre line of a touching cable
/// … Smaller: the way is pushed out of the obstacle once more; larger: it begins farther from its
/// rest. A choice, tuned on no campaign, as are the two below.
const TOP_CLEARANCE: f64 = 1.05;
/// … and this much more, m, for cables so thin that the factor is nothing. Smaller and larger: as
/// above.
const TOP_CLEARANCE_M: f64 = 2e-3;
/// Radius of the polygon round a circle in clearances, so that its sides are clear as well: 1/cos
/// of half a side, 5.6°, is 1.005. Smaller: sides cut into the circle; larger: as of the clearance.
const CIRCLE_POLYGON: f64 = 1.02;

/// The bodies of a world that are in the way from `a` to `b` (m), in order; all of them where there
/// is no way over those.
pub(crate) fn bodies_in_the_way(world: &World, a: Vec2, b: Vec2) -> Vec<usize> {
    let geometry = world.geometry();
    let count = geometry.bodies().len();
    let mut found: Vec<usize> = Vec::new();
    let mut way = vec![a, b];
    for _ in 0..=count {
        let met: Vec<usize> = way.windows(2).flat_map(|leg| geometry.bodies_between(leg[0], leg[1])).collect();
        if met.is_empty() {
            found.sort_unstable();
            return found;
        }
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
    (0..count).collect()
}

/// The upper hull of the places `a` and `b` (m) and of the tops of some bodies between them, from
/// `a` to `b`.
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

/// Points just clear of the top of every corner and of the circle of a body.
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

//! This module makes the first guess: straight lines from wheel to wheel, with the material spread
//! evenly along them.

use super::sliding_problem::WheelArc;
use super::supports_and_loads::{SupportLayout, SupportNode, angle_of};
use crate::math::{Vec2, larger};
use crate::problem::Problem;
use crate::problem::wheel_passage::{angle_near, turn_through_centre};

/// Material of dangling ends of a cable that is too short for its way, as a fraction of its length.
/// Smaller: an end that pays out from nothing; larger: spans that begin tauter than they are. A
/// choice, tuned on no campaign.
const TAUT_SPARE_FRACTION: f64 = 0.05;

/// The arcs of straight ways from wheel to wheel.
pub(super) fn first_arcs(layout: &SupportLayout) -> Vec<WheelArc> {
    let all = &layout.anchors;
    let hang = |force: Vec2| if force.norm() > 0.0 { force } else { layout.weight };
    let hanging = |way: Vec2| (way, Some(angle_of(way)));
    let arc = |k: usize, a: &SupportNode| {
        let before = k.checked_sub(1).and_then(|j| all.get(j));
        // The ways from and to the neighbours, or along the loads, and the angles of the tangents.
        let (from, arrive) = match before {
            Some(b) => (a.at - b.at, tangent(b, a)),
            None => hanging(-hang(layout.end_force[0] + layout.weight)),
        };
        let (to, leave) = match all.get(k + 1) {
            Some(b) => (b.at - a.at, tangent(a, b)),
            None => hanging(hang(layout.end_force[1] + layout.weight)),
        };
        let arrive = arrive.unwrap_or(0.0);
        let turn = a.facing * (arrive - leave.unwrap_or(arrive));
        let turn = larger(angle_near(turn, turn_through_centre(a.facing, from, to)), 0.0);
        WheelArc { arrive, turn, mark: arrive - 0.5 * a.facing * turn, material: a.radius * turn }
    };
    all.iter().enumerate().map(|(k, a)| if a.radius == 0.0 { WheelArc::default() } else { arc(k, a) }).collect()
}

/// Direction of the straight line that touches two anchors one after the other, rad. With t along
/// it, n = perp t and the touch points c + f R n: (c₂ − c₁)·n = f₁R₁ − f₂R₂. None where they are in
/// one place.
fn tangent(from: &SupportNode, to: &SupportNode) -> Option<f64> {
    let d = to.at - from.at;
    let apart = d.norm();
    let aside = (to.facing * to.radius - from.facing * from.radius) / apart;
    // Wheels that overlap have no such line.
    (apart > 0.0).then(|| angle_of(d) + aside.clamp(-1.0, 1.0).asin())
}

/// Returns the arc length (m) of each anchor with the material spread evenly along the way.
///
/// Along the route the ends of the scene give, else straight from anchor to anchor; a dangling
/// end takes what a taut cable leaves over.
pub(super) fn spread(layout: &SupportLayout, p: &Problem) -> Vec<f64> {
    let way = way(layout, p);
    let (n, total) = (layout.anchors.len(), way.1);
    let way = way.0;
    let last = way[n - 1];
    let spare = if p.length > last - way[0] { p.length - (last - way[0]) } else { TAUT_SPARE_FRACTION * p.length };
    // Known material points, as (way, s), the ends of the cable where they dangle included.
    let mut known: Vec<(f64, f64)> = Vec::with_capacity(n + 2);
    if layout.free[0] {
        let head = if p.route.len() > 1 {
            way[0]
        } else if layout.free[1] {
            0.5 * spare
        } else {
            spare
        };
        known.push((way[0] - head, 0.0));
    }
    known.extend(layout.anchors.iter().zip(&way).filter_map(|(a, w)| a.material_point.map(|s| (*w, s))));
    if layout.free[1] {
        let tail = if p.route.len() > 1 {
            total - last
        } else if layout.free[0] {
            0.5 * spare
        } else {
            spare
        };
        known.push((last + tail, p.length));
    }
    layout
        .anchors
        .iter()
        .zip(&way)
        .map(|(a, w)| {
            a.material_point.unwrap_or_else(|| {
                let k = known.partition_point(|(kw, _)| kw <= w).clamp(1, known.len().max(2) - 1);
                match (known.get(k - 1), known.get(k)) {
                    (Some(a), Some(b)) if b.0 > a.0 => a.1 + (b.1 - a.1) * (w - a.0) / (b.0 - a.0),
                    _ => 0.5 * p.length,
                }
            })
        })
        .collect()
}

/// Returns the distance of each anchor along the way, and the length of the whole way, m.
fn way(layout: &SupportLayout, p: &Problem) -> (Vec<f64>, f64) {
    if p.route.len() > 1 {
        let (mut from, mut total) = (0.0, 0.0);
        let mut out = Vec::with_capacity(layout.anchors.len());
        for w in p.route.windows(2) {
            total += (w[1] - w[0]).norm();
        }
        for a in &layout.anchors {
            from = nearest_along(&p.route, a.at, from);
            out.push(from);
        }
        return (out, total);
    }
    let out = taut_arc_lengths(layout);
    let total = out.last().copied().unwrap_or(0.0);
    (out, total)
}

/// Returns the distance (m) of each anchor along a taut cable: from tangent point to tangent point,
/// and round the wheels to their marks.
pub(super) fn taut_arc_lengths(layout: &SupportLayout) -> Vec<f64> {
    let arcs = first_arcs(layout);
    let mut out = Vec::with_capacity(layout.anchors.len());
    let touches = |k: usize| {
        let (a, arc) = (&layout.anchors[k], &arcs[k]);
        (a.touch(arc.arrive), a.touch(arc.arrive - a.facing * arc.turn), 0.5 * a.radius * arc.turn)
    };
    let mut sum = 0.0;
    for k in 0..layout.anchors.len() {
        if k > 0 {
            let (before, here) = (touches(k - 1), touches(k));
            sum += before.2 + (here.0 - before.1).norm() + here.2;
        }
        out.push(sum);
    }
    out
}

/// Arc length along a polyline of its point nearest to `p`, not before `from`, m.
pub(super) fn nearest_along(line: &[Vec2], p: Vec2, from: f64) -> f64 {
    let (mut best, mut best_distance, mut sum) = (from, f64::INFINITY, 0.0);
    for w in line.windows(2) {
        let d = w[1] - w[0];
        let l = d.norm();
        if l > 0.0 {
            let u = ((p - w[0]).dot(&d) / (l * l)).clamp(0.0, 1.0);
            let at = sum + u * l;
            let distance = (w[0] + d * u - p).norm();
            if at >= from && distance < best_distance {
                (best, best_distance) = (at, distance);
            }
        }
        sum += l;
    }
    best
}

//! This module makes the nodes of an answer: those of the mesh, with points on the rounds of
//! sliding nodes.

use crate::math::Vec2;
use crate::model::fem::results::forces::{
    curvature_at, end_tensions, force_at_break, half, moments, shear, signed_tension, tension_at_node,
};
use crate::model::fem::results::points_on_round::points_on_round;
use crate::model::fem::state::CableState;
use crate::solution::Node;

/// Least arc length between two points of an answer on a round, m. Smaller: two nodes at one place;
/// larger: points of small rounds are lost.
const LEAST_POINT_DISTANCE_M: f64 = 1e-9;

/// Room for so many points on each round: more are rare, and only cost a copy.
const USUAL_POINTS_ON_ROUND: usize = 8;

/// The nodes of the answer, with points on the rounds of sliding nodes.
pub(super) fn nodes(d: &CableState, x: &[Vec2], v: &[Vec2], tension: &[f64], ends: &[Vec2; 2]) -> Vec<Node> {
    let (mesh, n) = (&d.mesh, x.len());
    let area = d.problem.cable.area_m2();
    let moments = moments(d, x);
    let node = |s: f64, (x, v): (Vec2, Vec2), t: f64, (curvature_per_m, force): (f64, Vec2)| Node {
        arc_length_m: s,
        x_m: x.x,
        y_m: x.y,
        vx_m_per_s: v.x,
        vy_m_per_s: v.y,
        tension_n: t,
        strain: t / d.problem.axial_stiffness,
        stress_pa: t / area,
        curvature_per_m,
        force_n: force.into(),
        ..Node::default()
    };
    let rounds = mesh.sliding.iter().flatten().count();
    let mut out: Vec<Node> = Vec::with_capacity(n + rounds * USUAL_POINTS_ON_ROUND);
    let at_ends = end_tensions(mesh, x, *ends);
    for k in 0..n {
        if let (Some(sliding), Some(load)) = (&mesh.sliding[k], d.load(k)) {
            for p in points_on_round(d, k, sliding, &load, x, tension) {
                let along = p.force.try_normalize(0.0).unwrap_or_default();
                let velocity = v[k] - along * (d.motion.slide_rates[k] * p.stretch);
                let curvature =
                    if sliding.end.radius > 0.0 { p.stretch * sliding.end.sense / sliding.end.radius } else { 0.0 };
                if out.last().is_none_or(|l: &Node| p.arc_length > l.arc_length_m + LEAST_POINT_DISTANCE_M) {
                    out.push(node(p.arc_length, (p.at, velocity), p.tension, (curvature, p.force)));
                } else if let Some(last) = out.last_mut() {
                    last.force_n = p.force.into();
                }
            }
            continue;
        }
        // Ends of pieces at a break.
        let broken = match k {
            k if k > 0 && mesh.is_break(k - 1) => Some(force_at_break(d, x, tension, k, 1)),
            k if k + 1 < n && mesh.is_break(k) => Some(force_at_break(d, x, tension, k, 0)),
            _ => None,
        };
        let t = match k {
            0 => at_ends[0],
            k if k + 1 == n => at_ends[1],
            _ if broken.is_some() => {
                let bar = if mesh.is_break(k - 1) { k } else { k - 1 };
                broken.map_or(0.0, |force| signed_tension(mesh, bar, x, force))
            }
            k => tension_at_node(d, x, tension, k),
        };
        let bar = |e: usize| mesh.direction(e, x) * tension[e] + shear(mesh, &moments, e, x);
        let force = match k {
            0 => ends[0] + shear(mesh, &moments, 0, x),
            k if k + 1 == n => ends[1] + shear(mesh, &moments, k - 1, x),
            _ if broken.is_some() => broken.unwrap_or_default(),
            k => bar(k) + d.input.loads.body * half(d, k, 1, x),
        };
        // A round that reaches up to the node within one point ends there.
        let begins = k > 0 && mesh.is_break(k - 1);
        while !begins && out.last().is_some_and(|l: &Node| l.arc_length_m >= mesh.arc_length[k]) {
            out.pop();
        }
        let node = node(mesh.arc_length[k], (x[k], v[k]), t, (curvature_at(mesh, k, x), force));
        // Relaxation branches add their forces to that of the strain.
        let beside = if k == 0 { 0..1 } else { k - 1..if k + 1 < n { k + 1 } else { k } };
        let count = beside.len() as f64;
        let by_branches =
            beside.map(|e| if tension[e] > 0.0 { mesh.branch_forces.sum(e) } else { 0.0 }).sum::<f64>() / count;
        out.push(Node { strain: node.strain - by_branches / d.problem.axial_stiffness, ..node });
    }
    out
}

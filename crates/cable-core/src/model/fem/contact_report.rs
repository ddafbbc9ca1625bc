//! Reads tensions, reactions and contacts out of a state.

use super::contact_set::{Rub, SLIDE, Touch};
use super::dynamics::Dynamics;
use crate::contact::friction;
use crate::energy::bending::turn;
use crate::math::Vec2;
use crate::problem::Problem;
use crate::solution::{CableSolution, ContactReport, ContactState, Node, SupportReaction};

/// The answer at positions `x` and velocities `v`.
#[must_use]
pub fn solution(d: &Dynamics, x: &[Vec2], v: &[Vec2]) -> CableSolution {
    let problem = &d.problem;
    let tension = bar_tensions(d, x);
    let ends = end_forces(d, x, &tension);
    CableSolution {
        name: problem.cable.name.clone(),
        nodes: nodes(d, (x, v), &tension, &ends),
        supports: supports(d, x, &ends),
        contacts: contacts(d, x, &tension),
        ..CableSolution::default()
    }
}

/// Tension of each bar, N (a slack one pushes a little: 0 is reported).
fn bar_tensions(d: &Dynamics, x: &[Vec2]) -> Vec<f64> {
    let mesh = &d.mesh;
    (0..mesh.rest_length.len())
        .map(|e| {
            let t = mesh.bar(e).tension((x[e + 1] - x[e]).norm());
            if t < 0.0 { 0.0 } else { t }
        })
        .collect()
}

/// Tension force (N) at the start of the first bar and at the end of the last: that of the middle plus what acts on
/// the half between. On the ground what acts on the half is guessed from the next node.
fn end_forces(d: &Dynamics, x: &[Vec2], tension: &[f64]) -> [Vec2; 2] {
    let n = x.len();
    let end = |node: usize, next: usize, e: usize, sign: f64| {
        let way = x[e + 1] - x[e];
        let middle = if way.norm() > 0.0 { way * (tension[e] / way.norm()) } else { way };
        let half = d.mesh.share(node);
        let body = d.problem.body_force(d.time()) * half;
        let lies = d.problem.world.signed_gap(x[node], 3.0 * super::dynamics::REACH).is_some();
        let ground = if lies { ground_force(d, next, x) * (half / d.mesh.share(next)) } else { Vec2::zeros() };
        middle + (body + ground) * sign
    };
    if n < 3 {
        return [Vec2::zeros(); 2];
    }
    [end(0, 1, 0, 1.0), end(n - 1, n - 2, n - 2, -1.0)]
}

/// Normal and friction force of edges and floor on a node, N.
fn ground_force(d: &Dynamics, node: usize, x: &[Vec2]) -> Vec2 {
    let mut sum = Vec2::zeros();
    for rub in d.contacts.rubs.iter().filter(|r| r.touch.node == node && !r.touch.on_segment) {
        sum += rub.touch.pair.gap.normal * rub.touch.load(&d.contacts.barrier) + rub_force(rub, x);
    }
    if let Some(&limit) = d.task.floor_limit.get(node) {
        sum -= friction::at_plane(d.contacts.floor_slid[node], limit, SLIDE).1;
    }
    sum
}

/// Friction force on the cable, N.
fn rub_force(rub: &Rub, x: &[Vec2]) -> Vec2 {
    -rub.tangent * friction::at(rub.sliding(x), rub.limit, SLIDE).1
}

fn nodes(d: &Dynamics, (x, v): (&[Vec2], &[Vec2]), tension: &[f64], ends: &[Vec2; 2]) -> Vec<Node> {
    let (mesh, n) = (&d.mesh, x.len());
    let area = d.problem.cable.area_m2();
    (0..n)
        .map(|k| {
            let t = match k {
                0 if mesh.held[0] => ends[0].norm(),
                k if k + 1 == n && mesh.held[k] => ends[1].norm(),
                0 => d.task.force[0].norm().min(tension[0]),
                k if k + 1 == n => d.task.force[k].norm().min(tension[k - 1]),
                k => 0.5 * (tension[k - 1] + tension[k]),
            };
            let mut curvature = 0.0;
            if k > 0 && k + 1 < n {
                let rest = 0.5 * (mesh.arc_length[k + 1] - mesh.arc_length[k - 1]);
                curvature = turn(x[k] - x[k - 1], x[k + 1] - x[k]) / rest;
            } else if let Some(clamp) = mesh.clamps.iter().find(|c| c.node == k) {
                let e = if k == 0 { 0 } else { k - 1 };
                let bend = turn(clamp.direction, x[e + 1] - x[e]);
                let sign = if k == 0 { 1.0 } else { -1.0 };
                curvature = sign * bend / (0.5 * (mesh.arc_length[e + 1] - mesh.arc_length[e]));
            }
            Node {
                arc_length_m: mesh.arc_length[k],
                x_m: x[k].x,
                y_m: x[k].y,
                vx_m_per_s: v[k].x,
                vy_m_per_s: v[k].y,
                tension_n: t,
                strain: t / d.problem.axial_stiffness,
                stress_pa: t / area,
                curvature_per_m: curvature,
            }
        })
        .collect()
}

fn supports(d: &Dynamics, x: &[Vec2], ends: &[Vec2; 2]) -> Vec<SupportReaction> {
    let problem: &Problem = &d.problem;
    problem
        .supports
        .iter()
        .zip(&d.support_node)
        .map(|(s, node)| {
            let node = node.unwrap_or(0);
            let last = x.len() - 1;
            let lies = problem.world.signed_gap(x[node], 3.0 * super::dynamics::REACH).is_some();
            let reaction = match node {
                _ if !d.mesh.held[node] => Vec2::zeros(),
                // On the ground the end's own share of weight and friction is the ground's, not the support's.
                0 if lies => ends[0],
                k if k == last && lies => -ends[1],
                _ => d.reaction[node],
            };
            SupportReaction {
                name: s.name.clone(),
                x_m: x[node].x,
                y_m: x[node].y,
                reaction_x_n: reaction.x,
                reaction_y_n: reaction.y,
                arc_length_m: d.mesh.arc_length[node],
                tension_before_n: None,
                tension_after_n: None,
            }
        })
        .collect()
}

/// One report for each stretch of neighbouring contacts with one obstacle.
fn contacts(d: &Dynamics, x: &[Vec2], tension: &[f64]) -> Vec<ContactReport> {
    let mut touches: Vec<Touch> = Vec::new();
    d.contacts.find(&d.problem, &d.mesh, x, &mut touches);
    let mut obstacles: Vec<usize> = touches.iter().map(|t| t.pair.gap.obstacle).collect();
    obstacles.sort_unstable();
    obstacles.dedup();
    let mut out = Vec::new();
    for obstacle in obstacles {
        let mut stretch: Vec<Touch> = Vec::new();
        for t in touches.iter().filter(|t| t.pair.gap.obstacle == obstacle) {
            if stretch.last().is_some_and(|l| t.node > l.node + 1) {
                out.push(report(d, x, tension, &stretch));
                stretch.clear();
            }
            stretch.push(*t);
        }
        out.push(report(d, x, tension, &stretch));
    }
    out.retain(|c| c.normal_n > 0.0);
    out.sort_by(|a, b| a.arc_length_m.total_cmp(&b.arc_length_m));
    out
}

fn report(d: &Dynamics, x: &[Vec2], tension: &[f64], stretch: &[Touch]) -> ContactReport {
    let (Some(first), Some(last)) = (stretch.first(), stretch.last()) else {
        return ContactReport::default();
    };
    let bars = tension.len();
    let before = if first.on_segment { first.node } else { first.node.saturating_sub(1) };
    let after = last.node.min(bars - 1);
    let (mut normal, mut normal_n, mut friction_n) = (Vec2::zeros(), 0.0, 0.0);
    for t in stretch {
        let load = t.load(&d.contacts.barrier);
        normal_n += load;
        normal += t.pair.gap.normal * load;
    }
    let mut slips = 0.0;
    for rub in d.contacts.rubs.iter().filter(|r| {
        r.touch.pair.gap.obstacle == first.pair.gap.obstacle && (first.node..=last.node).contains(&r.touch.node)
    }) {
        let e = rub.touch.node.min(bars - 1);
        let along = (x[e + 1] - x[e]).normalize();
        friction_n += rub_force(rub, x).dot(&along);
        if rub.sliding(x).abs() > 0.999 * SLIDE {
            slips += rub.limit;
        }
    }
    let limit: f64 = stretch.iter().map(|t| t.load(&d.contacts.barrier) * t.pair.gap.friction).sum();
    let (a, b) = (first.interpolate(x), last.interpolate(x));
    let arc = |t: &Touch| {
        let s = &d.mesh.arc_length;
        s[t.node] + if t.on_segment { t.pair.gap.fraction * (s[t.node + 1] - s[t.node]) } else { 0.0 }
    };
    let unit = if normal.norm() > 0.0 { normal.normalize() } else { first.pair.gap.normal };
    let middle = (a + b) * 0.5;
    // Summed bar by bar: a wrap may go round more than once.
    let turned: f64 = (before..after).map(|e| turn(x[e + 1] - x[e], x[e + 2] - x[e + 1])).sum();
    let frictionless = first.pair.gap.friction == 0.0;
    ContactReport {
        obstacle: d.problem.world.obstacle_name(first.pair.gap.obstacle).to_owned(),
        x_m: middle.x,
        y_m: middle.y,
        arc_length_m: 0.5 * (arc(first) + arc(last)),
        normal: [unit.x, unit.y],
        normal_n,
        friction_n,
        state: if frictionless || slips > 0.5 * limit { ContactState::Slip } else { ContactState::Stick },
        turn_deg: turned.to_degrees(),
        tension_before_n: tension[before],
        tension_after_n: tension[after],
    }
}

//! This module computes the forces in the cable, and those of ground and loads on its ends and
//! nodes, from a state.

use crate::contact::friction;
use crate::energy::bending::turn;
use crate::math::{Vec2, larger, perp};
use crate::model::fem::mesh::{Mesh, SlidingNodeLoad};
use crate::model::fem::state::CableState;
use crate::model::fem::system::{ContactPair, Weight, bar_weight};

/// Distance within which a load is at a support, as a fraction of the cable's length: round-off.
/// Smaller: a load that the support carries counts as unbalanced; larger: a load beside it does
/// not.
const SAME_POINT_FRACTION: f64 = 1e-9;

/// Difference of two bars, in parts of their length, up to which they count as equal. It only keeps
/// rounding out: between even bars the tension of a node is their mean.
const EVEN_BARS_LENGTH_FRACTION: f64 = 1e-9;

/// Tension in the middle of the straight part of each bar, N; it may be negative in a stiff cable.
pub(super) fn bar_tensions(d: &CableState, x: &[Vec2]) -> Vec<f64> {
    (0..d.mesh.rest_length.len()).map(|e| bar_tension(d, x, e)).collect()
}

/// Tension of a bar (N): with a sliding node, that in the middle of its straight part.
pub(super) fn bar_tension(d: &CableState, x: &[Vec2], e: usize) -> f64 {
    let path = d.mesh.path(e, x);
    let tension = d.mesh.tension(e, path.length);
    if d.mesh.sliding[e].is_some() || d.mesh.sliding[e + 1].is_some() {
        let material = d.mesh.arc_length[e + 1] - d.mesh.arc_length[e];
        return Weight::of(&d.mesh, e, &path, d.input.loads.body).tension_in_middle(
            tension,
            material,
            d.mesh.is_flexible(),
        );
    }
    tension
}

/// Arc length from a node to the middle of the straight part of the bar before it (`side` 0) or
/// after it (1), m.
pub(super) fn half(d: &CableState, node: usize, side: usize, x: &[Vec2]) -> f64 {
    let e = node + side - 1;
    let material = d.mesh.arc_length[e + 1] - d.mesh.arc_length[e];
    Weight::of(&d.mesh, e, &d.mesh.path(e, x), d.input.loads.body).carried_material(material)[1 - side]
}

/// Tension (N) where the cable comes to the round of a sliding node (`side` 0) or leaves it (1).
/// The node itself is at its mark: between there and the tangent point the cable carries its
/// weight.
pub(super) fn tension_beside_round(
    d: &CableState,
    node: usize,
    load: &SlidingNodeLoad,
    side: usize,
    x: &[Vec2],
) -> f64 {
    let tangent = d.mesh.path(node + side - 1, x).ends[1 - side];
    load.tension[side] + d.input.loads.body.dot(&(x[node] - tangent))
}

/// Tension at inner node `k` between two bars, N: that of their middles, linear in between.
pub(super) fn tension_at_node(d: &CableState, x: &[Vec2], tension: &[f64], k: usize) -> f64 {
    let (mesh, s) = (&d.mesh, &d.mesh.arc_length);
    let slides = [k - 1, k, k + 1].into_iter().any(|j| mesh.sliding[j].is_some());
    let [before, after] =
        if slides { [0, 1].map(|side| half(d, k, side, x)) } else { [s[k] - s[k - 1], s[k + 1] - s[k]] };
    let whole = before + after;
    if !((before - after).abs() > EVEN_BARS_LENGTH_FRACTION * whole) {
        return 0.5 * (tension[k - 1] + tension[k]);
    }
    (tension[k - 1] * after + tension[k] * before) / whole
}

/// Tension (N) where a force acts on the end of bar `e`: the whole force on a flexible cable, the
/// part along a stiff one, which may be pushed.
pub(super) fn signed_tension(mesh: &Mesh, e: usize, x: &[Vec2], force: Vec2) -> f64 {
    if mesh.is_flexible() || force == Vec2::zeros() { force.norm() } else { force.dot(&mesh.direction(e, x)) }
}

/// The tensions at both ends, from the forces there, N.
pub(super) fn end_tensions(mesh: &Mesh, x: &[Vec2], forces: [Vec2; 2]) -> [f64; 2] {
    let last = mesh.rest_length.len().saturating_sub(1);
    [signed_tension(mesh, 0, x, forces[0]), signed_tension(mesh, last, x, forces[1])]
}

/// The force of the ground on the half bar at a held end that lies on it.
pub(super) struct LyingEnd {
    /// The end, and the node beside it.
    pub node: usize,
    pub next: usize,
    pub obstacle: usize,
    /// Unit vector along the cable.
    pub along: Vec2,
    pub normal: Vec2,
    /// Force on the cable, N.
    pub force: Vec2,
}

/// Tension force (N) at the start of the first bar and at the end of the last: at a free end the
/// load there, else the force in the middle of the bar plus the forces on the half bar between. On
/// the ground these are estimated from the next node. The second value is the force of the ground
/// on half bars that lie along an edge.
pub(super) fn end_forces(d: &CableState, x: &[Vec2], tension: &[f64]) -> ([Vec2; 2], [Option<LyingEnd>; 2]) {
    let n = x.len();
    let mut lying_ends = [None, None];
    let mut end = |node: usize, next: usize, e: usize, sign: f64| {
        let ground = d.problem.world.signed_gap(x[node], 3.0 * d.contacts.barrier.reach);
        if let Some(hung) = free_end(d, node) {
            // The ground carries the normal force there, and friction a part of the tangential
            // force, within the friction cone.
            let borne = ground.map_or(Vec2::zeros(), |g| {
                let pressed = hung.dot(&g.normal).min(0.0);
                let along = perp(g.normal);
                let half = d.problem.body_force(d.time()) * d.mesh.tributary_length(node);
                let most = -pressed * g.friction;
                let rubbed = (ground_force(d, node, x) + half).dot(&along).clamp(-most, most);
                g.normal * pressed - along * rubbed
            });
            return (borne - floor_force_on_lump(d, node) - hung) * sign;
        }
        let middle = d.mesh.direction(e, x) * tension[e];
        let half = half(d, node, usize::from(sign > 0.0), x);
        let body = d.problem.body_force(d.time()) * half;
        let Some(ground) = ground else { return middle + body * sign };
        let grounded = ground_force(d, next, x) * (half / d.mesh.tributary_length(next));
        let force = middle + (body + grounded) * sign;
        // A cable that lies on an edge up to its end is pressed along the edge's normal; the gap
        // within the barrier would tilt the last bar.
        let beyond = d.problem.world.signed_gap(x[next], 3.0 * d.contacts.barrier.reach);
        let along = ground.feature % 2 == 0 && beyond.is_some_and(|g| g.feature == ground.feature);
        // The lift is at most the pressing force; with more the support would be pulled off the
        // edge.
        let pressed = larger(grounded.dot(&ground.normal), 0.0);
        let tilt = force.dot(&ground.normal) * sign;
        let lift = if along { if tilt < pressed { tilt } else { pressed } } else { 0.0 };
        // The next node presses more by the force that the tilt lifts here and has more friction;
        // this half has less normal force and less friction.
        let part_left = if pressed > 0.0 { (1.0 - lift / pressed).clamp(0.0, 1.0) } else { 1.0 };
        let rubbed = (grounded - ground.normal * pressed) * (1.0 - part_left);
        let lift = ground.normal * (lift * sign);
        let (grounded, force) = (grounded - rubbed, force - rubbed * sign);
        // The ground also carries the normal force of a point mass; the force on its node includes
        // it.
        lying_ends[usize::from(sign < 0.0)] = d.mesh.fixity[node].then(|| LyingEnd {
            node,
            next,
            obstacle: ground.obstacle,
            along: d.mesh.direction(e, x),
            normal: ground.normal,
            force: grounded - lift * sign,
        });
        force - lift
    };
    if n < 3 {
        return ([Vec2::zeros(); 2], lying_ends);
    }
    ([end(0, 1, 0, 1.0), end(n - 1, n - 2, n - 2, -1.0)], lying_ends)
}

/// The load on a free end, N; None for other nodes, and for a moving point mass, whose inertia acts
/// as well.
fn free_end(d: &CableState, node: usize) -> Option<Vec2> {
    let k = d.meshing.support_node.iter().position(|n| *n == Some(node)).filter(|_| !d.mesh.fixity[node])?;
    if d.motion.hands[k].is_some() {
        return Some(d.problem.hung_on(k, d.time()) - d.answers.reaction[node]);
    }
    let rests = d.problem.supports.get(k)?.mass == 0.0 || !d.motion.inertia_counts();
    rests.then(|| d.problem.hung_on(k, d.time()))
}

/// Plan view: the friction of the floor on the lumped masses of supports at a node, N.
fn floor_force_on_lump(d: &CableState, node: usize) -> Vec2 {
    let on_lump = d.problem.max_floor_friction(0.0, Mesh::lumped_mass(&d.problem, &d.meshing.support_node, node));
    match d.input.loads.floor_limit.get(node) {
        Some(&limit) if limit > 0.0 => {
            friction::at_plane(d.contacts.floor_slip[node], limit, d.contacts.slip).1 * (-on_lump / limit)
        }
        _ => Vec2::zeros(),
    }
}

/// Normal and friction force of edges and floor on a node, N.
fn ground_force(d: &CableState, node: usize, x: &[Vec2]) -> Vec2 {
    let mut sum = Vec2::zeros();
    for contact in d.contacts.friction_contacts.iter().filter(|r| r.touch.node == node && !r.touch.on_segment) {
        sum += contact.touch.pair.gap.normal * contact.touch.load(&d.contacts.barrier)
            + d.contacts.friction_force(contact, x);
    }
    if let Some(&limit) = d.input.loads.floor_limit.get(node) {
        sum -= friction::at_plane(d.contacts.floor_slip[node], limit, d.contacts.slip).1;
    }
    sum
}

/// Sum of all external forces on a cable that no support holds, N: weight, loads, obstacles and
/// floor. Internal forces cancel, so the sum has none of their round-off; it distinguishes a
/// sliding cable from a resting one although each node alone may have a small unbalanced force.
pub(in crate::model::fem) fn unbalanced(d: &CableState, x: &[Vec2], time_s: f64) -> Vec2 {
    let problem = &d.problem;
    let hung: Vec2 = (0..problem.supports.len()).map(|k| problem.hung_on(k, time_s)).sum();
    let at_support = |s: f64| {
        problem
            .supports
            .iter()
            .any(|p| p.arc_length.is_some_and(|a| (a - s).abs() <= SAME_POINT_FRACTION * problem.length))
    };
    let loads: Vec2 = problem.loads.iter().filter(|l| !at_support(l.arc_length)).map(|l| l.force.at(time_s)).sum();
    let mut sum = problem.body_force(time_s) * problem.length + hung + loads;
    let mut touches: Vec<ContactPair> = Vec::new();
    d.contacts.find(problem, &d.mesh, x, &mut touches);
    for touch in &touches {
        sum += touch.pair.gap.normal * touch.load(&d.contacts.barrier);
    }
    for contact in &d.contacts.friction_contacts {
        sum += d.contacts.friction_force(contact, x);
    }
    for k in 0..x.len() {
        let floor = d
            .input
            .loads
            .floor_limit
            .get(k)
            .map(|&l| friction::at_plane(d.contacts.floor_slip[k], l, d.contacts.slip).1);
        if d.mesh.sliding[k].is_some() && k > 0 && k + 1 < x.len() {
            let [before, after] = [k - 1, k].map(|e| {
                let path = d.mesh.path(e, x);
                path.direction * d.mesh.tension(e, path.length)
            });
            sum += before - after - bar_weight::force_on_node(&d.mesh, k, x, problem.body_force(time_s));
            sum -= d.input.loads.on_round(k);
        } else {
            sum -= floor.unwrap_or_default();
        }
    }
    sum
}

/// Tension force (N) of a piece at its end at a break: at the last node `k` of the first piece
/// (`side` 0) or the first node of the second one (1). Nothing pulls at a free end; a support or
/// load there balances the bar.
pub(super) fn force_at_break(d: &CableState, x: &[Vec2], tension: &[f64], k: usize, side: usize) -> Vec2 {
    let loaded = d.meshing.support_node.contains(&Some(k)) || d.meshing.loads.iter().any(|load| load.node == k);
    let e = k + side - 1;
    if loaded { d.mesh.direction(e, x) * tension[e] } else { Vec2::zeros() }
}

/// d(angle)/d(arc length) at a node, 1/m.
pub(super) fn curvature_at(mesh: &Mesh, k: usize, x: &[Vec2]) -> f64 {
    if k > 0 && k + 1 < x.len() && mesh.goes_on_through(k) {
        let rest = 0.5 * (mesh.arc_length[k + 1] - mesh.arc_length[k - 1]);
        return turn(mesh.direction(k - 1, x), mesh.direction(k, x)) / rest;
    }
    let Some(clamp) = mesh.clamps.iter().find(|c| c.node == k) else { return 0.0 };
    let begins = k == 0 || mesh.is_break(k - 1);
    let e = if begins { k } else { k - 1 };
    let sign = if begins { 1.0 } else { -1.0 };
    sign * turn(clamp.direction, x[e + 1] - x[e]) / (0.5 * (mesh.arc_length[e + 1] - mesh.arc_length[e]))
}

/// Bending moment at each node, N·m; empty for a flexible cable.
pub(super) fn moments(d: &CableState, x: &[Vec2]) -> Vec<f64> {
    let mesh = &d.mesh;
    if !(mesh.bending_stiffness > 0.0) {
        return Vec::new();
    }
    let slides = |k: usize| mesh.sliding.get(k).is_some_and(Option::is_some);
    let carries = |k: usize| !(slides(k) || slides(k + 1) || k > 0 && slides(k - 1));
    let stiffness = mesh.bending_stiffness / mesh.thermal_stretch;
    let moment = |k: usize| stiffness * curvature_at(mesh, k, x) + branch_moment(mesh, k);
    (0..x.len()).map(|k| if carries(k) { moment(k) } else { 0.0 }).collect()
}

/// The moment in the relaxation branches of the bend at a node, N·m.
fn branch_moment(mesh: &Mesh, k: usize) -> f64 {
    let ends = |e: Option<usize>| e.is_none_or(|e| mesh.rest_length.get(e).is_none_or(|l| *l == 0.0));
    let slots = match [ends(k.checked_sub(1)), ends(Some(k))] {
        [false, false] => [2 * k, 2 * k + 1],
        [true, _] => [2 * k + 1, 2 * k + 1],
        [false, true] => [2 * k, 2 * k],
    };
    mesh.branch_moments.sum(slots)
}

/// Shear force of bar e, N, which balances the moments at its nodes.
pub(super) fn shear(mesh: &Mesh, moments: &[f64], e: usize, x: &[Vec2]) -> Vec2 {
    let (Some(before), Some(after)) = (moments.get(e), moments.get(e + 1)) else { return Vec2::zeros() };
    let path = mesh.path(e, x);
    if path.length > 0.0 { perp(path.direction) * ((before - after) / path.length) } else { Vec2::zeros() }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::model::Settings;
    use crate::model::fem::first_shape::cable_along_route;
    use crate::problem::problems;
    use crate::scene::{Load, catalog};

    /// A tension that grows evenly along the cable has its own value at nodes between even bars and
    /// between uneven ones.
    #[test]
    fn issue_016_an_even_growth_of_tension_is_seen_at_every_node() {
        let mut scene = catalog::hanging_span();
        let cable = scene.cables[0].name.clone();
        let (arc_length_m, force_n) = (1.3, Some([0.0; 2]));
        scene.loads = vec![Load { cable, arc_length_m, force_n, times_s: Vec::new(), forces_n: Vec::new() }];
        let problem = problems(&scene).unwrap().remove(0);
        let settings = Settings { segments: Some(8), ..Settings::default() };
        let state = cable_along_route(problem, settings, Arc::default());
        let s = &state.mesh.arc_length;
        let bars: Vec<f64> = s.windows(2).map(|pair| 10.0 + 1.5 * (pair[0] + pair[1])).collect();
        assert!((s[1] - s[0] - (s[2] - s[1])).abs() > 0.1, "even bars: {s:?}");
        for k in 1..bars.len() {
            let found = tension_at_node(&state, &state.motion.positions, &bars, k);
            assert!((found - (10.0 + 3.0 * s[k])).abs() < 1e-12, "{found} at {}", s[k]);
        }
    }
}

//! Nodes are added to the mesh and removed from it beside pulleys, and pulleys that let go become
//! nodes.
//!
//! Mass and momentum are conserved, kinetic energy falls or stays (it is convex). A node that is
//! removed shortens the path by the sag it stood for, a new one hangs on that sag: the difference
//! of rest length is spread over the whole stretch between its fixed marks, so that tension does
//! not jump there.

use crate::error::{SolveError, Unsupported};
use crate::math::Vec2;
use crate::model::Model;
use crate::model::mass_spring::mesh::cable_mesh::Mesh;
use crate::numerics::bisect;
use crate::problem::Departure;

/// Material that stays beside a node that does not run through a pulley, m.
pub(in crate::model::mass_spring) fn least_straight_length(mesh: &Mesh) -> f64 {
    mesh.tuning.mesh.blocked_straight_lengths * mesh.even_length
}

/// Brings the elements beside pulleys near the even length.
pub(in crate::model::mass_spring) fn even_out(mesh: &mut Mesh, time_s: f64) {
    mesh.update_elements();
    for _ in 0..mesh.position.len() {
        if !remesh(mesh, time_s) {
            break;
        }
    }
}

/// Keeps the elements beside pulleys near the even length; returns true if nodes have changed.
pub(in crate::model::mass_spring) fn remesh(mesh: &mut Mesh, time_s: f64) -> bool {
    let (min, max) = (mesh.tuning.mesh.min_straight_lengths, mesh.tuning.mesh.max_straight_lengths);
    let mut changed = false;
    for k in 0..mesh.wheels.pulleys.len() {
        for side in 0..2 {
            let i = mesh.wheels.pulleys[k].node;
            let e = i - 1 + side;
            if mesh.straight_length[e] < min * mesh.even_length {
                let n = if side == 0 { i - 1 } else { i + 1 };
                changed |= remove_beside(mesh, k, n);
            } else if mesh.straight_length[e] > max * mesh.even_length {
                halve_beside(mesh, k, e, time_s);
                changed = true;
            }
        }
    }
    changed
}

/// Makes pulleys that hold no more in a sub-step from `begins_s` (s) nodes of the mesh: the
/// material goes on as it slid.
pub(in crate::model::mass_spring) fn release_pulleys(mesh: &mut Mesh, begins_s: f64) {
    let mut k = 0;
    while k < mesh.wheels.pulleys.len() {
        let p = mesh.wheels.pulleys[k];
        if mesh.problem.supports[p.support].holds_from(begins_s) {
            k += 1;
            continue;
        }
        let (n, bars) = (p.node, [p.node - 1, p.node]);
        let [b, a] = bars.map(|e| mesh.element(e));
        let stretch = [b.length / mesh.rest_length[n - 1], a.length / mesh.rest_length[n]];
        let along = (b.direction + a.direction).try_normalize(0.0).unwrap_or_default();
        let outward = (b.direction - a.direction).try_normalize(0.0).unwrap_or_default();
        mesh.velocity[n] -= along * p.sliding_speed;
        mesh.wheels.pulleys.remove(k);
        mesh.wheels.index();
        place_at_length(mesh, n, b.length + a.length, [(b.end + a.start) * 0.5, outward]);
        // Both elements keep their strain; what the shorter path leaves over is shared.
        let needs = [0, 1].map(|side| mesh.element(bars[side]).length / stretch[side]);
        let whole = mesh.arc_length[n + 1] - mesh.arc_length[n - 1];
        mesh.arc_length[n] = mesh.arc_length[n - 1] + whole * needs[0] / (needs[0] + needs[1]);
        mesh.update_elements();
    }
}

/// A wheel that the cable may leave and round which it turns the wrong way: it would have to pull.
pub(in crate::model::mass_spring) fn lifted_wheel(mesh: &Mesh, time_s: f64) -> Option<SolveError> {
    let support = mesh.wheels.pulleys.iter().filter(|p| p.radius > 0.0 && p.turn < 0.0).find_map(|p| {
        mesh.problem
            .supports
            .get(p.support)
            .filter(|support| support.departure == Departure::Possible && support.holds_from(time_s))
    })?;
    let feature = Unsupported::OffWheel { support: support.name.clone() };
    Some(SolveError::Unsupported { model: Model::MassSpring, feature })
}

/// Places node `n` at the distance from a point (m) along a direction at which its elements are
/// `length` (m) long together.
fn place_at_length(mesh: &mut Mesh, n: usize, length: f64, [from, along]: [Vec2; 2]) {
    let fits = |distance: f64| {
        mesh.position[n] = from + along * distance;
        mesh.element(n - 1).length + mesh.element(n).length <= length
    };
    let [distance, _] = bisect([0.0, length], f64::MANTISSA_DIGITS as usize, fits);
    mesh.position[n] = from + along * distance;
}

/// True if a node belongs to the mesh alone, not to a support, load or pulley.
fn is_plain(mesh: &Mesh, n: usize) -> bool {
    n > 0
        && n + 1 < mesh.position.len()
        && mesh.wheels.at_node[n].is_none()
        && !mesh.support_node.contains(&n)
        && !mesh.load_node.contains(&n)
}

/// Removes node `n` beside pulley `k`, if it can go.
fn remove_beside(mesh: &mut Mesh, k: usize, n: usize) -> bool {
    let i = mesh.wheels.pulleys[k].node;
    if !is_plain(mesh, n) {
        return false;
    }
    let far = 2 * n - i;
    // Two wheels keep a node between them.
    if mesh.wheels.at_node[far].is_some() {
        return false;
    }
    let (inner, outer) = if n < i { (n, n - 1) } else { (i, n) };
    let density = mesh.problem.linear_density;
    let (to_far, to_pulley) =
        (0.5 * density * mesh.straight_length[inner], 0.5 * density * mesh.straight_length[outer]);
    let (v, m) = (mesh.velocity[n], mesh.mass[far]);
    if !mesh.supported[far] {
        mesh.velocity[far] = (mesh.velocity[far] * m + v * to_far) / (m + to_far);
    }
    let direction = mesh.element(inner).direction;
    let sliding = -(v - mesh.velocity[i]).dot(&direction);
    let p = &mut mesh.wheels.pulleys[k];
    p.sliding_speed = (p.sliding_speed * p.mass + sliding * to_pulley) / (p.mass + to_pulley);
    let before = mesh.element(inner).length + mesh.element(outer).length;
    let rest = mesh.arc_length[inner.max(outer) + 1] - mesh.arc_length[inner.min(outer)];
    remove_node(mesh, n);
    let merged = if n < i { n - 1 } else { i };
    let after = mesh.element(merged).length;
    spread_length(mesh, merged, rest * (after / before - 1.0));
    true
}

/// Halves element `e` beside pulley `k`.
fn halve_beside(mesh: &mut Mesh, k: usize, e: usize, time_s: f64) {
    let i = mesh.wheels.pulleys[k].node;
    let r = mesh.element(e);
    let u = mesh.wheels.pulleys[k].sliding_speed;
    let other = if e < i { e } else { e + 1 };
    let sliding = mesh.velocity[i] - r.direction * u;
    let velocity = (mesh.velocity[other] + sliding) * 0.5;
    let half = 0.5 * r.straight;
    // The sag of a parabola under its own weight, q L²/8T with the half element L/2 on each
    // side.
    let body = mesh.problem.body_force(time_s);
    let across = body - r.direction * body.dot(&r.direction);
    let sag = across * (0.5 * half * 0.5 * mesh.straight_length[e] / mesh.tension[e]);
    let sag = if sag.norm() <= mesh.tuning.mesh.max_sag_lengths * half { sag } else { Vec2::zeros() };
    let at = (r.start + r.end) * 0.5 + sag;
    let rest = mesh.material_length[e];
    let s = if e < i {
        mesh.arc_length[e] + 0.5 * mesh.straight_length[e]
    } else {
        mesh.arc_length[e + 1] - 0.5 * mesh.straight_length[e]
    };
    insert_node(mesh, e, s, at, velocity);
    let after = mesh.element(e).length + mesh.element(e + 1).length;
    let changed = if e < i { e } else { e + 1 };
    spread_length(mesh, changed, rest * (after / r.length - 1.0));
}

/// Gives element `e` `more` rest length, taken evenly from the rest of its stretch: the nodes up to
/// the next mark shift along the material a little.
fn spread_length(mesh: &mut Mesh, e: usize, more: f64) {
    let mark = |n: usize| n == 0 || n + 1 == mesh.position.len() || !is_plain(mesh, n);
    let mut first = e;
    while !mark(first) {
        first -= 1;
    }
    let mut last = e + 1;
    while !mark(last) {
        last += 1;
    }
    let others: f64 = (first..last).filter(|&k| k != e).map(|k| mesh.material_length[k]).sum();
    if others > 0.0 && more.abs() < mesh.tuning.mesh.max_spread_fraction * others {
        let mut s = mesh.arc_length[first];
        for k in first..last - 1 {
            s += if k == e { mesh.material_length[k] + more } else { mesh.material_length[k] * (1.0 - more / others) };
            mesh.arc_length[k + 1] = s;
        }
    }
    mesh.update_elements();
}

fn remove_node(mesh: &mut Mesh, n: usize) {
    let [before, after] = [mesh.material_length[n - 1], mesh.material_length[n]];
    mesh.excess[n] = (before * mesh.excess[n - 1] + after * mesh.excess[n]) / (before + after);
    mesh.spring_memory.merge(n - 1, before / (before + after));
    mesh.bend_memory.remove_node(n);
    for list in [&mut mesh.arc_length, &mut mesh.mass, &mut mesh.point_mass] {
        list.remove(n);
    }
    for list in [&mut mesh.position, &mut mesh.velocity, &mut mesh.force, &mut mesh.support_acceleration] {
        list.remove(n);
    }
    mesh.supported.remove(n);
    mesh.wheels.at_node.remove(n);
    for list in [
        &mut mesh.material_length,
        &mut mesh.rest_length,
        &mut mesh.straight_length,
        &mut mesh.tension,
        &mut mesh.excess,
    ] {
        list.remove(n - 1);
    }
    renumber(mesh, n, -1);
}

fn insert_node(mesh: &mut Mesh, e: usize, s: f64, x: Vec2, v: Vec2) {
    let n = e + 1;
    mesh.spring_memory.divide(e);
    mesh.bend_memory.insert_node(n);
    mesh.arc_length.insert(n, s);
    mesh.mass.insert(n, 0.0);
    mesh.point_mass.insert(n, 0.0);
    mesh.position.insert(n, x);
    mesh.velocity.insert(n, v);
    mesh.force.insert(n, Vec2::zeros());
    mesh.support_acceleration.insert(n, Vec2::zeros());
    mesh.supported.insert(n, false);
    mesh.wheels.at_node.insert(n, None);
    let (tension, excess) = (mesh.tension[e], mesh.excess[e]);
    for (list, value) in [
        (&mut mesh.material_length, 0.0),
        (&mut mesh.rest_length, 0.0),
        (&mut mesh.straight_length, 0.0),
        (&mut mesh.tension, tension),
        (&mut mesh.excess, excess),
    ] {
        list.insert(n, value);
    }
    renumber(mesh, n, 1);
}

/// Moves the indices of nodes from `n` on up or down by one.
fn renumber(mesh: &mut Mesh, n: usize, by: isize) {
    let moved = |k: &mut usize| {
        if *k >= n {
            *k = k.wrapping_add_signed(by);
        }
    };
    mesh.support_node.iter_mut().for_each(moved);
    mesh.load_node.iter_mut().for_each(moved);
    for p in &mut mesh.wheels.pulleys {
        moved(&mut p.node);
    }
    mesh.update_elements();
}

//! This module adds the energies of contacts with obstacles to the equations of a step.

use crate::contact::friction::{self, Branch};
use crate::energy::Curvature;
use crate::math::{Mat2, Vec2};
use crate::model::fem::mesh::Mesh;
use crate::model::fem::system::assembly::System;
use crate::model::fem::system::contact::contact_pair::ContactPair;
use crate::model::fem::system::contact::contact_set::ContactSet;
use crate::model::fem::system::step_input::{StepInput, Unknowns, node_scale};

/// Adds a force gradient and a block, shared by the nodes of a contact; sliding nodes get neither.
#[inline]
pub fn add_pair(s: &mut System, mesh: &Mesh, touch: &ContactPair, gradient: Vec2, block: &Mat2) {
    let (node, [a, b]) = (touch.node, touch.shares());
    let moves = |k: usize| mesh.sliding[k].is_none();
    if moves(node) {
        s.add_gradient(node, gradient * a);
        s.add_block(node, node, &(block * (a * a)));
    }
    if b != 0.0 && moves(node + 1) {
        s.add_gradient(node + 1, gradient * b);
        s.add_block(node + 1, node + 1, &(block * (b * b)));
        if moves(node) {
            s.add_block(node, node + 1, &(block * (a * b)));
        }
    }
}

/// Adds the barrier of one contact; returns its energy (J) and its stiffness for a weight of one
/// (N/m). Its distance d from the corner has curvature (θ the turn of the segment, u its direction,
/// c the touching point, all linear in the nodes):
/// ```text
/// node:     ∇²d = (I − n nᵀ)/d  at a corner, 0 at an edge
/// segment:  ∇²d = −(θ qᵀ + q θᵀ) − d θ θᵀ,   q = u·δc,   θ = n·(δb − δa)/l
/// ```
pub fn add_barrier(
    s: &mut System,
    mesh: &Mesh,
    touch: &ContactPair,
    scale: f64,
    contacts: &ContactSet,
    x: &[Vec2],
    curvature: Curvature,
) -> (f64, f64) {
    let (gap, weight) = (&touch.pair.gap, touch.pair.weight * scale);
    let b = contacts.barrier.at(gap.gap_m);
    let (slope, bend) = (b.slope * weight, b.curvature * weight);
    let n = gap.normal;
    let definite = curvature == Curvature::Clipped;
    let bend = if definite && bend < 0.0 { 0.0 } else { bend };
    add_pair(s, mesh, touch, n * slope, &(n * n.transpose() * bend));
    if definite {
        return (b.value * weight, b.curvature);
    }
    if !touch.on_segment {
        let distance = (x[touch.node] - gap.point).norm();
        // Edges have even feature indices: their distance is linear.
        if gap.feature % 2 == 1 && distance > 0.0 {
            s.add_block(touch.node, touch.node, &((Mat2::identity() - n * n.transpose()) * (slope / distance)));
        }
        return (b.value * weight, b.curvature);
    }
    let (i, shares) = (touch.node, touch.shares());
    let [from, to] = mesh.straight(i, x);
    let (d, distance) = (to - from, (from * shares[0] + to * shares[1] - gap.point).norm());
    let length = d.norm();
    let u = d / length;
    let theta = [n * (-1.0 / length), n * (1.0 / length)];
    let q = [u * shares[0], u * shares[1]];
    let block = |a: usize, b: usize| {
        (-(theta[a] * q[b].transpose() + q[a] * theta[b].transpose()) - theta[a] * theta[b].transpose() * distance)
            * slope
    };
    let moves = [0, 1].map(|j| mesh.sliding[i + j].is_none());
    for j in (0..2).filter(|&j| moves[j]) {
        s.add_block(i + j, i + j, &block(j, j));
    }
    if moves == [true, true] {
        s.add_block(i, i + 1, &block(0, 1));
    }
    (b.value * weight, b.curvature)
}

/// Adds the friction of the contacts with obstacles, on the given branches or, without any, on
/// those of the present unknowns; returns its energy, J.
pub fn add_friction(
    s: &mut System,
    mesh: &Mesh,
    input: &StepInput,
    contacts: &ContactSet,
    branches: &[Branch],
    x: &[Vec2],
) -> f64 {
    let mut value = 0.0;
    for (k, contact) in contacts.friction_contacts.iter().enumerate() {
        let scale = input.scale.get(contact.touch.node).copied().unwrap_or(node_scale(input, contact.touch.node));
        let y = contact.sliding(x);
        let (d, mut slope, mut bend) = friction::at(y, contact.limit, contacts.slip);
        if let Some(branch) = branches.get(k) {
            (slope, bend) = branch.force(y, contact.limit, contacts.slip);
        }
        value += d * scale;
        let block = contact.tangent * contact.tangent.transpose() * (bend * scale);
        add_pair(s, mesh, &contact.touch, contact.tangent * (slope * scale), &block);
    }
    value
}

/// Plan view: adds the friction of every node on the floor; returns its energy, J.
pub fn add_floor(s: &mut System, mesh: &Mesh, input: &StepInput, contacts: &ContactSet, unknowns: &Unknowns) -> f64 {
    let mut value = 0.0;
    for (i, &limit) in input.loads.floor_limit.iter().enumerate() {
        let scale = node_scale(input, i);
        if let Some(sliding) = &mesh.sliding[i] {
            let (d, slope, bend) = friction::at(
                contacts.floor_slip[i].x + unknowns.slides[i],
                limit * sliding.floor_factor,
                contacts.slip,
            );
            value += d * scale;
            s.gradient[2 * i] += slope * scale;
            s.hessian.add(2 * i, 2 * i, bend * scale);
        } else {
            let slid = contacts.floor_slip[i] + (unknowns.positions[i] - input.supports.start[i]);
            let (d, slope, bend) = friction::at_plane(slid, limit, contacts.slip);
            value += d * scale;
            s.add_gradient(i, slope * scale);
            s.add_block(i, i, &(bend * scale));
        }
    }
    value
}

//! This module adds the bending forces of the chain (see [`crate::energy::bending`]). A pulley
//! bends the cable without a moment of its own.

use crate::energy::bending::{BendingEnergy, ClampBend, angle_gradient, turn, turn_gradient};
use crate::math::Vec2;
use crate::model::mass_spring::mesh::Mesh;
use crate::scene::SupportKind;

/// Direction that a clamp gives the cable at a node now.
pub(in crate::model::mass_spring) fn clamp_at(mesh: &Mesh, node: usize) -> Option<Vec2> {
    let k = mesh.support_node.iter().position(|&n| n == node)?;
    let support = &mesh.problem.supports[k];
    let angle = support.angle.filter(|_| support.kind == SupportKind::Clamped && mesh.supported[node])?;
    Some(Vec2::new(angle.cos(), angle.sin()))
}

/// Bending energy at an inner node; a pulley has none.
pub(in crate::model::mass_spring) fn bend_at(mesh: &Mesh, n: usize) -> Option<BendingEnergy> {
    let inner = n > 0 && n + 1 < mesh.position.len() && mesh.wheels.at_node[n].is_none();
    inner.then(|| BendingEnergy {
        stiffness: mesh.bending_stiffness,
        length: 0.5 * (mesh.rest_length[n - 1] + mesh.rest_length[n]),
        from: 0.0,
    })
}

/// Bending energy of element `e` against a clamp at one of its ends.
pub(in crate::model::mass_spring) fn clamp_bend(mesh: &Mesh, e: usize, direction: Vec2) -> ClampBend {
    ClampBend { stiffness: mesh.bending_stiffness, length: 0.5 * mesh.rest_length[e], direction, from: 0.0 }
}

/// Adds the forces of bending at a time `since_s` (s) after they were last computed in this motion.
pub(in crate::model::mass_spring) fn add_forces(mesh: &mut Mesh, since_s: f64) {
    if !(mesh.bending_stiffness > 0.0) {
        return;
    }
    mesh.bend_memory.begin_step(since_s);
    for n in 0..mesh.position.len() {
        if let Some(direction) = clamp_at(mesh, n) {
            for e in n.saturating_sub(1)..(n + 1).min(mesh.rest_length.len()) {
                add_clamp_forces(mesh, n, e, direction);
            }
        } else if let Some(bend) = bend_at(mesh, n) {
            let (a, b) = (mesh.position[n] - mesh.position[n - 1], mesh.position[n + 1] - mesh.position[n]);
            let moment = mesh.bend_memory.moment(2 * n, turn(a, b) / bend.length);
            for (j, g) in turn_gradient(a, b).iter().enumerate() {
                mesh.force[n - 1 + j] -= *g * moment;
            }
        }
    }
    mesh.bend_memory.end_step();
}

/// Adds the forces of the bend of element `e` against a clamp at node `n`.
fn add_clamp_forces(mesh: &mut Mesh, n: usize, e: usize, direction: Vec2) {
    let bend = clamp_bend(mesh, e, direction);
    let d = mesh.position[e + 1] - mesh.position[e];
    // Curvature is positive where the cable turns to the left.
    let (slot, sense) = if e < n { (2 * n, -1.0) } else { (2 * n + 1, 1.0) };
    let moment = sense * mesh.bend_memory.moment(slot, sense * turn(direction, d) / bend.length);
    let force = angle_gradient(d) * moment;
    mesh.force[e] += force;
    mesh.force[e + 1] -= force;
}

//! This module adds the bending forces of the chain (see [`crate::energy::bending`]). A pulley
//! bends the cable without a moment of its own.

use crate::energy::Energy;
use crate::energy::bending::{BendingEnergy, ClampBend};
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
        stiffness: mesh.problem.bending_stiffness,
        length: 0.5 * (mesh.rest_length[n - 1] + mesh.rest_length[n]),
        from: 0.0,
    })
}

/// Bending energy of element `e` against a clamp at one of its ends.
pub(in crate::model::mass_spring) fn clamp_bend(mesh: &Mesh, e: usize, direction: Vec2) -> ClampBend {
    ClampBend { stiffness: mesh.problem.bending_stiffness, length: 0.5 * mesh.rest_length[e], direction, from: 0.0 }
}

/// Adds the forces of bending.
pub(in crate::model::mass_spring) fn add_forces(mesh: &mut Mesh) {
    if !(mesh.problem.bending_stiffness > 0.0) {
        return;
    }
    for n in 0..mesh.position.len() {
        if let Some(direction) = clamp_at(mesh, n) {
            for e in n.saturating_sub(1)..(n + 1).min(mesh.rest_length.len()) {
                let g = clamp_bend(mesh, e, direction).gradient(&[mesh.position[e], mesh.position[e + 1]]);
                mesh.force[e] -= g[0];
                mesh.force[e + 1] -= g[1];
            }
        } else if let Some(bend) = bend_at(mesh, n) {
            let g = bend.gradient(&[mesh.position[n - 1], mesh.position[n], mesh.position[n + 1]]);
            for (j, g) in g.iter().enumerate() {
                mesh.force[n - 1 + j] -= *g;
            }
        }
    }
}

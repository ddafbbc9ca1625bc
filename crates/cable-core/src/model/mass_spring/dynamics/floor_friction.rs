//! The floor of a plan view brakes the nodes that slide on it.

use crate::model::mass_spring::dynamics::momentum::MomentumSums;
use crate::model::mass_spring::mesh::Mesh;

/// Lets the floor of a plan view take up to μ·w·ds·dt of each node's momentum in a time `h` (s),
/// and as much for a lumped mass there as for cable of its mass.
pub(in crate::model::mass_spring) fn floor_friction(mesh: &mut Mesh, account: &mut MomentumSums, h: f64) {
    if mesh.problem.floor_friction.is_none() {
        return;
    }
    for i in 0..mesh.position.len() {
        let before = if i > 0 { mesh.material_length[i - 1] } else { 0.0 };
        let ds = 0.5 * (before + mesh.material_length.get(i).copied().unwrap_or(0.0));
        let speed = mesh.velocity[i].norm();
        let limit = mesh.problem.max_floor_friction(ds, mesh.point_mass[i]);
        let loss = limit * h / mesh.mass[i];
        if !mesh.supported[i] {
            let part_left = if speed <= loss { 0.0 } else { 1.0 - loss / speed };
            account.contacts -= mesh.velocity[i] * ((1.0 - part_left) * mesh.mass[i]);
            mesh.velocity[i] *= part_left;
        }
    }
}

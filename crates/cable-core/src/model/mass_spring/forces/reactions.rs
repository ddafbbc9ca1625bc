//! This module reports the forces of the cable on supports, and of the ground under a supported
//! end.

use crate::contact::Gap;
use crate::math::Vec2;
use crate::model::mass_spring::mesh::Mesh;

/// Speed of a supported node, m/s, below which it does not slide on the ground.
const RESTING_SPEED: f64 = 1e-9;

/// The force of the ground on a supported end of the cable.
pub(in crate::model::mass_spring) struct GroundForce {
    pub gap: Gap,
    /// Normal force, N.
    pub normal_force: f64,
    /// Normal force and friction on the cable, N.
    pub force: Vec2,
}

/// Force of the cable on all that holds node `i`, N: its support, and ground under it.
pub(in crate::model::mass_spring) fn total(mesh: &Mesh, i: usize) -> Vec2 {
    mesh.force[i] - mesh.support_acceleration[i] * mesh.mass[i]
}

/// Force of the cable on the support that holds node `i`, N. Ground under the node carries its
/// share of the weight and rubs on it: without that a drag comes out half an element's friction
/// short.
pub(in crate::model::mass_spring) fn of_support(mesh: &Mesh, i: usize) -> Vec2 {
    let force = total(mesh, i);
    if let Some(p) = mesh.wheels.at(i) {
        // Material that turns round it pulls less by its momentum.
        let turned = mesh.element(i).direction - mesh.element(i - 1).direction;
        return force - turned * (mesh.problem.linear_density * p.sliding_speed * p.sliding_speed);
    }
    force + ground(mesh, i).map_or(Vec2::zeros(), |under| under.force)
}

/// The force of ground under a held end on the cable. At rest the ground can hold
/// what the cable pulls along it, but the support is there for that.
pub(in crate::model::mass_spring) fn ground(mesh: &Mesh, i: usize) -> Option<GroundForce> {
    let force = total(mesh, i);
    let gap = mesh.problem.world.signed_gap(mesh.position[i], mesh.tuning.impact.skin_m)?;
    let normal_force = -force.dot(&gap.normal);
    if !(normal_force > 0.0) {
        return None;
    }
    let along = mesh.velocity[i] - gap.normal * mesh.velocity[i].dot(&gap.normal);
    let rubbing = along.try_normalize(RESTING_SPEED).unwrap_or_default() * (gap.friction * normal_force);
    Some(GroundForce { gap, normal_force, force: gap.normal * normal_force - rubbing })
}

//! A cable that is deep inside an obstacle is refused.

use crate::error::SolveError;
use crate::model::Model;
use crate::model::mass_spring::mesh::Mesh;

/// Refuses to go on from where the middle of the cable is inside an obstacle: distances have no
/// sign there, and what should push it out would hold it in. A shallow penetration is pushed
/// out.
pub(in crate::model::mass_spring) fn refuse_buried(mesh: &Mesh) -> Result<(), SolveError> {
    let world = &mesh.problem.world;
    if world.is_empty() {
        return Ok(());
    }
    let free = (0..mesh.position.len()).filter(|&n| !mesh.supported[n] && mesh.wheels.at_node[n].is_none());
    let gaps = free.filter_map(|n| Some((n, world.signed_gap(mesh.position[n], f64::INFINITY)?)));
    let inside = gaps.filter(|(_, gap)| gap.gap_m < -mesh.problem.radius);
    if let Some((n, deepest)) = inside.min_by(|a, b| a.1.gap_m.total_cmp(&b.1.gap_m)) {
        return Err(SolveError::Buried {
            model: Model::MassSpring,
            obstacle: world.obstacle_name(deepest.obstacle).to_owned(),
            depth_m: -deepest.gap_m,
            arc_length_m: mesh.arc_length[n],
            at_m: mesh.position[n],
        });
    }
    Ok(())
}

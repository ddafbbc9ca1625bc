//! This module decides whether a dynamic step is explicit or a preview.

use crate::model::mass_spring::mesh::Mesh;
use crate::model::settings::Stepping;

/// A display frame, s.
pub(in crate::model::mass_spring) const FRAME_S: f64 = 1.0 / 60.0;

/// True if a dynamic step is to be a preview.
pub(in crate::model::mass_spring) fn is_preview(mesh: &Mesh, stepping: Stepping) -> bool {
    if mesh.problem.bending_stiffness > 0.0 {
        return false;
    }
    match stepping {
        Stepping::Explicit => false,
        Stepping::Preview => true,
        // The test uses even elements: short ones beside a pulley come and go, and a run must keep
        // its integrator.
        Stepping::Auto => {
            let wave_speed = (mesh.problem.axial_stiffness / mesh.problem.linear_density).sqrt();
            mesh.even_length / wave_speed * mesh.tuning.sub_step.max_per_frame < FRAME_S
        }
    }
}

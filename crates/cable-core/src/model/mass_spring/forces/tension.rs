//! Tensions at nodes as a gauge takes them in every sub-step.

use crate::math::{Vec2, larger};
use crate::model::mass_spring::forces::reactions;
use crate::model::mass_spring::mesh::Mesh;

/// Tension at a node, N: the mean of the elements beside it, the greater of both sides of a pulley,
/// and at a supported end the force that holds it, ground beside it left out.
pub(in crate::model::mass_spring) fn at_node(mesh: &Mesh, i: usize) -> f64 {
    let e = match i.checked_sub(1) {
        Some(e) if i < mesh.rest_length.len() => {
            return match mesh.wheels.at(i) {
                Some(p) => larger(p.tension[0], p.tension[1]),
                None => 0.5 * (mesh.tension[e] + mesh.tension[i]),
            };
        }
        before => before.unwrap_or(0),
    };
    if !mesh.supported[i] {
        return mesh.tension[e];
    }
    let force = reactions::total(mesh, i);
    if mesh.bending_stiffness > 0.0 { along_end(i, force, mesh.element(e).direction) } else { force.norm() }
}

/// The part (N) of the force of the cable on what holds its end `i` along the cable there: negative
/// if a stiff cable pushes.
pub(in crate::model::mass_spring) fn along_end(i: usize, force: Vec2, direction: Vec2) -> f64 {
    if i == 0 { force.dot(&direction) } else { -force.dot(&direction) }
}

/// The same where forces are not summed up: at an end the tension of its element.
pub(in crate::model::mass_spring) fn at_node_inside(mesh: &Mesh, i: usize) -> f64 {
    match (i, mesh.rest_length.len()) {
        (0, _) => mesh.tension.first().copied().unwrap_or(0.0),
        (i, n) if i == n => mesh.tension.last().copied().unwrap_or(0.0),
        _ => at_node(mesh, i),
    }
}

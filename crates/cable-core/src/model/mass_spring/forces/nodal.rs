//! This module sums the forces on the nodes of a mesh.

use crate::math::Vec2;
use crate::model::mass_spring::forces::{bending, pulley};
use crate::model::mass_spring::mesh::Mesh;

/// Computes the tensions, and all forces but those of supports and contacts, at a time `since_s`
/// (s) after they were last computed in this motion; 0 where none has begun.
pub(in crate::model::mass_spring) fn update(mesh: &mut Mesh, time_s: f64, since_s: f64) {
    set_loads(mesh, time_s);
    mesh.spring_memory.begin_step(since_s);
    for e in 0..mesh.rest_length.len() {
        let (length, t) = if mesh.wheels.is_beside(e) {
            let r = mesh.element(e);
            (r.length, r.direction)
        } else {
            let d = mesh.position[e + 1] - mesh.position[e];
            let l = d.norm();
            (l, if l > 0.0 { d / l } else { Vec2::zeros() })
        };
        let tension = mesh.spring_memory.tension(e, length / mesh.rest_length[e] - 1.0, mesh.tension[e]);
        mesh.tension[e] = tension;
        mesh.force[e] += t * tension;
        mesh.force[e + 1] -= t * tension;
    }
    mesh.spring_memory.end_step();
    bending::add_forces(mesh, since_s);
    pulley::update_all(mesh, time_s);
}

/// Computes the forces of the tensions as they are, without bending.
pub(in crate::model::mass_spring) fn update_from_tensions(mesh: &mut Mesh, time_s: f64) {
    set_loads(mesh, time_s);
    for e in 0..mesh.rest_length.len() {
        let pull = spring_force(mesh, e);
        mesh.force[e] += pull;
        mesh.force[e + 1] -= pull;
    }
    pulley::update_all(mesh, time_s);
}

/// Sets the forces to those of weight, wind and loads.
pub(in crate::model::mass_spring) fn set_loads(mesh: &mut Mesh, time_s: f64) {
    let p = &mesh.problem;
    let body = p.body_force(time_s);
    let mut before = Vec2::zeros();
    for (f, share) in mesh.force.iter_mut().zip(mesh.straight_length.iter().copied().chain([0.0])) {
        let half = body * (0.5 * share);
        *f = before + half;
        before = half;
    }
    for k in &mesh.wheels.pulleys {
        let i = k.node;
        mesh.force[i] += body
            * (mesh.material_length[i - 1] - mesh.straight_length[i - 1] + mesh.material_length[i]
                - mesh.straight_length[i]);
    }
    let g = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
    for (u, &k) in p.supports.iter().zip(&mesh.support_node) {
        mesh.force[k] += u.force.at(time_s) + g * u.mass;
    }
    for (l, &k) in p.loads.iter().zip(&mesh.load_node) {
        mesh.force[k] += l.force.at(time_s);
    }
}

/// Force of the spring of element `e` on its first node, N.
pub(in crate::model::mass_spring) fn spring_force(mesh: &Mesh, e: usize) -> Vec2 {
    if mesh.wheels.is_beside(e) {
        return mesh.element(e).direction * mesh.tension[e];
    }
    let d = mesh.position[e + 1] - mesh.position[e];
    let length = d.norm();
    if length > 0.0 { d * (mesh.tension[e] / length) } else { Vec2::zeros() }
}

//! This module gives the tensions beside pulleys and the force that slides material over them (see
//! [`crate::model::mass_spring::mesh::pulley`]).

use crate::math::{Vec2, cross, perp};
use crate::model::mass_spring::mesh::{ElementGeometry, Mesh, angle_of, principal_angle};

/// Updates what the cable does at all pulleys.
pub(in crate::model::mass_spring) fn update_all(mesh: &mut Mesh, time_s: f64) {
    let body = mesh.problem.body_force(time_s);
    for k in 0..mesh.wheels.pulleys.len() {
        update(mesh, k, body);
    }
}

/// Tensions beside pulley `k`, its turn, and the force on its material, with the tensions of the
/// elements as they are and a `body` force (N/m) on the cable.
pub(in crate::model::mass_spring) fn update(mesh: &mut Mesh, k: usize, body: Vec2) {
    let i = mesh.wheels.pulleys[k].node;
    let (b, a) = (mesh.element(i - 1), mesh.element(i));
    let ratio = mesh.tuning.mesh.direction_tension_ratio;
    let (tb, ta) = (mesh.tension[i - 1], mesh.tension[i]);
    // Half a straight part's weight lies between the middle of an element and the wheel: that also
    // turns the cable a little, and moves where it touches.
    let at_wheel = |r: &ElementGeometry, tension: f64, half: Vec2| {
        let force = r.direction * tension + half;
        let size = force.norm();
        (size, if size > ratio * half.norm() { force / size } else { r.direction })
    };
    let (before, from) = at_wheel(&b, tb, body * (-0.5 * mesh.straight_length[i - 1]));
    let (after, to) = at_wheel(&a, ta, body * (0.5 * mesh.straight_length[i]));
    let center = mesh.position[i];
    let p = &mut mesh.wheels.pulleys[k];
    if p.radius > 0.0 {
        let arcs = [principal_angle(angle_of(from) - p.mark_angle), principal_angle(p.mark_angle - angle_of(to))];
        p.arc = arcs.map(|a| a * p.sense * p.radius);
        let at = |t: Vec2| center + perp(t) * (p.sense * p.radius);
        p.tension = [before - body.dot(&(at(from) - b.end)), after - body.dot(&(at(to) - a.start))];
        p.turn = (p.arc[0] + p.arc[1]) / p.radius;
    } else {
        p.tension = [before, after];
        p.turn = cross(from, to).atan2(from.dot(&to));
    }
    let ea = mesh.problem.axial_stiffness;
    let theta = |t: f64| t * (1.0 + 0.5 * t / ea);
    p.sliding_force = mesh.thermal_stretch * (theta(tb) - theta(ta)) + body.dot(&(b.middle - a.middle));
}

//! Material slides over pulleys (see [`crate::model::mass_spring::mesh::pulley`]).

use crate::model::mass_spring::dynamics::SubStep;
use crate::model::mass_spring::mesh::{Mesh, least_straight_length};

/// Slides the material over all pulleys in a sub-step; friction stops it within the capstan's cone.
pub(in crate::model::mass_spring) fn slide(mesh: &mut Mesh, SubStep { length_s: h, kick_s: kick }: SubStep) {
    let (least, thermal) = (least_straight_length(mesh), mesh.thermal_stretch);
    for k in 0..mesh.wheels.pulleys.len() {
        let p = &mut mesh.wheels.pulleys[k];
        let push = p.sliding_speed + p.sliding_force * kick / p.mass;
        let most = thermal * p.friction_ratio() * (p.tension[0] + p.tension[1]) * kick / p.mass;
        p.sliding_speed = if push.abs() <= most { 0.0 } else { push - most * push.signum() };
        // A support or load on the cable does not run through.
        let (i, rate) = (p.node, p.sliding_speed);
        let blocked =
            rate < 0.0 && mesh.straight_length[i - 1] < least || rate > 0.0 && mesh.straight_length[i] < least;
        if blocked {
            mesh.wheels.pulleys[k].sliding_speed = 0.0;
        }
        transfer(mesh, k, mesh.wheels.pulleys[k].sliding_speed * h);
    }
    if !mesh.wheels.pulleys.is_empty() {
        mesh.update_pulley_elements();
    }
}

/// Moves material `ds` (m) to the side before pulley `k`: the node that gets it takes its momentum
/// with it.
fn transfer(mesh: &mut Mesh, k: usize, ds: f64) {
    let (i, u) = (mesh.wheels.pulleys[k].node, mesh.wheels.pulleys[k].sliding_speed);
    mesh.arc_length[i] += ds;
    let gained = 0.5 * mesh.problem.linear_density * ds.abs();
    let (node, e) = if ds > 0.0 { (i - 1, i - 1) } else { (i + 1, i) };
    let direction = mesh.element(e).direction;
    let arriving = (mesh.velocity[node] + mesh.velocity[i] - direction * u) * 0.5;
    if !mesh.supported[node] {
        let m = mesh.mass[node];
        mesh.velocity[node] = (mesh.velocity[node] * m + arriving * gained) / (m + gained);
    }
}

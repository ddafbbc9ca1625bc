//! This module sums the energies of springs, loads and bending, with their gradients and Hessians.
//!
//! Derivatives of a spring beside a pulley, t its direction, L its length, λ the thermal stretch:
//! ```text
//! ∂²U/∂p² = (EA/l₀) t tᵀ + (T/L_straight)(I − t tᵀ),   ∂²U/∂σ² = λ² EA L²/l₀³,   ∂²U/∂p∂σ = λ EA L/l₀² t
//! ```

use crate::energy::{Curvature, ElementEnergy};
use crate::math::{Mat2, Vec2};
use crate::model::mass_spring::equilibrium::system::EquilibriumSystem;
use crate::model::mass_spring::forces::bending;
use crate::model::mass_spring::mesh::Mesh;

/// Adds the energy of weight, wind and loads; returns its value, J.
pub(in crate::model::mass_spring) fn add_loads(mesh: &Mesh, system: &mut EquilibriumSystem, time_s: f64) -> f64 {
    let p = &mesh.problem;
    let body = p.body_force(time_s);
    let mut value = 0.0;
    for e in 0..mesh.rest_length.len() {
        let moment = if mesh.wheels.is_beside(e) {
            let r = mesh.element(e);
            // σ moves half of the weight to the other end's side.
            for (node, other, sign) in [(e, e + 1, 1.0), (e + 1, e, -1.0)] {
                if mesh.wheels.at_node[node].is_some() && mesh.wheels.at_node[other].is_none() {
                    system.hessian.add(2 * other, 2 * node, 0.5 * sign * body.x);
                    system.hessian.add(2 * other + 1, 2 * node, 0.5 * sign * body.y);
                }
            }
            r.middle * mesh.straight_length[e] + r.arc_moment / p.thermal_stretch
        } else {
            (mesh.position[e] + mesh.position[e + 1]) * (0.5 * mesh.straight_length[e])
        };
        let half = body * (0.5 * mesh.straight_length[e]);
        value -= body.dot(&moment);
        system.add_gradient(e, -half);
        system.add_gradient(e + 1, -half);
    }
    let g = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
    let supports = p.supports.iter().zip(&mesh.support_node).map(|(u, &k)| (k, u.force.at(time_s) + g * u.mass));
    let loads = p.loads.iter().zip(&mesh.load_node).map(|(l, &k)| (k, l.force.at(time_s)));
    for (k, force) in supports.chain(loads) {
        value -= force.dot(&mesh.position[k]);
        system.add_gradient(k, -force);
    }
    value
}

/// Adds the energy of the spring of element `e` and updates its tension; returns the value, J.
pub(in crate::model::mass_spring) fn add_spring(mesh: &mut Mesh, system: &mut EquilibriumSystem, e: usize) -> f64 {
    let r = mesh.element(e);
    let (l0, ea, lambda) = (mesh.rest_length[e], mesh.problem.axial_stiffness, mesh.thermal_stretch);
    let stretch = r.length - l0;
    // A spring of a cable with bending stiffness pushes.
    let taut = stretch > 0.0 || mesh.bending_stiffness > 0.0;
    let lent = system.initial_tension[e] * system.fade;
    let tension = if taut { ea * stretch / l0 } else { 0.0 };
    mesh.tension[e] = tension;
    if !taut && lent == 0.0 {
        return 0.0;
    }
    let t = r.direction;
    let along = t * t.transpose();
    let ea = if taut { ea } else { ea * system.fade };
    let across = if tension > lent { tension } else { lent };
    let k = along * (ea / l0) + (Mat2::identity() - along) * if r.straight > 0.0 { across / r.straight } else { 0.0 };
    let slides = [mesh.wheels.at_node[e].is_some(), mesh.wheels.at_node[e + 1].is_some()];
    let cross = t * (lambda * ea * r.length / (l0 * l0));
    let square = lambda * lambda * ea * r.length * r.length / l0.powi(3);
    for (i, sign, slides) in [(e, -1.0, slides[0]), (e + 1, 1.0, slides[1])] {
        if slides {
            system.hessian.add(2 * i, 2 * i, square);
        } else {
            system.add_gradient(i, t * (sign * tension));
            system.add_block(i, i, &k);
        }
    }
    match slides {
        [false, false] => system.add_block(e, e + 1, &-k),
        [true, true] => system.hessian.add(2 * e, 2 * e + 2, -square),
        [first, _] => {
            let (wheel, other) = if first { (e, e + 1) } else { (e + 1, e) };
            system.hessian.add(2 * other, 2 * wheel, cross.x);
            system.hessian.add(2 * other + 1, 2 * wheel, cross.y);
        }
    }
    0.5 * tension * stretch
}

/// Adds the energy of bending; returns its value, J.
pub(in crate::model::mass_spring) fn add_bending(
    mesh: &Mesh,
    system: &mut EquilibriumSystem,
    curvature: Curvature,
) -> f64 {
    let mut value = 0.0;
    for n in 0..mesh.position.len() {
        if let Some(direction) = bending::clamp_at(mesh, n) {
            for e in n.saturating_sub(1)..(n + 1).min(mesh.rest_length.len()) {
                let (bend, x) = (bending::clamp_bend(mesh, e, direction), [mesh.position[e], mesh.position[e + 1]]);
                value += bend.value(&x);
                system.add_energy([e, e + 1], bend.gradient(&x), &bend.hessian(&x, curvature));
            }
        } else if let Some(bend) = bending::bend_at(mesh, n) {
            let x = [mesh.position[n - 1], mesh.position[n], mesh.position[n + 1]];
            value += bend.value(&x);
            system.add_energy([n - 1, n, n + 1], bend.gradient(&x), &bend.hessian(&x, curvature));
        }
    }
    value
}

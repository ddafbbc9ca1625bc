//! How wrong the largest tension is: the dual-weighted residual.
//!
//! Each element's chord lacks δ to the chord of the exact catenary under the same force. The span then closes with
//! another start force, and pulleys slide a little to keep their balance:
//! ```text
//! δF₀ = −C⁻¹ Σδ,     C = ∂reach/∂F₀
//! ```
//! (R. Becker and R. Rannacher, *An optimal control approach to a posteriori error estimation in finite element methods*,
//! Acta Numerica 2001: the residual weighted by the inverse Hessian, here 2×2.)

use super::beam::Beam;
use super::network::Network;
use super::span::elements;
use crate::math::{Vec2, larger};

/// Estimated relative error of the largest tension.
#[must_use]
pub fn relative_error(network: &Network) -> f64 {
    let (mut largest, mut error) = (0.0, 0.0);
    let changes = force_errors(network);
    for (forces, change) in network.forces.iter().zip(&changes) {
        for (force, d) in forces.iter().zip(change) {
            let tension = force.norm();
            largest = larger(largest, tension);
            let off = if tension > 0.0 { force.dot(d) / tension } else { 0.0 };
            error = larger(error, off.abs());
        }
    }
    if largest > 0.0 { error / largest } else { error }
}

/// Estimated error of the tension force before and after each stop, N.
fn force_errors(network: &Network) -> Vec<[Vec2; 2]> {
    let mut errors = vec![[Vec2::zeros(); 2]; network.layout.stops.len()];
    for (&ends, span) in network.ends.iter().zip(&network.spans) {
        let mut lack = Vec2::zeros();
        elements(&network.material, &network.layout, ends, span.force, |ds, f| {
            lack += network.material.chord_error(ds, f);
        });
        let off = span.walk.compliance.try_inverse().map_or(Vec2::repeat(f64::NAN), |k| -(k * lack));
        errors[ends.0][1] = off;
        errors[ends.1][0] = off;
    }
    let_pulleys_follow(network, &mut errors);
    errors
}

/// Adds what frictionless pulleys do to small changes of the forces beside the stops: they slide until the tensions
/// agree again.
fn let_pulleys_follow(network: &Network, changes: &mut [[Vec2; 2]]) {
    let pulleys = network.pulleys();
    let faults: Vec<Option<f64>> = pulleys
        .iter()
        .map(|&k| {
            let (wheel, [before, after]) = (network.wheel(k)?, network.forces[k]);
            network.fault(k, &wheel)?;
            Some(network.fault_rate(&wheel, 0.0, [before, after], changes[k]))
        })
        .collect();
    let (slides, _) = network.newton_step(&pulleys, &faults);
    for (&of, slide) in pulleys.iter().zip(slides) {
        for (k, change) in changes.iter_mut().enumerate() {
            let rates = network.rates_at(k, of);
            change[0] += rates[0] * slide;
            change[1] += rates[1] * slide;
        }
    }
}

/// Estimated relative error of the largest tension on the finer of two meshes, fourth order: a fifteenth of the change.
#[must_use]
pub fn halving_error(coarse: &Beam, fine: &Beam) -> f64 {
    let (mut largest, mut change) = (fine.bending_force(), 0.0);
    for (a, b) in coarse.stop_forces().iter().flatten().zip(fine.stop_forces().iter().flatten()) {
        let (size, off) = (b.norm(), (b - a).norm());
        largest = larger(largest, size);
        change = larger(change, off);
    }
    if largest > 0.0 { change / (15.0 * largest) } else { change }
}

//! This module estimates the error of the tension of a stiff cable, because sliding nodes carry no
//! moment.

use crate::energy::bending::turn;
use crate::math::{larger, smaller};
use crate::model::fem::results::forces::bar_tensions;
use crate::model::fem::state::CableState;
use crate::model::fem::system::ContactPair;

/// Bounds of the error of the tension of a stiff cable where it bends round obstacles and pulleys,
/// relative to the greatest tension.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct BendingError {
    /// At sliding nodes, which carry no moment: the tension there is off by EI/2ρ² if the cable
    /// lies on the round, and by at most T(1 − cos ½φ), φ its turn, if it touches in a point. It
    /// does not vanish with the length of bars.
    pub sliding: f64,
    /// At material nodes. Where one turns by ψ, the normal force of a contact can have any
    /// direction within the turn, which makes an error along the cable of ½ψ times the force.
    pub material: f64,
    /// The arc length at which the error is greatest, m.
    pub arc_length: f64,
}

/// The error of the tension of a stiff cable where it bends round obstacles and pulleys.
pub(in crate::model::fem) fn bending_error(cable: &CableState) -> BendingError {
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    let tension = bar_tensions(cable, x);
    let most = tension.iter().map(|t| t.abs()).fold(0.0, larger);
    let (mut off, mut arc_length) = ([0.0, 0.0], 0.0);
    let mut take = |force: f64, node: usize, kind: usize| {
        if force > larger(off[0], off[1]) {
            arc_length = mesh.arc_length[node];
        }
        off[kind] = larger(off[kind], force);
    };
    for k in 1..mesh.nodes().saturating_sub(1) {
        let (Some(sliding), Some(load)) = (&mesh.sliding[k], cable.load(k)) else { continue };
        let point = 0.5 * (load.tension[0] + load.tension[1]) * (1.0 - (0.5 * load.turn).cos());
        let radius = sliding.end.radius;
        let lying = if radius > 0.0 { 0.5 * mesh.bending_stiffness / (radius * radius) } else { point };
        take(smaller(lying, point), k, 0);
    }
    let mut touches: Vec<ContactPair> = Vec::new();
    cable.contacts.find(&cable.problem, mesh, x, &mut touches);
    for t in touches.iter().filter(|t| !t.on_segment && t.node > 0 && t.node + 1 < mesh.nodes()) {
        let bend = turn(mesh.direction(t.node - 1, x), mesh.direction(t.node, x));
        take(0.5 * bend.abs() * t.load(&cable.contacts.barrier), t.node, 1);
    }
    for t in touches.iter().filter(|t| t.on_segment) {
        // The neighbouring nodes could have touched instead.
        let ends = [t.node, t.node + 1].into_iter().filter(|&k| k > 0 && k + 1 < mesh.nodes());
        for k in ends {
            let bend = turn(mesh.direction(k - 1, x), mesh.direction(k, x));
            take(0.5 * bend.abs() * t.load(&cable.contacts.barrier), k, 1);
        }
    }
    let [sliding, material] = off.map(|off| if most > 0.0 { off / most } else { 0.0 });
    BendingError { sliding, material, arc_length }
}

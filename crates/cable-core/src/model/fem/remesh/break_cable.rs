//! A cable breaks at a node: the node becomes two, of which each has the half of its mass that
//! belongs to its piece, and both its place and its velocity. Nothing else changes, so that mass,
//! momentum and all energies are kept but the energy of the bend at the node.

use crate::math::Vec2;
use crate::model::BreakPlace;
use crate::model::fem::results;
use crate::model::fem::state::{CableState, renew_input, stored_energy};

/// Breaks the cable; false, without a change, if its mesh is not one of material nodes that can
/// touch each other.
pub(in crate::model::fem) fn break_cable(cable: &mut CableState, place: &BreakPlace) -> bool {
    if !cable.contacts.self_contacts.shape.is_on() || cable.mesh.slides_anywhere() || !cable.mesh.spread.is_lumped() {
        return false;
    }
    let Some(k) = cable.mesh.node_at(place.arc_length_m) else { return false };
    if k == 0 || k + 1 == cable.mesh.nodes() {
        tear_off(cable, k);
    } else if cable.mesh.goes_on_through(k) {
        divide(cable, k, place);
    } else {
        return false;
    }
    cable.motion.begin_after_break();
    cable.answers.stepped = None;
    renew_input(cable);
    let stored = stored_energy(cable);
    cable.motion.energies.note_break(stored);
    let x = std::mem::take(&mut cable.motion.positions);
    cable.contacts.prepare(&cable.problem, &cable.mesh, &x, &x);
    cable.motion.positions = x;
    results::gauge_tension(cable);
    true
}

/// Takes an end of the cable off its supports, which keep the loads that hang there.
fn tear_off(cable: &mut CableState, k: usize) {
    for node in &mut cable.meshing.support_node {
        *node = node.filter(|node| *node != k);
    }
    cable.meshing.loads.retain(|load| load.node != k);
}

/// Makes two nodes of node `k`; its supports and loads stay with the first piece if the second one
/// gives way.
fn divide(cable: &mut CableState, k: usize, place: &BreakPlace) {
    let m = &mut cable.motion;
    for values in [&mut m.positions, &mut m.velocities, &mut m.previous_positions, &mut m.previous_velocities] {
        values.insert(k + 1, values[k]);
    }
    for values in [&mut m.slide_rates, &mut m.previous_slide_rates, &mut m.previous_arc_length] {
        values.insert(k + 1, values[k]);
    }
    cable.mesh.break_at(k);
    cable.answers.reaction.insert(k + 1, Vec2::zeros());
    let last_kept = if place.gives_way_after { k } else { k - 1 };
    cable.meshing.renumber(|node| Some(if node > last_kept { node + 1 } else { node }));
    for clamp in &mut cable.mesh.clamps {
        clamp.node += usize::from(clamp.node > last_kept);
    }
    cable.contacts.break_at(k, &cable.mesh, &cable.motion.positions);
}

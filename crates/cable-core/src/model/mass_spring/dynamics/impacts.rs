//! Impulses act where the cable meets an obstacle in a sub-step.

use crate::math::{Vec2, bounded, larger};
use crate::model::mass_spring::contact_memory::{ContactImpulse, ContactMemory};
use crate::model::mass_spring::dynamics::momentum::MomentumSums;
use crate::model::mass_spring::mesh::Mesh;

/// Makes velocities such that nothing is entered in this sub-step: at each contact an inelastic
/// normal impulse and a friction impulse within the Coulomb cone. Inside the cone the
/// tangential velocity becomes exactly zero, so a held cable does not creep.
pub(in crate::model::mass_spring) fn apply(
    contacts: &mut ContactMemory,
    mesh: &mut Mesh,
    account: &mut MomentumSums,
    h: f64,
) {
    contacts.impulses.clear();
    find(contacts, mesh, h);
    for _ in 0..mesh.tuning.impact.passes {
        resolve(contacts, mesh, account, h);
    }
}

/// Finds the contacts that a sub-step of `h` (s) can close. Those that were known before keep their
/// impulses; of those that are no more the impulses are taken back.
pub(in crate::model::mass_spring) fn find(contacts: &mut ContactMemory, mesh: &mut Mesh, h: f64) {
    let known = std::mem::take(&mut contacts.impulses);
    let mut found = std::mem::take(&mut contacts.known_before);
    found.clear();
    let tuning = mesh.tuning.impact;
    for e in 0..mesh.rest_length.len() {
        if mesh.wheels.is_on_wheel(e) {
            continue;
        }
        let (va, vb) = (mesh.velocity[e].norm(), mesh.velocity[e + 1].norm());
        let travel = if va > vb { va } else { vb } * h;
        contacts.clearance[e] -= travel;
        if contacts.clearance[e] > 0.0 {
            continue;
        }
        let near = tuning.skin_m + 2.0 * travel;
        let reach = near + mesh.rest_length[e];
        contacts.gap_buffer.clear();
        mesh.problem.world.segment_gaps(mesh.position[e], mesh.position[e + 1], reach, &mut contacts.gap_buffer);
        let nearest = contacts.gap_buffer.iter().map(|g| g.gap_m).fold(reach, f64::min);
        contacts.clearance[e] = nearest - near;
        for gap in contacts.gap_buffer.iter().filter(|g| g.gap_m < near) {
            found.push(ContactImpulse { element: e, gap: *gap, normal: 0.0, friction: 0.0, slips: false });
        }
    }
    for before in &known {
        match found.iter_mut().find(|now| now.is_same_place(before)) {
            Some(now) => *now = *before,
            None => push(before, mesh, -before.impulse(mesh)),
        }
    }
    contacts.impulses = found;
    contacts.known_before = known;
}

/// Begins a sub-step of `h` (s) with the contacts of the last one, of `last` (s): their impulses
/// are those of the same forces.
pub(in crate::model::mass_spring) fn carry_over(contacts: &mut ContactMemory, h: f64, last: f64) {
    let part = h / last;
    contacts.impulses.retain(|c| c.normal > 0.0);
    for contact in &mut contacts.impulses {
        (contact.normal, contact.friction) = (contact.normal * part, contact.friction * part);
    }
}

/// Adds the impulses of contacts to positions that are predicted for the end of a sub-step of `h`
/// (s).
pub(in crate::model::mass_spring) fn displace(contacts: &ContactMemory, mesh: &Mesh, position: &mut [Vec2], h: f64) {
    for contact in &contacts.impulses {
        let j = contact.impulse(mesh) * h;
        for (i, share) in contact.shares(mesh) {
            position[i] += j * share;
        }
    }
}

/// One pass over the contacts; returns the greatest change of a place at the end of a sub-step of
/// `h` (s) that their impulses make, m.
pub(in crate::model::mass_spring) fn resolve(
    contacts: &mut ContactMemory,
    mesh: &mut Mesh,
    account: &mut MomentumSums,
    h: f64,
) -> f64 {
    contacts.impulses.iter_mut().map(|contact| apply_one(contact, mesh, account, h)).fold(0.0, larger)
}

/// Gives the nodes of a contact an impulse, N·s.
fn push(contact: &ContactImpulse, mesh: &mut Mesh, impulse: Vec2) {
    for (i, share) in contact.shares(mesh) {
        mesh.velocity[i] += impulse * share;
    }
}

/// Returns by how much (m) the impulse of a contact changes its place at the end of a sub-step.
fn apply_one(contact: &mut ContactImpulse, mesh: &mut Mesh, account: &mut MomentumSums, h: f64) -> f64 {
    let tuning = &mesh.tuning.impact;
    let (a, b, c) = (contact.element, contact.element + 1, contact.gap.fraction);
    let inverse = |i: usize| if mesh.supported[i] { 0.0 } else { 1.0 / mesh.mass[i] };
    let (ia, ib) = (inverse(a), inverse(b));
    // Inverse mass of the point at fraction c of the element.
    let w = (1.0 - c) * (1.0 - c) * ia + c * c * ib;
    if !(w > 0.0) {
        return 0.0;
    }
    let n = contact.gap.normal;
    let v = mesh.velocity[a] * (1.0 - c) + mesh.velocity[b] * c;
    // The gap after the sub-step is gap + v·n·h ≥ 0; a penetration leaves at a bounded speed.
    let gap = contact.gap.gap_m;
    let target = if gap > 0.0 { -gap / h } else { (-gap / tuning.push_out_time_s).min(tuning.push_out_speed_m_per_s) };
    let wanted = contact.normal + (target - v.dot(&n)) / w;
    let normal = if wanted > 0.0 { wanted } else { 0.0 };
    let change = normal - contact.normal;
    let t = contact.tangent(mesh);
    let wanted = contact.friction - v.dot(&t) / w;
    let cone = contact.gap.friction * normal;
    let friction = bounded(wanted, -cone, cone);
    contact.slips = wanted.abs() > cone;
    let j = n * change + t * (friction - contact.friction);
    (contact.normal, contact.friction) = (normal, friction);
    let of = |i: usize, part: f64| if mesh.supported[i] { 0.0 } else { part };
    account.contacts += j * (of(a, 1.0 - c) + of(b, c));
    push(contact, mesh, j);
    j.norm() * w * h
}

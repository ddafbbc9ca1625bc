//! Impulses act where the cable meets an obstacle in a sub-step.

use crate::math::{Vec2, bounded};
use crate::model::mass_spring::contact_memory::{ContactImpulse, ContactMemory};
use crate::model::mass_spring::dynamics::momentum::Account;
use crate::model::mass_spring::mesh::cable_mesh::Mesh;

/// Makes velocities such that nothing is entered in this sub-step: at each contact an inelastic
/// normal impulse and a friction impulse within the Coulomb cone. Inside the cone the
/// tangential velocity becomes exactly zero, so a held cable does not creep.
pub(in crate::model::mass_spring) fn apply(
    contacts: &mut ContactMemory,
    mesh: &mut Mesh,
    account: &mut Account,
    h: f64,
) {
    contacts.impulses.clear();
    if mesh.problem.world.is_empty() {
        return;
    }
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
            contacts.impulses.push(ContactImpulse { element: e, gap: *gap, normal: 0.0, friction: 0.0, slips: false });
        }
    }
    for _ in 0..tuning.passes {
        for contact in &mut contacts.impulses {
            apply_one(contact, mesh, account, h);
        }
    }
}

fn apply_one(contact: &mut ContactImpulse, mesh: &mut Mesh, account: &mut Account, h: f64) {
    let tuning = &mesh.tuning.impact;
    let (a, b, c) = (contact.element, contact.element + 1, contact.gap.fraction);
    let inverse = |i: usize| if mesh.supported[i] { 0.0 } else { 1.0 / mesh.mass[i] };
    let (ia, ib) = (inverse(a), inverse(b));
    // Inverse mass of the point at fraction c of the element.
    let w = (1.0 - c) * (1.0 - c) * ia + c * c * ib;
    if !(w > 0.0) {
        return;
    }
    let n = contact.gap.normal;
    let v = mesh.velocity[a] * (1.0 - c) + mesh.velocity[b] * c;
    // The gap after the sub-step is gap + v·n·h ≥ 0; a penetration leaves at a bounded speed.
    let gap = contact.gap.gap_m;
    let target = if gap > 0.0 { -gap / h } else { (-gap / tuning.push_out_time_s).min(tuning.push_out_speed_m_per_s) };
    let wanted = contact.normal + (target - v.dot(&n)) / w;
    let normal = if wanted > 0.0 { wanted } else { 0.0 };
    let change = normal - contact.normal;
    let mut along = mesh.position[b] - mesh.position[a];
    along -= n * along.dot(&n);
    let t = along.try_normalize(0.0).unwrap_or(Vec2::new(n.y, -n.x));
    let wanted = contact.friction - v.dot(&t) / w;
    let cone = contact.gap.friction * normal;
    let friction = bounded(wanted, -cone, cone);
    contact.slips = wanted.abs() > cone;
    let j = n * change + t * (friction - contact.friction);
    (contact.normal, contact.friction) = (normal, friction);
    let of = |i: usize, part: f64| if mesh.supported[i] { 0.0 } else { part };
    account.contacts += j * (of(a, 1.0 - c) + of(b, c));
    mesh.velocity[a] += j * ((1.0 - c) * ia);
    mesh.velocity[b] += j * (c * ib);
}

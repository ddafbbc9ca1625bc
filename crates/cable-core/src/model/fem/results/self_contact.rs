//! This module reports the contacts of a cable with itself.

use crate::contact::friction;
use crate::math::Vec2;
use crate::model::fem::state::CableState;
use crate::solution::{ContactReport, ContactSample, ContactState};

/// Contacts of the cable with itself at positions `x` (m): one report for each stretch of
/// nodes.
pub(in crate::model::fem) fn reports(cable: &CableState, x: &[Vec2], tension: &[f64], out: &mut Vec<ContactReport>) {
    let own = &cable.contacts.self_contacts;
    let mut last = None;
    for contact in &own.friction_contacts {
        let (k, pair) = (contact.pair.node, &contact.pair);
        let load = -cable.contacts.barrier.at(pair.gap_m).slope * pair.weight;
        let along = cable.mesh.direction(k.min(tension.len().saturating_sub(1)), x);
        let (_, rubbing, _) = friction::at(contact.sliding(x), contact.limit, cable.contacts.tuning.slip_m);
        let new = last.is_none_or(|l| k > l + 1);
        last = Some(k);
        if new {
            let around = [k.saturating_sub(1), k.min(tension.len().saturating_sub(1))];
            out.push(ContactReport {
                obstacle: cable.problem.cable.name.clone(),
                x_m: x[k].x,
                y_m: x[k].y,
                arc_length_m: cable.mesh.arc_length[k],
                normal: [pair.normal.x, pair.normal.y],
                state: ContactState::Stick,
                tension_before_n: tension[around[0]],
                begins_m: cable.mesh.arc_length[k],
                ..ContactReport::default()
            });
        }
        if let Some(report) = out.last_mut() {
            let force = pair.normal * load - pair.tangent() * rubbing;
            // The other side of the contact gets the opposite force: the force on the whole cable
            // is zero.
            for (node, part) in pair.shares() {
                report.samples.push(ContactSample::new(cable.mesh.arc_length[node], force * part));
            }
            report.normal_n += load;
            report.ends_m = cable.mesh.arc_length[k];
            report.friction_n -= rubbing * pair.tangent().dot(&along);
            report.tension_after_n = tension[k.min(tension.len().saturating_sub(1))];
            if rubbing.abs() >= contact.limit {
                report.state = ContactState::Slip;
            }
        }
    }
}

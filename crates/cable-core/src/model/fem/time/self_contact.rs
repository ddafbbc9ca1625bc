//! A cable lands on itself without bouncing, and its contacts with itself are reported.

use crate::contact::friction;
use crate::math::{Vec2, bounded, perp};
use crate::model::fem::state::cable::CableState;
use crate::solution::{ContactReport, ContactSample, ContactState};

/// Part of the speed along its normal (m/s, positive away from it) that a plastic contact takes, of
/// which its force made `made` in the step.
pub(in crate::model::fem) fn plastic(speed: f64, made: f64) -> f64 {
    if speed > made { made } else { speed }
}

/// Impulse that a contact of this normal and friction goes on giving against the other forces, the
/// opposite of `against`, N s.
pub(in crate::model::fem) fn carried_on(against: Vec2, normal: Vec2, friction: f64) -> Vec2 {
    let (pressed, along) = (against.dot(&normal), perp(normal));
    let pressed = if pressed > 0.0 { pressed } else { 0.0 };
    normal * pressed + along * bounded(against.dot(&along), -friction * pressed, friction * pressed)
}

/// Takes the normal speed out of contacts of the cable with itself that are faster than
/// those left alone, after a step of `h` (s) whose forces acted for 1/`a` (s); momentum is kept.
pub(in crate::model::fem) fn land(cable: &mut CableState, h: f64, a: f64) {
    let (mut given, mut forgotten) = (Vec2::zeros(), Vec2::zeros());
    let mass = |k: usize| cable.mesh.mass_with(&cable.problem, &cable.meshing.support_node, k);
    let m = &mut cable.motion;
    for rub in &cable.contacts.own.friction_contacts {
        let n = rub.pair.normal;
        let speed = n.dot(&rub.pair.difference(&m.velocities));
        let shares = rub.pair.shares();
        let give = |k: usize| if cable.mesh.is_free(k) { 1.0 / mass(k) } else { 0.0 };
        let sum: f64 = shares.iter().map(|&(k, part)| part * part * give(k)).sum();
        let made = -cable.contacts.barrier.at(rub.pair.gap_m).slope * rub.pair.weight / a;
        if !(sum > 0.0) || speed.abs() < cable.mesh.tuning.step.plastic_speed_m_per_s {
            continue;
        }
        let taken = plastic(speed, made * sum) / sum;
        let change = rub.pair.difference(&m.velocities) - rub.pair.difference(&m.previous_velocities);
        let (_, rubbing, _) = friction::at(rub.sliding(&m.positions), rub.limit, cable.contacts.tuning.slip_m);
        let acted = n * made - rub.pair.tangent() * (rubbing / a);
        let over = acted - carried_on(acted - change / sum, n, cable.contacts.own.friction);
        for (k, part) in shares.into_iter().filter(|&(k, _)| cable.mesh.is_free(k)) {
            m.velocities[k] -= n * (taken * part * give(k));
            m.previous_velocities[k] += (over - n * taken) * (part * give(k));
            m.previous_positions[k] = m.positions[k] - (m.velocities[k] + m.previous_velocities[k]) * (0.5 * h);
            given -= n * (taken * part);
            forgotten += over * part;
        }
    }
    // Nothing, but where a support holds a side of the contact.
    cable.motion.account.land(given, forgotten);
}

/// Contacts of the cable with itself at positions `x` (m): one report for each stretch of
/// nodes.
pub(in crate::model::fem) fn reports(cable: &CableState, x: &[Vec2], tension: &[f64], out: &mut Vec<ContactReport>) {
    let own = &cable.contacts.own;
    let mut last = None;
    for rub in &own.friction_contacts {
        let (k, pair) = (rub.pair.node, &rub.pair);
        let load = -cable.contacts.barrier.at(pair.gap_m).slope * pair.weight;
        let along = cable.mesh.path(k.min(tension.len().saturating_sub(1)), x).direction;
        let (_, rubbing, _) = friction::at(rub.sliding(x), rub.limit, cable.contacts.tuning.slip_m);
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
            // The other side of the contact feels the opposite: the force on the whole cable is
            // nothing.
            for (node, part) in pair.shares() {
                report.samples.push(ContactSample::new(cable.mesh.arc_length[node], force * part));
            }
            report.normal_n += load;
            report.ends_m = cable.mesh.arc_length[k];
            report.friction_n -= rubbing * pair.tangent().dot(&along);
            report.tension_after_n = tension[k.min(tension.len().saturating_sub(1))];
            if rubbing.abs() >= rub.limit {
                report.state = ContactState::Slip;
            }
        }
    }
}

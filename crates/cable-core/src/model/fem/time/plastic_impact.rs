//! Contacts are plastic: after each step the normal speeds of impacts are taken away.
//!
//! The barrier is a spring and would throw a landing cable back at 0.4 to 0.8 of its speed. A node
//! that still comes nearer stops, and one that goes away goes no faster than without the force of
//! the contact, as nothing presses on what leaves (J. J. Moreau, "Unilateral contact and dry
//! friction in finite freedom dynamics", in: Nonsmooth Mechanics and Applications, CISM 302, 1988).
//! A node that the cable itself draws away keeps its speed: stopped in each step, it would stay
//! until one step carries it out of the barrier's reach, and finer steps would hold it harder.
//!
//! An impact is over with its step: the history of nodes that change keeps the impulse of the other
//! forces, and of the contact that which holds against those. With all of the contact in the
//! history a third of an impact would come after it and throw the cable back; with none of it
//! contacts would press by half too much in the next step; without the impulse of the other forces
//! BDF2 would give two thirds of their next one only.

use crate::contact::friction;
use crate::math::{Vec2, bounded, perp};
use crate::model::fem::state::CableState;

/// Makes the contacts with obstacles plastic after a step of `h` (s) whose forces acted for 1/`a`
/// (s).
pub(in crate::model::fem) fn land_on_obstacles(cable: &mut CableState, h: f64, a: f64) {
    let (mut given, mut forgotten) = (Vec2::zeros(), Vec2::zeros());
    let mass = |k: usize| cable.mesh.mass_with(&cable.problem, &cable.meshing.support_node, k);
    let m = &mut cable.motion;
    for (touch, load) in cable.contacts.loaded_contacts() {
        let n = touch.pair.gap.normal;
        let carried = cable.contacts.outline_motion.filter(|c| c.obstacle == touch.pair.gap.obstacle);
        let of_it = carried.map_or(Vec2::zeros(), |c| c.way(touch.interpolate(&m.positions)) / h);
        let speed = (touch.interpolate(&m.velocities) - of_it).dot(&n);
        let shares = touch.shares();
        let nodes = [touch.node, touch.node + usize::from(touch.on_segment)];
        let free = [0, 1].map(|j| if cable.mesh.is_free(nodes[j]) { shares[j] } else { 0.0 });
        let sum = free[0] * shares[0] + free[1] * shares[1];
        if sum < 1e-3 {
            continue;
        }
        let give = [0, 1].map(|j| if free[j] > 0.0 { free[j] / mass(nodes[j]) } else { 0.0 });
        let sum = give[0] * shares[0] + give[1] * shares[1];
        // Impulses: what the contact gave in the step, and what is taken of it.
        let made = load / a;
        let taken = taken_speed(speed, made * sum) / sum;
        if speed.abs() < cable.mesh.tuning.step.plastic_speed_m_per_s {
            continue;
        }
        let change = touch.interpolate(&m.velocities) - touch.interpolate(&m.previous_velocities);
        let acted = n * made + touch.tangent() * (cable.contacts.tangential_force(touch, &m.positions) / a);
        let over = acted - lasting_impulse(acted - change / sum, n, touch.pair.gap.friction);
        for j in 0..2 {
            if free[j] > 0.0 {
                let k = nodes[j];
                m.velocities[k] -= n * (taken * give[j]);
                m.previous_velocities[k] += (over - n * taken) * give[j];
                m.previous_positions[k] = m.positions[k] - (m.velocities[k] + m.previous_velocities[k]) * (0.5 * h);
                given -= n * (taken * free[j]);
                forgotten += over * free[j];
            }
        }
    }
    cable.motion.account.land(given, forgotten);
}

/// Makes the contacts of the cable with itself plastic; its momentum is kept.
pub(in crate::model::fem) fn land_on_itself(cable: &mut CableState, h: f64, a: f64) {
    let (mut given, mut forgotten) = (Vec2::zeros(), Vec2::zeros());
    let mass = |k: usize| cable.mesh.mass_with(&cable.problem, &cable.meshing.support_node, k);
    let m = &mut cable.motion;
    for rub in &cable.contacts.self_contacts.friction_contacts {
        let n = rub.pair.normal;
        let speed = n.dot(&rub.pair.difference(&m.velocities));
        let shares = rub.pair.shares();
        let give = |k: usize| if cable.mesh.is_free(k) { 1.0 / mass(k) } else { 0.0 };
        let sum: f64 = shares.iter().map(|&(k, part)| part * part * give(k)).sum();
        let made = -cable.contacts.barrier.at(rub.pair.gap_m).slope * rub.pair.weight / a;
        if !(sum > 0.0) || speed.abs() < cable.mesh.tuning.step.plastic_speed_m_per_s {
            continue;
        }
        let taken = taken_speed(speed, made * sum) / sum;
        let change = rub.pair.difference(&m.velocities) - rub.pair.difference(&m.previous_velocities);
        let (_, rubbing, _) = friction::at(rub.sliding(&m.positions), rub.limit, cable.contacts.tuning.slip_m);
        let acted = n * made - rub.pair.tangent() * (rubbing / a);
        let over = acted - lasting_impulse(acted - change / sum, n, cable.contacts.self_contacts.friction);
        for (k, part) in shares.into_iter().filter(|&(k, _)| cable.mesh.is_free(k)) {
            m.velocities[k] -= n * (taken * part * give(k));
            m.previous_velocities[k] += (over - n * taken) * (part * give(k));
            m.previous_positions[k] = m.positions[k] - (m.velocities[k] + m.previous_velocities[k]) * (0.5 * h);
            given -= n * (taken * part);
            forgotten += over * part;
        }
    }
    // Both are zero unless a support holds a side of the contact.
    cable.motion.account.land(given, forgotten);
}

/// The speed along its normal (m/s) that a plastic contact takes: all of one towards it, and of one
/// away from it no more than its force `made` in the step.
fn taken_speed(speed: f64, made: f64) -> f64 {
    if speed > made { made } else { speed }
}

/// Impulse (N s) that a contact goes on giving after an impact: against the other forces, which are
/// the opposite of `against`, as far as its normal and friction can.
fn lasting_impulse(against: Vec2, normal: Vec2, friction: f64) -> Vec2 {
    let (pressed, along) = (against.dot(&normal), perp(normal));
    let pressed = if pressed > 0.0 { pressed } else { 0.0 };
    normal * pressed + along * bounded(against.dot(&along), -friction * pressed, friction * pressed)
}

//! Contacts are plastic: after each step this module removes the normal speeds of impacts.
//!
//! The barrier is a spring and would throw a landing cable back at 0.4 to 0.8 of its speed. A node
//! that still approaches stops, and one that recedes is no faster than without the contact force,
//! because nothing presses on a receding node (J. J. Moreau, "Unilateral contact and dry friction
//! in finite freedom dynamics", in: Nonsmooth Mechanics and Applications, CISM 302, 1988). A node
//! that the cable itself pulls away keeps its speed: stopped in each step, it would stay until one
//! step carries it out of the barrier's reach, and finer steps would hold it harder.
//!
//! An impact ends with its step: the history of the stopped nodes keeps the impulse of the other
//! forces, and the part of the contact impulse that balances these. With all of the contact impulse
//! in the history a third of an impact would follow later and throw the cable back; with none of it
//! contacts would press by half too much in the next step; without the impulse of the other forces
//! BDF2 would give only two thirds of their next one.
//!
//! The work of an impulse that ends with its step is the impulse times the mean of the speeds at
//! start and end. The energy account first counts force times displacement, which is half as much
//! again, because BDF2 would have given a third of the impulse later.

use crate::contact::friction;
use crate::math::{Vec2, bounded, perp};
use crate::model::fem::newton::NodalWays;
use crate::model::fem::state::{CableState, Works};
use crate::model::fem::system::BodyMotion;

/// Part of the mass at a contact that must be free for the contact to be an impact. Smaller: a free
/// node beside a held one gets an impulse a thousand times as large; larger: bars beside supports
/// pass through obstacles. A choice, tuned on no campaign.
const LEAST_FREE_SHARE: f64 = 1e-3;

/// The contact impulses that end with a step whose forces acted for 1/`a` (s).
struct EndedImpulses<'a> {
    ways: &'a NodalWays,
    a: f64,
    /// Their work beyond force times displacement.
    extra_work: Works,
}

/// The motion in a step of the body that a contact touches.
#[derive(Clone, Copy)]
struct TouchedMotion<'a> {
    /// Velocity of the touched point, m/s.
    velocity: Vec2,
    /// Its displacement in the step, m.
    way: Vec2,
    /// None for a body at rest, and for the cable itself.
    body: Option<&'a BodyMotion>,
}

impl TouchedMotion<'_> {
    const NONE: Self = Self { velocity: Vec2::new(0.0, 0.0), way: Vec2::new(0.0, 0.0), body: None };
}

impl EndedImpulses<'_> {
    /// Adds the work of an impulse (N s) of a contact with this normal on node `k`, which now has a
    /// velocity (m/s).
    fn add(&mut self, k: usize, impulse: Vec2, velocity: Vec2, normal: Vec2, touched: TouchedMotion<'_>) {
        let (Some(way), Some(before)) = (self.ways.ways.get(k), self.ways.velocities.get(k)) else { return };
        let relative = (velocity + before) * 0.5 - touched.velocity - (way - touched.way) * self.a;
        let of_normal_force = impulse.dot(&normal) * relative.dot(&normal);
        self.extra_work.impacts += of_normal_force;
        self.extra_work.friction += impulse.dot(&relative) - of_normal_force;
        self.extra_work.add_of_body(touched.body, impulse.dot(&(touched.velocity - touched.way * self.a)));
    }
}

/// Makes the contacts with obstacles plastic after a step of `h` (s) whose forces acted for 1/`a`
/// (s) and whose nodes moved by `ways`.
pub(in crate::model::fem) fn land_on_obstacles(cable: &mut CableState, h: f64, a: f64, ways: &NodalWays) {
    let (mut given, mut forgotten) = (Vec2::zeros(), Vec2::zeros());
    let mut ended = EndedImpulses { ways, a, extra_work: Works::default() };
    let mass = |k: usize| cable.mesh.mass_with(&cable.problem, &cable.meshing.support_node, k);
    let m = &mut cable.motion;
    for (touch, load) in cable.contacts.loaded_contacts() {
        let n = touch.pair.gap.normal;
        let body = cable.contacts.motion_of(touch);
        let way = body.map_or(Vec2::zeros(), |b| b.way(touch.interpolate(&m.positions)));
        let touched = TouchedMotion { velocity: way / h, way, body };
        let speed = (touch.interpolate(&m.velocities) - touched.velocity).dot(&n);
        let shares = touch.shares();
        let nodes = [touch.node, touch.node + usize::from(touch.on_segment)];
        let free = [0, 1].map(|j| if cable.mesh.is_free(nodes[j]) { shares[j] } else { 0.0 });
        let sum = free[0] * shares[0] + free[1] * shares[1];
        if sum < LEAST_FREE_SHARE {
            continue;
        }
        let compliance = [0, 1].map(|j| if free[j] > 0.0 { free[j] / mass(nodes[j]) } else { 0.0 });
        let sum = compliance[0] * shares[0] + compliance[1] * shares[1];
        // These are the impulse of the contact in the step, and the part that is removed.
        let pressed = load / a;
        let removed = removed_speed(speed, pressed * sum) / sum;
        if speed.abs() < cable.mesh.tuning.step.plastic_speed_m_per_s {
            continue;
        }
        let change = touch.interpolate(&m.velocities) - touch.interpolate(&m.previous_velocities);
        let impulse = n * pressed + touch.tangent() * (cable.contacts.tangential_force(touch, &m.positions) / a);
        let ended_part = impulse - lasting_impulse(impulse - change / sum, n, touch.pair.gap.friction);
        for j in 0..2 {
            if free[j] > 0.0 {
                let k = nodes[j];
                ended.add(k, ended_part * free[j], m.velocities[k], n, touched);
                m.velocities[k] -= n * (removed * compliance[j]);
                m.previous_velocities[k] += (ended_part - n * removed) * compliance[j];
                m.previous_positions[k] = m.positions[k] - (m.velocities[k] + m.previous_velocities[k]) * (0.5 * h);
                given -= n * (removed * free[j]);
                forgotten += ended_part * free[j];
            }
        }
    }
    cable.motion.account.land(given, forgotten);
    cable.motion.energies.correct(&ended.extra_work);
}

/// Makes the contacts of the cable with itself plastic; its momentum is kept.
pub(in crate::model::fem) fn land_on_itself(cable: &mut CableState, h: f64, a: f64, ways: &NodalWays) {
    let (mut given, mut forgotten) = (Vec2::zeros(), Vec2::zeros());
    let mut ended = EndedImpulses { ways, a, extra_work: Works::default() };
    let mass = |k: usize| cable.mesh.mass_with(&cable.problem, &cable.meshing.support_node, k);
    let m = &mut cable.motion;
    for contact in &cable.contacts.self_contacts.friction_contacts {
        let n = contact.pair.normal;
        let speed = n.dot(&contact.pair.difference(&m.velocities));
        let shares = contact.pair.shares();
        let compliance = |k: usize| if cable.mesh.is_free(k) { 1.0 / mass(k) } else { 0.0 };
        let sum: f64 = shares.iter().map(|&(k, part)| part * part * compliance(k)).sum();
        let pressed = -cable.contacts.barrier.at(contact.pair.gap_m).slope * contact.pair.weight / a;
        if !(sum > 0.0) || speed.abs() < cable.mesh.tuning.step.plastic_speed_m_per_s {
            continue;
        }
        let removed = removed_speed(speed, pressed * sum) / sum;
        let change = contact.pair.difference(&m.velocities) - contact.pair.difference(&m.previous_velocities);
        let (_, rubbing, _) = friction::at(contact.sliding(&m.positions), contact.limit, cable.contacts.tuning.slip_m);
        let impulse = n * pressed - contact.pair.tangent() * (rubbing / a);
        let ended_part = impulse - lasting_impulse(impulse - change / sum, n, cable.contacts.self_contacts.friction);
        for (k, part) in shares.into_iter().filter(|&(k, _)| cable.mesh.is_free(k)) {
            ended.add(k, ended_part * part, m.velocities[k], n, TouchedMotion::NONE);
            m.velocities[k] -= n * (removed * part * compliance(k));
            m.previous_velocities[k] += (ended_part - n * removed) * (part * compliance(k));
            m.previous_positions[k] = m.positions[k] - (m.velocities[k] + m.previous_velocities[k]) * (0.5 * h);
            given -= n * (removed * part);
            forgotten += ended_part * part;
        }
    }
    // Both are zero unless a support holds a side of the contact.
    cable.motion.account.land(given, forgotten);
    cable.motion.energies.correct(&ended.extra_work);
}

/// The normal speed (m/s) that a plastic contact removes: all of an approaching speed, and at most
/// the part that its force `pressed` in the step of a receding one.
fn removed_speed(speed: f64, pressed: f64) -> f64 {
    if speed > pressed { pressed } else { speed }
}

/// Impulse (N s) of a contact that lasts after an impact: it balances the other forces, which are
/// the opposite of `against`, within its normal and friction cone.
fn lasting_impulse(against: Vec2, normal: Vec2, friction: f64) -> Vec2 {
    let (pressed, along) = (against.dot(&normal), perp(normal));
    let pressed = if pressed > 0.0 { pressed } else { 0.0 };
    normal * pressed + along * bounded(against.dot(&along), -friction * pressed, friction * pressed)
}

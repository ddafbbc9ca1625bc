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
    more: Works,
}

impl EndedImpulses<'_> {
    /// Counts an impulse (N s) of a contact with this normal on node `k`, which now has a velocity
    /// (m/s); `carried` is the velocity (m/s) of the touching body, and `carried_way` its
    /// displacement in the step (m).
    fn add(
        &mut self,
        k: usize,
        impulse: Vec2,
        velocity: Vec2,
        normal: Vec2,
        [carried, carried_way]: [Vec2; 2],
        body: Option<&BodyMotion>,
    ) {
        let (Some(way), Some(before)) = (self.ways.ways.get(k), self.ways.velocities.get(k)) else { return };
        let relative = (velocity + before) * 0.5 - carried - (way - carried_way) * self.a;
        let pressed = impulse.dot(&normal) * relative.dot(&normal);
        self.more.impacts += pressed;
        self.more.friction += impulse.dot(&relative) - pressed;
        self.more.add_of_body(body, impulse.dot(&(carried - carried_way * self.a)));
    }
}

/// Makes the contacts with obstacles plastic after a step of `h` (s) whose forces acted for 1/`a`
/// (s) and whose nodes moved by `ways`.
pub(in crate::model::fem) fn land_on_obstacles(cable: &mut CableState, h: f64, a: f64, ways: &NodalWays) {
    let (mut given, mut forgotten) = (Vec2::zeros(), Vec2::zeros());
    let mut ended = EndedImpulses { ways, a, more: Works::default() };
    let mass = |k: usize| cable.mesh.mass_with(&cable.problem, &cable.meshing.support_node, k);
    let m = &mut cable.motion;
    for (touch, load) in cable.contacts.loaded_contacts() {
        let n = touch.pair.gap.normal;
        let carried = cable.contacts.motion_of(touch);
        let way_of_it = carried.map_or(Vec2::zeros(), |c| c.way(touch.interpolate(&m.positions)));
        let of_it = way_of_it / h;
        let speed = (touch.interpolate(&m.velocities) - of_it).dot(&n);
        let shares = touch.shares();
        let nodes = [touch.node, touch.node + usize::from(touch.on_segment)];
        let free = [0, 1].map(|j| if cable.mesh.is_free(nodes[j]) { shares[j] } else { 0.0 });
        let sum = free[0] * shares[0] + free[1] * shares[1];
        if sum < LEAST_FREE_SHARE {
            continue;
        }
        let give = [0, 1].map(|j| if free[j] > 0.0 { free[j] / mass(nodes[j]) } else { 0.0 });
        let sum = give[0] * shares[0] + give[1] * shares[1];
        // These are the impulse of the contact in the step, and the part that is removed.
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
                ended.add(k, over * free[j], m.velocities[k], n, [of_it, way_of_it], carried);
                m.velocities[k] -= n * (taken * give[j]);
                m.previous_velocities[k] += (over - n * taken) * give[j];
                m.previous_positions[k] = m.positions[k] - (m.velocities[k] + m.previous_velocities[k]) * (0.5 * h);
                given -= n * (taken * free[j]);
                forgotten += over * free[j];
            }
        }
    }
    cable.motion.account.land(given, forgotten);
    cable.motion.energies.correct(&ended.more);
}

/// Makes the contacts of the cable with itself plastic; its momentum is kept.
pub(in crate::model::fem) fn land_on_itself(cable: &mut CableState, h: f64, a: f64, ways: &NodalWays) {
    let (mut given, mut forgotten) = (Vec2::zeros(), Vec2::zeros());
    let mut ended = EndedImpulses { ways, a, more: Works::default() };
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
            ended.add(k, over * part, m.velocities[k], n, [Vec2::zeros(); 2], None);
            m.velocities[k] -= n * (taken * part * give(k));
            m.previous_velocities[k] += (over - n * taken) * (part * give(k));
            m.previous_positions[k] = m.positions[k] - (m.velocities[k] + m.previous_velocities[k]) * (0.5 * h);
            given -= n * (taken * part);
            forgotten += over * part;
        }
    }
    // Both are zero unless a support holds a side of the contact.
    cable.motion.account.land(given, forgotten);
    cable.motion.energies.correct(&ended.more);
}

/// The normal speed (m/s) that a plastic contact removes: all of an approaching speed, and at most
/// the part that its force `made` in the step of a receding one.
fn taken_speed(speed: f64, made: f64) -> f64 {
    if speed > made { made } else { speed }
}

/// Impulse (N s) of a contact that lasts after an impact: it balances the other forces, which are
/// the opposite of `against`, within its normal and friction cone.
fn lasting_impulse(against: Vec2, normal: Vec2, friction: f64) -> Vec2 {
    let (pressed, along) = (against.dot(&normal), perp(normal));
    let pressed = if pressed > 0.0 { pressed } else { 0.0 };
    normal * pressed + along * bounded(against.dot(&along), -friction * pressed, friction * pressed)
}

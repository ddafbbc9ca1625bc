//! This module reports contacts: neighbouring contacts with one obstacle are one report, and so is
//! each round.

use crate::energy::bending::turn;
use crate::math::{Vec2, larger};
use crate::model::fem::mesh::{BalancedTensions, SlideOver, SlidingNodeLoad};
use crate::model::fem::results::forces::{LyingEnd, tension_beside_round};
use crate::model::fem::results::self_contact;
use crate::model::fem::state::CableState;
use crate::model::fem::system::{ContactPair, FrictionContact, RoundFloorFriction};
use crate::solution::{ContactReport, ContactSample, ContactState};

/// Part of the slip over which friction grows to its limit, from which a contact slides. Smaller:
/// sticking contacts are reported as sliding; larger: round-off hides those that slide.
const SLIDING_SLIP_FRACTION: f64 = 0.999;

/// One report for each stretch of neighbouring contacts with one obstacle.
pub(super) fn contacts(
    d: &CableState,
    x: &[Vec2],
    tension: &[f64],
    lying_ends: &[Option<LyingEnd>; 2],
) -> Vec<ContactReport> {
    let mut touches: Vec<ContactPair> = Vec::new();
    d.contacts.find(&d.problem, &d.mesh, x, &mut touches);
    let mut obstacles: Vec<usize> = touches.iter().map(|t| t.pair.gap.obstacle).collect();
    obstacles.sort_unstable();
    obstacles.dedup();
    let mut out = Vec::new();
    for obstacle in obstacles {
        let mut stretch: Vec<ContactPair> = Vec::new();
        for t in touches.iter().filter(|t| t.pair.gap.obstacle == obstacle) {
            let elsewhere = |l: &ContactPair| t.node > l.node + 1 || t.node > l.node && d.mesh.is_break(l.node);
            if stretch.last().is_some_and(elsewhere) {
                out.push(report(d, x, tension, lying_ends, &stretch));
                stretch.clear();
            }
            stretch.push(*t);
        }
        out.push(report(d, x, tension, lying_ends, &stretch));
    }
    for end in lying_ends.iter().flatten() {
        add_lying_end(d, x, end, &mut out);
    }
    rounds(d, x, &mut out);
    self_contact::reports(d, x, tension, &mut out);
    out.retain(|c| c.normal_n > 0.0);
    out.sort_by(|a, b| a.arc_length_m.total_cmp(&b.arc_length_m));
    out
}

/// Adds the force on a lying end of the cable to the contact beside it.
fn add_lying_end(d: &CableState, x: &[Vec2], end: &LyingEnd, out: &mut Vec<ContactReport>) {
    let (tip, at) = (d.mesh.arc_length[end.node], d.mesh.arc_length[end.next]);
    let name = d.problem.world.obstacle_name(end.obstacle);
    let holds = |c: &&mut ContactReport| c.obstacle == name && c.begins_m <= at && c.ends_m >= at;
    if let Some(c) = out.iter_mut().find(holds) {
        c.normal_n += end.force.dot(&end.normal);
        c.friction_n += end.force.dot(&end.along);
        let mut samples = std::mem::take(&mut c.samples);
        samples.insert(if tip < at { 0 } else { samples.len() }, ContactSample::new(0.5 * (tip + at), end.force));
        c.set_samples(samples);
        (c.begins_m, c.ends_m) = (c.begins_m.min(tip), c.ends_m.max(tip));
        c.arc_length_m += 0.5 * (tip - at);
        let half = (x[end.node] - x[end.next]) * 0.5;
        (c.x_m, c.y_m) = (c.x_m + half.x, c.y_m + half.y);
    } else {
        // Only the end of the cable lies there.
        let mut c = ContactReport {
            obstacle: name.to_owned(),
            x_m: x[end.node].x,
            y_m: x[end.node].y,
            arc_length_m: tip,
            normal: [end.normal.x, end.normal.y],
            normal_n: end.force.dot(&end.normal),
            friction_n: end.force.dot(&end.along),
            begins_m: tip,
            ends_m: tip,
            ..ContactReport::default()
        };
        c.set_samples(vec![ContactSample::new(tip, end.force)]);
        out.push(c);
    }
}

/// One report for each corner, post or circle with sliding nodes.
fn rounds(d: &CableState, x: &[Vec2], out: &mut Vec<ContactReport>) {
    let n = x.len();
    let mut k = 1;
    while k + 1 < n {
        let first = k;
        k += 1;
        let Some(node) = d.mesh.sliding[first] else { continue };
        let SlideOver::Obstacle { obstacle, .. } = node.slide_over else { continue };
        while k + 1 < n && d.mesh.sliding[k].is_some_and(|s| s.shares_round(&node)) {
            k += 1;
        }
        let mut r = ContactReport {
            obstacle: d.problem.world.obstacle_name(obstacle).to_owned(),
            arc_length_m: 0.5 * (d.mesh.arc_length[first] + d.mesh.arc_length[k - 1]),
            ..ContactReport::default()
        };
        // A wrap slips only if all of it slips: one place that sticks is enough to hold the cable.
        let (mut push, mut turn, mut slips, mut samples) = (Vec2::zeros(), 0.0, true, Vec::new());
        for j in first..k {
            let (Some(load), Some(node)) = (d.load(j), &d.mesh.sliding[j]) else { continue };
            let [before, after] = [0, 1].map(|side| tension_beside_round(d, j, &load, side, x));
            // The law of friction relates the pulls along the bars: the transverse part of the
            // force is the cable's own weight, and the floor's friction on the sliding cable does
            // not belong to the round.
            let at_rest =
                BalancedTensions { pull: load.at_round(), turn: load.turn, momentum_flux: 0.0, pressed: load.pressed };
            let acts = node.balanced.unwrap_or(at_rest);
            let [a, b] = acts.pull;
            let floor = load.floor[1];
            let over = RoundFloorFriction::between([a, b], floor);
            let mean = over.map_or(0.5 * (a + b), |over| over.normal(1.0));
            // A compressed bar counts as slack there.
            let carried = d.input.loads.on_round(j);
            let pressed = larger(mean * acts.turn, 0.0) + acts.pressed;
            r.normal_n += pressed;
            push += node.end.mark * pressed;
            turn += load.turn;
            // Without friction the two tensions differ by weight alone.
            r.friction_n += if node.friction > 0.0 { a - b - floor } else { 0.0 };
            slips &= !node.sticks();
            // The arc of the round on either side of the node belongs to the contact.
            let lap = |e: usize, side: usize| {
                let stretch = d.mesh.thermal_stretch * (1.0 + load.tension[side] / d.problem.axial_stiffness);
                node.end.radius * d.mesh.path(e, x).arcs[1 - side] / stretch
            };
            if j == first {
                r.tension_before_n = before;
                r.begins_m = d.mesh.arc_length[j] - lap(j - 1, 0);
            }
            r.ends_m = d.mesh.arc_length[j] + lap(j, 1);
            samples.push(ContactSample::new(d.mesh.arc_length[j], round_force(&load, acts.momentum_flux) - carried));
            r.tension_after_n = after;
        }
        let normal = if push.norm() > 0.0 { push.normalize() } else { node.end.mark };
        let at = node.end.center + normal * node.end.radius;
        (r.x_m, r.y_m, r.normal) = (at.x, at.y, [normal.x, normal.y]);
        r.turn_deg = node.end.sense * turn.to_degrees();
        r.state = if slips { ContactState::Slip } else { ContactState::Stick };
        r.set_samples(samples);
        out.push(r);
    }
}

/// Force of a round on the cable at a sliding node, N: the change of the internal force, less the
/// momentum flux and the force of the floor.
fn round_force(load: &SlidingNodeLoad, momentum_flux: f64) -> Vec2 {
    let [before, after] = load.force.map(|f| f.try_normalize(0.0).unwrap_or_default());
    let on = (before + after).try_normalize(0.0).unwrap_or_default();
    (after - before) * momentum_flux - load.jump - before * load.floor[0] - on * load.floor[1] - after * load.floor[2]
}

/// Neighbouring contacts with one obstacle, and the state that they are read from.
struct NeighbouringContacts<'a> {
    state: &'a CableState,
    positions: &'a [Vec2],
    lying_ends: &'a [Option<LyingEnd>; 2],
    pairs: &'a [ContactPair],
    first: &'a ContactPair,
    last: &'a ContactPair,
}

/// The friction along a stretch.
struct StretchFriction {
    /// Force along the cable, N.
    force_n: f64,
    /// Limits of the contacts that slide, N.
    sliding_n: f64,
}

impl NeighbouringContacts<'_> {
    /// The part of a contact's force that is reported here: that on a sliding node or on a lying
    /// end is reported with that round or end.
    fn part(&self, t: &ContactPair) -> f64 {
        let ends = self.lying_ends.iter().flatten();
        let stays = |k: usize| self.state.mesh.sliding[k].is_some() || ends.clone().any(|l| l.node == k);
        let [a, b] = t.shares();
        (if stays(t.node) { 0.0 } else { a }) + (if b != 0.0 && !stays(t.node + 1) { b } else { 0.0 })
    }

    /// The contacts of the stretch that have friction.
    fn friction_contacts(&self) -> impl Iterator<Item = &FrictionContact> {
        self.state.contacts.friction_contacts.iter().filter(|r| {
            r.touch.pair.gap.obstacle == self.first.pair.gap.obstacle
                && (self.first.node..=self.last.node).contains(&r.touch.node)
        })
    }

    /// The friction along the cable, N.
    fn friction(&self) -> StretchFriction {
        let (d, x) = (self.state, self.positions);
        let mut out = StretchFriction { force_n: 0.0, sliding_n: 0.0 };
        for contact in self.friction_contacts() {
            let e = contact.touch.node.min(x.len() - 2);
            let along = d.mesh.direction(e, x);
            out.force_n += d.contacts.friction_force(contact, x).dot(&along) * self.part(&contact.touch);
            if contact.sliding(x).abs() > SLIDING_SLIP_FRACTION * d.contacts.slip {
                out.sliding_n += contact.limit;
            }
        }
        out
    }

    /// Turn of the cable from one bar to another, rad; it is summed bar by bar, because a wrap may
    /// go round more than once.
    fn turn(&self, [before, after]: [usize; 2]) -> f64 {
        let (mesh, x) = (&self.state.mesh, self.positions);
        (before..after)
            .filter(|&e| mesh.sliding[e + 1].is_none())
            .map(|e| turn(mesh.direction(e, x), mesh.direction(e + 1, x)))
            .sum()
    }

    fn arc_length(&self, t: &ContactPair) -> f64 {
        let s = &self.state.mesh.arc_length;
        s[t.node] + if t.on_segment { t.pair.gap.fraction * (s[t.node + 1] - s[t.node]) } else { 0.0 }
    }

    /// The forces along it, in order.
    fn samples(&self) -> Vec<ContactSample> {
        let contacts = &self.state.contacts;
        let press = |t: &ContactPair| t.pair.gap.normal * (t.load(&contacts.barrier) * self.part(t));
        let mut samples: Vec<ContactSample> =
            self.pairs.iter().map(|t| ContactSample::new(self.arc_length(t), press(t))).collect();
        for contact in self.friction_contacts() {
            let force = contacts.friction_force(contact, self.positions) * self.part(&contact.touch);
            samples.push(ContactSample::new(self.arc_length(&contact.touch), force));
        }
        samples.sort_by(|a, b| a.arc_length_m.total_cmp(&b.arc_length_m));
        samples
    }
}

/// The report of a run of neighbouring contacts.
fn report(
    d: &CableState,
    x: &[Vec2],
    tension: &[f64],
    lying_ends: &[Option<LyingEnd>; 2],
    pairs: &[ContactPair],
) -> ContactReport {
    let (Some(first), Some(last)) = (pairs.first(), pairs.last()) else {
        return ContactReport::default();
    };
    let stretch = NeighbouringContacts { state: d, positions: x, lying_ends, pairs, first, last };
    let before = if first.on_segment { first.node } else { first.node.saturating_sub(1) };
    let after = last.node.min(tension.len() - 1);
    let (mut normal, mut normal_n, mut limit_n) = (Vec2::zeros(), 0.0, 0.0);
    for t in pairs {
        let pressed = t.load(&d.contacts.barrier);
        let load = pressed * stretch.part(t);
        normal_n += load;
        normal += t.pair.gap.normal * load;
        limit_n += pressed * t.pair.gap.friction;
    }
    let friction = stretch.friction();
    let slips = first.pair.gap.friction == 0.0 || friction.sliding_n > 0.5 * limit_n;
    let unit = if normal.norm() > 0.0 { normal.normalize() } else { first.pair.gap.normal };
    let middle = (first.interpolate(x) + last.interpolate(x)) * 0.5;
    let [begins_m, ends_m] = [first, last].map(|t| stretch.arc_length(t));
    let mut out = ContactReport {
        obstacle: d.problem.world.obstacle_name(first.pair.gap.obstacle).to_owned(),
        x_m: middle.x,
        y_m: middle.y,
        arc_length_m: 0.5 * (begins_m + ends_m),
        normal: [unit.x, unit.y],
        normal_n,
        friction_n: friction.force_n,
        state: if slips { ContactState::Slip } else { ContactState::Stick },
        turn_deg: stretch.turn([before, after]).to_degrees(),
        tension_before_n: tension[before],
        tension_after_n: tension[after],
        begins_m,
        ends_m,
        ..ContactReport::default()
    };
    out.set_samples(stretch.samples());
    out
}

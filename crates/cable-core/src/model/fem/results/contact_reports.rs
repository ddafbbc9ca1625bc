//! This module reports contacts: neighbouring contacts with one obstacle are one report, and so is
//! each round.

use crate::energy::bending::turn;
use crate::math::{Vec2, larger};
use crate::model::fem::mesh::{BalancedTensions, SlideOver, SlidingNodeLoad};
use crate::model::fem::results::forces::LyingEnd;
use crate::model::fem::results::self_contact;
use crate::model::fem::state::CableState;
use crate::model::fem::system::{ContactPair, RoundFloorFriction};
use crate::solution::{ContactReport, ContactSample, ContactState};

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
            if stretch.last().is_some_and(|l| t.node > l.node + 1) {
                out.push(report(d, x, tension, lying_ends, &stretch));
                stretch.clear();
            }
            stretch.push(*t);
        }
        out.push(report(d, x, tension, lying_ends, &stretch));
    }
    for end in lying_ends.iter().flatten() {
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
    rounds(d, x, &mut out);
    self_contact::reports(d, x, tension, &mut out);
    out.retain(|c| c.normal_n > 0.0);
    out.sort_by(|a, b| a.arc_length_m.total_cmp(&b.arc_length_m));
    out
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
            let [before, after] = load.tension;
            // The law of friction relates the pulls along the bars: the transverse part of the
            // force is the cable's own weight, and the floor's friction on the sliding cable does
            // not belong to the round.
            let at_rest = BalancedTensions { pull: load.at_round(), turn: load.turn, momentum_flux: 0.0 };
            let acts = node.balanced.unwrap_or(at_rest);
            let [a, b] = acts.pull;
            let floor = load.floor[1];
            let over = RoundFloorFriction::between([a, b], floor);
            let mean = over.map_or(0.5 * (a + b), |over| over.normal(1.0));
            // A compressed bar counts as slack there.
            let pressed = larger(mean * acts.turn, 0.0);
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
            samples.push(ContactSample::new(d.mesh.arc_length[j], round_force(&load, acts.momentum_flux)));
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

fn report(
    d: &CableState,
    x: &[Vec2],
    tension: &[f64],
    lying_ends: &[Option<LyingEnd>; 2],
    stretch: &[ContactPair],
) -> ContactReport {
    let (Some(first), Some(last)) = (stretch.first(), stretch.last()) else {
        return ContactReport::default();
    };
    let bars = tension.len();
    let before = if first.on_segment { first.node } else { first.node.saturating_sub(1) };
    let after = last.node.min(bars - 1);
    let (mut normal, mut normal_n, mut friction_n) = (Vec2::zeros(), 0.0, 0.0);
    // The contact force on a sliding node or on a lying end is reported with that round or end.
    let stays = |k: usize| d.mesh.sliding[k].is_some() || lying_ends.iter().flatten().any(|l| l.node == k);
    let part = |t: &ContactPair| {
        let [a, b] = t.shares();
        (if stays(t.node) { 0.0 } else { a }) + (if b != 0.0 && !stays(t.node + 1) { b } else { 0.0 })
    };
    for t in stretch {
        let load = t.load(&d.contacts.barrier) * part(t);
        normal_n += load;
        normal += t.pair.gap.normal * load;
    }
    let mut slips = 0.0;
    let rubs = d.contacts.friction_contacts.iter().filter(|r| {
        r.touch.pair.gap.obstacle == first.pair.gap.obstacle && (first.node..=last.node).contains(&r.touch.node)
    });
    for rub in rubs.clone() {
        let e = rub.touch.node.min(bars - 1);
        let along = d.mesh.direction(e, x);
        friction_n += d.contacts.friction_force(rub, x).dot(&along) * part(&rub.touch);
        if rub.sliding(x).abs() > 0.999 * d.contacts.slip {
            slips += rub.limit;
        }
    }
    let limit: f64 = stretch.iter().map(|t| t.load(&d.contacts.barrier) * t.pair.gap.friction).sum();
    let (a, b) = (first.interpolate(x), last.interpolate(x));
    let arc = |t: &ContactPair| {
        let s = &d.mesh.arc_length;
        s[t.node] + if t.on_segment { t.pair.gap.fraction * (s[t.node + 1] - s[t.node]) } else { 0.0 }
    };
    let unit = if normal.norm() > 0.0 { normal.normalize() } else { first.pair.gap.normal };
    let middle = (a + b) * 0.5;
    // The turn is summed bar by bar, because a wrap may go round more than once.
    let turned: f64 = (before..after)
        .filter(|&e| d.mesh.sliding[e + 1].is_none())
        .map(|e| turn(d.mesh.direction(e, x), d.mesh.direction(e + 1, x)))
        .sum();
    let frictionless = first.pair.gap.friction == 0.0;
    let mut out = ContactReport {
        obstacle: d.problem.world.obstacle_name(first.pair.gap.obstacle).to_owned(),
        x_m: middle.x,
        y_m: middle.y,
        arc_length_m: 0.5 * (arc(first) + arc(last)),
        normal: [unit.x, unit.y],
        normal_n,
        friction_n,
        state: if frictionless || slips > 0.5 * limit { ContactState::Slip } else { ContactState::Stick },
        turn_deg: turned.to_degrees(),
        tension_before_n: tension[before],
        tension_after_n: tension[after],
        begins_m: arc(first),
        ends_m: arc(last),
        ..ContactReport::default()
    };
    let press = |t: &ContactPair| t.pair.gap.normal * (t.load(&d.contacts.barrier) * part(t));
    let mut samples: Vec<ContactSample> = stretch.iter().map(|t| ContactSample::new(arc(t), press(t))).collect();
    for rub in rubs {
        samples.push(ContactSample::new(arc(&rub.touch), d.contacts.friction_force(rub, x) * part(&rub.touch)));
    }
    samples.sort_by(|a, b| a.arc_length_m.total_cmp(&b.arc_length_m));
    out.set_samples(samples);
    out
}

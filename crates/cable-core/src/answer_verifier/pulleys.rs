//! The friction of eyes and wheels limits the change of tension beside them: the capstan law.
//!
//! With m from −μ to μ, t the direction, n the outward normal and b the load per metre, dT = m T dθ
//! − (b·t + m b·n) ds: the greatest tension after a pulley follows from that before it with m = μ,
//! the least with m = −μ (L. Euler, "Remarques sur l'effet du frottement dans l'équilibre", Mém.
//! Acad. Berlin 1762, with the weight on the wheel).

use super::checked_cable::CheckedCable;
use super::support_hold::Role;
use super::tolerance::{BALANCE_FRACTION, CONE_EXCESS, MATERIAL_TOLERANCE, REPORTED_BALANCE};
use crate::math::{Vec2, cross, larger};
use crate::solution::SupportReaction;
use crate::verification_report::{Law, Verification};

/// Distance from a wheel within which a node lies on it (round-off), as a fraction of its radius.
const WHEEL_TOLERANCE: f64 = 1e-9;

/// A pulley that leads the cable, with what it does.
struct PulleyContact<'a> {
    reaction: &'a SupportReaction,
    friction: f64,
    /// Centre and radius of the centre line; None for an eye.
    wheel: Option<(Vec2, f64)>,
    /// First and last node on it.
    nodes: [usize; 2],
}

/// Checks the friction of pulleys, and the tensions reported beside them.
pub(super) fn check_pulleys(checked: &CheckedCable<'_>, found: &mut Verification) {
    let nodes = &checked.answer.nodes;
    for contact in pulley_contacts(checked) {
        found.ask(Law::Friction);
        let [first, last] = contact.nodes;
        // A node without material before or after it is an end of the cable, so no cable leads to
        // the pulley.
        if first == 0 || last + 1 >= nodes.len() {
            continue;
        }
        let before = checked.force_before(first);
        let after = nodes[last].force();
        let [least, most] =
            [-contact.friction, contact.friction].map(|m| tension_after_pulley(checked, &contact, before, m));
        let value = larger(after.norm() - most, least - after.norm());
        let limit = CONE_EXCESS * larger(most, after.norm()) + BALANCE_FRACTION * checked.scale;
        let mut tell = |law: Law, value: f64, limit: f64| {
            if !(value <= limit) {
                let mut finding = checked.finding(law, first, value, limit);
                finding.with.clone_from(&contact.reaction.name);
                found.report(finding);
            }
        };
        tell(Law::Friction, value, limit);
        // Nodes just off the wheel count as on it: from there to the wheel the cable carries
        // its weight.
        let on = |k: &usize| contact.wheel.is_none_or(|(c, r)| (nodes[*k].at() - c).norm() <= r + WHEEL_TOLERANCE * r);
        let touches = [(first..=last).find(on).unwrap_or(last), (first..=last).rev().find(on).unwrap_or(first)];
        for (reported_n, force, beside) in [
            (contact.reaction.tension_before_n, before, [first - 1, touches[0]]),
            (contact.reaction.tension_after_n, after, [touches[1], last + 1]),
        ] {
            let [a, b] = beside.map(|k| nodes[k].arc_length_m);
            let limit = REPORTED_BALANCE * checked.scale + checked.body.norm() * (b - a);
            tell(Law::Tension, reported_n.map_or(0.0, |t| (t - force.norm()).abs()), limit);
        }
    }
}

/// The tension after a pulley that follows from the force before it with friction m, N.
fn tension_after_pulley(checked: &CheckedCable<'_>, contact: &PulleyContact<'_>, before: Vec2, m: f64) -> f64 {
    let nodes = &checked.answer.nodes;
    let turn = |a: Vec2, b: Vec2| cross(a, b).atan2(a.dot(&b)).abs();
    let [first, last] = contact.nodes;
    let mut tension = before.norm() * (m * turn(before, nodes[first].force())).exp();
    for pair in nodes[first..=last].windows(2) {
        let grown = (m * turn(pair[0].force(), pair[1].force())).exp();
        let way = (pair[1].at() - pair[0].at()).try_normalize(0.0).unwrap_or_default();
        let out = contact.wheel.map_or_else(Vec2::zeros, |(center, _)| {
            ((pair[0].at() + pair[1].at()) * 0.5 - center).try_normalize(0.0).unwrap_or_default()
        });
        let load = checked.body * (pair[1].arc_length_m - pair[0].arc_length_m);
        let half = 0.5 * (load.dot(&way) + m * load.dot(&out));
        tension = (tension - half) * grown - half;
    }
    tension
}

/// Pulleys that lead the cable now, with the nodes on them.
fn pulley_contacts<'a>(checked: &'a CheckedCable<'_>) -> Vec<PulleyContact<'a>> {
    let nodes = &checked.answer.nodes;
    let same = MATERIAL_TOLERANCE * checked.cable.length_m;
    let loaded = checked.loaded_rounds();
    let mut out = Vec::new();
    for hold in &checked.holds {
        let wheel = match hold.role {
            Role::Pulley => None,
            Role::Wheel { radius } => Some((hold.at, radius)),
            Role::Held | Role::Clear { .. } | Role::Load | Role::Released => continue,
        };
        let near = nodes.partition_point(|n| n.arc_length_m < hold.arc_length - same).min(nodes.len() - 1);
        let on = |k: usize| match wheel {
            Some((center, radius)) => checked.is_on_wheel(k, center, radius),
            None => (nodes[k].arc_length_m - hold.arc_length).abs() <= same,
        };
        // Between two nodes of a wheel the nearer one may be just off it.
        let Some(middle) = [near, near.saturating_sub(1)].into_iter().find(|&k| on(k)) else { continue };
        let first = (0..middle).rev().take_while(|&k| on(k)).last().unwrap_or(middle);
        let last = (middle + 1..nodes.len()).take_while(|&k| on(k)).last().unwrap_or(middle);
        // A load on the pulley itself is no part of this law, nor is one that runs on to it or off
        // it.
        let [from, to] = [first, last].map(|k| nodes[k].arc_length_m);
        let is_on = |at: f64| at >= from - same && at <= to + same;
        let is_loaded = |[a, b]: &[usize; 2]| *a <= last && *b >= first;
        if checked.scene_loads().any(is_on) || loaded.iter().any(is_loaded) {
            continue;
        }
        let friction = hold.support.friction.unwrap_or(0.0);
        out.push(PulleyContact { reaction: hold.reaction, friction, wheel, nodes: [first, last] });
    }
    out
}

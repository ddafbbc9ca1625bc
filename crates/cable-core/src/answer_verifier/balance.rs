//! This check finds whether the forces on each piece of a cable at rest add up to zero; in motion
//! they must change its momentum.
//!
//! With F(s) the internal force, b the load per metre and d the force of obstacles on a piece of
//! cable from s₁ to s₂, F(s₂) − F(s₁) + b (s₂ − s₁) + Σ P + d = 0, with P the point forces on it.
//! So d follows from the cable's values in the answer alone. It must be zero in the air, and
//! elsewhere within the friction cone about the normals of the obstacles that touch the piece.
//! Beyond its ends the cable has no internal force.

use super::checked_cable::{AppliedForce, CheckedCable, CheckedWheel};
use super::support_hold::{Role, SupportHold};
use super::surroundings::{NearestFeature, Neighbours};
use super::tolerance::{
    BALANCE_FRACTION, CONE_EXCESS, LUMPED_WEIGHT_TURN, MATERIAL_TOLERANCE, MOMENTUM, NORMAL_TOLERANCE, PIECE_EXCESS,
    REPORTED_BALANCE,
};
use crate::math::{Vec2, cross, larger, smaller, vec2};
use crate::solution::ContactReport;
use crate::verification_report::{Balance, Law, Verification};

/// Squared difference of two unit vectors from which they are two directions: the square of a
/// rounding of 1e-10. Smaller: one direction is counted twice; larger: flat corners have one.
const SAME_RAY_SQUARED: f64 = 1e-20;

/// A piece of the cable between two nodes, including both.
#[derive(Clone, Debug, Default)]
struct CheckedPiece {
    /// First and last node.
    nodes: [usize; 2],
    /// The force that obstacles must exert on it, N.
    contact: Vec2,
}

/// Checks that reported contacts push, within their friction cone.
pub(super) fn check_contacts(checked: &CheckedCable<'_>, found: &mut Verification) {
    found.ask(Law::Push);
    found.ask(Law::Friction);
    let noise = BALANCE_FRACTION * checked.scale;
    for c in &checked.answer.contacts {
        let friction = match checked.surroundings.find(&c.obstacle) {
            Some(body) => checked.surroundings.friction(body, checked.cable.friction),
            None => checked.cable.friction,
        };
        let node = checked.answer.nodes.partition_point(|n| n.arc_length_m < c.arc_length_m);
        let mut tell = |law: Law, value: f64, limit: f64| {
            if !(value <= limit) {
                let mut finding = checked.finding(law, node, value, limit);
                finding.with.clone_from(&c.obstacle);
                found.report(finding);
            }
        };
        tell(Law::Push, -c.normal_n, noise);
        tell(Law::Friction, c.friction_n.abs() - friction * c.normal_n, CONE_EXCESS * c.normal_n.abs() + noise);
    }
}

/// The pieces from node to node. A force at a node belongs to the piece that ends there, because
/// internal forces are those just after nodes.
fn pieces(checked: &CheckedCable<'_>) -> impl Iterator<Item = CheckedPiece> {
    let nodes = &checked.answer.nodes;
    let last = nodes.len() - 1;
    let same = MATERIAL_TOLERANCE * checked.cable.length_m;
    let self_contact_forces: Vec<AppliedForce> = checked.self_contact_forces().collect();
    // The last of the nodes at that material, and never before the first piece.
    let node = |s: f64| nodes.partition_point(|n| n.arc_length_m <= s + same).clamp(2, nodes.len()) - 1;
    let mut known: Vec<_> =
        checked.points.iter().chain(&self_contact_forces).map(|p| (node(p.arc_length), p.force)).collect();
    known.sort_by_key(|p| p.0);
    let mut known = known.into_iter().peekable();
    let loaded = checked.loaded_rounds();
    // Forces of moving bodies are known only to a node's neighbourhood.
    let cut = move |k: usize| {
        let [before, after] = [k - 1, (k + 1).min(last)].map(|k| nodes[k].arc_length_m);
        // Nodes of one material point are merged: if the cable turns round a point, the answer does
        // not describe its path there.
        nodes[k + 1].arc_length_m - nodes[k].arc_length_m > same
            && loaded.iter().all(|[first, last]| k < *first || k > *last)
            && self_contact_forces.iter().all(|p| !(p.arc_length >= before - same && p.arc_length <= after + same))
    };
    let mut from = 0;
    std::iter::from_fn(move || {
        if from == last {
            return None;
        }
        let to = (from + 1..last).find(|&k| cut(k)).unwrap_or(last);
        let [a, b] = [from, to].map(|k| &nodes[k]);
        // There is no cable beyond its ends.
        let before = if from == 0 { Vec2::zeros() } else { a.force() };
        let after = if to == last { Vec2::zeros() } else { b.force() };
        let mut contact = before - after - checked.body * (b.arc_length_m - a.arc_length_m);
        while let Some((_, force)) = known.next_if(|p| p.0 <= to) {
            contact -= force;
        }
        let piece = CheckedPiece { nodes: [from, to], contact };
        from = to;
        Some(piece)
    })
}

/// Friction beyond its cone, of one piece or of all.
struct ConeExcess {
    /// Force beyond the cone, N.
    value: f64,
    /// The excess that is allowed, N.
    limit: f64,
    /// The node where it is reported.
    node: usize,
}

/// Checks that the pieces of the cable are in balance, each and together.
pub(super) fn check_balance(checked: &CheckedCable<'_>, found: &mut Verification, near: &Neighbours) {
    [Law::Balance, Law::TotalBalance].into_iter().for_each(|law| found.ask(law));
    let limit = BALANCE_FRACTION * checked.scale;
    let mut sums = Balance { scale_n: larger(found.balance.scale_n, checked.scale), ..found.balance };
    let (mut adrift, mut beyond, mut pressed, mut in_air) = (Vec2::zeros(), 0.0, 0.0, 0.0);
    let (mut contacts, mut wheels, mut worst) = (Vec2::zeros(), Vec2::zeros(), (0.0, 0));
    let mut rays = Vec::new();
    let mut gross: Option<ConeExcess> = None;
    for piece in pieces(checked) {
        let Some(excess) = excess(checked, near, &piece, &mut rays) else {
            // In the air residuals add up: each may be small and their sum large.
            adrift += piece.contact;
            for square in [adrift.norm_squared(), piece.contact.norm_squared()] {
                in_air = f64::max(in_air, square);
                if !(square <= limit * limit) {
                    found.report(checked.finding(Law::Balance, piece.nodes[0], square.sqrt(), limit));
                }
            }
            continue;
        };
        adrift = Vec2::zeros();
        if on_wheel(checked, &piece) {
            wheels += piece.contact
        } else {
            contacts += piece.contact
        }
        beyond += excess;
        let size = piece.contact.norm();
        pressed += size;
        let [before, after] = piece.nodes.map(|k| checked.answer.nodes[k].force().norm());
        let its_own = limit + PIECE_EXCESS * larger(size, larger(before, after));
        if !(excess <= its_own) && gross.as_ref().is_none_or(|g| excess > g.value) {
            gross = Some(ConeExcess { value: excess, limit: its_own, node: piece.nodes[0] });
        }
        if excess > worst.0 || excess.is_nan() {
            worst = (excess, piece.nodes[0]);
        }
    }
    sums.residual_n = larger(larger(sums.residual_n, in_air.sqrt()), beyond);
    let allowed = limit + CONE_EXCESS * pressed;
    // All bends together may account for a small sum, and a single bend for a larger one at its
    // place.
    let [at_bends, apart] = if beyond <= allowed { [0.0; 2] } else { lumped_friction(checked, near) };
    let hidden = smaller(at_bends, REPORTED_BALANCE * checked.scale);
    let all = (!(beyond <= allowed + hidden) && !(apart <= allowed)).then_some(ConeExcess {
        value: beyond,
        limit: allowed,
        node: worst.1,
    });
    if let Some(ConeExcess { value, limit, node }) = all.or(gross) {
        let mut finding = checked.finding(Law::Friction, node, value, limit);
        let here = near.of(node).first();
        here.map_or("", |n| checked.surroundings.name(n.body)).clone_into(&mut finding.with);
        found.report(finding);
    }
    check_sums(checked, found, sums, [contacts, wheels]);
}

/// Returns the force on a piece beyond the friction cones of obstacles and floor, N; None if
/// nothing touches it.
fn excess(checked: &CheckedCable<'_>, near: &Neighbours, piece: &CheckedPiece, rays: &mut Vec<Vec2>) -> Option<f64> {
    let within = |n: &NearestFeature| {
        let pushes = piece.contact.dot(&n.normal);
        let friction = checked.surroundings.friction(n.body, checked.cable.friction);
        pushes > 0.0 && cross(n.normal, piece.contact).abs() <= friction * pushes
    };
    // Most pieces need no more than one of the things that touch them.
    if near.around(piece.nodes[0], piece.nodes[1]).iter().any(within) {
        return Some(0.0);
    }
    gather_rays(checked, near, piece, rays);
    let touches = !rays.is_empty() || checked.floor_rubs();
    touches.then(|| floor_excess(checked, piece, outside_cone(piece.contact, rays)))
}

/// Checks that the reported forces of contacts and wheels add up to those the cable needs.
fn check_sums(checked: &CheckedCable<'_>, found: &mut Verification, mut sums: Balance, [contacts, wheels]: [Vec2; 2]) {
    let limit = BALANCE_FRACTION * checked.scale;
    let known_here = |c: &&ContactReport| checked.surroundings.find(&c.obstacle).is_some();
    let reported: Vec2 = checked.answer.contacts.iter().filter(known_here).map(|c| vec2(c.force_n)).sum::<Vec2>()
        + checked.self_contact_forces().map(|p| p.force).sum::<Vec2>();
    let led: Vec2 = checked.holds.iter().filter(|h| matches!(h.role, Role::Wheel { .. })).map(SupportHold::force).sum();
    let known: Vec2 = checked.points.iter().map(|p| p.force).sum();
    let weight = checked.body * checked.cable.length_m;
    let whole = known + weight + led + reported;
    let off = if checked.floor_rubs() { (wheels - led).norm() } else { whole.norm() };
    sums.residual_n = larger(sums.residual_n, off);
    let limit = if checked.answer.contacts.is_empty() { limit } else { REPORTED_BALANCE * checked.scale };
    if !(off <= limit) {
        found.report(checked.finding(Law::TotalBalance, 0, off, limit));
    }
    let add = |to: &mut [f64; 2], v: Vec2| *to = [to[0] + v.x, to[1] + v.y];
    let supports: Vec2 = support_forces(checked);
    add(&mut sums.loads_n, known - supports + weight);
    add(&mut sums.supports_n, supports + led);
    add(&mut sums.contacts_n, contacts);
    found.balance = sums;
}

/// Forces of supports on the cable that are neither dead loads nor wheels, N.
fn support_forces(checked: &CheckedCable<'_>) -> Vec2 {
    checked.holds.iter().filter(|h| matches!(h.role, Role::Held | Role::Pulley)).map(SupportHold::force).sum()
}

/// Returns the part of an excess that exceeds the floor's friction, too, N.
fn floor_excess(checked: &CheckedCable<'_>, piece: &CheckedPiece, excess: f64) -> f64 {
    if !checked.floor_rubs() {
        return excess;
    }
    let weight = checked.cable.linear_density_kg_per_m * checked.scene.environment.gravity_m_per_s2;
    let nodes = &checked.answer.nodes;
    let last = nodes.len() - 1;
    // Friction at a node is that of half of both pieces beside it, and at an end of the cable also
    // that of the half there.
    let [a, b] = piece.nodes.map(|k| nodes[k].arc_length_m);
    let next = nodes[(piece.nodes[1] + 1).min(last)].arc_length_m;
    let half = if piece.nodes[0] == 0 { 0.5 * (b - a) } else { 0.0 };
    let share = larger(b - a, 0.5 * (next - a) + half);
    let previous = nodes[piece.nodes[0].saturating_sub(1)].arc_length_m;
    let here = |s: &f64| (previous..=next).contains(s);
    let gravity = checked.scene.environment.gravity_m_per_s2;
    let lumps: f64 = checked.lumps().filter(|(s, _)| here(s)).map(|(_, mass)| mass * gravity).sum();
    larger(excess - checked.cable.friction * (weight * share + lumps), 0.0)
}

fn on_wheel(checked: &CheckedCable<'_>, piece: &CheckedPiece) -> bool {
    checked.wheels.iter().any(|&CheckedWheel { center, radius, .. }| {
        bars_at(checked, piece).any(|bar| checked.touches_wheel(bar, center, radius).is_some())
    })
}

/// The bars of a piece, the one before it and the one after it.
fn bars_at(checked: &CheckedCable<'_>, piece: &CheckedPiece) -> std::ops::Range<usize> {
    let [from, to] = piece.nodes;
    from.saturating_sub(1)..(to + 1).min(checked.answer.nodes.len() - 1)
}

/// Returns two sums, N: the friction that the bars' own weight may add or hide where the ground
/// turns, and the excess of pieces over their cones after each is reduced by its own share of that.
/// A bar carries its weight to its ends, where it turns the cable by weight over tension, and so
/// presses like no edge.
fn lumped_friction(checked: &CheckedCable<'_>, near: &Neighbours) -> [f64; 2] {
    let nodes = &checked.answer.nodes;
    let last = nodes.len() - 1;
    let (mut rays, mut sums) = (Vec::new(), [0.0; 2]);
    for piece in pieces(checked) {
        let excess = excess(checked, near, &piece, &mut rays).unwrap_or(0.0);
        let [from, to] = [piece.nodes[0].saturating_sub(1), (piece.nodes[1] + 1).min(last)];
        // Material in folds lies beside the path, and turns nothing.
        let way: f64 = nodes[from..=to].windows(2).map(|pair| (pair[1].at() - pair[0].at()).norm()).sum();
        let weight = checked.body.norm() * smaller(nodes[to].arc_length_m - nodes[from].arc_length_m, way);
        let force = larger(nodes[piece.nodes[0]].force().norm(), nodes[piece.nodes[1]].force().norm());
        let turn = if weight < force { weight / force } else { 1.0 };
        let lumped = if gather_rays(checked, near, &piece, &mut rays) { weight * turn } else { 0.0 };
        // At most a fraction of the force there: slack cable hides nothing.
        let hidden = smaller(LUMPED_WEIGHT_TURN * greatest_friction(checked) * lumped, REPORTED_BALANCE * force);
        sums = [sums[0] + hidden, sums[1] + larger(excess - hidden, 0.0)];
    }
    sums
}

/// The greatest friction coefficient that the cable may meet.
fn greatest_friction(checked: &CheckedCable<'_>) -> f64 {
    checked.scene.obstacles.iter().map(|o| o.friction.unwrap_or(checked.cable.friction)).fold(0.0, larger)
}

/// Gathers unit vectors that bound the friction cones of all obstacles that touch a piece or its
/// neighbours, because a force that is known only at nodes is known to a node's neighbourhood.
/// Returns whether their normals differ, as at a corner.
fn gather_rays(checked: &CheckedCable<'_>, near: &Neighbours, piece: &CheckedPiece, out: &mut Vec<Vec2>) -> bool {
    out.clear();
    let (mut first, mut turns, mut before) = (None, false, (Vec2::zeros(), 0.0));
    let mut add = |normal: Vec2, friction: f64| {
        if normal == Vec2::zeros() || (normal, friction) == before {
            return;
        }
        before = (normal, friction);
        turns |= cross(*first.get_or_insert(normal), normal).abs() > NORMAL_TOLERANCE;
        let along = Vec2::new(normal.y, -normal.x) * friction;
        let shorten = 1.0 / (1.0 + friction * friction).sqrt();
        for ray in [(normal + along) * shorten, (normal - along) * shorten] {
            if out.iter().all(|r: &Vec2| (r - ray).norm_squared() > SAME_RAY_SQUARED) {
                out.push(ray);
            }
        }
    };
    let [from, to] = piece.nodes;
    for n in near.around(from, to) {
        add(n.normal, checked.surroundings.friction(n.body, checked.cable.friction));
    }
    for &CheckedWheel { center, radius, friction } in &checked.wheels {
        for k in (from..=to).filter(|&k| checked.is_on_wheel(k, center, radius)) {
            add((checked.answer.nodes[k].at() - center).try_normalize(0.0).unwrap_or_default(), friction);
        }
        // A stiff cable may touch the wheel between two nodes.
        for at in bars_at(checked, piece).filter_map(|bar| checked.touches_wheel(bar, center, radius)) {
            add((at - center).try_normalize(0.0).unwrap_or_default(), friction);
        }
    }
    turns
}

/// Checks that momentum changes by the impulses of the account, and that the impulse of the weight
/// is that of the mass.
pub(super) fn check_momentum(checked: &CheckedCable<'_>, found: &mut Verification) {
    let Some(account) = &checked.answer.momentum else { return };
    found.ask(Law::Momentum);
    let impulses = account.impulses_n_s().map(vec2);
    let [before, after] = [account.before_kg_m_per_s, account.after_kg_m_per_s].map(vec2);
    let sum: Vec2 = impulses.iter().sum();
    let largest = impulses.iter().map(|i| i.norm()).fold((after - before).norm(), larger);
    let value = (after - before - sum).norm();
    // A step may leave unbalanced as much as a rest may, even if nothing acts in it.
    let limit = larger(MOMENTUM * largest, BALANCE_FRACTION * checked.scale * account.over_s);
    if !(value <= limit) {
        found.report(checked.finding(Law::Momentum, 0, value, limit));
    }
}

/// Returns the distance of a force from the convex cone of some rays (unit vectors), N.
fn outside_cone(force: Vec2, rays: &[Vec2]) -> f64 {
    let size = force.norm();
    if size == 0.0 {
        return 0.0;
    }
    let mut least = size;
    for (k, a) in rays.iter().enumerate() {
        let along = force.dot(a);
        if along > 0.0 {
            least = least.min((force - a * along).norm());
        }
        for b in rays.iter().skip(k + 1) {
            let wide = cross(*a, *b);
            // force = αa + βb with both not negative.
            if wide != 0.0 && cross(force, *b) / wide >= 0.0 && cross(*a, force) / wide >= 0.0 {
                return 0.0;
            }
        }
    }
    least
}

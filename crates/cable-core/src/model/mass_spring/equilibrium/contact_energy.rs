//! Contacts and friction of a resting chain are energies.
//!
//! A contact is a spring from `OFFSET` on, ½k(gap − δ)² for gap < δ, on the signed sums of pairs
//! that make the force of a polyline continuous (see [`crate::contact::pairs`]). Friction is
//! measured from an anchor: the material point that was there and where, y = (X(s) − a)·t, limited
//! by μ times the normal force of the last accepted step; after a solve the anchor follows, y ←
//! clamp(y, ±ε) (see [`crate::contact::friction`]). A held contact then neither creeps nor forgets,
//! and sliding ends at the least that balances.

use crate::contact::Gap;
use crate::contact::friction;
use crate::contact::pairs::Pair;
use crate::math::{Mat2, Vec2, larger, perp};
use crate::model::mass_spring::equilibrium::newton::System;
use crate::model::mass_spring::{Anchor, MassSpringModel, Surface, Touch};

/// Gap at which a contact begins to push, m; the whole load on one contact closes it. Less is
/// stiffer and takes more steps, more lifts the cable.
const OFFSET: f64 = 2e-5;
/// What lies nearer than this to an obstacle at the start was laid there, m: the bars' barrier
/// keeps a millimetre. Less lets the cable slide while it falls that far, more anchors what hangs
/// beside.
const FIRST_CONTACT_DISTANCE: f64 = 2e-3;
/// Sliding at which friction is called up whole, m: less takes more steps, more creeps, and near a
/// held end, where a stiff cable moves by less, friction is called up in part only.
const SLIP: f64 = 5e-6;
/// A contact takes the anchor of material this near, in even lengths.
const ANCHOR_REACH_LENGTHS: f64 = 0.75;

part! {
    /// What the cable touches, and where friction holds it.
    ContactMemory {
        /// How far each element may still travel before it can touch anything, m.
        clearance: Vec<f64>,
        /// Contacts of the last sub-step.
        touches: Vec<Touch>,
        /// Room for the gaps of one element.
        gaps: Vec<Gap>,
        /// Where friction holds, between steps without inertia.
        anchors: Vec<Anchor>,
    }
}

/// Friction at one place, frozen for a step.
#[derive(Clone, Copy, Debug)]
struct Rub {
    anchor: Anchor,
    /// Element and fraction of the anchored material.
    element: usize,
    fraction: f64,
    /// Direction; zero on a floor, which rubs every way.
    along: Vec2,
    /// Greatest force, N.
    limit: f64,
    /// Which pair it belongs to.
    pair: usize,
}

/// A contact pair on element `e` (a node's pair has fraction 0 or 1).
#[derive(Clone, Copy, Debug)]
struct Push {
    element: usize,
    fraction: f64,
    pair: Pair,
    inside: bool,
}

impl Push {
    /// The material here, as it lies.
    fn anchor(&self, model: &MassSpringModel) -> Anchor {
        let (e, c) = (self.element, self.fraction);
        let at = model.chain.x[e] + (model.chain.x[e + 1] - model.chain.x[e]) * c;
        Anchor { surface: Surface::Obstacle(self.pair.gap.obstacle), s: model.chain.s[e] + model.chain.span[e] * c, at }
    }
}

/// What becomes of the points where friction held before an equilibrium is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::mass_spring) enum Anchors {
    /// Friction holds anew where the cable is.
    Forgotten,
    /// Friction goes on from where it held.
    Kept,
}

/// What the chain touches while it comes to rest.
pub(in crate::model::mass_spring) struct Contacts {
    stiffness: f64,
    anchors: Vec<Anchor>,
    rubs: Vec<Rub>,
    pushes: Vec<Push>,
}

impl Contacts {
    pub(in crate::model::mass_spring) fn new(model: &MassSpringModel, kept: Anchors) -> Self {
        let mut anchors = match kept {
            Anchors::Forgotten => Vec::new(),
            Anchors::Kept => model.contacts.anchors.clone(),
        };
        // Those of the floor come first, one a node.
        let on_floor = anchors.iter().filter(|a| a.surface == Surface::Floor).count();
        if model.problem.floor_friction.is_some() && on_floor != model.chain.x.len() {
            let others = anchors.iter().copied().filter(|a| a.surface != Surface::Floor);
            let floor =
                model.chain.s.iter().zip(&model.chain.x).map(|(&s, &at)| Anchor { surface: Surface::Floor, s, at });
            anchors = floor.chain(others).collect();
        }
        let stiffness = model.problem.force_scale() / OFFSET;
        let mut this = Self { stiffness, anchors, rubs: Vec::new(), pushes: Vec::new() };
        if kept == Anchors::Forgotten {
            this.find(model, FIRST_CONTACT_DISTANCE);
            let laid = this.pushes.iter().filter(|p| p.pair.weight > 0.0).map(|p| p.anchor(model));
            this.anchors.extend(laid);
        }
        this
    }

    /// Stiffness of a contact, N/m; 0 where there is nothing to touch.
    pub(in crate::model::mass_spring) fn stiffness(&self, model: &MassSpringModel) -> f64 {
        if model.problem.world.is_empty() { 0.0 } else { self.stiffness }
    }

    /// Every pair nearer than `reach`, m.
    fn find(&mut self, model: &MassSpringModel, reach: f64) {
        self.pushes.clear();
        if model.problem.world.is_empty() {
            return;
        }
        let (geometry, x) = (model.problem.world.geometry(), &model.chain.x);
        let last = x.len() - 1;
        for n in 0..=last {
            if !model.drives.held[n] {
                let before = n.checked_sub(1).map(|k| x[k]);
                let (element, fraction) = if n < last { (n, 0.0) } else { (n - 1, 1.0) };
                geometry.node_pairs(before, x[n], x.get(n + 1).copied(), reach, &mut |pair| {
                    self.pushes.push(Push { element, fraction, pair, inside: false });
                });
            }
            if n < last && !model.on_wheel(n) {
                geometry.segment_pairs(x[n], x[n + 1], reach, &mut |pair| {
                    self.pushes.push(Push { element: n, fraction: pair.gap.fraction, pair, inside: true });
                });
            }
        }
    }

    /// Takes normal forces and directions of friction from here; whether there is any.
    pub(in crate::model::mass_spring) fn refresh(&mut self, model: &mut MassSpringModel) -> bool {
        for p in &mut model.wheels.pulleys {
            let (sum, ea) = (p.tension[0] + p.tension[1], model.problem.axial_stiffness);
            let high = 0.5 * sum * (1.0 + p.grip());
            let low = sum - high;
            p.hold = model.problem.thermal_stretch * (high - low) * (1.0 + 0.5 * sum / ea);
        }
        let model = &*model;
        self.find(model, OFFSET);
        self.rubs.clear();
        if let Some((mu, normal)) = model.problem.floor_friction {
            for n in 0..model.chain.x.len() {
                let limit = mu * normal * model.half_share(n);
                let (element, fraction) = model.material(model.chain.s[n]);
                self.rubs.push(Rub {
                    anchor: self.anchors[n],
                    element,
                    fraction,
                    along: Vec2::zeros(),
                    limit,
                    pair: n,
                });
            }
        }
        let known = self.anchors.len();
        let mut taken = vec![false; known];
        for (k, push) in self.pushes.iter().enumerate() {
            let gap = push.pair.gap;
            if !(push.pair.weight > 0.0 && gap.friction > 0.0) {
                continue;
            }
            let e = push.element;
            let s = model.chain.s[e] + model.chain.span[e] * push.fraction;
            let nearest = (0..known)
                .filter(|&a| !taken[a] && self.anchors[a].surface == Surface::Obstacle(gap.obstacle))
                .min_by(|&a, &b| (self.anchors[a].s - s).abs().total_cmp(&(self.anchors[b].s - s).abs()))
                .filter(|&a| (self.anchors[a].s - s).abs() < ANCHOR_REACH_LENGTHS * model.chain.even);
            let anchor = match nearest {
                Some(a) => {
                    taken[a] = true;
                    self.anchors[a]
                }
                None => {
                    let new = push.anchor(model);
                    self.anchors.push(new);
                    new
                }
            };
            let (element, fraction) = model.material(anchor.s);
            let along = perp(gap.normal);
            let along = if along.dot(&(model.chain.x[e + 1] - model.chain.x[e])) < 0.0 { -along } else { along };
            let limit = gap.friction * self.stiffness * (OFFSET - gap.gap_m);
            self.rubs.push(Rub { anchor, element, fraction, along, limit, pair: k });
        }
        !self.rubs.is_empty() || !model.wheels.pulleys.is_empty()
    }

    /// Adds energy, gradient and Hessian of contacts (as they are here) and friction (as it was
    /// frozen).
    pub(in crate::model::mass_spring) fn assemble(&mut self, model: &MassSpringModel, system: &mut System) -> f64 {
        self.find(model, OFFSET);
        let mut value = 0.0;
        for push in &self.pushes {
            let (gap, e, c) = (push.pair.gap, push.element, push.fraction);
            let (k, depth) = (self.stiffness * push.pair.weight, OFFSET - gap.gap_m);
            value += 0.5 * k * depth * depth;
            let (n, force) = (gap.normal, k * depth);
            let shares = [1.0 - c, c];
            let stiff = n * n.transpose() * k;
            // ∇²gap: a contact inside an element turns its normal with it, a node turns round a
            // corner.
            let line = perp(n);
            let away = (model.chain.x[e] * shares[0] + model.chain.x[e + 1] * shares[1] - gap.point).norm();
            let turning = line * line.transpose() * if push.inside { 0.0 } else { self.round(push, away) };
            let (mut mixed, mut lever) = (Mat2::zeros(), Mat2::zeros());
            if push.inside {
                let d = model.chain.x[e + 1] - model.chain.x[e];
                let l = d.norm();
                mixed = n * d.transpose() * (force / (l * l));
                lever = n * n.transpose() * (force * away / (l * l));
            }
            for i in 0..2 {
                if shares[i] == 0.0 {
                    continue;
                }
                system.add_gradient(e + i, n * (-force * shares[i]));
                let sign = if i == 0 { -shares[0] } else { shares[1] };
                let bend = (mixed + mixed.transpose()) * sign + lever;
                system.add_block(e + i, e + i, &(stiff * (shares[i] * shares[i]) - turning * force + bend));
            }
            if shares[0] != 0.0 && shares[1] != 0.0 {
                let bend = mixed.transpose() * shares[0] - mixed * shares[1] - lever;
                system.add_block(e, e + 1, &(stiff * (shares[0] * shares[1]) + bend));
            }
        }
        value + self.assemble_friction(model, system)
    }

    /// Curvature of the gap of a node that lies nearest to a corner or a circle, 1/m.
    fn round(&self, push: &Push, away: f64) -> f64 {
        // Features with odd numbers are corners and circles.
        if push.pair.gap.feature % 2 == 1 && away > 0.0 { 1.0 / away } else { 0.0 }
    }

    fn assemble_friction(&self, model: &MassSpringModel, system: &mut System) -> f64 {
        let mut value = 0.0;
        for rub in &self.rubs {
            let shift = rub.shift(model);
            let (energy, gradient, hessian) = if rub.along == Vec2::zeros() {
                friction::at_plane(shift, rub.limit, SLIP)
            } else {
                let (energy, slope, stiff) = friction::at(shift.dot(&rub.along), rub.limit, SLIP);
                (energy, rub.along * slope, rub.along * rub.along.transpose() * stiff)
            };
            value += energy;
            let shares = [1.0 - rub.fraction, rub.fraction];
            for i in 0..2 {
                if shares[i] != 0.0 {
                    system.add_gradient(rub.element + i, gradient * shares[i]);
                    system.add_block(rub.element + i, rub.element + i, &(hessian * (shares[i] * shares[i])));
                }
            }
            if shares[0] != 0.0 && shares[1] != 0.0 {
                system.add_block(rub.element, rub.element + 1, &(hessian * (shares[0] * shares[1])));
            }
        }
        value
    }

    /// Returns where friction holds from now on.
    pub(in crate::model::mass_spring) fn commit(&self, model: &MassSpringModel) -> Vec<Anchor> {
        self.rubs
            .iter()
            .map(|rub| {
                let shift = rub.shift(model);
                if rub.along == Vec2::zeros() {
                    let at = rub.anchor.at + shift - friction::return_map_plane(shift, SLIP);
                    return Anchor { at, ..rub.anchor };
                }
                let push = &self.pushes[rub.pair.min(self.pushes.len() - 1)];
                let kept = friction::return_map(shift.dot(&rub.along), SLIP);
                let here = push.anchor(model);
                Anchor { at: here.at - rub.along * kept, ..here }
            })
            .collect()
    }

    /// Hands the contacts over as impulses of one second, as the answer reads them.
    pub(in crate::model::mass_spring) fn report(&self, model: &mut MassSpringModel) {
        model.contacts.touches.clear();
        for (k, push) in self.pushes.iter().enumerate().filter(|(_, p)| p.pair.weight > 0.0) {
            let rub = self.rubs.iter().find(|r| r.pair == k && r.along != Vec2::zeros());
            let (friction, limit) =
                rub.map_or((0.0, 0.0), |r| (-friction::at(r.shift(model).dot(&r.along), r.limit, SLIP).1, r.limit));
            model.contacts.touches.push(Touch {
                element: push.element,
                gap: crate::contact::Gap { fraction: push.fraction, ..push.pair.gap },
                normal: self.stiffness * push.pair.weight * (OFFSET - push.pair.gap.gap_m),
                friction,
                slips: limit > 0.0 && friction.abs() >= SLIP_FRACTION * limit,
            });
        }
    }
}

/// Part of the greatest friction from which on a contact is said to slide.
const SLIP_FRACTION: f64 = 0.999;

impl Rub {
    /// Returns how far the material has moved from its anchor, m.
    fn shift(&self, model: &MassSpringModel) -> Vec2 {
        let (a, b) = (model.chain.x[self.element], model.chain.x[self.element + 1]);
        a + (b - a) * self.fraction - self.anchor.at
    }
}

impl MassSpringModel {
    /// Returns what a floor leaves open of tension, over the largest: where the cable does not
    /// slide on it, friction is whatever the way there left, up to μ times what presses. 0 where
    /// nothing is remembered.
    pub(in crate::model::mass_spring) fn held_by_floor(&self) -> f64 {
        let Some((mu, normal)) = self.problem.floor_friction else { return 0.0 };
        let on_floor = self.contacts.anchors.iter().take_while(|a| a.surface == Surface::Floor).count();
        let top = self.chain.tension.iter().copied().fold(0.0, larger);
        if on_floor != self.chain.x.len() || !(top > 0.0) {
            return 0.0;
        }
        let sticks = |n: &usize| (self.chain.x[*n] - self.contacts.anchors[*n].at).norm() < SLIP_FRACTION * SLIP;
        let held: f64 = (0..on_floor).filter(sticks).map(|n| mu * normal * self.half_share(n)).sum();
        held / top
    }

    /// Element and fraction of a material point.
    fn material(&self, s: f64) -> (usize, f64) {
        let e = self.chain.s.partition_point(|&v| v <= s).clamp(1, self.chain.s.len() - 1) - 1;
        let fraction = (s - self.chain.s[e]) / self.chain.span[e];
        (e, if fraction > 1.0 { 1.0 } else { fraction })
    }
}

//! Contacts and friction of a resting cable are energies.
//!
//! A contact is a spring from a gap δ on, ½k(gap − δ)² for gap < δ, on the signed sums of pairs
//! that make the force of a polyline continuous (see [`crate::contact::obstacle_pairs`]). Friction
//! is measured from an anchor: the material point that was there and where, y = (X(s) − a)·t,
//! limited by μ times the normal force of the last accepted step; after a solve the anchor follows,
//! y ← clamp(y, ±ε) (see [`crate::contact::friction`]). A held contact then neither creeps nor
//! forgets, and sliding ends at the least that balances.

use crate::contact::friction as friction_law;
use crate::contact::obstacle_pairs::Pair;
use crate::math::{Mat2, Vec2, perp};
use crate::model::mass_spring::contact_memory::{Anchor, ContactImpulse, Surface};
use crate::model::mass_spring::equilibrium::system::EquilibriumSystem;
use crate::model::mass_spring::mesh::Mesh;
use crate::model::mass_spring::settings::ContactTuning;

/// Friction at one place, frozen for a step.
#[derive(Clone, Copy, Debug)]
struct FrozenFriction {
    anchor: Anchor,
    /// Element and fraction of the anchored material.
    element: usize,
    fraction: f64,
    /// Direction of sliding; zero on a floor, on which the cable slides every way.
    direction: Vec2,
    /// Greatest force, N.
    limit: f64,
    /// Index of the pair to which it belongs.
    pair: usize,
}

/// A contact pair on element `e` (a node's pair has fraction 0 or 1).
#[derive(Clone, Copy, Debug)]
struct PenaltyPair {
    element: usize,
    fraction: f64,
    signed: Pair,
    inside: bool,
}

impl PenaltyPair {
    /// The anchor of the material here, where it is now.
    fn anchor(&self, mesh: &Mesh) -> Anchor {
        let (e, c) = (self.element, self.fraction);
        let at = mesh.position[e] + (mesh.position[e + 1] - mesh.position[e]) * c;
        Anchor {
            surface: Surface::Obstacle(self.signed.gap.obstacle),
            arc_length: mesh.arc_length[e] + mesh.material_length[e] * c,
            at,
        }
    }
}

/// The treatment of the points where friction held before an equilibrium is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::mass_spring) enum Anchors {
    /// Friction holds anew where the cable is.
    Forgotten,
    /// Friction goes on from where it held.
    Kept,
}

/// The contacts of a mesh while its equilibrium is sought.
pub(in crate::model::mass_spring) struct Contacts {
    tuning: ContactTuning,
    stiffness: f64,
    anchors: Vec<Anchor>,
    friction: Vec<FrozenFriction>,
    pairs: Vec<PenaltyPair>,
}

impl Contacts {
    pub(in crate::model::mass_spring) fn new(mesh: &Mesh, anchors: &[Anchor], memory: Anchors) -> Self {
        let tuning = mesh.tuning.contact;
        let mut anchors = match memory {
            Anchors::Forgotten => Vec::new(),
            Anchors::Kept => anchors.to_vec(),
        };
        // Those of the floor come first, one a node.
        let on_floor = anchors.iter().filter(|a| a.surface == Surface::Floor).count();
        if mesh.problem.floor_friction.is_some() && on_floor != mesh.position.len() {
            anchors = with_floor(&anchors, mesh);
        }
        let stiffness = mesh.problem.force_scale() / tuning.offset_m;
        let mut this = Self { tuning, stiffness, anchors, friction: Vec::new(), pairs: Vec::new() };
        if memory == Anchors::Forgotten {
            this.find_pairs(mesh, tuning.first_contact_m);
            let new_anchors = this.pairs.iter().filter(|p| p.signed.weight > 0.0).map(|p| p.anchor(mesh));
            this.anchors.extend(new_anchors);
        }
        this
    }

    /// Follows a mesh that has got or lost nodes: the floor holds the material, not the node.
    pub(in crate::model::mass_spring) fn follow_nodes(&mut self, mesh: &Mesh) {
        if mesh.problem.floor_friction.is_some() {
            self.anchors = with_floor(&self.anchors, mesh);
        }
    }

    /// Stiffness of a contact, N/m; 0 where there is nothing to touch.
    pub(in crate::model::mass_spring) fn stiffness(&self, mesh: &Mesh) -> f64 {
        if mesh.problem.world.is_empty() { 0.0 } else { self.stiffness }
    }

    /// Finds all pairs nearer than `reach`, m.
    fn find_pairs(&mut self, mesh: &Mesh, reach: f64) {
        self.pairs.clear();
        if mesh.problem.world.is_empty() {
            return;
        }
        let (geometry, x) = (mesh.problem.world.geometry(), &mesh.position);
        let last = x.len() - 1;
        for n in 0..=last {
            if !mesh.supported[n] {
                let before = n.checked_sub(1).map(|k| x[k]);
                let (element, fraction) = if n < last { (n, 0.0) } else { (n - 1, 1.0) };
                geometry.node_pairs(before, x[n], x.get(n + 1).copied(), reach, &mut |signed| {
                    self.pairs.push(PenaltyPair { element, fraction, signed, inside: false });
                });
            }
            if n < last && !mesh.wheels.is_on_wheel(n) {
                geometry.segment_pairs(x[n], x[n + 1], reach, &mut |signed| {
                    self.pairs.push(PenaltyPair { element: n, fraction: signed.gap.fraction, signed, inside: true });
                });
            }
        }
    }

    /// Takes normal forces and directions of friction from here; returns true if there is friction.
    pub(in crate::model::mass_spring) fn freeze_friction(&mut self, mesh: &mut Mesh) -> bool {
        for p in &mut mesh.wheels.pulleys {
            let (sum, ea) = (p.tension[0] + p.tension[1], mesh.problem.axial_stiffness);
            let high = 0.5 * sum * (1.0 + p.friction_ratio());
            let low = sum - high;
            p.friction_limit = mesh.thermal_stretch * (high - low) * (1.0 + 0.5 * sum / ea);
        }
        self.find_pairs(mesh, self.tuning.offset_m);
        self.friction.clear();
        if mesh.problem.floor_friction.is_some() {
            for n in 0..mesh.position.len() {
                let limit = mesh.problem.max_floor_friction(mesh.half_straight_length(n), mesh.point_mass[n]);
                let (element, fraction) = mesh.locate(mesh.arc_length[n]);
                self.friction.push(FrozenFriction {
                    anchor: self.anchors[n],
                    element,
                    fraction,
                    direction: Vec2::zeros(),
                    limit,
                    pair: n,
                });
            }
        }
        let known = self.anchors.len();
        let mut taken = vec![false; known];
        for (k, pair) in self.pairs.iter().enumerate() {
            let gap = pair.signed.gap;
            if !(pair.signed.weight > 0.0 && gap.friction > 0.0) {
                continue;
            }
            let e = pair.element;
            let s = mesh.arc_length[e] + mesh.material_length[e] * pair.fraction;
            let nearest = (0..known)
                .filter(|&a| !taken[a] && self.anchors[a].surface == Surface::Obstacle(gap.obstacle))
                .min_by(|&a, &b| {
                    (self.anchors[a].arc_length - s).abs().total_cmp(&(self.anchors[b].arc_length - s).abs())
                })
                .filter(|&a| {
                    (self.anchors[a].arc_length - s).abs() < self.tuning.anchor_reach_lengths * mesh.even_length
                });
            let anchor = match nearest {
                Some(a) => {
                    taken[a] = true;
                    self.anchors[a]
                }
                None => {
                    let new = pair.anchor(mesh);
                    self.anchors.push(new);
                    new
                }
            };
            let (element, fraction) = mesh.locate(anchor.arc_length);
            let along = perp(gap.normal);
            let backwards = along.dot(&(mesh.position[e + 1] - mesh.position[e])) < 0.0;
            let direction = if backwards { -along } else { along };
            let limit = gap.friction * self.stiffness * (self.tuning.offset_m - gap.gap_m);
            self.friction.push(FrozenFriction { anchor, element, fraction, direction, limit, pair: k });
        }
        !self.friction.is_empty() || !mesh.wheels.pulleys.is_empty()
    }

    /// Adds energy, gradient and Hessian of contacts (as they are here) and friction (as it was
    /// frozen).
    pub(in crate::model::mass_spring) fn assemble(&mut self, mesh: &Mesh, system: &mut EquilibriumSystem) -> f64 {
        self.find_pairs(mesh, self.tuning.offset_m);
        let mut value = 0.0;
        for pair in &self.pairs {
            let (gap, e, c) = (pair.signed.gap, pair.element, pair.fraction);
            let (k, depth) = (self.stiffness * pair.signed.weight, self.tuning.offset_m - gap.gap_m);
            value += 0.5 * k * depth * depth;
            let (n, force) = (gap.normal, k * depth);
            let shares = [1.0 - c, c];
            let stiff = n * n.transpose() * k;
            // ∇²gap: a contact inside an element turns its normal with it, a node turns round a
            // corner.
            let line = perp(n);
            let away = (mesh.position[e] * shares[0] + mesh.position[e + 1] * shares[1] - gap.point).norm();
            let turning = line * line.transpose() * if pair.inside { 0.0 } else { curvature(pair, away) };
            let (mut mixed, mut lever) = (Mat2::zeros(), Mat2::zeros());
            if pair.inside {
                let d = mesh.position[e + 1] - mesh.position[e];
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
        value + self.assemble_friction(mesh, system)
    }

    fn assemble_friction(&self, mesh: &Mesh, system: &mut EquilibriumSystem) -> f64 {
        let mut value = 0.0;
        for contact in &self.friction {
            let shift = contact.shift(mesh);
            let (energy, gradient, hessian) = if contact.direction == Vec2::zeros() {
                friction_law::at_plane(shift, contact.limit, self.tuning.slip_m)
            } else {
                let (energy, slope, stiff) =
                    friction_law::at(shift.dot(&contact.direction), contact.limit, self.tuning.slip_m);
                (energy, contact.direction * slope, contact.direction * contact.direction.transpose() * stiff)
            };
            value += energy;
            let shares = [1.0 - contact.fraction, contact.fraction];
            for i in 0..2 {
                if shares[i] != 0.0 {
                    system.add_gradient(contact.element + i, gradient * shares[i]);
                    system.add_block(contact.element + i, contact.element + i, &(hessian * (shares[i] * shares[i])));
                }
            }
            if shares[0] != 0.0 && shares[1] != 0.0 {
                system.add_block(contact.element, contact.element + 1, &(hessian * (shares[0] * shares[1])));
            }
        }
        value
    }

    /// The points where friction holds from now on.
    pub(in crate::model::mass_spring) fn moved_anchors(&self, mesh: &Mesh) -> Vec<Anchor> {
        self.friction
            .iter()
            .map(|contact| {
                let shift = contact.shift(mesh);
                if contact.direction == Vec2::zeros() {
                    let at = contact.anchor.at + shift - friction_law::return_map_plane(shift, self.tuning.slip_m);
                    return Anchor { at, ..contact.anchor };
                }
                let pair = &self.pairs[contact.pair.min(self.pairs.len() - 1)];
                let elastic_slip = friction_law::return_map(shift.dot(&contact.direction), self.tuning.slip_m);
                let here = pair.anchor(mesh);
                Anchor { at: here.at - contact.direction * elastic_slip, ..here }
            })
            .collect()
    }

    /// The contacts as impulses of one second, as the answer reads them.
    pub(in crate::model::mass_spring) fn impulses(&self, mesh: &Mesh) -> Vec<ContactImpulse> {
        let mut impulses = Vec::with_capacity(self.pairs.len());
        for (k, pair) in self.pairs.iter().enumerate().filter(|(_, p)| p.signed.weight > 0.0) {
            let contact = self.friction.iter().find(|r| r.pair == k && r.direction != Vec2::zeros());
            let (friction, limit) = contact.map_or((0.0, 0.0), |r| {
                (-friction_law::at(r.shift(mesh).dot(&r.direction), r.limit, self.tuning.slip_m).1, r.limit)
            });
            impulses.push(ContactImpulse {
                element: pair.element,
                gap: crate::contact::Gap { fraction: pair.fraction, ..pair.signed.gap },
                normal: self.stiffness * pair.signed.weight * (self.tuning.offset_m - pair.signed.gap.gap_m),
                friction,
                slips: limit > 0.0 && friction.abs() >= self.tuning.slip_fraction * limit,
            });
        }
        impulses
    }
}

/// The anchors with one on the floor for each node, first: where its material has its anchor, or
/// where it is if none is known.
fn with_floor(anchors: &[Anchor], mesh: &Mesh) -> Vec<Anchor> {
    let known: Vec<&Anchor> = anchors.iter().filter(|a| a.surface == Surface::Floor).collect();
    let anchor_of = |(&s, &at): (&f64, &Vec2)| {
        let k = known.partition_point(|a| a.arc_length < s);
        let at = match (k.checked_sub(1).and_then(|k| known.get(k)), known.get(k)) {
            (Some(a), Some(b)) => a.at + (b.at - a.at) * ((s - a.arc_length) / (b.arc_length - a.arc_length)),
            (Some(one), None) | (None, Some(one)) => one.at,
            (None, None) => at,
        };
        Anchor { surface: Surface::Floor, arc_length: s, at }
    };
    let floor = mesh.arc_length.iter().zip(&mesh.position).map(anchor_of);
    floor.chain(anchors.iter().copied().filter(|a| a.surface != Surface::Floor)).collect()
}

/// Curvature of the gap of a node that lies nearest to a corner or a circle, 1/m.
fn curvature(pair: &PenaltyPair, away: f64) -> f64 {
    // Features with odd numbers are corners and circles.
    if pair.signed.gap.feature % 2 == 1 && away > 0.0 { 1.0 / away } else { 0.0 }
}

impl FrozenFriction {
    /// Displacement of the material from its anchor, m.
    fn shift(&self, mesh: &Mesh) -> Vec2 {
        let (a, b) = (mesh.position[self.element], mesh.position[self.element + 1]);
        a + (b - a) * self.fraction - self.anchor.at
    }
}

//! This module holds the contacts of a cable with itself in a step: barrier, friction and its
//! memory.
//!
//! As with obstacles, the normal force of friction is that of the step before, and the slide is
//! measured from an anchor.

use crate::contact::barrier::Barrier;
use crate::contact::friction;
use crate::contact::self_contact_pairs::{SelfContact, SelfPair, SortedNodes};
use crate::energy::Curvature;
use crate::math::{Mat2, Vec2};
use crate::model::fem::mesh::Mesh;
use crate::model::fem::system::assembly::System;

/// Friction of one contact of the cable with itself during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfFriction {
    /// The contact.
    pub pair: SelfPair,
    /// Largest friction force μN, N.
    pub limit: f64,
    /// Slide from the anchor at the start of the step, m.
    slid: f64,
    /// Position of the node relative to the segment at the start of the step, m.
    origin: Vec2,
}

impl SelfFriction {
    /// Slide of the node along the segment from the anchor, m.
    #[must_use]
    pub fn sliding(&self, x: &[Vec2]) -> f64 {
        self.slid + self.pair.tangent().dot(&(self.pair.difference(x) - self.origin))
    }
}

/// The slide of a contact at the end of the last step.
#[derive(Clone, Copy, Debug)]
struct RememberedSlide {
    node: usize,
    segment: usize,
    /// Slide from the anchor, m.
    slid: f64,
}

/// The contacts of a cable with itself, with their history.
#[derive(Clone, Debug, Default)]
pub struct SelfContacts {
    /// The cable as an obstacle.
    pub shape: SelfContact,
    /// Coulomb friction coefficient of the cable on itself.
    pub friction: f64,
    /// Friction of the present step.
    pub friction_contacts: Vec<SelfFriction>,
    memory: Vec<RememberedSlide>,
    scratch: Vec<SelfPair>,
    order: SortedNodes,
}

impl SelfContacts {
    /// Becomes a copy of `other`, reusing its memory where possible.
    pub fn copy_from(&mut self, other: &Self) {
        self.shape.copy_from(&other.shape);
        self.friction = other.friction;
        self.friction_contacts.clone_from(&other.friction_contacts);
        self.memory.clone_from(&other.memory);
    }

    /// Forgets all friction.
    pub fn forget(&mut self) {
        self.memory.clear();
        self.friction_contacts.clear();
    }

    /// Sets up friction for a step that began at `start`: contacts and normal forces as at `now`
    /// (m).
    pub fn prepare(&mut self, barrier: &Barrier, mesh: &Mesh, now: &[Vec2], start: &[Vec2]) {
        self.friction_contacts.clear();
        if !self.shape.is_on() {
            return;
        }
        self.shape.pairs(now, &mesh.arc_length, barrier.reach, &mut self.order, &mut self.scratch);
        for pair in &self.scratch {
            let load = -barrier.at(pair.gap_m).slope * pair.weight;
            if load > 0.0 {
                let known = |m: &&RememberedSlide| (m.node, m.segment) == (pair.node, pair.segment);
                let slid = self.memory.iter().find(known).map_or(0.0, |m| m.slid);
                let origin = pair.difference(start);
                self.friction_contacts.push(SelfFriction { pair: *pair, limit: self.friction * load, slid, origin });
            }
        }
    }

    /// Breaks the cable at node `k`, whose copy for the second piece has become node `k` + 1 of
    /// the mesh at positions `x` (m).
    pub fn break_at(&mut self, k: usize, mesh: &Mesh, x: &[Vec2], reach: f64) {
        self.friction_contacts.clear();
        for RememberedSlide { node, segment, .. } in &mut self.memory {
            *node += usize::from(*node > k);
            *segment += usize::from(*segment >= k);
        }
        self.shape.break_at(k, x, &mesh.arc_length, reach);
    }

    /// Accepts a step that ended at `end` (m), with a barrier of this `reach` (m): anchors follow
    /// contacts that slid by more than `slip` (m).
    pub fn commit(&mut self, end: &[Vec2], slip: f64, reach: f64) {
        self.shape.part(end, reach);
        self.memory.clear();
        for contact in &mut self.friction_contacts {
            contact.slid = friction::return_map(contact.sliding(end), slip);
            contact.origin = contact.pair.difference(end);
            self.memory.push(RememberedSlide {
                node: contact.pair.node,
                segment: contact.pair.segment,
                slid: contact.slid,
            });
        }
    }

    /// Smallest gap (m) and its node, if any is below `within` (m).
    #[must_use]
    pub fn smallest_gap(&self, mesh: &Mesh, x: &[Vec2], within: f64) -> Option<(f64, usize)> {
        self.shape.smallest_gap(x, &mesh.arc_length, within)
    }
}

/// Entries (row, column, value) of the Hessian outside its band, one of each symmetric pair.
pub type Coupling = Vec<(usize, usize, f64)>;

/// The laws of contact of the cable with itself.
#[derive(Clone, Copy, Debug)]
pub struct SelfContactLaws<'a> {
    /// The contacts and their friction.
    pub self_contacts: &'a SelfContacts,
    /// The barrier.
    pub barrier: &'a Barrier,
    /// Slide at which friction is fully mobilised, m.
    pub slip: f64,
}

/// Adds barrier and friction of the cable on itself at `x` (m); returns the energy and the sum of
/// the magnitudes of its terms, J.
///
/// A pair's distance d = m·(p − c) has, with u along the segment of length l, the curvature (as in
/// `contact_energy.rs`)
/// ```text
/// inside:  ∇²d = −(θ qᵀ + q θᵀ) − d θ θᵀ,   θ = m·(δb − δa)/l,   q = u·(δp − δc)
/// joint:   ∇²d = (I − m mᵀ)/d on δp − δc
/// ```
pub fn add(
    s: &mut System,
    coupling: &mut Coupling,
    laws: SelfContactLaws<'_>,
    pairs: &[SelfPair],
    x: &[Vec2],
    curvature: Curvature,
) -> (f64, f64) {
    let SelfContactLaws { self_contacts, barrier, slip } = laws;
    let exact = curvature == Curvature::Exact;
    let (mut value, mut size) = (0.0, 0.0);
    for pair in pairs {
        let b = barrier.at(pair.gap_m);
        let (slope, bend) = (b.slope * pair.weight, b.curvature * pair.weight);
        let bend = if !exact && bend < 0.0 { 0.0 } else { bend };
        let (n, d) = (pair.normal, pair.distance_m);
        let shares = pair.shares();
        let chord = x[pair.segment + 1] - x[pair.segment];
        let (length, inside) = (chord.norm(), pair.fraction > 0.0 && pair.fraction < 1.0);
        let u = chord / length;
        let theta = [Vec2::zeros(), -n / length, n / length];
        for (j, &(node, part)) in shares.iter().enumerate() {
            s.add_gradient(node, n * (slope * part));
            for (k, &(other, its)) in shares.iter().enumerate().skip(j) {
                let mut block = n * n.transpose() * (bend * part * its);
                if exact && inside {
                    let turn = theta[j] * (u * its).transpose() + (u * part) * theta[k].transpose();
                    block -= (turn + theta[j] * theta[k].transpose() * d) * slope;
                } else if exact {
                    block += (Mat2::identity() - n * n.transpose()) * (slope * part * its / d);
                }
                couple(s, coupling, [node, other], &block);
            }
        }
        value += b.value * pair.weight;
        size += b.value;
    }
    for contact in &self_contacts.friction_contacts {
        let (d, slope, bend) = friction::at(contact.sliding(x), contact.limit, slip);
        let (t, shares) = (contact.pair.tangent(), contact.pair.shares());
        for (j, &(node, part)) in shares.iter().enumerate() {
            s.add_gradient(node, t * (slope * part));
            for &(other, its) in &shares[j..] {
                couple(s, coupling, [node, other], &(t * t.transpose() * (bend * part * its)));
            }
        }
        value += d;
        size += d;
    }
    (value, size)
}

/// Adds a block for two nodes, in the band or outside it.
pub(in crate::model::fem) fn couple(s: &mut System, coupling: &mut Coupling, [i, j]: [usize; 2], block: &Mat2) {
    if i.abs_diff(j) <= 1 {
        s.add_block(i, j, block);
        return;
    }
    for (r, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        coupling.push((2 * i + r, 2 * j + c, block[(r, c)]));
    }
}

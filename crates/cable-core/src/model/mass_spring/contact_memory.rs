//! The contacts of the last sub-step, and the points from which friction at rest is measured.

use crate::contact::Gap;
use crate::math::{Vec2, larger};
use crate::model::mass_spring::mesh::Mesh;

part! {
    /// The contacts of the cable, and the points where friction holds it.
    #[derive(Default)]
    ContactMemory {
        /// Distance that each element may still travel before it can touch anything, m.
        clearance: Vec<f64>,
        /// Contacts of the last sub-step.
        impulses: Vec<ContactImpulse>,
        /// Room for those of the sub-step before.
        known_before: Vec<ContactImpulse>,
        /// Room for the gaps of one element.
        gap_buffer: Vec<Gap>,
        /// Points where friction holds, between steps without inertia.
        anchors: Vec<Anchor>,
    }
}

/// The surface to which an anchor holds the cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::mass_spring) enum Surface {
    /// The floor of a plan view, on which all of the cable lies.
    Floor,
    /// The obstacle of this index.
    Obstacle(usize),
}

/// The point where friction holds the cable.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::mass_spring) struct Anchor {
    pub surface: Surface,
    /// Arc length of the material, m.
    pub arc_length: f64,
    pub at: Vec2,
}

/// A contact in the last sub-step.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::mass_spring) struct ContactImpulse {
    pub element: usize,
    pub gap: Gap,
    /// Normal impulse, N·s.
    pub normal: f64,
    /// Friction impulse along growing arc length, N·s.
    pub friction: f64,
    pub slips: bool,
}

impl ContactImpulse {
    /// Returns whether this is the contact of the same element with the same feature.
    pub(in crate::model::mass_spring) fn is_same_place(&self, other: &Self) -> bool {
        self.element == other.element && self.gap.feature == other.gap.feature
    }

    /// Unit vector along growing arc length, along the surface.
    pub(in crate::model::mass_spring) fn tangent(&self, mesh: &Mesh) -> Vec2 {
        let n = self.gap.normal;
        let along = mesh.position[self.element + 1] - mesh.position[self.element];
        (along - n * along.dot(&n)).try_normalize(0.0).unwrap_or(Vec2::new(n.y, -n.x))
    }

    /// Its impulse on the cable, N·s.
    pub(in crate::model::mass_spring) fn impulse(&self, mesh: &Mesh) -> Vec2 {
        self.gap.normal * self.normal + self.tangent(mesh) * self.friction
    }

    /// The nodes that it moves, and how much velocity an impulse of one gives each, 1/kg.
    pub(in crate::model::mass_spring) fn shares(&self, mesh: &Mesh) -> [(usize, f64); 2] {
        let c = self.gap.fraction;
        let share = |i: usize, part: f64| (i, if mesh.supported[i] { 0.0 } else { part / mesh.mass[i] });
        [share(self.element, 1.0 - c), share(self.element + 1, c)]
    }
}

impl ContactMemory {
    /// Room for contacts of a number of elements.
    pub(in crate::model::mass_spring) fn new(elements: usize) -> Self {
        Self {
            clearance: vec![0.0; elements],
            impulses: Vec::with_capacity(2 * elements),
            known_before: Vec::with_capacity(2 * elements),
            gap_buffer: Vec::with_capacity(16),
            anchors: Vec::new(),
        }
    }

    /// Forgets the distances to obstacles, since nodes were moved.
    pub(in crate::model::mass_spring) fn forget_distances(&mut self) {
        self.clearance.fill(0.0);
    }

    /// Forgets distances and impulses, since the mesh now has a number of other elements.
    pub(in crate::model::mass_spring) fn renew(&mut self, elements: usize) {
        self.clearance.clear();
        self.clearance.resize(elements, 0.0);
        self.impulses.clear();
    }

    /// Part of the largest tension that a floor leaves open: where the cable does not slide on it,
    /// friction is whatever the path there left, up to μ times the normal force. 0 where nothing is
    /// remembered.
    pub(in crate::model::mass_spring) fn floor_uncertainty(&self, mesh: &Mesh) -> f64 {
        if mesh.problem.floor_friction.is_none() {
            return 0.0;
        }
        let on_floor = self.anchors.iter().take_while(|a| a.surface == Surface::Floor).count();
        let top = mesh.tension.iter().copied().fold(0.0, larger);
        if on_floor != mesh.position.len() || !(top > 0.0) {
            return 0.0;
        }
        let tuning = &mesh.tuning.contact;
        let sticks =
            |n: &usize| (mesh.position[*n] - self.anchors[*n].at).norm() < tuning.slip_fraction * tuning.slip_m;
        let limit = |n: usize| mesh.problem.max_floor_friction(mesh.half_straight_length(n), mesh.point_mass[n]);
        let sticking_limit: f64 = (0..on_floor).filter(sticks).map(limit).sum();
        sticking_limit / top
    }
}

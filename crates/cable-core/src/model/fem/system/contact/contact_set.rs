//! The contact set holds the contacts of a mesh in a step: the barrier, the search, and friction,
//! whose normal forces are frozen during a solve.

use crate::contact::barrier::Barrier;
use crate::contact::friction;
use crate::math::{Vec2, larger};
use crate::model::fem::mesh::Mesh;
use crate::model::fem::settings::ContactTuning;
use crate::model::fem::system::contact::barrier_stiffness;
use crate::model::fem::system::contact::body_motion::BodyMotion;
use crate::model::fem::system::contact::contact_pair::ContactPair;
use crate::model::fem::system::contact::contact_search::ContactSearch;
use crate::model::fem::system::contact::friction_contact::{FrictionContact, of_node};
use crate::model::fem::system::contact::friction_memory::FrictionMemory;
use crate::model::fem::system::contact::self_contact::SelfContacts;
use crate::problem::Problem;

/// All contacts of a mesh with their history.
#[derive(Clone, Debug)]
pub struct ContactSet {
    /// The tuned constants of contact.
    pub tuning: ContactTuning,
    /// The barrier.
    pub barrier: Barrier,
    /// The barrier with which the last accepted step was balanced.
    balanced: Barrier,
    /// Slide ε at which friction is fully mobilised, m.
    pub slip: f64,
    /// Friction of the present step.
    pub friction_contacts: Vec<FrictionContact>,
    /// The friction contacts before their normal forces were renewed.
    before: Vec<FrictionContact>,
    /// The memory of slides from anchors.
    memory: FrictionMemory,
    scratch: Vec<ContactPair>,
    /// The search for contacts.
    pub search: ContactSearch,
    /// Plan view: slide of each node from its anchor, m.
    pub floor_slip: Vec<Vec2>,
    /// Contacts of the cable with itself.
    pub self_contacts: SelfContacts,
    /// Motions of bodies in this step.
    pub body_motions: Vec<BodyMotion>,
}

impl ContactSet {
    /// A set without contacts.
    #[must_use]
    pub fn new(barrier: Barrier, tuning: ContactTuning, nodes: usize) -> Self {
        Self {
            tuning,
            barrier,
            balanced: barrier,
            slip: tuning.slip_m,
            friction_contacts: Vec::with_capacity(nodes),
            before: Vec::with_capacity(nodes),
            memory: FrictionMemory::with_room_for(nodes),
            scratch: Vec::with_capacity(nodes),
            search: ContactSearch::default(),
            floor_slip: vec![Vec2::zeros(); nodes],
            self_contacts: SelfContacts::default(),
            body_motions: Vec::new(),
        }
    }

    /// Copies another set, reusing its memory where possible.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { barrier, balanced, slip, friction_contacts, memory, floor_slip, .. } = other;
        let Self { self_contacts, body_motions, .. } = other;
        (self.barrier, self.balanced, self.slip) = (*barrier, *balanced, *slip);
        // Memory is reserved for as many contacts, so that a travelling contact front needs no
        // allocation; and for no more, or each copy would double it.
        self.friction_contacts.clear();
        self.friction_contacts.reserve_exact(friction_contacts.capacity());
        self.friction_contacts.extend_from_slice(friction_contacts);
        self.memory.copy_from(memory);
        self.floor_slip.clone_from(floor_slip);
        self.self_contacts.copy_from(self_contacts);
        self.body_motions.clone_from(body_motions);
    }

    /// The motion in this step of the body that a contact is with, if it moves.
    pub fn motion_of(&self, touch: &ContactPair) -> Option<&BodyMotion> {
        self.body_motions.iter().find(|motion| motion.obstacle == touch.pair.gap.obstacle)
    }

    /// Sets the slide at which friction is fully mobilised (m); every contact keeps its force.
    pub fn set_slip(&mut self, slip: f64) {
        let part = slip / self.slip;
        if part == 1.0 {
            return;
        }
        self.memory.scale(part);
        self.friction_contacts.iter_mut().for_each(|r| r.slid *= part);
        self.floor_slip.iter_mut().for_each(|s| *s *= part);
        self.slip = slip;
    }

    /// Forgets all friction.
    pub fn forget(&mut self) {
        self.memory.clear();
        self.friction_contacts.clear();
        self.floor_slip.fill(Vec2::zeros());
        self.self_contacts.forget();
    }

    /// Stores the slide of a contact from its anchor, m.
    pub fn remember(&mut self, touch: &ContactPair, slid: f64) {
        self.memory.remember(touch, slid);
    }

    /// Finds the contacts of the mesh at `x` (m), in order of arc length. Held nodes have no
    /// contacts.
    pub fn find(&self, problem: &Problem, mesh: &Mesh, x: &[Vec2], out: &mut Vec<ContactPair>) {
        self.find_within(problem, mesh, x, self.barrier.reach, out);
    }

    /// Finds the contacts nearer than `reach` (m).
    pub fn find_within(&self, problem: &Problem, mesh: &Mesh, x: &[Vec2], reach: f64, out: &mut Vec<ContactPair>) {
        self.search.find(problem, mesh, x, |_| reach, out);
    }

    /// True if all bars stay out of the barrier's reach on the way between two sets of node
    /// positions (m).
    pub fn out_of_reach(&self, mesh: &Mesh, ways: [&[Vec2]; 2]) -> bool {
        self.search.is_out_of_reach(mesh, ways, self.barrier.reach)
    }

    /// Lists the obstacles that each bar can come near to while its nodes move from `x` by no more
    /// than `most` (m), with room to spare.
    pub fn list_neighbours(&mut self, problem: &Problem, mesh: &Mesh, x: &[Vec2], most: impl Fn(usize) -> f64) {
        if problem.world.is_empty() {
            return;
        }
        let move_of = |e: usize| if most(e) > most(e + 1) { most(e) } else { most(e + 1) };
        let (reach, tuning) = (self.barrier.reach, &self.tuning);
        let needed = |e: usize| reach + move_of(e) + tuning.listed_move_m;
        let within = |e: usize| reach + tuning.listed_steps * move_of(e) + 2.0 * tuning.listed_move_m;
        self.search.list_neighbours(problem, mesh, x, needed, within);
        self.search.note_collapsed_bars(mesh, x, reach);
    }

    /// Sets up friction for a step that began at `start`, with the contacts and normal forces at
    /// `now` (m).
    pub fn prepare(&mut self, problem: &Problem, mesh: &Mesh, now: &[Vec2], start: &[Vec2]) {
        self.prepare_with(self.barrier, problem, mesh, [now, start]);
    }

    /// As [`Self::prepare`], with the normal forces of the step before. With those of a barrier
    /// that has become stiffer since then friction would rise with the rate of the tension, and
    /// feed vibrations: a cable drawn over a floor at 0.05 m/s chattered between 53 and 192 N.
    pub fn prepare_step(&mut self, problem: &Problem, mesh: &Mesh, now: &[Vec2], start: &[Vec2]) {
        self.prepare_with(self.balanced, problem, mesh, [now, start]);
    }

    fn prepare_with(&mut self, barrier: Barrier, problem: &Problem, mesh: &Mesh, [now, start]: [&[Vec2]; 2]) {
        self.self_contacts.prepare(&barrier, mesh, now, start);
        self.find_friction_contacts(barrier, problem, mesh, [now, start]);
    }

    /// Sets up friction of contacts with obstacles only.
    fn find_friction_contacts(&mut self, barrier: Barrier, problem: &Problem, mesh: &Mesh, [now, start]: [&[Vec2]; 2]) {
        let mut touches = std::mem::take(&mut self.scratch);
        self.find(problem, mesh, now, &mut touches);
        self.friction_contacts.clear();
        for touch in &touches {
            let limit = touch.pair.gap.friction * touch.load(&barrier);
            // A contact that is counted twice has pairs of both signs, and so has its friction.
            let same = self
                .friction_contacts
                .iter_mut()
                .rev()
                .take_while(|r| r.touch.node == touch.node)
                .find(|r| r.is_of(touch));
            if let Some(contact) = same {
                contact.limit += limit;
            } else if limit != 0.0 {
                let slid = self.memory.slid(touch);
                let was = touch.interpolate(start);
                let carried = self.motion_of(touch);
                let origin = carried.map_or(was, |c| c.carried(was));
                self.friction_contacts.push(FrictionContact {
                    touch: *touch,
                    tangent: touch.tangent(),
                    limit,
                    slid,
                    origin,
                });
            }
        }
        self.friction_contacts.retain(|r| r.limit != 0.0);
        self.scratch = touches;
    }

    /// Sets the normal forces of friction to those at `now` (m) in a step that began at `start`,
    /// unless they are the same: `same` decides that by the greatest change of a friction limit and
    /// the greatest limit (N). Returns whether they were set.
    pub fn renew_normal_forces(
        &mut self,
        problem: &Problem,
        mesh: &Mesh,
        [now, start]: [&[Vec2]; 2],
        same: impl Fn(f64, f64) -> bool,
    ) -> bool {
        std::mem::swap(&mut self.friction_contacts, &mut self.before);
        self.find_friction_contacts(self.barrier, problem, mesh, [now, start]);
        let limit = |all: &[FrictionContact], touch: &ContactPair| {
            of_node(all, touch.node).find(|r| r.is_of(touch)).map_or(0.0, |r| r.limit)
        };
        let (mut change, mut most) = (0.0, 0.0);
        for contact in self.friction_contacts.iter().chain(&self.before) {
            let (was, is) = (limit(&self.before, &contact.touch), limit(&self.friction_contacts, &contact.touch));
            (change, most) = (larger(change, (is - was).abs()), larger(most, larger(is, was)));
        }
        let renewed = !same(change, most);
        if renewed {
            self.self_contacts.prepare(&self.barrier, mesh, now, start);
        } else {
            // The step is balanced with the earlier limits.
            std::mem::swap(&mut self.friction_contacts, &mut self.before);
        }
        renewed
    }

    /// The contacts that were found last, each with its normal force, N.
    pub fn loaded_contacts(&self) -> impl Iterator<Item = (&ContactPair, f64)> {
        let same = |a: &ContactPair, b: &ContactPair| {
            (a.node, a.on_segment, a.pair.gap.feature) == (b.node, b.on_segment, b.pair.gap.feature)
        };
        self.scratch.iter().enumerate().filter_map(move |(k, touch)| {
            // Parts of the same contact are summed with the first of them.
            let of_node = |t: &&ContactPair| t.node == touch.node;
            let first = !self.scratch[..k].iter().rev().take_while(of_node).any(|t| same(t, touch));
            let all = self.scratch[k..].iter().take_while(of_node).filter(|t| same(t, touch));
            let load: f64 = all.map(|t| t.load(&self.barrier)).sum();
            (first && load > 0.0).then_some((touch, load))
        })
    }

    /// Friction force of a contact along its tangent at `x` (m), N.
    pub fn tangential_force(&self, touch: &ContactPair, x: &[Vec2]) -> f64 {
        let contact = of_node(&self.friction_contacts, touch.node).find(|r| r.is_of(touch));
        contact.map_or(0.0, |r| -friction::at(r.sliding(x), r.limit, self.slip).1)
    }

    /// Accepts the step from `start` to `end` (m): anchors follow sliding contacts; `slide` is the
    /// slide of sliding nodes (m).
    pub fn commit(&mut self, problem: &Problem, mesh: &Mesh, end: &[Vec2], start: &[Vec2], slide: &[f64]) {
        self.prepare(problem, mesh, end, start);
        self.balanced = self.barrier;
        self.self_contacts.commit(end, self.tuning.slip_m, self.barrier.reach);
        self.memory.commit(&mut self.friction_contacts, end, self.slip, self.tuning.remembered_steps);
        if problem.floor_friction.is_some() {
            for (k, (slid, (e, s))) in self.floor_slip.iter_mut().zip(end.iter().zip(start)).enumerate() {
                let by = if mesh.sliding[k].is_some() { Vec2::new(slide[k], 0.0) } else { e - s };
                *slid = friction::return_map_plane(*slid + by, self.slip);
            }
        }
    }

    /// True if there is nothing to touch: no obstacle, and the cable can pass itself.
    pub(in crate::model::fem) fn meets_nothing(&self, problem: &Problem) -> bool {
        problem.world.is_empty() && !self.self_contacts.shape.is_on()
    }

    /// Adapts the barrier's stiffness to the greatest tension (N): see
    /// [`barrier_stiffness::follow_tension`].
    pub(in crate::model::fem) fn adapt_stiffness(&mut self, forces: [f64; 2], bounds: [f64; 2], ahead: f64) {
        barrier_stiffness::follow_tension(&mut self.barrier, &self.tuning, forces, bounds, ahead);
    }

    /// Friction force of a contact on the cable at `x` (m), N.
    #[must_use]
    pub fn friction_force(&self, contact: &FrictionContact, x: &[Vec2]) -> Vec2 {
        -contact.tangent * friction::at(contact.sliding(x), contact.limit, self.slip).1
    }

    /// Force of the cable on an obstacle, N.
    #[must_use]
    pub fn force_on(&self, obstacle: usize, problem: &Problem, mesh: &Mesh, x: &[Vec2]) -> Vec2 {
        let mut sum = Vec2::zeros();
        let mut touches = Vec::new();
        self.find(problem, mesh, x, &mut touches);
        for touch in touches.iter().filter(|t| t.pair.gap.obstacle == obstacle) {
            sum -= touch.pair.gap.normal * touch.load(&self.barrier);
        }
        for contact in self.friction_contacts.iter().filter(|r| r.touch.pair.gap.obstacle == obstacle) {
            sum -= self.friction_force(contact, x);
        }
        sum
    }

    /// Breaks the cable at node `k`, whose copy for the second piece has become node `k` + 1 of the
    /// mesh at positions `x` (m). Friction stays with the first piece.
    pub(in crate::model::fem) fn break_at(&mut self, k: usize, mesh: &Mesh, x: &[Vec2]) {
        self.renumber(|node| Some(if node > k { node + 1 } else { node }));
        if let Some(slip) = self.floor_slip.get(k).copied() {
            self.floor_slip.insert(k + 1, slip);
        }
        self.self_contacts.break_at(k, mesh, x, self.barrier.reach);
        self.search.lists.clear();
    }

    /// Continues among other obstacles: `change` gives the obstacle and the feature of a feature
    /// there, None if it is gone.
    pub(in crate::model::fem) fn change_features(&mut self, change: impl Fn(usize) -> Option<(usize, usize)>) {
        self.friction_contacts.clear();
        self.memory.change_features(change);
    }

    /// Renumbers the friction memory: `change` gives the new number of a node, None if it was
    /// removed.
    pub fn renumber(&mut self, change: impl Fn(usize) -> Option<usize>) {
        self.friction_contacts.clear();
        self.memory.renumber(change);
    }
}

//! The friction state holds the contacts of a mesh at an instant, and the friction of each.

use crate::contact::barrier::Barrier;
use crate::contact::friction;
use crate::contact::neighbour_lists::NeighbourLists;
use crate::contact::pairs::Pair;
use crate::math::{RigidPose, Vec2, bounded, larger};
use crate::model::fem::settings::ContactTuning;
use crate::model::fem::system::mesh::Mesh;
use crate::model::fem::system::self_contact::Own;
use crate::problem::Problem;

/// ε of a cable at rest under a greatest force of `force` (N), m.
#[must_use]
pub fn slip_at_rest(tuning: &ContactTuning, problem: &Problem, force: f64) -> f64 {
    let stretch = force * problem.length / problem.axial_stiffness;
    // A force that is no number is none of a state to be kept.
    bounded(tuning.slip_stretch_fraction * stretch, tuning.min_slip_m, tuning.slip_m)
}

/// One contact pair of the mesh: a node, or the inside of a segment (from `node` to `node + 1`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPair {
    /// Node, or first node of the segment.
    pub node: usize,
    /// True if the segment's inside touches (a corner or a circle).
    pub on_segment: bool,
    /// Pair as found.
    pub pair: Pair,
}

impl ContactPair {
    /// Weights of the two nodes that carry it.
    #[inline]
    #[must_use]
    pub fn shares(&self) -> [f64; 2] {
        if self.on_segment { [1.0 - self.pair.gap.fraction, self.pair.gap.fraction] } else { [1.0, 0.0] }
    }

    /// The part of its force that acts on nodes that move with their material, as `moves` tells.
    #[must_use]
    pub fn felt(&self, moves: impl Fn(usize) -> bool) -> f64 {
        let [a, b] = self.shares();
        (if moves(self.node) { a } else { 0.0 }) + (if b != 0.0 && moves(self.node + 1) { b } else { 0.0 })
    }

    /// A field's value at the touching point.
    #[inline]
    #[must_use]
    pub fn interpolate(&self, x: &[Vec2]) -> Vec2 {
        let [a, b] = self.shares();
        if self.on_segment { x[self.node] * a + x[self.node + 1] * b } else { x[self.node] }
    }

    /// Direction in which friction acts: the normal turned clockwise.
    #[inline]
    #[must_use]
    pub fn tangent(&self) -> Vec2 {
        Vec2::new(self.pair.gap.normal.y, -self.pair.gap.normal.x)
    }

    /// Normal force, N.
    #[inline]
    #[must_use]
    pub fn load(&self, barrier: &Barrier) -> f64 {
        -barrier.at(self.pair.gap.gap_m).slope * self.pair.weight
    }
}

/// The motion of the outline in the present step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineMotion {
    /// Its number among the obstacles.
    pub obstacle: usize,
    /// From where.
    pub from: RigidPose,
    /// To where.
    pub to: RigidPose,
}

impl OutlineMotion {
    /// Position now of a point at `p` (m) if it had gone with the outline.
    #[must_use]
    pub fn carried(&self, p: Vec2) -> Vec2 {
        self.from.carried(&self.to, p)
    }

    /// Displacement of the point of the outline that is at `p` (m).
    #[must_use]
    pub fn way(&self, p: Vec2) -> Vec2 {
        p - self.to.carried(&self.from, p)
    }
}

/// The memory of a friction contact after an accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Memory {
    node: usize,
    on_segment: bool,
    feature: usize,
    obstacle: usize,
    slid: f64,
    /// Steps since it carried load.
    age: usize,
}

/// Friction of one contact during a step: the normal force and direction are frozen, the sliding is
/// not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionContact {
    /// The contact.
    pub touch: ContactPair,
    /// Unit vector of positive sliding.
    pub tangent: Vec2,
    /// Largest friction force μN, N.
    pub limit: f64,
    /// Sliding remembered at the start of the step, m.
    pub slid: f64,
    /// Position of the touching material at the start of the step, m.
    pub origin: Vec2,
}

impl FrictionContact {
    /// True if it is the friction of a touch, wherever that is now.
    #[inline]
    fn is_of(&self, touch: &ContactPair) -> bool {
        let key = |t: &ContactPair| (t.node, t.on_segment, t.pair.gap.feature);
        key(&self.touch) == key(touch)
    }

    /// Sliding since the anchor, m.
    #[inline]
    #[must_use]
    pub fn sliding(&self, x: &[Vec2]) -> f64 {
        self.slid + self.tangent.dot(&(self.touch.interpolate(x) - self.origin))
    }
}

/// The friction contacts of a node, out of a list in order of nodes.
fn of_node(rubs: &[FrictionContact], node: usize) -> impl Iterator<Item = &FrictionContact> {
    let low = rubs.partition_point(|r| r.touch.node < node);
    rubs[low..].iter().take_while(move |r| r.touch.node == node)
}

/// All contacts of a mesh with their history.
#[derive(Clone, Debug)]
pub struct ContactSet {
    /// The tuned constants of contact.
    pub tuning: ContactTuning,
    /// The barrier.
    pub barrier: Barrier,
    /// Sliding at which friction is fully mobilised (ε), m.
    pub slip: f64,
    /// Friction of the present step.
    pub friction_contacts: Vec<FrictionContact>,
    /// The friction before its normal forces were taken anew.
    before: Vec<FrictionContact>,
    /// By node; of one node the newest first.
    memory: Vec<Memory>,
    /// Room for the next memory.
    spare: Vec<Memory>,
    scratch: Vec<ContactPair>,
    /// The obstacles to which each bar can come near in this step.
    pub near: NeighbourLists,
    /// Plan view: sliding of each node remembered, m.
    pub floor_slid: Vec<Vec2>,
    /// Contacts of the cable with itself.
    pub own: Own,
    /// Motion of the robot's outline in this step.
    pub outline_motion: Option<OutlineMotion>,
}

impl ContactSet {
    /// A set without contacts.
    #[must_use]
    pub fn new(barrier: Barrier, tuning: ContactTuning, nodes: usize) -> Self {
        Self {
            tuning,
            barrier,
            slip: tuning.slip_m,
            friction_contacts: Vec::with_capacity(nodes),
            before: Vec::with_capacity(nodes),
            memory: Vec::with_capacity(2 * nodes),
            spare: Vec::with_capacity(2 * nodes),
            scratch: Vec::with_capacity(nodes),
            near: NeighbourLists::default(),
            floor_slid: vec![Vec2::zeros(); nodes],
            own: Own::default(),
            outline_motion: None,
        }
    }

    /// Copies another set; asks for no memory where there is room.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { barrier, slip, friction_contacts, memory, floor_slid, own, outline_motion, .. } = other;
        (self.barrier, self.slip) = (*barrier, *slip);
        // With room for as many, so that a front of contact that runs on asks for none; and no
        // more, or each copy would double it.
        self.friction_contacts.clear();
        self.friction_contacts.reserve_exact(friction_contacts.capacity());
        self.friction_contacts.extend_from_slice(friction_contacts);
        self.memory.clear();
        self.memory.reserve_exact(memory.capacity());
        self.memory.extend_from_slice(memory);
        self.floor_slid.clone_from(floor_slid);
        self.own.copy_from(own);
        self.outline_motion = *outline_motion;
    }

    /// Sets the sliding at which friction is fully mobilised (m); every contact keeps its force.
    pub fn set_slip(&mut self, slip: f64) {
        let part = slip / self.slip;
        if part == 1.0 {
            return;
        }
        self.memory.iter_mut().for_each(|m| m.slid *= part);
        self.friction_contacts.iter_mut().for_each(|r| r.slid *= part);
        self.floor_slid.iter_mut().for_each(|s| *s *= part);
        self.slip = slip;
    }

    /// Forgets all friction.
    pub fn forget(&mut self) {
        self.memory.clear();
        self.friction_contacts.clear();
        self.floor_slid.fill(Vec2::zeros());
        self.own.forget();
    }

    /// Remembers that a contact has slid by so much, m.
    pub fn remember(&mut self, touch: &ContactPair, slid: f64) {
        let gap = &touch.pair.gap;
        let (node, on_segment) = (touch.node, touch.on_segment);
        self.memory.push(Memory { node, on_segment, feature: gap.feature, obstacle: gap.obstacle, slid, age: 0 });
        self.memory.sort_by_key(|m| m.node);
    }

    /// Finds the contacts of the mesh at `x` (m), in order of arc length. Held nodes push on
    /// nothing.
    pub fn find(&self, problem: &Problem, mesh: &Mesh, x: &[Vec2], out: &mut Vec<ContactPair>) {
        self.find_within(problem, mesh, x, self.barrier.reach, out);
    }

    /// The same for contacts nearer than `reach` (m).
    pub fn find_within(&self, problem: &Problem, mesh: &Mesh, x: &[Vec2], reach: f64, out: &mut Vec<ContactPair>) {
        self.find_within_each(problem, mesh, x, |_| reach, out);
    }

    /// The same where contacts of each bar, and of the node at its start, are nearer than its own
    /// `reach` (m).
    pub fn find_within_each(
        &self,
        problem: &Problem,
        mesh: &Mesh,
        x: &[Vec2],
        reach: impl Fn(usize) -> f64,
        out: &mut Vec<ContactPair>,
    ) {
        out.clear();
        if problem.world.is_empty() {
            return;
        }
        let (geometry, last) = (problem.world.geometry(), x.len().saturating_sub(1));
        let plain = |e: usize| mesh.sliding[e].is_none() && mesh.sliding[e + 1].is_none();
        for node in 0..x.len() {
            let reach = reach(if node < last { node } else { last.saturating_sub(1) });
            if node < last && plain(node) && self.near.is_clear(node, [[x[node], x[node + 1]]], reach) {
                continue;
            }
            let ends = (node < last).then(|| mesh.straight(node, x));
            let listed = match ends {
                Some(ends) => self.near.of(node, [ends], reach),
                None => last.checked_sub(1).and_then(|e| self.near.of(e, [mesh.straight(e, x)], reach)),
            };
            if listed.is_some_and(<[_]>::is_empty) {
                continue;
            }
            if mesh.is_free(node) {
                let before = node.checked_sub(1).map(|e| mesh.straight(e, x)[0]);
                let chain = [before, Some(x[node]), ends.map(|e| e[1])];
                let mut keep = |pair| out.push(ContactPair { node, on_segment: false, pair });
                match listed {
                    Some(parts) => geometry.node_pairs_among(parts.iter().copied(), &chain, reach, &mut keep),
                    None => geometry.node_pairs(chain[0], x[node], chain[2], reach, &mut keep),
                }
            }
            let Some(ends) = ends.filter(|_| mesh.is_free(node) || mesh.is_free(node + 1)) else { continue };
            let rounds = mesh.rounds(node);
            let mut keep = |pair: Pair| {
                if !rounds.contains(&Some(pair.gap.feature)) {
                    out.push(ContactPair { node, on_segment: true, pair });
                }
            };
            match listed {
                Some(parts) => geometry.segment_pairs_among(parts.iter().copied(), ends, reach, &mut keep),
                None => geometry.segment_pairs(ends[0], ends[1], reach, &mut keep),
            }
        }
    }

    /// True if all bars stay out of reach of everything on the way between places of the nodes (m).
    pub fn out_of_reach(&self, mesh: &Mesh, [from, to]: [&[Vec2]; 2]) -> bool {
        (0..mesh.rest_length.len()).all(|e| {
            let ways = [mesh.straight(e, from), mesh.straight(e, to)];
            self.near.listed(e, ways, self.barrier.reach).is_some_and(<[_]>::is_empty)
        })
    }

    /// Lists the obstacles that each bar can come near to while its nodes move from `x` by no more
    /// than `most` (m), with room to spare, unless the present lists suffice, and measures its gap.
    pub fn list_neighbours(&mut self, problem: &Problem, mesh: &Mesh, x: &[Vec2], most: impl Fn(usize) -> f64) {
        if problem.world.is_empty() {
            return;
        }
        let move_of = |e: usize| if most(e) > most(e + 1) { most(e) } else { most(e + 1) };
        let bars = mesh.rest_length.len();
        let good = |e: usize| {
            let need = self.barrier.reach + move_of(e) + self.tuning.listed_move_m;
            self.near.listed(e, [mesh.straight(e, x)], need).is_some()
        };
        if self.near.len() == bars && (0..bars).all(good) {
            for e in 0..bars {
                self.near.measure(problem.world.geometry(), e, mesh.straight(e, x));
            }
            return;
        }
        self.near.clear();
        self.near.reserve(bars);
        for e in 0..bars {
            let within = self.barrier.reach + self.tuning.listed_steps * move_of(e) + 2.0 * self.tuning.listed_move_m;
            self.near.push(problem.world.geometry(), mesh.straight(e, x), within);
        }
    }

    /// Sets up friction for a step that began at `start`, with the contacts and normal forces at
    /// `now` (m).
    pub fn prepare(&mut self, problem: &Problem, mesh: &Mesh, now: &[Vec2], start: &[Vec2]) {
        self.own.prepare(&self.barrier, mesh, now, start);
        self.find_friction_contacts(problem, mesh, now, start);
    }

    /// The same for contacts with obstacles alone.
    fn find_friction_contacts(&mut self, problem: &Problem, mesh: &Mesh, now: &[Vec2], start: &[Vec2]) {
        let mut touches = std::mem::take(&mut self.scratch);
        self.find(problem, mesh, now, &mut touches);
        self.friction_contacts.clear();
        for touch in &touches {
            let limit = touch.pair.gap.friction * touch.load(&self.barrier);
            // A contact that counts twice has pairs of both signs, and so has its friction.
            let same = self
                .friction_contacts
                .iter_mut()
                .rev()
                .take_while(|r| r.touch.node == touch.node)
                .find(|r| r.is_of(touch));
            if let Some(rub) = same {
                rub.limit += limit;
            } else if limit != 0.0 {
                let slid = self.remembered(touch);
                let was = touch.interpolate(start);
                let carried = self.outline_motion.filter(|c| c.obstacle == touch.pair.gap.obstacle);
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
        self.find_friction_contacts(problem, mesh, now, start);
        let limit = |all: &[FrictionContact], touch: &ContactPair| {
            of_node(all, touch.node).find(|r| r.is_of(touch)).map_or(0.0, |r| r.limit)
        };
        let (mut change, mut most) = (0.0, 0.0);
        for rub in self.friction_contacts.iter().chain(&self.before) {
            let (was, is) = (limit(&self.before, &rub.touch), limit(&self.friction_contacts, &rub.touch));
            (change, most) = (larger(change, (is - was).abs()), larger(most, larger(is, was)));
        }
        let renewed = !same(change, most);
        if renewed {
            self.own.prepare(&self.barrier, mesh, now, start);
        } else {
            // The step is in balance with the limits before.
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
            // Parts of the same contact are taken together, with the first of them.
            let of_node = |t: &&ContactPair| t.node == touch.node;
            let first = !self.scratch[..k].iter().rev().take_while(of_node).any(|t| same(t, touch));
            let all = self.scratch[k..].iter().take_while(of_node).filter(|t| same(t, touch));
            let load: f64 = all.map(|t| t.load(&self.barrier)).sum();
            (first && load > 0.0).then_some((touch, load))
        })
    }

    /// Friction force of a contact along its tangent at `x` (m), N.
    pub fn tangential_force(&self, touch: &ContactPair, x: &[Vec2]) -> f64 {
        let rub = of_node(&self.friction_contacts, touch.node).find(|r| r.is_of(touch));
        rub.map_or(0.0, |r| -friction::at(r.sliding(x), r.limit, self.slip).1)
    }

    /// Sets the friction limit of every contact to a `part` of the way from that `before` to the
    /// present one (0 where there is no contact); returns the greatest difference of the two, N.
    pub fn blend_friction(&mut self, before: &[FrictionContact], part: f64) -> f64 {
        let gone =
            |now: &[FrictionContact], b: &FrictionContact| !of_node(now, b.touch.node).any(|n| n.is_of(&b.touch));
        let gone: Vec<FrictionContact> = before.iter().filter(|b| gone(&self.friction_contacts, b)).copied().collect();
        self.friction_contacts.extend(gone.iter().map(|b| FrictionContact { limit: 0.0, ..*b }));
        self.friction_contacts.sort_by_key(|r| r.touch.node);
        let mut off = 0.0;
        for rub in &mut self.friction_contacts {
            let was = of_node(before, rub.touch.node).find(|b| b.is_of(&rub.touch)).map_or(0.0, |b| b.limit);
            off = larger(off, (rub.limit - was).abs());
            rub.limit = if part < 1.0 { was + part * (rub.limit - was) } else { rub.limit };
        }
        self.friction_contacts.retain(|r| r.limit != 0.0);
        off
    }

    /// The sliding a contact starts with: its own, else that of the same material on the same
    /// obstacle (it crossed a corner), else that of a neighbour at the same feature (the material
    /// moved past it), else none.
    fn remembered(&self, touch: &ContactPair) -> f64 {
        let low = self.memory.partition_point(|m| m.node + 2 < touch.node);
        let near = self.memory[low..].iter().take_while(|m| m.node <= touch.node + 2);
        let gap = &touch.pair.gap;
        let mut best = (0, 0.0);
        for m in near {
            let same_kind = m.on_segment == touch.on_segment;
            let rank = match (m.feature == gap.feature, m.node == touch.node && same_kind) {
                (true, true) => 3,
                (false, true) if m.obstacle == gap.obstacle => 2,
                (true, false) if same_kind => 1,
                _ => 0,
            };
            if rank > best.0 {
                best = (rank, m.slid);
            }
        }
        best.1
    }

    /// Accepts the step from `start` to `end` (m): anchors follow what slid; `slide` is that of
    /// sliding nodes (m).
    pub fn commit(&mut self, problem: &Problem, mesh: &Mesh, end: &[Vec2], start: &[Vec2], slide: &[f64]) {
        self.prepare(problem, mesh, end, start);
        self.own.commit(end, self.tuning.slip_m);
        // A contact that trembles loses its load now and then: forgetting it each time would let it
        // creep by ε a step.
        let mut old = std::mem::take(&mut self.memory);
        let mut all = std::mem::take(&mut self.spare);
        all.clear();
        for rub in &self.friction_contacts {
            let gap = &rub.touch.pair.gap;
            all.push(Memory {
                node: rub.touch.node,
                on_segment: rub.touch.on_segment,
                feature: gap.feature,
                obstacle: gap.obstacle,
                slid: friction::return_map(rub.sliding(end), self.slip),
                age: 0,
            });
        }
        let now = all.len();
        for m in old.iter().filter(|m| m.age < self.tuning.remembered_steps) {
            let same = |n: &Memory| (n.node, n.on_segment, n.feature) == (m.node, m.on_segment, m.feature);
            let low = all[..now].partition_point(|n| n.node < m.node);
            if !all[low..now].iter().take_while(|n| n.node == m.node).any(same) {
                all.push(Memory { age: m.age + 1, ..*m });
            }
        }
        old.clear();
        let (known, lost) = all.split_at(now);
        merge(known, lost, &mut old);
        (self.memory, self.spare) = (old, all);
        if problem.floor_friction.is_some() {
            for (k, (slid, (e, s))) in self.floor_slid.iter_mut().zip(end.iter().zip(start)).enumerate() {
                let by = if mesh.sliding[k].is_some() { Vec2::new(slide[k], 0.0) } else { e - s };
                *slid = friction::return_map_plane(*slid + by, self.slip);
            }
        }
        // The friction that is left in them is of the state reached: nothing slides further from
        // here.
        for (rub, memory) in self.friction_contacts.iter_mut().zip(&self.spare) {
            rub.slid = memory.slid;
            rub.origin = rub.touch.interpolate(end);
        }
    }

    /// True if there is nothing to touch: no obstacle, and the cable can pass itself.
    pub(in crate::model::fem) fn meets_nothing(&self, problem: &Problem) -> bool {
        problem.world.is_empty() && !self.own.shape.is_on()
    }

    /// The barrier's stiffness follows the greatest tension (N) beside the normal force of an even
    /// bar on flat ground, `bar_weight` (N); `up` and `down` bound by how much; `ahead` is how many
    /// times what follows is reckoned with.
    pub(in crate::model::fem) fn adapt_stiffness(
        &mut self,
        tension: f64,
        bar_weight: f64,
        [up, down]: [f64; 2],
        ahead: f64,
    ) {
        let ContactTuning { stiffness_weights, stiffness_tensions, .. } = self.tuning;
        let least = stiffness_weights * bar_weight;
        let wanted = if stiffness_tensions * tension > least { stiffness_tensions * tension } else { least };
        let now = self.barrier.stiffness;
        self.barrier.stiffness = bounded(wanted * ahead, now * down, now * up);
    }

    /// Friction force of a contact on the cable at `x` (m), N.
    #[must_use]
    pub fn friction_force(&self, rub: &FrictionContact, x: &[Vec2]) -> Vec2 {
        -rub.tangent * friction::at(rub.sliding(x), rub.limit, self.slip).1
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
        for rub in self.friction_contacts.iter().filter(|r| r.touch.pair.gap.obstacle == obstacle) {
            sum -= self.friction_force(rub, x);
        }
        sum
    }

    /// Renumbers what friction remembers: `change` gives the new number of a node, None if it is
    /// gone.
    pub fn renumber(&mut self, change: impl Fn(usize) -> Option<usize>) {
        self.friction_contacts.clear();
        let old = std::mem::take(&mut self.memory);
        self.memory.extend(old.into_iter().filter_map(|m| Some(Memory { node: change(m.node)?, ..m })));
    }
}

/// Merges two lists, each by node, into one: of one node those of the first list come first.
fn merge(first: &[Memory], second: &[Memory], out: &mut Vec<Memory>) {
    let mut rest = second.iter().peekable();
    for m in first {
        while let Some(n) = rest.next_if(|n| n.node < m.node) {
            out.push(*n);
        }
        out.push(*m);
    }
    out.extend(rest);
}

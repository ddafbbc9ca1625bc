//! This module computes the work of each kind of force in a step, from its own force and
//! displacement.
//!
//! A step balances forces at its end, M a (v₁ − v̂) = Σ F₁ (see `bdf2`). Multiplied by the
//! displacements Δx of the nodes and the slides of sliding nodes, that is
//! ```text
//! I − C = Σ F₁·Δx,     I = M a (v₁ − v̂)·Δx,     C = −∂U/∂x(x₁)·Δx
//! ```
//! with U the energy of height, stretch and bending, and the sum over all other forces. The work of
//! a force that changes within the step is its mean force times the displacement. So with K the
//! kinetic energy the integrator gives the cable the energy
//! ```text
//! numerical = ΔK + ΔU − (I − C) + Σ (F₁·Δx − work)
//! ```
//! which is computed without using the balance of energies: the account closes if gains and works
//! agree.

use crate::contact::friction;
use crate::math::Vec2;
use crate::model::fem::mesh::Mesh;
use crate::model::fem::newton::SolverMemory;
use crate::model::fem::state::{CableState, Works, bending_energy, gravity_energy};
use crate::model::fem::system::bar_weight;
use crate::model::fem::system::{
    BarBranch, ContactPair, HandSpring, PlainBar, Unknowns, Weight, bar_energy, bends_slope, visit_turns,
};
use crate::scene::SupportKind;
use crate::solution::Energy;

/// The work of a balanced step before it is accepted.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct StepWork {
    works: Works,
    /// I − C, J; without sliding nodes it excludes the work of the weight.
    balanced: f64,
    /// The energy at the end of the step without kinetic energy; None if there are sliding nodes.
    stored: Option<Energy>,
}

impl StepWork {
    /// The energy at the end of the step without kinetic energy, if it is known.
    pub(in crate::model::fem) fn stored(&self) -> Option<Energy> {
        self.stored
    }

    /// The work of each kind of force in a step from one energy to another.
    pub(in crate::model::fem) fn between(self, before: Energy, after: Energy) -> Works {
        // Without sliding nodes the energy of height is linear in the unknowns.
        let linear = if self.stored.is_some() { after.gravity_j - before.gravity_j } else { 0.0 };
        let gained = after.total_j() - before.total_j() - linear;
        Works { numerical: self.works.numerical + gained - self.balanced, ..self.works }
    }
}

/// Adds the work by the `mean` force in the step to its kind, and the excess of that by the force
/// at the `end` to the numerical work, J.
fn add_work(kind: &mut f64, numerical: &mut f64, [mean, end]: [f64; 2]) {
    *kind += mean;
    *numerical += end - mean;
}

/// A balanced step with the displacements of its nodes.
struct BalancedStep<'a> {
    cable: &'a CableState,
    unknowns: &'a Unknowns,
    /// m.
    ways: &'a [Vec2],
}

/// The work of a step balanced at `unknowns`; `solver` has the displacements of the nodes (m) and
/// the forces on supports at its start (N).
pub(in crate::model::fem) fn work_in_step(cable: &CableState, unknowns: &Unknowns, solver: &SolverMemory) -> StepWork {
    let step = BalancedStep { cable, unknowns, ways: &solver.ways.ways };
    let mut works = Works::default();
    step.add_support_work(&mut works, &solver.ways.reaction);
    step.add_load_work(&mut works);
    if !cable.meshing.was_contact_free {
        step.add_contact_work(&mut works, solver);
    }
    let (mut balanced, mut stored) = (step.inertia_work() - step.add_bend_work(&mut works), None);
    if cable.meshing.never_slides {
        let (work, energy) = step.add_plain_bar_work(&mut works);
        balanced -= work;
        stored = Some(energy);
    } else {
        step.add_sliding_friction_work(&mut works);
        balanced -= step.gravity_work() + step.add_bar_work(&mut works);
    }
    StepWork { works, balanced, stored }
}

impl BalancedStep<'_> {
    fn mesh(&self) -> &Mesh {
        &self.cable.mesh
    }

    /// Work of the inertia forces, J.
    fn inertia_work(&self) -> f64 {
        let (mesh, input, x) = (self.mesh(), &self.cable.input, &self.unknowns.positions);
        let mut sum = 0.0;
        for (k, inertia) in input.inertial.stiffness.iter().enumerate() {
            sum += if mesh.sliding[k].is_some() {
                let slide = self.unknowns.slides[k];
                inertia * (slide - input.inertial.predicted_slide[k]) * slide
            } else {
                (x[k] - input.inertial.predicted[k]).dot(&self.ways[k]) * inertia
            };
        }
        for ((coupling, chord), pairs) in input.inertial.coupling.iter().zip(x.windows(2).zip(self.ways.windows(2))) {
            if let ([a, b], [from, to]) = pairs {
                sum -= (b - a - chord).dot(&(to - from)) * coupling;
            }
        }
        // The springs of hands are included in that inertia.
        for &HandSpring { node: k, stiffness, at } in &input.inertial.hands {
            sum -= (x[k] - at).dot(&self.ways[k]) * stiffness;
        }
        sum
    }

    /// Work of a distributed force (N/m), J.
    fn distributed_work(&self, body: Vec2) -> f64 {
        let (mesh, x, slides) = (self.mesh(), &self.unknowns.positions, &self.unknowns.slides);
        let mut moved = Vec2::zeros();
        let mut sum = 0.0;
        for e in 0..mesh.rest_length.len() {
            let material = mesh.arc_length[e + 1] - mesh.arc_length[e];
            let sliding = [mesh.sliding[e].is_some(), mesh.sliding[e + 1].is_some()];
            if sliding == [false; 2] {
                moved += (self.ways[e] + self.ways[e + 1]) * (0.5 * material);
                continue;
            }
            let on = bar_weight::force_on_ends(mesh, e, x, Some(slides), body);
            sum += on[0].dot(&self.ways[e]) + on[1].dot(&self.ways[e + 1]);
            let center = Weight::of(mesh, e, &mesh.path(e, x), body).center;
            for (j, sign) in [-1.0, 1.0].into_iter().enumerate().filter(|(j, _)| sliding[*j]) {
                sum += sign * body.dot(&(center - x[e + j])) * slides[e + j];
            }
        }
        for (more, way) in mesh.spread.more.iter().zip(self.ways) {
            moved += way * *more;
        }
        sum + body.dot(&moved)
    }

    /// Work of the weight at the end of the step, J.
    fn gravity_work(&self) -> f64 {
        let problem = &self.cable.problem;
        let mut sum = self.distributed_work(problem.weight);
        for (s, node) in problem.supports.iter().zip(&self.cable.meshing.support_node) {
            if let Some(way) = node.and_then(|k| self.ways.get(k)) {
                sum += problem.gravity().dot(way) * s.mass;
            }
        }
        sum
    }

    /// Adds the work of wind, current and loads.
    fn add_load_work(&self, works: &mut Works) {
        let (problem, input) = (&self.cable.problem, &self.cable.input);
        let [from, to] = [self.cable.motion.time, input.loads.time_s];
        let mut both = [[from, to], [to, to]].map(|[from, to]| {
            let wind = (problem.wind.at(from) + problem.wind.at(to)) * 0.5;
            if wind == Vec2::zeros() { 0.0 } else { self.distributed_work(wind) }
        });
        let mut point = |way: Vec2, force: &dyn Fn(f64) -> Vec2| {
            both[0] += (force(from) + force(to)).dot(&way) * 0.5;
            both[1] += force(to).dot(&way);
        };
        // In the order of the loads.
        let mut on_rounds = input.loads.on_rounds.iter();
        for load in &self.cable.meshing.loads {
            let over = if self.mesh().sliding[load.node].is_some() { on_rounds.next() } else { None };
            let slid = over.map_or(Vec2::zeros(), |over| over.way * self.unknowns.slides[load.node]);
            point(self.ways[load.node] + slid, &|t| load.force.at(t));
        }
        for (s, node) in problem.supports.iter().zip(&self.cable.meshing.support_node) {
            if let Some(k) = node.filter(|_| s.kind == SupportKind::Load) {
                point(self.ways[k], &|t| s.force.at(t));
            }
        }
        add_work(&mut works.loads, &mut works.numerical, both);
    }

    /// Adds the work of supports and hands, whose forces on the cable were the opposite of `before`
    /// (N) at the start.
    fn add_support_work(&self, works: &mut Works, before: &[Vec2]) {
        let (mesh, x, cable) = (self.mesh(), &self.unknowns.positions, self.cable);
        let mut support = |k: usize, force: Vec2| {
            let known = cable.motion.step_before > 0.0;
            let was = before.get(k).filter(|_| known).map_or(force, |f| -*f);
            let both = [(force + was) * 0.5, force].map(|f| f.dot(&self.ways[k]));
            add_work(&mut works.supports, &mut works.numerical, both);
        };
        for k in (0..mesh.nodes()).filter(|&k| mesh.fixity[k]) {
            support(k, -cable.answers.reaction[k]);
        }
        for &HandSpring { node: k, stiffness, at } in &cable.input.inertial.hands {
            support(k, (at - x[k]) * stiffness);
        }
    }

    /// Work of the loss of a bar whose length changes from one to another (m) in the step, J. What
    /// the bar pulls with beside its stretch goes evenly from its value at the start to that at the
    /// end while the bar is taut. Where it is slack nothing but its folds pulls: its material then
    /// recovers by itself from the strain at which its tension ended, and the energy of that strain
    /// is lost.
    fn loss_work(&self, e: usize, bar: &PlainBar, [from, to]: [f64; 2]) -> f64 {
        let mesh = self.mesh();
        let (l, ea, remembered) = (mesh.rest_length[e], mesh.axial_stiffness, mesh.branch_forces.sum(e));
        let pull = |p: f64| bar_energy::stiffness(mesh, !(p < l)) / l * (p - l);
        let stored = |p: f64| 0.5 * pull(p) * (p - l);
        let at_end = bar.pull(bar.branch(to), to).0 - pull(to);
        let folds = at_end + pull(to);
        let was_taut = !mesh.is_flexible() || !(from < l * (1.0 - remembered / ea));
        let turns_at = bar.taut_from();
        match (was_taut, bar.branch(to)) {
            (true, BarBranch::Taut) if remembered == 0.0 => -at_end * (to - from),
            (true, BarBranch::Taut) => -0.5 * (remembered + at_end) * (to - from),
            (false, BarBranch::Slack) => stored(to) - stored(from) - folds * (to - from),
            (true, BarBranch::Slack) => {
                stored(to)
                    - stored(turns_at)
                    - 0.5 * (remembered - pull(turns_at)) * (turns_at - from)
                    - folds * (to - turns_at)
            }
            (false, BarBranch::Taut) => {
                stored(turns_at) - stored(from) - 0.5 * (at_end - pull(turns_at)) * (to - turns_at)
            }
        }
    }

    /// Adds the damping work of a bar without sliding nodes. Returns the work of stretch at the end
    /// of the step and the energy that it stores then, J.
    #[inline]
    fn add_one_plain_bar_work(&self, works: &mut Works, e: usize) -> [f64; 2] {
        let (mesh, input, x) = (self.mesh(), &self.cable.input, &self.unknowns.positions);
        let (d, way, l) = (x[e + 1] - x[e], self.ways[e + 1] - self.ways[e], mesh.rest_length[e]);
        if mesh.is_break(e) {
            return [0.0; 2];
        }
        let p = d.norm();
        let taut = !(p < l);
        let pull = bar_energy::stiffness(mesh, taut) / l * (p - l);
        let bar = PlainBar::of(mesh, input, e);
        let loss = bar.pull(bar.branch(p), p).0 - pull;
        let along = if p > 0.0 { d.dot(&way) / p } else { way.x };
        let lengths = [(d - way).norm(), p];
        let mean = self.loss_work(e, &bar, lengths);
        if loss != 0.0 || mean != 0.0 {
            add_work(&mut works.material, &mut works.numerical, [mean, -loss * along]);
        }
        [-pull * along, 0.5 * pull * (p - l)]
    }

    /// Adds the damping work of all bars of a mesh without sliding nodes; returns the work of
    /// stretch at the end of the step (J) and the energy stored then without kinetic energy.
    fn add_plain_bar_work(&self, works: &mut Works) -> (f64, Energy) {
        let (arc_length, x) = (&self.mesh().arc_length, &self.unknowns.positions);
        let (mut moment, mut sum) = (Vec2::zeros(), [0.0; 2]);
        for e in 0..self.mesh().rest_length.len() {
            let [work, stretch_j] = self.add_one_plain_bar_work(works, e);
            sum = [sum[0] + work, sum[1] + stretch_j];
            moment += (x[e] + x[e + 1]) * (0.5 * (arc_length[e + 1] - arc_length[e]));
        }
        let gravity_j = gravity_energy(self.cable, moment, x);
        let bending_j = bending_energy(self.cable, x);
        (sum[0], Energy { kinetic_j: 0.0, gravity_j, stretch_j: sum[1], bending_j })
    }

    /// Adds the damping work of bars; returns the work of stretch at the end of the step, J.
    fn add_bar_work(&self, works: &mut Works) -> f64 {
        let (mesh, input, x) = (self.mesh(), &self.cable.input, &self.unknowns.positions);
        let mut stretched = 0.0;
        for e in 0..mesh.rest_length.len() {
            if mesh.sliding[e].is_none() && mesh.sliding[e + 1].is_none() {
                stretched += self.add_one_plain_bar_work(works, e)[0];
                continue;
            }
            let way = self.ways[e + 1] - self.ways[e];
            let path = mesh.path(e, x);
            let l = bar_energy::rest_length(mesh, e, &self.unknowns.slides);
            let [elastic, loss] = bar_energy::slopes(mesh, input, e, [path.length, l]);
            let (along, more) = (path.direction.dot(&way), l - mesh.rest_length[e]);
            stretched -= elastic[0] * along + elastic[1] * more;
            works.material -= loss[0] * along + loss[1] * more;
            // A moving wheel pulls at both bars.
            for (j, sign) in [1.0, -1.0].into_iter().enumerate().filter(|(j, _)| mesh.sliding[e + j].is_some()) {
                let pull = path.direction * (sign * (elastic[0] + loss[0]));
                let on = bar_weight::force_on_ends(mesh, e, x, Some(&self.unknowns.slides), input.loads.body)[j];
                works.supports -= (pull + on).dot(&self.ways[e + j]);
            }
        }
        for load in &input.loads.on_rounds {
            works.supports -= load.force.dot(&self.ways[load.node]);
        }
        stretched
    }

    /// Adds the damping work of bends; returns the work of bending at the end of the step, J.
    fn add_bend_work(&self, works: &mut Works) -> f64 {
        let (mesh, input, x) = (self.mesh(), &self.cable.input, &self.unknowns.positions);
        if mesh.is_flexible() {
            return 0.0;
        }
        let ([stiffness, viscous], [start, unbent]) = (input.losses.bending, &input.losses.turns);
        if stiffness > 0.0 {
            // The viscous part is even in the step, the branches go from their moments at its start
            // to those at its end.
            let mut mean = 0.0;
            visit_turns(mesh, x, |bend| {
                let [slot, _] = bend.slots;
                let turned = bend.turn - start[slot];
                let end = stiffness * (bend.turn - unbent[slot]) / bend.length;
                let even = viscous * turned / bend.length;
                mean += 0.5 * (end + even + mesh.branch_moments.sum(bend.slots)) * turned;
            });
            let end = bends_slope(mesh, stiffness, Some(unbent), x, self.ways);
            add_work(&mut works.material, &mut works.numerical, [-mean, -end]);
        }
        -bends_slope(mesh, mesh.bending_stiffness, None, x, self.ways)
    }

    /// Adds the work of friction at sliding nodes, on their rounds and on the floor.
    fn add_sliding_friction_work(&self, works: &mut Works) {
        let (mesh, input, x, slides) =
            (self.mesh(), &self.cable.input, &self.unknowns.positions, &self.unknowns.slides);
        for (k, node) in mesh.sliding.iter().enumerate() {
            let Some(node) = node.filter(|_| slides[k] != 0.0) else { continue };
            let pull_before = bar_energy::pull_at_slide(mesh, input, k, 0, x, slides);
            works.friction -= (node.factor - 1.0) * (pull_before - input.inertial.momentum_flux[k]) * slides[k];
            if let Some(limit) = input.loads.floor_limit.get(k) {
                let slid = self.cable.contacts.floor_slip[k].x + slides[k];
                let (_, slope, _) = friction::at(slid, limit * node.floor_factor, self.cable.contacts.slip);
                works.friction -= slope * slides[k];
            }
        }
    }

    /// Displacement of the material under a contact, m, weighted by the shares of its material
    /// nodes, and the sum of these weights.
    fn way_at(&self, touch: &ContactPair) -> (Vec2, f64) {
        let moves = |k: usize| self.mesh().sliding[k].is_none();
        let [a, b] = touch.shares();
        let mut way = if moves(touch.node) { self.ways[touch.node] * a } else { Vec2::zeros() };
        if b != 0.0 && moves(touch.node + 1) {
            way += self.ways[touch.node + 1] * b;
        }
        (way, touch.material_share(moves))
    }

    /// Adds the work of normal forces and friction of obstacles, of the floor and of the cable on
    /// itself.
    fn add_contact_work(&self, works: &mut Works, solver: &SolverMemory) {
        let (cable, x, contacts) = (self.cable, &self.unknowns.positions, &self.cable.contacts);
        let way_of_body = |touch: &ContactPair, share: f64| {
            contacts.motion_of(touch).map_or(Vec2::zeros(), |c| c.way(touch.interpolate(x)) * share)
        };
        for touch in solver.contacts() {
            let force = touch.pair.gap.normal * touch.load(&contacts.barrier);
            let (way, share) = self.way_at(touch);
            let with_body = way_of_body(touch, share);
            works.add_of_body(contacts.motion_of(touch), force.dot(&with_body));
            works.impacts += force.dot(&(way - with_body));
        }
        for contact in &contacts.friction_contacts {
            let force = contacts.friction_force(contact, x);
            let (way, share) = self.way_at(&contact.touch);
            let with_body = way_of_body(&contact.touch, share);
            works.add_of_body(contacts.motion_of(&contact.touch), force.dot(&with_body));
            works.friction += force.dot(&(way - with_body));
        }
        for (k, &limit) in cable.input.loads.floor_limit.iter().enumerate() {
            if self.mesh().sliding[k].is_none() {
                let slid = contacts.floor_slip[k] + (x[k] - cable.input.supports.start[k]);
                works.friction -= friction::at_plane(slid, limit, contacts.slip).1.dot(&self.ways[k]);
            }
        }
        let own = &contacts.self_contacts;
        if own.shape.is_on() {
            for pair in solver.own_contacts() {
                let force = -contacts.barrier.at(pair.gap_m).slope * pair.weight;
                works.impacts += force * pair.normal.dot(&pair.difference(self.ways));
            }
            for contact in &own.friction_contacts {
                let (_, slope, _) = friction::at(contact.sliding(x), contact.limit, contacts.tuning.slip_m);
                works.friction -= slope * contact.pair.tangent().dot(&contact.pair.difference(self.ways));
            }
        }
    }
}

//! The momentum account says what each kind of force gave the cable in a step of its caller.
//!
//! With p the momentum and F a force at the end of a step, its history gives (see `bdf2`)
//! ```text
//! Δp = F/a + (past − older) Δp₋ − older Δp₌
//! ```
//! so that the impulse of each kind of force is filtered as their sum is. What a round does to the
//! cable that runs over it is what bends its way: the pull of the bars beside it, and the change of
//! the momentum of what lies on it and of what goes over it.

use crate::contact::friction;
use crate::math::Vec2;
use crate::model::fem::mesh::sliding_node::SlideOver;
use crate::model::fem::state::account::{Account, Kinds};
use crate::model::fem::state::cable::CableState;
use crate::model::fem::system::bar_energy;
use crate::model::fem::system::bar_weight;
use crate::model::fem::system::friction_state::ContactPair;
use crate::model::fem::system::step_input::Unknowns;
use crate::model::fem::time::bdf2::Weights;
use crate::scene::SupportKind;
use crate::solution::MomentumAccount;

const WEIGHT: usize = 0;
const LOADS: usize = 1;
const SUPPORTS: usize = 2;
const CONTACTS: usize = 3;

fn kind_of(slide_over: SlideOver) -> usize {
    match slide_over {
        SlideOver::Pulley(_) => SUPPORTS,
        SlideOver::Obstacle { .. } => CONTACTS,
    }
}

impl CableState {
    /// A step of the caller begins.
    pub(in crate::model::fem) fn begin_account(&mut self) {
        let now = self.motion.time;
        let known = self.motion.account.to == now;
        let present = if known { Vec2::zeros() } else { self.momentum() };
        let account = &mut self.motion.account;
        if !known {
            *account = Account { reached: present, ..Account::default() };
        }
        (account.from, account.to, account.before) = (now, now, account.reached);
        (account.sum, account.late) = (account.late, [Vec2::zeros(); 4]);
    }

    /// The cable was put elsewhere: what was counted is not of it.
    pub(in crate::model::fem) fn forget_account(&mut self) {
        self.motion.account = Account { from: f64::NAN, to: f64::NAN, ..Account::default() };
    }

    /// Of the caller's last step, where there is one with inertia.
    pub(in crate::model::fem) fn momentum_account(&self) -> Option<MomentumAccount> {
        let a = &self.motion.account;
        let over_s = a.to - a.from;
        let [weight, loads, supports, contacts] = [0, 1, 2, 3].map(|k| <[f64; 2]>::from(a.sum[k] - a.late[k]));
        (over_s > 0.0 && self.inertia_counts()).then(|| MomentumAccount {
            over_s,
            before_kg_m_per_s: a.before.into(),
            after_kg_m_per_s: a.reached.into(),
            weight_n_s: weight,
            loads_n_s: loads,
            supports_n_s: supports,
            contacts_n_s: contacts,
        })
    }

    /// Mass that moves with a node, kg.
    pub(in crate::model::fem) fn node_mass(&self, node: usize) -> f64 {
        self.mesh.mass_with(&self.problem, &self.meshing.support_node, node)
    }

    /// Momentum of cable and lumps, kg m/s.
    pub(in crate::model::fem) fn momentum(&self) -> Vec2 {
        let [pulleys, rounds] = self.sliding_momentum();
        self.moved_by(&self.motion.v) + pulleys + rounds
    }

    /// The same of the nodes that move with their material, at velocities `v` (m/s).
    pub(in crate::model::fem) fn moved_by(&self, v: &[Vec2]) -> Vec2 {
        let mesh = &self.mesh;
        let mut sum = Vec2::zeros();
        for (k, v) in v.iter().enumerate() {
            if mesh.sliding[k].is_none() {
                sum += v * mesh.share(k);
            }
        }
        sum *= self.problem.linear_density;
        for (s, node) in self.problem.supports.iter().zip(&self.meshing.support_node) {
            if let Some(v) = node.and_then(|k| v.get(k)).filter(|_| s.mass > 0.0) {
                sum += v * s.mass;
            }
        }
        sum
    }

    /// The same of the material at sliding nodes: that on pulleys, and that on rounds of obstacles.
    pub(in crate::model::fem) fn sliding_momentum(&self) -> [Vec2; 2] {
        [SUPPORTS, CONTACTS].map(|kind| self.slid_by(&self.motion.w, |slide_over| kind_of(slide_over) == kind))
    }

    /// The same of all of it, at rates `w` (m/s) of the arc length.
    pub(in crate::model::fem) fn sliding_momentum_at(&self, w: &[f64]) -> Vec2 {
        self.slid_by(w, |_| true)
    }

    /// Half of it runs each way.
    fn slid_by(&self, w: &[f64], counts: impl Fn(SlideOver) -> bool) -> Vec2 {
        let mut sum = Vec2::zeros();
        if self.meshing.never_slides {
            return sum;
        }
        let (mesh, x) = (&self.mesh, &self.motion.x);
        for k in 1..mesh.nodes().saturating_sub(1) {
            if !mesh.sliding[k].is_some_and(|node| counts(node.slide_over)) {
                continue;
            }
            let s = &mesh.arc_length;
            let ways =
                mesh.path(k - 1, x).direction * (s[k] - s[k - 1]) + mesh.path(k, x).direction * (s[k + 1] - s[k]);
            sum -= ways * (0.5 * self.problem.linear_density * w[k]);
        }
        sum
    }

    /// Adds the impulses of a step of these weights in which forces (N) were balanced: the step is
    /// made, contacts are not yet made plastic. `slid` is the momentum of what lay on rounds before
    /// (kg m/s), `slide` how far it slid (m).
    pub(in crate::model::fem) fn account_for_step(
        &mut self,
        weights: Weights,
        forces: Kinds,
        slid: [Vec2; 2],
        slide: &[f64],
    ) {
        let now = self.sliding_momentum();
        let mut over = [now[0] - slid[0], now[1] - slid[1]];
        let mut history = [Vec2::zeros(); 2];
        if !self.meshing.never_slides {
            let (mesh, m) = (&self.mesh, &self.motion);
            for (k, node) in mesh.sliding.iter().enumerate() {
                let Some(node) = node else { continue };
                // Material that goes over moves as the material there, and has its history.
                let of = |v: &[Vec2]| {
                    let at = |j: usize| if mesh.sliding[j].is_none() { v[j] } else { Vec2::zeros() };
                    (at(k - 1) - at(k + 1)) * (0.5 * self.problem.linear_density * slide[k])
                };
                let kind = kind_of(node.slide_over) - SUPPORTS;
                over[kind] += of(&m.v);
                history[kind] += of(&m.v) - of(&m.v_before);
            }
        }
        let account = &mut self.motion.account;
        for (k, force) in forces.into_iter().enumerate() {
            let Weights { past, older, a, .. } = weights;
            let given = force / a + account.last[k] * (past - older) - account.older[k] * older;
            account.older[k] = account.last[k];
            account.last[k] = given;
            account.add(k, given);
        }
        for (k, kind) in [SUPPORTS, CONTACTS].into_iter().enumerate() {
            account.add(kind, over[k]);
            account.last[kind] += history[k];
        }
        account.late = [Vec2::zeros(); 4];
    }

    /// A plastic contact of the step of velocities gave the cable so much, and of what the step's
    /// contact forces gave it so much is not of its history, N s.
    pub(in crate::model::fem) fn account_for_landing(&mut self, given: Vec2, forgotten: Vec2) {
        let account = &mut self.motion.account;
        account.add(CONTACTS, given);
        account.last[CONTACTS] -= forgotten;
    }

    /// Material that comes to lie on a round or leaves it takes a part of the history with it, N s.
    pub(in crate::model::fem) fn account_for_history(&mut self, slide_over: SlideOver, impulse: Vec2) {
        self.motion.account.last[kind_of(slide_over)] += impulse;
    }

    /// The account goes up to the present instant, on the mesh that was balanced.
    pub(in crate::model::fem) fn close_account(&mut self) {
        let reached = self.momentum();
        let account = &mut self.motion.account;
        (account.reached, account.to) = (reached, self.motion.time);
    }

    /// A change of the mesh that makes a node sliding or takes that back: what that does to
    /// the momentum it does.
    pub(in crate::model::fem) fn as_of<R>(&mut self, slide_over: SlideOver, change: impl FnOnce(&mut Self) -> R) -> R {
        let history = |d: &Self| d.moved_by(&d.motion.v) - d.moved_by(&d.motion.v_before);
        let (before, known) = (self.momentum(), history(self));
        let done = change(self);
        let (given, changed) = (self.momentum() - before, history(self) - known);
        let (account, kind) = (&mut self.motion.account, kind_of(slide_over));
        account.add(kind, given);
        account.late[kind] += given;
        account.last[kind] += changed;
        done
    }

    /// The forces that a step balanced at unknowns, N: on what moves with its material, and the
    /// weight of what does not less what carries that. `touches` are the contacts of the solver.
    pub(in crate::model::fem) fn forces_in_step(&self, unknowns: &Unknowns, touches: &[ContactPair]) -> Kinds {
        let (problem, mesh, input, x) = (&self.problem, &self.mesh, &self.input, &unknowns.x);
        let gravity =
            if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
        let mut sum = [Vec2::zeros(); 4];
        sum[WEIGHT] = problem.weight * problem.length;
        sum[LOADS] = (input.body - problem.weight) * problem.length;
        let to = input.to;
        for (s, _) in problem.supports.iter().zip(&self.meshing.support_node).filter(|(_, node)| node.is_some()) {
            sum[WEIGHT] += gravity * s.mass;
            if s.kind == SupportKind::Load {
                sum[LOADS] += s.force.at(to);
            }
        }
        for (_, force) in &self.meshing.loads {
            sum[LOADS] += force.at(to);
        }
        for (k, _) in mesh.held.iter().enumerate().filter(|(_, held)| **held) {
            sum[SUPPORTS] -= self.answers.reaction[k];
        }
        for &(k, stiffness, at) in &input.hands {
            sum[SUPPORTS] += (at - x[k]) * stiffness;
        }
        if self.meshing.freely {
            return sum;
        }
        let moves = |k: usize| mesh.sliding[k].is_none();
        for touch in touches {
            sum[CONTACTS] += touch.pair.gap.normal * (touch.load(&self.contacts.barrier) * touch.felt(moves));
        }
        for rub in &self.contacts.friction_contacts {
            let (_, slope, _) = friction::at(rub.sliding(x), rub.limit, self.contacts.slip);
            sum[CONTACTS] -= rub.tangent * (slope * rub.touch.felt(moves));
        }
        for (k, &limit) in input.floor_limit.iter().enumerate().filter(|(k, _)| moves(*k)) {
            let slid = self.contacts.floor_slid[k] + (x[k] - input.start[k]);
            sum[CONTACTS] -= friction::at_plane(slid, limit, self.contacts.slip).1;
        }
        for k in 1..mesh.nodes().saturating_sub(1) {
            let Some(node) = &mesh.sliding[k] else { continue };
            let round = &mut sum[kind_of(node.slide_over)];
            let l = |e: usize| bar_energy::rest_length(mesh, e, &unknowns.slide);
            if moves(k - 1) {
                *round += mesh.path(k - 1, x).direction * bar_energy::pull_on(mesh, input, k - 1, x, l(k - 1));
            }
            if moves(k + 1) {
                *round -= mesh.path(k, x).direction * bar_energy::pull_on(mesh, input, k, x, l(k));
            }
            for (e, side) in [(k - 1, 1), (k, 0)] {
                *round -= bar_weight::on_ends(mesh, e, x, Some(&unknowns.slide), input.body)[side];
            }
        }
        sum
    }
}

//! Implicit dynamics (BDF2) and quasi-statics of a cable in contact.
//!
//! BDF2 with a step ratio ω = h/h₋ (Hairer, Wanner, "Solving ordinary differential equations II", 1996): with
//! α₀ = (1 + 2ω)/(1 + ω) and the history x̂ = ((1 + ω) x₀ − ω²/(1 + ω) x₋)/α₀,
//! ```text
//! v = a (x − x̂),  a = α₀/h,   v̂ likewise,   m a² (x − x̃) + ∂E/∂x − f = 0,   x̃ = x̂ + v̂/a
//! ```
//! After each step contacts are made plastic: the barrier is a spring and would throw a landing cable back at
//! 0.4 to 0.8 of its speed, so the velocity along the normal is taken out of everything that touches.

use std::sync::Arc;

use super::assembly::Mesh;
use super::contact_set::ContactSet;
use super::contact_start::{lay, push_out, way};
use super::contact_step::{Done, Failure, Task, Workspace};
use crate::contact::barrier::Barrier;
use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::drive::Follower;
use crate::model::{Inertia, Model, Settings, StepReport};
use crate::problem::{Problem, Series};
use crate::scene::SupportKind;
use crate::solution::{CableSolution, Cost, Warning, WarningKind};
use crate::state::State;

/// Inner time step, s. METHODS' comparison at 1/240: tip of a falling chain within 5e-4 of its length.
const INNER_STEP: f64 = 1.0 / 240.0;

/// Gap at which contact begins (d̂), m. 1e-4 halves many dynamic steps; larger lifts the cable visibly.
pub const REACH: f64 = 1e-3;

/// Barrier stiffness in units of the weight of one element: 20 times smaller rebounds and costs 30 % more.
const STIFFNESS: f64 = 20.0;

/// Unbalanced force accepted, part of the whole load.
const TOLERANCE: f64 = 1e-6;

/// Time constant of material damping, s, where the cable's own damping ratio does not ask for more. Without it a
/// soft cable (EA 1e5 N) shows 11 % of axial noise in a drag.
const MATERIAL_DAMPING: f64 = 1e-3;

/// A step is halved at most this often.
const MAX_DEPTH: usize = 10;

/// Normal speed (m/s) below which a contact is left alone by the plastic impulse.
const QUIET: f64 = 1e-3;

/// Newton iterations of a dynamic step.
const STEP_ITERATIONS: usize = 60;

/// Newton iterations of a step without inertia.
const REST_ITERATIONS: usize = 150;

/// Rounds of refreshing the normal forces that friction uses, in a step without inertia.
const LAG_ROUNDS: usize = 25;

/// The same in a step of relaxation.
const RELAX_LAG_ROUNDS: usize = 8;

/// Steps of relaxation before it is given up.
const MAX_RELAX: usize = 600;

/// The minimiser's memory; a copy of the model makes its own.
#[derive(Debug, Default)]
struct Memory(Option<Box<Workspace>>);

impl Clone for Memory {
    fn clone(&self) -> Self {
        Self(None)
    }
}

/// What a step may change, kept to go back to.
#[derive(Clone, Debug, Default)]
struct Motion {
    x: Vec<Vec2>,
    v: Vec<Vec2>,
    x_before: Vec<Vec2>,
    v_before: Vec<Vec2>,
    /// Last step, s; 0 = no history, the next step is implicit Euler.
    step_before: f64,
    followers: Vec<Option<Follower>>,
    time: f64,
}

/// The moving cable, or the resting one where it can touch something.
#[derive(Clone, Debug)]
pub struct Dynamics {
    pub(super) problem: Arc<Problem>,
    pub(super) mesh: Mesh,
    pub(super) contacts: ContactSet,
    pub(super) task: Task,
    /// Force of the cable on each node that is held, N.
    pub(super) reaction: Vec<Vec2>,
    motion: Motion,
    saved: Motion,
    saved_contacts: Option<ContactSet>,
    mass: Vec<f64>,
    /// Node of each support; None for one that slides.
    pub(super) support_node: Vec<Option<usize>>,
    loads: Vec<(usize, Series)>,
    memory: Memory,
    rested: bool,
    held_back: Vec<usize>,
}

impl Dynamics {
    /// Builds it at the route.
    ///
    /// # Errors
    /// None today: what it cannot do is refused when asked for.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        let way = way(&problem);
        let segments = segments(&problem, settings);
        let even = problem.length / segments as f64;
        let mut breaks = vec![0.0, problem.length];
        breaks.extend(problem.supports.iter().filter_map(|s| s.arc_length));
        breaks.extend(problem.loads.iter().map(|l| l.arc_length));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b < 1e-9 * problem.length);
        if !problem.world.is_empty() {
            for (s, _) in &way {
                if breaks.iter().all(|b| (b - s).abs() > 0.3 * even) {
                    breaks.push(*s);
                }
            }
            breaks.sort_by(f64::total_cmp);
        }
        let mesh = Mesh::new(&problem, &breaks, segments);
        let n = mesh.nodes();
        let mut mass: Vec<f64> = (0..n).map(|k| problem.linear_density * mesh.share(k)).collect();
        let support_node: Vec<Option<usize>> =
            problem.supports.iter().map(|s| s.arc_length.and_then(|a| mesh.node_at(a))).collect();
        for (s, node) in problem.supports.iter().zip(&support_node) {
            if let Some(k) = node {
                mass[*k] += s.mass;
            }
        }
        let loads = problem.loads.iter().filter_map(|l| Some((mesh.node_at(l.arc_length)?, l.force.clone()))).collect();
        let (normal_per_m, whole) = load_scale(&problem);
        let barrier = Barrier { reach: REACH, stiffness: STIFFNESS * normal_per_m * even };
        let task = Task { tolerance: tolerance(&problem, whole), ..Task::default() };
        let mut this = Self {
            contacts: ContactSet::new(barrier, n),
            reaction: vec![Vec2::zeros(); n],
            motion: Motion {
                x: lay(&mesh, &way),
                v: vec![Vec2::zeros(); n],
                followers: vec![None; problem.supports.len()],
                ..Motion::default()
            },
            saved: Motion::default(),
            saved_contacts: None,
            memory: Memory(None),
            rested: false,
            held_back: Vec::new(),
            mass,
            support_node,
            loads,
            mesh,
            task,
            problem,
        };
        this.forget_history();
        this.prepare_task(0.0, None);
        for k in 0..n {
            if this.mesh.held[k] {
                this.motion.x[k] = this.task.target[k];
            }
        }
        let mut x = std::mem::take(&mut this.motion.x);
        push_out(&this.problem, &this.mesh, &mut x, 0.9 * REACH);
        this.motion.x = x;
        this.forget_history();
        Ok(this)
    }

    fn forget_history(&mut self) {
        let m = &mut self.motion;
        m.x_before.clone_from(&m.x);
        m.v_before.clone_from(&m.v);
        m.step_before = 0.0;
    }

    fn refuse(&self) -> Result<(), SolveError> {
        let feature = |s: &str| SolveError::Unsupported { model: Model::Fem, feature: s.to_owned() };
        if self.problem.supports.iter().any(|s| s.kind == SupportKind::Pulley) {
            return Err(feature("a pulley together with obstacles, a rubbing floor or inertia"));
        }
        if self.problem.cable.self_contact {
            return Err(feature("contact of the cable with itself"));
        }
        Ok(())
    }

    /// Sets held nodes, their targets and all forces for the time `to` (s); dragged supports go where `dragged` says.
    fn prepare_task(&mut self, to: f64, dragged: Option<&[Option<Vec2>]>) {
        let (problem, mesh, task) = (&self.problem, &mut self.mesh, &mut self.task);
        let n = mesh.nodes();
        let body = problem.body_force(to);
        task.force.clear();
        task.force.extend((0..n).map(|k| body * mesh.share(k)));
        for (node, force) in &self.loads {
            task.force[*node] += force.at(to);
        }
        task.start.clone_from(&self.motion.x);
        task.target.clone_from(&self.motion.x);
        mesh.held.fill(false);
        mesh.clamps.clear();
        for (k, (s, node)) in problem.supports.iter().zip(&self.support_node).enumerate() {
            let Some(node) = *node else { continue };
            if s.kind == SupportKind::Load {
                task.force[node] += s.force.at(to);
            }
            if let Some((at, _)) = s.position_at(to) {
                let hand = dragged.and_then(|d| d.get(k).copied().flatten());
                let at = self.motion.followers[k].map_or(hand.unwrap_or(at), |f| f.position());
                mesh.held[node] = true;
                task.target[node] = clear_way(problem, self.motion.x[node], at);
                if task.target[node] != at && !self.held_back.contains(&k) {
                    self.held_back.push(k);
                }
                if let Some(angle) = s.angle
                    && s.kind == SupportKind::Clamped
                    && mesh.bending_stiffness > 0.0
                {
                    let direction = Vec2::new(angle.cos(), angle.sin());
                    mesh.clamps.push(super::assembly::Clamp { node, direction });
                }
            }
        }
        task.floor_limit.clear();
        if let Some((friction, normal)) = problem.floor_friction {
            task.floor_limit.extend((0..n).map(|k| friction * normal * mesh.share(k)));
        }
        task.max_iterations = STEP_ITERATIONS;
        task.max_move = 2.0 * INNER_STEP * 100.0;
        task.shift = 0.0;
        task.damping = 0.0;
        task.inertia.clear();
        task.inertia.resize(n, 0.0);
        task.predicted.clone_from(&self.motion.x);
        task.predicted_length.clear();
        task.predicted_length.extend_from_slice(&mesh.rest_length);
    }

    fn minimise(&mut self, x: &mut [Vec2]) -> Result<Done, Failure> {
        let mut memory = match self.memory.0.take() {
            Some(m) => m,
            None => Box::new(Workspace::new(&self.mesh).map_err(|_| Failure {
                node: 0,
                residual: f64::NAN,
                cause: "there is no memory for it",
            })?),
        };
        let done = memory.minimise((&self.problem, &self.mesh), &self.contacts, &self.task, x);
        for k in 0..self.mesh.nodes() {
            self.reaction[k] = -memory.gradient_at(k);
        }
        self.memory.0 = Some(memory);
        done
    }

    /// Takes the normal velocity out of what touches; the history of nodes it changes starts anew.
    fn land(&mut self, h: f64) {
        let m = &mut self.motion;
        for rub in &self.contacts.rubs {
            let (touch, n) = (&rub.touch, rub.touch.pair.gap.normal);
            let speed = touch.interpolate(&m.v).dot(&n);
            if speed.abs() < QUIET {
                continue;
            }
            let shares = touch.shares();
            let nodes = [touch.node, touch.node + usize::from(touch.on_segment)];
            let free = [0, 1].map(|j| if self.mesh.held[nodes[j]] { 0.0 } else { shares[j] });
            let sum = free[0] * shares[0] + free[1] * shares[1];
            if sum < 1e-3 {
                continue;
            }
            for j in 0..2 {
                if free[j] > 0.0 {
                    m.v[nodes[j]] -= n * (speed * free[j] / sum);
                    m.v_before[nodes[j]] = m.v[nodes[j]];
                    m.x_before[nodes[j]] = m.x[nodes[j]] - m.v[nodes[j]] * h;
                }
            }
        }
    }

    fn dynamic_step(&mut self, h: f64, dragged: &[Option<Vec2>]) -> Result<Done, Failure> {
        for (k, target) in dragged.iter().enumerate() {
            if let (Some(target), Some(node)) = (target, self.support_node.get(k).copied().flatten()) {
                let mut f = self.motion.followers[k].unwrap_or_else(|| Follower::at_rest(self.motion.x[node]));
                if f.follow(*target, h) && !self.held_back.contains(&k) {
                    self.held_back.push(k);
                }
                self.motion.followers[k] = Some(f);
            }
        }
        self.prepare_task(self.motion.time + h, Some(dragged));
        let omega = if self.motion.step_before > 0.0 { h / self.motion.step_before } else { 0.0 };
        let alpha = (1.0 + 2.0 * omega) / (1.0 + omega);
        let (now, past) = ((1.0 + omega) / alpha, omega * omega / (1.0 + omega) / alpha);
        let a = alpha / h;
        let (m, task) = (&self.motion, &mut self.task);
        for k in 0..m.x.len() {
            let x_hat = m.x[k] * now - m.x_before[k] * past;
            let v_hat = m.v[k] * now - m.v_before[k] * past;
            task.predicted[k] = x_hat + v_hat / a;
            task.inertia[k] = self.mass[k] * a * a;
        }
        task.damping = self.problem.axial_stiffness * damping_time(&self.problem) * a;
        for e in 0..self.mesh.rest_length.len() {
            let length = |x: &[Vec2]| (x[e + 1] - x[e]).norm();
            task.predicted_length[e] = length(&m.x) * now - length(&m.x_before) * past;
        }
        let mut x = m.x.clone();
        self.contacts.prepare(&self.problem, &self.mesh, &x, &m.x);
        let done = self.minimise(&mut x)?;
        self.contacts.commit(&self.problem, &self.mesh, &x, &self.motion.x);
        let m = &mut self.motion;
        for k in 0..x.len() {
            let x_hat = m.x[k] * now - m.x_before[k] * past;
            let v = (x[k] - x_hat) * a;
            m.x_before[k] = m.x[k];
            m.v_before[k] = m.v[k];
            m.x[k] = x[k];
            m.v[k] = v;
        }
        m.step_before = h;
        m.time += h;
        self.land(h);
        Ok(done)
    }

    /// A step without inertia to the time `to`; friction remembers.
    fn rest_step(&mut self, to: f64, dragged: &[Option<Vec2>]) -> Result<Done, Failure> {
        self.prepare_task(to, Some(dragged));
        self.task.max_iterations = REST_ITERATIONS;
        let mut x = self.motion.x.clone();
        let mut total = Done::default();
        for _ in 0..LAG_ROUNDS {
            self.contacts.prepare(&self.problem, &self.mesh, &x, &self.motion.x);
            self.task.shift = self.soft_shift();
            let done = self.minimise(&mut x)?;
            total = Done { iterations: total.iterations + done.iterations, ..done };
            // A round that needed no iteration found the normal forces it had used.
            if done.iterations == 0 || self.contacts.rubs.is_empty() {
                break;
            }
        }
        self.accept_rest(x, to);
        Ok(total)
    }

    fn accept_rest(&mut self, x: Vec<Vec2>, to: f64) {
        self.contacts.commit(&self.problem, &self.mesh, &x, &self.motion.x);
        self.motion.x = x;
        self.motion.v.fill(Vec2::zeros());
        self.motion.time = to;
        self.forget_history();
    }

    /// Weight of an element over a tenth of a metre: enough to keep slack nodes from wandering.
    fn soft_shift(&self) -> f64 {
        self.contacts.barrier.stiffness / STIFFNESS / 0.1
    }

    /// Follows the way down with ever weaker viscous resistance, then finds the resting place itself.
    fn relax(&mut self, to: f64, dragged: &[Option<Vec2>]) -> Result<Done, Failure> {
        let mut resistance = self.soft_shift();
        let (full, floor) = (resistance, 1e-5 * resistance);
        let mut total = 0;
        let mut last = Failure { node: 0, residual: f64::NAN, cause: "it never came to rest" };
        for round in 0..MAX_RELAX {
            self.prepare_task(to, Some(dragged));
            let even = self.problem.length / self.mesh.rest_length.len() as f64;
            self.task.inertia.fill(resistance);
            for k in 0..self.mesh.nodes() {
                self.task.inertia[k] *= self.mesh.share(k) / even;
            }
            let exact = self.task.tolerance;
            self.task.tolerance = 1e2 * exact;
            let mut x = self.motion.x.clone();
            // A first lay carries no normal force yet: without refreshing, it would slide as if on ice.
            let mut done = Ok(Done::default());
            for _ in 0..RELAX_LAG_ROUNDS {
                self.contacts.prepare(&self.problem, &self.mesh, &x, &self.motion.x);
                done = self.minimise(&mut x);
                if self.contacts.rubs.is_empty() || !matches!(done, Ok(Done { iterations: 1.., .. })) {
                    break;
                }
            }
            self.task.tolerance = exact;
            match done {
                Ok(done) => {
                    total += done.iterations;
                    let mut moved: f64 = 0.0;
                    for (a, b) in x.iter().zip(&self.motion.x) {
                        moved = moved.max((a - b).norm());
                    }
                    self.accept_rest(x, self.motion.time);
                    resistance *= if moved < 0.3 { 0.6 } else { 1.0 };
                    if resistance < floor || (moved < 1e-4 && round % 8 == 7) || moved < 1e-7 {
                        match self.rest_step(to, dragged) {
                            Ok(done) => return Ok(Done { iterations: total + done.iterations, ..done }),
                            Err(failure) => {
                                last = failure;
                                resistance = resistance.max(floor) * 30.0;
                            }
                        }
                    }
                }
                Err(failure) => {
                    last = failure;
                    resistance *= 8.0;
                    if resistance > 1e9 * full {
                        return Err(failure);
                    }
                }
            }
        }
        Err(last)
    }

    /// Finds the resting place with contact at the present time; `dragged` are the hand-set support positions, m.
    ///
    /// # Errors
    /// A typed reason when there is none, or none was found.
    pub fn settle(&mut self, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        self.refuse()?;
        self.held_back.clear();
        self.save();
        self.motion.followers.fill(None);
        match self.relax(self.motion.time, dragged) {
            Ok(done) => {
                self.rested = true;
                Ok(self.report(done, 0, 0.0))
            }
            Err(f) => {
                let at_m = self.motion.x.get(f.node).copied().unwrap_or_default();
                self.restore();
                let (residual_n, node) = (f.residual, f.node);
                Err(SolveError::NotConverged { model: Model::Fem, iterations: MAX_RELAX, residual_n, node, at_m })
            }
        }
    }

    /// Advances time.
    ///
    /// # Errors
    /// As `Mechanics::advance`.
    pub fn advance(&mut self, dt_s: f64, inertia: Inertia, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        self.refuse()?;
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return Err(SolveError::TimeStep { dt_s, allowed: "more than 0 s" });
        }
        if !self.rested {
            self.settle(dragged)?;
        }
        self.held_back.clear();
        let end = self.motion.time + dt_s;
        let pieces = match inertia {
            Inertia::Dynamic => (dt_s / INNER_STEP - 1e-9).ceil().max(1.0),
            Inertia::QuasiStatic => self.pieces(end, dragged),
        };
        let h = dt_s / pieces;
        let (mut total, mut halved) = (Done::default(), 0);
        for _ in 0..pieces as usize {
            let done = self.halving(h, inertia, dragged, &mut halved)?;
            total = Done { iterations: total.iterations + done.iterations, ..done };
        }
        self.motion.time = end;
        Ok(self.report(total, halved, h))
    }

    /// Steps without inertia that keep every support's move below half an element.
    fn pieces(&self, end: f64, dragged: &[Option<Vec2>]) -> f64 {
        let even = self.problem.length / self.mesh.rest_length.len() as f64;
        let mut most: f64 = 0.0;
        for (k, (s, node)) in self.problem.supports.iter().zip(&self.support_node).enumerate() {
            if let (Some((at, _)), Some(node)) = (s.position_at(end), node) {
                let at = dragged.get(k).copied().flatten().unwrap_or(at);
                most = most.max((at - self.motion.x[*node]).norm());
            }
        }
        (most / (0.5 * even)).ceil().clamp(1.0, 1e4)
    }

    fn save(&mut self) {
        self.saved.clone_from(&self.motion);
        self.saved_contacts = Some(self.contacts.clone());
    }

    fn restore(&mut self) {
        self.motion.clone_from(&self.saved);
        if let Some(c) = self.saved_contacts.take() {
            self.contacts = c;
        }
    }

    /// One step of `h`; on failure back to its start and two of half the size, again and again.
    fn halving(
        &mut self,
        h: f64,
        inertia: Inertia,
        dragged: &[Option<Vec2>],
        halved: &mut usize,
    ) -> Result<Done, SolveError> {
        let (mut left, mut size, mut depth) = (h, h, 0);
        let mut total = Done::default();
        loop {
            self.save();
            let to = self.motion.time + size;
            let tried = match inertia {
                Inertia::Dynamic => self.dynamic_step(size, dragged),
                Inertia::QuasiStatic => {
                    let start = self.motion.time;
                    self.rest_step(to, dragged).or_else(|_| {
                        self.restore();
                        self.motion.time = start;
                        self.relax(to, dragged)
                    })
                }
            };
            let finite = self.motion.x.iter().chain(&self.motion.v).all(|p| p.iter().all(|c| c.is_finite()));
            match tried {
                Ok(done) if finite => {
                    total = Done { iterations: total.iterations + done.iterations, ..done };
                    left -= size;
                    if left <= 1e-9 * h {
                        return Ok(total);
                    }
                    size = size.min(left);
                }
                other => {
                    let f = other.err().unwrap_or(Failure { node: 0, residual: f64::NAN, cause: "not finite" });
                    self.restore();
                    *halved += 1;
                    depth += 1;
                    size *= 0.5;
                    self.motion.step_before = 0.0;
                    if depth > MAX_DEPTH {
                        return Err(SolveError::StepFailed {
                            model: Model::Fem,
                            time_s: self.motion.time,
                            dt_s: size,
                            node: f.node,
                            residual_n: f.residual,
                            cause: f.cause.to_owned(),
                        });
                    }
                }
            }
        }
    }

    fn report(&self, done: Done, halved_steps: usize, inner_step_s: f64) -> StepReport {
        let cost = Cost { iterations: done.iterations, halved_steps, residual_n: done.residual, inner_step_s };
        let warnings = self
            .held_back
            .iter()
            .filter_map(|&k| {
                let (s, node) = (self.problem.supports.get(k)?, self.support_node.get(k).copied().flatten()?);
                let (most, reached) = (crate::model::drive::MAX_SPEED, self.motion.v[node].norm());
                let message = format!(
                    "support `{}` lags behind where it is sent: an obstacle is in its way, or it would be faster than {most} m/s",
                    s.name
                );
                let (name, arc_length) = (&self.problem.cable.name, self.mesh.arc_length[node]);
                Some(Warning::new(WarningKind::SupportHeld, name, arc_length, [reached, most], message))
            })
            .collect();
        StepReport { cost, warnings }
    }

    /// Takes over a state (from statics: at rest).
    ///
    /// # Errors
    /// When a number is not finite or the state does not fit the cable.
    pub fn adopt(&mut self, state: &State) -> Result<(), SolveError> {
        if let Some(node) = state.first_non_finite() {
            return Err(SolveError::NonFinite { quantity: "position", node, time_s: state.time_s });
        }
        if state.arc_length_m.len() < 2 || state.position_m.len() != state.arc_length_m.len() {
            return Ok(());
        }
        let same = state.arc_length_m == self.mesh.arc_length;
        for (k, &s) in self.mesh.arc_length.iter().enumerate() {
            if let Some(p) = state.position_at(s) {
                self.motion.x[k] = p;
            }
            let near = state.arc_length_m.partition_point(|&a| a < s).min(state.position_m.len() - 1);
            self.motion.v[k] = state.velocity_m_per_s.get(near).copied().unwrap_or_default();
        }
        self.motion.time = state.time_s;
        self.motion.followers.fill(None);
        self.contacts.forget();
        if !same {
            let mut x = std::mem::take(&mut self.motion.x);
            push_out(&self.problem, &self.mesh, &mut x, 0.9 * REACH);
            self.motion.x = x;
        }
        self.forget_history();
        // A state at rest on another mesh is brought to rest on this one before it moves.
        let still = self.motion.v.iter().all(|v| v.norm() == 0.0);
        self.rested = same || !still;
        self.prepare_task(state.time_s, None);
        Ok(())
    }

    /// Time reached, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.motion.time
    }

    /// Where the cable is.
    #[must_use]
    pub fn state(&self) -> State {
        State {
            time_s: self.motion.time,
            arc_length_m: self.mesh.arc_length.clone(),
            position_m: self.motion.x.clone(),
            velocity_m_per_s: self.motion.v.clone(),
        }
    }

    /// The answer at this instant.
    #[must_use]
    pub fn solution(&self) -> CableSolution {
        super::contact_report::solution(self, &self.motion.x, &self.motion.v)
    }

    /// Smallest gap of any free node or segment, m (infinite if nothing is near).
    #[must_use]
    pub fn smallest_gap(&self) -> f64 {
        let mut touches = Vec::new();
        self.contacts.find(&self.problem, &self.mesh, &self.motion.x, &mut touches);
        touches.iter().map(|t| t.pair.gap.gap_m).fold(f64::INFINITY, |a, b| if b < a { b } else { a })
    }
}

/// The target of a held node, stopped where an obstacle is in its way (m).
fn clear_way(problem: &Problem, from: Vec2, to: Vec2) -> Vec2 {
    if problem.world.is_empty() || from == to {
        return to;
    }
    let free = problem.world.free_fraction([from, from], [to, to], 0.2);
    if free >= 1.0 {
        return to;
    }
    // Near the surface already: it stays, so that its gap never shrinks away.
    let near = problem.world.signed_gap(from, 0.2 * REACH).is_some_and(|g| g.gap_m.abs() < 0.2 * REACH);
    if near { from } else { from + (to - from) * free }
}

/// Load per metre that presses on the ground and the whole load, N/m and N; never 0.
fn load_scale(problem: &Problem) -> (f64, f64) {
    let floor = problem.floor_friction.map_or(0.0, |(_, n)| n);
    let whole = problem.force_scale().max(floor * problem.length);
    let per_m = problem.body_force(0.0).norm().max(floor).max(1e-3 * whole / problem.length);
    (per_m, whole)
}

/// Unbalanced force to reach, N: not below the rounding of the axial forces.
fn tolerance(problem: &Problem, whole: f64) -> f64 {
    let rounding = 64.0 * f64::EPSILON * problem.axial_stiffness * 100.0;
    (TOLERANCE * whole).max(rounding)
}

fn damping_time(problem: &Problem) -> f64 {
    let wave = (problem.axial_stiffness / problem.linear_density).sqrt();
    let first_mode = std::f64::consts::PI * wave / problem.length;
    MATERIAL_DAMPING.max(2.0 * problem.cable.damping_ratio / first_mode)
}

/// Elements of a cable where neither the scene nor the settings say: finer where it can touch something.
fn segments(problem: &Problem, settings: Settings) -> usize {
    let element = if problem.world.is_empty() { 0.2 } else { 0.12 };
    let automatic = (problem.length / element).ceil().clamp(60.0, 200.0) as usize;
    settings.segments.or(problem.cable.segments).unwrap_or(automatic).max(2)
}

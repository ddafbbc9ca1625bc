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
use super::contact_step::{Done, Failure, Pose, Task, Workspace};
use super::layout::{Hold, Layout};
use super::path::End;
use super::prepare::{damping_time, load_scale, tolerance};
use super::sliding::{Grip, Seat, Sliding};
use crate::contact::barrier::Barrier;
use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::drive::Follower;
use crate::model::{Inertia, Model, Settings, StepReport};
use crate::problem::{Problem, Series};
use crate::scene::PulleySide;
use crate::solution::{CableSolution, Cost, Warning, WarningKind};
use crate::state::State;

/// Inner time step, s. METHODS' comparison at 1/240: tip of a falling chain within 5e-4 of its length.
pub(super) const INNER_STEP: f64 = 1.0 / 240.0;

/// Gap at which contact begins (d̂), m. Where the cable is taut a corner lifts it by this: 1e-3 adds 2 % to the tension of a
/// soft cable of 12 m over two beams, 1e-4 nothing that shows.
pub const REACH: f64 = 1e-4;

/// The same where the cable moves fast: at 5 m/s, 1e-4 m is passed in a hundredth of a step, and every hundredth step
/// of a cable falling on rubble had to be halved.
const FAST_REACH: f64 = 1e-3;

/// Speed (m/s) that counts as fast. Slower, and a cable dragged at 1 m/s loses 9 % of its friction to the changing reach.
const FAST: f64 = 2.0;

/// Change of the reach from one step to the next. Faster shakes a stiff cable that bends round a corner.
const REACH_CHANGE: f64 = 1.25;

/// Barrier stiffness in units of the weight of one element: 20 times smaller rebounds and costs 30 % more.
pub(super) const STIFFNESS: f64 = 20.0;

/// A step is halved at most this often.
const MAX_DEPTH: usize = 10;

/// Normal speed (m/s) below which a contact is left alone by the plastic impulse.
const QUIET: f64 = 1e-3;

/// Roundings in the force of inertia of a node. Fewer: small steps of heavy lumps fail; more: they are coarse.
const ROUNDING: f64 = 16.0;

/// Rounds of finding out which sliding nodes hold and which slip, in a step with inertia.
const GRIP_ROUNDS: usize = 6;

/// The minimiser's memory; a copy of the model makes its own.
#[derive(Debug, Default)]
pub(super) struct Memory(pub(super) Option<Box<Workspace>>);

impl Clone for Memory {
    fn clone(&self) -> Self {
        Self(None)
    }
}

/// What a step may change, kept to go back to.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub(super) x: Vec<Vec2>,
    pub(super) v: Vec<Vec2>,
    pub(super) x_before: Vec<Vec2>,
    pub(super) v_before: Vec<Vec2>,
    /// Arc length at sliding nodes one step ago, m.
    pub(super) s_before: Vec<f64>,
    /// Rate of the arc length at sliding nodes, m/s.
    pub(super) w: Vec<f64>,
    pub(super) w_before: Vec<f64>,
    /// Last step, s; 0 = no history, the next step is implicit Euler.
    pub(super) step_before: f64,
    pub(super) followers: Vec<Option<Follower>>,
    pub(super) time: f64,
}

/// A state to go back to.
#[derive(Clone, Debug)]
struct Saved {
    motion: Motion,
    mesh: Mesh,
    contacts: ContactSet,
    support_node: Vec<Option<usize>>,
    loads: Vec<(usize, Series)>,
    reaction: Vec<Vec2>,
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
    pub(super) motion: Motion,
    saved: Option<Box<Saved>>,
    /// Whether corners and posts get sliding nodes.
    pub(super) slides: bool,
    /// Number of bars of the even mesh.
    pub(super) even_bars: usize,
    /// Node of each support; None for one that slides.
    pub(super) support_node: Vec<Option<usize>>,
    pub(super) loads: Vec<(usize, Series)>,
    pub(super) memory: Memory,
    pub(super) rested: bool,
    pub(super) held_back: Vec<usize>,
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
        let support_node: Vec<Option<usize>> =
            problem.supports.iter().map(|s| s.arc_length.and_then(|a| mesh.node_at(a))).collect();
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
                x_before: vec![Vec2::zeros(); n],
                v_before: vec![Vec2::zeros(); n],
                s_before: mesh.arc_length.clone(),
                w: vec![0.0; n],
                w_before: vec![0.0; n],
                followers: vec![None; problem.supports.len()],
                ..Motion::default()
            },
            saved: None,
            slides: true,
            even_bars: segments,
            memory: Memory(None),
            rested: false,
            held_back: Vec::new(),
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
        this.thread_pulleys(None);
        let mut x = std::mem::take(&mut this.motion.x);
        push_out(&this.problem, &this.mesh, &mut x, 0.9 * REACH);
        this.motion.x = x;
        this.forget_history();
        Ok(this)
    }

    /// Puts a sliding node at every pulley: where `state` has the cable nearest to it, else where the layout lays it.
    fn thread_pulleys(&mut self, state: Option<&State>) {
        let problem = Arc::clone(&self.problem);
        let layout = Layout::new(&problem, self.motion.time, &[], &[]);
        for stop in &layout.stops {
            let (Hold::Pulley(wheel), Some(support)) = (stop.hold, stop.support) else { continue };
            let s = state.and_then(|s| s.on_round(wheel.center, wheel.radius)).unwrap_or(stop.arc_length);
            let k = self.mesh.arc_length.partition_point(|&a| a <= s).clamp(1, self.mesh.nodes() - 1);
            let room = 0.05 * problem.length / self.even_bars as f64;
            let (low, high) = (self.mesh.arc_length[k - 1] + room, self.mesh.arc_length[k] - room);
            let at = if low < high { s.clamp(low, high) } else { 0.5 * (low + high) };
            let passing = self.motion.x[k] - self.motion.x[k - 1];
            let up = if wheel.side == PulleySide::Over { 1.0 } else { -1.0 };
            let right = if passing.x < 0.0 { -1.0 } else { 1.0 };
            let end = End { center: wheel.center, radius: wheel.radius, mark: Vec2::new(0.0, up), sense: -up * right };
            let sliding = Sliding {
                end,
                friction: wheel.friction,
                seat: Seat::Pulley(support),
                grip: Grip::Stick,
                factor: 1.0,
                exponent: 0.0,
            };
            self.insert(k, at, Some(sliding));
        }
        self.even_out();
        self.renew_task();
    }

    /// Sets the task anew after a change of the mesh, for what is read off it between steps.
    pub(super) fn renew_task(&mut self) {
        self.prepare_task(self.motion.time, None);
    }

    /// Where a pulley's centre is, m; None for other supports and pulleys that have let go.
    fn pulley_center(&self, support: usize) -> Option<Vec2> {
        self.mesh.sliding.iter().flatten().find(|s| s.seat == Seat::Pulley(support)).map(|s| s.end.center)
    }

    /// Where a support is, m.
    pub(super) fn support_position(&self, support: usize) -> Option<Vec2> {
        match self.support_node.get(support).copied().flatten() {
            Some(node) => self.motion.x.get(node).copied(),
            None => self.pulley_center(support),
        }
    }

    pub(super) fn forget_history(&mut self) {
        let m = &mut self.motion;
        m.x_before.clone_from(&m.x);
        m.v_before.clone_from(&m.v);
        m.w_before.clone_from(&m.w);
        m.s_before.clone_from(&self.mesh.arc_length);
        m.step_before = 0.0;
    }

    pub(super) fn refuse(&self) -> Result<(), SolveError> {
        let feature = |s: &str| SolveError::Unsupported { model: Model::Fem, feature: s.to_owned() };
        if self.problem.cable.self_contact {
            return Err(feature("contact of the cable with itself"));
        }
        Ok(())
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
            let free = [0, 1].map(|j| if self.mesh.is_free(nodes[j]) { shares[j] } else { 0.0 });
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
            if let (Some(target), Some(at)) = (target, self.support_position(k)) {
                let mut f = self.motion.followers[k].unwrap_or_else(|| Follower::at_rest(at));
                if f.follow(*target, h) && !self.held_back.contains(&k) {
                    self.held_back.push(k);
                }
                self.motion.followers[k] = Some(f);
            }
        }
        self.prepare_step([self.motion.time, self.motion.time + h], Some(dragged));
        self.adapt_reach();
        let omega = if self.motion.step_before > 0.0 { h / self.motion.step_before } else { 0.0 };
        let alpha = (1.0 + 2.0 * omega) / (1.0 + omega);
        let (now, past) = ((1.0 + omega) / alpha, omega * omega / (1.0 + omega) / alpha);
        let a = alpha / h;
        self.set_inertia([now, past, a]);
        let (mut pose, exact) = (self.moving_pose(h), self.task.tolerance);
        self.contacts.prepare(&self.problem, &self.mesh, &pose.x, &self.motion.x);
        self.task.tolerance = self.rounded_tolerance();
        let done = self.grip_and_minimise(&mut pose);
        self.task.tolerance = exact;
        let done = done?;
        self.contacts.commit(&self.problem, &self.mesh, &pose.x, &self.motion.x, &pose.slide);
        let (m, mesh) = (&mut self.motion, &self.mesh);
        for k in 0..pose.x.len() {
            let x_hat = m.x[k] * now - m.x_before[k] * past;
            let v = (pose.x[k] - x_hat) * a;
            let s = mesh.arc_length[k];
            let w = (s + pose.slide[k] - s * now + m.s_before[k] * past) * a;
            m.x_before[k] = m.x[k];
            m.v_before[k] = m.v[k];
            m.s_before[k] = s;
            m.w_before[k] = m.w[k];
            m.x[k] = pose.x[k];
            m.v[k] = v;
            m.w[k] = if mesh.sliding[k].is_some() { w } else { 0.0 };
        }
        self.slide(&pose.slide);
        self.motion.step_before = h;
        self.motion.time += h;
        self.land(h);
        self.remesh();
        Ok(done)
    }

    /// The present pose moved on at its velocities for `h` (s), where nothing can be in the way. Newton then starts nearer
    /// by a factor of the step, and what it leaves is smaller and not always on the same side.
    fn moving_pose(&self, h: f64) -> Pose {
        let mut pose = self.still_pose();
        if self.problem.world.is_empty() {
            for (k, (x, v)) in pose.x.iter_mut().zip(&self.motion.v).enumerate() {
                if self.mesh.is_free(k) {
                    *x += v * h;
                }
            }
        }
        pose
    }

    /// Minimises until no sliding node changes its grip.
    fn grip_and_minimise(&mut self, pose: &mut Pose) -> Result<Done, Failure> {
        let mut done = self.minimise(pose)?;
        for _ in 1..GRIP_ROUNDS {
            if !self.update_grips(pose).0 {
                break;
            }
            let more = self.minimise(pose)?;
            done = Done { iterations: done.iterations + more.iterations, ..more };
        }
        Ok(done)
    }

    /// Unbalanced force to reach in a step with inertia, N: not below the rounding of m a² (x − x̃). That grows as the
    /// step shrinks: 5 kg at 20 m and 1/4000 s know their force to 1e-6 N only.
    fn rounded_tolerance(&self) -> f64 {
        let mut tolerance = self.task.tolerance;
        for (inertia, x) in self.task.inertia.iter().zip(&self.motion.x) {
            let rounding = ROUNDING * f64::EPSILON * inertia * x.norm();
            if rounding > tolerance {
                tolerance = rounding;
            }
        }
        tolerance
    }

    /// The gap at which contact begins follows the speed of the cable.
    fn adapt_reach(&mut self) {
        if self.problem.world.is_empty() {
            return;
        }
        let fastest = self.motion.v.iter().map(Vec2::norm).fold(0.0, |a: f64, b| if b <= a { a } else { b });
        let (wanted, now) = (if fastest > FAST { FAST_REACH } else { REACH }, self.contacts.barrier.reach);
        self.set_reach(wanted.clamp(now / REACH_CHANGE, now * REACH_CHANGE));
    }

    /// Sets the gap at which contact begins, m, and with it how far out rounds of obstacles are.
    pub(super) fn set_reach(&mut self, reach: f64) {
        let change = reach - self.contacts.barrier.reach;
        if change == 0.0 || !change.is_finite() {
            return;
        }
        self.contacts.barrier.reach = reach;
        for (node, (x, start)) in self.mesh.sliding.iter_mut().zip(self.motion.x.iter_mut().zip(&mut self.task.start)) {
            if let Some(node) = node
                && node.feature().is_some()
            {
                node.end.radius += change;
                *x = node.position();
                *start = *x;
            }
        }
    }

    /// Inertia and damping of a step; `now` and `past` weigh the history, `a` turns lengths into speeds (1/s).
    fn set_inertia(&mut self, [now, past, a]: [f64; 3]) {
        let (m, task, mesh) = (&self.motion, &mut self.task, &self.mesh);
        for k in 0..m.x.len() {
            let v_hat = m.v[k] * now - m.v_before[k] * past;
            task.predicted[k] = m.x[k] * now - m.x_before[k] * past + v_hat / a;
            task.inertia[k] = self.problem.linear_density * mesh.share(k) * a * a;
            if mesh.sliding[k].is_some() {
                let w_hat = m.w[k] * now - m.w_before[k] * past;
                let s = mesh.arc_length[k];
                task.predicted_slide[k] = s * now - m.s_before[k] * past + w_hat / a - s;
            }
        }
        for (s, node) in self.problem.supports.iter().zip(&self.support_node) {
            if let Some(k) = node {
                task.inertia[*k] += s.mass * a * a;
            }
        }
        task.damping = self.problem.axial_stiffness * damping_time(&self.problem) * a;
        for e in 0..mesh.rest_length.len() {
            task.predicted_length[e] = if mesh.sliding[e].is_none() && mesh.sliding[e + 1].is_none() {
                let length = |x: &[Vec2]| (x[e + 1] - x[e]).norm();
                length(&m.x) * now - length(&m.x_before) * past
            } else {
                mesh.path(e, &m.x).length
            };
        }
    }

    /// The present pose.
    pub(super) fn still_pose(&self) -> Pose {
        Pose { x: self.task.start.clone(), slide: vec![0.0; self.mesh.nodes()] }
    }

    /// Lets the material slide through the sliding nodes, m of arc length each.
    pub(super) fn slide(&mut self, slide: &[f64]) {
        let mesh = &mut self.mesh;
        for (s, by) in mesh.arc_length.iter_mut().zip(slide) {
            *s += by;
        }
        for e in 0..mesh.rest_length.len() {
            if slide[e] != 0.0 || slide[e + 1] != 0.0 {
                mesh.rest_length[e] = mesh.thermal_stretch * (mesh.arc_length[e + 1] - mesh.arc_length[e]);
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

    pub(super) fn save(&mut self) {
        self.saved = Some(Box::new(Saved {
            motion: self.motion.clone(),
            mesh: self.mesh.clone(),
            contacts: self.contacts.clone(),
            support_node: self.support_node.clone(),
            loads: self.loads.clone(),
            reaction: self.reaction.clone(),
        }));
    }

    pub(super) fn restore(&mut self) {
        if let Some(s) = self.saved.take() {
            self.motion = s.motion;
            self.mesh = s.mesh;
            self.contacts = s.contacts;
            self.support_node = s.support_node;
            self.loads = s.loads;
            self.reaction = s.reaction;
            self.renew_task();
        }
    }

    /// `h` (s), or less where a support lets go on the way.
    fn until_release(&self, h: f64) -> f64 {
        let now = self.motion.time;
        let releases = self.problem.supports.iter().filter_map(|s| s.release_between(now, now + h));
        releases.fold(h, |least, r| if r - now < least { r - now } else { least })
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
            let start = self.motion.time;
            let piece = match inertia {
                Inertia::Dynamic => self.until_release(size),
                Inertia::QuasiStatic => size,
            };
            let to = start + piece;
            let tried = match inertia {
                Inertia::Dynamic => self.dynamic_step(piece, dragged),
                Inertia::QuasiStatic => self.rest_step(to, dragged).or_else(|_| {
                    self.restore();
                    self.save();
                    self.motion.time = start;
                    self.relax(to, dragged)
                }),
            };
            let finite = self.motion.x.iter().chain(&self.motion.v).all(|p| p.iter().all(|c| c.is_finite()));
            match tried {
                Ok(done) if finite => {
                    total = Done { iterations: total.iterations + done.iterations, ..done };
                    left -= piece;
                    // Forces jump where a support lets go: with the history from before, BDF2 would feel them half a step late.
                    if self.problem.supports.iter().any(|s| s.holds_from(start) != s.holds_from(to)) {
                        self.motion.step_before = 0.0;
                    }
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

    pub(super) fn report(&self, done: Done, halved_steps: usize, inner_step_s: f64) -> StepReport {
        let cost = Cost { iterations: done.iterations, halved_steps, residual_n: done.residual, inner_step_s };
        let warnings = self
            .held_back
            .iter()
            .filter_map(|&k| {
                let seat = Seat::Pulley(k);
                let sliding = self.mesh.sliding.iter().position(|s| s.is_some_and(|s| s.seat == seat));
                let node = self.support_node.get(k).copied().flatten().or(sliding)?;
                let s = self.problem.supports.get(k)?;
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
        if !same {
            self.unthread();
        }
        for (k, &s) in self.mesh.arc_length.iter().enumerate() {
            if self.mesh.sliding[k].is_some() {
                continue;
            }
            if let Some(p) = state.position_at(s) {
                self.motion.x[k] = p;
            }
            self.motion.v[k] = state.velocity_at(s).unwrap_or_default();
        }
        self.motion.time = state.time_s;
        self.motion.followers.fill(None);
        self.contacts.forget();
        if !same {
            self.thread_pulleys(Some(state));
            let mut x = std::mem::take(&mut self.motion.x);
            push_out(&self.problem, &self.mesh, &mut x, 0.9 * REACH);
            self.motion.x = x;
        }
        self.forget_history();
        // A state at rest on another mesh is brought to rest on this one before it moves.
        let still = self.motion.v.iter().all(|v| v.norm() == 0.0);
        self.rested = same || !still;
        self.renew_task();
        Ok(())
    }

    /// Takes all sliding nodes out.
    fn unthread(&mut self) {
        let mut k = 1;
        while k + 1 < self.mesh.nodes() {
            if self.mesh.sliding[k].is_some() {
                self.remove(k);
            } else {
                k += 1;
            }
        }
        self.even_out();
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

/// Elements of a cable where neither the scene nor the settings say: finer where it can touch something.
fn segments(problem: &Problem, settings: Settings) -> usize {
    let element = if problem.world.is_empty() { 0.2 } else { 0.12 };
    let automatic = (problem.length / element).ceil().clamp(60.0, 200.0) as usize;
    settings.segments.or(problem.cable.segments).unwrap_or(automatic).max(2)
}

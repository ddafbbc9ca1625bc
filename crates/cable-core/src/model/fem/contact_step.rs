//! One implicit step as a minimisation, by Newton with a banded factor and steps that cross nothing.
//!
//! ```text
//! Φ(x) = ½ Σ mᵢ a² |xᵢ − x̃ᵢ|² + E(x) − Σ fᵢ·xᵢ + Σ w B(g(x)) + Σ D(y(x))
//! ```
//! with a = α₀/h of the integrator and x̃ what its history predicts (a = 0 for a step without inertia). Damping
//! of a bar with time constant τ is a second bar of stiffness EA τ a whose rest length is the one predicted.

use super::assembly::{Mesh, System};
use super::contact_set::{ContactSet, SLIDE, Touch};
use crate::contact::friction;
use crate::energy::Curvature;
use crate::linalg::{BandFactor, FactorError};
use crate::math::{Mat2, Vec2};
use crate::problem::Problem;

/// Part of EA that resists shortening. A flexible cable gives way sideways between the nodes instead of
/// pushing; with none, slack nodes are free to wander, with all of it a slack cable on the ground stays straight and pushes.
pub const PUSH: f64 = 0.01;

/// Part of each gap that a Newton step leaves. Smaller: gaps shrink too fast for Newton; larger: more steps.
const KEEP: f64 = 0.2;

/// Sufficient decrease (Armijo).
const DECREASE: f64 = 1e-4;

/// Line search halvings before the step is given up.
const MAX_HALVINGS: usize = 30;

/// Energies are trusted to this part of the sum of their magnitudes.
const ENERGY_NOISE: f64 = 1e-13;

/// What a step is about.
#[derive(Clone, Debug, Default)]
pub struct Task {
    /// mᵢ a², N/m.
    pub inertia: Vec<f64>,
    /// x̃, m.
    pub predicted: Vec<Vec2>,
    /// EA τ a, N (0: no damping).
    pub damping: f64,
    /// Predicted length of each bar, m.
    pub predicted_length: Vec<f64>,
    /// External force on each node, N.
    pub force: Vec<Vec2>,
    /// Where each held node has to go, m (others: ignored).
    pub target: Vec<Vec2>,
    /// Where the step began, m.
    pub start: Vec<Vec2>,
    /// Plan view: largest friction force of each node, N (empty otherwise).
    pub floor_limit: Vec<f64>,
    /// Unbalanced force to reach, N.
    pub tolerance: f64,
    /// Iterations allowed.
    pub max_iterations: usize,
    /// Largest move of a node in one iteration, m.
    pub max_move: f64,
    /// Regularisation to begin with, N/m.
    pub shift: f64,
}

/// Why a step failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    /// Worst node.
    pub node: usize,
    /// Its unbalanced force, N.
    pub residual: f64,
    /// In words.
    pub cause: &'static str,
}

/// What a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Done {
    /// Newton iterations.
    pub iterations: usize,
    /// Largest unbalanced force left, N.
    pub residual: f64,
    /// Whether a held node could not reach its target.
    pub held_back: bool,
}

/// Memory of the minimisation.
#[derive(Debug)]
pub struct Workspace {
    system: System,
    factor: BandFactor,
    direction: Vec<f64>,
    trial: Vec<Vec2>,
    touches: Vec<Touch>,
    magnitude: f64,
}

impl Workspace {
    /// Room for a mesh.
    ///
    /// # Errors
    /// `TooLarge` when there is no memory for it.
    pub fn new(mesh: &Mesh) -> Result<Self, FactorError> {
        let system = System::new(mesh);
        let factor = BandFactor::new(2 * mesh.nodes(), mesh.half_bandwidth())?;
        Ok(Self {
            direction: vec![0.0; 2 * mesh.nodes()],
            trial: vec![Vec2::zeros(); mesh.nodes()],
            touches: Vec::new(),
            magnitude: 0.0,
            system,
            factor,
        })
    }

    /// Gradient of the last assembly, N: at a held node minus the force of the cable on what holds it.
    #[must_use]
    pub fn gradient_at(&self, node: usize) -> Vec2 {
        self.system.gradient_at(node)
    }

    /// Φ with gradient and Hessian at `x`.
    pub fn assemble(
        &mut self,
        problem: &Problem,
        mesh: &Mesh,
        contacts: &ContactSet,
        (task, x): (&Task, &[Vec2]),
        curvature: Curvature,
    ) -> f64 {
        let mut touches = std::mem::take(&mut self.touches);
        contacts.find(problem, mesh, x, &mut touches);
        let s = &mut self.system;
        s.hessian.clear();
        s.gradient.fill(0.0);
        let mut value = 0.0;
        self.magnitude = 0.0;
        for e in 0..mesh.rest_length.len() {
            value += add_bar(s, mesh, task, (e, x), curvature);
        }
        if mesh.bending_stiffness > 0.0 {
            value += s.add_bending(mesh, x, curvature);
        }
        self.magnitude += value;
        for i in 0..x.len() {
            let (away, k) = (x[i] - task.predicted[i], task.inertia[i]);
            let kinetic = 0.5 * k * away.norm_squared();
            // Work is measured from the start of the step, so that its size is that of the change.
            let work = task.force[i].dot(&(x[i] - task.start[i]));
            value += kinetic - work;
            self.magnitude += kinetic + work.abs();
            s.add_gradient(i, away * k - task.force[i]);
            s.add_block(i, i, &(Mat2::identity() * k));
        }
        for touch in &touches {
            value += add_touch(s, touch, contacts, x, curvature);
        }
        for rub in &contacts.rubs {
            let (d, slope, bend) = friction::at(rub.sliding(x), rub.limit, SLIDE);
            value += d;
            let [a, b] = rub.touch.shares();
            add_pair(s, rub.touch.node, [a, b], rub.tangent * slope, &(rub.tangent * rub.tangent.transpose() * bend));
        }
        for (i, &limit) in task.floor_limit.iter().enumerate() {
            let slid = contacts.floor_slid[i] + (x[i] - task.start[i]);
            let (d, slope, bend) = friction::at_plane(slid, limit, SLIDE);
            value += d;
            s.add_gradient(i, slope);
            s.add_block(i, i, &bend);
        }
        self.touches = touches;
        value
    }

    /// Largest unbalanced force on a free node, and which.
    fn residual(&self, mesh: &Mesh) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for node in (0..mesh.nodes()).filter(|&k| !mesh.held[k]) {
            let r = self.system.gradient_at(node).norm();
            if !(r <= worst.0) {
                worst = (r, node);
            }
        }
        worst
    }

    /// Sets `direction` to the Newton step; false if the matrix is not positive definite.
    fn solve(&mut self, mesh: &Mesh, task: &Task, (x, shift): (&[Vec2], f64)) -> bool {
        let s = &mut self.system;
        for (d, g) in self.direction.iter_mut().zip(&s.gradient) {
            *d = -g;
        }
        let (rows, band) = (s.hessian.rows(), s.hessian.half_bandwidth());
        for node in 0..mesh.nodes() {
            if mesh.held[node] {
                let go = task.target[node] - x[node];
                for (k, go) in [(2 * node, go.x), (2 * node + 1, go.y)] {
                    for i in k.saturating_sub(band)..(k + band + 1).min(rows) {
                        self.direction[i] -= s.hessian.get(i, k) * go;
                    }
                }
            } else if shift > 0.0 {
                s.add_block(node, node, &(Mat2::identity() * shift));
            }
        }
        for node in (0..mesh.nodes()).filter(|&k| mesh.held[k]) {
            let go = task.target[node] - x[node];
            for (k, go) in [(2 * node, go.x), (2 * node + 1, go.y)] {
                s.hessian.pin(k);
                self.direction[k] = go;
            }
        }
        if self.factor.factor(&s.hessian).is_err() {
            return false;
        }
        self.factor.solve_in_place(&mut self.direction);
        self.direction.iter().all(|d| d.is_finite())
    }

    /// Minimises Φ from `x` (m), which becomes the answer; on failure it is where it got to.
    ///
    /// # Errors
    /// With the worst node and its unbalanced force.
    pub fn minimise(
        &mut self,
        (problem, mesh): (&Problem, &Mesh),
        contacts: &ContactSet,
        task: &Task,
        x: &mut [Vec2],
    ) -> Result<Done, Failure> {
        let mut shift = task.shift;
        let mut pushes = 0;
        let mut done = Done::default();
        let mut value = self.assemble(problem, mesh, contacts, (task, x), Curvature::Exact);
        loop {
            let (residual, node) = self.residual(mesh);
            let failed = |cause| Err(Failure { node, residual, cause });
            if !value.is_finite() || !residual.is_finite() {
                return failed("the energy is not finite");
            }
            let left = (0..mesh.nodes()).any(|k| mesh.held[k] && task.target[k] != x[k]);
            done.residual = residual;
            done.held_back = left;
            if residual <= task.tolerance && !left {
                return Ok(done);
            }
            if done.iterations >= task.max_iterations {
                return failed("too many iterations");
            }
            done.iterations += 1;
            // The gradient is needed after pinning overwrote the Hessian only, so it stays valid.
            if !self.solve(mesh, task, (x, shift)) {
                let mut tries = 0;
                loop {
                    self.assemble(problem, mesh, contacts, (task, x), Curvature::Clipped);
                    if self.solve(mesh, task, (x, shift)) {
                        break;
                    }
                    shift = grow(shift, task);
                    tries += 1;
                    if tries > 40 {
                        return failed("the tangent is not positive definite");
                    }
                }
            }
            let mut slope: f64 = self.direction.iter().zip(&self.system.gradient).map(|(d, g)| d * g).sum();
            if !(slope < 0.0) && !left {
                slope = 0.0;
            }
            match self.search((problem, mesh), contacts, (task, left), (x, value, slope)) {
                Some((new_value, fraction)) => {
                    value = new_value;
                    if fraction > 0.5 {
                        shift *= 0.25;
                        if shift < 1e-3 * task.shift {
                            shift = 0.0;
                        }
                    } else if fraction < 0.1 && task.shift > 0.0 {
                        shift = grow(shift, task);
                    }
                    if left && fraction < 0.5 {
                        pushes += 1;
                        if pushes > 12 {
                            return failed("a support cannot reach its place");
                        }
                    }
                }
                None => {
                    // At the noise of the energy there is nothing left to gain.
                    if residual <= 30.0 * task.tolerance && !left {
                        return Ok(done);
                    }
                    if shift > 1e12 * task.shift.max(1e-6) {
                        return failed("no descent");
                    }
                    shift = grow(shift, task);
                    value = self.assemble(problem, mesh, contacts, (task, x), Curvature::Clipped);
                }
            }
        }
    }

    /// Moves `x` along the direction as far as is free and lowers Φ; None if nothing does. Returns Φ and the part of
    /// the step taken; the system is assembled there.
    fn search(
        &mut self,
        (problem, mesh): (&Problem, &Mesh),
        contacts: &ContactSet,
        (task, moving): (&Task, bool),
        (x, value, slope): (&mut [Vec2], f64, f64),
    ) -> Option<(f64, f64)> {
        let n = x.len();
        let step = |k: usize, d: &[f64]| Vec2::new(d[2 * k], d[2 * k + 1]);
        let mut largest = 0.0;
        for k in 0..n {
            let m = step(k, &self.direction).norm();
            if !(m <= largest) {
                largest = m;
            }
        }
        let mut fraction = if largest > task.max_move { task.max_move / largest } else { 1.0 };
        if !problem.world.is_empty() {
            let mut free = fraction;
            for e in 0..n.saturating_sub(1) {
                let from = [x[e], x[e + 1]];
                let to = [from[0] + step(e, &self.direction) * free, from[1] + step(e + 1, &self.direction) * free];
                free *= problem.world.free_fraction(from, to, KEEP);
            }
            fraction = free;
        }
        let noise = ENERGY_NOISE * (self.magnitude.abs() + value.abs());
        for _ in 0..MAX_HALVINGS {
            for k in 0..n {
                self.trial[k] = x[k] + step(k, &self.direction) * fraction;
                // A full step ends exactly on target.
                if mesh.held[k] && fraction == 1.0 {
                    self.trial[k] = task.target[k];
                }
            }
            let trial = std::mem::take(&mut self.trial);
            let new_value = self.assemble(problem, mesh, contacts, (task, &trial), Curvature::Exact);
            self.trial = trial;
            let lower = new_value <= value + DECREASE * fraction * slope + noise;
            if new_value.is_finite() && (moving || lower) {
                x.copy_from_slice(&self.trial);
                return Some((new_value, fraction));
            }
            fraction *= 0.5;
        }
        None
    }
}

fn grow(shift: f64, task: &Task) -> f64 {
    let least = if task.shift > 0.0 { task.shift } else { 1.0 };
    if shift > 0.0 { 4.0 * shift } else { least }
}

fn add_bar(s: &mut System, mesh: &Mesh, task: &Task, (e, x): (usize, &[Vec2]), curvature: Curvature) -> f64 {
    let d = x[e + 1] - x[e];
    let (length, rest) = (d.norm(), mesh.rest_length[e]);
    let stretch = length - rest;
    let stiffness = mesh.axial_stiffness / rest * if stretch < 0.0 { PUSH } else { 1.0 };
    let (late, viscous) = (length - task.predicted_length[e], task.damping / rest);
    let tension = stiffness * stretch + viscous * late;
    let t = if length > 0.0 { d / length } else { Vec2::x() };
    let mut geometric = if length > 0.0 { tension / length } else { 0.0 };
    if curvature == Curvature::Clipped && geometric < 0.0 {
        geometric = 0.0;
    }
    let along = t * t.transpose();
    let block = along * (stiffness + viscous) + (Mat2::identity() - along) * geometric;
    s.add_gradient(e, -t * tension);
    s.add_gradient(e + 1, t * tension);
    s.add_block(e, e, &block);
    s.add_block(e + 1, e + 1, &block);
    s.add_block(e, e + 1, &-block);
    0.5 * (stiffness * stretch * stretch + viscous * late * late)
}

/// Adds a force gradient and a block shared by the nodes of a touch.
fn add_pair(s: &mut System, node: usize, [a, b]: [f64; 2], gradient: Vec2, block: &Mat2) {
    s.add_gradient(node, gradient * a);
    s.add_block(node, node, &(block * (a * a)));
    if b != 0.0 {
        s.add_gradient(node + 1, gradient * b);
        s.add_block(node + 1, node + 1, &(block * (b * b)));
        s.add_block(node, node + 1, &(block * (a * b)));
    }
}

/// The barrier of one touch. Its distance d from the corner has curvature (θ the turn of the segment, u its
/// direction, c the touching point, all linear in the nodes):
/// ```text
/// node:     ∇²d = (I − n nᵀ)/d  at a corner, 0 at an edge
/// segment:  ∇²d = −(θ qᵀ + q θᵀ) − d θ θᵀ,   q = u·δc,   θ = n·(δb − δa)/l
/// ```
fn add_touch(s: &mut System, touch: &Touch, contacts: &ContactSet, x: &[Vec2], curvature: Curvature) -> f64 {
    let (gap, weight) = (&touch.pair.gap, touch.pair.weight);
    let b = contacts.barrier.at(gap.gap_m);
    let (slope, bend) = (b.slope * weight, b.curvature * weight);
    let n = gap.normal;
    let shares = touch.shares();
    let definite = curvature == Curvature::Clipped;
    let bend = if definite && bend < 0.0 { 0.0 } else { bend };
    add_pair(s, touch.node, shares, n * slope, &(n * n.transpose() * bend));
    if definite {
        return b.value * weight;
    }
    let distance = (touch.interpolate(x) - gap.point).norm();
    if !touch.on_segment {
        // Edges have even feature numbers: their distance is linear.
        if gap.feature % 2 == 1 && distance > 0.0 {
            s.add_block(touch.node, touch.node, &((Mat2::identity() - n * n.transpose()) * (slope / distance)));
        }
        return b.value * weight;
    }
    let (i, d) = (touch.node, x[touch.node + 1] - x[touch.node]);
    let length = d.norm();
    let u = d / length;
    let theta = [n * (-1.0 / length), n * (1.0 / length)];
    let q = [u * shares[0], u * shares[1]];
    let block = |a: usize, b: usize| {
        (-(theta[a] * q[b].transpose() + q[a] * theta[b].transpose()) - theta[a] * theta[b].transpose() * distance)
            * slope
    };
    s.add_block(i, i, &block(0, 0));
    s.add_block(i + 1, i + 1, &block(1, 1));
    s.add_block(i, i + 1, &block(0, 1));
    b.value * weight
}

//! Newton's method on one energy finds the equilibrium of the cable.
//!
//! Springs that only pull, U = EA (length − l₀)²/2l₀ for length > l₀, are convex in nodes and
//! material coordinates together, so no compressed state can come out; weight is linear. Bending,
//! contacts and friction (see `contact_energy`) add their terms. The tangent is a band: a step
//! costs about as much as a few sweeps of relaxation, of which a stiff chain needs N·√(EA/T) for
//! each swing. The diagonal is shifted (K. Levenberg, A method for the solution of certain
//! non-linear problems in least squares, Quarterly of Applied Mathematics 2, 1944) until the energy
//! or the unbalanced force falls.

use crate::contact::friction;
use crate::energy::Curvature;
use crate::error::SolveError;
use crate::math::{Vec2, larger};
use crate::model::Model;
use crate::model::mass_spring::contact_memory::{Anchor, ContactImpulse};
use crate::model::mass_spring::equilibrium::assembly;
use crate::model::mass_spring::equilibrium::contact_energy::{Anchors, Contacts};
use crate::model::mass_spring::equilibrium::system::EquilibriumSystem;
use crate::model::mass_spring::forces::pulley;
use crate::model::mass_spring::mesh::{Mesh, remesh};

/// Least shift, of EA over the shortest element: some roundings of the diagonal, to which it adds
/// nothing there, and from which a few failures raise it again.
const MIN_SHIFT: f64 = 1e-14;

/// Units in the last place by which positions are off when they are good: strain is off by that
/// over l₀, tension EA times it. Two positions and the length between them lose about one each, and
/// both springs of a node add up.
const POSITION_ROUNDING_ULPS: f64 = 8.0;

/// An unbalanced force and its node.
#[derive(Clone, Copy, Debug)]
struct Residual {
    force_n: f64,
    node: usize,
}

/// The iterations of a solve, and the unbalanced force that they left.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::mass_spring) struct Iterations {
    pub count: usize,
    pub residual_n: f64,
}

/// The solver of one equilibrium.
pub(in crate::model::mass_spring) struct EquilibriumSolver<'a> {
    mesh: &'a mut Mesh,
    time_s: f64,
    contacts: Contacts,
    system: EquilibriumSystem,
}

impl<'a> EquilibriumSolver<'a> {
    /// Prepares the equilibrium of a mesh at a time; friction was held at `anchors`.
    pub(in crate::model::mass_spring) fn new(
        mesh: &'a mut Mesh,
        time_s: f64,
        anchors: &[Anchor],
        memory: Anchors,
    ) -> Result<Self, SolveError> {
        mesh.update_pulley_elements();
        let contacts = Contacts::new(mesh, anchors, memory);
        for p in &mut mesh.wheels.pulleys {
            p.sliding_speed = 0.0;
            if memory == Anchors::Forgotten {
                p.anchor = mesh.arc_length[p.node];
            }
        }
        let system = EquilibriumSystem::new(mesh)?;
        Ok(Self { mesh, time_s, contacts, system })
    }

    /// Moves the anchors of pulleys; returns the points where friction holds from now on.
    pub(in crate::model::mass_spring) fn move_anchors(&mut self) -> Vec<Anchor> {
        let slip = self.mesh.tuning.contact.pulley_slip_m;
        let anchors = self.contacts.moved_anchors(self.mesh);
        for p in &mut self.mesh.wheels.pulleys {
            let s = self.mesh.arc_length[p.node];
            p.anchor = s - friction::return_map(s - p.anchor, slip);
        }
        anchors
    }

    /// The contacts as impulses of one second, as the answer reads them.
    pub(in crate::model::mass_spring) fn impulses(&self) -> Vec<ContactImpulse> {
        self.contacts.impulses(self.mesh)
    }

    /// Moves the nodes to equilibrium. On an error they are somewhere on the way.
    pub(in crate::model::mass_spring) fn solve(&mut self) -> Result<Iterations, SolveError> {
        let tuning = self.mesh.tuning.newton;
        let unit =
            self.mesh.problem.axial_stiffness / self.mesh.rest_length.iter().copied().fold(f64::INFINITY, f64::min);
        // A contact may be stiffer than the springs: a step must be short for it, too.
        let stiffest = larger(unit, self.contacts.stiffness(self.mesh));
        let tolerance = self.rest_tolerance();
        let mut shift = tuning.first_shift * unit;
        let mut curvature = Curvature::Exact;
        self.contacts.freeze_friction(self.mesh);
        let mut energy = self.assemble(curvature);
        let mut worst = self.residual();
        let mut iterations = 0;
        // Steps since normal forces were taken over into friction.
        let mut frozen = 0;
        for k in 1..=tuning.max_steps {
            iterations = k;
            if worst.force_n <= tolerance && frozen == 0 {
                return Ok(Iterations { count: k, residual_n: worst.force_n });
            }
            let solved = self.try_step(shift);
            let new = self.assemble(Curvature::Exact);
            let left = self.residual();
            // Near round-off the energy no longer tells a better state, the unbalanced force does.
            if solved && new.is_finite() && (new < energy || left.force_n < worst.force_n) {
                shift = (shift * tuning.shift_decrease).max(MIN_SHIFT * unit);
                curvature = Curvature::Exact;
                (energy, worst) = (new, left);
                self.system.fade *= tuning.first_stiffness_fade;
                let remeshed = self.remesh_at_pulleys()?;
                let due = k < tuning.eager_friction_steps
                    || left.force_n <= tolerance
                    || frozen >= tuning.max_frozen_steps
                    || remeshed;
                frozen = if due { 0 } else { frozen + 1 };
                if due && (self.contacts.freeze_friction(self.mesh) || remeshed) {
                    energy = self.assemble(curvature);
                    worst = self.residual();
                }
            } else {
                self.undo_step();
                if !solved && curvature == Curvature::Exact {
                    curvature = Curvature::Clipped;
                } else {
                    shift *= tuning.shift_increase;
                }
                if !(shift < tuning.max_shift * stiffest) {
                    break;
                }
                energy = self.assemble(curvature);
            }
        }
        Err(self.not_converged(iterations, worst))
    }

    /// Adds and removes nodes beside pulleys; returns whether there were any.
    fn remesh_at_pulleys(&mut self) -> Result<bool, SolveError> {
        let remeshed = !self.mesh.wheels.pulleys.is_empty() && remesh(self.mesh, self.time_s);
        if remeshed {
            self.contacts.follow_nodes(self.mesh);
            self.system = EquilibriumSystem { fade: self.system.fade, ..EquilibriumSystem::new(self.mesh)? };
        }
        Ok(remeshed)
    }

    /// Returns to the state before the last step.
    fn undo_step(&mut self) {
        self.mesh.position.copy_from_slice(&self.system.position);
        self.mesh.arc_length.copy_from_slice(&self.system.arc_length);
        self.mesh.update_pulley_elements();
    }

    fn not_converged(&self, iterations: usize, worst: Residual) -> SolveError {
        let (s, at) = (self.mesh.arc_length[worst.node], self.mesh.position[worst.node]);
        SolveError::NotConverged {
            model: Model::MassSpring,
            iterations,
            residual_n: worst.force_n,
            place: self.mesh.problem.place(s, at, self.time_s),
        }
    }

    /// Unbalanced force at equilibrium, N: a part of the forces here, but never below the round-off
    /// of the positions times EA.
    fn rest_tolerance(&self) -> f64 {
        let tuning = &self.mesh.tuning.newton;
        let part = if self.mesh.can_touch() { tuning.touching_residual } else { tuning.residual };
        let far = self
            .mesh
            .position
            .iter()
            .map(|p| p.amax())
            .fold(self.mesh.problem.length, |a: f64, b| if b > a { b } else { a });
        let shortest = self.mesh.rest_length.iter().copied().fold(f64::INFINITY, f64::min);
        part * self.mesh.problem.force_scale()
            + POSITION_ROUNDING_ULPS * f64::EPSILON * self.mesh.problem.axial_stiffness * far / shortest
    }

    /// Goes one step; returns true if the tangent was positive. The system keeps the state before.
    fn try_step(&mut self, shift: f64) -> bool {
        let (mesh, system) = (&mut *self.mesh, &mut self.system);
        let n = mesh.position.len();
        system.position.copy_from_slice(&mesh.position);
        system.arc_length.copy_from_slice(&mesh.arc_length);
        for i in 0..n {
            system.hessian.add(2 * i, 2 * i, shift);
            system.hessian.add(2 * i + 1, 2 * i + 1, shift);
        }
        for i in 0..n {
            let slides = mesh.wheels.at_node[i].is_some();
            for axis in 0..2 {
                if mesh.supported[i] && !(slides && axis == 0) {
                    system.gradient[2 * i + axis] = 0.0;
                    system.hessian.pin(2 * i + axis);
                }
            }
        }
        if system.factor.factor(&system.hessian).is_err() {
            return false;
        }
        system.step.copy_from_slice(&system.gradient);
        system.factor.solve_in_place(&mut system.step);
        let limit = if mesh.problem.world.is_empty() {
            f64::INFINITY
        } else {
            mesh.tuning.newton.max_move_radii * mesh.problem.radius
        };
        let mut scale = 1.0;
        for i in 0..n {
            let (size, limit) = if mesh.wheels.at_node[i].is_some() {
                (system.step[2 * i].abs(), mesh.tuning.newton.max_slide_lengths * mesh.even_length)
            } else {
                (system.step[2 * i].hypot(system.step[2 * i + 1]), limit)
            };
            if size * scale > limit {
                scale = limit / size;
            }
        }
        for i in 0..n {
            let step = Vec2::new(system.step[2 * i], system.step[2 * i + 1]) * scale;
            if mesh.wheels.at_node[i].is_some() {
                mesh.arc_length[i] -= step.x;
            } else {
                mesh.position[i] -= step;
            }
        }
        mesh.update_pulley_elements();
        true
    }

    /// Computes energy (J), gradient, Hessian and the tensions here.
    fn assemble(&mut self, curvature: Curvature) -> f64 {
        let (mesh, system) = (&mut *self.mesh, &mut self.system);
        system.hessian.clear();
        system.gradient.fill(0.0);
        let mut value = assembly::add_loads(mesh, system, self.time_s);
        for e in 0..mesh.rest_length.len() {
            value += assembly::add_spring(mesh, system, e);
        }
        if mesh.bending_stiffness > 0.0 {
            value += assembly::add_bending(mesh, system, curvature);
        }
        value += self.contacts.assemble(mesh, system);
        let slip = mesh.tuning.contact.pulley_slip_m;
        let body = mesh.problem.body_force(self.time_s);
        for k in 0..mesh.wheels.pulleys.len() {
            pulley::update(mesh, k, body);
            let p = &mesh.wheels.pulleys[k];
            let (energy, slope, stiff) = friction::at(mesh.arc_length[p.node] - p.anchor, p.friction_limit, slip);
            value += energy;
            system.gradient[2 * p.node] = slope - p.sliding_force;
            system.hessian.add(2 * p.node, 2 * p.node, stiff);
        }
        value
    }

    /// The largest unbalanced force; NaN wins.
    fn residual(&self) -> Residual {
        let mut worst = Residual { force_n: 0.0, node: 0 };
        for i in 0..self.mesh.position.len() {
            let g = Vec2::new(self.system.gradient[2 * i], self.system.gradient[2 * i + 1]);
            let force_n = match (self.mesh.wheels.at_node[i].is_some(), self.mesh.supported[i]) {
                (true, _) => g.x.abs(),
                (false, true) => 0.0,
                (false, false) => g.norm(),
            };
            if force_n > worst.force_n || force_n.is_nan() {
                worst = Residual { force_n, node: i };
            }
        }
        worst
    }
}

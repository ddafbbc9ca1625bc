//! Where the springs rest when they touch nothing: Newton's method on their energy.
//!
//! Relaxation needs of the order of N·√(EA/T) sweeps for each swing it damps; the tangent of a chain is a band, so
//! Newton's step costs about as much as a few sweeps. The geometric stiffness is clipped in compression and the
//! diagonal shifted (K. Levenberg, A method for the solution of certain non-linear problems in least squares,
//! Quarterly of Applied Mathematics 2, 1944) until the energy falls.

use super::MassSpringModel;
use crate::energy::Curvature;
use crate::error::SolveError;
use crate::linalg::BandFactor;
use crate::math::{Mat2, Vec2};
use crate::model::Model;
use crate::model::fem::assembly::{Mesh, System};

/// Unbalanced force at rest, of the force scale: round-off allows little less, more shows in the reactions.
const RESIDUAL: f64 = 1e-9;
/// The same of EA: positions are good to 1e-16, strains to a little less.
const ROUND_OFF: f64 = 1e-13;
/// Newton steps: a start from the corrected bars' shape takes 5 to 15, a straight line some 40.
const MAX_STEPS: usize = 200;
/// First shift of the diagonal, of EA over the shortest element; and how it falls and rises with success. Smaller starts
/// with wild steps, larger wastes a few steps.
const FIRST_SHIFT: f64 = 1e-8;
const SHIFT_DOWN: f64 = 0.1;
const SHIFT_UP: f64 = 8.0;
/// Shift beyond which no step helps, of the same.
const LAST_SHIFT: f64 = 1e3;

impl MassSpringModel {
    /// Moves the nodes to rest. On an error they are somewhere on the way.
    pub(super) fn equilibrium(&mut self) -> Result<(), SolveError> {
        self.place_supports();
        let mesh = Mesh {
            arc_length: self.s.clone(),
            rest_length: self.rest.clone(),
            held: self.held.clone(),
            clamps: Vec::new(),
            axial_stiffness: self.problem.axial_stiffness,
            bending_stiffness: 0.0,
        };
        let force = self.external();
        let n = self.x.len();
        let mut system = System::new(&mesh);
        let unstable = |node| SolveError::Indefinite { model: Model::MassSpring, node };
        let mut factor = BandFactor::new(2 * n, mesh.half_bandwidth()).map_err(|_| unstable(0))?;
        let tolerance = RESIDUAL * self.problem.force_scale() + ROUND_OFF * mesh.axial_stiffness;
        let shortest = self.rest.iter().copied().fold(f64::INFINITY, f64::min);
        let unit = mesh.axial_stiffness / shortest;
        let mut shift = FIRST_SHIFT * unit;
        let mut step = vec![0.0; 2 * n];
        let mut tried = self.x.clone();
        let mut energy = system.assemble(&mesh, &self.x, &force, Curvature::Clipped);
        let (mut worst, mut node) = largest(&system, &mesh);
        for k in 1..=MAX_STEPS {
            self.cost.iterations = k;
            self.cost.residual_n = worst;
            if worst <= tolerance {
                return Ok(());
            }
            for i in 0..n {
                system.add_block(i, i, &(Mat2::identity() * shift));
            }
            system.pin_held(&mesh);
            let solved = factor.factor(&system.hessian).is_ok();
            if solved {
                step.copy_from_slice(&system.gradient);
                factor.solve_in_place(&mut step);
                for i in 0..n {
                    tried[i] = self.x[i] - Vec2::new(step[2 * i], step[2 * i + 1]);
                }
            }
            let new = system.assemble(&mesh, &tried, &force, Curvature::Clipped);
            let (left, at) = largest(&system, &mesh);
            // Near round-off the energy no longer tells a better state, the unbalanced force does.
            if solved && new.is_finite() && (new < energy || left < worst) {
                std::mem::swap(&mut self.x, &mut tried);
                (energy, worst, node) = (new, left, at);
                shift *= SHIFT_DOWN;
            } else {
                shift *= SHIFT_UP;
                if !(shift < LAST_SHIFT * unit) {
                    break;
                }
                tried.copy_from_slice(&self.x);
                system.assemble(&mesh, &self.x, &force, Curvature::Clipped);
            }
        }
        Err(SolveError::NotConverged {
            model: Model::MassSpring,
            iterations: self.cost.iterations,
            residual_n: worst,
            node,
            at_m: self.x[node],
        })
    }

    /// Forces that do not depend on the shape, N a node.
    fn external(&self) -> Vec<Vec2> {
        let p = &self.problem;
        let body = p.body_force(self.time_s);
        let mut force = vec![Vec2::zeros(); self.x.len()];
        for (e, d) in self.span.iter().enumerate() {
            force[e] += body * (0.5 * d);
            force[e + 1] += body * (0.5 * d);
        }
        let g = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
        for (u, &k) in p.supports.iter().zip(&self.node_of) {
            force[k] += u.force.at(self.time_s) + g * u.mass;
        }
        for (l, &k) in p.loads.iter().zip(&self.load_node) {
            force[k] += l.force.at(self.time_s);
        }
        force
    }

    /// Whether an element found at rest pushes, which a cable cannot.
    pub(super) fn compressed(&self) -> Option<SolveError> {
        let tolerance = RESIDUAL * self.problem.force_scale() + ROUND_OFF * self.problem.axial_stiffness;
        (0..self.rest.len()).find_map(|e| {
            let strain = (self.x[e + 1] - self.x[e]).norm() / self.rest[e] - 1.0;
            let tension_n = self.problem.axial_stiffness * strain;
            (tension_n < -10.0 * tolerance).then_some(SolveError::Compressed {
                model: Model::MassSpring,
                element: e,
                tension_n,
            })
        })
    }
}

/// The largest unbalanced force (N) on a node that is not held, and the node; NaN wins.
fn largest(system: &System, mesh: &Mesh) -> (f64, usize) {
    let mut out = (0.0, 0);
    for i in 0..mesh.nodes() {
        let force = system.gradient_at(i).norm();
        if !mesh.held[i] && (force > out.0 || force.is_nan()) {
            out = (force, i);
        }
    }
    out
}

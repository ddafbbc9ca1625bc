//! This solver takes one implicit step of a flexible cable that can touch nothing, with the forces
//! of the bars as additional unknowns.
//!
//! With positions alone, moving a node across its bars by δ lengthens them by δ²/2l, which adds a
//! force EA δ²/2l² in a stiff bar: the finer the mesh, the more iterations (6, 18 and 47 a step at
//! 100, 1000 and 10 000 bars). If the bar forces Q are unknowns, they change only by the linear
//! equations, and the count stays at 2 to 4:
//! ```text
//! mᵢ a² (x − x̃) − f + Σ ± Q t = 0,     Q = k (P − L) + c (P − P̂),     k = EA/L,  c = EA τ a/L or that of `loss`
//! [A + Bᵀ(k + c)B] δx = −(residual with Q of the present lengths),     Q ← Q(P) + (k + c) t·δ(x₂ − x₁)
//! A = m a² + Q/P (I − t tᵀ)
//! ```
//! with the mass m spread over the bars (see `mass_matrix`). (Q < 0 is replaced by 0 in the matrix
//! if that is not positive definite otherwise.) The matrix is that of Newton's method in positions
//! except for Q (the multiplier, as in augmented Lagrangian methods: R. Glowinski and P. Le
//! Tallec, *Augmented Lagrangian and operator-splitting methods in nonlinear mechanics*, SIAM
//! 1989). It is block tridiagonal and needs no general sparse factorisation. If this method fails
//! (for a cable that is both slack and stiff, say), the minimiser of contact steps takes over from
//! the same start.

use crate::energy::Curvature;
use crate::math::{Vec2, larger};
use crate::model::fem::mesh::Mesh;
use crate::model::fem::system::{BarBranch, Converged, PlainBar, StepInput, Unknowns, bar_energy};

/// Round-off of a bar's length, in units of the round-off of a coordinate.
const BAR_LENGTH_ROUNDINGS: f64 = 16.0;

/// A symmetric 2×2 matrix: xx, xy, yy.
type Symmetric = [f64; 3];

/// Working memory of the solver; a copy of the model allocates its own.
#[derive(Debug, Default)]
pub struct MixedFreeSolver {
    /// Force of each bar as an unknown, N.
    pull: Vec<f64>,
    /// Force of each bar at its present length, N.
    present: Vec<f64>,
    /// The branch of its material law on which each bar is.
    branch: Vec<BarBranch>,
    /// (k + c) and t of each bar.
    hold: Vec<(f64, Vec2)>,
    /// Unbalanced force on each node with the unknown bar forces, N.
    gradient: Vec<Vec2>,
    /// Diagonal blocks, and the blocks that couple the nodes of each bar, N/m.
    diagonal: Vec<Symmetric>,
    between: Vec<Symmetric>,
    step: Vec<Vec2>,
    start: Vec<Vec2>,
}

impl Clone for MixedFreeSolver {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Residual of the equations.
struct EquilibriumResidual {
    /// Largest unbalanced force of a free node, N.
    force: f64,
    /// Largest difference between a bar's unknown force and that of its length, beyond round-off,
    /// N.
    pull: f64,
}

impl MixedFreeSolver {
    /// Finds the unknowns at the end of a step; returns None, with `unknowns` as before, if it does
    /// not converge.
    pub fn solve(&mut self, mesh: &Mesh, input: &StepInput, unknowns: &mut Unknowns) -> Option<Converged> {
        self.start.clone_from(&unknowns.positions);
        self.make_room(mesh);
        let done = self.newton(mesh, input, &mut unknowns.positions);
        if done.is_none() {
            unknowns.positions.clone_from(&self.start);
        }
        done
    }

    /// Unbalanced force on a node after a solve, N; at a held node it is minus the force of the
    /// cable on its support.
    #[must_use]
    pub fn gradient_at(&self, node: usize) -> Vec2 {
        self.gradient.get(node).copied().unwrap_or_default()
    }

    /// Makes the vectors as long as the mesh requires.
    fn make_room(&mut self, mesh: &Mesh) {
        let (nodes, bars) = (mesh.nodes(), mesh.rest_length.len());
        self.pull.resize(bars, 0.0);
        self.present.resize(bars, 0.0);
        self.branch.resize(bars, BarBranch::Taut);
        self.hold.resize(bars, (0.0, Vec2::zeros()));
        self.between.resize(bars, [0.0; 3]);
        self.gradient.resize(nodes, Vec2::zeros());
        self.diagonal.resize(nodes, [0.0; 3]);
        self.step.resize(nodes, Vec2::zeros());
    }

    /// Takes Newton steps from `x`, which becomes the answer; None if they do not converge.
    fn newton(&mut self, mesh: &Mesh, input: &StepInput, x: &mut [Vec2]) -> Option<Converged> {
        for iterations in 0..=mesh.tuning.newton.free_iterations {
            if iterations == 0 {
                self.begin(mesh, input);
            }
            let balance = self.assemble(mesh, input, x, Curvature::Exact);
            let left = mesh
                .fixity
                .iter()
                .zip(x.iter().zip(&input.supports.target))
                .any(|(is_fixed, (x, to))| *is_fixed && x != to);
            if !(balance.force.is_finite() && balance.pull.is_finite()) {
                return None;
            }
            if balance.force <= input.stopping.tolerance && balance.pull <= input.stopping.tolerance && !left {
                return Some(Converged { iterations, residual: balance.force });
            }
            if iterations == mesh.tuning.newton.free_iterations {
                return None;
            }
            if !self.factor_and_solve(mesh, input, x) {
                self.assemble(mesh, input, x, Curvature::Clipped);
                if !self.factor_and_solve(mesh, input, x) {
                    return None;
                }
            }
            self.walk(mesh, input, x);
        }
        None
    }

    /// Sets the first bar forces of the step: nearer to those at its end than the forces of the
    /// predicted positions.
    fn begin(&mut self, mesh: &Mesh, input: &StepInput) {
        for (e, (pull, branch)) in self.pull.iter_mut().zip(&mut self.branch).enumerate() {
            let (p, l) = ((input.supports.start[e + 1] - input.supports.start[e]).norm(), mesh.rest_length[e]);
            *branch = PlainBar::of(mesh, input, e).branch(p);
            *pull = bar_energy::stiffness(mesh, p >= l) * (p / l - 1.0);
        }
    }

    /// Assembles the gradient with the unknown bar forces into `gradient`, the matrix into the
    /// blocks, and the right-hand side (with the forces of the present lengths) into `step`.
    fn assemble(&mut self, mesh: &Mesh, input: &StepInput, x: &[Vec2], curvature: Curvature) -> EquilibriumResidual {
        for i in 0..x.len() {
            let (k, away) = (input.inertial.stiffness[i], x[i] - input.inertial.predicted[i]);
            let rest = away * k - input.loads.force[i];
            self.gradient[i] = rest;
            self.step[i] = -rest;
            self.diagonal[i] = [k, 0.0, k];
        }
        let mut balance = EquilibriumResidual { force: 0.0, pull: 0.0 };
        for e in 0..mesh.rest_length.len() {
            let d = x[e + 1] - x[e];
            let p = d.norm();
            let (now, stiffness) = PlainBar::of(mesh, input, e).pull(self.branch[e], p);
            let t = if p > 0.0 { d / p } else { Vec2::x() };
            let pull = self.pull[e];
            let off = (now - pull).abs() - BAR_LENGTH_ROUNDINGS * f64::EPSILON * stiffness * x[e].norm();
            balance.pull = larger(balance.pull, off);
            let (coupling, chord) = input.inertial.coupling.get(e).copied().unwrap_or_default();
            let inertia = (d - chord) * coupling;
            self.gradient[e] -= t * pull - inertia;
            self.gradient[e + 1] += t * pull - inertia;
            self.step[e] += t * now - inertia;
            self.step[e + 1] -= t * now - inertia;
            let clip = curvature == Curvature::Clipped && pull < 0.0;
            let geometric = if p > 0.0 && !clip { pull / p } else { 0.0 };
            let along = stiffness - geometric;
            let across = geometric - coupling;
            let block = [along * t.x * t.x + across, along * t.x * t.y, along * t.y * t.y + across];
            for c in 0..3 {
                self.diagonal[e][c] += block[c];
                self.diagonal[e + 1][c] += block[c];
                self.between[e][c] = -block[c];
            }
            self.hold[e] = (stiffness, t);
            self.present[e] = now;
        }
        for (g, _) in self.gradient.iter().zip(&mesh.fixity).filter(|(_, is_fixed)| !**is_fixed) {
            balance.force = larger(balance.force, g.norm());
        }
        balance
    }

    /// Block elimination from the first node on, D ← D − C D₋⁻¹ C, and back substitution. False if
    /// a block is not positive definite.
    fn factor_and_solve(&mut self, mesh: &Mesh, input: &StepInput, x: &[Vec2]) -> bool {
        let n = x.len();
        for k in 0..n {
            if mesh.fixity[k] {
                let go = input.supports.target[k] - x[k];
                if k > 0 {
                    self.step[k - 1] -= times(&self.between[k - 1], go);
                    self.between[k - 1] = [0.0; 3];
                }
                if k + 1 < n {
                    self.step[k + 1] -= times(&self.between[k], go);
                    self.between[k] = [0.0; 3];
                }
                self.diagonal[k] = [1.0, 0.0, 1.0];
                self.step[k] = go;
            }
        }
        for k in 0..n {
            if k > 0 {
                // C is symmetric here. The inverse of D is stored in place of D, for C D⁻¹ C and C
                // D⁻¹ r.
                let (c, inverse) = (self.between[k - 1], self.diagonal[k - 1]);
                let [m00, m01, m10, m11] = product(&c, &inverse);
                self.diagonal[k][0] -= m00 * c[0] + m01 * c[1];
                self.diagonal[k][1] -= m00 * c[1] + m01 * c[2];
                self.diagonal[k][2] -= m10 * c[1] + m11 * c[2];
                let r = self.step[k - 1];
                self.step[k] -= Vec2::new(m00 * r.x + m01 * r.y, m10 * r.x + m11 * r.y);
            }
            let [a, b, c] = self.diagonal[k];
            let determinant = a * c - b * b;
            if !(a > 0.0 && determinant > 0.0) {
                return false;
            }
            let scale = 1.0 / determinant;
            self.diagonal[k] = [c * scale, -b * scale, a * scale];
        }
        let mut after = Vec2::zeros();
        for k in (0..n).rev() {
            let mut r = self.step[k];
            if k + 1 < n {
                r -= times(&self.between[k], after);
            }
            after = times(&self.diagonal[k], r);
            self.step[k] = after;
        }
        true
    }

    /// Moves the nodes and the bar forces by the step, or by the fraction of it that moves no node
    /// too far.
    fn walk(&mut self, mesh: &Mesh, input: &StepInput, x: &mut [Vec2]) {
        let mut longest = 0.0;
        for s in &self.step {
            longest = larger(longest, s.norm());
        }
        let part = if longest > input.stopping.max_move { input.stopping.max_move / longest } else { 1.0 };
        for (e, &(stiffness, t)) in self.hold.iter().enumerate() {
            let by = t.dot(&(self.step[e + 1] - self.step[e])) * part;
            self.pull[e] = self.present[e] + stiffness * by;
            self.branch[e] = PlainBar::of(mesh, input, e).branch((x[e + 1] - x[e]).norm() + by);
        }
        for (k, x) in x.iter_mut().enumerate() {
            *x += self.step[k] * part;
            if mesh.fixity[k] && part == 1.0 {
                *x = input.supports.target[k];
            }
        }
    }
}

fn times(m: &Symmetric, v: Vec2) -> Vec2 {
    Vec2::new(m[0] * v.x + m[1] * v.y, m[1] * v.x + m[2] * v.y)
}

/// The product of two symmetric matrices, row by row.
fn product(a: &Symmetric, b: &Symmetric) -> [f64; 4] {
    [a[0] * b[0] + a[1] * b[1], a[0] * b[1] + a[1] * b[2], a[1] * b[0] + a[2] * b[1], a[1] * b[1] + a[2] * b[2]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::fem::newton::step_potential::Workspace;
    use crate::model::fem::stepper::Stepper;
    use crate::model::fem::system::StepContext;
    use crate::model::{Inertia, Settings};
    use crate::problem::problems;
    use crate::scene::{Support, SupportKind, catalog};
    use proptest::prelude::*;

    fn dynamics(stiffness: f64, far_end: SupportKind) -> Stepper {
        let mut scene = catalog::hanging_span();
        scene.cables[0].axial_stiffness_n = stiffness;
        scene.cables[0].bending_stiffness_n_m2 = 0.0;
        if far_end == SupportKind::Free {
            scene.cables[0].supports[1] = Support::new("loose", SupportKind::Free);
        }
        let settings = Settings { segments: Some(30), ..Settings::default() };
        Stepper::new(problems(&scene).unwrap().remove(0), settings, Default::default()).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        /// The equations are those of the minimiser, so the answer and the support forces agree for
        /// any history.
        #[test]
        fn the_pose_is_that_of_the_minimiser(
            log_stiffness in 4.0f64..7.0, loose in any::<bool>(), waves in prop::collection::vec(-1.0f64..1.0, 6), a in 300.0f64..700.0,
        ) {
            let mut d = dynamics(10f64.powf(log_stiffness), if loose { SupportKind::Free } else { SupportKind::Fixed });
            for _ in 0..3 {
                d.advance(1.0 / 240.0, Inertia::Dynamic, &[]).unwrap();
            }
            let (n, mut input) = (d.cable.mesh.nodes(), d.cable.input.clone());
            input.stopping.tolerance = 1e-7;
            for k in 0..n {
                let s = k as f64 / (n - 1) as f64 * std::f64::consts::PI;
                let push = Vec2::new(waves[0] * s.sin() + waves[1] * (2.0 * s).sin(), waves[2] * s.sin() + waves[3] * (3.0 * s).sin());
                input.inertial.predicted[k] = d.cable.motion.positions[k] + push * 0.004;
                input.inertial.stiffness[k] = d.cable.mesh.tributary_length(k) * a * a;
            }
            let start = Unknowns { positions: d.cable.motion.positions.clone(), slides: vec![0.0; n] };
            let (mut free, mut found) = (MixedFreeSolver::default(), start.clone());
            let Some(done) = free.solve(&d.cable.mesh, &input, &mut found) else { return Err(TestCaseError::fail("not solved")) };
            prop_assert!(done.residual <= 1e-7 && done.iterations <= 12, "{done:?}");
            let (mut general, mut expected) = (Workspace::new(&d.cable.mesh).unwrap(), start);
            let step = StepContext { input: &input, ..d.cable.step_context() };
            prop_assert!(general.minimise(&step, &mut expected).is_ok());
            let off = found.positions.iter().zip(&expected.positions).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            prop_assert!(off < 1e-7, "{off}");
            let scale = 1e-4 * (1.0 + general.gradient_at(0).norm());
            prop_assert!((free.gradient_at(0) - general.gradient_at(0)).norm() < scale);
        }
    }

    #[test]
    fn what_it_cannot_solve_is_left_as_it_was() {
        let mut d = dynamics(1e5, SupportKind::Fixed);
        d.advance(1.0 / 240.0, Inertia::Dynamic, &[]).unwrap();
        let mut input = d.cable.input.clone();
        input.inertial.predicted[7].x = f64::NAN;
        let start = Unknowns { positions: d.cable.motion.positions.clone(), slides: vec![0.0; d.cable.mesh.nodes()] };
        let mut unknowns = start.clone();
        assert_eq!(MixedFreeSolver::default().solve(&d.cable.mesh, &input, &mut unknowns), None);
        assert_eq!(unknowns, start);
    }
}

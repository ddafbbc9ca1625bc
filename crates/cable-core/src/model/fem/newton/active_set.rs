//! This module predicts the contacts that a Newton step is about to make: the active set of the
//! step.
//!
//! The barrier acts only at gaps below d̂. A Newton step that ignores farther obstacles runs into
//! them and is cut where the first node would touch; the next step is cut at the next node. A cable
//! that landed on the ground took as many iterations as nodes landed. Therefore contacts that the
//! step δ would carry past their landing gap g* become constraints, and the step is solved again:
//! ```text
//! min ½ δᵀHδ + gᵀδ   subject to   n·δc + r ≥ −(g − g*)    for each contact ahead, c its point
//! ```
//! with the violated constraints as stiff springs, added until none is violated. r is the change of
//! the gap beyond first order (`gap_constraint`), evaluated at the last step found: a bar that
//! slides along a corner also turns, and to first order it would run into the corner however much
//! its gap opens at first (a second-order correction: N. Maratos, "Exact penalty function
//! algorithms for finite dimensional and control optimization problems", thesis, University of
//! London, 1978; R. Fletcher, "Second order corrections for non-differentiable optimization",
//! Lecture Notes in Mathematics 912, 1982). Without it a taut cable that is dragged round a corner
//! moves a hundredth of its way in each iteration. With r = 0 the step δ = 0 satisfies every
//! constraint, so the constrained step goes downhill. With r it may not, and then the step without
//! constraints is taken as far as it is free.

use crate::contact::self_contact_pairs::{SelfPair, SortedNodes};
use crate::linalg::{BandFactor, solve_coupled};
use crate::math::Vec2;
use crate::model::fem::newton::gap_constraint::{ConstraintChange, GapConstraint};
use crate::model::fem::settings::NewtonTuning;
use crate::model::fem::system::{ContactPair, Coupling, StepContext, System, longest};

/// The contacts that a step is about to make.
#[derive(Clone, Debug)]
pub struct PredictedContacts {
    touches: Vec<ContactPair>,
    gap_constraints: Vec<GapConstraint>,
    pairs: Vec<SelfPair>,
    order: SortedNodes,
    right: Vec<f64>,
    step: Vec<f64>,
    /// The direction before contacts were predicted.
    pub(in crate::model::fem) plain: Vec<f64>,
}

/// The linear equations of a Newton iteration, with the held nodes fixed.
pub(in crate::model::fem) struct Equations<'a> {
    /// Gradient and Hessian.
    pub system: &'a mut System,
    /// The Hessian's factor.
    pub factor: &'a mut BandFactor,
    /// The coupling of nodes that are far apart along the cable.
    pub coupling: &'a mut Coupling,
}

impl PredictedContacts {
    /// Allocates room for a mesh of so many nodes with one contact each.
    #[must_use]
    pub fn new(nodes: usize) -> Self {
        Self {
            touches: Vec::with_capacity(nodes),
            gap_constraints: Vec::with_capacity(nodes),
            pairs: Vec::new(),
            order: SortedNodes::default(),
            right: Vec::with_capacity(2 * nodes),
            step: Vec::with_capacity(2 * nodes),
            plain: Vec::with_capacity(2 * nodes),
        }
    }

    /// Stores the right-hand side before the equations are solved in place.
    pub fn keep(&mut self, right: &[f64]) {
        self.right.clear();
        self.right.extend_from_slice(right);
    }

    /// The stored right-hand side.
    pub fn right_hand_side(&self) -> &[f64] {
        &self.right
    }

    /// Stops each node of a step at its landing gap, independently of its neighbours.
    pub(in crate::model::fem) fn stop(&mut self, step: &StepContext<'_>, x: &[Vec2], direction: &mut [f64]) {
        let StepContext { mesh, contacts, .. } = *step;
        self.find_contacts(step, x, direction);
        for touch in self.touches.iter().filter(|t| !t.on_segment && t.pair.weight > 0.0 && mesh.is_free(t.node)) {
            let (n, k) = (touch.pair.gap.normal, 2 * touch.node);
            let least = landing_gap(&mesh.tuning.newton, touch.pair.gap.gap_m, contacts.barrier.reach);
            let over = least - touch.pair.gap.gap_m - n.dot(&moved(touch, direction));
            if over > 0.0 {
                direction[k] += n.x * over;
                direction[k + 1] += n.y * over;
            }
        }
    }

    /// Finds everything that each bar could touch if it moved as far as in this step, in any
    /// direction.
    fn find_contacts(&mut self, step: &StepContext<'_>, x: &[Vec2], direction: &[f64]) {
        let StepContext { problem, mesh, contacts, .. } = *step;
        let reach = |e: usize| contacts.barrier.reach + longest(direction.get(2 * e..2 * e + 4).unwrap_or(direction));
        contacts.search.find(problem, mesh, x, reach, &mut self.touches);
    }

    /// Solves again with the predicted contacts as constraints. The held nodes of `system` are
    /// fixed, and `direction` is the step that ran into the contacts. If the solve fails,
    /// `direction` stays as it is.
    pub(in crate::model::fem) fn solve(
        &mut self,
        context: &StepContext<'_>,
        equations: Equations<'_>,
        x: &[Vec2],
        direction: &mut [f64],
    ) {
        let StepContext { mesh, contacts, .. } = *context;
        let Equations { system, factor, coupling } = equations;
        self.find_contacts(context, x, direction);
        let reach = contacts.barrier.reach;
        self.gap_constraints.clear();
        for touch in self.touches.iter().filter(|t| t.pair.weight > 0.0) {
            self.gap_constraints.push(GapConstraint::of(
                touch,
                mesh,
                system,
                landing_gap(&mesh.tuning.newton, touch.pair.gap.gap_m, reach),
            ));
        }
        if contacts.self_contacts.shape.is_on() {
            let within = reach + 2.0 * longest(direction);
            contacts.self_contacts.shape.pairs(x, &mesh.arc_length, within, &mut self.order, &mut self.pairs);
            for pair in self.pairs.iter().filter(|p| p.weight > 0.0) {
                self.gap_constraints.push(GapConstraint::of_own(
                    pair,
                    mesh,
                    system,
                    landing_gap(&mesh.tuning.newton, pair.gap_m, reach),
                ));
            }
        }
        let Self { gap_constraints, right, step, .. } = self;
        step.clear();
        step.extend_from_slice(direction);
        for _ in 0..mesh.tuning.newton.active_set_rounds {
            let (mut stiffer, mut changed) = (false, false);
            for constraint in gap_constraints.iter_mut() {
                let change = constraint.add_to(system, coupling, right, mesh, x, step);
                stiffer |= change == ConstraintChange::Matrix;
                changed |= change != ConstraintChange::None;
            }
            if !changed {
                break;
            }
            step.copy_from_slice(right);
            let solved = if !coupling.is_empty() {
                solve_coupled(&system.hessian, coupling, step).is_ok()
            } else if stiffer {
                factor.factor_and_solve(&system.hessian, step).is_ok()
            } else {
                factor.solve_in_place(step);
                true
            };
            if !solved || !step.iter().all(|d| d.is_finite()) {
                return;
            }
        }
        direction.copy_from_slice(step);
    }
}

/// The gap at which a step is stopped.
fn landing_gap(tuning: &NewtonTuning, gap: f64, reach: f64) -> f64 {
    if gap > reach {
        return tuning.landing_gap_fraction * reach;
    }
    let loss = tuning.bound_margin * (1.0 - tuning.kept_gap_fraction);
    (1.0 - loss) * gap
}

/// Displacement of the touching point in a step.
fn moved(touch: &ContactPair, step: &[f64]) -> Vec2 {
    let shares = touch.shares();
    let at = |k: usize| Vec2::new(step[2 * k], step[2 * k + 1]);
    if touch.on_segment { at(touch.node) * shares[0] + at(touch.node + 1) * shares[1] } else { at(touch.node) }
}

#[cfg(test)]
mod tests {
    use crate::math::Vec2;
    use crate::model::fem::newton::step_potential::Workspace;
    use crate::model::fem::settings::ContactTuning;
    use crate::model::fem::stepper::Stepper;
    use crate::model::{Inertia, Settings};
    use crate::problem::problems;
    use crate::scene::{Obstacle, Shape, Support, catalog};

    const STEP: f64 = 1.0 / 240.0;

    /// A loose cable of 10 m and 100 bars in the air, in a slight wave above a floor, at 5 m/s
    /// downwards: it lands all along its length in the next step, at slightly different instants.
    fn about_to_land() -> Stepper {
        let mut scene = catalog::hanging_span();
        let shape = Shape::Terrain { points_m: vec![[-5.0, 0.0], [15.0, 0.0]] };
        scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape, friction: Some(0.5) }];
        let c = &mut scene.cables[0];
        (c.length_m, c.bending_stiffness_n_m2) = (10.0, 0.0);
        let hook = |name: &str, x| Support { release_s: Some(0.5 * STEP), ..Support::fixed(name, [x, 0.6]) };
        c.supports = vec![hook("a", 0.0), hook("b", 9.95)];
        let radius = 0.5 * c.diameter_m;
        let settings = Settings { segments: Some(100), ..Settings::default() };
        let mut d = Stepper::new(problems(&scene).unwrap().remove(0), settings, Default::default()).unwrap();
        d.settle(&[]).unwrap();
        d.advance(STEP, Inertia::Dynamic, &[]).unwrap();
        for (k, (x, v)) in d.cable.motion.positions.iter_mut().zip(&mut d.cable.motion.velocities).enumerate() {
            let gap = 5.0 * ContactTuning::default().reach_m + 8e-3 * (1.0 + (0.13 * k as f64).sin());
            (*x, *v) = (Vec2::new(0.1 * k as f64, radius + gap), Vec2::new(0.0, -5.0));
        }
        d.forget_history();
        d
    }

    #[test]
    fn a_cable_that_lands_all_along_its_length_in_one_step_takes_few_iterations() {
        let mut d = about_to_land();
        d.begin_step(STEP, &[]).unwrap();
        let mut unknowns = d.solver.present_unknowns(&d.cable);
        let mut memory = Workspace::new(&d.cable.mesh).unwrap();
        let done = memory.minimise_by_line_search(&d.cable.step_context(), &mut unknowns).unwrap();
        let landed = memory.touches.len();
        println!("{} iterations, {landed} nodes landed", done.iterations);
        assert!(landed > 90 && done.iterations <= 8, "{landed} {}", done.iterations);
    }
}

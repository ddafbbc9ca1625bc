//! This solver takes a step in contact by a mixed Newton method, with the forces of the bars as
//! additional unknowns and without line search.
//!
//! As in [`crate::model::fem::newton::mixed_free`] a bar's force Q satisfies its own linear
//! equation, so the stiffness across a bar follows the tension of the solution and not that of a
//! temporarily stretched bar: the number of iterations no longer grows with the number of bars. The
//! energy may rise during the iteration, so it is not tested (a watchdog: R. Chamberlain, M.
//! Powell, C. Lemarechal, H. Pedersen, "The watchdog technique for forcing convergence in
//! algorithms for constrained optimization", Mathematical Programming Study 16, 1982). Only gaps
//! are limited, and none may become so small that its force is lost in round-off: nothing else
//! keeps a node from approaching an obstacle by a fraction of its gap in every iteration. A step
//! that has not converged after a few iterations is left to the minimiser, from the same start. If
//! the cable touches itself, the minimiser is tried first, and the undamped Newton method if the
//! minimiser fails.

use crate::contact::friction::Branch;
use crate::energy::Curvature;
use crate::math::{Mat2, Vec2, larger};
use crate::model::fem::mesh::Mesh;
use crate::model::fem::newton::step_potential::{ENERGY_NOISE, Workspace};
use crate::model::fem::system::{
    ContactSet, Converged, Failure, PlainBar, StepContext, StepInput, Unknowns, bar_energy,
};

/// Strain below which a bar counts as unstretched.
const UNSTRETCHED_STRAIN: f64 = 1e-12;

/// Number of iterations above which the energy of an answer is compared with that of its start.
/// Smaller: two more assemblies in steps that converge quickly; larger: another local minimum is
/// accepted. Of 89 489 undamped solves in 100 violent scenes none that took more than one iteration
/// ended above its start by more than the work of the supports; scene 20330 has one that did,
/// after 25.
const MAX_UNCHECKED_ITERATIONS: usize = 8;

/// Number of iterations after which a solve whose residual has grown by more than
/// [`MAX_RESIDUAL_GROWTH`] is given up. Smaller: solves that first move a bar far are given up;
/// larger: time is spent on those that never converge. In a capstan of 30 bars 803 of 1440 steps do
/// not converge, with residuals thousands of times the first one.
const MIN_ITERATIONS: usize = 6;

/// See [`MIN_ITERATIONS`].
const MAX_RESIDUAL_GROWTH: f64 = 100.0;

/// Slide that counts as round-off, as a fraction of the slide at which friction changes from stick
/// to slip; the same fraction holds for the friction force.
const BRANCH_ROUNDING: f64 = 1e-14;

/// The reaction of a solve to a cable that comes within the barrier's reach of itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::fem) enum SelfTouch {
    /// The solve is given up.
    Avoid,
    /// The solve goes on.
    Allow,
}

impl Workspace {
    /// Minimises Φ from `unknowns`, which becomes the answer; on failure it is where it got to.
    ///
    /// # Errors
    /// With the worst node and its unbalanced force.
    pub(in crate::model::fem) fn minimise(
        &mut self,
        step: &StepContext<'_>,
        unknowns: &mut Unknowns,
    ) -> Result<Converged, Failure> {
        if !step.input.inertial.moves {
            return self.minimise_by_line_search(step, unknowns);
        }
        let found = self.undamped_newton(step, SelfTouch::Avoid, unknowns);
        if let Some(done) = found
            && !(done.iterations > MAX_UNCHECKED_ITERATIONS && self.raises_energy(step, unknowns))
        {
            return Ok(done);
        }
        if found.is_some() {
            self.mixed.near_enough = false;
            self.go_back(unknowns);
        }
        let mut undamped = self.mixed.undamped_iterations;
        let mut done = self.minimise_by_line_search(step, unknowns);
        if self.mixed.near_enough && (done.is_err() || self.raises_energy(step, unknowns)) {
            self.go_back(unknowns);
            done = self.minimise_by_line_search(step, unknowns);
        }
        if done.is_err() && step.contacts.self_contacts.shape.is_on() {
            self.go_back(unknowns);
            if let Some(found) = self.undamped_newton(step, SelfTouch::Allow, unknowns) {
                done = Ok(found);
            } else {
                undamped += self.mixed.undamped_iterations;
            }
        }
        done.map(|d| Converged { iterations: d.iterations + undamped, ..d })
    }

    /// Solves for the unknowns at the end of a step; returns None if that fails, with `unknowns`
    /// then as before or not far from that. Unless `self_touch` allows it, the cable must not come
    /// within reach of itself during the iteration.
    fn undamped_newton(
        &mut self,
        step: &StepContext<'_>,
        self_touch: SelfTouch,
        unknowns: &mut Unknowns,
    ) -> Option<Converged> {
        self.mixed.begun.positions.clone_from(&unknowns.positions);
        self.mixed.begun.slides.clone_from(&unknowns.slides);
        self.goal.clone_from(&step.input.supports.target);
        self.init_bar_iterates(step.mesh, step.input, unknowns);
        let done = self.iterate_undamped(step, self_touch, unknowns);
        self.mixed.carried.clear();
        self.mixed.branches.clear();
        if done.is_none() && !self.mixed.near_enough {
            self.go_back(unknowns);
        }
        done
    }

    /// True if Φ is greater at `unknowns` than where the step began, by more than the work of the
    /// supports. No descent from the start leads there: the iteration found another local minimum.
    /// (A cable of 100 N that was whipped round the edge of a beam had 2.9 kN and four times the
    /// kinetic energy at the end of such a step.)
    fn raises_energy(&mut self, step: &StepContext<'_>, unknowns: &Unknowns) -> bool {
        let begun = std::mem::take(&mut self.mixed.begun);
        let at_start = self.assemble(step, &begun, Curvature::Exact);
        let noise = ENERGY_NOISE * self.magnitude.abs();
        // The system stays assembled at the answer, because its gradient gives the reactions.
        let value = self.assemble(step, unknowns, Curvature::Exact);
        let noise = noise + ENERGY_NOISE * self.magnitude.abs();
        let fixed_nodes = (0..step.mesh.nodes()).filter(|&k| step.mesh.fixity[k]);
        let work: f64 =
            fixed_nodes.map(|k| self.gradient_at(k).dot(&(unknowns.positions[k] - begun.positions[k]))).sum();
        self.mixed.begun = begun;
        value > at_start + larger(work, 0.0) + noise
    }

    /// Sets `unknowns` to the start of the step.
    fn go_back(&self, unknowns: &mut Unknowns) {
        unknowns.positions.clone_from(&self.mixed.begun.positions);
        unknowns.slides.clone_from(&self.mixed.begun.slides);
    }

    /// Sets the force of each bar (N) and its branch to those at `unknowns`.
    fn init_bar_iterates(&mut self, mesh: &Mesh, input: &StepInput, unknowns: &Unknowns) {
        self.mixed.carried.clear();
        for (e, l) in mesh.rest_length.iter().enumerate() {
            let p = (unknowns.positions[e + 1] - unknowns.positions[e]).norm();
            let stretched = if mesh.is_break(e) { 0.0 } else { p / l - 1.0 };
            let pull = bar_energy::stiffness(mesh, p >= *l) * stretched;
            let branch = PlainBar::of(mesh, input, e).branch(p);
            self.mixed.carried.push(bar_energy::BarIterate { pull, branch });
        }
    }

    /// Moves `unknowns` from the start of the step to the positions that its velocities predict, as
    /// far as the way is free.
    fn start_from_prediction(&mut self, step: &StepContext<'_>, unknowns: &mut Unknowns) {
        let StepContext { mesh, input, .. } = *step;
        if unknowns.positions != input.begins() {
            return;
        }
        for (k, d) in self.direction.chunks_exact_mut(2).enumerate() {
            let to = match (mesh.fixity[k], mesh.is_free(k)) {
                (true, _) => self.goal[k],
                (_, true) => input.inertial.predicted[k],
                _ => unknowns.positions[k],
            };
            (d[0], d[1]) = (to.x - unknowns.positions[k].x, to.y - unknowns.positions[k].y);
        }
        self.predicted_contacts.stop(step, &unknowns.positions, &mut self.direction);
        let whole = self.max_step_fraction(input);
        let free = self.ccd_step_bound(step, unknowns, whole);
        self.move_unknowns(mesh, unknowns, free);
    }

    /// Takes full Newton steps until the residual is within tolerance and every branch is as
    /// assumed; None if that fails or is given up.
    fn iterate_undamped(
        &mut self,
        step: &StepContext<'_>,
        self_touch: SelfTouch,
        unknowns: &mut Unknowns,
    ) -> Option<Converged> {
        let StepContext { mesh, contacts, input, .. } = *step;
        self.start_from_prediction(step, unknowns);
        self.mixed.branches.clear();
        self.mixed.branches.extend(
            contacts.friction_contacts.iter().map(|r| Branch::at(r.sliding(&unknowns.positions), contacts.slip)),
        );
        let mut first = f64::NAN;
        self.mixed.near_enough = false;
        for iterations in 0..=mesh.tuning.newton.mixed_iterations {
            self.mixed.undamped_iterations = iterations;
            let value = self.assemble(step, unknowns, Curvature::Exact);
            if self_touch == SelfTouch::Avoid && !self.self_contact.coupling.is_empty() {
                self.mixed.near_enough = false;
                return None;
            }
            let residual = self.residual(mesh, input).force;
            let left = (0..mesh.nodes()).any(|k| mesh.fixity[k] && self.goal[k] != unknowns.positions[k]);
            if iterations == 0 {
                first = residual;
            }
            let sound = value.is_finite() && residual.is_finite() && self.rounding.noise <= input.stopping.tolerance;
            if sound
                && residual <= input.stopping.tolerance
                && !left
                && self.branches_hold(mesh, input, contacts, &unknowns.positions)
            {
                return Some(Converged { iterations, residual });
            }
            self.mixed.near_enough = sound && residual < mesh.tuning.newton.handed_on_residual_fraction * first;
            let diverges = iterations >= MIN_ITERATIONS && residual > MAX_RESIDUAL_GROWTH * first;
            if iterations == mesh.tuning.newton.mixed_iterations || !sound || diverges {
                return None;
            }
            if !self.solve(mesh, input, &unknowns.positions, input.stopping.shift)
                && !self.reduce_compression(mesh, input, &unknowns.positions)
            {
                self.assemble(step, unknowns, Curvature::Clipped);
                if !self.solve(mesh, input, &unknowns.positions, input.stopping.shift) {
                    return None;
                }
            }
            let free = self.predict_contacts(step, unknowns);
            let whole = self.max_step_fraction(input);
            self.mixed.slid.clear();
            self.mixed.slid.extend(contacts.friction_contacts.iter().map(|r| r.sliding(&unknowns.positions)));
            self.move_with_bar_forces(mesh, input, unknowns, if free < whole { free } else { whole });
            for (b, (from, r)) in
                self.mixed.branches.iter_mut().zip(self.mixed.slid.iter().zip(&contacts.friction_contacts))
            {
                *b = b.next([*from, r.sliding(&unknowns.positions)], contacts.slip);
            }
        }
        None
    }

    /// Solves for the direction again if compressed bars make the matrix indefinite: the geometric
    /// stiffness of their compression is reduced until the matrix is definite. (The minimiser drops
    /// it entirely, but that matrix is far from the equations, and its steps oscillate.) Returns
    /// false if no reduction helps; then the values of the system are lost.
    fn reduce_compression(&mut self, mesh: &Mesh, input: &StepInput, x: &[Vec2]) -> bool {
        if !self.self_contact.coupling.is_empty() || mesh.bending_stiffness > 0.0 {
            return false;
        }
        let mut kept = 1.0;
        for part in mesh.tuning.newton.push_fractions {
            self.change_compression(mesh, input, x, part - kept);
            kept = part;
            self.predicted_contacts.keep(&self.direction);
            if self.factor.factor_and_solve(&self.system.hessian, &mut self.direction).is_ok() {
                return self.direction.iter().all(|d| d.is_finite());
            }
            self.direction.copy_from_slice(self.predicted_contacts.right_hand_side());
        }
        false
    }

    /// Changes the geometric stiffness of all compressed bars by a fraction of it; the motion of
    /// fixed nodes goes to the right-hand side.
    fn change_compression(&mut self, mesh: &Mesh, input: &StepInput, x: &[Vec2], change: f64) {
        for (e, carried) in self.mixed.carried.iter().enumerate().filter(|(_, c)| c.pull < 0.0) {
            let d = x[e + 1] - x[e];
            let p = d.norm();
            if !(p > 0.0) || mesh.sliding[e].is_some() || mesh.sliding[e + 1].is_some() {
                continue;
            }
            let (t, stiffness) = (d / p, input.scale[e] * change * carried.pull / p);
            let across = [stiffness * (1.0 - t.x * t.x), -stiffness * t.x * t.y, stiffness * (1.0 - t.y * t.y)];
            match [mesh.fixity[e], mesh.fixity[e + 1]] {
                [false, false] => self.system.hessian.add_spring(2 * e, across),
                [true, true] => {}
                [first, _] => {
                    let (free, fixed_node) = if first { (e + 1, e) } else { (e, e + 1) };
                    let block = Mat2::new(across[0], across[1], across[1], across[2]);
                    let force = block * (self.goal[fixed_node] - x[fixed_node]);
                    self.system.add_block(free, free, &block);
                    self.direction[2 * free] += force.x;
                    self.direction[2 * free + 1] += force.y;
                }
            }
        }
    }

    /// True if every bar and every friction contact is on the branch (taut or slack, stick or slip)
    /// that the step assumed.
    fn branches_hold(&self, mesh: &Mesh, input: &StepInput, contacts: &ContactSet, x: &[Vec2]) -> bool {
        let frictions = contacts.friction_contacts.iter().zip(&self.mixed.branches);
        let slip = contacts.slip;
        let holds = |y: f64, b: Branch| b == Branch::at(y, slip) || (y.abs() - slip).abs() <= BRANCH_ROUNDING;
        frictions.map(|(r, b)| (r.sliding(x), *b)).all(|(y, b)| holds(y, b))
            && self.mixed.carried.iter().enumerate().all(|(e, carried)| {
                PlainBar::of(mesh, input, e).is_on(carried.branch, (x[e + 1] - x[e]).norm(), UNSTRETCHED_STRAIN)
            })
    }

    /// Moves unknowns and bar forces by a fraction of the direction.
    fn move_with_bar_forces(&mut self, mesh: &Mesh, input: &StepInput, unknowns: &mut Unknowns, part: f64) {
        let direction = &self.direction;
        let step = |k: usize| Vec2::new(direction[2 * k], direction[2 * k + 1]) * part;
        for (e, carried) in self.mixed.carried.iter_mut().enumerate() {
            let d = unknowns.positions[e + 1] - unknowns.positions[e];
            let p = d.norm();
            let bar = PlainBar::of(mesh, input, e);
            let (now, slope) = bar.pull(carried.branch, p);
            let along = if p > 0.0 { d.dot(&(step(e + 1) - step(e))) / p } else { 0.0 };
            *carried = bar_energy::BarIterate { pull: now + slope * along, branch: bar.branch(p + along) };
        }
        self.move_unknowns(mesh, unknowns, part);
    }

    /// Moves unknowns by a fraction of the direction.
    fn move_unknowns(&self, mesh: &Mesh, unknowns: &mut Unknowns, part: f64) {
        for k in 0..mesh.nodes() {
            let step = Vec2::new(self.direction[2 * k], self.direction[2 * k + 1]) * part;
            if mesh.sliding[k].is_some() {
                unknowns.slides[k] += step.x;
            } else if mesh.fixity[k] && part == 1.0 {
                unknowns.positions[k] = self.goal[k];
            } else {
                unknowns.positions[k] += step;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::fem::stepper::Stepper;
    use crate::model::{Inertia, Settings};
    use crate::problem::problems;
    use crate::scene::{Obstacle, Shape, Support, catalog};
    use proptest::prelude::*;

    const STEP: f64 = 1.0 / 240.0;

    /// A cable of 6 m released with a tilt (m) above rough ground, thrown down and sideways.
    fn falling(tilt: f64, waves: &[f64]) -> Stepper {
        let mut scene = catalog::hanging_span();
        let points_m = (0..=40).map(|k| [-4.0 + 0.4 * f64::from(k), 0.05 * f64::from(k * 7 % 5)]).collect();
        let shape = Shape::Terrain { points_m };
        scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape, friction: Some(0.5) }];
        let c = &mut scene.cables[0];
        (c.length_m, c.axial_stiffness_n, c.bending_stiffness_n_m2) = (6.0, 1e6, 0.0);
        let hook = |name: &str, at| Support { release_s: Some(0.5 * STEP), ..Support::fixed(name, at) };
        c.supports = vec![hook("a", [0.0, 0.9]), hook("b", [5.9, 0.9 + tilt])];
        let settings = Settings { segments: Some(40), ..Settings::default() };
        let mut d = Stepper::new(problems(&scene).unwrap().remove(0), settings, Default::default()).unwrap();
        d.settle(&[]).unwrap();
        let n = d.cable.mesh.nodes() - 1;
        for (k, v) in d.cable.motion.velocities.iter_mut().enumerate() {
            let s = std::f64::consts::PI * k as f64 / n as f64;
            *v = Vec2::new(waves[0] * s.sin(), waves[1] * s.sin() + waves[2] * (3.0 * s).sin() - 3.0);
        }
        d.forget_history();
        d
    }

    /// A cable of 10 m with so many bars, released at both ends above a floor.
    fn dropped(height: f64, bars: usize) -> Stepper {
        let mut scene = catalog::hanging_span();
        let shape = Shape::Terrain { points_m: vec![[-5.0, 0.0], [15.0, 0.0]] };
        scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape, friction: Some(0.5) }];
        let c = &mut scene.cables[0];
        (c.length_m, c.bending_stiffness_n_m2) = (10.0, 0.0);
        let hook = |name: &str, x| Support { release_s: Some(0.5 * STEP), ..Support::fixed(name, [x, height]) };
        c.supports = vec![hook("a", 0.0), hook("b", 9.95)];
        let settings = Settings { segments: Some(bars), ..Settings::default() };
        let mut d = Stepper::new(problems(&scene).unwrap().remove(0), settings, Default::default()).unwrap();
        d.settle(&[]).unwrap();
        d
    }

    /// Landing nodes are thrown together along the floor with forces of kN. Without branches of
    /// friction 14 of these steps cycled until the minimiser took over. A step in which a node
    /// lands is balanced twice, as friction follows the normal forces of its own step: 565
    /// iterations and 28 steps of a dozen or more. (495 and 17 if slack bars resist as strongly as
    /// taut ones; below 380 and none with the friction of the step before.)
    #[test]
    fn a_landing_front_is_found_without_the_minimiser() {
        let mut d = dropped(1.0, 100);
        let (mut whole, mut long) = (0, 0);
        for _ in 0..130 {
            let cost = d.advance(STEP, Inertia::Dynamic, &[]).unwrap().cost;
            (whole, long) = (whole + cost.iterations, long + usize::from(cost.iterations >= 12));
            assert_eq!(cost.halved_steps, 0);
        }
        println!("{whole} iterations, {long} steps of a dozen or more");
        // Since the recoil of the cable that is let go gains no energy, 692 and 26 (590 and 26):
        // one step of it is balanced twice, and the cable lands with other folds.
        assert!(long < 34 && whole < 760, "{whole} {long}");
    }

    /// Chance decides which steps the undamped Newton method does not solve, so the test counts
    /// over many drops.
    #[test]
    fn bars_that_buckle_where_they_land_take_few_iterations() {
        let (mut whole, mut long) = (0, 0);
        for k in 0..8 {
            let mut d = dropped(0.7 + 0.04 * f64::from(k), 600);
            for _ in 0..120 {
                let cost = d.advance(STEP, Inertia::Dynamic, &[]).unwrap().cost;
                (whole, long) = (
                    whole + cost.iterations,
                    long + usize::from(cost.iterations > d.cable.mesh.tuning.newton.mixed_iterations),
                );
            }
        }
        println!("{whole} iterations, {long} steps left to the minimiser");
        // Measured: 13 444 and 250, because slack bars give way: where the nodes of a landing front
        // are thrown together, the minimiser finds which bars buckle. With slack bars that resisted
        // like taut ones: 7087 and 10. Since the recoil of a cable that is let go gains no energy,
        // 17 369 and 264: 16 steps of eight drops are balanced twice, and the cables land with
        // other folds.
        assert!(whole < 18_500 && long < 290, "{whole} iterations, {long} steps left to the minimiser");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]
        /// The equations are those of the minimiser, so the answers agree wherever both have one.
        #[test]
        fn the_pose_is_that_of_the_minimiser(tilt in -0.5f64..0.5, waves in prop::collection::vec(-1.0f64..1.0, 3)) {
            let mut d = falling(tilt, &waves);
            let (mut compared, mut touching, mut worst) = (0, 0, 0.0);
            for _ in 0..80 {
                let mut trial = d.clone();
                trial.begin_step(STEP, &[]).unwrap();
                let mut expected = trial.solver.present_unknowns(&trial.cable);
                trial.cable.contacts.prepare(&trial.cable.problem, &trial.cable.mesh, &expected.positions, &trial.cable.motion.positions);
                let mut memory = Workspace::new(&trial.cable.mesh).unwrap();
                let (step, mut found) = (trial.cable.step_context(), expected.clone());
                let found_undamped = memory.undamped_newton(&step, SelfTouch::Avoid, &mut found).is_some();
                if found_undamped && memory.minimise_by_line_search(&step, &mut expected).is_ok() {
                    let off = found.positions.iter().zip(&expected.positions).map(|(a, b)| (a - b).norm());
                    worst = off.fold(worst, larger);
                    compared += 1;
                    touching += usize::from(memory.touches.len() > 2);
                }
                d.advance(STEP, Inertia::Dynamic, &[]).unwrap();
            }
            println!("{compared} compared, {touching} of them in contact, {worst:e} m off");
            // A hundred times the tolerance would move it by 1e-7 m.
            prop_assert!(worst < 2e-8 && compared >= 60 && touching >= 15, "{} {} {}", compared, touching, worst);
        }
    }
}

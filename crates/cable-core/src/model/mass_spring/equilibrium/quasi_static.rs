//! Equilibria of the model, and quasi-static steps: the supports move a little, the cable comes to
//! rest there, and friction remembers.

use crate::error::{NoEquilibrium, SolveError};
use crate::math::Vec2;
use crate::model::mass_spring::MassSpringModel;
use crate::model::mass_spring::equilibrium::contact_energy::Anchors;
use crate::model::mass_spring::equilibrium::newton::EquilibriumSolver;
use crate::model::mass_spring::forces::nodal;
use crate::numerics::HalvedSteps;

/// Part of a step that is taken with the step before it.
const JOINED_FRACTION: f64 = 0.5;

/// This block solves equilibria and repeats the whole model's state where a part of a step fails.
impl MassSpringModel {
    /// Moves the nodes to equilibrium. On an error they are somewhere on the way.
    pub(in crate::model::mass_spring) fn equilibrium(&mut self, anchors: Anchors) -> Result<(), SolveError> {
        self.mesh.velocity.fill(Vec2::zeros());
        self.clock.behind_s = 0.0;
        let time_s = self.clock.time_s;
        self.drives.place_nodes(&mut self.mesh, time_s);
        self.contacts.forget_distances();
        if !self.mesh.supported.contains(&true) && !self.mesh.can_touch() {
            return Err(SolveError::NoRestingPlace { why: NoEquilibrium::NothingBelow });
        }
        let mut solver = EquilibriumSolver::new(&mut self.mesh, time_s, &self.contacts.anchors, anchors)?;
        let iterations = solver.solve()?;
        self.contacts.anchors = solver.move_anchors();
        let impulses = solver.impulses();
        self.contacts.renew(self.mesh.rest_length.len());
        self.contacts.impulses.extend(impulses);
        self.report.cost.iterations = iterations.count;
        self.report.cost.residual_n = iterations.residual_n;
        self.report.cost.inner_step_s = 0.0;
        nodal::update(&mut self.mesh, time_s);
        self.mesh.non_finite(time_s).map_or(Ok(()), Err)
    }

    /// Follows the supports through equilibria for `dt_s`.
    pub(in crate::model::mass_spring) fn quasi_static_step(&mut self, dt_s: f64) -> Result<(), SolveError> {
        let (begin, end) = (self.clock.time_s, self.clock.time_s + dt_s);
        let tuning = self.mesh.tuning.quasi_static;
        let from = self.mesh.position.clone();
        let nodes: Vec<(usize, usize)> = self.mesh.support_node.iter().copied().enumerate().collect();
        let mut path: f64 = 0.0;
        for &(k, node) in &nodes {
            let support = &self.mesh.problem.supports[k];
            // The path of a motion within the step may be longer than the distance.
            let mut last = from[node];
            for j in 1..=tuning.path_samples {
                let time = begin + dt_s * f64::from(j) / f64::from(tuning.path_samples);
                let Some((at, _)) = support.position_at(time) else { break };
                let at = self.drives.targets[k].unwrap_or(at);
                path += (at - last).norm();
                last = at;
            }
        }
        let within = if self.mesh.problem.world.is_empty() {
            self.mesh.even_length
        } else {
            self.mesh.even_length.min(self.mesh.problem.radius)
        };
        let parts = if self.mesh.can_touch() || !self.mesh.wheels.pulleys.is_empty() {
            (path / (tuning.max_path_lengths * within)).ceil().clamp(1.0, tuning.max_parts)
        } else {
            1.0
        };
        let targets = self.drives.targets.clone();
        let starts: Vec<Vec2> = nodes.iter().map(|&(_, n)| from[n]).collect();
        let mut steps = HalvedSteps::new(1.0, 1.0 / parts, tuning.max_halvings, JOINED_FRACTION);
        let (mut done, mut iterations) = (0.0, 0);
        while let Some(next) = steps.next(done) {
            let kept = self.clone();
            self.clock.time_s = begin + (end - begin) * next;
            for (k, target) in targets.iter().enumerate() {
                // A hand goes straight.
                self.drives.targets[k] = target.map(|t| starts[k] + (t - starts[k]) * next);
            }
            match self.equilibrium(Anchors::Kept) {
                Ok(()) => {
                    iterations += self.report.cost.iterations;
                    done = next;
                }
                Err(e) => {
                    *self = kept;
                    if !steps.halve() {
                        return Err(e);
                    }
                }
            }
        }
        self.report.cost.iterations = iterations;
        // Friction on a supported node acts against its velocity.
        for &(k, node) in &nodes {
            let now = self.mesh.support_node[k];
            if self.mesh.supported[now] {
                self.mesh.velocity[now] = (self.mesh.position[now] - from[node]) / dt_s;
            }
        }
        self.drives.targets = targets;
        Ok(())
    }
}

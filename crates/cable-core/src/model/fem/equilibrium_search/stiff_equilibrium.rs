//! This module finds the equilibrium of a stiff cable in contact as an elastica, from a flexible
//! cable or from the mesh. If there is none, it warns of the bending that the mesh neglects.

use crate::math::larger;
use crate::model::Inertia;
use crate::model::fem::elastica::{self, Elastica};
use crate::model::fem::equilibrium_search::TwoMeshes;
use crate::model::fem::equilibrium_search::mesh_error::MeshRefinement;
use crate::model::fem::stepper::Stepper;
use crate::model::fem::{FemModel, PresentPart, results};
use crate::model::initial_equilibrium::{initial_equilibrium, meets_itself};
use crate::model::{Mechanics, StepReport};
use crate::problem::Problem;
use crate::solution::{CableSolution, Cost, Node, ShownEquilibrium, Warning, WarningCause};
use crate::state::State;

/// Fraction of the tolerance below which the error estimate of a stiff cable's equilibrium must
/// stay.
const STIFF_ESTIMATE_FRACTION: f64 = 0.5;

/// Greatest distance of a stiff cable's equilibrium from that of its mesh, as a fraction of the
/// cable's length. Smaller: the equilibria of coarse meshes are not replaced; larger: another
/// equilibrium passes for the same one.
const STIFF_SHIFT_LIMIT: f64 = 0.05;

impl FemModel {
    /// Finds the equilibrium of a stiff cable as an elastica, from that of a flexible one; None if
    /// none is found. A cable that can touch itself, and does not, has the equilibrium of one that
    /// could pass through itself.
    pub(in crate::model::fem) fn elastica_from_flexible(&mut self) -> Option<StepReport> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let passing = Problem::without_self_contact(self.problem.clone());
        let lay = initial_equilibrium(&passing, self.settings, &self.dragged, self.robot_pose).ok()?;
        let (time_s, tolerance) = (self.stepper.cable.time(), STIFF_ESTIMATE_FRACTION * self.settings.tolerance);
        let flexible = lay.as_ref().map(|l| &l.answer);
        let (answer, cost) = elastica::equilibrium(&passing, time_s, &self.dragged, flexible, tolerance)?;
        if meets_itself(&self.problem, &answer.nodes) || crosses_an_obstacle(&self.problem, &answer.nodes) {
            return None;
        }
        self.elastica_answer = Some(answer);
        let mut warnings = lay.map_or_else(Vec::new, |l| l.warnings);
        warnings.extend(self.elastica_warning());
        Some(StepReport { cost, warnings })
    }

    /// Finds the elastica from the equilibrium of the mesh.
    pub(in crate::model::fem) fn elastica_from_mesh(&mut self) -> Option<Cost> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let answer = self.stepper.solution();
        let bar = self.stepper.cable.even();
        let passing = Problem::without_self_contact(self.problem.clone());
        let found = Elastica::from_mesh(&passing, self.stepper.cable.time(), &self.dragged, &answer, bar)?;
        let cost = self.accept_elastica(found)?;
        // A shape that differs by more than the error of a mesh is another equilibrium.
        let near = |n: &Node| {
            let at =
                self.elastica_answer.as_ref().and_then(|b| State::of_nodes(&b.nodes, 0.0).position_at(n.arc_length_m));
            at.is_some_and(|at| (at - n.at()).norm() <= STIFF_SHIFT_LIMIT * self.problem.length)
        };
        let touches = |found: &CableSolution| meets_itself(&self.problem, &found.nodes);
        if !answer.nodes.iter().all(near) || self.elastica_answer.as_ref().is_some_and(touches) {
            self.elastica_answer = None;
            return None;
        }
        Some(cost)
    }

    /// A warning of a stiff cable's equilibrium whose error exceeds the tolerance.
    pub(in crate::model::fem) fn elastica_warning(&self) -> Option<Warning> {
        let (estimate, asked) = (self.elastica_answer.as_ref()?.error_estimate?, self.settings.tolerance);
        let cause = WarningCause::BarContacts;
        (estimate > asked).then(|| Warning::new(cause, &self.problem.cable.name, 0.0, [estimate, asked]))
    }

    /// Raises an elastica to the whole stiffness, refines it and stores its answer.
    pub(in crate::model::fem) fn accept_elastica(&mut self, mut found: Elastica) -> Option<Cost> {
        if !found.stiffen(&self.problem) {
            return None;
        }
        let (estimate, errors) =
            elastica::refine(&mut found, &self.problem, STIFF_ESTIMATE_FRACTION * self.settings.tolerance)?;
        let (iterations, residual_n) = found.cost();
        self.elastica_answer =
            Some(CableSolution { error_estimate: Some(estimate), errors, ..elastica::solution(&found, &self.problem) });
        Some(Cost { iterations, residual_n, ..Cost::default() })
    }

    /// Begins to move a stiff cable without inertia from the answer of an elastica, at which the
    /// mesh has come to rest.
    pub(in crate::model::fem) fn begin_from_elastica(&mut self, answer: &CableSolution) {
        if self.problem.bending_stiffness > 0.0 {
            let refinement = self.refinement();
            let (meshes, stepper) = (&mut self.meshes, &mut self.stepper);
            meshes.begin(&self.problem, self.settings, refinement, stepper, answer, &self.dragged);
        }
    }

    /// The number of bars to which those of a stiff cable that moves may be divided to show its
    /// bends.
    pub(in crate::model::fem) fn finest_bars(&self, inertia: Inertia) -> usize {
        let cable = &self.stepper.cable;
        let (bars, most) = (cable.meshing.even_bars, cable.mesh.tuning.start.max_refined_bars);
        let may_refine = self.refinement() == MeshRefinement::Allowed && self.problem.outline.is_none();
        match inertia {
            Inertia::QuasiStatic if may_refine => std::iter::successors(Some(bars), |bars| Some(2 * bars))
                .take_while(|b| *b <= most)
                .last()
                .unwrap_or(bars),
            _ => bars,
        }
    }

    /// Halves the bars of a stiff cable that moves without inertia until they show its bending to
    /// the tolerance, if the scene leaves their number open.
    pub(in crate::model::fem) fn refine_for_bending(&mut self) {
        if !(self.problem.bending_stiffness > 0.0)
            || self.problem.outline.is_some()
            || self.refinement() == MeshRefinement::Forbidden
        {
            return;
        }
        let (meshes, stepper) = (&mut self.meshes, &mut self.stepper);
        while BendingEstimate::of(meshes, stepper).whole > self.settings.tolerance
            && meshes.halve_bars(&self.problem, self.settings, stepper, &self.dragged)
        {}
    }

    /// A warning of the bending of a stiff cable that the mesh neglects, if it exceeds the
    /// tolerance.
    pub(in crate::model::fem) fn coarse_bend_warning(&mut self) -> Option<Warning> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let estimate = BendingEstimate::of(&self.meshes, &self.stepper);
        self.bending_error = Some(estimate.hidden);
        let limit = self.settings.tolerance;
        if estimate.whole <= limit {
            return None;
        }
        let cause = WarningCause::CoarseBend { bars: self.stepper.cable.meshing.even_bars };
        Some(Warning::new(cause, &self.problem.cable.name, estimate.arc_length, [estimate.whole, limit]))
    }

    /// A warning of the other equilibria of a compressed stiff cable: it may bow to another side.
    pub(in crate::model::fem) fn bow_warning(&self) -> Option<Warning> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let free = || {
            let mut statics = self.statics.clone();
            if self.present == PresentPart::Stepper || self.elastica_answer.is_some() {
                // Without an answer it has no buckled shapes either.
                let _ = statics.settle(&self.dragged);
            }
            statics.buckled_shapes()
        };
        let passing = Problem::without_self_contact(self.problem.clone());
        let histories = elastica::other_equilibria(&passing, self.time_s(), &self.dragged, &self.solution(), free)?;
        let cause = WarningCause::ManyEquilibria { shown: ShownEquilibrium::FromRoute, histories };
        Some(Warning::new(cause, &self.problem.cable.name, 0.0, [0.0; 2]))
    }
}

/// The error of the tension of a stiff cable by its bars, relative to the greatest tension.
struct BendingEstimate {
    /// All of it.
    whole: f64,
    /// The part that a coarser mesh beside it does not show.
    hidden: f64,
    /// The arc length at which that is greatest, m.
    arc_length: f64,
}

impl BendingEstimate {
    /// A coarser mesh shows the error of material nodes; without one there is a bound.
    fn of(meshes: &TwoMeshes, stepper: &Stepper) -> Self {
        let bound = results::bending_error(&stepper.cable);
        let shown = meshes.halving_error(&stepper.solution());
        let hidden = if shown.is_some() { bound.sliding } else { larger(bound.sliding, bound.material) };
        Self { whole: larger(hidden, shown.unwrap_or(0.0)), hidden, arc_length: bound.arc_length }
    }
}

/// True if the centre line of a cable goes through an edge of an obstacle between two of its nodes:
/// elements are longer than a thin beam, and clear of it on both sides.
fn crosses_an_obstacle(problem: &Problem, nodes: &[Node]) -> bool {
    let geometry = problem.world.geometry();
    nodes.windows(2).any(|pair| geometry.is_crossed([pair[0].at(), pair[1].at()]))
}

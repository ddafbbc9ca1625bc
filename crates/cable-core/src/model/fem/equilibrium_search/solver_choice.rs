//! This module controls the search for an equilibrium: it chooses the solver and the start, and
//! checks the answer.

use std::sync::Arc;

use crate::error::SolveError;
use crate::model::fem::equilibrium::slides_as_a_whole;
use crate::model::fem::equilibrium_search::easier_start::SpansStart;
use crate::model::fem::equilibrium_search::mesh_error::{LEAST_BARS, MeshRefinement, TwoMeshes};
use crate::model::fem::obstacle::touches_nothing;
use crate::model::fem::stepper::Stepper;
use crate::model::fem::system::WorkBudget;
use crate::model::fem::{FemModel, PresentPart};
use crate::model::initial_equilibrium::{InitialEquilibrium, slid_first, slides_on, work};
use crate::model::{Mechanics, StepReport};
use crate::problem::Problem;
use crate::solution::{Cost, Histories, ShownEquilibrium, Warning, WarningCause, WarningKind};
use crate::state::State;

/// Iterations that a mesh which measures the errors of another may take for its own rest, however
/// quickly that other one came to rest. Smaller: errors are measured from meshes that begin at the
/// answer; larger: hard cables beside a robot take longer to solve.
const LEAST_ITERATIONS: usize = 1000;

/// The shape from which an equilibrium was sought.
#[derive(Clone, Copy)]
pub(in crate::model::fem) enum SearchStart {
    /// The first shape of the cable along its route.
    FirstShape,
    /// The shape that it had already.
    PresentState,
}

impl FemModel {
    /// Finds the equilibrium.
    pub(in crate::model::fem) fn find_equilibrium(&mut self) -> Result<StepReport, SolveError> {
        if touches_nothing(&self.problem) {
            return self.equilibrium_without_contact();
        }
        self.elastica_answer = None;
        self.bending_error = None;
        if self.is_broken() {
            return self.stepper.settle(&self.dragged);
        }
        if self.on_smooth_floor {
            return self.equilibrium_on_smooth_floor();
        }
        if let Some(report) = self.elastica_from_flexible() {
            return Ok(report);
        }
        self.stepper.solver.work_left = WorkBudget::Left(self.tuning().equilibrium.max_work);
        let found = self.equilibrium_in_contact();
        self.stepper.solver.work_left = WorkBudget::Unlimited;
        found
    }

    /// Finds the equilibrium of a cable on a floor without friction. On a rubbing floor it is one,
    /// too: where nothing slides, friction is anything up to its limit, and zero will do.
    fn equilibrium_on_smooth_floor(&mut self) -> Result<StepReport, SolveError> {
        let smooth = Arc::new(Problem { floor_friction: None, ..Problem::clone(&self.problem) });
        let mut model = Self::with_tuning(smooth, self.settings, self.tuning().clone())?;
        model.dragged.clone_from(&self.dragged);
        model.starts_from_spans = self.starts_from_spans;
        model.is_comparison = self.is_comparison;
        let mut report = model.settle()?;
        report.warnings.retain(|w| w.kind != WarningKind::NotUnique);
        let shown = ShownEquilibrium::Frictionless;
        let cause = WarningCause::ManyEquilibria { shown, histories: Histories::NotSought };
        report.warnings.push(Warning::new(cause, &self.problem.cable.name, 0.0, [0.0; 2]));
        self.elastica_answer = Some(model.solution());
        Ok(report)
    }

    /// Finds the equilibrium of a cable that can touch nothing. The continuation in EI of a stiff
    /// cable ends where its shape snaps over, as when clamps turn upwards a cable that sags against
    /// them: a relaxed chain of bars follows the snap, as in contact.
    pub(in crate::model::fem) fn equilibrium_without_contact(&mut self) -> Result<StepReport, SolveError> {
        self.make_present(PresentPart::Statics)?;
        self.elastica_answer = None;
        let found = self.statics.settle(&self.dragged);
        let Err(why) = found else { return found };
        if !(self.problem.bending_stiffness > 0.0) || self.make_present(PresentPart::Stepper).is_err() {
            return Err(why);
        }
        match self.elastica_from_flexible() {
            Some(report) => Ok(report),
            None => {
                self.make_present(PresentPart::Statics)?;
                Err(why)
            }
        }
    }

    /// Finds the equilibrium of a cable that can touch something.
    pub(in crate::model::fem) fn equilibrium_in_contact(&mut self) -> Result<StepReport, SolveError> {
        let begins = !self.stepper.rested && self.stepper.cable.time() == 0.0;
        let (start, spans) =
            if begins && self.starts_from_spans { self.start_from_spans() } else { (SpansStart::Unknown, None) };
        if begins && !matches!(start, SpansStart::Accepted(_)) {
            // Easier cables are meant to save work, so together they may do as much as the search
            // itself.
            let mut work = WorkBudget::Left(self.tuning().equilibrium.max_work);
            self.start_from_own_statics(self.tuning().start.eased_loads, &mut work);
        }
        let has_equilibrium = matches!(start, SpansStart::Accepted(_) | SpansStart::Rejected);
        let first = self.stepper.cable.state();
        let before = if has_equilibrium { None } else { Some(self.stepper.clone()) };
        let found = if has_equilibrium { self.stepper.settle(&self.dragged) } else { self.settle_unknown() };
        let found = match start {
            SpansStart::Accepted(warnings) => found.map(|mut report| {
                report.warnings.extend(warnings);
                report
            }),
            SpansStart::Slides(slides) => self.rest_after_slide(found, &first, slides),
            SpansStart::Rejected | SpansStart::Unknown => found,
        };
        let found = if begins { found.or_else(|why| self.rest_from_easier_cable().ok_or(why)) } else { found };
        if let (Err(_), Some(before)) = (&found, before) {
            self.stepper = before;
        }
        let mut report = found?;
        if let Some(cost) = self.elastica_from_mesh() {
            report.cost = Cost { iterations: report.cost.iterations + cost.iterations, ..cost };
            return Ok(report);
        }
        report.warnings.extend(self.coarse_bend_warning());
        self.compare_meshes(spans, if begins { SearchStart::FirstShape } else { SearchStart::PresentState });
        report.warnings.extend(self.coarse_mesh_warning());
        Ok(report)
    }

    /// Settles the mesh of a cable for which no other model has an equilibrium: the unbalanced
    /// forces of its nodes must not add up to a force that moves it.
    pub(in crate::model::fem) fn settle_unknown(&mut self) -> Result<StepReport, SolveError> {
        let report = self.stepper.settle(&self.dragged)?;
        match slides_as_a_whole(&self.stepper.cable) {
            Some(why) => Err(SolveError::NoRestingPlace { why }),
            None => Ok(report),
        }
    }

    /// The equilibrium of a cable that slides from its `first` place: it may rest elsewhere, if it
    /// came down to there and does not slide on.
    pub(in crate::model::fem) fn rest_after_slide(
        &self,
        found: Result<StepReport, SolveError>,
        first: &State,
        slides: SolveError,
    ) -> Result<StepReport, SolveError> {
        let Ok(mut report) = found else { return Err(slides) };
        let answer = self.stepper.solution();
        let comes_down = work(&self.problem, first, &answer, self.stepper.cable.time()) > 0.0;
        if !comes_down || slides_on(&self.problem, self.settings, &answer) {
            return Err(slides);
        }
        report.warnings.push(slid_first(&self.problem, &slides));
        Ok(report)
    }

    /// Estimates the errors of the mesh against the solution of `spans` or another mesh, and
    /// refines it if the scene leaves its number of bars open.
    pub(in crate::model::fem) fn compare_meshes(&mut self, exact: Option<InitialEquilibrium>, start: SearchStart) {
        if self.is_comparison {
            return;
        }
        if self.problem.outline.is_some() {
            let found = match start {
                SearchStart::FirstShape => self.compared_with_own_searches(),
                SearchStart::PresentState => None,
            };
            match found {
                Some(meshes) => self.meshes = meshes,
                None => self.meshes.compare_again(&self.problem, self.settings, &self.stepper, &self.dragged),
            }
            return;
        }
        let refinement = self.refinement();
        let (meshes, stepper) = (&mut self.meshes, &mut self.stepper);
        meshes.compare(&self.problem, self.settings, refinement, stepper, exact, &self.dragged);
    }

    /// Estimates the errors of a cable that was laid beside a robot from meshes of a half and a
    /// quarter of its bars that find their own resting places: slack among a robot, obstacles and
    /// friction comes to rest in many ways, and which of them is found depends on the mesh, too.
    fn compared_with_own_searches(&self) -> Option<TwoMeshes> {
        let bars = self.stepper.cable.meshing.even_bars;
        let coarse = self.at_rest_by_own_search(bars / 2)?;
        let coarsest = self.at_rest_by_own_search(bars / 4);
        Some(TwoMeshes::beside(&self.stepper, coarse, coarsest.as_ref()))
    }

    /// The same cable laid on fewer bars and come to rest, in no more iterations than this one took
    /// or than [`LEAST_ITERATIONS`].
    fn at_rest_by_own_search(&self, bars: usize) -> Option<Stepper> {
        if 2 * bars < LEAST_BARS {
            return None;
        }
        let mut other = self.on_other_bars(bars)?;
        if let WorkBudget::Left(left) = self.stepper.solver.work_left {
            let work = self.tuning().equilibrium.max_work.saturating_sub(left);
            let iterations = work / self.stepper.cable.meshing.even_bars;
            other.limit_work(iterations.max(LEAST_ITERATIONS) * bars);
        }
        other.is_comparison = true;
        other.find_equilibrium().ok()?;
        // The work of the search does not bound the steps that follow.
        other.stepper.solver.work_of_advance = self.stepper.solver.work_of_advance;
        other.stepper.cable.mesh.tuning = self.tuning().clone();
        (other.present == PresentPart::Stepper && other.elastica_answer.is_none()).then_some(other.stepper)
    }

    /// Tells whether the mesh may be refined: whether the scene leaves the number of bars open.
    pub(in crate::model::fem) fn refinement(&self) -> MeshRefinement {
        let given = self.settings.segments.or(self.problem.cable.segments).is_some();
        if given { MeshRefinement::Forbidden } else { MeshRefinement::Allowed }
    }

    /// A warning of a mesh that is too coarse for the tolerance.
    pub(in crate::model::fem) fn coarse_mesh_warning(&self) -> Option<Warning> {
        let (estimate, asked) = (self.meshes.errors.relative(&self.stepper.solution())?, self.settings.tolerance);
        let cause = WarningCause::CoarseForces { elements: self.stepper.cable.meshing.even_bars };
        (estimate > asked).then(|| Warning::new(cause, &self.problem.cable.name, 0.0, [estimate, asked]))
    }
}

//! This module starts the search for an equilibrium in contact from one that is easier to find:
//! that of `spans`, on a coarser mesh, of the cable without obstacles, or of a cable that stretches
//! more or bends more easily.

use std::sync::Arc;

use crate::error::SolveError;
use crate::math::{Vec2, larger};
use crate::model::fem::stepper::Stepper;
use crate::model::fem::system::WorkBudget;
use crate::model::fem::{FemModel, PresentPart};
use crate::model::initial_equilibrium::{InitialEquilibrium, initial_equilibrium};
use crate::model::{Mechanics, Settings, StepReport};
use crate::problem::Problem;
use crate::solution::{CableSolution, Warning};

/// The outcome of starting from the solution of `spans`.
pub(in crate::model::fem) enum SpansStart {
    /// The mesh is in equilibrium there, too; with the warnings about it.
    Accepted(Vec<Warning>),
    /// The mesh is not in equilibrium there and relaxes from its own first shape.
    Rejected,
    /// `spans` has no solution, or was not used.
    Unknown,
    /// The cable slides from its route; with the error that gives the reason.
    Slides(SolveError),
}

/// Parts of its bending stiffness by which a stiff cable is stiffened before it has all of it.
/// Fewer: a heap of slack springs open where it is laid on the next; more: time for cables that are
/// found nowhere.
const STIFFENING_FRACTIONS: [f64; 5] = [0.0, 1e-3, 1e-2, 0.1, 0.3];

/// Least number of bars of the coarse mesh from which a finer one may come to rest; it has up to
/// twice as many. Smaller: shapes of the coarse mesh lie elsewhere among obstacles than those of
/// finer ones; larger: the search on the coarse mesh takes longer.
const COARSEST_BARS: usize = 40;

impl FemModel {
    /// Finds the first equilibrium of a cable that its own search did not find, from that of an
    /// easier one. Returns None, without a change, if there is none.
    pub(in crate::model::fem) fn rest_from_easier_cable(&mut self) -> Option<StepReport> {
        self.rest_by_stiffening().or_else(|| self.rest_from_coarse_mesh())
    }

    /// Finds the first equilibrium from that on a mesh of few bars (nested iteration): slack
    /// travels along the bars in waves, which takes as many steps as there are bars. The coarse
    /// mesh may take as many iterations as this one. Returns None, without a change, if it has no
    /// equilibrium near by or is not coarser.
    fn rest_from_coarse_mesh(&mut self) -> Option<StepReport> {
        let bars = self.stepper.cable.meshing.even_bars;
        let halvings = (bars / COARSEST_BARS).checked_ilog2().filter(|halvings| *halvings > 0)?;
        let max_work = self.tuning().equilibrium.max_work;
        let mut coarse = self.on_other_bars(bars >> halvings)?;
        coarse.is_comparison = true;
        coarse.limit_work(max_work >> halvings);
        let on_coarse = coarse.find_equilibrium().ok()?;
        let mut report = self.rest_from(&coarse.solution(), &mut WorkBudget::Left(max_work))?;
        report.cost.iterations += on_coarse.cost.iterations;
        Some(report)
    }

    /// Comes to rest from the equilibrium of an easier cable; without a change if it does not.
    fn rest_from(&mut self, easier: &CableSolution, work: &mut WorkBudget) -> Option<StepReport> {
        let before = self.stepper.clone();
        self.stepper.rested = false;
        let starts = self.stepper.warm_start_within(easier, before.cable.time(), &self.dragged, work).is_ok();
        // The search that found no rest has spent the work it had.
        self.stepper.solver.work_left = *work;
        let report = if starts { self.settle_unknown().ok() } else { None };
        if report.is_none() {
            self.stepper = before;
        }
        report
    }

    /// Finds the first equilibrium of a stiff cable from that of a flexible one, which is stiffened
    /// in steps. Slack that falls upon a robot, or beside it, comes to rest as a flexible cable;
    /// all of the stiffness at once keeps it from there. Returns None, without a change, where a
    /// step is not found.
    fn rest_by_stiffening(&mut self) -> Option<StepReport> {
        let (whole, time_s) = (self.problem.bending_stiffness, self.stepper.cable.time());
        if !(whole > 0.0) {
            return None;
        }
        let mut work = WorkBudget::Left(self.tuning().equilibrium.max_work);
        let mut softer: Option<CableSolution> = None;
        for part in STIFFENING_FRACTIONS {
            let problem = Problem { bending_stiffness: part * whole, ..Problem::clone(&self.problem) };
            let mut model = self.of_easier_cable(problem, self.settings)?;
            let rests = match &softer {
                None => model.settle().is_ok(),
                Some(softer) => model.stepper.rests_from(softer, time_s, &self.dragged, &mut work),
            };
            softer = rests.then(|| model.solution());
            softer.as_ref()?;
        }
        self.rest_from(&softer?, &mut work)
    }

    /// The model of an easier cable at the same supports; None if there is none.
    fn of_easier_cable(&self, problem: Problem, settings: Settings) -> Option<Self> {
        let model = Self::with_tuning(Arc::new(problem), settings, self.tuning().clone()).ok()?;
        // Nobody reads its errors.
        let dragged = self.dragged.clone();
        let mut model = Self { dragged, present: PresentPart::Stepper, is_comparison: true, ..model };
        if let Some(to) = self.robot_pose {
            model.set_robot_pose(to);
        }
        Some(model)
    }

    /// Starts from the equilibrium of `spans` with the least slide, if it has one: a cable that
    /// relaxes by itself forms folds, which friction then holds. Returns the outcome, and the
    /// solution of `spans` if it belongs to this cable.
    pub(in crate::model::fem) fn start_from_spans(&mut self) -> (SpansStart, Option<InitialEquilibrium>) {
        let first = match initial_equilibrium(&self.problem, self.settings, &self.dragged, self.robot_pose) {
            Ok(Some(first)) => first,
            Ok(None) => return (SpansStart::Unknown, None),
            Err(slides) => return (SpansStart::Slides(slides), None),
        };
        let is_flexible = self.problem.bending_stiffness == 0.0;
        let before = self.stepper.clone();
        let rests =
            self.stepper.warm_start(&first.answer, before.cable.time(), &self.dragged).is_ok() && self.stepper.rested;
        let greatest = first.answer.nodes.iter().map(|n| n.tension_n).fold(0.0, larger);
        let found = self.stepper.solution();
        let pairs = first.answer.supports.iter().zip(&found.supports);
        let change = pairs.map(|(a, b)| (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n));
        let tuning = self.tuning().start;
        let most =
            if self.problem.bending_stiffness > 0.0 { tuning.max_stiff_force_change } else { tuning.max_force_change };
        // The weight of a bar is on its two nodes: forces on supports differ by up to half of it.
        let lumped = 0.5 * self.problem.body_force(0.0).norm() * self.stepper.cable.even();
        let outcome = if rests && change.fold(0.0, larger) <= most * greatest + lumped {
            SpansStart::Accepted(first.warnings.clone())
        } else {
            self.stepper = before;
            SpansStart::Rejected
        };
        (outcome, is_flexible.then_some(first))
    }

    /// Starts from the equilibrium of an easier cable: on a coarser mesh (nested iteration),
    /// because slack travels along the bars in waves and relaxation takes as many steps as there
    /// are bars; and with less axial stiffness (continuation), because the search with nearly
    /// inextensible bars is ill-conditioned although the equilibrium hardly differs. That search
    /// may itself start from an easier one. Cables with an axial stiffness below `eased_loads`, in
    /// whole loads, are not eased like this. All searches share the `work`.
    pub(in crate::model::fem) fn start_from_easier_cable(&mut self, eased_loads: f64, work: &mut WorkBudget) {
        let fine = self.settings.segments.or(self.problem.cable.segments).unwrap_or(0);
        let start = self.tuning().start;
        let segments = if fine > start.two_mesh_bars { Some(fine / start.mesh_ratio) } else { self.settings.segments };
        let (own, load) = (self.problem.axial_stiffness, self.problem.whole_load());
        let is_eased = load > 0.0 && own >= eased_loads * load;
        let axial_stiffness = if is_eased { own / start.stiffness_ratio } else { own };
        if segments == self.settings.segments && axial_stiffness == own {
            return;
        }
        let problem = Problem { axial_stiffness, ..Problem::clone(&self.problem) };
        let settings = Settings { segments, ..self.settings };
        let Some(mut easier) = self.of_easier_cable(problem, settings) else { return };
        easier.stepper.cable.meshing.slides = self.stepper.cable.meshing.slides;
        easier.start_from_own_statics(start.stiffness_ratio * start.softest_loads, work);
        easier.stepper.solver.work_left = *work;
        let found = easier.settle_unknown();
        *work = easier.stepper.solver.work_left;
        if found.is_err() {
            return;
        }
        let before = self.stepper.clone();
        let time_s = before.cable.time();
        let started = self.stepper.warm_start_within(&easier.solution(), time_s, &self.dragged, work);
        if started.is_err() {
            self.stepper = before;
        }
    }

    /// Starts from the equilibrium without obstacles, and then from that of an easier cable.
    pub(in crate::model::fem) fn start_from_own_statics(&mut self, eased_loads: f64, work: &mut WorkBudget) {
        if self.statics.settle(&self.dragged).is_ok() {
            self.stepper.start_from_shape(&self.statics.state(), &self.dragged);
        }
        self.start_from_easier_cable(eased_loads, work);
    }
}

impl Stepper {
    /// As [`Self::warm_start`], with all the `work` that is left.
    ///
    /// # Errors
    /// As `warm_start`.
    fn warm_start_within(
        &mut self,
        answer: &CableSolution,
        time_s: f64,
        dragged: &[Option<Vec2>],
        work: &mut WorkBudget,
    ) -> Result<(), SolveError> {
        let own = std::mem::replace(&mut self.solver.work_left, *work);
        let started = self.warm_start(answer, time_s, dragged);
        *work = std::mem::replace(&mut self.solver.work_left, own);
        started
    }

    /// Starts from an answer with all the `work` that is left; returns whether the cable comes to
    /// rest.
    fn rests_from(
        &mut self,
        answer: &CableSolution,
        time_s: f64,
        dragged: &[Option<Vec2>],
        work: &mut WorkBudget,
    ) -> bool {
        self.warm_start_within(answer, time_s, dragged, work).is_ok() && self.rested
    }
}

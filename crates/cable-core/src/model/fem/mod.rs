//! `fem` is the finite element model of a cable: contact, friction, bending, equilibrium and
//! motion.
//!
//! | room | what it holds |
//! |---|---|
//! | `state` | the state of the cable (`state/cable_state.rs`) and its parts, and the setup of a step |
//! | `dynamics` | advances that state: one step with inertia, halvings, reports |
//! | `free`, `elastica` | equilibrium of a cable that touches nothing but its supports; of a stiff one in contact |
//! | `equilibrium` | equilibria in contact, and steps without inertia |
//! | `time` | BDF2, step sizes, sleep, hands, momentum, checkpoints |
//! | `newton` | one step: the choice of its solver, its Newton iterations, and what bounds them |
//! | `system` | input and energies of a step: value, gradient and banded Hessian; contacts in `system/contact` |
//! | `mesh`, `remesh` | nodes, bars, sliding nodes and paths round corners; changes of nodes between steps |
//! | `obstacle` | the robot's outline; does the cable run through an obstacle? |
//! | `first_shape` | the first shape: along the route, clear of obstacles |
//! | `transfer` | states and answers of other meshes and models |
//! | `results`, `mesh_error` | the answer of a state, and its errors |
//! | `settings` | the tuned constants |
//!
//! [`FemModel`] decides which part answers, and hands the state over when the question changes.

mod dynamics;
mod elastica;
mod equilibrium;
mod first_shape;
mod free;
mod mesh;
mod mesh_error;
pub(in crate::model) mod newton;
mod obstacle;
mod remesh;
mod results;
pub mod settings;
mod state;
pub(crate) mod system;
#[cfg(test)]
mod tests;
mod time;
mod transfer;

use std::sync::Arc;

use crate::error::SolveError;
use crate::math::RigidPose;
use crate::math::{Vec2, larger};
use crate::model::fem::equilibrium::slides_as_a_whole;
use crate::model::fem::mesh_error::{Refinement, TwoMeshes};
use crate::model::fem::obstacle::{outline_report, place_outline};
use crate::model::fem::settings::Tuning;
use crate::model::fem::system::WorkBudget;
use crate::model::gauge::TensionGauge;
use crate::model::initial_equilibrium::{InitialEquilibrium, initial_equilibrium, slid_first, slides_on, work};
use crate::model::{Inertia, Mechanics, Model, OwnedResources, RobotContact, Settings, StepReport};
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::ErrorEstimates;
use crate::solution::{CableSolution, Cost, Node, ShownEquilibrium, Warning, WarningCause};
use crate::state::State;
use elastica::Elastica;

/// The outcome of starting from the solution of `spans`.
enum SpansStart {
    /// The mesh rests in it, too; with the warnings about it.
    Accepted(Vec<Warning>),
    /// The mesh does not rest in it and relaxes from its own first shape.
    Rejected,
    /// `spans` has no solution, or was not asked.
    Unknown,
    /// The cable slides from its route: the error that says why.
    Slides(SolveError),
}

/// The error estimate of a stiff cable's equilibrium must stay below this part of the tolerance.
const STIFF_ESTIMATE_FRACTION: f64 = 0.5;

/// A stiff cable's equilibrium may differ from that of its mesh by this part of the cable's length.
/// Smaller: the equilibrium of coarse meshes is not replaced; larger: another equilibrium is taken
/// for the same.
const STIFF_SHIFT_LIMIT: f64 = 0.05;

/// The part that holds the present state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Statics,
    Dynamics,
}

/// The model's mechanics of one cable.
#[derive(Clone, Debug)]
pub struct FemModel {
    problem: Arc<Problem>,
    /// Points to which supports were dragged by hand, m.
    dragged: Vec<Option<Vec2>>,
    statics: free::Statics,
    dynamics: dynamics::Dynamics,
    present: Part,
    /// True if the search for a first equilibrium in contact starts from that of `spans`.
    starts_from_spans: bool,
    settings: Settings,
    /// The estimate of the error in contact by another mesh.
    meshes: TwoMeshes,
    /// Pose to which the outline of the robot was moved.
    robot_pose: Option<RigidPose>,
    /// The equilibrium of a stiff cable in contact as an elastica, until something moves.
    elastica_answer: Option<CableSolution>,
    /// Error of the mesh's equilibrium of a stiff cable by the bend that it leaves out, in parts of
    /// the greatest tension, until something moves.
    bending_error: Option<f64>,
}

impl FemModel {
    /// Builds it at the route.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs what the model lacks.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        Self::with_tuning(problem, settings, Arc::default())
    }

    /// The same with other tuned constants.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_tuning(problem: Arc<Problem>, settings: Settings, tuning: Arc<Tuning>) -> Result<Self, SolveError> {
        let statics = free::Statics::new(problem.clone(), settings)?;
        let dynamics = dynamics::Dynamics::new(problem.clone(), settings, tuning)?;
        let present = if touches_nothing(&problem) { Part::Statics } else { Part::Dynamics };
        Ok(Self {
            dragged: vec![None; problem.supports.len()],
            statics,
            dynamics,
            present,
            starts_from_spans: true,
            meshes: TwoMeshes::default(),
            settings,
            robot_pose: problem.outline.as_ref().map(|o| o.placement),
            elastica_answer: None,
            bending_error: None,
            problem,
        })
    }

    /// The tuned constants by which it is solved.
    fn tuning(&self) -> &Arc<Tuning> {
        &self.dynamics.cable.mesh.tuning
    }

    /// Starts from the equilibrium of `spans` with the least sliding, if it has one: a cable that
    /// relaxes by itself comes to lie in folds, which friction then holds. Returns the outcome, and
    /// the solution of `spans` where it is one of this cable.
    fn start_from_spans(&mut self) -> (SpansStart, Option<InitialEquilibrium>) {
        let first = match initial_equilibrium(&self.problem, self.settings, &self.dragged, self.robot_pose) {
            Ok(Some(first)) => first,
            Ok(None) => return (SpansStart::Unknown, None),
            Err(slides) => return (SpansStart::Slides(slides), None),
        };
        let is_flexible = self.problem.bending_stiffness == 0.0;
        let before = self.dynamics.clone();
        let rests =
            self.dynamics.warm_start(&first.answer, before.cable.time(), &self.dragged).is_ok() && self.dynamics.rested;
        let greatest = first.answer.nodes.iter().map(|n| n.tension_n).fold(0.0, larger);
        let found = self.dynamics.solution();
        let pairs = first.answer.supports.iter().zip(&found.supports);
        let change = pairs.map(|(a, b)| (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n));
        let tuning = self.tuning().start;
        let most =
            if self.problem.bending_stiffness > 0.0 { tuning.max_stiff_force_change } else { tuning.max_force_change };
        let outcome = if rests && change.fold(0.0, larger) <= most * greatest {
            SpansStart::Accepted(first.warnings.clone())
        } else {
            self.dynamics = before;
            SpansStart::Rejected
        };
        (outcome, is_flexible.then_some(first))
    }

    /// Finds the equilibrium.
    fn find_equilibrium(&mut self) -> Result<StepReport, SolveError> {
        if touches_nothing(&self.problem) {
            return self.equilibrium_without_contact();
        }
        self.elastica_answer = None;
        self.bending_error = None;
        if let Some(report) = self.elastica_from_flexible() {
            return Ok(report);
        }
        self.dynamics.solver.work_left = WorkBudget::Left(self.tuning().equilibrium.max_work);
        let found = self.equilibrium_in_contact();
        self.dynamics.solver.work_left = WorkBudget::Unlimited;
        found
    }

    /// A warning of the other equilibria of a stiff cable that is compressed: it may bow to another
    /// side.
    fn bow_warning(&self) -> Option<Warning> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let free = || {
            let mut statics = self.statics.clone();
            if self.present == Part::Dynamics || self.elastica_answer.is_some() {
                // Without an answer it has no shapes, either.
                let _ = statics.settle(&self.dragged);
            }
            statics.buckled_shapes()
        };
        let histories =
            elastica::other_equilibria(&self.problem, self.time_s(), &self.dragged, &self.solution(), free)?;
        let cause = WarningCause::ManyEquilibria { shown: ShownEquilibrium::FromRoute, histories };
        Some(Warning::new(cause, &self.problem.cable.name, 0.0, [0.0; 2]))
    }

    /// Finds the equilibrium of a cable that can touch nothing. The continuation of a stiff cable
    /// up in EI ends where its shape snaps over, as clamps against which it sags turn it upwards: a
    /// chain of bars that is let go follows it there, as it does in contact.
    fn equilibrium_without_contact(&mut self) -> Result<StepReport, SolveError> {
        self.make_present(Part::Statics)?;
        self.elastica_answer = None;
        let found = self.statics.settle(&self.dragged);
        let Err(why) = found else { return found };
        if !(self.problem.bending_stiffness > 0.0) || self.make_present(Part::Dynamics).is_err() {
            return Err(why);
        }
        match self.elastica_from_flexible() {
            Some(report) => Ok(report),
            None => {
                self.make_present(Part::Statics)?;
                Err(why)
            }
        }
    }

    /// Finds the equilibrium of a cable that can touch something.
    fn equilibrium_in_contact(&mut self) -> Result<StepReport, SolveError> {
        let begins = !self.dynamics.rested && self.dynamics.cable.time() == 0.0;
        let (start, spans) =
            if begins && self.starts_from_spans { self.start_from_spans() } else { (SpansStart::Unknown, None) };
        if begins && !matches!(start, SpansStart::Accepted(_)) {
            // Easier cables are to save work: together they may do as much as the search itself.
            let mut work = WorkBudget::Left(self.tuning().equilibrium.max_work);
            self.start_from_own_statics(self.tuning().start.eased_loads, &mut work);
        }
        let has_equilibrium = matches!(start, SpansStart::Accepted(_) | SpansStart::Rejected);
        let first = self.dynamics.cable.state();
        let before = if has_equilibrium { None } else { Some(self.dynamics.clone()) };
        let found = self.settle_dynamics(has_equilibrium);
        let found = match start {
            SpansStart::Accepted(warnings) => found.map(|mut report| {
                report.warnings.extend(warnings);
                report
            }),
            SpansStart::Slides(slides) => self.rest_after_slide(found, &first, slides),
            SpansStart::Rejected | SpansStart::Unknown => found,
        };
        if let (Err(_), Some(before)) = (&found, before) {
            self.dynamics = before;
        }
        let mut report = found?;
        if let Some(cost) = self.elastica_from_mesh() {
            report.cost = Cost { iterations: report.cost.iterations + cost.iterations, ..cost };
            return Ok(report);
        }
        report.warnings.extend(self.coarse_bend_warning());
        self.compare_meshes(spans);
        report.warnings.extend(self.coarse_mesh_warning());
        Ok(report)
    }

    /// Settles the mesh. If no other model `has_equilibrium` for the cable, what its nodes leave
    /// unbalanced must not add up to a force that moves it.
    fn settle_dynamics(&mut self, has_equilibrium: bool) -> Result<StepReport, SolveError> {
        let report = self.dynamics.settle(&self.dragged)?;
        match if has_equilibrium { None } else { slides_as_a_whole(&self.dynamics.cable) } {
            Some(why) => Err(SolveError::NoRestingPlace { why }),
            None => Ok(report),
        }
    }

    /// The rest of a cable that slides from its `first` place: it may rest elsewhere, if it came
    /// down to there and does not slide on.
    fn rest_after_slide(
        &self,
        found: Result<StepReport, SolveError>,
        first: &State,
        slides: SolveError,
    ) -> Result<StepReport, SolveError> {
        let Ok(mut report) = found else { return Err(slides) };
        let answer = self.dynamics.solution();
        let comes_down = work(&self.problem, first, &answer, self.dynamics.cable.time()) > 0.0;
        if !comes_down || slides_on(&self.problem, self.settings, &answer) {
            return Err(slides);
        }
        report.warnings.push(slid_first(&self.problem, &slides));
        Ok(report)
    }

    /// A warning of the bend of a stiff cable that the mesh leaves out, where that is more than was
    /// asked for.
    fn coarse_bend_warning(&mut self) -> Option<Warning> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let (off, s) = results::bending_error(&self.dynamics.cable);
        self.bending_error = Some(off);
        let limit = self.settings.tolerance;
        if off <= limit {
            return None;
        }
        let cause = WarningCause::CoarseBend { bars: self.dynamics.cable.meshing.even_bars };
        Some(Warning::new(cause, &self.problem.cable.name, s, [off, limit]))
    }

    /// Starts from the equilibrium of a cable whose equilibrium is found more easily: on a coarser
    /// mesh (nested iteration), as slack runs along the bars in waves, in as many steps of
    /// relaxation as there are bars; and of less axial stiffness (continuation), as the search
    /// among bars that hardly stretch is ill-conditioned, and where they rest is hardly another
    /// place. That one may begin at one that is easier still. Of cables of less than `eased_loads`
    /// axial stiffness, in whole loads, the search is not made easier so. All of them share the
    /// `work`.
    fn start_from_easier_cable(&mut self, eased_loads: f64, work: &mut WorkBudget) {
        let fine = self.settings.segments.or(self.problem.cable.segments).unwrap_or(0);
        let tuning = self.tuning().clone();
        let segments = if fine > tuning.start.two_mesh_bars {
            Some(fine / tuning.start.mesh_ratio)
        } else {
            self.settings.segments
        };
        let (own, load, start) = (self.problem.axial_stiffness, self.problem.whole_load(), tuning.start);
        let is_eased = load > 0.0 && own >= eased_loads * load;
        let axial_stiffness = if is_eased { own / start.stiffness_ratio } else { own };
        if segments == self.settings.segments && axial_stiffness == own {
            return;
        }
        let problem = Problem { axial_stiffness, ..Problem::clone(&self.problem) };
        let settings = Settings { segments, ..self.settings };
        let Ok(easier) = Self::with_tuning(Arc::new(problem), settings, tuning.clone()) else { return };
        let mut easier = Self { dragged: self.dragged.clone(), present: Part::Dynamics, ..easier };
        if let Some(to) = self.robot_pose {
            easier.set_robot_pose(to);
        }
        easier.dynamics.cable.meshing.slides = self.dynamics.cable.meshing.slides;
        easier.start_from_own_statics(start.stiffness_ratio * start.softest_loads, work);
        easier.dynamics.solver.work_left = *work;
        let found = easier.settle_dynamics(false);
        *work = easier.dynamics.solver.work_left;
        if found.is_err() {
            return;
        }
        let before = self.dynamics.clone();
        let time_s = before.cable.time();
        let own = std::mem::replace(&mut self.dynamics.solver.work_left, *work);
        let started = self.dynamics.warm_start(&easier.solution(), time_s, &self.dragged);
        *work = std::mem::replace(&mut self.dynamics.solver.work_left, own);
        if started.is_err() {
            self.dynamics = before;
        }
    }

    /// Starts where the cable would rest among no obstacles, and then where one rests that is
    /// solved more easily.
    fn start_from_own_statics(&mut self, eased_loads: f64, work: &mut WorkBudget) {
        if self.statics.settle(&self.dragged).is_ok() {
            self.dynamics.start_from_shape(&self.statics.state(), &self.dragged);
        }
        self.start_from_easier_cable(eased_loads, work);
    }

    /// Finds the equilibrium of a stiff cable as an elastica, from that of a flexible one; None
    /// where there is none.
    fn elastica_from_flexible(&mut self) -> Option<StepReport> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let lay = initial_equilibrium(&self.problem, self.settings, &self.dragged, self.robot_pose).ok()?;
        let (time_s, tolerance) = (self.dynamics.cable.time(), STIFF_ESTIMATE_FRACTION * self.settings.tolerance);
        let flexible = lay.as_ref().map(|l| &l.answer);
        let (answer, cost) = elastica::rest(&self.problem, time_s, &self.dragged, flexible, tolerance)?;
        self.elastica_answer = Some(answer);
        let mut warnings = lay.map_or_else(Vec::new, |l| l.warnings);
        warnings.extend(self.elastica_warning());
        Some(StepReport { cost, warnings })
    }

    /// The same from the equilibrium that the mesh has found.
    fn elastica_from_mesh(&mut self) -> Option<Cost> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let answer = self.dynamics.solution();
        let bar = self.dynamics.cable.even();
        let found = Elastica::from_mesh(&self.problem, self.dynamics.cable.time(), &self.dragged, &answer, bar)?;
        let cost = self.accept_elastica(found)?;
        // A shape that differs by more than the error of a mesh is another equilibrium.
        let near = |n: &Node| {
            let at =
                self.elastica_answer.as_ref().and_then(|b| State::of_nodes(&b.nodes, 0.0).position_at(n.arc_length_m));
            at.is_some_and(|at| (at - n.at()).norm() <= STIFF_SHIFT_LIMIT * self.problem.length)
        };
        if !answer.nodes.iter().all(near) {
            self.elastica_answer = None;
            return None;
        }
        Some(cost)
    }

    /// A warning of a stiff cable's equilibrium whose error is more than was asked for.
    fn elastica_warning(&self) -> Option<Warning> {
        let (estimate, asked) = (self.elastica_answer.as_ref()?.error_estimate?, self.settings.tolerance);
        let cause = WarningCause::BarContacts;
        (estimate > asked).then(|| Warning::new(cause, &self.problem.cable.name, 0.0, [estimate, asked]))
    }

    /// Raises an elastica to the whole stiffness and refines it; keeps its answer.
    fn accept_elastica(&mut self, mut found: Elastica) -> Option<Cost> {
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

    /// The same without sliding nodes at corners and posts: every node stays with its material. For
    /// models that take over its nodes.
    #[must_use]
    pub fn with_material_nodes(mut self) -> Self {
        self.dynamics.cable.meshing.slides = false;
        self
    }

    /// The same cable on bars half as long, laid anew, where their number is open and the mesh gave
    /// the first answer.
    fn on_finer_mesh(&self) -> Option<Self> {
        let bars = 2 * self.dynamics.cable.meshing.even_bars;
        let given = self.settings.segments.or(self.problem.cable.segments).is_some();
        let by_mesh = self.present == Part::Dynamics && self.elastica_answer.is_none() && self.time_s() <= 0.0;
        if given || !by_mesh || bars > self.tuning().start.max_refined_bars {
            return None;
        }
        let settings = Settings { segments: Some(bars), ..self.settings };
        let mut finer = Self::with_tuning(self.problem.clone(), settings, self.tuning().clone()).ok()?;
        finer.starts_from_spans = self.starts_from_spans;
        finer.dragged.clone_from(&self.dragged);
        finer.dynamics.hand_drive.pulled.clone_from(&self.dynamics.hand_drive.pulled);
        finer.dynamics.cable.meshing.slides = self.dynamics.cable.meshing.slides;
        if let Some(pose) = self.robot_pose {
            finer.set_robot_pose(pose);
        }
        Some(finer)
    }

    /// A copy to go back to. Its obstacles are those of the scene: the ones among which the outline
    /// of the robot is moved stay with this model.
    pub(super) fn copy_for_rollback(&self) -> Self {
        let mut copy = self.clone();
        copy.dynamics.cable.problem = self.problem.clone();
        copy
    }

    /// Estimates the errors of the mesh beside the solution of `spans` or another mesh, and refines
    /// it where the scene leaves its number of bars open.
    fn compare_meshes(&mut self, exact: Option<InitialEquilibrium>) {
        let given = self.settings.segments.or(self.problem.cable.segments).is_some();
        let refinement = if given { Refinement::Forbidden } else { Refinement::Allowed };
        let (meshes, dynamics) = (&mut self.meshes, &mut self.dynamics);
        meshes.compare(&self.problem, self.settings, refinement, dynamics, exact, &self.dragged);
    }

    /// A warning of a mesh that is coarser than the tolerance asks for.
    fn coarse_mesh_warning(&self) -> Option<Warning> {
        let (estimate, asked) = (self.meshes.errors.relative(&self.dynamics.solution())?, self.settings.tolerance);
        let cause = WarningCause::CoarseForces { elements: self.dynamics.cable.meshing.even_bars };
        (estimate > asked).then(|| Warning::new(cause, &self.problem.cable.name, 0.0, [estimate, asked]))
    }

    /// Makes `part` the one that holds the present state.
    fn make_present(&mut self, part: Part) -> Result<(), SolveError> {
        if self.present != part {
            match part {
                Part::Statics => self.statics.set_state(&self.dynamics.cable.state())?,
                Part::Dynamics => {
                    self.dynamics.set_state(&self.statics.state())?;
                    self.dynamics.come_to_rest(&self.dragged);
                }
            }
            self.present = part;
        }
        Ok(())
    }
}

/// True if the cable can touch nothing but its supports.
fn touches_nothing(problem: &Problem) -> bool {
    problem.world.is_empty()
        && problem.outline.is_none()
        && problem.floor_friction.is_none()
        && !problem.cable.self_contact
        && !(problem.bending_stiffness > 0.0 && problem.supports.iter().any(|s| s.kind == SupportKind::Pulley))
}

impl Mechanics for FemModel {
    fn model(&self) -> Model {
        Model::Fem
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        let mut report = self.find_equilibrium()?;
        report.warnings.extend(self.bow_warning());
        Ok(report)
    }

    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return Err(SolveError::TimeStep { dt_s, longest_s: f64::INFINITY });
        }
        if inertia == Inertia::QuasiStatic && touches_nothing(&self.problem) && self.elastica_answer.is_none() {
            self.make_present(Part::Statics)?;
            self.statics.advance(dt_s, &self.dragged)
        } else {
            self.make_present(Part::Dynamics)?;
            self.bending_error = None;
            if let Some(answer) = self.elastica_answer.take() {
                self.dynamics.warm_start(&answer, self.dynamics.cable.time(), &self.dragged)?;
            }
            let mut report = self.dynamics.advance_gauged(dt_s, inertia, &self.dragged, gauge)?;
            self.meshes.follow(&self.problem, self.settings, &self.dynamics, dt_s, inertia, &self.dragged);
            let may_bend_over = !touches_nothing(&self.problem) || self.dynamics.cable.mesh.slides_anywhere();
            match if may_bend_over { self.coarse_bend_warning() } else { None } {
                Some(warning) => report.warnings.push(warning),
                // An error below the tolerance says nothing about the other errors of a step.
                None => self.bending_error = None,
            }
            Ok(report)
        }
    }

    fn state(&self) -> State {
        if let Some(answer) = &self.elastica_answer {
            return State::of_nodes(&answer.nodes, self.dynamics.cable.time());
        }
        match self.present {
            Part::Statics => self.statics.state(),
            Part::Dynamics => self.dynamics.cable.state(),
        }
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.meshes = TwoMeshes::default();
        self.elastica_answer = None;
        self.bending_error = None;
        // Statics has no velocities: what moves is taken over by the part that can move.
        if self.present == Part::Statics && state.moves() {
            self.dynamics.set_state(state)?;
            self.present = Part::Dynamics;
            return Ok(());
        }
        match self.present {
            Part::Statics => self.statics.set_state(state),
            Part::Dynamics => self.dynamics.set_state(state),
        }
    }

    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        self.elastica_answer = None;
        self.bending_error = None;
        match self.present {
            Part::Statics => self.set_state(&State::of_nodes(&answer.nodes, time_s)),
            Part::Dynamics => {
                self.meshes = TwoMeshes::default();
                self.dynamics.warm_start(answer, time_s, &self.dragged)
            }
        }
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        if let (Some(d), Some(pulled)) =
            (self.dragged.get_mut(support), self.dynamics.hand_drive.pulled.get_mut(support))
        {
            (*d, *pulled) = (Some(target_m), false);
        }
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.drag_support(support, hand_m);
        let kind = self.problem.supports.get(support).map(|s| s.kind);
        if let Some(pulled) = self.dynamics.hand_drive.pulled.get_mut(support) {
            *pulled = matches!(kind, Some(SupportKind::Fixed | SupportKind::Clamped));
        }
    }

    fn set_robot_pose(&mut self, to: RigidPose) {
        self.robot_pose = Some(to);
        if let Some(outline) = &mut self.dynamics.cable.outline {
            outline.lead_to(to);
        }
    }

    fn limit_work(&mut self, work: usize) {
        self.dynamics.solver.work_of_advance = WorkBudget::Left(work);
        let most = &mut Arc::make_mut(&mut self.dynamics.cable.mesh.tuning).equilibrium.max_work;
        *most = work.min(*most);
    }

    fn start_without_spans(&mut self) {
        self.starts_from_spans = false;
    }

    fn fall_back(&mut self, why: &SolveError) -> bool {
        let finer = if matches!(why, SolveError::Unsound { .. }) { self.on_finer_mesh() } else { None };
        let found = finer.is_some();
        if let Some(finer) = finer {
            *self = finer;
        }
        found
    }

    fn robot_contact(&self) -> Option<RobotContact> {
        outline_report(&self.dynamics.cable)
    }

    fn solution(&self) -> CableSolution {
        if let Some(answer) = &self.elastica_answer {
            return answer.clone();
        }
        match self.present {
            Part::Statics => self.statics.solution(),
            Part::Dynamics => {
                let answer = self.dynamics.solution();
                let meshes = self.meshes.errors;
                let estimates = [self.bending_error, meshes.relative(&answer)].into_iter().flatten();
                let errors = match self.bending_error {
                    Some(part) => meshes.plus(&ErrorEstimates::of_forces(&answer, Some(part))),
                    None => meshes,
                };
                CableSolution { error_estimate: estimates.reduce(larger), errors, ..answer }
            }
        }
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    fn inner_step_s(&self) -> f64 {
        self.dynamics.time_control.step_size.longest_step()
    }

    fn copy_to_keep(&self) -> Box<dyn Mechanics> {
        Box::new(self.copy_for_rollback())
    }

    fn lend(&mut self) -> Option<OwnedResources> {
        Some(OwnedResources {
            memory: self.dynamics.solver.memory.0.take().map(|memory| memory as Box<dyn std::any::Any + Send>),
            problem: self.dynamics.cable.problem.clone(),
        })
    }

    fn borrow(&mut self, own: Option<OwnedResources>) {
        let own =
            own.unwrap_or_else(|| OwnedResources { memory: None, problem: state::with_outline(self.problem.clone()) });
        self.dynamics.solver.memory.0 = own.memory.and_then(|memory| memory.downcast().ok());
        self.dynamics.cable.problem = own.problem;
        place_outline(&mut self.dynamics.cable);
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

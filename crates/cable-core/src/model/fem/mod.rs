//! `fem` is the finite element model of a cable: contact, friction, bending, equilibrium and
//! motion.
//!
//! | room | what it holds |
//! |---|---|
//! | `state` | the state of the cable (`state/cable_state.rs`) and its parts, and the setup of a step |
//! | `stepper` | takes implicit steps from that state: one with inertia, halvings, reports |
//! | `free`, `elastica` | equilibrium of a cable that touches nothing but its supports; of a stiff one in contact |
//! | `equilibrium` | equilibria in contact, and steps without inertia |
//! | `time` | BDF2, step sizes, sleep, hands, momentum, checkpoints |
//! | `newton` | one step: the choice of its solver, its Newton iterations, and what bounds them |
//! | `system` | input and energies of a step: value, gradient and banded Hessian; contacts in `system/contact` |
//! | `mesh`, `remesh` | nodes, bars, sliding nodes and paths round corners; changes of nodes between steps |
//! | `obstacle` | can the cable touch anything? does it run through an obstacle? the robot's outline and posts that move |
//! | `first_shape` | the first shape: along the route, clear of obstacles |
//! | `transfer` | states and answers of other meshes and models |
//! | `results` | the answer of a state |
//! | `equilibrium_search` | the search for an equilibrium: choice of solver, start and mesh |
//! | `settings` | the tuned constants |
//!
//! [`FemModel`] decides which part answers, and passes the state to another part when the question
//! changes.

mod elastica;
mod equilibrium;
mod equilibrium_search;
mod first_shape;
mod free;
mod mesh;
pub(in crate::model) mod newton;
mod obstacle;
mod remesh;
mod results;
mod settings;
mod state;
mod stepper;
pub(crate) mod system;
#[cfg(test)]
mod tests;
mod time;
mod transfer;

use std::any::Any;
use std::sync::Arc;

use crate::error::SolveError;
use crate::math::{RigidPose, Vec2, larger};
use crate::model::fem::equilibrium_search::{MeshRefinement, TwoMeshes};
use crate::model::fem::obstacle::touches_nothing;
use crate::model::fem::obstacle::{outline_report, place_bodies};
use crate::model::fem::remesh::break_cable;
use crate::model::fem::state::stored_energy;
use crate::model::fem::system::WorkBudget;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{BreakPlace, Inertia, Mechanics, Model, OwnedResources, RobotContact, Settings, StepReport};
use crate::problem::{Problem, SupportPoint};
use crate::scene::SupportKind;
use crate::solution::{CableSolution, Energy, ErrorEstimates, SupportReaction};
use crate::state::State;

pub use crate::model::fem::settings::Tuning;

/// The part that holds the present state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PresentPart {
    Statics,
    Stepper,
}

/// The memory of a model from which it goes on after an edit of the scene.
struct Continuation {
    stepper: stepper::Stepper,
    errors: ErrorEstimates,
}

/// The finite element model of one cable.
#[derive(Clone, Debug)]
pub struct FemModel {
    problem: Arc<Problem>,
    /// Points to which supports were dragged by hand, m.
    dragged: Vec<Option<Vec2>>,
    statics: free::Statics,
    stepper: stepper::Stepper,
    present: PresentPart,
    /// True if the search for a first equilibrium in contact starts from that of `spans`.
    starts_from_spans: bool,
    settings: Settings,
    /// The estimate of the error in contact by another mesh.
    meshes: TwoMeshes,
    /// Pose to which the outline of the robot was moved.
    robot_pose: Option<RigidPose>,
    /// The equilibrium of a stiff cable in contact as an elastica, or of a cable on a smooth floor
    /// that stands for that on the rubbing one, until something moves.
    elastica_answer: Option<CableSolution>,
    /// True if the first equilibrium on a rubbing floor is that on a smooth floor.
    on_smooth_floor: bool,
    /// True if it measures the errors of another: it needs none of its own.
    is_comparison: bool,
    /// Error of the mesh's equilibrium of a stiff cable by neglected bending, relative to the
    /// greatest tension, until something moves.
    bending_error: Option<f64>,
}

impl FemModel {
    /// Builds the cable along its route.
    ///
    /// # Errors `Unsupported` if the scene needs a feature that the model lacks.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        Self::with_tuning(problem, settings, Arc::default())
    }

    /// As [`Self::new`], with other tuned constants.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_tuning(problem: Arc<Problem>, settings: Settings, tuning: Arc<Tuning>) -> Result<Self, SolveError> {
        let statics = free::Statics::new(problem.clone(), settings)?;
        let stepper = stepper::Stepper::new(problem.clone(), settings, tuning)?;
        let present = if touches_nothing(&problem) { PresentPart::Statics } else { PresentPart::Stepper };
        Ok(Self {
            dragged: vec![None; problem.supports.len()],
            statics,
            stepper,
            present,
            starts_from_spans: true,
            meshes: TwoMeshes::default(),
            settings,
            robot_pose: problem.outline.as_ref().map(|o| o.placement),
            elastica_answer: None,
            on_smooth_floor: false,
            is_comparison: false,
            bending_error: None,
            problem,
        })
    }

    /// The tuned constants with which it is solved.
    fn tuning(&self) -> &Arc<Tuning> {
        &self.stepper.cable.mesh.tuning
    }

    /// True if the cable is broken: no other solver and no other model knows its pieces.
    pub(in crate::model) fn is_broken(&self) -> bool {
        self.stepper.cable.mesh.breaks().next().is_some()
    }

    /// Removes the sliding nodes at corners and posts, so that every node moves with its material:
    /// for models that take over its nodes.
    #[must_use]
    pub(in crate::model) fn with_material_nodes(mut self) -> Self {
        self.stepper.cable.meshing.slides = false;
        self
    }

    /// The same cable on bars half as long, laid along its route, if the scene leaves their number
    /// open and the mesh gave the first answer.
    fn on_finer_mesh(&self) -> Option<Self> {
        let bars = 2 * self.stepper.cable.meshing.even_bars;
        let by_mesh = self.present == PresentPart::Stepper && self.elastica_answer.is_none() && self.time_s() <= 0.0;
        if self.refinement() == MeshRefinement::Forbidden || !by_mesh || bars > self.tuning().start.max_refined_bars {
            return None;
        }
        self.on_other_bars(bars)
    }

    /// The same cable laid along its route on another number of bars; None if there is none.
    pub(in crate::model::fem) fn on_other_bars(&self, bars: usize) -> Option<Self> {
        let settings = Settings { segments: Some(bars), ..self.settings };
        let mut other = Self::with_tuning(self.problem.clone(), settings, self.tuning().clone()).ok()?;
        other.starts_from_spans = self.starts_from_spans;
        other.dragged.clone_from(&self.dragged);
        other.stepper.hand_drive.pulled.clone_from(&self.stepper.hand_drive.pulled);
        other.stepper.cable.meshing.slides = self.stepper.cable.meshing.slides;
        if let Some(pose) = self.robot_pose {
            other.set_robot_pose(pose);
        }
        Some(other)
    }

    /// Estimates the errors of the steps without inertia that follow on an answer of another model.
    pub(super) fn estimate_errors_from(&mut self, answer: &CableSolution) {
        if self.present == PresentPart::Stepper {
            self.meshes.continue_beside(&self.problem, self.settings, &self.stepper, answer, &self.dragged);
        }
    }

    /// A copy for rollback. It has the obstacles of the scene; those with the robot's moving
    /// outline stay with this model.
    pub(super) fn copy_for_rollback(&self) -> Self {
        let mut copy = self.clone();
        copy.stepper.cable.problem = self.problem.clone();
        copy
    }

    /// The errors of an answer that neglects so much bending, relative to the greatest tension.
    /// Where a cable turns by φ under a tension T, its stiffness lowers the tension by T φ²/8 and
    /// moves it aside by ½φ √(EI/T), and by no more than its length. Compression counts as tension,
    /// as it does in that part.
    fn error_of_neglected_bending(&self, answer: &CableSolution, part: f64) -> ErrorEstimates {
        let greatest_n = answer.nodes.iter().map(|n| n.tension_n.abs()).fold(f64::MIN_POSITIVE, larger);
        let aside_m = (2.0 * part * (self.problem.bending_stiffness / greatest_n)).sqrt();
        let position_m = Some(if aside_m < self.problem.length { aside_m } else { self.problem.length });
        ErrorEstimates { position_m, ..ErrorEstimates::of_forces(answer, Some(part)) }
    }

    /// Makes `part` the part that holds the present state.
    fn make_present(&mut self, part: PresentPart) -> Result<(), SolveError> {
        if self.present != part {
            match part {
                PresentPart::Statics => self.statics.set_state(&self.stepper.cable.state())?,
                PresentPart::Stepper => {
                    self.stepper.set_state(&self.statics.state())?;
                    self.stepper.come_to_rest(&self.dragged);
                }
            }
            self.present = part;
        }
        Ok(())
    }
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
            self.make_present(PresentPart::Statics)?;
            self.statics.advance(dt_s, &self.dragged)
        } else {
            self.make_present(PresentPart::Stepper)?;
            self.bending_error = None;
            if let Some(answer) = self.elastica_answer.take() {
                self.stepper.warm_start(&answer, self.stepper.cable.time(), &self.dragged)?;
                if inertia == Inertia::QuasiStatic {
                    self.begin_from_elastica(&answer);
                }
            }
            if inertia == Inertia::QuasiStatic {
                self.refine_for_bending();
            }
            let mut report = self.stepper.advance_gauged(dt_s, inertia, &self.dragged, gauge)?;
            self.meshes.follow(&self.problem, self.settings, &self.stepper, dt_s, inertia, &self.dragged);
            let may_bend_over = !touches_nothing(&self.problem) || self.stepper.cable.mesh.slides_anywhere();
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
            return State::of_nodes(&answer.nodes, self.stepper.cable.time());
        }
        match self.present {
            PresentPart::Statics => self.statics.state(),
            PresentPart::Stepper => self.stepper.cable.state(),
        }
    }

    fn time_s(&self) -> f64 {
        match (&self.elastica_answer, self.present) {
            (None, PresentPart::Statics) => self.statics.state().time_s,
            _ => self.stepper.cable.time(),
        }
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.meshes = TwoMeshes::default();
        self.elastica_answer = None;
        self.bending_error = None;
        // Statics has no velocities, so a moving state needs the part that has them.
        if self.present == PresentPart::Statics && state.moves() {
            self.stepper.set_state(state)?;
            self.present = PresentPart::Stepper;
            return Ok(());
        }
        match self.present {
            PresentPart::Statics => self.statics.set_state(state),
            PresentPart::Stepper => self.stepper.set_state(state),
        }
    }

    fn continuation(&self) -> Option<Box<dyn Any + Send>> {
        let continues = self.present == PresentPart::Stepper && self.elastica_answer.is_none() && self.time_s() > 0.0;
        let continuation = || Continuation { stepper: self.stepper.clone(), errors: self.meshes.errors };
        continues.then(|| Box::new(continuation()) as Box<dyn Any + Send>)
    }

    fn continue_from(&mut self, before: &(dyn Any + Send)) -> bool {
        let Some(Continuation { stepper, errors }) = before.downcast_ref() else { return false };
        let continues = self.stepper.continue_from(stepper, &self.dragged);
        if continues {
            self.present = PresentPart::Stepper;
            // A cable that lost its bending stiffness has another mesh, whose errors are not known.
            let lost_bending = self.stepper.cable.mesh.is_flexible() && !stepper.cable.mesh.is_flexible();
            self.meshes = if lost_bending { TwoMeshes::default() } else { TwoMeshes::after_edit(*errors) };
            (self.elastica_answer, self.bending_error) = (None, None);
            if let Some(pose) = self.robot_pose {
                self.set_robot_pose(pose);
            }
        }
        continues
    }

    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        self.elastica_answer = None;
        self.bending_error = None;
        match self.present {
            PresentPart::Statics => self.set_state(&State::of_nodes(&answer.nodes, time_s)),
            PresentPart::Stepper => {
                self.meshes = TwoMeshes::default();
                self.stepper.warm_start(answer, time_s, &self.dragged)
            }
        }
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        if let (Some(d), Some(pulled)) =
            (self.dragged.get_mut(support), self.stepper.hand_drive.pulled.get_mut(support))
        {
            (*d, *pulled) = (Some(target_m), false);
        }
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.drag_support(support, hand_m);
        let kind = self.problem.supports.get(support).map(|s| s.kind);
        if let Some(pulled) = self.stepper.hand_drive.pulled.get_mut(support) {
            *pulled = matches!(kind, Some(SupportKind::Fixed | SupportKind::Clamped));
        }
    }

    fn set_robot_pose(&mut self, to: RigidPose) {
        self.robot_pose = Some(to);
        if let Some(outline) = &mut self.stepper.cable.outline {
            outline.lead_to(to);
        }
    }

    fn limit_work(&mut self, work: usize) {
        self.stepper.solver.work_of_advance = WorkBudget::Left(work);
        let most = &mut Arc::make_mut(&mut self.stepper.cable.mesh.tuning).equilibrium.max_work;
        *most = work.min(*most);
        self.meshes.limit_work(work);
    }

    fn start_without_spans(&mut self) {
        self.starts_from_spans = false;
    }

    fn break_at(&mut self, place: &BreakPlace) -> bool {
        let broken = self.present == PresentPart::Stepper
            && self.elastica_answer.is_none()
            && break_cable(&mut self.stepper.cable, place);
        if broken {
            self.meshes = TwoMeshes::default();
            self.stepper.time_control.sleep.wake();
            self.stepper.rested = true;
        }
        broken
    }

    fn change_wheels(&mut self, problem: Arc<Problem>) -> bool {
        let Ok(statics) = free::Statics::new(problem.clone(), self.settings) else { return false };
        if self.present != PresentPart::Stepper || self.elastica_answer.is_some() {
            return false;
        }
        let changes = self.stepper.change_wheels(problem.clone());
        if changes {
            (self.statics, self.problem) = (statics, problem);
        }
        changes
    }

    fn wheels_bent_over(&self, inertia: Inertia) -> Vec<usize> {
        let (mesh, meshing) = (&self.stepper.cable.mesh, &self.stepper.cable.meshing);
        if mesh.is_flexible() || self.problem.supports.iter().all(|s| !(s.wheel_radius > 0.0)) {
            return Vec::new();
        }
        let bars = self.finest_bars(inertia);
        let answer = self.solution();
        let bends = |(support, reaction): (&SupportPoint, &SupportReaction)| {
            let tension = [reaction.tension_before_n, reaction.tension_after_n].into_iter().flatten().fold(0.0, larger);
            support.wheel_radius > 0.0 && meshing.bends_visibly_on(bars, mesh, mesh.bending_stiffness, tension)
        };
        let pairs = self.problem.supports.iter().zip(&answer.supports).map(bends);
        pairs.enumerate().filter(|(_, bends)| *bends).map(|(k, _)| k).collect()
    }

    fn stored_energy(&self) -> Option<Energy> {
        let counts = self.present == PresentPart::Stepper && self.stepper.accounts_energy;
        counts.then(|| stored_energy(&self.stepper.cable))
    }

    fn fall_back(&mut self, why: &SolveError) -> bool {
        let finer = if matches!(why, SolveError::Unsound { .. }) { self.on_finer_mesh() } else { None };
        if let Some(finer) = finer {
            *self = finer;
            return true;
        }
        let begins = !self.on_smooth_floor && self.time_s() <= 0.0;
        self.on_smooth_floor |= begins && self.problem.floor_friction.is_some();
        begins && self.on_smooth_floor
    }

    fn robot_contact(&self) -> Option<RobotContact> {
        outline_report(&self.stepper.cable)
    }

    fn solution(&self) -> CableSolution {
        if let Some(answer) = &self.elastica_answer {
            return answer.clone();
        }
        match self.present {
            PresentPart::Statics => self.statics.solution(),
            PresentPart::Stepper => {
                let answer = self.stepper.solution();
                let meshes = self.meshes.errors;
                let estimates = [self.bending_error, meshes.relative(&answer)].into_iter().flatten();
                let errors = match self.bending_error {
                    Some(part) => meshes.plus(&self.error_of_neglected_bending(&answer, part)),
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
        self.stepper.time_control.step_size.longest_step()
    }

    fn copy_to_keep(&self) -> Box<dyn Mechanics> {
        Box::new(self.copy_for_rollback())
    }

    fn lend(&mut self) -> Option<OwnedResources> {
        Some(OwnedResources {
            memory: self.stepper.solver.memory.0.take().map(|memory| memory as Box<dyn Any + Send>),
            problem: self.stepper.cable.problem.clone(),
        })
    }

    fn borrow(&mut self, own: Option<OwnedResources>) {
        let own =
            own.unwrap_or_else(|| OwnedResources { memory: None, problem: state::with_outline(self.problem.clone()) });
        self.stepper.solver.memory.0 = own.memory.and_then(|memory| memory.downcast().ok());
        self.stepper.cable.problem = own.problem;
        place_bodies(&mut self.stepper.cable);
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

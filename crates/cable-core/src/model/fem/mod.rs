//! `fem` is the finite element model of a cable: contact, friction, bending, equilibrium and
//! motion.
//!
//! | room | what it holds |
//! |---|---|
//! | `state` | the state of the cable (`state/cable.rs`) and its parts, the setup of a step, and what controls it (`state/control.rs`) |
//! | `dynamics` | advances that state: one step with inertia, halvings, reports |
//! | `free`, `elastica` | equilibrium of a cable that touches nothing but its supports; of a stiff one in contact |
//! | `bows` | the other equilibria of a stiff cable that is compressed |
//! | `equilibrium` | equilibria in contact, and steps without inertia |
//! | `time` | BDF2, step sizes, sleep, hands, momentum, checkpoints |
//! | `newton` | one step: its initial guess, its Newton iterations, and what bounds them |
//! | `system` | input and energies of a step: value, gradient and banded Hessian |
//! | `mesh`, `remesh` | sliding nodes and paths round corners; changes of nodes between steps |
//! | `obstacle` | the robot's outline; does the cable run through an obstacle? |
//! | `transfer` | the first state along the route; states and answers of other models |
//! | `results`, `mesh_comparison` | the answer of a state, and its errors |
//! | `settings` | the tuned constants |
//!
//! [`FemModel`] decides which part answers, and hands the state over when the question changes.

mod bows;
mod dynamics;
mod elastica;
mod equilibrium;
mod free;
mod mesh;
mod mesh_comparison;
pub(in crate::model) mod newton;
mod obstacle;
mod remesh;
mod results;
pub mod settings;
mod state;
pub mod system;
#[cfg(test)]
mod tests;
mod time;
mod transfer;

use std::sync::Arc;

use crate::error::SolveError;
use crate::math::RigidPose;
use crate::math::{Vec2, larger};
use crate::model::fem::equilibrium::quasi_static::slides_as_a_whole;
use crate::model::fem::mesh_comparison::{Refinement, TwoMeshes};
use crate::model::fem::obstacle::moving_outline::outline_report;
use crate::model::fem::obstacle::moving_outline::place_outline;
use crate::model::fem::settings::Tuning;
use crate::model::fem::system::step_input::WorkBudget;
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
enum FirstEquilibrium {
    /// The mesh rests in it too; with the warnings about it.
    Accepted(Vec<Warning>),
    /// The mesh does not rest in it and relaxes from its own initial guess.
    Rejected,
    /// Nothing.
    Unknown,
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
    statics: free::statics::Statics,
    dynamics: dynamics::Dynamics,
    present: Part,
    /// True if a first rest with contact goes on from that of `spans`, where there is one.
    starts_from_spans: bool,
    settings: Settings,
    /// The estimate of the error in contact by another mesh.
    meshes: TwoMeshes,
    /// Pose to which the outline of the robot was led.
    led: Option<RigidPose>,
    /// The rest of a stiff cable in contact, until something moves.
    bent: Option<CableSolution>,
    /// Error of the mesh's equilibrium of a stiff cable, in parts of the greatest tension, until
    /// something moves.
    unbent: Option<f64>,
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
        let statics = free::statics::Statics::new(problem.clone(), settings)?;
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
            led: problem.outline.as_ref().map(|o| o.placement),
            bent: None,
            unbent: None,
            problem,
        })
    }

    /// The tuned constants by which it is solved.
    fn tuning(&self) -> &Arc<Tuning> {
        &self.dynamics.cable.mesh.tuning
    }

    /// The same, but `spans` is not asked how the cable is laid: it was, and has no answer.
    #[must_use]
    pub fn without_spans_start(mut self) -> Self {
        self.starts_from_spans = false;
        self
    }

    /// Lays the cable with the least sliding, if there is an answer to that. On its own way down
    /// slack comes to lie in folds, which friction then holds. Returns what there is to say of it,
    /// and the answer without a mesh.
    ///
    /// # Errors
    /// That it slides from where it is laid.
    fn lay(&mut self) -> Result<(FirstEquilibrium, Option<InitialEquilibrium>), SolveError> {
        let laid = initial_equilibrium(&self.problem, self.settings, &self.dragged, self.led)?;
        let Some(lay) = laid else { return Ok((FirstEquilibrium::Unknown, None)) };
        // A stiff cable is laid as a flexible one: that is where it begins, not how it lies.
        let flexible = self.problem.bending_stiffness == 0.0;
        let before = self.dynamics.clone();
        let taken =
            self.dynamics.warm_start(&lay.answer, before.cable.time(), &self.dragged).is_ok() && self.dynamics.rested;
        let greatest = lay.answer.nodes.iter().map(|n| n.tension_n).fold(0.0, larger);
        let found = self.dynamics.solution();
        let pairs = lay.answer.supports.iter().zip(&found.supports);
        let off = pairs.map(|(a, b)| (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n));
        let tuning = self.tuning().start;
        let jammed =
            if self.problem.bending_stiffness > 0.0 { tuning.max_stiff_force_change } else { tuning.max_force_change };
        if taken && off.fold(0.0, larger) <= jammed * greatest {
            return Ok((FirstEquilibrium::Accepted(lay.warnings.clone()), flexible.then_some(lay)));
        }
        self.dynamics = before;
        Ok((FirstEquilibrium::Rejected, flexible.then_some(lay)))
    }

    /// The resting place.
    fn rest(&mut self) -> Result<StepReport, SolveError> {
        if touches_nothing(&self.problem) {
            return self.rest_in_the_air();
        }
        self.bent = None;
        self.unbent = None;
        if let Some(report) = self.bend() {
            return Ok(report);
        }
        self.dynamics.solver.work_left = WorkBudget::Left(self.tuning().equilibrium.max_work);
        let found = self.rest_in_touch();
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
            if self.present == Part::Dynamics || self.bent.is_some() {
                // It tells of no shapes where it has no answer.
                let _ = statics.settle(&self.dragged);
            }
            statics.bows()
        };
        let histories = bows::elsewhere(&self.problem, self.time_s(), &self.dragged, &self.solution(), free)?;
        let cause = WarningCause::ManyEquilibria { shown: ShownEquilibrium::FromRoute, histories };
        Some(Warning::new(cause, &self.problem.cable.name, 0.0, [0.0; 2]))
    }

    /// The resting place where nothing can be touched. From the flexible cable up in EI a stiff one
    /// may come to where its shape snaps over, clamps against which it sags turn it upwards: a
    /// chain of bars that is let go follows it there, as it does in contact.
    fn rest_in_the_air(&mut self) -> Result<StepReport, SolveError> {
        self.ask(Part::Statics)?;
        self.bent = None;
        let found = self.statics.settle(&self.dragged);
        let Err(why) = found else { return found };
        if !(self.problem.bending_stiffness > 0.0) || self.ask(Part::Dynamics).is_err() {
            return Err(why);
        }
        match self.bend() {
            Some(report) => Ok(report),
            None => {
                self.ask(Part::Statics)?;
                Err(why)
            }
        }
    }

    /// The resting place where something may be touched.
    fn rest_in_touch(&mut self) -> Result<StepReport, SolveError> {
        let begins = !self.dynamics.rested && self.dynamics.cable.time() == 0.0;
        let (laid, exact) = match begins && self.starts_from_spans {
            true => self.lay().map_or_else(|slides| (Err(slides), None), |(laid, exact)| (Ok(laid), exact)),
            false => (Ok(FirstEquilibrium::Unknown), None),
        };
        let taken = matches!(laid, Ok(FirstEquilibrium::Accepted(_)));
        if begins && !taken && self.statics.settle(&self.dragged).is_ok() {
            self.dynamics.begin_at(&self.statics.state(), &self.dragged);
        }
        if begins && !taken {
            self.begin_coarse();
        }
        let known = matches!(laid, Ok(FirstEquilibrium::Accepted(_) | FirstEquilibrium::Rejected));
        let start = self.dynamics.cable.state();
        let before = if known { None } else { Some(self.dynamics.clone()) };
        let mut found = self.dynamics.settle(&self.dragged);
        let slid = if known || found.is_err() { None } else { slides_as_a_whole(&self.dynamics.cable) };
        if let Some(why) = slid {
            found = Err(SolveError::NoRestingPlace { why });
        }
        let said = match laid {
            Ok(FirstEquilibrium::Accepted(said)) => said,
            Ok(FirstEquilibrium::Rejected | FirstEquilibrium::Unknown) => Vec::new(),
            // A cable that slides from its first place may come to rest elsewhere.
            Err(slides) => {
                let answer = self.dynamics.solution();
                let rises = !(work(&self.problem, &start, &answer, self.dynamics.cable.time()) > 0.0);
                if found.is_err() || rises || slides_on(&self.problem, self.settings, &answer) {
                    found = Err(slides);
                    Vec::new()
                } else {
                    vec![slid_first(&self.problem, &slides)]
                }
            }
        };
        if let (Err(_), Some(before)) = (&found, before) {
            self.dynamics = before;
        }
        let mut report = found?;
        report.warnings.extend(said);
        if let Some(cost) = self.bend_on() {
            report.cost = Cost { iterations: report.cost.iterations + cost.iterations, ..cost };
            return Ok(report);
        }
        report.warnings.extend(self.bend_warning());
        self.compare_meshes(exact);
        report.warnings.extend(self.coarse_warning());
        Ok(report)
    }

    /// A warning of the bend of a stiff cable that the mesh leaves out, where that is more than was
    /// asked for.
    fn bend_warning(&mut self) -> Option<Warning> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let (off, s) = results::bending_error::bending_error(&self.dynamics.cable);
        self.unbent = Some(off);
        let limit = self.settings.tolerance;
        if off <= limit {
            return None;
        }
        let cause = WarningCause::CoarseBend { bars: self.dynamics.cable.meshing.even_bars };
        Some(Warning::new(cause, &self.problem.cable.name, s, [off, limit]))
    }

    /// Begins a first rest of a fine mesh at that of a coarse one (nested iteration): the way down
    /// takes as many steps as waves of slack run along the bars, which a coarse mesh does cheaply.
    fn begin_coarse(&mut self) {
        let fine = self.settings.segments.or(self.problem.cable.segments).unwrap_or(0);
        let tuning = self.tuning().clone();
        if fine <= tuning.start.two_mesh_bars {
            return;
        }
        let settings = Settings { segments: Some(fine / tuning.start.mesh_ratio), ..self.settings };
        let Ok(coarse) = Self::with_tuning(self.problem.clone(), settings, tuning) else { return };
        let mut coarse = Self { dragged: self.dragged.clone(), ..coarse.without_spans_start() };
        if let Some(to) = self.led {
            coarse.set_robot_pose(to);
        }
        if coarse.settle().is_err() {
            return;
        }
        let before = self.dynamics.clone();
        let time_s = before.cable.time();
        if self.dynamics.warm_start(&coarse.solution(), time_s, &self.dragged).is_err() {
            self.dynamics = before;
        }
    }

    /// The resting place of a stiff cable in contact as an elastica, from that of a flexible one;
    /// None where this finds none.
    fn bend(&mut self) -> Option<StepReport> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let lay = initial_equilibrium(&self.problem, self.settings, &self.dragged, self.led).ok()?;
        let (time_s, tolerance) = (self.dynamics.cable.time(), STIFF_ESTIMATE_FRACTION * self.settings.tolerance);
        let flexible = lay.as_ref().map(|l| &l.answer);
        let (answer, cost) = elastica::rest(&self.problem, time_s, &self.dragged, flexible, tolerance)?;
        self.bent = Some(answer);
        let mut warnings = lay.map_or_else(Vec::new, |l| l.warnings);
        warnings.extend(self.bent_warning());
        Some(StepReport { cost, warnings })
    }

    /// The same from the rest that the mesh has found.
    fn bend_on(&mut self) -> Option<Cost> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let answer = self.dynamics.solution();
        let bar = self.dynamics.cable.even();
        let found = Elastica::from_mesh(&self.problem, self.dynamics.cable.time(), &self.dragged, &answer, bar)?;
        let cost = self.take_bent(found)?;
        // The equilibrium of the mesh is followed: places that differ by more are another
        // equilibrium.
        let near = |n: &Node| {
            let at = self.bent.as_ref().and_then(|b| State::of_nodes(&b.nodes, 0.0).position_at(n.arc_length_m));
            at.is_some_and(|at| (at - n.at()).norm() <= STIFF_SHIFT_LIMIT * self.problem.length)
        };
        if !answer.nodes.iter().all(near) {
            self.bent = None;
            return None;
        }
        Some(cost)
    }

    /// A warning of a stiff cable's equilibrium whose error is more than was asked for.
    fn bent_warning(&self) -> Option<Warning> {
        let (estimate, asked) = (self.bent.as_ref()?.error_estimate?, self.settings.tolerance);
        let cause = WarningCause::BarContacts;
        (estimate > asked).then(|| Warning::new(cause, &self.problem.cable.name, 0.0, [estimate, asked]))
    }

    fn take_bent(&mut self, mut found: Elastica) -> Option<Cost> {
        if !found.stiffen(&self.problem) {
            return None;
        }
        let (estimate, errors) =
            elastica::refine(&mut found, &self.problem, STIFF_ESTIMATE_FRACTION * self.settings.tolerance)?;
        let (iterations, residual_n) = found.cost();
        self.bent =
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

    /// A copy to go back to. It leaves the obstacles, among which the outline of the robot is
    /// moved, to this one.
    pub(super) fn kept(&self) -> Self {
        let mut copy = self.clone();
        copy.dynamics.cable.problem = self.problem.clone();
        copy
    }

    /// Looks at the cable in contact beside an answer without a mesh, or on another one, and makes
    /// its own finer where the scene leaves that open.
    fn compare_meshes(&mut self, exact: Option<InitialEquilibrium>) {
        let given = self.settings.segments.or(self.problem.cable.segments).is_some();
        let refinement = if given { Refinement::Forbidden } else { Refinement::Allowed };
        let (meshes, dynamics) = (&mut self.meshes, &mut self.dynamics);
        meshes.compare(&self.problem, self.settings, refinement, dynamics, exact, &self.dragged);
    }

    /// A warning of a mesh that is coarser than the tolerance asks for.
    fn coarse_warning(&self) -> Option<Warning> {
        let (estimate, asked) = (self.meshes.errors.relative(&self.dynamics.solution())?, self.settings.tolerance);
        let cause = WarningCause::CoarseForces { elements: self.dynamics.cable.meshing.even_bars };
        (estimate > asked).then(|| Warning::new(cause, &self.problem.cable.name, 0.0, [estimate, asked]))
    }

    /// Makes `part` the one that holds the present state.
    fn ask(&mut self, part: Part) -> Result<(), SolveError> {
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
        let mut report = self.rest()?;
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
        if inertia == Inertia::QuasiStatic && touches_nothing(&self.problem) && self.bent.is_none() {
            self.ask(Part::Statics)?;
            self.statics.advance(dt_s, &self.dragged)
        } else {
            self.ask(Part::Dynamics)?;
            self.unbent = None;
            if let Some(answer) = self.bent.take() {
                self.dynamics.warm_start(&answer, self.dynamics.cable.time(), &self.dragged)?;
            }
            let mut report = self.dynamics.advance_gauged(dt_s, inertia, &self.dragged, gauge)?;
            self.meshes.follow(&self.problem, self.settings, &self.dynamics, dt_s, inertia, &self.dragged);
            let led = !touches_nothing(&self.problem) || self.dynamics.cable.mesh.slides_anywhere();
            match if led { self.bend_warning() } else { None } {
                Some(warning) => report.warnings.push(warning),
                // An error below the tolerance tells nothing of the other errors of a step.
                None => self.unbent = None,
            }
            Ok(report)
        }
    }

    fn state(&self) -> State {
        if let Some(answer) = &self.bent {
            return State::of_nodes(&answer.nodes, self.dynamics.cable.time());
        }
        match self.present {
            Part::Statics => self.statics.state(),
            Part::Dynamics => self.dynamics.cable.state(),
        }
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.meshes = TwoMeshes::default();
        self.bent = None;
        self.unbent = None;
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
        self.bent = None;
        self.unbent = None;
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
        self.led = Some(to);
        if let Some(outline) = &mut self.dynamics.cable.outline {
            outline.lead_to(to);
        }
    }

    fn robot_contact(&self) -> Option<RobotContact> {
        outline_report(&self.dynamics.cable)
    }

    fn solution(&self) -> CableSolution {
        if let Some(answer) = &self.bent {
            return answer.clone();
        }
        match self.present {
            Part::Statics => self.statics.solution(),
            Part::Dynamics => {
                let answer = self.dynamics.solution();
                let meshes = self.meshes.errors;
                let estimates = [self.unbent, meshes.relative(&answer)].into_iter().flatten();
                let errors = match self.unbent {
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
        self.dynamics.pacing.pace.longest_step()
    }

    fn copy_to_keep(&self) -> Box<dyn Mechanics> {
        Box::new(self.kept())
    }

    fn lend(&mut self) -> Option<OwnedResources> {
        Some(OwnedResources {
            memory: self.dynamics.solver.memory.0.take().map(|memory| memory as Box<dyn std::any::Any + Send>),
            problem: self.dynamics.cable.problem.clone(),
        })
    }

    fn borrow(&mut self, own: Option<OwnedResources>) {
        let own = own.unwrap_or_else(|| OwnedResources {
            memory: None,
            problem: state::moving_outline::with_outline(self.problem.clone()),
        });
        self.dynamics.solver.memory.0 = own.memory.and_then(|memory| memory.downcast().ok());
        self.dynamics.cable.problem = own.problem;
        place_outline(&mut self.dynamics.cable);
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

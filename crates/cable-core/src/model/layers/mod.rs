//! A layer is a model around another one: it changes some inputs or outputs, and [`Layered`] passes
//! everything else on.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | what a layer may change |
//! | `leavable_wheels.rs` | a cable over wheels, which it may leave |
//! | `natural_scale.rs` | a cable computed at another scale |
//! | `spans_then_fem.rs` | two models that take turns |

pub(in crate::model) mod leavable_wheels;
pub(in crate::model) mod natural_scale;
pub(in crate::model) mod spans_then_fem;

use std::any::Any;
use std::borrow::Cow;
use std::sync::Arc;

use crate::error::SolveError;
use crate::math::{RigidPose, Vec2};
use crate::model::tension_gauge::TensionGauge;
use crate::model::{BreakPlace, Inertia, Mechanics, Model, OwnedResources, RobotContact, StepReport};
use crate::problem::Problem;
use crate::solution::{CableSolution, Energy, ModelReason};
use crate::state::State;

/// The changes that a layer makes. A method that it does not implement calls the inner model, or
/// changes nothing. Methods that act return reports and errors of the inner model; `outer_report`
/// and `outer_error` translate them.
pub(in crate::model) trait Layer: Send + Sized + 'static {
    /// The inner model.
    fn inner(&self) -> &dyn Mechanics;

    /// The inner model, mutably.
    fn inner_mut(&mut self) -> &mut dyn Mechanics;

    /// The same layer around another inner model.
    fn around(&self, inner: Box<dyn Mechanics>) -> Self;

    /// The problem that the layer solves.
    fn problem(&self) -> &Arc<Problem>;

    /// Records data of the inner model after it acted.
    fn observe(&mut self) {}

    fn reason(&self) -> Option<&ModelReason> {
        self.inner().reason()
    }

    fn refusal(&self) -> Option<&SolveError> {
        self.inner().refusal()
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        self.inner_mut().settle()
    }

    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        self.inner_mut().advance_gauged(dt_s, inertia, gauge)
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.inner_mut().set_state(state)
    }

    /// See [`Mechanics::continuation`].
    fn continuation(&self) -> Option<Box<dyn Any + Send>> {
        self.inner().continuation()
    }

    /// See [`Mechanics::continue_from`].
    fn continue_from(&mut self, before: &(dyn Any + Send)) -> bool {
        self.inner_mut().continue_from(before)
    }

    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        self.inner_mut().warm_start(answer, time_s)
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        self.inner_mut().drag_support(support, target_m);
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.inner_mut().pull_support(support, hand_m);
    }

    fn set_robot_pose(&mut self, to: RigidPose) {
        self.inner_mut().set_robot_pose(to);
    }

    /// See [`Mechanics::break_at`].
    fn break_at(&mut self, place: &BreakPlace) -> bool {
        self.inner_mut().break_at(place)
    }

    /// Translates an energy of the inner model.
    fn outer_energy(&self, energy: Energy) -> Energy {
        energy
    }

    /// See [`Mechanics::fall_back`].
    fn fall_back(&mut self, why: &SolveError) -> bool {
        self.inner_mut().fall_back(why)
    }

    /// Translates a time of the inner model, s.
    fn outer_time(&self, time_s: f64) -> f64 {
        time_s
    }

    /// Translates a state for the inner model.
    fn inner_state<'a>(&self, state: &'a State) -> Cow<'a, State> {
        Cow::Borrowed(state)
    }

    /// Translates a state of the inner model.
    fn outer_state(&self, state: State) -> State {
        state
    }

    /// Translates an answer of the inner model.
    fn outer_solution(&self, answer: CableSolution) -> CableSolution {
        answer
    }

    /// Translates a report of the inner model.
    fn outer_report(&self, report: StepReport) -> StepReport {
        report
    }

    /// Translates an error of the inner model.
    fn outer_error(&self, error: SolveError) -> SolveError {
        error
    }
}

/// A layer as a model.
pub(in crate::model) struct Layered<L>(pub(in crate::model) L);

impl<L: Layer> Layered<L> {
    /// Observes the inner model after it acted, and translates the outcome.
    fn report(&mut self, outcome: Result<StepReport, SolveError>) -> Result<StepReport, SolveError> {
        self.0.observe();
        match outcome {
            Ok(report) => Ok(self.0.outer_report(report)),
            Err(error) => Err(self.0.outer_error(error)),
        }
    }
}

impl<L: Layer> Mechanics for Layered<L> {
    fn model(&self) -> Model {
        self.0.inner().model()
    }

    fn reason(&self) -> Option<&ModelReason> {
        self.0.reason()
    }

    fn refusal(&self) -> Option<&SolveError> {
        self.0.refusal()
    }

    fn wheels_bent_over(&self, inertia: Inertia) -> Vec<usize> {
        self.0.inner().wheels_bent_over(inertia)
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        let outcome = self.0.settle();
        self.report(outcome)
    }

    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        let outcome = self.0.advance_gauged(dt_s, inertia, gauge);
        self.report(outcome)
    }

    fn state(&self) -> State {
        self.0.outer_state(self.0.inner().state())
    }

    fn time_s(&self) -> f64 {
        self.0.outer_time(self.0.inner().time_s())
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        let state = self.0.inner_state(state);
        let outcome = self.0.set_state(&state);
        self.0.observe();
        outcome.map_err(|e| self.0.outer_error(e))
    }

    fn continuation(&self) -> Option<Box<dyn Any + Send>> {
        self.0.continuation()
    }

    fn continue_from(&mut self, before: &(dyn Any + Send)) -> bool {
        let continues = self.0.continue_from(before);
        self.0.observe();
        continues
    }

    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        let outcome = self.0.warm_start(answer, time_s);
        self.0.observe();
        outcome.map_err(|e| self.0.outer_error(e))
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        self.0.drag_support(support, target_m);
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.0.pull_support(support, hand_m);
    }

    fn set_robot_pose(&mut self, to: RigidPose) {
        self.0.set_robot_pose(to);
    }

    fn limit_work(&mut self, work: usize) {
        self.0.inner_mut().limit_work(work);
    }

    fn start_without_spans(&mut self) {
        self.0.inner_mut().start_without_spans();
    }

    fn robot_contact(&self) -> Option<RobotContact> {
        self.0.inner().robot_contact()
    }

    fn break_at(&mut self, place: &BreakPlace) -> bool {
        self.0.break_at(place)
    }

    fn stored_energy(&self) -> Option<Energy> {
        self.0.inner().stored_energy().map(|energy| self.0.outer_energy(energy))
    }

    fn fall_back(&mut self, why: &SolveError) -> bool {
        let fell = self.0.fall_back(why);
        self.0.observe();
        fell
    }

    fn solution(&self) -> CableSolution {
        self.0.outer_solution(self.0.inner().solution())
    }

    fn problem(&self) -> &Arc<Problem> {
        self.0.problem()
    }

    fn inner_step_s(&self) -> f64 {
        self.0.outer_time(self.0.inner().inner_step_s())
    }

    fn copy_to_keep(&self) -> Box<dyn Mechanics> {
        Box::new(Self(self.0.around(self.0.inner().copy_to_keep())))
    }

    fn lend(&mut self) -> Option<OwnedResources> {
        self.0.inner_mut().lend()
    }

    fn borrow(&mut self, own: Option<OwnedResources>) {
        self.0.inner_mut().borrow(own);
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(Self(self.0.around(self.0.inner().boxed_clone())))
    }
}

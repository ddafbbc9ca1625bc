//! [`Mechanics`] is the trait that every model implements, with the reports that go through it.

use std::any::Any;
use std::sync::Arc;

use super::settings::Settings;
use super::tension_gauge::TensionGauge;
use crate::error::SolveError;
use crate::math::{RigidPose, Vec2, larger};
use crate::model_id::Model;
use crate::problem::Problem;
use crate::solution::{CableSolution, Cost, Energy, ModelReason, Warning};
use crate::state::State;

/// The role of inertia in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// Masses accelerate.
    Dynamic,
    /// Supports move infinitely slowly: friction keeps its memory, and masses do not accelerate.
    QuasiStatic,
}

/// The outcome of a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Work of the step.
    pub cost: Cost,
    /// Warnings about this step (velocity capped, support held …).
    pub warnings: Vec<Warning>,
}

impl StepReport {
    /// Adds the report of a further part of a step.
    pub(crate) fn add(&mut self, more: Self) {
        let Cost { iterations, halved_steps, residual_n, inner_step_s } = more.cost;
        self.cost.iterations += iterations;
        self.cost.halved_steps += halved_steps;
        // `larger` keeps NaN, unlike `max`.
        self.cost.residual_n = larger(self.cost.residual_n, residual_n);
        if inner_step_s > self.cost.inner_step_s {
            self.cost.inner_step_s = inner_step_s;
        }
        for warning in more.warnings {
            // Each part of a step repeats the warning with figures of its own.
            self.warnings.retain(|w| !w.has_cause_of(&warning));
            self.warnings.push(warning);
        }
    }
}

/// The place of a break.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BreakPlace {
    /// Arc length, m.
    pub arc_length_m: f64,
    /// True if the cable gives way on the side of greater arc length of what sits there: a support
    /// or load stays with the first piece.
    pub gives_way_after: bool,
}

/// The contact of a cable with the outline of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotContact {
    /// Force of the cable on the outline, N.
    pub force_n: Vec2,
    /// Pose of the outline: its target, unless the cable was in its way.
    pub placement: RigidPose,
    /// Distance of that pose from its target, m.
    pub left_m: f64,
}

/// The resources that a model does not share: its working memory, and its obstacles, among which it
/// moves the outline of the robot.
#[derive(Debug)]
pub struct OwnedResources {
    /// Its working memory, of a type that it alone knows.
    pub(super) memory: Option<Box<dyn Any + Send>>,
    /// The cable, with obstacles that the model moves.
    pub(super) problem: Arc<Problem>,
}

/// A function that builds a model.
pub type Constructor = dyn Fn(Arc<Problem>, Settings) -> Result<Box<dyn Mechanics>, SolveError> + Send + Sync;

/// The interface of every model. One cable; time and positions in SI units.
pub trait Mechanics: Send {
    /// The kind of this model.
    fn model(&self) -> Model;

    /// Returns the reason for this model, if the model changed during a run.
    fn reason(&self) -> Option<&ModelReason> {
        None
    }

    /// Returns the error of the model that was tried first, if another one gave the present answer.
    fn refusal(&self) -> Option<&SolveError> {
        None
    }

    /// Finds the equilibrium at the present time from the present state (after `new`: from the
    /// route) and sets velocities to zero.
    ///
    /// # Errors The reason if there is no equilibrium, or none was found.
    fn settle(&mut self) -> Result<StepReport, SolveError>;

    /// Advances time by exactly `dt_s` (sub-stepping inside as the model needs). On an error the
    /// state is the last good one, with the time that was reached.
    ///
    /// # Errors
    /// `TimeStep` for a step that is zero, negative, not finite or too large; `StepFailed`
    /// otherwise.
    fn advance(&mut self, dt_s: f64, inertia: Inertia) -> Result<StepReport, SolveError> {
        self.advance_gauged(dt_s, inertia, &mut TensionGauge::off())
    }

    /// As [`Self::advance`]; every inner step with inertia passes the tension along the cable to
    /// `tension_gauge`.
    ///
    /// # Errors
    /// As [`Self::advance`].
    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError>;

    /// Returns the state of the cable.
    fn state(&self) -> State;

    /// Time reached, s.
    fn time_s(&self) -> f64 {
        self.state().time_s
    }

    /// Adopts a state of the same cable, resampled on this model's mesh (after an edit, or from
    /// another model).
    ///
    /// # Errors An error if a number is not finite or the state does not fit the cable; `Buried` if
    /// the model cannot continue from inside an obstacle.
    fn set_state(&mut self, state: &State) -> Result<(), SolveError>;

    /// All that the model needs to continue from here after an edit of the scene, beside the
    /// problem, in a type that it alone knows: its mesh, history and friction. None if
    /// [`Self::state`] holds it all.
    fn continuation(&self) -> Option<Box<dyn Any + Send>> {
        None
    }

    /// Continues from where a model of the same kind was before an edit of the scene (see
    /// [`Self::continuation`]). Returns false, without a change, if the edit does not allow it:
    /// then [`Self::set_state`] lays the state on a mesh of its own.
    fn continue_from(&mut self, _before: &(dyn Any + Send)) -> bool {
        false
    }

    /// Continues from an answer of the same cable, by this model or another: as
    /// [`Self::set_state`], and with the friction of the answer if the model can adopt it.
    ///
    /// # Errors
    /// As [`Self::set_state`].
    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        self.set_state(&State::of_nodes(&answer.nodes, time_s))
    }

    /// From now on a support follows `target_m` (smoothly and no faster than
    /// [`super::Settings::hand_speed_m_per_s`] in `Dynamic` steps; at the next `settle` or
    /// quasi-static step it is there) instead of its `motion`. A support on a robot moves there
    /// evenly in the next step, without a speed limit.
    fn drag_support(&mut self, support: usize, target_m: Vec2);

    /// From now on a hand at `hand_m` (m) holds a support by a spring
    /// (`model/hand.rs`) in `Dynamic` steps, its free end no faster than
    /// [`super::Settings::hand_speed_m_per_s`]; else as [`Self::drag_support`], which ends it. A
    /// support without a node of its own (a pulley), and one of a robot, is dragged.
    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.drag_support(support, hand_m);
    }

    /// The outline of the robot moves to this pose in the next `advance`; after [`Self::set_state`]
    /// it is there at once. Models without the outline ignore it.
    fn set_robot_pose(&mut self, _to: RigidPose) {}

    /// From now on a search for an equilibrium and an advance without inertia fail beyond this
    /// work, in iterations times elements. Models that need little work ignore it.
    fn limit_work(&mut self, _work: usize) {}

    /// The initial equilibrium is not sought with `spans`, which is known to have none. Models that
    /// never use it ignore this.
    fn start_without_spans(&mut self) {}

    /// Returns the action of the cable on the outline of the robot; None without an outline, or if
    /// the model ignores it.
    fn robot_contact(&self) -> Option<RobotContact> {
        None
    }

    /// Breaks the cable in its present state, at a node of its answer, and goes on with both
    /// pieces, which can touch each other; the answer has the places of its breaks from then on. At
    /// an end the cable is torn off what holds it. Returns false, without a change, if the model
    /// knows unbroken cables only.
    fn break_at(&mut self, _place: &BreakPlace) -> bool {
        false
    }

    /// Goes on with wheels that let go of the cable now, or hold it again: `problem` is the same
    /// but for these, and for posts after its other obstacles. Returns false, without a change, if
    /// the model cannot.
    fn change_wheels(&mut self, _problem: Arc<Problem>) -> bool {
        false
    }

    /// Returns the supports that are wheels over which the cable bends as the model would neglect
    /// in steps with or without inertia: there it lies better on posts.
    fn wheels_bent_over(&self, _inertia: Inertia) -> Vec<usize> {
        Vec::new()
    }

    /// Returns the energy of the cable as its energy account counts it; None if it keeps none.
    fn stored_energy(&self) -> Option<Energy> {
        None
    }

    /// Hands the cable to the next model or the next finer mesh, if there is one, because the
    /// answer violates a law (`why`); the next [`Self::settle`] uses that. Returns whether there
    /// was one.
    fn fall_back(&mut self, _why: &SolveError) -> bool {
        false
    }

    /// The answer at this instant.
    fn solution(&self) -> CableSolution;

    /// The problem it solves.
    fn problem(&self) -> &Arc<Problem>;

    /// Longest inner step of the next step with inertia, s; infinite if the model has no inner
    /// steps.
    fn inner_step_s(&self) -> f64 {
        f64::INFINITY
    }

    /// A copy for rollback, without the resources that the model does not share.
    fn copy_to_keep(&self) -> Box<dyn Mechanics> {
        self.boxed_clone()
    }

    /// Lends the resources that it does not share and that hold none of its state.
    fn lend(&mut self) -> Option<OwnedResources> {
        None
    }

    /// Lets a copy continue with the resources that the original has lent, or with its own.
    fn borrow(&mut self, _own: Option<OwnedResources>) {}

    /// A copy with all its history, for reset and compare.
    fn boxed_clone(&self) -> Box<dyn Mechanics>;
}

#[cfg(test)]
mod tests {
    use super::StepReport;
    use crate::solution::{Warning, WarningCause};

    #[test]
    fn parts_of_a_step_warn_once_of_a_cause_at_a_place() {
        let warns = |arc_length_m, value| {
            let warning = Warning::new(WarningCause::StiffPreview, "cable", arc_length_m, [value, 1.0]);
            StepReport { warnings: vec![warning], ..StepReport::default() }
        };
        let mut step = warns(0.0, 2.0);
        step.add(warns(0.0, 2.000_000_1));
        step.add(warns(3.0, 2.0));
        let warnings: Vec<_> = step.warnings.iter().map(|w| (w.arc_length_m, w.value)).collect();
        assert_eq!(warnings, [(0.0, 2.000_000_1), (3.0, 2.0)]);
    }
}

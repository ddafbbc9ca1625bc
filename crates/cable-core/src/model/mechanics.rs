//! [`Mechanics`] is the trait that every model implements, with the reports that go through it.

use std::any::Any;
use std::sync::Arc;

use super::settings::Settings;
use super::tension_gauge::TensionGauge;
use crate::error::SolveError;
use crate::math::{RigidPose, Vec2, larger};
use crate::model_id::Model;
use crate::problem::Problem;
use crate::solution::{CableSolution, Cost, ModelReason, Warning};
use crate::state::State;

/// The part that inertia takes in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// Masses accelerate.
    Dynamic,
    /// Supports move infinitely slowly: friction remembers, masses do not.
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
        // Not `max`: what is not a number must show.
        self.cost.residual_n = larger(self.cost.residual_n, residual_n);
        if inner_step_s > self.cost.inner_step_s {
            self.cost.inner_step_s = inner_step_s;
        }
        for warning in more.warnings {
            // Of the parts of a step each says the same again, with figures of its own.
            self.warnings.retain(|w| !w.has_cause_of(&warning));
            self.warnings.push(warning);
        }
    }
}

/// The contact of a cable with the outline of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotContact {
    /// Its force on it, N.
    pub force_n: Vec2,
    /// Its pose: that to which it was led unless the cable was in its way.
    pub placement: RigidPose,
    /// Distance of that from the pose to which it was led, m.
    pub left_m: f64,
}

/// The resources that a model has for itself alone: the memory it works in, and its obstacles,
/// among which it moves the outline of the robot.
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

    /// Returns why it is this model, where that changed on the way.
    fn reason(&self) -> Option<&ModelReason> {
        None
    }

    /// Returns why the model that was asked first has no answer, where another one gave the present
    /// one.
    fn refusal(&self) -> Option<&SolveError> {
        None
    }

    /// Finds the resting place at the present time from the present state (after `new`: from the
    /// route) and sets velocities to zero.
    ///
    /// # Errors
    /// A typed reason when there is none, or none was found.
    fn settle(&mut self) -> Result<StepReport, SolveError>;

    /// Advances time by exactly `dt_s` (sub-stepping inside as the model needs). On an error the
    /// state is the last good one, its time says how far it came.
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

    /// Returns where the cable is.
    fn state(&self) -> State;

    /// Time reached, s.
    fn time_s(&self) -> f64 {
        self.state().time_s
    }

    /// Takes over a state of the same cable, resampled on this model's mesh (after an edit, or from
    /// another model).
    ///
    /// # Errors
    /// When a number is not finite or the state does not fit the cable; `Buried` when the model
    /// cannot go on from inside an obstacle.
    fn set_state(&mut self, state: &State) -> Result<(), SolveError>;

    /// Goes on from an answer of the same cable, by this model or another: as [`Self::set_state`],
    /// and where the model can, what friction held is still held.
    ///
    /// # Errors
    /// As [`Self::set_state`].
    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        self.set_state(&State::of_nodes(&answer.nodes, time_s))
    }

    /// From now on a support follows `target_m` (smoothly and no faster than
    /// [`super::Settings::hand_speed_m_per_s`] in `Dynamic` steps; at the next `settle` or
    /// quasi-static step it is there) instead of its `motion`. One of a robot goes there evenly in
    /// the next step, whatever that takes.
    fn drag_support(&mut self, support: usize, target_m: Vec2);

    /// From now on a hand at `hand_m` (m) holds a support by a spring
    /// (`model/hand.rs`) in `Dynamic` steps, its free end no faster than
    /// [`super::Settings::hand_speed_m_per_s`]; else as [`Self::drag_support`], which ends it. A
    /// support without a node of its own (a pulley), and one of a robot, is dragged.
    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.drag_support(support, hand_m);
    }

    /// The outline of the robot goes there in the next advance; what is put somewhere
    /// ([`Self::set_state`]) finds it there at once. Models that know nothing of it leave it out.
    fn set_robot_pose(&mut self, _to: RigidPose) {}

    /// From now on a search for an equilibrium and an advance without inertia may do so much work
    /// at most, in iterations times elements, and fail beyond it. Models that need little leave it
    /// out.
    fn limit_work(&mut self, _work: usize) {}

    /// The first equilibrium is not asked of `spans`, which is known to have none. Models that
    /// never ask leave it out.
    fn start_without_spans(&mut self) {}

    /// Returns what the cable does to the outline of the robot; None where the model leaves it out,
    /// or there is none.
    fn robot_contact(&self) -> Option<RobotContact> {
        None
    }

    /// Gives the cable to the next model or the next finer mesh, where there is one behind this
    /// one, because of what the laws say of its answer; the next [`Self::settle`] is that one's.
    /// Returns whether there was one.
    fn fall_back(&mut self, _why: &SolveError) -> bool {
        false
    }

    /// The answer at this instant.
    fn solution(&self) -> CableSolution;

    /// The problem it solves.
    fn problem(&self) -> &Arc<Problem>;

    /// Longest inner step that the next step with inertia is made of, s; infinite where there is
    /// none to speak of.
    fn inner_step_s(&self) -> f64 {
        f64::INFINITY
    }

    /// A copy to go back to, which does not hold what the model can have for itself alone.
    fn copy_to_keep(&self) -> Box<dyn Mechanics> {
        self.boxed_clone()
    }

    /// Gives away what it has for itself alone and what holds nothing of its state.
    fn lend(&mut self) -> Option<OwnedResources> {
        None
    }

    /// A copy that was kept goes on with what the model that it was copied from has lent, or with
    /// its own.
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
        let told: Vec<_> = step.warnings.iter().map(|w| (w.arc_length_m, w.value)).collect();
        assert_eq!(told, [(0.0, 2.000_000_1), (3.0, 2.0)]);
    }
}

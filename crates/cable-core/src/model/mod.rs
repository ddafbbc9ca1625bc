//! The models of a cable behind one seam: [`Mechanics`] is what each must do, [`Model`] names them.
//!
//! A model holds one cable of a scene (a [`Problem`]) and answers two kinds of question: where does it
//! rest ([`Mechanics::settle`]) and what happens next ([`Mechanics::advance`]). A model that cannot answer
//! returns a typed error, never a guess.

mod arc_nodes;
pub mod auto;
pub mod catenary;
pub mod conformance;
pub mod fem;
pub mod gauge;
pub mod initial_equilibrium;
pub mod input_filter;
pub mod mass_spring;
pub mod similar;
pub mod spans;
pub mod switching;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use self::gauge::TensionGauge;
use self::mass_spring::Stepping;
use crate::contact::outline::RigidPose;
use crate::error::SolveError;
use crate::math::Vec2;
use crate::problem::Problem;
use crate::solution::{CableSolution, Cost, Warning};
use crate::state::State;

/// The models a user can ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// The cheapest model that can answer.
    #[default]
    Auto,
    /// Elastic catenaries between supports: no contact, no motion, no discretisation error.
    Catenary,
    /// Exact catenaries between contacts that are intervals of a boundary: friction without a mesh, no motion.
    Spans,
    /// Corrected bar elements with contact, friction, bending, dynamics.
    Fem,
    /// Lumped masses and springs, explicit in time.
    MassSpring,
}

impl Model {
    /// Every model that solves by itself.
    pub const SOLVERS: [Self; 4] = [Self::Catenary, Self::Spans, Self::Fem, Self::MassSpring];

    /// The name used on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Catenary => "catenary",
            Self::Spans => "spans",
            Self::Fem => "fem",
            Self::MassSpring => "mass-spring",
        }
    }

    /// The model of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Auto].into_iter().chain(Self::SOLVERS).find(|m| m.name() == name)
    }
}

impl std::fmt::Display for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// How finely and how exactly a model works.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Relative accuracy asked of the tension; models choose their mesh by it where the scene does not.
    pub tolerance: f64,
    /// Elements per cable; overrides the scene's `segments`.
    pub segments: Option<usize>,
    /// How `mass-spring` takes dynamic steps.
    #[serde(default)]
    pub stepping: Stepping,
    /// Longest inner step of `fem` with inertia, s, 1e-9 to 1, of the cable at the scale at which it is solved; None = 1/240 s.
    #[serde(default)]
    pub inner_step_s: Option<f64>,
    /// Fastest a support follows the hand that drags it while masses move, m/s.
    #[serde(default = "hand_speed")]
    pub hand_speed_m_per_s: f64,
    /// Stiffness of the spring by which a hand holds a support while masses move, N/m; None: that of [`input_filter::default_hand_stiffness`].
    #[serde(default)]
    pub hand_stiffness_n_per_m: Option<f64>,
    /// Whether a rest that friction makes one of many is told with what other histories would have left in it: `spans` lays the cable anew for
    /// each, which takes some times as long as the rest. No figure of the answer hangs on it.
    #[serde(default = "yes")]
    pub histories: bool,
}

fn yes() -> bool {
    true
}

fn hand_speed() -> f64 {
    input_filter::HAND_SPEED
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-3,
            segments: None,
            stepping: Stepping::Auto,
            inner_step_s: None,
            hand_speed_m_per_s: hand_speed(),
            hand_stiffness_n_per_m: None,
            histories: true,
        }
    }
}

/// Least tolerance that makes sense: below, rounding is more than is asked for. From 1 on nothing is asked, which a test of one mesh may want.
pub(crate) const LEAST_TOLERANCE: f64 = 1e-14;
/// Slowest hand, m/s: slower is none that means to move anything.
const LEAST_HAND_SPEED: f64 = 0.01;
/// Segments, as a scene's own.
const SEGMENTS: (usize, usize) = (1, 100_000);
/// Inner steps, s: below, a second of motion takes longer than anyone waits; above, nothing that moves is seen.
const INNER_STEPS_S: std::ops::RangeInclusive<f64> = 1e-9..=1.0;

impl Settings {
    /// Refuses what no model can work by.
    ///
    /// # Errors
    /// `Setting`, with the value and what is allowed.
    pub fn validate(&self) -> Result<(), SolveError> {
        if !(self.tolerance >= LEAST_TOLERANCE && self.tolerance.is_finite()) {
            let (name, allowed) = ("tolerance", "1e-14 or more, and finite");
            return Err(SolveError::Setting { name, value: self.tolerance, allowed });
        }
        if let Some(value) = self.inner_step_s.filter(|step| !INNER_STEPS_S.contains(step)) {
            return Err(SolveError::Setting { name: "inner_step_s", value, allowed: "1e-9 to 1 s" });
        }
        if !(LEAST_HAND_SPEED..=input_filter::MAX_SPEED).contains(&self.hand_speed_m_per_s) {
            let (name, allowed) = ("hand speed", "0.01 to 20 m/s");
            return Err(SolveError::Setting { name, value: self.hand_speed_m_per_s, allowed });
        }
        if let Some(value) = self.hand_stiffness_n_per_m.filter(|k| !input_filter::HAND_STIFFNESSES.contains(k)) {
            return Err(SolveError::Setting { name: "hand stiffness", value, allowed: "0.001 to 1e9 N/m" });
        }
        match self.segments {
            Some(n) if !(SEGMENTS.0..=SEGMENTS.1).contains(&n) => {
                let (name, allowed) = ("segments", "1 to 100000");
                #[expect(clippy::cast_precision_loss, reason = "only shown")]
                Err(SolveError::Setting { name, value: n as f64, allowed })
            }
            _ => Ok(()),
        }
    }
}

/// Whether inertia takes part in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// Masses accelerate.
    Dynamic,
    /// Supports move infinitely slowly: friction remembers, masses do not.
    QuasiStatic,
}

/// What a step did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// What it took.
    pub cost: Cost,
    /// What the user should know about this step (velocity capped, support held …).
    pub warnings: Vec<Warning>,
}

/// What a cable does to the outline of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotContact {
    /// Its force on it, N.
    pub force_n: Vec2,
    /// Where it is: where it was led unless the cable was in its way.
    pub placement: RigidPose,
    /// How far that is from where it was led, m.
    pub left_m: f64,
}

/// What a model has for itself alone: the memory it works in, and its obstacles, among which it moves the outline of the robot.
#[derive(Debug)]
pub struct Own {
    memory: Option<Box<fem::contact_step::Workspace>>,
    problem: Arc<Problem>,
}

/// What every model does. One cable; time and positions in SI units.
pub trait Mechanics: Send {
    /// Which model this is.
    fn model(&self) -> Model;

    /// Why it is this model, where that changed on the way.
    fn reason(&self) -> Option<&str> {
        None
    }

    /// Why the model that was asked first has no answer, where another one gave the present one.
    fn refusal(&self) -> Option<&SolveError> {
        None
    }

    /// Finds the resting place at the present time from the present state (after `new`: from the route)
    /// and sets velocities to zero.
    ///
    /// # Errors
    /// A typed reason when there is none, or none was found.
    fn settle(&mut self) -> Result<StepReport, SolveError>;

    /// Advances time by exactly `dt_s` (sub-stepping inside as the model needs). On an error the state is
    /// the last good one, its time says how far it came.
    ///
    /// # Errors
    /// `TimeStep` for a step that is zero, negative, not finite or too large; `StepFailed` otherwise.
    fn advance(&mut self, dt_s: f64, inertia: Inertia) -> Result<StepReport, SolveError> {
        self.advance_gauged(dt_s, inertia, &mut TensionGauge::off())
    }

    /// The same; every inner step with inertia tells `gauge` the tension along the cable.
    ///
    /// # Errors
    /// As [`Self::advance`].
    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError>;

    /// Where the cable is.
    fn state(&self) -> State;

    /// Time reached, s.
    fn time_s(&self) -> f64 {
        self.state().time_s
    }

    /// Takes over a state of the same cable, resampled on this model's mesh (after an edit, or from another model).
    ///
    /// # Errors
    /// When a number is not finite or the state does not fit the cable; `Buried` when the model cannot go on from inside an obstacle.
    fn set_state(&mut self, state: &State) -> Result<(), SolveError>;

    /// Goes on from an answer of the same cable, by this model or another: as [`Self::set_state`], and where the model can,
    /// what friction held is still held.
    ///
    /// # Errors
    /// As [`Self::set_state`].
    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        self.set_state(&State::of_nodes(&answer.nodes, time_s))
    }

    /// From now on a support follows `target_m` (smoothly and no faster than [`Settings::hand_speed_m_per_s`] in `Dynamic` steps; at the
    /// next `settle` or quasi-static step it is there) instead of its `motion`. One of a robot goes there evenly in the next step, whatever that takes.
    fn drag_support(&mut self, support: usize, target_m: Vec2);

    /// From now on a hand at `hand_m` (m) holds a support by a spring ([`input_filter::Hand`]) in `Dynamic` steps, its free end no faster than
    /// [`Settings::hand_speed_m_per_s`]; else as [`Self::drag_support`], which ends it. A support without a node of its own (a pulley), and one of a robot, is dragged.
    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.drag_support(support, hand_m);
    }

    /// The outline of the robot goes there in the next advance; what is put somewhere ([`Self::set_state`]) finds it there at once.
    /// Models that know nothing of it leave it out.
    fn set_robot_pose(&mut self, _to: RigidPose) {}

    /// What the cable does to the outline of the robot; None where the model leaves it out, or there is none.
    fn robot_contact(&self) -> Option<RobotContact> {
        None
    }

    /// Gives the cable to the next model, where there is one behind this one, because of what the laws say of its answer; the next
    /// [`Self::settle`] is that model's. Returns whether there was one.
    fn fall_back(&mut self, _why: &str) -> bool {
        false
    }

    /// The answer at this instant.
    fn solution(&self) -> CableSolution;

    /// The problem it solves.
    fn problem(&self) -> &Arc<Problem>;

    /// Longest inner step that the next step with inertia is made of, s; infinite where there is none to speak of.
    fn inner_step_s(&self) -> f64 {
        f64::INFINITY
    }

    /// A copy to go back to, which does not hold what the model can have for itself alone.
    fn copy_to_keep(&self) -> Box<dyn Mechanics> {
        self.boxed_clone()
    }

    /// Gives away what it has for itself alone and what holds nothing of its state.
    fn lend(&mut self) -> Option<Own> {
        None
    }

    /// A copy that was kept goes on with what the model that it was copied from has lent, or with its own.
    fn borrow(&mut self, _own: Option<Own>) {}

    /// A copy with all its history, for reset and compare.
    fn boxed_clone(&self) -> Box<dyn Mechanics>;
}

/// Refuses friction that is fully mobilised towards one end for a model that finds its own.
///
/// # Errors
/// `Unsupported`.
fn refuse_mobilised(model: Model, problem: &Problem) -> Result<(), SolveError> {
    let mobilised = problem.cable.friction_mobilised;
    if mobilised.is_default() {
        return Ok(());
    }
    let feature =
        format!("friction mobilised {} (only spans answers that, of a flexible cable at rest)", mobilised.name());
    Err(SolveError::Unsupported { model, feature })
}

/// Builds the mechanics of one cable. `Auto` is resolved for rest (see [`auto::choose`]); where it chooses `spans`, `fem`
/// stands behind it ([`switching::SwitchingModel`]).
///
/// # Errors
/// `Setting` when the settings are out of range, `Unsupported` when the model lacks what the scene needs.
pub fn build(model: Model, problem: Arc<Problem>, settings: Settings) -> Result<Box<dyn Mechanics>, SolveError> {
    settings.validate()?;
    built(model, problem, settings)
}

fn built(model: Model, problem: Arc<Problem>, settings: Settings) -> Result<Box<dyn Mechanics>, SolveError> {
    if let Some((by, copy)) = problem.similar.clone() {
        let hand_speed_m_per_s = settings.hand_speed_m_per_s * by.length / by.time;
        let hand_stiffness_n_per_m = settings.hand_stiffness_n_per_m.map(|k| k / by.length);
        let inner = built(model, copy, Settings { hand_speed_m_per_s, hand_stiffness_n_per_m, ..settings })?;
        return Ok(Box::new(similar::Similar::new(problem, by, inner)));
    }
    if !matches!(model, Model::Spans | Model::Auto) {
        refuse_mobilised(model, &problem)?;
    }
    match model {
        Model::Catenary => Ok(Box::new(catenary::CatenaryModel::new(Problem::without_outline(problem), settings)?)),
        Model::Spans => Ok(Box::new(spans::SpansModel::new(Problem::without_outline(problem), settings)?)),
        Model::Fem => Ok(Box::new(fem::FemModel::new(problem, settings)?)),
        Model::MassSpring => {
            Ok(Box::new(mass_spring::MassSpringModel::new(Problem::without_outline(problem), settings)?))
        }
        Model::Auto => match auto::choose(&problem, auto::Question::Rest).0 {
            Model::Spans => Ok(Box::new(switching::SwitchingModel::new(problem, settings)?)),
            chosen => built(chosen, problem, settings),
        },
    }
}

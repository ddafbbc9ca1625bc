//! A simulation is the object that users hold: a scene, a model for each cable, and their state.
//!
//! | room | content |
//! |---|---|
//! | `simulation.rs` | [`Simulation`]: settle, step, reset, edit |
//! | `model_fallback.rs` | answers that break a law are refused, and the next model is asked |
//! | `robot_coupling.rs` | robot and cables in one step |
//! | `speed_search.rs` | the speed of the robot at which both agree |
//! | `non_unique_equilibrium.rs` | warnings of equilibria that are one of many |
//! | `loading_histories.rs` | tensions that other loading histories would have left |
//! | `cheaper_model_error.rs` | error of the next cheaper model |

mod cheaper_model_error;
mod loading_histories;
mod model_fallback;
mod non_unique_equilibrium;
mod robot_coupling;
mod speed_search;

use std::sync::Arc;

use crate::answer_verifier::{Depth, Verification, Verifier};
use crate::any_error::Error;
use crate::error::SolveError;
use crate::math::{Vec2, larger};
use crate::model::auto::{self, Question};
use crate::model::{Inertia, MIN_TOLERANCE, Mechanics, Model, ModelSource, Settings, StepReport};
use crate::problem::{Problem, problems};
use crate::robot::Vehicle;
use crate::scene::Scene;
use crate::simulated_cable::SimulatedCable;
use crate::solution::error_estimates::MIN_COMPARED_ELEMENTS;
use crate::solution::{
    CableSolution, Cost, Energy, ErrorEstimates, MaxTension, ModelReason, MomentumAccount, NextCheaper, Node,
    SharedNodes, Solution, TensionPeaks, Warning, WarningCause, WarningKind, material_point_motion,
};
use crate::state::State;
use crate::warnings::{Observed, SharpestBends, WarningMonitor};

/// Step with inertia, s: the inner step of `fem`.
pub(crate) const STEP_S: f64 = 1.0 / 240.0;

/// Longest step a display frame takes, s: longer makes one slow frame cause the next, shorter slows
/// time at 10 Hz.
const MAX_FRAME_S: f64 = 0.1;

/// Longest step with inertia, s: a quarter of a million inner steps. With a longer step a typing
/// error would compute for hours without a message.
const MAX_STEP_S: f64 = 1e3;

/// Longest step without inertia, s.
const MAX_QUASI_STATIC_STEP_S: f64 = 1e6;

/// A scene being solved.
#[derive(Clone)]
pub struct Simulation {
    scene: Scene,
    /// The model that the user asked for.
    requested: Model,
    /// The model that was built: `Auto` where two may take turns.
    source: ModelSource,
    /// The model in use: the most general one that any of the cables uses.
    model: Model,
    reason: ModelReason,
    settings: Settings,
    cables: Vec<SimulatedCable>,
    start: Option<Vec<SimulatedCable>>,
    vehicle: Option<Vehicle>,
    /// The answers of the cables at the present instant.
    answers: Vec<CableSolution>,
    /// Nodes of the cables when the run began.
    initial_nodes: Vec<SharedNodes>,
    warning_monitor: WarningMonitor,
    energy: Energy,
    cost: Cost,
    warnings: Vec<Warning>,
    verifier: Arc<Verifier>,
    verification: Verification,
    /// Of the present equilibrium; None in motion.
    next_cheaper: Option<NextCheaper>,
}

/// A model that was chosen for a scene.
struct Choice {
    /// The model that answers report.
    model: Model,
    /// The constructor of the model.
    source: ModelSource,
    /// The reason that answers report.
    reason: ModelReason,
}

/// The place of an instant in a run: it begins one or continues one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RunPhase {
    /// The cables rest, and a run begins here.
    AtRest,
    /// A run goes on.
    InMotion,
}

/// The reports of several steps, summed.
struct StepSum {
    report: StepReport,
    /// Of each cable.
    peaks: Vec<Option<TensionPeaks>>,
    momentum: Vec<Option<MomentumAccount>>,
}

impl StepSum {
    /// Of the step that a simulation has just made.
    fn of(simulation: &mut Simulation) -> Self {
        Self {
            report: StepReport { cost: simulation.cost, warnings: std::mem::take(&mut simulation.warnings) },
            peaks: simulation.answers.iter().map(|a| a.peaks).collect(),
            momentum: simulation.answers.iter().map(|a| a.momentum).collect(),
        }
    }

    /// With the step after those.
    fn then(mut self, simulation: &mut Simulation) -> Self {
        let next = Self::of(simulation);
        self.report.add(next.report);
        for (sum, next) in self.peaks.iter_mut().zip(next.peaks) {
            *sum = sum.zip(next).map(|(sum, next)| sum.with(next)).or(next);
        }
        for (sum, next) in self.momentum.iter_mut().zip(next.momentum) {
            *sum = sum.zip(next).map(|(sum, next)| sum.then(&next));
        }
        self
    }

    /// Has the simulation say it.
    fn tell(self, simulation: &mut Simulation) {
        (simulation.cost, simulation.warnings) = (self.report.cost, self.report.warnings);
        for ((answer, peaks), momentum) in simulation.answers.iter_mut().zip(self.peaks).zip(self.momentum) {
            (answer.peaks, answer.momentum) = (peaks, momentum);
        }
    }
}

impl Simulation {
    /// Validates the scene and builds the model of each of its cables, at their routes, at rest.
    ///
    /// # Errors An error names the fault of the scene, or the missing feature of the model.
    pub fn new(scene: Scene, model: Model) -> Result<Self, Error> {
        Self::with_settings(scene, model, Settings::default())
    }

    /// As [`Self::new`], with settings.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_settings(scene: Scene, model: Model, settings: Settings) -> Result<Self, Error> {
        Self::for_question(scene, model, settings, Question::Rest)
    }

    /// As [`Self::with_settings`]; `Model::Auto` is resolved for the question that will be asked.
    /// One model serves the whole scene: the most general one that any cable needs, and a more
    /// general one where that lacks a feature.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn for_question(scene: Scene, model: Model, settings: Settings, question: Question) -> Result<Self, Error> {
        settings.validate()?;
        Self::of_models(scene, model, settings, question)
    }

    /// The same, with settings that may be those of a coarser run.
    fn of_models(scene: Scene, model: Model, settings: Settings, question: Question) -> Result<Self, Error> {
        let problems = problems(&scene)?;
        if !model.is_automatic() {
            let source = ModelSource::Registered(model);
            return Self::from_choice(
                scene,
                &problems,
                settings,
                Choice { model, source, reason: ModelReason::Requested },
            );
        }
        let (chosen, reason) = auto::choose_for_all(&problems, question);
        let source = ModelSource::Registered(auto::built_for(chosen));
        let built = Self::from_choice(scene.clone(), &problems, settings, Choice { model: chosen, source, reason });
        let mut this = match built {
            Err(Error::Solve(SolveError::Unsupported { feature, .. })) if chosen != Model::MOST_CAPABLE => {
                let reason = ModelReason::NoAnswer(Box::new(SolveError::Unsupported { model: chosen, feature }));
                let (model, source) = (Model::MOST_CAPABLE, ModelSource::Registered(Model::MOST_CAPABLE));
                Self::from_choice(scene, &problems, settings, Choice { model, source, reason })?
            }
            built => built?,
        };
        this.requested = Model::Auto;
        Ok(this)
    }

    /// As [`Self::with_settings`], by a model of the program's own: `constructor` is called for
    /// each cable, and for each piece that one breaks into.
    ///
    /// # Errors
    /// As [`Self::new`], or what the constructor says.
    pub fn with_mechanics<F>(scene: Scene, settings: Settings, constructor: F) -> Result<Self, Error>
    where
        F: Fn(Arc<Problem>, Settings) -> Result<Box<dyn Mechanics>, SolveError> + Send + Sync + 'static,
    {
        settings.validate()?;
        Self::by_source(scene, settings, ModelSource::External(Arc::new(constructor)))
    }

    /// As [`Self::with_settings`], by a model of the program or of the user.
    fn by_source(scene: Scene, settings: Settings, source: ModelSource) -> Result<Self, Error> {
        if let ModelSource::Registered(model) = source {
            return Self::of_models(scene, model, settings, Question::Rest);
        }
        let problems = problems(&scene)?;
        let choice = Choice { model: source.model(), source, reason: ModelReason::Requested };
        Self::from_choice(scene, &problems, settings, choice)
    }

    /// Builds every cable by the model that was chosen.
    fn from_choice(scene: Scene, problems: &[Arc<Problem>], settings: Settings, choice: Choice) -> Result<Self, Error> {
        let Choice { model, source, reason } = choice;
        let cables = problems.iter().map(|p| SimulatedCable::new(source.clone(), p.clone(), settings));
        let cables = cables.collect::<Result<Vec<_>, SolveError>>()?;
        let answers = cables.iter().map(SimulatedCable::answer).collect();
        Ok(Self {
            vehicle: Vehicle::of(&scene),
            verifier: Arc::new(Verifier::new(&scene)),
            verification: Verification::default(),
            next_cheaper: None,
            scene,
            requested: model,
            source,
            model,
            reason,
            settings,
            cables,
            start: None,
            answers,
            initial_nodes: Vec::new(),
            warning_monitor: WarningMonitor::default(),
            energy: Energy::default(),
            cost: Cost::default(),
            warnings: Vec::new(),
        })
    }

    /// Reads the present instant: the answers and their warnings.
    fn refresh(&mut self, instant: RunPhase) {
        self.read_answers();
        self.judge_answers(instant);
    }

    /// Reads the answers of the cables, which are not judged yet.
    fn read_answers(&mut self) {
        self.answers = self.cables.iter().map(SimulatedCable::answer).collect();
    }

    /// Finds displacements, bends, energy and warnings of the answers, and verifies them.
    fn judge_answers(&mut self, instant: RunPhase) {
        match instant {
            RunPhase::AtRest => self.initial_nodes = self.answers.iter().map(|a| a.nodes.clone()).collect(),
            RunPhase::InMotion => {
                for (answer, first) in self.answers.iter_mut().zip(&self.initial_nodes) {
                    material_point_motion::displace(&mut answer.nodes, first);
                }
            }
        }
        self.model = self.cables.iter().map(SimulatedCable::model).max_by_key(|m| m.rank()).unwrap_or(self.model);
        let mut bends = Vec::with_capacity(self.cables.len());
        for (cable, answer) in self.cables.iter().zip(&mut self.answers) {
            let found = SharpestBends::of(cable.problem(), answer);
            (answer.tightest_bend, answer.sidewall_pressure) = (found.tightest(), found.pressure);
            (answer.free_bend, answer.judged_bend) = (found.free(), found.judged());
            bends.push(found);
        }
        let time_s = self.time_s();
        let observed: Vec<Observed<'_>> = (self.cables.iter().zip(&self.answers).zip(bends))
            .map(|((c, answer), bends)| {
                let energy = Energy::of(c.problem(), answer);
                Observed { problem: c.problem(), answer, energy, bends, breaks: c.breaks() }
            })
            .collect();
        self.energy = observed.iter().map(|s| s.energy).sum();
        if instant == RunPhase::InMotion {
            self.warning_monitor.moving(&observed, time_s)
        } else {
            self.warning_monitor.at_rest(&observed, time_s)
        }
        self.warn_through_robot();
        self.warn_robot_in_obstacle();
        self.warn_without_ground();
        self.verification = self.verify(&self.answers);
        self.next_cheaper = None;
    }

    /// Verifies answers for the cables, with the robot in its present pose.
    fn verify(&self, answers: &[CableSolution]) -> Verification {
        let robot = self.vehicle.as_ref().map(Vehicle::report);
        self.verifier.check_cables(&self.scene, answers, robot.as_ref(), self.time_s(), Depth::Always)
    }

    /// Warns where an answer lies through the robot: models other than `fem` do not see it.
    fn warn_through_robot(&mut self) {
        self.warnings.retain(|w| w.kind != WarningKind::ThroughRobot);
        let Some(at) = self.vehicle.as_ref().map(|v| v.pose().placement()) else { return };
        for (cable, answer) in self.cables.iter().zip(&self.answers) {
            let problem = cable.problem();
            let Some(outline) = problem.outline.as_ref().filter(|_| cable.robot_contact().is_none()) else { continue };
            if !outline.is_clear(at, answer.nodes.iter().map(Node::at), problem.radius) {
                let cause = WarningCause::RobotIgnored { model: cable.model() };
                self.warnings.push(Warning::new(cause, &answer.name, problem.length, [0.0; 2]));
            }
        }
    }

    /// Warns where the robot stands in an obstacle that is no terrain: only terrain stops it.
    fn warn_robot_in_obstacle(&mut self) {
        self.warnings.retain(|w| w.kind != WarningKind::RobotInObstacle);
        let Some(at) = self.vehicle.as_ref().map(|v| v.pose().placement()) else { return };
        let Some(problem) = self.cables.first().map(SimulatedCable::problem) else { return };
        let Some(outline) = &problem.outline else { return };
        let met = self.scene.obstacles.iter().filter(|o| outline.overlaps(at, &o.shape));
        let place = [at.at.x, at.at.y];
        let warnings = met.map(|o| {
            let cause = WarningCause::RobotInObstacle { obstacle: o.name.clone() };
            Warning::new(cause, &problem.cable.name, problem.length, [0.0; 2]).at(place)
        });
        let warnings: Vec<Warning> = warnings.collect();
        self.warnings.extend(warnings);
    }

    /// Warns where a robot has a path that it cannot drive from the start on.
    fn warn_without_ground(&mut self) {
        self.warnings.retain(|w| w.cause != WarningCause::RobotWithoutGround);
        let robot = self.scene.robot.as_ref().filter(|r| self.vehicle.is_none() && !r.path.is_empty());
        let (Some(robot), Some(cable)) = (robot, self.scene.cables.first()) else { return };
        let warning = Warning::new(WarningCause::RobotWithoutGround, &cable.name, cable.length_m, [0.0; 2]);
        self.warnings.push(warning.at(robot.at_m));
    }

    #[cfg(test)]
    pub(crate) fn cables(&self) -> &[SimulatedCable] {
        &self.cables
    }

    #[cfg(test)]
    pub(crate) fn cables_mut(&mut self) -> &mut [SimulatedCable] {
        &mut self.cables
    }

    /// The settings with which it was built.
    #[must_use]
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Sets the error estimates of the present answers.
    pub(crate) fn set_error_estimates(&mut self, errors: impl Iterator<Item = ErrorEstimates>) {
        for (answer, errors) in self.answers.iter_mut().zip(errors) {
            (answer.error_estimate, answer.errors) = (errors.relative(answer), errors);
        }
    }

    /// Sets further warnings of the present instant.
    pub(crate) fn set_break_warnings(&mut self, warnings: Vec<Warning>) {
        self.warnings.retain(|w| w.kind != WarningKind::MayBreak);
        self.warnings.extend(warnings);
    }

    /// The scene being solved.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The model in use.
    #[must_use]
    pub fn model(&self) -> Model {
        self.model
    }

    /// The reason for that model.
    #[must_use]
    pub fn reason(&self) -> &ModelReason {
        // A requested model keeps this reason, whatever happens in the run.
        if self.reason == ModelReason::Requested {
            return &self.reason;
        }
        self.cables.iter().find_map(SimulatedCable::reason).unwrap_or(&self.reason)
    }

    /// Time reached, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.cables.first().map_or(0.0, SimulatedCable::time_s)
    }

    /// Finds where everything rests. The first answer is kept as the start that [`Self::reset`]
    /// returns to.
    ///
    /// # Errors
    /// A typed reason when there is no resting place, or none was found; the state is then as
    /// before.
    pub fn settle(&mut self) -> Result<Solution, SolveError> {
        let before = self.cables.clone();
        let found = self.settle_until_verified();
        if found.is_err() {
            self.cables = before;
            self.refresh(RunPhase::AtRest);
        }
        found?;
        self.warn_not_unique();
        if self.requested.is_automatic() && self.settings.histories {
            let problems = self.cables.iter().map(SimulatedCable::problem);
            let cables = problems.zip(&self.answers).filter(|_| self.time_s() == 0.0);
            self.next_cheaper = cheaper_model_error::next_cheaper(cables, self.reason(), self.settings);
        }
        if self.start.is_none() {
            self.start = Some(self.cables.clone());
        }
        Ok(self.solution())
    }

    /// Advances time with inertia by `dt_s` (s).
    ///
    /// # Errors
    /// See [`Mechanics::advance`].
    pub fn step(&mut self, dt_s: f64) -> Result<(), SolveError> {
        self.advance(dt_s, Inertia::Dynamic)
    }

    /// Advances time without inertia by `dt_s` (s).
    ///
    /// # Errors
    /// See [`Mechanics::advance`].
    pub fn step_quasi_static(&mut self, dt_s: f64) -> Result<(), SolveError> {
        self.advance(dt_s, Inertia::QuasiStatic)
    }

    /// Returns whether a step (s) can be made: it is positive and not longer than what is meant.
    pub(crate) fn check_step(dt_s: f64, inertia: Inertia) -> Result<(), SolveError> {
        let longest_s = match inertia {
            Inertia::Dynamic => MAX_STEP_S,
            Inertia::QuasiStatic => MAX_QUASI_STATIC_STEP_S,
        };
        if dt_s > 0.0 && dt_s <= longest_s { Ok(()) } else { Err(SolveError::TimeStep { dt_s, longest_s }) }
    }

    fn advance(&mut self, dt_s: f64, inertia: Inertia) -> Result<(), SolveError> {
        match inertia {
            Inertia::Dynamic => self.advance_steps(1, |_| dt_s, |_| ()),
            Inertia::QuasiStatic => self.advance_quasi_static(dt_s),
        }
    }

    /// Advances by `dt_s` (s) without inertia; if the answer violates a law, the next model
    /// answers.
    fn advance_quasi_static(&mut self, dt_s: f64) -> Result<(), SolveError> {
        let done = self.advance_unjudged(dt_s, Inertia::QuasiStatic);
        self.judge_answers(RunPhase::InMotion);
        done?;
        let Err(error) = self.verify_answers() else { return Ok(()) };
        if !self.switch_model(&error) {
            return Err(error);
        }
        self.settle_until_verified()
    }

    /// Advances time with inertia by several steps, each as long (s) as `dt_s` says of the time
    /// (s) before it, and judges the answer at the end alone: its peaks, its account of momentum
    /// and its warnings are of all of them. `each` sees the answers after each.
    ///
    /// # Errors
    /// See [`Mechanics::advance`].
    pub(crate) fn advance_steps(
        &mut self,
        count: u64,
        dt_s: impl Fn(f64) -> f64,
        mut each: impl FnMut(&Self),
    ) -> Result<(), SolveError> {
        let mut sum: Option<StepSum> = None;
        let (mut done, mut last_s, mut nodes_before) = (Ok(()), 0.0, Vec::new());
        for _ in 0..count {
            last_s = dt_s(self.time_s());
            Self::check_step(last_s, Inertia::Dynamic)?;
            nodes_before = self.answers.iter().map(|a| a.nodes.clone()).collect();
            done = self.advance_unjudged(last_s, Inertia::Dynamic);
            sum = Some(match sum {
                None => StepSum::of(self),
                Some(sum) => sum.then(self),
            });
            if done.is_err() {
                break;
            }
            each(self);
        }
        let Some(sum) = sum else { return Ok(()) };
        sum.tell(self);
        self.judge_answers(RunPhase::InMotion);
        done?;
        // In motion nothing else is there to go back to: the verdict stands with the answer.
        for (answer, before) in self.answers.iter_mut().zip(&nodes_before) {
            material_point_motion::accelerate(&mut answer.nodes, before, last_s);
        }
        Ok(())
    }

    /// Advances time by a step (s) and reads the answers, which are not judged.
    ///
    /// # Errors
    /// See [`Mechanics::advance`].
    pub(crate) fn advance_unjudged(&mut self, dt_s: f64, inertia: Inertia) -> Result<(), SolveError> {
        Self::check_step(dt_s, inertia)?;
        self.cables.iter_mut().for_each(SimulatedCable::begin_step);
        let done = match self.vehicle.is_some() {
            true => self.advance_with_robot(dt_s, inertia),
            false => self.for_each_cable(|c| c.advance(dt_s, inertia)),
        };
        // A cable alone that fails stays where it came: that is what there is to see then.
        self.read_answers();
        done
    }

    /// Limits the work of each step of a cable, see [`crate::model::Mechanics::limit_work`].
    pub(crate) fn limit_work(&mut self, work: usize) {
        self.cables.iter_mut().for_each(|cable| cable.limit_work(work));
    }

    /// The work of the last step on elements, in iterations times nodes of a cable; models without
    /// elements need little.
    pub(crate) fn work_of_step(&self) -> usize {
        if !self.model().capabilities().mesh {
            return 0;
        }
        let nodes: usize = self.answers.iter().map(|answer| answer.nodes.len()).sum();
        self.cost.iterations * nodes / self.answers.len().max(1)
    }

    /// The largest tension of some cables now, N (NaN propagates).
    pub fn largest_n(&self, cables: impl IntoIterator<Item = usize>) -> f64 {
        let nodes = cables.into_iter().filter_map(|k| self.answers.get(k)).flat_map(|a| &a.nodes);
        nodes.map(|n| n.tension_n).fold(0.0, larger)
    }

    /// Advances by a display frame: at most 0.1 s, so a stalled picture makes time run
    /// slower instead of a step nobody sees. Returns the time advanced (s); its ratio to `dt_s` is
    /// the speed to show.
    ///
    /// # Errors
    /// `TimeStep` for a frame that is zero, negative or not a number; otherwise as [`Self::step`].
    pub fn advance_frame(&mut self, dt_s: f64) -> Result<f64, SolveError> {
        if !(dt_s > 0.0) {
            return Err(SolveError::TimeStep { dt_s, longest_s: f64::INFINITY });
        }
        let step_s = if dt_s > MAX_FRAME_S { MAX_FRAME_S } else { dt_s };
        self.step(step_s)?;
        Ok(step_s)
    }

    /// A new simulation of the same scene by the same model at its start, with so many times as
    /// many elements and inner steps so many times as short; None where a cable would have too few
    /// elements for an error estimate. It has not settled.
    ///
    /// # Errors
    /// As [`Self::new`]; what the settings then ask for is out of range.
    pub fn resolved(&self, times: f64) -> Result<Option<Self>, Error> {
        let mut scene = self.scene.clone();
        for (cable, answer) in scene.cables.iter_mut().zip(&self.answers) {
            let elements = (answer.nodes.len().saturating_sub(1) as f64 * times).floor() as usize;
            if elements < MIN_COMPARED_ELEMENTS {
                return Ok(None);
            }
            cable.segments = Some(elements);
        }
        let settings = Settings {
            // Steps of a taut cable follow its frequency, as the square root of it.
            tolerance: larger(self.settings.tolerance / (times * times), MIN_TOLERANCE),
            segments: None,
            inner_step_s: Some(self.settings.inner_step_s.unwrap_or(STEP_S) / times),
            histories: false,
            // A run beside another only serves as a measure of its error.
            energy_account: self.settings.energy_account && times >= 1.0,
            ..self.settings
        };
        let source = match &self.source {
            ModelSource::Registered(_) => ModelSource::Registered(auto::built_for(self.model)),
            external @ ModelSource::External(_) => external.clone(),
        };
        let mut next = Self::by_source(scene, settings, source)?;
        next.reason.clone_from(&self.reason);
        Ok(Some(next))
    }

    /// The same run with an edited scene: cables keep their shape, speed and time; the start of
    /// [`Self::reset`] is that of the new scene once it is settled.
    ///
    /// # Errors An error names the fault of the new scene; the old simulation is unchanged.
    pub fn with_scene(&self, scene: Scene, settings: Settings) -> Result<Self, Error> {
        settings.validate()?;
        let mut next = Self::by_source(scene, settings, self.source.clone())?;
        next.reason.clone_from(&self.reason);
        next.carry(self)?;
        Ok(next)
    }

    /// Advances every cable. Where one of several fails, all go back to where they were, so that
    /// none is a step ahead. (A single cable stays where it came to, see [`Mechanics::advance`].)
    fn for_each_cable(
        &mut self,
        mut f: impl FnMut(&mut SimulatedCable) -> Result<StepReport, SolveError>,
    ) -> Result<(), SolveError> {
        let (mut cost, mut warnings) = (Cost::default(), Vec::new());
        let several = self.cables.len() > 1;
        let mut before = Vec::with_capacity(if several { self.cables.len() } else { 0 });
        for k in 0..self.cables.len() {
            let Some(cable) = self.cables.get_mut(k) else { break };
            if several {
                before.push(cable.clone());
            }
            let report = match f(cable) {
                Ok(report) => report,
                Err(error) => {
                    for (cable, old) in self.cables.iter_mut().zip(before) {
                        *cable = old;
                    }
                    return Err(error);
                }
            };
            cost.iterations += report.cost.iterations;
            cost.halved_steps += report.cost.halved_steps;
            cost.residual_n = larger(cost.residual_n, report.cost.residual_n);
            cost.inner_step_s = cost.inner_step_s.max(report.cost.inner_step_s);
            warnings.extend(report.warnings);
        }
        self.cost = cost;
        self.warnings = warnings;
        Ok(())
    }

    /// The answers of the cables at the present instant, in the scene's order.
    #[must_use]
    pub fn answers(&self) -> &[CableSolution] {
        &self.answers
    }

    /// The greatest tension of all cables now (NaN propagates).
    #[must_use]
    pub fn max_tension(&self) -> MaxTension {
        MaxTension::of(&self.answers)
    }

    /// The warnings of this instant.
    pub fn warnings(&self) -> impl Iterator<Item = &Warning> {
        self.warnings.iter().chain(self.warning_monitor.warnings())
    }

    /// The answer at this instant; its warnings include limits that the cables exceed.
    #[must_use]
    pub fn solution(&self) -> Solution {
        let warnings = self.warnings().cloned().collect();
        Solution {
            time_s: self.time_s(),
            model: self.model,
            reason: self.reason().clone(),
            next_cheaper: self.next_cheaper,
            cables: self.answers.clone(),
            warnings,
            cost: self.cost,
            energy: self.energy,
            verification: Some(self.verification.clone()),
            robot: self.vehicle.as_ref().map(Vehicle::report),
        }
    }

    /// From now on no cable breaks, whatever pulls it.
    pub(crate) fn prevent_breaks(&mut self) {
        self.cables.iter_mut().for_each(SimulatedCable::prevent_breaks);
    }

    /// Drags a support to a place (m), whatever force that takes: see [`Mechanics::drag_support`].
    pub fn drag_support(&mut self, cable: usize, support: usize, target_m: Vec2) {
        if let Some(c) = self.cables.get_mut(cable) {
            c.drag_support(support, target_m);
        }
    }

    /// Holds a support by a hand at `hand_m` (m), by a spring while masses move: what it pulls with
    /// stands in the answer ([`SupportReaction::hand`](crate::solution::SupportReaction::hand)).
    /// See [`Mechanics::pull_support`].
    pub fn pull_support(&mut self, cable: usize, support: usize, hand_m: Vec2) {
        if let Some(c) = self.cables.get_mut(cable) {
            c.pull_support(support, hand_m);
        }
    }

    /// The hand lets a support go, which is then fixed where it is: returns where, m.
    pub fn let_go(&mut self, cable: usize, support: usize) -> Option<Vec2> {
        let now = self.answers.get(cable)?.supports.get(support).filter(|s| s.hand.is_some())?;
        let at = Vec2::new(now.x_m, now.y_m);
        self.drag_support(cable, support, at);
        Some(at)
    }

    /// Goes back to the first settled state, bit for bit.
    pub fn reset(&mut self) {
        if let Some(start) = &self.start {
            self.cables.clone_from(start);
            self.vehicle = Vehicle::of(&self.scene);
            self.cost = Cost::default();
            self.warnings.clear();
            self.refresh(RunPhase::AtRest);
        }
    }

    /// Returns the state of each cable. Where a cable broke, its state has two nodes of the same
    /// arc length.
    #[must_use]
    pub fn states(&self) -> Vec<State> {
        self.cables.iter().map(SimulatedCable::state).collect()
    }

    /// Continues from the state of `old`, a simulation of the same cables, with the same breaks.
    ///
    /// # Errors An error is returned if a state does not fit its cable.
    pub fn carry(&mut self, old: &Self) -> Result<(), SolveError> {
        if let (Some(new), Some(old), true) = (&mut self.vehicle, &old.vehicle, old.time_s() > 0.0) {
            new.carry(old);
        }
        self.set_robot_pose();
        for (new, old) in self.cables.iter_mut().zip(&old.cables) {
            new.continue_from(old)?;
        }
        self.refresh(RunPhase::AtRest);
        Ok(())
    }

    /// Takes over states of the same cables, all whole.
    ///
    /// # Errors An error is returned if a state does not fit its cable, or the cable broke.
    pub fn set_states(&mut self, states: &[State]) -> Result<(), SolveError> {
        for (c, s) in self.cables.iter_mut().zip(states) {
            c.set_state(s)?;
        }
        self.refresh(RunPhase::AtRest);
        Ok(())
    }

    /// Goes on from an answer of an earlier instant of the same scene: cables where and as fast as
    /// they were, all whole, the robot where it was. What an answer does not hold is lost: friction
    /// takes hold anew, a robot that waits begins to wait again.
    ///
    /// # Errors
    /// As [`Self::set_states`].
    pub fn resume(&mut self, answer: &Solution) -> Result<(), SolveError> {
        let states: Vec<State> = answer.cables.iter().map(|c| State::of_nodes(&c.nodes, answer.time_s)).collect();
        if let (Some(vehicle), Some(then)) = (&mut self.vehicle, &answer.robot) {
            vehicle.resume(then);
        }
        self.set_robot_pose();
        self.set_states(&states)
    }
}

impl std::fmt::Debug for Simulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Simulation")
            .field("scene", &self.scene.name)
            .field("model", &self.model)
            .field("time_s", &self.time_s())
            .finish()
    }
}

//! The switching model is what `auto` builds where a cable can touch something: `spans` while it is
//! taut and slow, else `fem`.
//!
//! `spans` goes first. If it loses the tension, cannot lay the cable, or finds no answer, `fem`
//! continues from the last state with its friction ([`Mechanics::warm_start`]); with inertia `fem`
//! is always used. A cable with self-contact is first solved as if it could pass through itself,
//! and by `fem` if its strands then meet, or pass each other on the way from the last answer. From
//! time to time an answer of `fem` without inertia is offered back; `spans` takes over if its own
//! answer there is practically the same.

use std::any::Any;
use std::sync::Arc;

use crate::error::{SolveError, Unsupported};
use crate::math::RigidPose;
use crate::math::Vec2;
use crate::model::fem::FemModel;
use crate::model::initial_equilibrium::{
    StrandWatch, is_buried, meets_itself, meets_outline, slid_first, slides_on, work,
};
use crate::model::mobilised_friction::refuse_mobilised;
use crate::model::spans::SpansModel;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{BreakPlace, Inertia, Mechanics, Model, OwnedResources, RobotContact, Settings, StepReport};
use crate::problem::Problem;
use crate::solution::{CableSolution, ContactState, Energy, ErrorEstimates, ModelReason, Node, Warning};
use crate::state::State;

/// Greatest displacement of the cable when it is handed back, the larger of a length (m) and a
/// fraction of the cable: not visible.
const MAX_MOVE: (f64, f64) = (1e-3, 1e-4);
/// Greatest change of tension when it is handed back, relative to the greatest tension.
const MAX_TENSION_CHANGE: f64 = 1e-2;
/// First number of answers of `fem` between two offers; each offer doubles it.
const FIRST_INTERVAL: usize = 1;
/// Greatest number of answers between two offers.
const MAX_INTERVAL: usize = 8;

/// Two models of one cable, one at a time.
#[derive(Clone, Debug)]
pub struct SwitchingModel {
    settings: Settings,
    /// The problem with the robot's outline and self-contact, which `spans` does not model.
    problem: Arc<Problem>,
    spans: SpansModel,
    /// It holds the present state if it exists.
    fem: Option<FemModel>,
    /// Adopted state of the cable, until it is known to rest or to move.
    adopted: Option<State>,
    /// Errors of the answer from which `spans` goes on, as long as friction remembers it.
    remembered: Option<ErrorEstimates>,
    dragged: Vec<Option<Vec2>>,
    /// True for those that a hand holds by a spring.
    pulled: Vec<bool>,
    /// Pose to which the outline of the robot was moved.
    robot_pose: Option<RigidPose>,
    reason: Option<ModelReason>,
    /// The reason why `spans` has no equilibrium, if `fem` found one.
    refusal: Option<SolveError>,
    /// Number of answers until the next offer, and until the one after that.
    interval: [usize; 2],
    /// The most work of a search for an equilibrium or an advance, where that is bounded.
    max_work: Option<usize>,
}

/// The memory of `fem`, from which it continues after an edit of the scene.
struct FemContinuation {
    fem: Box<dyn Any + Send>,
    reason: Option<ModelReason>,
    interval: [usize; 2],
}

impl SwitchingModel {
    /// Builds it at the route.
    ///
    /// # Errors `Unsupported` if the scene needs a feature that neither model has.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        let dragged = vec![None; problem.supports.len()];
        let simpler = Problem::without_self_contact(Problem::without_outline(problem.clone()));
        let spans = SpansModel::new(simpler, settings)?;
        Ok(Self {
            settings,
            robot_pose: problem.outline.as_ref().map(|o| o.placement),
            problem,
            spans,
            fem: None,
            adopted: None,
            remembered: None,
            pulled: vec![false; dragged.len()],
            dragged,
            reason: None,
            refusal: None,
            interval: [FIRST_INTERVAL; 2],
            max_work: None,
        })
    }

    /// `fem`, which holds the present state from now on; `why` counts where it did not before.
    fn fem(&mut self, why: Option<ModelReason>) -> Result<&mut FemModel, SolveError> {
        let fem = match self.fem.take() {
            Some(fem) => fem,
            None => {
                let inertia = match why {
                    Some(ModelReason::Inertia) => Inertia::Dynamic,
                    _ => Inertia::QuasiStatic,
                };
                let fem = self.hand_over_to_fem(inertia)?;
                self.reason = why;
                self.interval[0] = self.interval[1];
                fem
            }
        };
        Ok(self.fem.insert(fem))
    }

    /// `fem` from where `spans` is, for steps with or without inertia.
    fn hand_over_to_fem(&self, inertia: Inertia) -> Result<FemModel, SolveError> {
        let mut fem = self.new_fem()?;
        let answer = self.spans.solution();
        let is_buried = || self.spans.time_s() == 0.0 && is_buried(&self.problem, &answer.nodes);
        if self.meets_robot(&answer) || meets_itself(&self.problem, &answer.nodes) || is_buried() {
            // The answer ignores the robot or self-contact, or there is none: the cable is laid
            // anew.
        } else if let Some(state) = &self.adopted {
            fem.set_state(state)?;
        } else if self.spans.has_equilibrium() {
            // Dragged supports are at their present positions, not yet at their targets.
            for (k, at) in answer.supports.iter().enumerate().filter(|(k, _)| self.is_dragged(*k)) {
                fem.drag_support(k, Vec2::new(at.x_m, at.y_m));
            }
            fem.warm_start(&answer, self.spans.time_s())?;
            if inertia == Inertia::QuasiStatic {
                fem.estimate_errors_from(&self.known_answer());
            }
        } else if self.spans.time_s() > 0.0 {
            fem.set_state(&self.spans.state())?;
        }
        self.draw_supports(&mut fem);
        Ok(fem)
    }

    /// The answer of `spans`, with the errors that its friction remembers.
    fn known_answer(&self) -> CableSolution {
        let answer = self.spans.solution();
        match self.remembered {
            Some(errors) => {
                let errors = answer.errors.plus(&errors);
                answer.known_to(errors)
            }
            None => answer,
        }
    }

    /// `fem` along the route, with the robot at its pose.
    fn new_fem(&self) -> Result<FemModel, SolveError> {
        refuse_mobilised(Model::Fem, &self.problem)?;
        let mut fem = FemModel::new(self.problem.clone(), self.settings)?;
        fem.start_without_spans();
        if let Some(work) = self.max_work {
            fem.limit_work(work);
        }
        if let Some(robot_pose) = self.robot_pose {
            fem.set_robot_pose(robot_pose);
        }
        Ok(fem)
    }

    /// As [`Self::new_fem`], with supports moved to their targets, and the cable in the adopted
    /// state.
    fn new_fem_with_hands(&self) -> Result<FemModel, SolveError> {
        let mut fem = self.new_fem()?;
        if let Some(state) = &self.adopted {
            fem.set_state(state)?;
        }
        self.draw_supports(&mut fem);
        Ok(fem)
    }

    /// Returns whether the cable touches the robot, or overlaps it.
    fn meets_robot(&self, answer: &CableSolution) -> bool {
        meets_outline(&self.problem, self.robot_pose, answer)
    }

    /// Passes the targets of dragged supports to `fem`.
    fn draw_supports(&self, fem: &mut FemModel) {
        for (k, (target, pulled)) in self.dragged.iter().zip(&self.pulled).enumerate() {
            match target {
                Some(target) if *pulled => fem.pull_support(k, *target),
                Some(target) => fem.drag_support(k, *target),
                None => {}
            }
        }
    }

    /// Advances `spans` by `dt_s` (s) without inertia. If the cable then meets itself or the robot,
    /// `spans` is at its state before.
    fn advance_spans(&mut self, dt_s: f64) -> Result<SpansAdvance, SolveError> {
        let before = (self.robot_pose.is_some() || self.problem.cable.self_contact).then(|| self.spans.clone());
        let mut strands = StrandWatch::of(&self.problem);
        let outcome = match &mut strands {
            Some(watch) => self.spans.advance_while(dt_s, Some(&mut |nodes| watch.stay_clear(nodes))),
            None => self.spans.advance_while(dt_s, None),
        };
        let mut meets = strands.is_some_and(|watch| watch.met).then_some(ModelReason::SelfContact);
        if outcome.is_ok() && self.meets_robot(&self.spans.solution()) {
            meets = Some(ModelReason::TouchesRobot);
        }
        match (outcome, meets) {
            (Ok(_), Some(meets)) => {
                self.spans = before.unwrap_or_else(|| self.spans.clone());
                Ok(SpansAdvance::NeedsFem(meets))
            }
            (Ok(report), None) => {
                self.adopted = None;
                self.remembered = self.remembered.filter(|_| sticks_anywhere(&self.spans.solution()));
                Ok(SpansAdvance::Done(report))
            }
            // The cable goes on without the wheel that it leaves (see `leavable_wheels.rs`).
            (
                Err(
                    error @ (SolveError::TimeStep { .. }
                    | SolveError::Unsupported { feature: Unsupported::OffWheel { .. }, .. }),
                ),
                _,
            ) => Err(error),
            (Err(error), _) => Ok(SpansAdvance::NeedsFem(ModelReason::NoAnswer(Box::new(error)))),
        }
    }

    fn is_dragged(&self, support: usize) -> bool {
        self.dragged.get(support).is_some_and(Option::is_some)
    }

    /// Offers an answer of `fem` to `spans`; returns a warning about it.
    fn try_switch_back(&mut self) -> Option<Warning> {
        // `spans` knows no posts that move.
        let fem = self.fem.as_ref().filter(|_| self.problem.moving_posts.is_empty())?;
        self.interval[0] = self.interval[0].saturating_sub(1);
        if self.interval[0] > 0 {
            return None;
        }
        let answer = fem.solution();
        if meets_itself(&self.problem, &answer.nodes) || self.meets_robot(&answer) {
            self.interval[0] = self.interval[1];
            return None;
        }
        let before = self.spans.clone();
        let started = self.spans.warm_start(&answer, fem.time_s()).is_ok();
        if started && indistinguishable(self.spans.problem(), &answer, &self.spans.solution()) {
            self.fem = None;
            self.reason = None;
            self.remembered = Some(answer.errors);
            self.interval[1] = (2 * self.interval[1]).min(MAX_INTERVAL);
            self.spans.leave_unstable()
        } else {
            self.spans = before;
            self.interval = [self.interval[1], (2 * self.interval[1]).min(MAX_INTERVAL)];
            None
        }
    }
}

/// The outcome of a step of `spans`.
enum SpansAdvance {
    Done(StepReport),
    /// `spans` cannot answer, for this reason.
    NeedsFem(ModelReason),
}

/// Returns whether some contact sticks, so that friction is what it was.
fn sticks_anywhere(answer: &CableSolution) -> bool {
    answer.contacts.iter().any(|c| c.state == ContactState::Stick)
}

/// Returns whether two answers of a cable are visibly the same.
fn indistinguishable(problem: &Problem, a: &CableSolution, b: &CableSolution) -> bool {
    let greatest = a.nodes.iter().map(|n| n.tension_n).fold(0.0, |m, t| if t > m { t } else { m });
    let seen = MAX_MOVE.0.max(MAX_MOVE.1 * problem.length);
    let same = |n: &Node| {
        let k = b.nodes.partition_point(|m| m.arc_length_m < n.arc_length_m).clamp(1, b.nodes.len().max(2) - 1);
        let (Some(p), Some(q)) = (b.nodes.get(k - 1), b.nodes.get(k)) else { return false };
        let d = q.arc_length_m - p.arc_length_m;
        let f = if d > 0.0 { (n.arc_length_m - p.arc_length_m) / d } else { 0.0 };
        let sag = 0.125 * d * d * p.curvature_per_m.abs().max(q.curvature_per_m.abs());
        let far = (p.at() + (q.at() - p.at()) * f - n.at()).norm();
        // At a corner a chain of bars has one tension before it and one after.
        let (low, high) = (p.tension_n.min(q.tension_n), p.tension_n.max(q.tension_n));
        let off = if n.tension_n < low { low - n.tension_n } else { n.tension_n - high };
        far <= seen + sag && off <= MAX_TENSION_CHANGE * greatest
    };
    a.nodes.iter().all(same)
}

impl Mechanics for SwitchingModel {
    fn model(&self) -> Model {
        if self.fem.is_some() { Model::Fem } else { Model::Spans }
    }

    fn reason(&self) -> Option<&ModelReason> {
        self.reason.as_ref().or_else(|| self.fem.is_none().then(|| self.spans.reason()).flatten())
    }

    fn refusal(&self) -> Option<&SolveError> {
        self.refusal.as_ref().filter(|_| self.fem.is_some())
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        let (mut why, mut slides, mut refused) = (None, None, None);
        self.refusal = None;
        if self.fem.is_none() {
            match self.spans.settle() {
                Ok(_) if self.meets_robot(&self.spans.solution()) => why = Some(ModelReason::TouchesRobot),
                Ok(_) if meets_itself(&self.problem, &self.spans.solution().nodes) => {
                    why = Some(ModelReason::SelfContact);
                }
                Ok(_) if is_buried(&self.problem, &self.spans.solution().nodes) => {
                    why = Some(ModelReason::BuriedWithoutMesh);
                }
                Ok(report) => {
                    self.adopted = None;
                    return Ok(report);
                }
                Err(error) if !self.problem.cable.friction_mobilised.is_default() => return Err(error),
                Err(error) => {
                    why = Some(ModelReason::NoAnswer(Box::new(error.clone())));
                    slides = Some(error.clone()).filter(|e| matches!(e, SolveError::NoRestingPlace { .. }));
                    refused = Some(error);
                }
            }
        }
        let first = self.fem.is_none();
        let first_state = self.fem(why.clone())?.state();
        self.refusal.clone_from(&refused);
        let mut found = match (self.fem(why)?.settle(), refused) {
            (Err(error), Some(before)) => Err(SolveError::clearer(before, error)),
            (found, _) => found,
        };
        // A cable that slides from its first place may come to rest elsewhere.
        if let (Some(slides), Some(fem)) = (slides, &self.fem) {
            let (problem, settings) = (&self.problem, self.settings);
            found = found
                .ok()
                .filter(|_| work(problem, &first_state, &fem.solution(), fem.time_s()) > 0.0)
                .filter(|_| !slides_on(problem, settings, &fem.solution()))
                .map(|mut report| {
                    report.warnings.push(slid_first(problem, &slides));
                    report
                })
                .ok_or(slides);
        }
        match &mut found {
            Ok(report) => {
                self.adopted = None;
                report.warnings.extend(self.try_switch_back());
                if self.fem.is_none() {
                    report.warnings.extend(self.spans.other_equilibria());
                }
            }
            Err(_) if first => {
                self.fem = None;
                self.reason = None;
            }
            Err(_) => {}
        }
        found
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
        if inertia == Inertia::Dynamic {
            return self.fem(Some(ModelReason::Inertia))?.advance_gauged(dt_s, inertia, gauge);
        }
        let end_s = self.time_s() + dt_s;
        let mut why = None;
        if self.fem.is_none() {
            match self.advance_spans(dt_s)? {
                SpansAdvance::Done(report) => return Ok(report),
                SpansAdvance::NeedsFem(reason) => why = Some(reason),
            }
        }
        let fem = self.fem(why)?;
        let rest_s = end_s - fem.time_s();
        let mut report = if rest_s > 0.0 { fem.advance(rest_s, inertia)? } else { StepReport::default() };
        self.adopted = None;
        report.warnings.extend(self.try_switch_back());
        Ok(report)
    }

    fn state(&self) -> State {
        self.fem.as_ref().map_or_else(|| self.spans.state(), Mechanics::state)
    }

    fn time_s(&self) -> f64 {
        self.fem.as_ref().map_or_else(|| self.spans.time_s(), Mechanics::time_s)
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        if let Some(broken) = self.fem.as_mut().filter(|fem| fem.is_broken()) {
            return broken.set_state(state);
        }
        self.spans.set_state(state)?;
        let moves = state.moves();
        self.adopted = Some(state.clone());
        self.remembered = None;
        self.fem = None;
        self.reason = None;
        if moves {
            self.fem(Some(ModelReason::Inertia))?;
        }
        Ok(())
    }

    fn continuation(&self) -> Option<Box<dyn Any + Send>> {
        let fem = self.fem.as_ref()?.continuation()?;
        Some(Box::new(FemContinuation { fem, reason: self.reason.clone(), interval: self.interval }))
    }

    fn continue_from(&mut self, before: &(dyn Any + Send)) -> bool {
        let Some(FemContinuation { fem: before, reason, interval }) = before.downcast_ref() else { return false };
        let fem = self.new_fem().ok().and_then(|mut fem| fem.continue_from(&**before).then_some(fem));
        let continues = fem.is_some();
        if let Some(mut fem) = fem {
            self.draw_supports(&mut fem);
            (self.fem, self.adopted, self.remembered) = (Some(fem), None, None);
            (self.reason, self.interval) = (reason.clone(), *interval);
        }
        continues
    }

    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        self.adopted = None;
        self.remembered = Some(answer.errors).filter(|_| sticks_anywhere(answer));
        self.fem = None;
        self.reason = None;
        let started = match self.meets_robot(answer) {
            true => Err(ModelReason::TouchesRobot),
            false if meets_itself(&self.problem, &answer.nodes) => Err(ModelReason::SelfContact),
            false => self.spans.warm_start(answer, time_s).map_err(|e| ModelReason::NoAnswer(Box::new(e))),
        };
        if let Err(why) = started {
            let mut fem = self.new_fem()?;
            self.draw_supports(&mut fem);
            fem.warm_start(answer, time_s)?;
            self.reason = Some(why);
            self.fem = Some(fem);
        }
        Ok(())
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        if let (Some(d), Some(pulled)) = (self.dragged.get_mut(support), self.pulled.get_mut(support)) {
            (*d, *pulled) = (Some(target_m), false);
        }
        self.spans.drag_support(support, target_m);
        if let Some(fem) = &mut self.fem {
            fem.drag_support(support, target_m);
        }
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.drag_support(support, hand_m);
        if let Some(pulled) = self.pulled.get_mut(support) {
            *pulled = true;
        }
        if let Some(fem) = &mut self.fem {
            fem.pull_support(support, hand_m);
        }
    }

    fn set_robot_pose(&mut self, to: RigidPose) {
        self.robot_pose = self.robot_pose.map(|_| to);
        if let Some(fem) = &mut self.fem {
            fem.set_robot_pose(to);
        }
    }

    fn limit_work(&mut self, work: usize) {
        self.max_work = Some(work);
        if let Some(fem) = &mut self.fem {
            fem.limit_work(work);
        }
    }

    fn break_at(&mut self, place: &BreakPlace) -> bool {
        self.fem.as_mut().is_some_and(|fem| fem.break_at(place))
    }

    fn change_wheels(&mut self, problem: Arc<Problem>) -> bool {
        let simpler = Problem::without_self_contact(Problem::without_outline(problem.clone()));
        let changed = match &mut self.fem {
            Some(fem) => {
                let spans = SpansModel::new(simpler, self.settings).ok();
                spans.filter(|_| fem.change_wheels(problem.clone())).map(|spans| self.spans = spans).is_some()
            }
            None => simpler.moving_posts.is_empty() && self.spans.change_wheels(simpler),
        };
        if changed {
            self.problem = problem;
        }
        changed
    }

    fn stored_energy(&self) -> Option<Energy> {
        self.fem.as_ref().and_then(Mechanics::stored_energy)
    }

    fn fall_back(&mut self, why: &SolveError) -> bool {
        // After a refusal the answer cannot be continued: the cable is laid anew where it was, or
        // in the adopted state.
        if let Some(fem) = &mut self.fem {
            return fem.fall_back(why);
        }
        let fresh = if self.spans.time_s() > 0.0 {
            self.hand_over_to_fem(Inertia::QuasiStatic)
        } else {
            self.new_fem_with_hands()
        };
        self.fem = fresh.ok();
        self.reason = self.fem.is_some().then(|| ModelReason::Unsound(Box::new(why.clone())));
        self.fem.is_some()
    }

    fn robot_contact(&self) -> Option<RobotContact> {
        self.fem.as_ref().and_then(Mechanics::robot_contact)
    }

    fn solution(&self) -> CableSolution {
        self.fem.as_ref().map_or_else(
            || {
                let mut answer = self.known_answer();
                answer.assumptions.self_contact = self.problem.cable.self_contact;
                answer
            },
            Mechanics::solution,
        )
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    fn inner_step_s(&self) -> f64 {
        self.fem.as_ref().map_or(f64::INFINITY, Mechanics::inner_step_s)
    }

    fn copy_to_keep(&self) -> Box<dyn Mechanics> {
        Box::new(Self {
            settings: self.settings,
            problem: self.problem.clone(),
            spans: self.spans.clone(),
            fem: self.fem.as_ref().map(FemModel::copy_for_rollback),
            adopted: self.adopted.clone(),
            remembered: self.remembered,
            dragged: self.dragged.clone(),
            pulled: self.pulled.clone(),
            robot_pose: self.robot_pose,
            reason: self.reason.clone(),
            refusal: self.refusal.clone(),
            interval: self.interval,
            max_work: self.max_work,
        })
    }

    fn lend(&mut self) -> Option<OwnedResources> {
        self.fem.as_mut().and_then(Mechanics::lend)
    }

    fn borrow(&mut self, own: Option<OwnedResources>) {
        if let Some(fem) = &mut self.fem {
            fem.borrow(own);
        }
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

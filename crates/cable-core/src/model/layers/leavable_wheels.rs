//! This layer lets a cable leave its wheels: if a model finds that the cable does not press on a
//! wheel, that wheel is replaced by a post ([`StandingWheels`]).
//!
//! A post acts on the cable like a wheel with the same friction, as long as it presses on it; its
//! force is reported as the reaction of the pulley. The other wheels stay, because a cable can
//! slide far over a wheel, but has to be followed in small steps over a post.

use std::sync::Arc;

use super::Layer;
use crate::contact::distance::segment_segment;
use crate::error::{NoEquilibrium, SolveError, Unsupported};
use crate::math::{RigidPose, Vec2};
use crate::model::mechanics::Constructor;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{Inertia, Mechanics, Model, Settings, StepReport};
use crate::problem::wheels_as_posts::WheelPost;
use crate::problem::{Problem, StandingWheels, WheelsAsPosts};
use crate::solution::{CableSolution, ModelReason, Node, SupportReaction, Warning, WarningCause};
use crate::state::State;

/// A model of a cable over wheels, and of the same with posts once it leaves one.
pub struct LeavableWheels {
    problem: Arc<Problem>,
    wheels: Arc<StandingWheels>,
    settings: Settings,
    construct: Arc<Constructor>,
    inner: Box<dyn Mechanics>,
    /// The problem of the inner model, with the wheels that the cable has left as posts; None if it
    /// has left none.
    left: Option<Arc<WheelsAsPosts>>,
    /// Places to which supports were moved, m, and by what.
    led: Vec<Option<SupportMove>>,
    robot_pose: Option<RigidPose>,
}

/// A place to which a support was moved, m.
#[derive(Clone, Copy, Debug)]
enum SupportMove {
    /// The support is there.
    Dragged(Vec2),
    /// A hand holds it there by a spring.
    Pulled(Vec2),
}

/// The names of the wheels that the cable leaves, by an error.
fn wheels_left_by(error: &SolveError) -> Vec<&str> {
    match error {
        SolveError::NoRestingPlace { why: NoEquilibrium::LeavesWheel { pulley } } => vec![pulley],
        SolveError::Unsupported { feature: Unsupported::OffWheel { support }, .. } => vec![support],
        SolveError::Neither { told, other } => [wheels_left_by(told), wheels_left_by(other)].concat(),
        _ => Vec::new(),
    }
}

impl LeavableWheels {
    /// Wraps a model of the cable; `construct` builds those with posts.
    pub fn new(
        problem: Arc<Problem>,
        wheels: Arc<StandingWheels>,
        settings: Settings,
        construct: Arc<Constructor>,
        inner: Box<dyn Mechanics>,
    ) -> Self {
        let led = vec![None; problem.supports.len()];
        Self { problem, wheels, settings, construct, inner, left: None, led, robot_pose: None }
    }

    /// Index that a support has in the inner model; None for a wheel that is a post there.
    fn inner_index(&self, support: usize) -> Option<usize> {
        let Some(replaced) = self.left.as_ref().map(|left| &left.replaced) else { return Some(support) };
        match replaced.get(support) {
            Some(true) => None,
            Some(false) => Some(replaced[..support].iter().filter(|r| !**r).count()),
            None => Some(support),
        }
    }

    /// A model with some wheels as posts, with supports moved as in this one, in the given state
    /// (None: along the route).
    fn built(
        &self,
        left: Option<&Arc<WheelsAsPosts>>,
        state: Option<&State>,
    ) -> Result<Box<dyn Mechanics>, SolveError> {
        let problem = left.map_or(&self.problem, |left| &left.problem);
        let mut this =
            Self { left: left.cloned(), ..Self::empty(self, (self.construct)(problem.clone(), self.settings)?) };
        if let Some(pose) = self.robot_pose {
            this.inner.set_robot_pose(pose);
        }
        if let Some(state) = state {
            this.inner.set_state(state)?;
        }
        for (k, lead) in self.led.iter().enumerate() {
            let Some(inner) = this.inner_index(k) else { continue };
            match lead {
                Some(SupportMove::Dragged(at)) => this.inner.drag_support(inner, *at),
                Some(SupportMove::Pulled(at)) => this.inner.pull_support(inner, *at),
                None => {}
            }
        }
        Ok(this.inner)
    }

    /// The same layer with another inner model, without moved supports.
    fn empty(of: &Self, inner: Box<dyn Mechanics>) -> Self {
        Self::new(of.problem.clone(), of.wheels.clone(), of.settings, of.construct.clone(), inner)
    }

    /// Returns whether a post moves to a place (m) clear of the cable.
    fn goes_clear(&self, support: usize, to: Vec2) -> bool {
        let wheel = self.left.iter().flat_map(|left| &left.wheels).find(|w| w.support == support);
        let radius = self.problem.supports.get(support).map(|s| s.wheel_radius);
        let (Some(wheel), Some(radius)) = (wheel, radius) else { return false };
        let state = self.inner.state();
        state.position_m.windows(2).all(|bar| segment_segment(bar[0], bar[1], wheel.center, to) > radius)
    }

    /// Moves a support. A wheel that was replaced by a post stays so if its path is clear of the
    /// cable; else it becomes a wheel again, because posts stand still.
    fn lead(&mut self, support: usize, lead: SupportMove) {
        if let Some(led) = self.led.get_mut(support) {
            *led = Some(lead);
        }
        match (self.inner_index(support), lead) {
            (Some(inner), SupportMove::Dragged(at)) => self.inner.drag_support(inner, at),
            (Some(inner), SupportMove::Pulled(at)) => self.inner.pull_support(inner, at),
            (None, lead) => {
                let clear = matches!(lead, SupportMove::Dragged(to) if self.goes_clear(support, to));
                if !(clear && self.move_posts())
                    && let Ok(inner) = self.built(None, Some(&self.inner.state()))
                {
                    (self.inner, self.left) = (inner, None);
                }
            }
        }
    }

    /// Moves the posts to the places of the wheels; false if that is impossible.
    fn move_posts(&mut self) -> bool {
        let replaced = self.replaced();
        let Some(posts) = self.posts(&replaced) else { return false };
        let Ok(inner) = self.built(Some(&posts), Some(&self.inner.state())) else { return false };
        (self.inner, self.left) = (inner, Some(posts));
        true
    }

    /// For each support, true if it is a wheel that the cable has left.
    fn replaced(&self) -> Vec<bool> {
        self.left.as_ref().map_or_else(|| vec![false; self.problem.supports.len()], |left| left.replaced.clone())
    }

    /// The wheels that are posts already and those that the cable leaves by an error; None if the
    /// error names no other wheel that may be left.
    fn also_left(&self, mut replaced: Vec<bool>, error: &SolveError) -> Option<Vec<bool>> {
        let names = wheels_left_by(error);
        let before = replaced.clone();
        for ((replaced, standing), support) in
            replaced.iter_mut().zip(&self.wheels.standing).zip(&self.problem.supports)
        {
            *replaced |= *standing && names.contains(&support.name.as_str());
        }
        (replaced != before).then_some(replaced)
    }

    /// Some wheels as posts at their present places; None if a hand holds one by a spring.
    fn posts(&self, replaced: &[bool]) -> Option<Arc<WheelsAsPosts>> {
        let places = self.led.iter().zip(replaced).map(|(lead, replaced)| match lead {
            Some(SupportMove::Pulled(_)) if *replaced => Err(()),
            Some(SupportMove::Dragged(at)) if *replaced => Ok(Some(*at)),
            _ => Ok(None),
        });
        self.wheels.as_posts(replaced, &places.collect::<Result<Vec<_>, ()>>().ok()?)
    }

    /// Continues from a state (None: along the route) with posts for the wheels that the cable
    /// leaves by this error and by following ones; returns None, with nothing changed, if that
    /// fails.
    fn run_on_posts(
        &mut self,
        error: &SolveError,
        state: Option<&State>,
        posts: impl Fn(&Self, &[bool]) -> Option<Arc<WheelsAsPosts>>,
        mut run: impl FnMut(&mut dyn Mechanics) -> Result<StepReport, SolveError>,
    ) -> Option<StepReport> {
        let mut replaced = self.also_left(self.replaced(), error)?;
        loop {
            let left = posts(self, &replaced)?;
            let mut inner = self.built(Some(&left), state).ok()?;
            let found = run(&mut *inner);
            let refusal = match &found {
                Ok(_) => inner.refusal(),
                Err(error) => Some(error),
            };
            match (refusal.and_then(|error| self.also_left(replaced.clone(), error)), found) {
                (Some(more), _) => replaced = more,
                (None, Ok(report)) => {
                    (self.inner, self.left) = (inner, Some(left));
                    return Some(report);
                }
                (None, Err(_)) => return None,
            }
        }
    }

    /// The warnings of a report, with one for each wheel of which the cable hangs clear.
    fn told(&self, mut report: StepReport) -> StepReport {
        if let Some(left) = &self.left {
            let name = &self.problem.cable.name;
            let wheels = self
                .outer_solution(self.inner.solution())
                .supports
                .into_iter()
                .zip(&left.replaced)
                .filter(|(_, replaced)| **replaced);
            let clear = wheels.map(|(s, _)| s).filter(|s| s.reaction_x_n == 0.0 && s.reaction_y_n == 0.0);
            report.warnings.extend(clear.map(|s| {
                let cause = WarningCause::ClearOfWheel { pulley: s.name };
                Warning::new(cause, name, s.arc_length_m, [0.0; 2]).at([s.x_m, s.y_m])
            }));
        }
        report
    }
}

/// The reaction of a pulley whose wheel is a post, from an answer of the copy.
fn reaction(problem: &Problem, wheel: &WheelPost, answer: &CableSolution) -> SupportReaction {
    let name = problem.supports.get(wheel.support).map(|s| s.name.clone()).unwrap_or_default();
    let mut out = SupportReaction { name, x_m: wheel.center.x, y_m: wheel.center.y, ..SupportReaction::default() };
    let on = || answer.contacts.iter().filter(|c| c.obstacle == wheel.post);
    if let (Some(first), Some(last)) = (on().next(), on().next_back()) {
        for c in on() {
            out.reaction_x_n -= c.force_n[0];
            out.reaction_y_n -= c.force_n[1];
        }
        out.arc_length_m = 0.5 * (first.begins_m + last.ends_m);
        out.tension_before_n = Some(first.tension_before_n);
        out.tension_after_n = Some(last.tension_after_n);
    } else {
        let distance = |n: &Node| (n.at() - wheel.center).norm();
        let nearest = answer.nodes.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(node) = nearest {
            out.arc_length_m = node.arc_length_m;
            out.tension_before_n = Some(node.tension_n);
            out.tension_after_n = Some(node.tension_n);
        }
    }
    out
}

impl Layer for LeavableWheels {
    fn inner(&self) -> &dyn Mechanics {
        &*self.inner
    }

    fn inner_mut(&mut self) -> &mut dyn Mechanics {
        &mut *self.inner
    }

    fn around(&self, inner: Box<dyn Mechanics>) -> Self {
        Self {
            problem: self.problem.clone(),
            wheels: self.wheels.clone(),
            settings: self.settings,
            construct: self.construct.clone(),
            inner,
            left: self.left.clone(),
            led: self.led.clone(),
            robot_pose: self.robot_pose,
        }
    }

    fn reason(&self) -> Option<&ModelReason> {
        let as_posts = self.left.as_ref().filter(|_| self.inner.model() == Model::Spans);
        self.inner.reason().or(as_posts.and(Some(&ModelReason::Obstacles)))
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        let found = self.inner.settle();
        let refusal = match &found {
            Ok(_) => self.inner.refusal(),
            Err(error) => Some(error),
        };
        if let Some(refusal) = refusal.cloned() {
            let state = (self.inner.time_s() > 0.0).then(|| self.inner.state());
            if let Some(report) = self.run_on_posts(&refusal, state.as_ref(), Self::posts, |inner| inner.settle()) {
                return Ok(self.told(report));
            }
        }
        found.map(|report| self.told(report))
    }

    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        let end_s = self.inner.time_s() + dt_s;
        let error = match self.inner.advance_gauged(dt_s, inertia, gauge) {
            Ok(report) => return Ok(self.told(report)),
            Err(error) => error,
        };
        // Posts stand still, so a moving wheel is not replaced.
        let standing = |this: &Self, replaced: &[bool]| {
            let led = replaced.iter().zip(&this.led).any(|(replaced, led)| *replaced && led.is_some());
            if led { None } else { this.posts(replaced) }
        };
        let (state, from_s) = (self.inner.state(), self.inner.time_s());
        let run = |inner: &mut dyn Mechanics| inner.advance_gauged(end_s - from_s, inertia, gauge);
        match self.run_on_posts(&error, Some(&state), standing, run) {
            Some(report) => Ok(self.told(report)),
            None => Err(error),
        }
    }

    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        if self.left.is_some() {
            return self.inner.set_state(&State::of_nodes(&answer.nodes, time_s));
        }
        self.inner.warm_start(answer, time_s)
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        self.lead(support, SupportMove::Dragged(target_m));
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.lead(support, SupportMove::Pulled(hand_m));
    }

    fn set_robot_pose(&mut self, to: RigidPose) {
        self.robot_pose = Some(to);
        self.inner.set_robot_pose(to);
    }

    /// A wheel that stands acts on the cable as a post does: where no answer over wheels is sound,
    /// one over posts is asked for. The elements of `mass-spring` run round wheels, but straight
    /// through posts that are smaller than they are long.
    fn fall_back(&mut self, why: &SolveError) -> bool {
        if self.inner.fall_back(why) {
            return true;
        }
        let all = self.wheels.standing.clone();
        let cuts_posts = self.inner.model() == Model::MassSpring;
        if cuts_posts || self.inner.time_s() > 0.0 || self.replaced() == all {
            return false;
        }
        let Some(posts) = self.posts(&all) else { return false };
        let Ok(inner) = self.built(Some(&posts), None) else { return false };
        (self.inner, self.left) = (inner, Some(posts));
        true
    }

    fn outer_solution(&self, mut answer: CableSolution) -> CableSolution {
        let Some(left) = &self.left else { return answer };
        for wheel in &left.wheels {
            let reaction = reaction(&self.problem, wheel, &answer);
            answer.supports.insert(wheel.support.min(answer.supports.len()), reaction);
        }
        answer.contacts.retain(|c| left.wheels.iter().all(|w| w.post != c.obstacle));
        answer
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }
}

//! The wheels of a cable are rounds that it may leave: where a model finds that it does not press
//! on one, the cable goes on with posts in place of its wheels ([`WheelsAsPosts`]).
//!
//! A post does to the cable what a wheel with the same friction does, as long as it presses on it;
//! what it does is reported as the reaction of the pulley.

use std::sync::Arc;

use super::Layer;
use crate::contact::distance::segment_segment;
use crate::error::{NoEquilibrium, SolveError, Unsupported};
use crate::math::{RigidPose, Vec2};
use crate::model::gauge::TensionGauge;
use crate::model::mechanics::Constructor;
use crate::model::{Inertia, Mechanics, Settings, StepReport};
use crate::problem::wheels_as_posts::WheelPost;
use crate::problem::{Problem, WheelsAsPosts, with_moved_posts};
use crate::solution::{CableSolution, ModelReason, Node, SupportReaction, Warning, WarningCause};
use crate::state::State;

/// A model of a cable over wheels, and of the same with posts once it leaves one.
pub struct LeavableWheels {
    problem: Arc<Problem>,
    copy: Arc<WheelsAsPosts>,
    settings: Settings,
    construct: Arc<Constructor>,
    inner: Box<dyn Mechanics>,
    /// True once the cable has left a wheel: the inner model is one of the copy.
    on_posts: bool,
    /// Places to which supports were led, m, and by what.
    led: Vec<Option<SupportTarget>>,
    robot_pose: Option<RigidPose>,
}

/// A place to which a support was led, m.
#[derive(Clone, Copy, Debug)]
enum SupportTarget {
    /// It is there.
    Dragged(Vec2),
    /// A hand holds it there by a spring.
    Pulled(Vec2),
}

/// Returns whether an error says that the cable leaves a wheel.
fn leaves_wheel(error: &SolveError) -> bool {
    match error {
        SolveError::NoRestingPlace { why: NoEquilibrium::LeavesWheel { .. } }
        | SolveError::Unsupported { feature: Unsupported::OffWheel { .. }, .. } => true,
        SolveError::Neither { told, other } => leaves_wheel(told) || leaves_wheel(other),
        _ => false,
    }
}

impl LeavableWheels {
    /// Wraps a model of the cable; `construct` builds the one of the copy.
    pub fn new(
        problem: Arc<Problem>,
        copy: Arc<WheelsAsPosts>,
        settings: Settings,
        construct: Arc<Constructor>,
        inner: Box<dyn Mechanics>,
    ) -> Self {
        let led = vec![None; problem.supports.len()];
        Self { problem, copy, settings, construct, inner, on_posts: false, led, robot_pose: None }
    }

    /// Index that a support has in the inner model; None for a wheel that is a post there.
    fn inner_index(&self, support: usize) -> Option<usize> {
        let replaced = &self.copy.replaced;
        match replaced.get(support) {
            Some(true) if self.on_posts => None,
            Some(_) if self.on_posts => Some(replaced[..support].iter().filter(|r| !**r).count()),
            _ => Some(support),
        }
    }

    /// A model of the copy with posts (`on_posts`) or of the cable itself, led as this one is, in
    /// the given state (None: at the route).
    fn built(&self, on_posts: bool, state: Option<&State>) -> Result<Box<dyn Mechanics>, SolveError> {
        let problem = if on_posts { &self.copy.problem } else { &self.problem };
        let mut this = Self { on_posts, ..Self::empty(self, (self.construct)(problem.clone(), self.settings)?) };
        if let Some(pose) = self.robot_pose {
            this.inner.set_robot_pose(pose);
        }
        if let Some(state) = state {
            this.inner.set_state(state)?;
        }
        for (k, lead) in self.led.iter().enumerate() {
            let Some(inner) = this.inner_index(k) else { continue };
            match lead {
                Some(SupportTarget::Dragged(at)) => this.inner.drag_support(inner, *at),
                Some(SupportTarget::Pulled(at)) => this.inner.pull_support(inner, *at),
                None => {}
            }
        }
        Ok(this.inner)
    }

    /// The same with another inner model, led nowhere.
    fn empty(of: &Self, inner: Box<dyn Mechanics>) -> Self {
        Self::new(of.problem.clone(), of.copy.clone(), of.settings, of.construct.clone(), inner)
    }

    /// Returns whether a wheel that is a post goes clear of the cable to a place (m).
    fn goes_clear(&self, support: usize, to: Vec2) -> bool {
        let wheel = self.copy.wheels.iter().find(|w| w.support == support);
        let radius = self.problem.supports.get(support).map(|s| s.wheel_radius);
        let (Some(wheel), Some(radius)) = (wheel, radius) else { return false };
        let state = self.inner.state();
        state.position_m.windows(2).all(|bar| segment_segment(bar[0], bar[1], wheel.center, to) > radius)
    }

    /// A support is led. A wheel that was a post stays one where its way is clear of the cable;
    /// else it is a wheel again, since posts stand still.
    fn lead(&mut self, support: usize, lead: SupportTarget) {
        if let Some(led) = self.led.get_mut(support) {
            *led = Some(lead);
        }
        match (self.inner_index(support), lead) {
            (Some(inner), SupportTarget::Dragged(at)) => self.inner.drag_support(inner, at),
            (Some(inner), SupportTarget::Pulled(at)) => self.inner.pull_support(inner, at),
            (None, lead) => {
                let clear = matches!(lead, SupportTarget::Dragged(to) if self.goes_clear(support, to));
                if !(clear && self.move_posts())
                    && let Ok(inner) = self.built(false, Some(&self.inner.state()))
                {
                    (self.inner, self.on_posts) = (inner, false);
                }
            }
        }
    }

    /// Goes on with posts where the wheels were led; false where it cannot.
    fn move_posts(&mut self) -> bool {
        let Some(posts) = self.posts() else { return false };
        let before = std::mem::replace(&mut self.copy, posts);
        match self.built(true, Some(&self.inner.state())) {
            Ok(inner) => {
                (self.inner, self.on_posts) = (inner, true);
                true
            }
            Err(_) => {
                self.copy = before;
                false
            }
        }
    }

    /// The copy with posts where the wheels were led; None where a hand holds one by a spring.
    fn posts(&self) -> Option<Arc<WheelsAsPosts>> {
        let leads: Vec<SupportTarget> =
            self.copy.wheels.iter().filter_map(|w| self.led.get(w.support).copied()?).collect();
        if leads.iter().any(|lead| matches!(lead, SupportTarget::Pulled(_))) {
            return None;
        }
        if leads.is_empty() {
            return Some(self.copy.clone());
        }
        let place = |k: usize| match self.led.get(k) {
            Some(Some(SupportTarget::Dragged(at))) if self.copy.replaced[k] => Some(*at),
            _ => None,
        };
        with_moved_posts(&self.copy, (0..self.copy.replaced.len()).map(place))
    }

    /// The warnings of a report, with one for each wheel of which the cable hangs clear.
    fn told(&self, mut report: StepReport) -> StepReport {
        if self.on_posts {
            let name = &self.problem.cable.name;
            let wheels = self
                .outer_solution(self.inner.solution())
                .supports
                .into_iter()
                .zip(&self.copy.replaced)
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
            copy: self.copy.clone(),
            settings: self.settings,
            construct: self.construct.clone(),
            inner,
            on_posts: self.on_posts,
            led: self.led.clone(),
            robot_pose: self.robot_pose,
        }
    }

    fn reason(&self) -> Option<&ModelReason> {
        self.inner.reason().or(self.on_posts.then_some(&ModelReason::Obstacles))
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        let found = self.inner.settle();
        let leaves = match &found {
            Ok(_) => self.inner.refusal().is_some_and(leaves_wheel),
            Err(error) => leaves_wheel(error),
        };
        if leaves
            && !self.on_posts
            && let Some(posts) = self.posts()
        {
            let before = std::mem::replace(&mut self.copy, posts);
            let state = (self.inner.time_s() > 0.0).then(|| self.inner.state());
            if let Ok(mut inner) = self.built(true, state.as_ref())
                && let Ok(report) = inner.settle()
            {
                (self.inner, self.on_posts) = (inner, true);
                return Ok(self.told(report));
            }
            self.copy = before;
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
        // Posts stand still: a wheel that is drawn on its way is none.
        let led = self.copy.wheels.iter().any(|w| self.led.get(w.support).is_some_and(Option::is_some));
        if self.on_posts || led || !leaves_wheel(&error) {
            return Err(error);
        }
        let Ok(mut inner) = self.built(true, Some(&self.inner.state())) else { return Err(error) };
        let Ok(report) = inner.advance_gauged(end_s - self.inner.time_s(), inertia, gauge) else { return Err(error) };
        (self.inner, self.on_posts) = (inner, true);
        Ok(self.told(report))
    }

    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        if self.on_posts {
            return self.inner.set_state(&State::of_nodes(&answer.nodes, time_s));
        }
        self.inner.warm_start(answer, time_s)
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        self.lead(support, SupportTarget::Dragged(target_m));
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.lead(support, SupportTarget::Pulled(hand_m));
    }

    fn set_robot_pose(&mut self, to: RigidPose) {
        self.robot_pose = Some(to);
        self.inner.set_robot_pose(to);
    }

    fn outer_solution(&self, mut answer: CableSolution) -> CableSolution {
        if !self.on_posts {
            return answer;
        }
        for wheel in &self.copy.wheels {
            let reaction = reaction(&self.problem, wheel, &answer);
            answer.supports.insert(wheel.support.min(answer.supports.len()), reaction);
        }
        answer.contacts.retain(|c| self.copy.wheels.iter().all(|w| w.post != c.obstacle));
        answer
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }
}

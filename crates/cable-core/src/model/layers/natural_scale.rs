//! This layer solves a similar copy of a cable at the scale that models are made for
//! ([`Similarity`]), and scales the answers back.
//!
//! Barrier reach, elastic slip and gaps are absolute lengths in the solvers, tuned on cables of 1
//! to 100 m. Instead of scaling each of them, the whole scene is scaled.

use std::any::Any;
use std::borrow::Cow;
use std::sync::Arc;

use super::{Layer, Layered};
use crate::error::{Place, SolveError};
use crate::math::Vec2;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{BreakPlace, Inertia, Mechanics, StepReport};
use crate::problem::Problem;
use crate::scene::froude_scaling::Similarity;
use crate::solution::{CableSolution, Energy, ModelReason, Warning};
use crate::state::State;

/// Longest time of the copy in one step, s: every model can take such a step.
const LONGEST_STEP_S: f64 = 30.0;

/// A model of the similar copy of a cable.
pub struct ScaledModel {
    problem: Arc<Problem>,
    by: Similarity,
    inner: Box<dyn Mechanics>,
    /// The reason that the inner model gives, at this scale.
    reason: Option<ModelReason>,
    refusal: Option<SolveError>,
}

/// The memory of a model of the copy, from which it continues after an edit of the scene.
struct ScaledContinuation {
    by: Similarity,
    inner: Box<dyn Any + Send>,
}

impl ScaledModel {
    /// Wraps the model of the copy.
    #[must_use]
    pub(in crate::model) fn new(problem: Arc<Problem>, by: Similarity, inner: Box<dyn Mechanics>) -> Layered<Self> {
        let mut this = Self { problem, by, inner, reason: None, refusal: None };
        this.observe();
        Layered(this)
    }

    fn at_back(&self, at: Vec2) -> Vec2 {
        self.by.place_back(at)
    }

    fn place_back(&self, place: &Place) -> Box<Place> {
        self.problem.place(
            place.arc_length_m / self.by.length,
            self.at_back(place.at_m),
            self.outer_time(self.inner.time_s()),
        )
    }
}

/// An answer with its lengths multiplied by `l`, its times by `t`, and its positions mapped by
/// `place`. Forces and dimensionless values stay.
fn answer(mut a: CableSolution, l: f64, t: f64, place: impl Fn(Vec2) -> Vec2) -> CableSolution {
    let put = |x: &mut f64, y: &mut f64| {
        let at = place(Vec2::new(*x, *y));
        (*x, *y) = (at.x, at.y);
    };
    for n in &mut a.nodes {
        put(&mut n.x_m, &mut n.y_m);
        n.arc_length_m *= l;
        n.acceleration_m_per_s2 = n.acceleration_m_per_s2.map(|a| a * l / (t * t));
        n.displacement_m = n.displacement_m.map(|d| d * l);
        n.vx_m_per_s *= l / t;
        n.vy_m_per_s *= l / t;
        n.stress_pa /= l * l;
        n.curvature_per_m /= l;
    }
    a.errors.scale_lengths(l);
    a.unstretched_length_m = a.unstretched_length_m.map(|length| length * l);
    a.assumptions.bending_stiffness_n_m2 *= l * l;
    for s in &mut a.supports {
        put(&mut s.x_m, &mut s.y_m);
        s.arc_length_m *= l;
        if let Some(hand) = &mut s.hand {
            put(&mut hand.x_m, &mut hand.y_m);
            hand.stiffness_n_per_m /= l;
        }
    }
    for c in &mut a.contacts {
        put(&mut c.x_m, &mut c.y_m);
        for length in [&mut c.arc_length_m, &mut c.begins_m, &mut c.ends_m] {
            *length *= l;
        }
        for part in &mut c.parts {
            part.begins_m *= l;
            part.ends_m *= l;
        }
        c.samples.iter_mut().for_each(|s| s.arc_length_m *= l);
    }
    if let Some(account) = &mut a.momentum {
        account.scale_times(t);
    }
    if let Some(account) = &mut a.energy_account {
        account.scale(t, l);
    }
    if let Some(b) = &mut a.tightest_bend {
        put(&mut b.x_m, &mut b.y_m);
        b.radius_m *= l;
        b.arc_length_m *= l;
    }
    if let Some(p) = &mut a.sidewall_pressure {
        put(&mut p.x_m, &mut p.y_m);
        p.pressure_n_per_m /= l;
        p.arc_length_m *= l;
    }
    a
}

impl Layer for ScaledModel {
    fn inner(&self) -> &dyn Mechanics {
        &*self.inner
    }

    fn inner_mut(&mut self) -> &mut dyn Mechanics {
        &mut *self.inner
    }

    fn around(&self, inner: Box<dyn Mechanics>) -> Self {
        let (problem, reason, refusal) = (self.problem.clone(), self.reason.clone(), self.refusal.clone());
        Self { problem, by: self.by, inner, reason, refusal }
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    /// Records the reason for the inner model, and the reason why another has no answer.
    fn observe(&mut self) {
        self.refusal = self.inner.refusal().cloned().map(|e| self.outer_error(e));
        self.reason = self.inner.reason().cloned().map(|reason| match reason {
            ModelReason::NoAnswer(error) => ModelReason::NoAnswer(Box::new(self.outer_error(*error))),
            // Asked of the scene itself: see `fall_back`.
            other => other,
        });
    }

    fn reason(&self) -> Option<&ModelReason> {
        self.reason.as_ref()
    }

    fn refusal(&self) -> Option<&SolveError> {
        self.refusal.as_ref()
    }

    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        let whole = dt_s * self.by.time;
        // A step that no model takes is refused by it.
        let parts =
            if whole > LONGEST_STEP_S && dt_s <= LONGEST_STEP_S { (whole / LONGEST_STEP_S).ceil() } else { 1.0 };
        let mut sum = StepReport::default();
        for _ in 0..parts as usize {
            gauge.of_copy([self.by.length, self.by.time]);
            let done = self.inner.advance_gauged(whole / parts, inertia, gauge);
            gauge.of_copy([self.by.length, self.by.time].map(f64::recip));
            let report = done?;
            sum.cost.iterations += report.cost.iterations;
            sum.cost.halved_steps += report.cost.halved_steps;
            (sum.cost.residual_n, sum.cost.inner_step_s) = (report.cost.residual_n, report.cost.inner_step_s);
            sum.warnings = report.warnings;
        }
        Ok(sum)
    }

    fn continuation(&self) -> Option<Box<dyn Any + Send>> {
        let inner = self.inner.continuation()?;
        Some(Box::new(ScaledContinuation { by: self.by, inner }))
    }

    fn continue_from(&mut self, before: &(dyn Any + Send)) -> bool {
        let before = before.downcast_ref().filter(|before: &&ScaledContinuation| before.by == self.by);
        before.is_some_and(|before| self.inner.continue_from(&*before.inner))
    }

    fn warm_start(&mut self, given: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        let to = answer(given.clone(), self.by.length, self.by.time, |p| self.by.place(p));
        self.inner.warm_start(&to, time_s * self.by.time)
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        self.inner.drag_support(support, self.by.place(target_m));
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.inner.pull_support(support, self.by.place(hand_m));
    }

    fn break_at(&mut self, place: &BreakPlace) -> bool {
        self.inner.break_at(&BreakPlace { arc_length_m: place.arc_length_m * self.by.length, ..*place })
    }

    fn outer_energy(&self, energy: Energy) -> Energy {
        energy * (1.0 / self.by.length)
    }

    fn outer_time(&self, time_s: f64) -> f64 {
        time_s / self.by.time
    }

    fn inner_state<'a>(&self, state: &'a State) -> Cow<'a, State> {
        let speed = self.by.length / self.by.time;
        Cow::Owned(State {
            time_s: state.time_s * self.by.time,
            arc_length_m: state.arc_length_m.iter().map(|s| s * self.by.length).collect(),
            position_m: state.position_m.iter().map(|p| self.by.place(*p)).collect(),
            velocity_m_per_s: state.velocity_m_per_s.iter().map(|v| v * speed).collect(),
            in_motion: state.in_motion,
        })
    }

    fn outer_state(&self, state: State) -> State {
        let speed = self.by.time / self.by.length;
        State {
            time_s: state.time_s / self.by.time,
            arc_length_m: state.arc_length_m.iter().map(|s| s / self.by.length).collect(),
            position_m: state.position_m.iter().map(|p| self.by.place_back(*p)).collect(),
            velocity_m_per_s: state.velocity_m_per_s.iter().map(|v| v * speed).collect(),
            in_motion: state.in_motion,
        }
    }

    fn outer_solution(&self, inner: CableSolution) -> CableSolution {
        answer(inner, 1.0 / self.by.length, 1.0 / self.by.time, |p| self.by.place_back(p))
    }

    fn outer_report(&self, report: StepReport) -> StepReport {
        let mut cost = report.cost;
        cost.inner_step_s /= self.by.time;
        let warning = |w: Warning| Warning {
            at_m: w.at_m.map(|[x, y]| self.at_back(Vec2::new(x, y)).into()),
            ..w.scaled(1.0 / self.by.length, 1.0 / self.by.time)
        };
        StepReport { cost, warnings: report.warnings.into_iter().map(warning).collect() }
    }

    /// An error of the inner model with the lengths, places and times of the outer scene; forces
    /// are the same in both.
    fn outer_error(&self, error: SolveError) -> SolveError {
        let (l, t) = (self.by.length, self.by.time);
        match error {
            SolveError::NotConverged { model, iterations, residual_n, place } => {
                SolveError::NotConverged { model, iterations, residual_n, place: self.place_back(&place) }
            }
            SolveError::Compressed { model, tension_n, place } => {
                SolveError::Compressed { model, tension_n, place: self.place_back(&place) }
            }
            SolveError::TensionLost { model, loss, arc_length_m, at_m } => {
                SolveError::TensionLost { model, loss, arc_length_m: arc_length_m / l, at_m: self.at_back(at_m) }
            }
            SolveError::NoRestingPlace { why } => {
                SolveError::NoRestingPlace { why: why.with_places(|s| s / l, |at| self.at_back(at)) }
            }
            SolveError::Unsupported { model, feature } => {
                let feature = feature.with_places(|s| s / l, |at| self.at_back(at));
                SolveError::Unsupported { model, feature }
            }
            SolveError::NonFinite { quantity, arc_length_m, time_s } => {
                SolveError::NonFinite { quantity, arc_length_m: arc_length_m / l, time_s: time_s / t }
            }
            SolveError::Buried { model, obstacle, depth_m, arc_length_m, at_m } => SolveError::Buried {
                model,
                obstacle,
                depth_m: depth_m / l,
                arc_length_m: arc_length_m / l,
                at_m: self.at_back(at_m),
            },
            SolveError::TimeStep { dt_s, longest_s } => {
                SolveError::TimeStep { dt_s: dt_s / t, longest_s: longest_s / t }
            }
            SolveError::StepFailed { model, time_s, dt_s, residual_n, place, cause } => SolveError::StepFailed {
                model,
                time_s: time_s / t,
                dt_s: dt_s / t,
                residual_n,
                place: self.place_back(&place),
                cause: cause.with_speed(|v| v * t / l),
            },
            SolveError::Neither { clearer, other } => SolveError::Neither {
                clearer: Box::new(self.outer_error(*clearer)),
                other: Box::new(self.outer_error(*other)),
            },
            SolveError::TooMuchWork { model, iterations, segments, residual_n, place } => {
                SolveError::TooMuchWork { model, iterations, segments, residual_n, place: self.place_back(&place) }
            }
            error @ (SolveError::AfterBreak { .. }
            | SolveError::Indefinite { .. }
            | SolveError::Unsound { .. }
            | SolveError::Setting { .. }) => error,
        }
    }
}

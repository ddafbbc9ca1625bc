//! Lumped masses and axial springs, stepped by semi-implicit Euler: a quick look, and the cheap way through violent
//! free motion. Its discretisation error is second order in the element and is not estimated.
//!
//! Sub-steps keep below the stability limit of a chain of springs, with ω_max = 2√(EA/(ρ l₀²)) and the damping ratio ζ
//! of that mode: `dt < 2/ω_max · (√(1+ζ²) − ζ)` (D. Baraff, A. Witkin, Physically based modeling, SIGGRAPH course notes,
//! 1997, derive the undamped part). Resting places on obstacles are found by dynamic relaxation with adaptive damping
//! (P. Underwood, Dynamic relaxation, in Computational Methods for Transient Analysis, 1983): fictitious masses, critical
//! damping of the motion that is going on. Where nothing can be touched Newton's method on the springs' energy finds them (`rest`). Both start
//! from the shape of [`super::fem`] where there is one: which of many resting places a rough floor allows is then the
//! same for both models, what holds there is this model's own balance of forces.

mod answer;
mod mesh;
mod relax;
mod rest;
mod step;

use std::sync::Arc;

use super::drive::Follower;
use super::fem::FemModel;
use super::{Inertia, Mechanics, Model, Settings, StepReport};
use crate::contact::Gap;
use crate::error::SolveError;
use crate::math::Vec2;
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{CableSolution, Cost};
use crate::state::State;

/// The model's mechanics of one cable.
#[derive(Clone, Debug)]
pub struct MassSpringModel {
    problem: Arc<Problem>,
    time_s: f64,
    /// Arc length of each node, m.
    s: Vec<f64>,
    /// Unstretched length of each element at the present temperature, m.
    rest: Vec<f64>,
    /// Arc length of each element at rest temperature, m: weight and wind go with it.
    span: Vec<f64>,
    /// Mass of each node, kg.
    mass: Vec<f64>,
    /// Node of each support.
    node_of: Vec<usize>,
    /// Node of each load.
    load_node: Vec<usize>,
    x: Vec<Vec2>,
    v: Vec<Vec2>,
    /// Force on each node but that of supports and contacts, N.
    f: Vec<Vec2>,
    /// Tension of each element, N.
    tension: Vec<f64>,
    /// Whether a support holds the node now.
    held: Vec<bool>,
    /// Acceleration of held nodes, m/s².
    held_acceleration: Vec<Vec2>,
    /// Where each support is dragged to, if it is.
    drag: Vec<Option<Vec2>>,
    /// How far each element may still travel before it can touch anything, m.
    clearance: Vec<f64>,
    touches: Vec<Touch>,
    gaps: Vec<Gap>,
    damping_time_s: f64,
    cost: Cost,
    /// Whether it has left the route for a shape found by a solve, a step or another model.
    laid: bool,
    /// Followers of dragged supports.
    followers: Vec<Option<Follower>>,
}

/// A contact in the last sub-step.
#[derive(Clone, Copy, Debug)]
struct Touch {
    element: usize,
    gap: Gap,
    /// Normal and friction impulse (along growing arc length), N·s.
    normal: f64,
    friction: f64,
    slips: bool,
}

/// The longest step, s: longer is a mistake in the caller's clock.
const MAX_STEP_S: f64 = 60.0;

fn unsupported(feature: &str) -> SolveError {
    SolveError::Unsupported { model: Model::MassSpring, feature: feature.to_owned() }
}

impl MassSpringModel {
    /// Builds it at the route.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs what the model lacks.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        if problem.supports.iter().any(|s| s.kind == SupportKind::Pulley) {
            return Err(unsupported("a pulley"));
        }
        if problem.bending_stiffness > 0.0 {
            return Err(unsupported("bending stiffness"));
        }
        if problem.cable.self_contact {
            return Err(unsupported("self-contact"));
        }
        Ok(Self::mesh(problem, settings))
    }

    /// Takes the first shape from the corrected bars, if they find one.
    fn lay(&mut self) {
        self.laid = true;
        let settings = Settings { segments: Some(self.rest.len()), ..Settings::default() };
        let shape = FemModel::new(self.problem.clone(), settings).and_then(|mut fem| {
            fem.settle()?;
            Ok(fem.state())
        });
        if let Ok(shape) = shape {
            let time_s = self.time_s;
            // A shape that does not fit leaves the route as it was.
            let _ = self.adopt(&shape);
            self.time_s = time_s;
        }
    }

    fn touches_something(&self) -> bool {
        !self.problem.world.is_empty() || self.problem.floor_friction.is_some()
    }

    /// Finds the resting place from here.
    fn rest_here(&mut self) -> Result<(), SolveError> {
        if !self.touches_something() {
            self.equilibrium()?;
            self.v.fill(Vec2::zeros());
            self.cost.inner_step_s = 0.0;
            self.forces();
            return self.compressed().or_else(|| self.non_finite()).map_or(Ok(()), Err);
        }
        self.relax()
    }

    /// What a sub-step cannot go beyond.
    fn non_finite(&self) -> Option<SolveError> {
        let bad = (0..self.x.len()).find(|&i| !(self.x[i] + self.v[i]).iter().all(|c| c.is_finite()))?;
        Some(SolveError::NonFinite { quantity: "position or velocity", node: bad, time_s: self.time_s })
    }

    fn report(&self) -> StepReport {
        StepReport { cost: self.cost, warnings: Vec::new() }
    }

    /// A copy of what a failed step must not change.
    fn keep(&self) -> (f64, Vec<Vec2>, Vec<Vec2>) {
        (self.time_s, self.x.clone(), self.v.clone())
    }

    fn restore(&mut self, kept: (f64, Vec<Vec2>, Vec<Vec2>)) {
        (self.time_s, self.x, self.v) = kept;
        self.clearance.fill(0.0);
        self.forces();
    }
}

impl Mechanics for MassSpringModel {
    fn model(&self) -> Model {
        Model::MassSpring
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        let kept = self.keep();
        if !self.laid {
            self.lay();
        }
        match self.rest_here() {
            Ok(()) => Ok(self.report()),
            Err(e) => {
                self.restore(kept);
                Err(e)
            }
        }
    }

    fn advance(&mut self, dt_s: f64, inertia: Inertia) -> Result<StepReport, SolveError> {
        if !(dt_s > 0.0 && dt_s <= MAX_STEP_S) {
            return Err(SolveError::TimeStep { dt_s, allowed: "above 0 s, at most 60 s" });
        }
        self.laid = true;
        let kept = self.keep();
        let end_s = self.time_s + dt_s;
        let done = match inertia {
            Inertia::Dynamic => self.integrate(dt_s),
            // Relaxation overshoots and sticks there: a drag came out at a third of its pull.
            Inertia::QuasiStatic if self.touches_something() => {
                Err(unsupported("slow motion without inertia where friction can hold"))
            }
            Inertia::QuasiStatic => {
                self.time_s = end_s;
                self.rest_here()
            }
        };
        if let Err(e) = done {
            self.restore(kept);
            return Err(e);
        }
        self.time_s = end_s;
        Ok(self.report())
    }

    fn state(&self) -> State {
        State {
            time_s: self.time_s,
            arc_length_m: self.s.clone(),
            position_m: self.x.clone(),
            velocity_m_per_s: self.v.clone(),
        }
    }

    fn adopt(&mut self, state: &State) -> Result<(), SolveError> {
        let misfit = |node| SolveError::NonFinite { quantity: "adopted state", node, time_s: state.time_s };
        if let Some(node) = state.first_non_finite() {
            return Err(misfit(node));
        }
        let speeds = State { position_m: state.velocity_m_per_s.clone(), ..state.clone() };
        let old_length = state.arc_length_m.last().copied().unwrap_or(0.0);
        // A cable whose length was edited keeps its shape: material is spread over it evenly.
        let scale = old_length / self.problem.length;
        let place =
            |from: &State| -> Option<Vec<Vec2>> { self.s.iter().map(|s| from.position_at(s * scale)).collect() };
        let (x, v) = place(state).zip(place(&speeds)).ok_or_else(|| misfit(0))?;
        (self.x, self.v, self.time_s, self.laid) = (x, v, state.time_s, true);
        self.clearance.fill(0.0);
        self.forces();
        Ok(())
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        if target_m.iter().all(|c| c.is_finite())
            && let Some(d) = self.drag.get_mut(support)
        {
            *d = Some(target_m);
        }
    }

    fn solution(&self) -> CableSolution {
        self.answer()
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests;

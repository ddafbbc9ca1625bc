//! Rung 2: finite elements. Two parts share the work:
//!
//! - [`statics`]: a cable that touches nothing but its supports, at rest or pulled slowly;
//! - [`dynamics`]: anything that moves, and anything with obstacles or a floor to rub on, at rest or not.
//!
//! [`FemModel`] decides which part is asked, and hands the state over when the question changes.

mod answer;
pub mod assembly;
mod bar;
mod beam;
mod beam_answer;
mod beam_mesh;
mod carry;
mod clear;
pub mod contact_report;
pub mod contact_set;
pub mod contact_start;
pub mod contact_step;
#[cfg(test)]
mod contact_tests;
pub mod dynamics;
mod elastica;
pub mod element;
mod estimate;
mod foresee;
mod free_step;
mod free_way;
mod handover;
mod integrate;
mod layout;
mod marks;
mod mesh_edit;
mod motion;
mod network;
mod own;
mod pace;
mod path;
mod prepare;
mod remesh;
mod rest;
mod rush;
mod sleep;
mod sliding;
#[cfg(test)]
mod sliding_tests;
mod span;
pub mod statics;
mod stop;
mod take_over;
mod task;
mod touch;
mod wheel;

use std::sync::Arc;

use super::lay::least_sliding;
use super::{Inertia, Mechanics, Model, OutlineReport, Settings, StepReport};
use crate::contact::outline::Placement;
use crate::error::SolveError;
use crate::math::{Vec2, larger};
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{CableSolution, Cost, Node, Warning, WarningKind};
use crate::state::State;
use elastica::Elastica;

/// Part of the greatest tension by which the force on a support may change when a first lay is taken over. Less: coarse meshes lay themselves, in folds; more:
/// bars too long for the ground, held by friction at both ends, keep a pull that nothing else asks for (25 bars on a robot's ground: 220 %).
const JAMMED: f64 = 0.1;

/// The same of a stiff cable, which is laid as a flexible one: its bending takes part in what supports feel.
const JAMMED_STIFF: f64 = 0.5;

/// Part of the tolerance that the error of a stiff cable's rest must stay below.
const SAFETY: f64 = 0.5;

/// Part of its length by which a stiff cable may lie elsewhere than where its mesh has it at rest. Less: coarse meshes are left as they are;
/// more: another resting place is taken for the same.
const STRAY: f64 = 0.05;

/// Which part holds the present state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Statics,
    Dynamics,
}

/// The model's mechanics of one cable.
#[derive(Clone, Debug)]
pub struct FemModel {
    problem: Arc<Problem>,
    /// Where a support was dragged to by hand, m.
    dragged: Vec<Option<Vec2>>,
    statics: statics::Statics,
    dynamics: dynamics::Dynamics,
    present: Part,
    /// Whether a first rest with contact goes on from that of `spans`, where there is one.
    laid_evenly: bool,
    settings: Settings,
    /// Where the outline of the robot was led.
    led: Option<Placement>,
    /// The rest of a stiff cable in contact, until something moves.
    bent: Option<CableSolution>,
    /// What the mesh's rest of a stiff cable may be off by, in parts of the greatest tension, until something moves.
    unbent: Option<f64>,
}

impl FemModel {
    /// Builds it at the route.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs what the model lacks.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        let statics = statics::Statics::new(problem.clone(), settings)?;
        let dynamics = dynamics::Dynamics::new(problem.clone(), settings)?;
        let present = if touches_nothing(&problem) { Part::Statics } else { Part::Dynamics };
        Ok(Self {
            dragged: vec![None; problem.supports.len()],
            statics,
            dynamics,
            present,
            laid_evenly: true,
            settings,
            led: problem.outline.as_ref().map(|o| o.placement),
            bent: None,
            unbent: None,
            problem,
        })
    }

    /// The same, but `spans` is not asked how the cable is laid: it was, and has no answer.
    #[must_use]
    pub fn laid_alone(mut self) -> Self {
        self.laid_evenly = false;
        self
    }

    /// Lays the cable with the least sliding, if there is an answer to that. On its own way down slack comes to lie in folds, which
    /// friction then holds. Returns what there is to say of it.
    fn lay(&mut self) -> Option<Vec<Warning>> {
        let lay = least_sliding(&self.problem, self.settings, (&self.dragged, self.led))?;
        let before = self.dynamics.clone();
        let taken = self.dynamics.take_over(&lay.answer, before.time(), &self.dragged).is_ok() && self.dynamics.rested;
        let greatest = lay.answer.nodes.iter().map(|n| n.tension_n).fold(0.0, larger);
        let found = self.dynamics.solution();
        let pairs = lay.answer.supports.iter().zip(&found.supports);
        let off = pairs.map(|(a, b)| (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n));
        let jammed = if self.problem.bending_stiffness > 0.0 { JAMMED_STIFF } else { JAMMED };
        if taken && off.fold(0.0, larger) <= jammed * greatest {
            return Some(lay.warnings);
        }
        self.dynamics = before;
        None
    }

    /// The resting place of a stiff cable in contact as an elastica, from that of a flexible one; None where this finds none.
    fn bend(&mut self) -> Option<StepReport> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let lay = least_sliding(&self.problem, self.settings, (&self.dragged, self.led))?;
        let found = Elastica::from_flexible(&self.problem, self.dynamics.time(), &self.dragged, &lay.answer)?;
        let cost = self.take_bent(found)?;
        Some(StepReport { cost, warnings: lay.warnings })
    }

    /// The same from the rest that the mesh has found.
    fn bend_on(&mut self) -> Option<Cost> {
        if !(self.problem.bending_stiffness > 0.0) {
            return None;
        }
        let answer = self.dynamics.solution();
        let bar = self.dynamics.even();
        let found = Elastica::from_mesh(&self.problem, self.dynamics.time(), &self.dragged, (&answer, bar))?;
        let cost = self.take_bent(found)?;
        // What the mesh found is followed, not left: places that differ by more are another rest.
        let near = |n: &Node| {
            let at = self.bent.as_ref().and_then(|b| State::of_nodes(&b.nodes, 0.0).position_at(n.arc_length_m));
            at.is_some_and(|at| (at - n.at()).norm() <= STRAY * self.problem.length)
        };
        if !answer.nodes.iter().all(near) {
            self.bent = None;
            return None;
        }
        Some(cost)
    }

    fn take_bent(&mut self, mut found: Elastica) -> Option<Cost> {
        if !found.stiffen(&self.problem) {
            return None;
        }
        let estimate = found.refine(&self.problem, SAFETY * self.settings.tolerance)?;
        let (iterations, residual_n) = found.cost();
        self.bent = Some(CableSolution { error_estimate: Some(estimate), ..found.solution(&self.problem) });
        Some(Cost { iterations, residual_n, ..Cost::default() })
    }

    /// The same without sliding nodes at corners and posts: every node stays with its material. For models that take
    /// over its nodes.
    #[must_use]
    pub fn with_material_nodes(mut self) -> Self {
        self.dynamics.slides = false;
        self
    }

    /// Makes `part` the one that holds the present state.
    fn ask(&mut self, part: Part) -> Result<(), SolveError> {
        if self.present != part {
            match part {
                Part::Statics => self.statics.adopt(&self.dynamics.state())?,
                Part::Dynamics => {
                    self.dynamics.adopt(&self.statics.state())?;
                    self.dynamics.come_to_rest(&self.dragged);
                }
            }
            self.present = part;
        }
        Ok(())
    }
}

/// Whether the cable can touch nothing but its supports.
fn touches_nothing(problem: &Problem) -> bool {
    problem.world.is_empty()
        && problem.outline.is_none()
        && problem.floor_friction.is_none()
        && !problem.cable.self_contact
        && !(problem.bending_stiffness > 0.0 && problem.supports.iter().any(|s| s.kind == SupportKind::Pulley))
}

impl Mechanics for FemModel {
    fn model(&self) -> Model {
        Model::Fem
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        if touches_nothing(&self.problem) {
            self.ask(Part::Statics)?;
            self.statics.settle(&self.dragged)
        } else {
            self.bent = None;
            self.unbent = None;
            if let Some(report) = self.bend() {
                return Ok(report);
            }
            let begins = !self.dynamics.rested && self.dynamics.time() == 0.0;
            let said = if begins && self.laid_evenly { self.lay() } else { None };
            if begins && said.is_none() && self.statics.settle(&self.dragged).is_ok() {
                self.dynamics.begin_at(&self.statics.state(), &self.dragged);
            }
            let mut report = self.dynamics.settle(&self.dragged)?;
            report.warnings.extend(said.into_iter().flatten());
            if let Some(cost) = self.bend_on() {
                report.cost = Cost { iterations: report.cost.iterations + cost.iterations, ..cost };
            } else if self.problem.bending_stiffness > 0.0 {
                let (off, s) = self.dynamics.bending_error();
                self.unbent = Some(off);
                if !(off <= self.settings.tolerance) {
                    let message = format!(
                        "{} bars show the bend of a stiff cable where it is led round something to {:.1e} of the greatest tension only; {:.1e} was asked for: use more segments",
                        self.dynamics.even_bars, off, self.settings.tolerance
                    );
                    let name = &self.problem.cable.name;
                    let limit = self.settings.tolerance;
                    report.warnings.push(Warning::new(WarningKind::Accuracy, name, s, [off, limit], message));
                }
            }
            Ok(report)
        }
    }

    fn advance(&mut self, dt_s: f64, inertia: Inertia) -> Result<StepReport, SolveError> {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return Err(SolveError::TimeStep { dt_s, allowed: "more than 0 s" });
        }
        if inertia == Inertia::QuasiStatic && touches_nothing(&self.problem) {
            self.ask(Part::Statics)?;
            self.statics.advance(dt_s, &self.dragged)
        } else {
            self.ask(Part::Dynamics)?;
            self.unbent = None;
            if let Some(answer) = self.bent.take() {
                self.dynamics.take_over(&answer, self.dynamics.time(), &self.dragged)?;
            }
            self.dynamics.advance(dt_s, inertia, &self.dragged)
        }
    }

    fn state(&self) -> State {
        if let Some(answer) = &self.bent {
            return State::of_nodes(&answer.nodes, self.dynamics.time());
        }
        match self.present {
            Part::Statics => self.statics.state(),
            Part::Dynamics => self.dynamics.state(),
        }
    }

    fn adopt(&mut self, state: &State) -> Result<(), SolveError> {
        self.bent = None;
        self.unbent = None;
        // Statics has no velocities: what moves is taken over by the part that can move.
        if self.present == Part::Statics && state.velocity_m_per_s.iter().any(|v| v.norm() > 0.0) {
            self.dynamics.adopt(state)?;
            self.present = Part::Dynamics;
            return Ok(());
        }
        match self.present {
            Part::Statics => self.statics.adopt(state),
            Part::Dynamics => self.dynamics.adopt(state),
        }
    }

    fn take_over(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        self.bent = None;
        self.unbent = None;
        match self.present {
            Part::Statics => self.adopt(&State::of_nodes(&answer.nodes, time_s)),
            Part::Dynamics => self.dynamics.take_over(answer, time_s, &self.dragged),
        }
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        if let Some(d) = self.dragged.get_mut(support) {
            *d = Some(target_m);
        }
    }

    fn lead_outline(&mut self, to: Placement) {
        self.led = Some(to);
        self.dynamics.lead_outline(to);
    }

    fn outline(&self) -> Option<OutlineReport> {
        self.dynamics.outline_report()
    }

    fn solution(&self) -> CableSolution {
        if let Some(answer) = &self.bent {
            return answer.clone();
        }
        match self.present {
            Part::Statics => self.statics.solution(),
            Part::Dynamics => CableSolution { error_estimate: self.unbent, ..self.dynamics.solution() },
        }
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

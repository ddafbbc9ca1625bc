//! `mass_spring` is the model of lumped masses and springs: a quick look, and the cheap way through
//! violent free motion.
//!
//! | room | what it holds |
//! |---|---|
//! | `mesh` | nodes, masses and the first shape |
//! | `integrator` | how dynamic steps are taken: explicit, or as a preview |
//! | `dynamics` | one explicit sub-step: forces, impacts, limits, rollback, momentum, hands |
//! | `xpbd` | the preview's sub-steps of compliant constraints |
//! | `equilibrium` | equilibria, steps without inertia, and how wrong their figures are |
//! | `pulleys`, `bending` | material that slides through pulleys; bending forces |
//! | `results`, `corner_error` | the answer, and what a mesh cannot know of tension beyond a corner |
//!
//! The leapfrog keeps velocities half a sub-step behind places. The discretisation error is of
//! second order in the element; at equilibrium and without inertia it is estimated, in motion only
//! for corners.
//!
//! Sub-steps keep below the stability limit of a chain of springs, with ω_max = 2√(EA/(ρ l₀²)) and
//! the damping ratio ζ of that mode: `dt < 2/ω_max · (√(1+ζ²) − ζ)` (D. Baraff, A. Witkin,
//! Physically based modeling, SIGGRAPH course notes, 1997, derive the undamped part). Equilibria
//! are found by Newton's method on the energy of springs, contacts and friction. They start from
//! the shape of [`crate::model::fem`] where there is one: which of many equilibria a rough floor
//! allows is then the same for both models; what holds there is this model's own balance of forces.

/// Declares a part of the model whose `clone_from` goes through its fields, into the memory that a
/// copy already has: a step keeps the state before it without new memory.
macro_rules! part {
    ($(#[$doc:meta])* $name:ident { $($(#[$about:meta])* $field:ident: $kind:ty,)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Default)]
        pub(in crate::model::mass_spring) struct $name {
            $($(#[$about])* pub(in crate::model::mass_spring) $field: $kind,)+
        }

        impl Clone for $name {
            fn clone(&self) -> Self {
                Self { $($field: self.$field.clone(),)+ }
            }

            fn clone_from(&mut self, other: &Self) {
                $(self.$field.clone_from(&other.$field);)+
            }
        }
    };
}

mod bending;
mod corner_error;
mod dynamics;
mod equilibrium;
mod integrator;
mod mesh;
mod pulleys;
mod results;
mod xpbd;

use std::sync::Arc;

use crate::contact::Gap;
use crate::error::{SolveError, Unsupported};
use crate::math::Vec2;
use crate::model::fem::FemModel;
use crate::model::gauge::TensionGauge;
use crate::model::input_filter::{SmoothedTarget, held_warning};
pub use crate::model::settings::Stepping;
use crate::model::{Inertia, Mechanics, Model, Settings, StepReport};
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::ErrorEstimates;
use crate::solution::{CableSolution, Cost, Warning, WarningKind};
use crate::state::State;
use dynamics::momentum::Account;
use dynamics::rollback::Rollback;
use dynamics::{Clock, SupportDrives};
use equilibrium::contact_energy::{Anchors, ContactMemory};
use equilibrium::error_estimate::ErrorEstimator;
use mesh::Chain;
use pulleys::pulley::Wheels;

part! {
    /// What is said of the present instant and of the last step.
    Report {
        /// What it took.
        cost: Cost,
        /// What the user should know.
        warnings: Vec<Warning>,
        /// What became of the momentum since the caller's step began.
        account: Account,
        /// The model that goes on beside it to tell its errors.
        beside: ErrorEstimator,
        /// What these are.
        errors: ErrorEstimates,
    }
}

/// The model's mechanics of one cable.
#[derive(Clone, Debug)]
pub struct MassSpringModel {
    problem: Arc<Problem>,
    settings: Settings,
    clock: Clock,
    chain: Chain,
    drives: SupportDrives,
    contacts: ContactMemory,
    wheels: Wheels,
    report: Report,
    /// True if it has left the route for a shape found by a solve, a step or another model.
    laid: bool,
    kept: Rollback,
}

/// What an anchor holds the cable to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Surface {
    /// The floor of a plan view, which rubs everywhere.
    Floor,
    /// The obstacle of this index.
    Obstacle(usize),
}

/// Where friction holds the cable: the material point, m, and where it lies.
#[derive(Clone, Copy, Debug)]
struct Anchor {
    surface: Surface,
    s: f64,
    at: Vec2,
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

fn unsupported(feature: Unsupported) -> SolveError {
    SolveError::Unsupported { model: Model::MassSpring, feature }
}

/// The resting shape of the corrected bars and where the supports sit on it.
fn shape_of(problem: Arc<Problem>, settings: Settings) -> Option<Shape> {
    let mut fem = FemModel::new(problem, settings).ok()?.with_material_nodes();
    let warnings = fem.settle().ok()?.warnings;
    let (state, answer) = (fem.state(), fem.solution());
    let slid = answer.supports.iter().map(|s| s.arc_length_m).collect();
    let tension = answer.nodes.iter().map(|n| (n.arc_length_m, n.tension_n)).collect();
    let warnings = warnings.into_iter().filter(|w| w.kind == WarningKind::NotUnique).collect();
    Some(Shape { state, slid, tension, warnings })
}

/// A resting shape of another model.
struct Shape {
    state: State,
    /// Where the supports sit, m.
    slid: Vec<f64>,
    /// Arc length, m, and tension there, N.
    tension: Vec<(f64, f64)>,
    /// Why it might be another one.
    warnings: Vec<Warning>,
}

impl MassSpringModel {
    /// Builds it at the route.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs what the model lacks.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        if problem.cable.self_contact {
            return Err(unsupported(Unsupported::SelfContact));
        }
        let slid = mesh::lay_supports(&problem);
        Ok(Self::mesh(problem, settings, &slid))
    }

    /// Takes the first shape from the corrected bars, if they find one.
    fn lay(&mut self) {
        let settings = Settings { segments: Some(self.chain.rest.len()), ..self.settings };
        let found = shape_of(self.problem.clone(), settings).or_else(|| shape_of(Arc::new(self.pinned()), settings));
        if let Some(shape) = found
            && let Some(mut next) = self.shaped(&shape.state, &shape.slid)
        {
            next.clock.time_s = self.clock.time_s;
            for e in 0..next.chain.tension.len() {
                let middle = 0.5 * (next.chain.s[e] + next.chain.s[e + 1]);
                let k = shape.tension.partition_point(|n| n.0 < middle).min(shape.tension.len().saturating_sub(1));
                next.chain.tension[e] = shape.tension.get(k).map_or(0.0, |n| n.1);
            }
            next.report.warnings.extend(shape.warnings);
            *self = next;
        }
        self.laid = true;
    }

    /// The problem with its pulleys gripping the cable where it was laid: for models that have none
    /// beside obstacles.
    fn pinned(&self) -> Problem {
        let mut problem = (*self.problem).clone();
        for p in &self.wheels.pulleys {
            let support = &mut problem.supports[p.support];
            let out = Vec2::new(-p.mark.sin(), p.mark.cos()) * (p.facing * p.radius);
            support.kind = SupportKind::Fixed;
            support.arc_length = Some(self.chain.s[p.node]);
            support.at = support.at.map(|a| a + out);
            if let Some(m) = &mut support.motion {
                m.shift(out);
            }
        }
        problem
    }

    /// A chain of the same cable along a shape, its supports where `slid` says; None if the shape
    /// has no place for it.
    fn shaped(&self, shape: &State, slid: &[f64]) -> Option<Self> {
        let own = self.nodes_of(shape);
        let mut next = Self::mesh_on(self.problem.clone(), self.settings, slid, own);
        let speeds = State { position_m: shape.velocity_m_per_s.clone(), ..shape.clone() };
        // A cable whose length was edited keeps its shape: material is spread over it evenly.
        let scale = shape.arc_length_m.last().copied().unwrap_or(0.0) / self.problem.length;
        for n in 0..next.chain.x.len() {
            next.chain.x[n] = shape.position_at(next.chain.s[n] * scale)?;
            next.chain.v[n] = speeds.position_at(next.chain.s[n] * scale)?;
        }
        next.clock.time_s = shape.time_s;
        next.drives.driven = self.drives.driven;
        next.drives.drag.clone_from(&self.drives.drag);
        next.drives.followers.clone_from(&self.drives.followers);
        next.drives.pulled.clone_from(&self.drives.pulled);
        next.drives.hands.clone_from(&self.drives.hands);
        next.place_pulleys();
        for k in 0..next.wheels.pulleys.len() {
            // What `slid` says is the middle of the arc, σ is where the mark is.
            let i = next.wheels.pulleys[k].node;
            let ahead = next.reach(i - 1).arc[0] - next.reach(i).arc[1];
            next.chain.s[i] += 0.5 * ahead / self.problem.thermal_stretch;
            next.wheels.pulleys[k].anchor = next.chain.s[i];
        }
        next.tidy();
        next.laid = true;
        next.forces();
        Some(next)
    }

    fn touches_something(&self) -> bool {
        !self.problem.world.is_empty() || self.problem.floor_friction.is_some()
    }

    /// Returns what a sub-step cannot go beyond.
    fn non_finite(&self) -> Option<SolveError> {
        let bad =
            (0..self.chain.x.len()).find(|&i| !(self.chain.x[i] + self.chain.v[i]).iter().all(|c| c.is_finite()))?;
        Some(SolveError::NonFinite {
            quantity: "position or velocity",
            arc_length_m: self.chain.s[bad],
            time_s: self.clock.time_s,
        })
    }

    /// Comes to rest; on an error nothing has changed.
    fn settle_alone(&mut self) -> Result<(), SolveError> {
        self.report.account = dynamics::momentum::Account::default();
        let kept = self.clone();
        if !self.laid {
            self.lay();
        }
        let found = self.equilibrium(Anchors::Forgotten);
        if found.is_err() {
            *self = kept;
        }
        found
    }

    fn report(&mut self) -> StepReport {
        self.warn_of_corners();
        for (k, f) in self.drives.followers.iter().enumerate() {
            if let Some(f) = f.as_ref().filter(|f| f.behind_m() > 0.0) {
                let fastest = self.settings.hand_speed_m_per_s;
                self.report.warnings.push(held_warning(
                    &self.problem,
                    k,
                    self.chain.s[self.chain.node_of[k]],
                    f,
                    fastest,
                ));
            }
        }
        self.warn_of_hands();
        StepReport { cost: self.report.cost, warnings: std::mem::take(&mut self.report.warnings) }
    }
}

impl Mechanics for MassSpringModel {
    fn model(&self) -> Model {
        Model::MassSpring
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        let first = !self.laid && self.clock.time_s == 0.0;
        self.settle_alone()?;
        self.look_beside(first);
        Ok(self.report())
    }

    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        if !(dt_s > 0.0 && dt_s <= MAX_STEP_S) {
            return Err(SolveError::TimeStep { dt_s, longest_s: 60.0 });
        }
        self.laid = true;
        let end_s = self.clock.time_s + dt_s;
        self.clock.due_s = end_s;
        if inertia == Inertia::Dynamic && gauge.asks(self.clock.time_s) {
            let at_rest = self.chain.v.iter().all(|v| *v == Vec2::zeros());
            gauge.begin(self.clock.time_s, at_rest, &self.chain.s, |i| self.gauged(i));
        }
        // Not copied with each of its parts.
        let beside = std::mem::take(&mut self.report.beside);
        let counts = inertia == Inertia::Dynamic && !self.previews();
        let done = self.or_as_before(|this| {
            this.begin_account(dt_s, counts);
            match inertia {
                Inertia::Dynamic if this.previews() => this.preview(dt_s, gauge),
                Inertia::Dynamic => this.integrate(dt_s, gauge),
                Inertia::QuasiStatic => this.creep(dt_s),
            }
        });
        self.report.beside = beside;
        done?;
        self.clock.time_s = end_s;
        self.follow_beside(dt_s, inertia);
        Ok(self.report())
    }

    fn state(&self) -> State {
        self.present()
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        if let Some(e) = state.refuse_non_finite() {
            return Err(e);
        }
        let slid = self.slid_in(state);
        let next = self.shaped(state, &slid).ok_or_else(|| unsupported(Unsupported::EmptyState))?;
        next.refuse_buried()?;
        *self = next;
        Ok(())
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        if target_m.iter().all(|c| c.is_finite())
            && let Some(d) = self.drives.drag.get_mut(support)
        {
            *d = Some(target_m);
            self.drives.pulled[support] = false;
        }
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.drag_support(support, hand_m);
        let holds = |kind| matches!(kind, SupportKind::Fixed | SupportKind::Clamped);
        if self.problem.supports.get(support).is_some_and(|s| holds(s.kind)) {
            self.drives.pulled[support] = true;
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

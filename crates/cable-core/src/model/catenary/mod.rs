//! `catenary` joins exact elastic catenaries between supports, loads and pulleys. It solves statics
//! and slow motion with friction memory, without obstacles within reach, bending or inertia.
//!
//! | room | content |
//! |---|---|
//! | `supports_and_loads.rs` | supports, wheels and loads at an instant |
//! | `first_guess.rs` | straight ways from wheel to wheel, material spread evenly along them |
//! | `sliding_problem.rs` | material σ at each pulley: span solutions, energy gradient, compliance |
//! | `wheel.rs` | tension and material round a wheel, with weight and friction on the arc |
//! | `equilibrium.rs` | Newton's method for σ: pulleys that hold or slip, stable balances only |
//! | `multiple_equilibria.rs` | other equilibria of a slack cable over frictionless pulleys |
//! | `results.rs` | the answer: nodes dense enough for straight lines, support reactions |
//! | `settings.rs` | the tuned constants of the model |
//!
//! The only unknowns are the arc lengths of the material at the pulleys (`sliding_problem`);
//! everything between is a convex problem of two forces ([`crate::catenary`]). With friction the
//! equilibrium depends on how the cable was laid: [`Mechanics::settle`] starts with the material
//! spread evenly along its way and lets it slip only where friction cannot hold it.

mod equilibrium;
mod first_guess;
mod multiple_equilibria;
pub(super) mod results;
mod settings;
mod sliding_problem;
mod supports_and_loads;
mod wheel;

use crate::numerics::{HalvedSteps, MAX_HALVINGS};
use std::sync::Arc;

use self::equilibrium::{Equilibrium, SlidingStart, solve};
use self::first_guess::{first_arcs, nearest_along, spread};
pub(crate) use self::multiple_equilibria::other_equilibria;
use self::results::{report, straight};
pub use self::settings::CatenarySettings;
use self::sliding_problem::PulleyMode;
use self::supports_and_loads::{SupportLayout, unsupported};
use super::tension_gauge::TensionGauge;
use super::{Inertia, Mechanics, Model, Settings, StepReport};
use crate::error::{FailureCause, SolveError, Unsupported};
use crate::math::{Vec2, bounded};
use crate::model::auxiliary_weight::slack_without_weight;
use crate::model::settings::MAX_MOVE_FRACTION;
use crate::problem::Problem;
use crate::solution::{
    CableSolution, Cost, Histories, Node, SharedNodes, ShownEquilibrium, SupportReaction, Warning, WarningCause,
};
use crate::state::State;

/// Most moves into which a step is divided. Smaller: long drags go farther at once than the method
/// follows; larger: a support that is carried off by kilometres takes minutes.
const MAX_MOVES: f64 = 1000.0;

/// Longest time step taken, s.
const LONGEST_STEP_S: f64 = 1e6;

/// Fraction of a slow step that is joined to the step before it (round-off of the time).
const JOINED_FRACTION: f64 = 1e-6;

/// The `catenary` model of one cable.
#[derive(Clone, Debug)]
pub struct CatenaryModel {
    problem: Arc<Problem>,
    tuned: CatenarySettings,
    time_s: f64,
    dragged: Vec<Option<Vec2>>,
    /// Supports of the anchors of the present equilibrium (a released one drops out).
    anchored: Vec<usize>,
    balance: Option<Equilibrium>,
    /// Material points of an adopted state, by support.
    adopted: Vec<Option<f64>>,
    nodes: SharedNodes,
    reactions: Vec<SupportReaction>,
}

/// The material at pulleys from which a balance is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InitialMaterial {
    /// The material of the present balance.
    AsBefore,
    /// Spread evenly.
    EvenSpread,
}

/// An instant of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StepStage {
    /// The last of a step.
    Final,
    /// One before it.
    Intermediate,
}

impl CatenaryModel {
    /// Builds the cable along its route.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs what the model lacks.
    pub fn new(problem: Arc<Problem>, _settings: Settings) -> Result<Self, SolveError> {
        Self::with_settings(problem, CatenarySettings::default())
    }

    /// As [`Self::new`], with other tuned constants.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_settings(problem: Arc<Problem>, tuned: CatenarySettings) -> Result<Self, SolveError> {
        if problem.bending_stiffness > 0.0 {
            return Err(unsupported(Unsupported::BendingStiffness));
        }
        if problem.floor_friction.is_some() {
            return Err(unsupported(Unsupported::PlanView));
        }
        if problem.cable.self_contact {
            return Err(unsupported(Unsupported::SelfContact));
        }
        let n = problem.supports.len();
        let mut model = Self {
            problem,
            tuned,
            time_s: 0.0,
            dragged: vec![None; n],
            anchored: Vec::new(),
            balance: None,
            adopted: vec![None; n],
            nodes: SharedNodes::default(),
            reactions: Vec::new(),
        };
        // A cable that nothing holds has no route to show; `settle` says so.
        if let Ok(layout) = model.layout(0.0) {
            model.nodes = straight(&model.problem, &layout, &spread(&layout, &model.problem)).into();
        } else {
            let at = model.problem.route.first().copied().unwrap_or_else(Vec2::zeros);
            let length = model.problem.length;
            let node = |s: f64| Node { arc_length_m: s, x_m: at.x + s, y_m: at.y, ..Node::default() };
            model.nodes = vec![node(0.0), node(length)].into();
        }
        Ok(model)
    }

    /// The layout at a time.
    fn layout(&self, time_s: f64) -> Result<SupportLayout, SolveError> {
        Ok(SupportLayout { settings: self.tuned, ..SupportLayout::new(&self.problem, &self.dragged, time_s)? })
    }

    /// Balance of a layout.
    fn balance(&self, layout: &SupportLayout, begin: InitialMaterial) -> Result<Equilibrium, SolveError> {
        let spread = spread(layout, &self.problem);
        let (mut sigma, mut arcs) = (spread, first_arcs(layout));
        let mut modes: Vec<PulleyMode> = layout
            .anchors
            .iter()
            .map(|a| {
                if a.material_point.is_none() && a.friction <= 0.0 { PulleyMode::Slip(0.0) } else { PulleyMode::Stick }
            })
            .collect();
        for (i, a) in layout.anchors.iter().enumerate() {
            if a.material_point.is_some() {
                continue;
            }
            if let Some(s) = self.adopted.get(a.support).copied().flatten() {
                sigma[i] = s;
            }
            let Some(old) = self.balance.as_ref().filter(|_| begin == InitialMaterial::AsBefore) else { continue };
            if let Some(j) = self.anchored.iter().position(|s| *s == a.support) {
                (sigma[i], arcs[i], modes[i]) = (old.sigma[j], old.arcs[j], old.modes[j]);
            }
        }
        let rest_points = sigma.clone();
        let start = SlidingStart { rest_points: &rest_points, sigma, modes: modes.clone(), arcs: arcs.clone() };
        let found = solve(&self.problem, layout, start);
        if found.is_ok() || begin == InitialMaterial::EvenSpread {
            return found;
        }
        // The last slip directions may be a bad start: from all holding.
        for (m, a) in modes.iter_mut().zip(&layout.anchors) {
            if a.friction > 0.0 {
                *m = PulleyMode::Stick;
            }
        }
        solve(
            &self.problem,
            layout,
            SlidingStart { rest_points: &rest_points, sigma: rest_points.clone(), modes, arcs },
        )
    }

    /// Accepts an equilibrium as the state at a time; on an error nothing has changed. Nodes cost
    /// more than the equilibrium, so those of an intermediate instant are made only if they may
    /// meet an obstacle.
    fn accept(
        &mut self,
        layout: &SupportLayout,
        e: Equilibrium,
        time_s: f64,
        instant: StepStage,
    ) -> Result<StepReport, SolveError> {
        if instant == StepStage::Final || !self.problem.world.is_empty() {
            let (nodes, reactions) = report(&self.problem, layout, &e);
            if let Some(node) =
                nodes.iter().position(|n| !(n.x_m.is_finite() && n.y_m.is_finite() && n.tension_n.is_finite()))
            {
                let arc_length_m = nodes.get(node).map_or(0.0, |n| n.arc_length_m);
                return Err(SolveError::NonFinite { quantity: "position or tension", arc_length_m, time_s });
            }
            self.refuse_contact(layout, &nodes)?;
            self.nodes = nodes.into();
            self.reactions = reactions;
        }
        let cost = Cost { iterations: e.iterations, residual_n: e.residual, ..Cost::default() };
        self.anchored = layout.anchors.iter().map(|a| a.support).collect();
        self.balance = Some(e);
        self.adopted.iter_mut().for_each(|a| *a = None);
        self.time_s = time_s;
        Ok(StepReport { cost, warnings: Vec::new() })
    }

    /// Refuses obstacles, unless the cable hangs clear of them and gets there from its first shape
    /// without meeting any.
    fn refuse_contact(&self, layout: &SupportLayout, nodes: &[Node]) -> Result<(), SolveError> {
        let world = &self.problem.world;
        if world.is_empty() {
            return Ok(());
        }
        let at = |n: &Node| Vec2::new(n.x_m, n.y_m);
        let first = first_state(&self.problem, layout);
        let reached = |s: f64| unsupported(Unsupported::Obstacle { arc_length_m: s });
        for w in nodes.windows(2) {
            let (s0, s1) = (w[0].arc_length_m, w[1].arc_length_m);
            if let (Some(a), Some(b)) = (first.position_at(s0), first.position_at(s1)) {
                let inside = world.signed_gap(a, self.problem.length).is_some_and(|g| g.gap_m < 0.0);
                if inside || world.free_fraction([a, b], [at(&w[0]), at(&w[1])], 0.0) < 1.0 {
                    return Err(reached(s0));
                }
            }
        }
        let mut gaps = Vec::new();
        for w in nodes.windows(2) {
            gaps.clear();
            world.segment_gaps(at(&w[0]), at(&w[1]), self.problem.radius, &mut gaps);
            let inside = world.signed_gap(at(&w[0]), self.problem.length).is_some_and(|g| g.gap_m < 0.0);
            if inside || gaps.iter().any(|g| g.gap_m < 0.0) {
                return Err(reached(w[0].arc_length_m));
            }
        }
        Ok(())
    }

    /// Takes one slow step to a time; on an error nothing has changed.
    fn slow_step(&mut self, time_s: f64, instant: StepStage) -> Result<StepReport, SolveError> {
        let layout = self.layout(time_s)?;
        let e = self.balance(&layout, InitialMaterial::AsBefore)?;
        self.accept(&layout, e, time_s, instant)
    }

    /// Makes the nodes of the present equilibrium, after steps that did not make them.
    fn show(&mut self) {
        if let (Ok(layout), Some(e)) = (self.layout(self.time_s), &self.balance) {
            let (nodes, reactions) = report(&self.problem, &layout, e);
            (self.nodes, self.reactions) = (nodes.into(), reactions);
        }
    }

    /// Returns the greatest displacement of a support between two times, m.
    fn support_travel(&self, from_s: f64, to_s: f64) -> f64 {
        let mut most = 0.0f64;
        for s in &self.problem.supports {
            if let (Some((a, _)), Some((b, _))) = (s.position_at(from_s), s.position_at(to_s)) {
                let d = (b - a).norm();
                if d > most {
                    most = d;
                }
            }
        }
        most
    }

    fn has_friction(&self) -> bool {
        self.problem.supports.iter().any(|s| s.friction > 0.0)
    }
}

/// The way the cable is laid, its material spread evenly along it.
fn first_state(p: &Problem, layout: &SupportLayout) -> State {
    let mut state = State::default();
    if p.route.len() > 1 {
        let total: f64 = p.route.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        let mut sum = 0.0;
        for (k, at) in p.route.iter().enumerate() {
            if k > 0 {
                sum += (at - p.route[k - 1]).norm();
            }
            state.arc_length_m.push(p.length * sum / total);
            state.position_m.push(*at);
        }
    } else {
        for n in straight(p, layout, &spread(layout, p)) {
            state.arc_length_m.push(n.arc_length_m);
            state.position_m.push(Vec2::new(n.x_m, n.y_m));
        }
    }
    state
}

impl Mechanics for CatenaryModel {
    fn model(&self) -> Model {
        Model::Catenary
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        let layout = self.layout(self.time_s)?;
        let e = match self.balance(&layout, InitialMaterial::AsBefore) {
            Ok(e) => e,
            Err(_) => self.balance(&layout, InitialMaterial::EvenSpread)?,
        };
        let runs_away = e.runs_away;
        let mut report = self.accept(&layout, e, self.time_s, StepStage::Final)?;
        if runs_away {
            report.warnings.push(Warning::new(WarningCause::Unstable, &self.problem.cable.name, 0.0, [0.0; 2]));
        }
        if self.has_friction() {
            let (shown, histories) = (ShownEquilibrium::EvenlyLaid, Histories::NotSought);
            let cause = WarningCause::ManyEquilibria { shown, histories };
            report.warnings.push(Warning::new(cause, &self.problem.cable.name, 0.0, [0.0; 2]));
        }
        if layout.hint > 0.0 {
            report.warnings.extend(slack_without_weight(&self.problem, &self.nodes));
        }
        Ok(report)
    }

    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        _gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        if inertia == Inertia::Dynamic {
            return Err(unsupported(Unsupported::Inertia));
        }
        if !(dt_s > 0.0 && dt_s <= LONGEST_STEP_S) {
            return Err(SolveError::TimeStep { dt_s, longest_s: LONGEST_STEP_S });
        }
        let (start, end) = (self.time_s, self.time_s + dt_s);
        let pieces =
            (self.support_travel(start, end) / (MAX_MOVE_FRACTION * self.problem.length)).ceil().clamp(1.0, MAX_MOVES);
        let mut steps = HalvedSteps::new(end, dt_s / pieces, MAX_HALVINGS, JOINED_FRACTION);
        let mut total = StepReport::default();
        while let Some(next) = steps.next(self.time_s) {
            match self.slow_step(next, if next >= end { StepStage::Final } else { StepStage::Intermediate }) {
                Ok(r) => {
                    total.cost.iterations += r.cost.iterations;
                    total.cost.residual_n = r.cost.residual_n;
                }
                Err(SolveError::NotConverged { place, residual_n, iterations, .. }) => {
                    total.cost.halved_steps += 1;
                    if !steps.halve() {
                        if self.time_s > start {
                            self.show();
                        }
                        return Err(SolveError::StepFailed {
                            model: Model::Catenary,
                            time_s: self.time_s,
                            dt_s: steps.step(),
                            residual_n,
                            place,
                            cause: FailureCause::NoBalance { iterations },
                        });
                    }
                }
                Err(e) => {
                    if self.time_s > start {
                        self.show();
                    }
                    return Err(e);
                }
            }
        }
        Ok(total)
    }

    fn time_s(&self) -> f64 {
        self.time_s
    }

    fn state(&self) -> State {
        State::of_nodes(&self.nodes, self.time_s)
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        if let Some(e) = state.refuse_non_finite() {
            return Err(e);
        }
        self.time_s = state.time_s;
        let line = &state.position_m;
        let mut lengths = vec![0.0];
        for w in line.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + (w[1] - w[0]).norm());
        }
        let mut from = 0.0;
        for (k, s) in self.problem.supports.iter().enumerate() {
            if let (None, Some((at, _))) = (s.arc_length, s.position_at(self.time_s)) {
                from = nearest_along(line, at, from);
                let i = lengths.partition_point(|l| *l <= from).clamp(1, lengths.len().max(2) - 1);
                let (Some(l0), Some(l1)) = (lengths.get(i - 1), lengths.get(i)) else { continue };
                let (Some(s0), Some(s1)) = (state.arc_length_m.get(i - 1), state.arc_length_m.get(i)) else { continue };
                let f = if l1 > l0 { (from - l0) / (l1 - l0) } else { 0.0 };
                self.adopted[k] = Some(bounded(s0 + f * (s1 - s0), 0.0, self.problem.length));
            }
        }
        self.balance = None;
        Ok(())
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        if let Some(d) = self.dragged.get_mut(support) {
            *d = Some(target_m);
        }
    }

    fn solution(&self) -> CableSolution {
        let answer = CableSolution {
            name: self.problem.cable.name.clone(),
            nodes: self.nodes.clone(),
            supports: self.reactions.clone(),
            contacts: Vec::new(),
            ..CableSolution::default()
        };
        answer.rounded(&self.problem)
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

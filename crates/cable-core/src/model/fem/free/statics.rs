//! `Statics` finds the equilibrium of a cable that touches nothing but its supports, and follows it
//! quasi-statically.
//!
//! A flexible cable is solved span by span (`span`, `pulley_balance`): every start converges, and
//! the result is in tension and stable by construction. The mesh follows the error estimate if the
//! scene does not give one.

use crate::model::settings::MAX_MOVE_FRACTION;
use crate::numerics::{HalvedSteps, MAX_HALVINGS};
use std::sync::Arc;

use crate::error::{NoEquilibrium, SolveError, Unsupported};
use crate::math::{Vec2, larger};
use crate::model::fem::free::beam::equilibrium::{Beam, BeamOutcome, STEP_TOLERANCE};
use crate::model::fem::free::beam::refinement::{RefinedBeam, refine};
use crate::model::fem::free::dual_weighted_residual;
use crate::model::fem::free::element_material::{BodyForce, material_at};
use crate::model::fem::free::failure_report::solve_error;
use crate::model::fem::free::pulley_balance::{PulleyFailure, PulleyNetwork};
use crate::model::fem::free::results;
use crate::model::fem::free::results::SolutionPoint;
use crate::model::fem::free::stations::{Restraint, StationLayout, place};
use crate::model::fem::free::straight_route::straight_points;
use crate::model::initial_equilibrium::initial_equilibrium;
use crate::model::{Model, Settings, StepReport};
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::ErrorEstimates;
use crate::solution::error_estimates::greatest_tension;
use crate::solution::{Assumptions, CableSolution, Cost, Histories, Node, ShownEquilibrium, Warning, WarningCause};
use crate::state::State;

/// Least and greatest factor by which the number of elements grows in one round. Less at the least:
/// rounds that gain nothing; more at the greatest: one bad estimate makes a mesh that takes
/// seconds.
const ELEMENT_GROWTH_RANGE: [f64; 2] = [1.2, 4.0];
/// Difference of arc lengths within which a state ends where the cable ends, as a fraction of its
/// length. Smaller: states read from text are refused; larger: those of another cable are taken.
const STATE_END_FRACTION: f64 = 1e-6;

/// First number of elements if none is given: an error of 1e-6 for a usual span, in 50 µs.
const FIRST_SEGMENTS: usize = 40;
/// Maximum number of elements by the error estimate. Beyond it round-off grows faster than the
/// error falls.
const MOST_SEGMENTS: usize = 4000;
/// Fraction of the tolerance below which the estimate must stay.
const ESTIMATE_FRACTION: f64 = 0.5;
/// Order of the corrected bar.
const BAR_ORDER: f64 = 4.0;
/// Maximum number of rounds of mesh refinement.
const MAX_MESHES: usize = 6;
/// Maximum number of slow steps in one call.
const MAX_SLOW_STEPS: f64 = 400.0;
/// Fraction of a slow step that is joined to the step before it.
const JOINED_FRACTION: f64 = 0.5;

/// Balances pulleys without friction. On wheels the strain of the material is first taken from a
/// mean tension (accurate to 1e-7), and then integrated exactly.
fn solve_smooth(network: &mut PulleyNetwork) -> Result<FrictionStart, PulleyFailure> {
    network.solve()?;
    if network.layout.stations.iter().any(|s| matches!(s.restraint, Restraint::Pulley(w) if w.radius > 0.0)) {
        let mut exact = network.clone();
        exact.remember();
        if exact.balance_with_friction().is_ok() {
            *network = exact;
        }
    }
    Ok(FrictionStart::Route)
}

/// The friction state of pulleys from which a search begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FrictionStart {
    /// None: the cable is laid along its route.
    Route,
    /// That of the answer before.
    Memory,
}

/// A cable at rest on its supports.
#[derive(Clone, Debug)]
pub struct Statics {
    problem: Arc<Problem>,
    settings: Settings,
    time: f64,
    segments: usize,
    /// Arc length at each support that slides, m.
    slid: Vec<Option<f64>>,
    /// The flexible cable of the last answer, from which the next one starts.
    network: Option<PulleyNetwork>,
    /// The same cable on a finer mesh if pulleys have friction: it gives the effect of the mesh on
    /// the friction memory.
    finer: Option<PulleyNetwork>,
    /// The stiff cable of the last answer.
    beam: Option<Beam>,
    /// The stations of the last answer and the tension forces before and after them, N.
    rested: Option<(StationLayout, Vec<[Vec2; 2]>)>,
    points: Vec<SolutionPoint>,
    estimate: Option<f64>,
    /// Estimated error of the shape, m.
    shape_error: Option<f64>,
    /// True if its state was adopted from outside, so that it no longer lies as on its route.
    adopted: bool,
}

impl Statics {
    /// Builds the cable along its route.
    ///
    /// # Errors `Unsupported` if the scene needs a feature that `Statics` lacks.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        let given = settings.segments.or(problem.cable.segments);
        let mut new = Self {
            segments: given.unwrap_or(FIRST_SEGMENTS),
            slid: vec![None; problem.supports.len()],
            network: None,
            finer: None,
            beam: None,
            rested: None,
            points: Vec::new(),
            estimate: None,
            shape_error: None,
            adopted: false,
            time: 0.0,
            problem,
            settings,
        };
        new.points = straight_points(&new.problem, new.segments, &new.slid);
        Ok(new)
    }

    /// Finds the equilibrium at the present time; `dragged` are the hand-set support positions, m.
    ///
    /// # Errors The reason if there is no equilibrium, or none was found.
    pub fn settle(&mut self, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        let time = self.time;
        self.rest_at(time, dragged)
    }

    /// Moves supports on by `dt_s` without inertia; friction remembers.
    ///
    /// # Errors
    /// As `Mechanics::advance`.
    pub fn advance(&mut self, dt_s: f64, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        let (start, end) = (self.time, self.time + dt_s);
        let rubs = self.problem.supports.iter().any(|s| s.friction > 0.0);
        let steps = if rubs { self.slow_steps(start, end, dragged) } else { 1.0 };
        let mut report = StepReport::default();
        let mut pieces = HalvedSteps::new(end, dt_s / steps, MAX_HALVINGS, JOINED_FRACTION);
        // A hand moves a support along a straight line.
        let from: Vec<Option<Vec2>> = (0..dragged.len()).map(|k| self.support_at(k)).collect();
        let drawn = |time: f64| -> Vec<Option<Vec2>> {
            let part = if time < end { (time - start) / dt_s } else { 1.0 };
            let at = |to: Vec2, from: &Option<Vec2>| from.map_or(to, |f| f + (to - f) * part);
            dragged.iter().zip(&from).map(|(to, from)| to.map(|to| at(to, from))).collect()
        };
        while let Some(next) = pieces.next(self.time) {
            match self.rest_at(next, &drawn(next)) {
                Ok(r) => {
                    report.cost.iterations += r.cost.iterations;
                    report.cost.residual_n = r.cost.residual_n;
                    report.warnings = r.warnings;
                }
                Err(error) => {
                    if !rubs || !pieces.halve() {
                        return Err(error);
                    }
                    report.cost.halved_steps += 1;
                }
            }
        }
        Ok(report)
    }

    /// Number of slow steps for the moves of the supports.
    fn slow_steps(&self, start: f64, end: f64, dragged: &[Option<Vec2>]) -> f64 {
        let mut longest: f64 = 0.0;
        for k in 0..self.problem.supports.len() {
            let from = self.support_at(k).or(place(&self.problem, k, start, &[]));
            let to = place(&self.problem, k, end, dragged);
            if let (Some(a), Some(b)) = (from, to) {
                longest = longest.max((b - a).norm());
            }
        }
        (longest / (MAX_MOVE_FRACTION * self.problem.length)).ceil().clamp(1.0, MAX_SLOW_STEPS)
    }

    /// Finds the equilibrium at a time; on an error nothing has changed.
    fn rest_at(&mut self, time: f64, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        let adaptive = self.settings.segments.or(self.problem.cable.segments).is_none();
        let mut layout = StationLayout::new(&self.problem, time, dragged, &self.slid);
        if layout.stations.len() < 2 || layout.anchored().is_none() {
            return Err(SolveError::NoRestingPlace { why: NoEquilibrium::NothingHolds });
        }
        let (material, body_force) = material_at(&self.problem, time, &layout);
        let (mut segments, mut iterations) = (self.segments, 0);
        layout.cut(segments);
        let mut network = PulleyNetwork::new(layout, material);
        if let Some(old) = &self.network {
            network.start_from(old);
        }
        let rubs = network.rubs() && self.problem.bending_stiffness == 0.0;
        let start = if rubs { self.begin_rubbing(&mut network, dragged) } else { solve_smooth(&mut network) };
        let start = start.map_err(|f| solve_error(&self.problem, &network, self.time, f))?;
        iterations += network.steps;
        if self.problem.bending_stiffness > 0.0 {
            if self.problem.supports.iter().any(|s| s.kind == SupportKind::Pulley) {
                let feature = Unsupported::BendingOverPulleys;
                return Err(SolveError::Unsupported { model: Model::Fem, feature });
            }
            return self.solve_with_bending(network, time, body_force);
        }
        let mut estimate = dual_weighted_residual::relative_error(&mut network);
        for _ in 0..MAX_MESHES {
            if !(adaptive && estimate > ESTIMATE_FRACTION * self.settings.tolerance && segments < MOST_SEGMENTS) {
                break;
            }
            let factor = (estimate / (ESTIMATE_FRACTION * self.settings.tolerance)).powf(1.0 / BAR_ORDER);
            segments = ((segments as f64 * factor.clamp(ELEMENT_GROWTH_RANGE[0], ELEMENT_GROWTH_RANGE[1])).ceil()
                as usize)
                .min(MOST_SEGMENTS);
            network.layout.cut(segments);
            if network.pulley_states.is_empty() { network.solve() } else { network.balance_with_friction() }
                .map_err(|f| solve_error(&self.problem, &network, self.time, f))?;
            iterations += network.steps;
            estimate = dual_weighted_residual::relative_error(&mut network);
        }
        if rubs {
            estimate += self.follow_finer(&network, time, dragged, start);
            network.commit_friction();
            // Friction carries the errors of the steps that it remembers.
            let before = if start == FrictionStart::Route { None } else { self.estimate };
            estimate = before.map_or(estimate, |e| larger(e, estimate));
        }
        self.time = time;
        self.segments = segments;
        self.remember_material_on_pulleys(&network.layout);
        results::points(&network, self.problem.radius, &mut self.points);
        self.estimate = Some(estimate);
        self.shape_error = Some(dual_weighted_residual::position_error(&mut network));
        self.rested = Some((network.layout.clone(), network.forces.clone()));
        let cost = Cost { iterations, residual_n: network.residual, ..Cost::default() };
        self.network = Some(network);
        Ok(StepReport { cost, warnings: self.warnings(body_force) })
    }

    /// Remembers the material at the middle of each pulley, from which the next search begins.
    fn remember_material_on_pulleys(&mut self, layout: &StationLayout) {
        for station in &layout.stations {
            if let (Some(k), Restraint::Pulley(_)) = (station.support, station.restraint)
                && let Some(slid) = self.slid.get_mut(k)
            {
                *slid = Some(station.arc_length + 0.5 * station.material_on_wheel);
            }
        }
    }

    /// Balances pulleys with friction from their memory, or else from the route; returns from
    /// which.
    fn begin_rubbing(
        &self,
        network: &mut PulleyNetwork,
        dragged: &[Option<Vec2>],
    ) -> Result<FrictionStart, PulleyFailure> {
        if let Some(old) = &self.network
            && network.remember_from(old)
        {
            return network.balance_with_friction().map(|()| FrictionStart::Memory);
        }
        if self.time == 0.0
            && !self.adopted
            && let Ok(Some(lay)) = initial_equilibrium(&self.problem, self.settings, dragged, None)
        {
            let mut candidate = network.clone();
            if candidate.remember_answer(&lay.answer) && candidate.balance_with_friction().is_ok() {
                *network = candidate;
                return Ok(FrictionStart::Route);
            }
        }
        network.solve()?;
        network.remember();
        network.balance_with_friction().map(|()| FrictionStart::Route)
    }

    /// Follows the same motion with bars and steps half as long and a friction memory of its own;
    /// returns the difference of the forces relative to the greatest. Errors of mesh and steps add
    /// up in the friction memory, and the present balance alone does not show them.
    fn follow_finer(
        &mut self,
        network: &PulleyNetwork,
        time: f64,
        dragged: &[Option<Vec2>],
        start: FrictionStart,
    ) -> f64 {
        let Some(finer) = self.finer(network, time, dragged, start) else {
            // The finer cable begins anew from here.
            self.finer = None;
            return 0.0;
        };
        let off = dual_weighted_residual::difference(network, &finer);
        self.finer = Some(finer);
        off
    }

    /// The same equilibrium on twice the elements, for the error estimate; None if that has none.
    fn finer(
        &self,
        network: &PulleyNetwork,
        time: f64,
        dragged: &[Option<Vec2>],
        start: FrictionStart,
    ) -> Option<PulleyNetwork> {
        let segments: usize = network.layout.stations.iter().map(|s| s.element_count).sum();
        let cut = |mut layout: StationLayout| {
            layout.cut(2 * segments);
            layout
        };
        let mut half = None;
        let old = self.finer.as_ref().filter(|_| start == FrictionStart::Memory);
        if let Some(old) = old.filter(|_| time > self.time) {
            let middle = 0.5 * (self.time + time);
            let halfway: Vec<Option<Vec2>> =
                (0..dragged.len()).map(|k| Some((dragged[k]? + self.support_at(k).or(dragged[k])?) * 0.5)).collect();
            let layout = cut(StationLayout::new(&self.problem, middle, &halfway, &self.slid));
            let (material, _) = material_at(&self.problem, middle, &layout);
            let mut step = PulleyNetwork::new(layout, material);
            step.start_from(old);
            if !step.remember_from(old) {
                return None;
            }
            step.balance_with_friction().ok()?;
            step.commit_friction();
            half = Some(step);
        }
        let mut finer = PulleyNetwork::new(cut(network.layout.clone()), network.material);
        match half.as_ref().or(old) {
            Some(old) => {
                finer.start_from(old);
                if !finer.remember_from(old) {
                    return None;
                }
            }
            None => {
                finer.start_from(network);
                finer.pulley_states.clone_from(&network.pulley_states);
            }
        }
        finer.balance_with_friction().ok()?;
        finer.commit_friction();
        Some(finer)
    }

    /// Position of a support in the last answer, m. For a wheel it is the centre, because the point
    /// where the cable meets it can move without the support.
    fn support_at(&self, support: usize) -> Option<Vec2> {
        let station = self.network.as_ref()?.layout.stations.iter().find(|s| s.support == Some(support))?;
        match station.restraint {
            Restraint::Pulley(wheel) => Some(wheel.center),
            _ => station.point(0),
        }
    }

    /// Finds the equilibrium with bending stiffness, starting from the flexible cable.
    fn solve_with_bending(
        &mut self,
        network: PulleyNetwork,
        time: f64,
        force: BodyForce,
    ) -> Result<StepReport, SolveError> {
        let given = self.settings.segments.or(self.problem.cable.segments).is_some();
        // A stiff cable has a definite shape without auxiliary weight.
        let body = match force {
            BodyForce::Auxiliary => Vec2::zeros(),
            BodyForce::Own => network.material.body,
        };
        let stiff = Beam::new(&network, self.problem.bending_stiffness, body).wound_as(&self.problem.route);
        let wanted = if given { None } else { Some(ESTIMATE_FRACTION * self.settings.tolerance) };
        let RefinedBeam { beam, outcome, steps, estimate, shape_error } = refine(stiff, wanted, MOST_SEGMENTS);
        let iterations = network.steps + steps;
        match outcome {
            BeamOutcome::Stable => {}
            BeamOutcome::Unstable => return Err(SolveError::Indefinite { model: Model::Fem }),
            BeamOutcome::Failed => {
                return Err(solve_error(&self.problem, &network, self.time, PulleyFailure::Span(0, beam.residual)));
            }
        }
        self.time = time;
        // On a mesh that the user gives, the answer has values at its nodes only.
        self.points = if given { beam.node_points() } else { beam.drawn_points() };
        self.rested = Some((beam.layout().clone(), beam.station_forces()));
        (self.estimate, self.shape_error) = (estimate.map(|e| larger(e, STEP_TOLERANCE)), shape_error);
        let cost = Cost { iterations, residual_n: beam.residual, ..Cost::default() };
        self.network = Some(network);
        // A stiff cable has a definite shape even without weight.
        self.beam = Some(beam);
        Ok(StepReport { cost, warnings: self.warnings(BodyForce::Own) })
    }

    /// The nodes of each equilibrium of a compressed stiff cable: the one that was found and those
    /// bowed to another side. Empty for any other cable.
    pub fn buckled_shapes(&self) -> Vec<Vec<Node>> {
        let nodes = |b: &Beam| b.drawn_points().iter().map(|p| p.node(&self.problem)).collect();
        self.beam
            .as_ref()
            .map_or_else(Vec::new, |b| std::iter::once(b).chain(&b.other_buckled_shapes()).map(nodes).collect())
    }

    /// The warnings about the model's assumptions.
    fn warnings(&self, body_force: BodyForce) -> Vec<Warning> {
        let problem = &self.problem;
        let mut out = Vec::new();
        let mut warn = |cause, value: f64, limit: f64| {
            out.push(Warning::new(cause, &problem.cable.name, 0.0, [value, limit]));
        };
        if problem.supports.iter().any(|s| s.friction > 0.0) {
            let (shown, histories) = (ShownEquilibrium::EvenlyLaid, Histories::NotSought);
            warn(WarningCause::ManyEquilibria { shown, histories }, 0.0, 0.0);
        }
        if body_force == BodyForce::Auxiliary && problem.loads.is_empty() {
            warn(WarningCause::Weightless, 0.0, 0.0);
        }
        if let Some(estimate) = self.estimate
            && !(estimate <= self.settings.tolerance)
        {
            warn(WarningCause::CoarseTension { elements: self.segments }, estimate, self.settings.tolerance);
        }
        out
    }

    /// Takes over a state of the same cable.
    ///
    /// # Errors If a number is not finite or the state does not fit the cable.
    pub fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        if let Some(e) = state.refuse_non_finite() {
            return Err(e);
        }
        let near = STATE_END_FRACTION * self.problem.length;
        let fits = state.arc_length_m.len() == state.position_m.len()
            && state.arc_length_m.first().is_some_and(|s| s.abs() <= near)
            && state.arc_length_m.last().is_some_and(|s| (s - self.problem.length).abs() <= near);
        if !fits {
            let feature = Unsupported::StateOfOtherLength;
            return Err(SolveError::Unsupported { model: Model::Fem, feature });
        }
        self.time = state.time_s;
        for (k, support) in self.problem.supports.iter().enumerate() {
            if let (None, Some((at, _))) = (support.arc_length, support.position_at(state.time_s)) {
                self.slid[k] =
                    Some(crate::model::fem::free::stations::nearest(&state.position_m, &state.arc_length_m, at));
            }
        }
        (self.network, self.beam) = (None, None);
        self.adopted = true;
        self.rested = None;
        (self.estimate, self.shape_error) = (None, None);
        self.points.clear();
        self.points.extend(state.arc_length_m.iter().zip(&state.position_m).map(|(&arc_length, &at)| SolutionPoint {
            arc_length,
            at,
            ..SolutionPoint::default()
        }));
        Ok(())
    }

    /// Positions and velocities of the cable.
    #[must_use]
    pub fn state(&self) -> State {
        State {
            time_s: self.time,
            arc_length_m: self.points.iter().map(|p| p.arc_length).collect(),
            position_m: self.points.iter().map(|p| p.at).collect(),
            velocity_m_per_s: vec![Vec2::zeros(); self.points.len()],
            in_motion: false,
        }
    }

    /// The answer at this instant.
    #[must_use]
    pub fn solution(&self) -> CableSolution {
        let body = self.problem.body_force(self.time);
        let supports = self.rested.as_ref().map_or_else(Vec::new, |(layout, forces)| {
            results::reactions(&self.problem, layout, forces, body, &self.points)
        });
        let answer = CableSolution {
            name: self.problem.cable.name.clone(),
            nodes: self.points.iter().map(|p| p.node(&self.problem)).collect(),
            supports,
            contacts: Vec::new(),
            error_estimate: self.estimate,
            assumptions: Assumptions {
                bending_stiffness_n_m2: self.problem.bending_stiffness,
                ..Assumptions::default()
            },
            ..CableSolution::default()
        };
        let mut errors =
            ErrorEstimates { position_m: self.shape_error, ..ErrorEstimates::of_forces(&answer, self.estimate) };
        // The greatest tension of a stiff cable may be between the nodes of a given mesh.
        if let Some(beam) = &self.beam {
            let unseen = (beam.greatest_tension() - greatest_tension(&answer.nodes)).abs();
            errors.max_tension_n = errors.max_tension_n.map(|e| e + unseen);
        }
        CableSolution { errors, ..answer }
    }
}

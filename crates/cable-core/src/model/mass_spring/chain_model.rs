//! The chain of masses and springs of one cable finds its rest and advances in time, without
//! knowing its errors: the model is one, and so is the coarser mesh beside which errors are
//! estimated.

use std::sync::Arc;

use crate::contact::geometry::Body;
use crate::error::{SolveError, Unsupported};
use crate::math::Vec2;
use crate::model::fem::FemModel;
use crate::model::mass_spring::contact_memory::ContactMemory;
use crate::model::mass_spring::dynamics::{
    ChainState, Clock, MomentumSums, Report, Rollback, SupportDrives, buried_nodes, hands, integrate, transaction,
};
use crate::model::mass_spring::equilibrium::{Anchors, find_equilibrium, quasi_static_step};
use crate::model::mass_spring::forces::{nodal, tension};
use crate::model::mass_spring::mesh::{Mesh, even_out, first_support_arc_lengths};
use crate::model::mass_spring::preview_choice::is_preview;
use crate::model::mass_spring::results;
use crate::model::mass_spring::settings::Tuning;
use crate::model::mass_spring::xpbd::preview;
use crate::model::tension_gauge::{TensionBefore, TensionGauge};
use crate::model::{Inertia, Mechanics, Model, Settings, StepReport};
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{CableSolution, ErrorEstimates, Node, Warning, WarningKind};
use crate::state::State;

/// The chain of one cable.
#[derive(Clone, Debug)]
pub(in crate::model::mass_spring) struct ChainModel {
    pub settings: Settings,
    pub chain: ChainState,
    /// True if it has left the route for a shape found by a solve, a step or another model.
    pub has_shape: bool,
    rollback: Rollback,
}

/// Longest step, s: a longer one is a mistake in the caller's clock.
const MAX_STEP_S: f64 = 60.0;
/// Difference of distances up to which two nodes are equally near to a point, as a fraction of the
/// even length.
const NEAREST_TOLERANCE: f64 = 1e-6;

fn unsupported(feature: Unsupported) -> SolveError {
    SolveError::Unsupported { model: Model::MassSpring, feature }
}

/// An equilibrium of `fem`.
struct FemEquilibrium {
    state: State,
    /// Arc lengths of the supports, m.
    supports: Vec<f64>,
    /// Tensions along the cable.
    tensions: Vec<TensionSample>,
    /// Warnings that other equilibria exist.
    warnings: Vec<Warning>,
}

/// A tension at a point of the cable.
struct TensionSample {
    arc_length: f64,
    tension: f64,
}

impl FemEquilibrium {
    /// The equilibrium of a cable, if `fem` finds one.
    fn find(problem: Arc<Problem>, settings: Settings) -> Option<Self> {
        let mut fem = FemModel::new(problem, settings).ok()?.with_material_nodes();
        let warnings = fem.settle().ok()?.warnings;
        let (state, answer) = (fem.state(), fem.solution());
        let tension = |n: &Node| TensionSample { arc_length: n.arc_length_m, tension: n.tension_n };
        Some(Self {
            state,
            supports: answer.supports.iter().map(|s| s.arc_length_m).collect(),
            tensions: answer.nodes.iter().map(tension).collect(),
            warnings: warnings.into_iter().filter(|w| w.kind == WarningKind::NotUnique).collect(),
        })
    }

    /// Tension at an arc length (m), N.
    fn tension_at(&self, arc_length: f64) -> f64 {
        let next = self.tensions.partition_point(|n| n.arc_length < arc_length);
        self.tensions.get(next.min(self.tensions.len().saturating_sub(1))).map_or(0.0, |n| n.tension)
    }
}

impl ChainModel {
    /// Builds the cable along its route.
    ///
    /// # Errors
    /// `Unsupported` when the scene needs a feature that the model lacks.
    pub fn new(problem: Arc<Problem>, settings: Settings, tuning: Arc<Tuning>) -> Result<Self, SolveError> {
        if problem.cable.self_contact {
            return Err(unsupported(Unsupported::SelfContact));
        }
        let supports = first_support_arc_lengths(&problem, &tuning.mesh);
        let segments = segments(&problem, &settings, &tuning);
        Ok(Self::of_mesh(Mesh::new(problem, tuning, segments, &supports), settings))
    }

    fn of_mesh(mut mesh: Mesh, settings: Settings) -> Self {
        let clock = Clock::default();
        let mut drives = SupportDrives::new(mesh.support_node.len());
        drives.place_nodes(&mut mesh, clock.time_s);
        even_out(&mut mesh, clock.time_s);
        nodal::update(&mut mesh, clock.time_s, 0.0);
        let contacts = ContactMemory::new(mesh.rest_length.len());
        let chain = ChainState { clock, mesh, drives, contacts, report: Report::default() };
        Self { settings, chain, has_shape: false, rollback: Rollback::default() }
    }

    /// The same cable along a shape, with its supports at given arc lengths (m); None if the shape
    /// does not fit it.
    pub fn on_shape(&self, shape: &State, supports: &[f64]) -> Option<Self> {
        let (problem, tuning) = (self.chain.mesh.problem.clone(), self.chain.mesh.tuning.clone());
        let segments = segments(&problem, &self.settings, &tuning);
        let mesh = match self.chain.mesh.usable_nodes(shape) {
            Some(nodes) => Mesh::with_nodes(problem, tuning, segments, supports, nodes),
            None => Mesh::new(problem, tuning, segments, supports),
        };
        let mut next = Self::of_mesh(mesh, self.settings);
        let time_s = shape.time_s;
        next.chain.clock.time_s = time_s;
        next.chain.drives.take_drags(&self.chain.drives);
        next.has_shape = true;
        let mesh = &mut next.chain.mesh;
        let speeds = State { position_m: shape.velocity_m_per_s.clone(), ..shape.clone() };
        // A cable whose length was edited keeps its shape: material is spread over it evenly.
        let scale = shape.arc_length_m.last().copied().unwrap_or(0.0) / mesh.problem.length;
        for n in 0..mesh.position.len() {
            mesh.position[n] = shape.position_at(mesh.arc_length[n] * scale)?;
            mesh.velocity[n] = speeds.position_at(mesh.arc_length[n] * scale)?;
        }
        next.chain.drives.place_pulleys(mesh, time_s);
        for k in 0..mesh.wheels.pulleys.len() {
            // The arc length of a support is that of the middle of the arc, σ is that of the mark.
            let i = mesh.wheels.pulleys[k].node;
            let ahead = mesh.element(i - 1).arc[0] - mesh.element(i).arc[1];
            mesh.arc_length[i] += 0.5 * ahead / mesh.thermal_stretch;
            mesh.wheels.pulleys[k].anchor = mesh.arc_length[i];
        }
        even_out(mesh, time_s);
        nodal::update(mesh, time_s, 0.0);
        next.chain.contacts = ContactMemory::new(next.chain.mesh.rest_length.len());
        Some(next)
    }

    /// Starts from the equilibrium of `fem`, if that finds one.
    fn start_from_fem(&mut self) {
        let settings = Settings { segments: Some(self.chain.mesh.rest_length.len()), ..self.settings };
        let found = FemEquilibrium::find(self.chain.mesh.problem.clone(), settings)
            .or_else(|| FemEquilibrium::find(Arc::new(self.without_pulleys()), settings));
        if let Some(found) = found
            && let Some(mut next) = self.on_shape(&found.state, &found.supports)
        {
            next.chain.clock.time_s = self.chain.clock.time_s;
            for e in 0..next.chain.mesh.tension.len() {
                let middle = 0.5 * (next.chain.mesh.arc_length[e] + next.chain.mesh.arc_length[e + 1]);
                next.chain.mesh.tension[e] = found.tension_at(middle);
            }
            next.chain.report.warnings.extend(found.warnings);
            *self = next;
        }
        self.has_shape = true;
    }

    /// The problem with pulleys that grip the cable at its first shape: for models that have no
    /// pulleys beside obstacles.
    fn without_pulleys(&self) -> Problem {
        let mut problem = (*self.chain.mesh.problem).clone();
        for p in &self.chain.mesh.wheels.pulleys {
            let support = &mut problem.supports[p.support];
            let out = Vec2::new(-p.mark_angle.sin(), p.mark_angle.cos()) * (p.sense * p.radius);
            support.kind = SupportKind::Fixed;
            support.arc_length = Some(self.chain.mesh.arc_length[p.node]);
            support.at = support.at.map(|a| a + out);
            if let Some(m) = &mut support.motion {
                m.shift(out);
            }
        }
        problem
    }

    /// Finds the equilibrium without `fem`; on an error nothing has changed.
    pub fn settle(&mut self) -> Result<(), SolveError> {
        self.chain.report.account = MomentumSums::default();
        let before = self.clone();
        if !self.has_shape {
            self.start_from_fem();
        }
        self.chain.mesh.approach_edit(1.0);
        let found = find_equilibrium(&mut self.chain, Anchors::Forgotten);
        if found.is_err() {
            *self = before;
        }
        found
    }

    /// Arc lengths of the supports on a shape, m: that of a pulley is of the material nearest to
    /// it, in order.
    pub fn support_arc_lengths(&self, shape: &State) -> Vec<f64> {
        let scale = self.chain.mesh.problem.length / shape.arc_length_m.last().copied().unwrap_or(1.0);
        let mut least = 0.0;
        let mut out = vec![0.0; self.chain.mesh.problem.supports.len()];
        for (k, s) in self.chain.mesh.problem.supports.iter().enumerate() {
            out[k] = match (s.arc_length, s.position_at(shape.time_s)) {
                (Some(known), _) => known,
                (None, Some((at, _))) => {
                    let at = self.chain.drives.targets[k].unwrap_or(at);
                    let off = |j: &usize| (shape.position_m[*j] - at).norm();
                    let later = (0..shape.position_m.len()).filter(|&j| shape.arc_length_m[j] * scale > least);
                    // Of several equally near nodes the middle one counts: they are those on the
                    // wheel.
                    let nearest = later.clone().map(|j| off(&j)).fold(f64::INFINITY, f64::min);
                    let near: Vec<usize> =
                        later.filter(|j| off(j) <= nearest + NEAREST_TOLERANCE * self.chain.mesh.even_length).collect();
                    near.get(near.len() / 2).map_or(least, |&j| shape.arc_length_m[j] * scale)
                }
                (None, None) => least,
            };
            least = out[k];
        }
        out
    }

    /// Advances time by `dt_s`; on an error nothing has changed but the time that is due.
    pub fn advance(&mut self, dt_s: f64, inertia: Inertia, gauge: &mut TensionGauge) -> Result<(), SolveError> {
        if !(dt_s > 0.0 && dt_s <= MAX_STEP_S) {
            return Err(SolveError::TimeStep { dt_s, longest_s: MAX_STEP_S });
        }
        self.has_shape = true;
        let end_s = self.chain.clock.time_s + dt_s;
        self.chain.clock.due_s = end_s;
        if inertia == Inertia::Dynamic && gauge.asks(self.chain.clock.time_s) {
            let before = TensionBefore::of_motion(&self.chain.mesh.velocity);
            gauge.begin(self.chain.clock.time_s, before, &self.chain.mesh.arc_length, |i| {
                tension::at_node(&self.chain.mesh, i)
            });
        }
        let settings = &self.settings;
        transaction(&mut self.rollback, &mut self.chain, |chain| {
            chain.report.account = MomentumSums::default();
            match inertia {
                Inertia::Dynamic if is_preview(&chain.mesh, settings.stepping) => preview(chain, settings, dt_s, gauge),
                Inertia::Dynamic => {
                    chain.report.account = MomentumSums::of_step(&chain.mesh, dt_s);
                    integrate(chain, settings, dt_s, gauge)
                }
                Inertia::QuasiStatic => quasi_static_step(chain, dt_s),
            }
        })?;
        self.chain.clock.time_s = end_s;
        Ok(())
    }

    /// Adopts a state of the same cable.
    pub fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        if let Some(e) = state.refuse_non_finite() {
            return Err(e);
        }
        let supports = self.support_arc_lengths(state);
        let next = self.on_shape(state, &supports).ok_or_else(|| unsupported(Unsupported::EmptyState))?;
        buried_nodes::refuse_buried(&next.chain.mesh)?;
        *self = next;
        Ok(())
    }

    /// Continues from where `before`, the same chain before an edit of its scene, is, with the loss
    /// and the contacts that it remembers. Returns false, without a change, if the edit concerns
    /// its nodes or its material, or an obstacle now stands where it is.
    pub fn continue_from(&mut self, before: &Self) -> bool {
        let edited = &self.chain.mesh;
        if !before.chain.mesh.is_divided_like(edited, before.chain.clock.time_s) {
            return false;
        }
        let mut chain = before.chain.clone();
        chain.mesh.become_cable_of(edited);
        let [old, new] = [&before.chain.mesh, edited].map(|mesh| mesh.problem.world.geometry().bodies());
        let same = |(a, b): (&Body, &Body)| (a.first, a.friction) == (b.first, b.friction) && a.is_where(b);
        if old.len() != new.len() || !old.iter().zip(new).all(same) {
            chain.contacts = ContactMemory::new(chain.mesh.rest_length.len());
        }
        chain.drives.continue_to(&self.chain.drives);
        chain.report = Report::default();
        if buried_nodes::refuse_buried(&chain.mesh).is_err() {
            return false;
        }
        (self.chain, self.has_shape) = (chain, true);
        true
    }

    /// Its answer, with these errors.
    pub fn answer(&self, errors: &ErrorEstimates) -> CableSolution {
        results::answer(&self.chain, errors, self.settings.tolerance)
    }

    /// Its answer while nothing is known of its errors.
    pub fn solution(&self) -> CableSolution {
        self.answer(&ErrorEstimates::default())
    }

    pub fn step_report(&mut self) -> StepReport {
        let fastest = self.settings.hand_speed_m_per_s;
        let corner =
            results::corner_warning(&self.chain.mesh, &self.chain.contacts, &self.chain.report.cost, &self.settings);
        let mut warnings = std::mem::take(&mut self.chain.report.warnings);
        warnings.extend(corner);
        warnings.extend(self.chain.drives.warnings(&self.chain.mesh, fastest));
        warnings.extend(hands::warnings(&self.chain.drives, &self.chain.mesh, fastest));
        StepReport { cost: self.chain.report.cost, warnings }
    }
}

/// Number of elements of a cable with even elements.
fn segments(problem: &Problem, settings: &Settings, tuning: &Tuning) -> usize {
    settings.segments.or(problem.cable.segments).unwrap_or(tuning.mesh.segments).max(1)
}

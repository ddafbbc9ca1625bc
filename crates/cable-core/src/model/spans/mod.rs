//! `spans` is the quasi-static model of exact elements: a taut flexible cable with contact and
//! friction, without a mesh.
//!
//! Free spans are elastic catenaries, contacts are intervals of an obstacle's boundary through
//! which the material slides, and friction remembers in closed form. Each module begins with its
//! derivation.
//!
//! | room | what it holds |
//! |---|---|
//! | `boundary` | the boundary as the centre line runs along it, the capstan law and friction memory |
//! | `contact` | a contact: equations, loads on it, supports on it, wheels |
//! | `section` | free spans and contacts in a row between two end conditions: the unknowns |
//! | `section_layout` | division of a cable into sections by supports and loads |
//! | `newton`, `bracketed_root` | all unknowns of a section at once; the root of one variable |
//! | `changes` | contacts that are released, merged and made, until none is needed |
//! | `initial` | the first shape: route, shortest path, contacts, tension; or another answer |
//! | `first_equilibrium` | the search for the first equilibrium, from several first shapes; other
//! equilibria; the friction that a sliding cable lacks |
//! | `continuation` | from one instant to the next, in steps that are halved |
//! | `reversal` | the cable counted from its other end |
//! | `slack` | cable that lies without tension |
//! | `acceptance` | checks of an equilibrium that do not use the solver |
//! | `results` | the answer |
//! | `wheel_departure` | wheels that the cable leaves |
//! | `settings` | the tuned constants |
//!
//! The model refuses what it cannot do: bending, self-contact, inertia, plan view, supports that
//! release the cable. If a cable loses its tension, the error tells the place.

mod acceptance;
mod boundary;
mod bracketed_root;
mod changes;
pub(in crate::model) mod contact;
mod continuation;
mod first_equilibrium;
mod initial;
mod newton;
mod results;
mod reversal;
mod section;
mod section_layout;
mod settings;
mod slack;
mod wheel_departure;

use std::sync::Arc;

use crate::error::{NoEquilibrium, Place, SolveError, Unsupported};
use crate::math::{Vec2, larger, smaller};
use crate::model::auxiliary_weight::slack_without_weight;
use crate::model::spans::continuation::StepStats;
use crate::model::spans::first_equilibrium::{NotFound, SearchStart};
use crate::model::spans::newton::Workspace;
use crate::model::spans::results::SpansAnswer;
use crate::model::spans::reversal::Reversal;
use crate::model::spans::section::{BoundaryConditions, CableEquilibrium, Failure, tension_loss};
use crate::model::spans::section_layout::{CableEnd, SectionLayout, unsupported};
use crate::model::tension_gauge::TensionGauge;
use crate::model::{Inertia, Mechanics, Model, Settings, StepReport};
use crate::problem::Problem;
use crate::scene::FrictionMobilised;
use crate::solution::{CableSolution, Cost, Histories, ModelReason, Node, ShownEquilibrium, Warning, WarningCause};
use crate::state::State;

pub use crate::model::spans::settings::SpansSettings;

/// Most moves into which a step is divided. Smaller: long drags go farther at once than the method
/// follows; larger: a support that is carried off by kilometres takes minutes.
const MAX_MOVES: f64 = 1000.0;

/// Difference of tensions within which two histories agree, as a fraction of the greatest tension.
/// Larger: a cable held by little friction is reported to have one equilibrium; smaller: round-off
/// is reported as another history.
const SAME_TENSION_FRACTION: f64 = 1e-9;
/// Longest time step taken, s.
const LONGEST_STEP_S: f64 = 1e6;

/// Is shown the nodes of each answer on the way of an advance; returns whether that goes on.
pub(in crate::model) type NodesWatch<'a> = &'a mut dyn FnMut(&[Node]) -> bool;

/// The `spans` model of one cable.
#[derive(Clone, Debug)]
pub struct SpansModel {
    problem: Arc<Problem>,
    /// True if other histories are searched.
    histories: bool,
    /// True if a cable too long to rest in tension is laid loose at once.
    lays_loose: bool,
    /// The layout of the cable, counted from either end.
    layout: SectionLayout,
    time_s: f64,
    /// Hand-set support positions (m) in the order of the layout.
    dragged: Vec<Option<Vec2>>,
    cable_equilibrium: Option<CableEquilibrium>,
    workspace: Workspace,
    /// The start and the goal of a step, and an instant between them.
    instants: [BoundaryConditions; 3],
    /// The report while there is no cable equilibrium.
    shown: SpansAnswer,
}

impl SpansModel {
    /// Builds the cable along its route.
    ///
    /// # Errors `Unsupported` if the scene needs a feature that the model lacks.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        Self::with_settings(problem, settings, Arc::default())
    }

    /// As [`Self::new`], with other tuned constants.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_settings(
        problem: Arc<Problem>,
        settings: Settings,
        tuned: Arc<SpansSettings>,
    ) -> Result<Self, SolveError> {
        let from = if reversal::is_led_up(&problem) { CableEnd::End } else { CableEnd::Start };
        let layout = counted(&problem, from, tuned)?;
        let n = problem.supports.len();
        let mut points: Vec<Vec2> = problem.route.clone();
        if points.len() < 2 {
            points = problem.supports.iter().filter_map(|s| s.position_at(0.0).map(|p| p.0)).collect();
        }
        if points.len() < 2 {
            let at = points.first().copied().unwrap_or_else(Vec2::zeros);
            points = vec![at, at - Vec2::y() * problem.length];
        }
        let last = (points.len() - 1) as f64;
        let node = |(k, p): (usize, &Vec2)| Node {
            arc_length_m: problem.length * k as f64 / last,
            x_m: p.x,
            y_m: p.y,
            ..Node::default()
        };
        let nodes = points.iter().enumerate().map(node).collect();
        let shown = SpansAnswer { nodes, ..SpansAnswer::default() };
        let (workspace, instants) = (Workspace::default(), <[BoundaryConditions; 3]>::default());
        let (histories, dragged) = (settings.histories, vec![None; n]);
        Ok(Self {
            problem,
            histories,
            lays_loose: true,
            layout,
            time_s: 0.0,
            dragged,
            cable_equilibrium: None,
            workspace,
            instants,
            shown,
        })
    }

    /// Seeks an equilibrium with tension, and slack in kinks, even for a cable too long to rest in
    /// tension alone: for a model that continues from it.
    pub(super) fn seek_tension(&mut self) {
        self.lays_loose = false;
    }

    /// True if cable of the equilibrium lies without tension.
    pub(super) fn has_loose_cable(&self) -> bool {
        self.cable_equilibrium.as_ref().is_some_and(|n| n.loose_lengths().is_some())
    }

    /// Leaves an unstable equilibrium for a stable one; returns a warning if it leads to none.
    pub(super) fn leave_unstable(&mut self) -> Option<Warning> {
        let cable_equilibrium = self.cable_equilibrium.as_mut()?;
        let instant = cable_equilibrium.instant.clone();
        let left = cable_equilibrium.leave_unstable(&self.layout, &instant, &mut self.workspace);
        left.is_err().then(|| self.warning(WarningCause::Unstable))
    }

    /// True if an equilibrium has been found.
    pub(super) fn has_equilibrium(&self) -> bool {
        self.cable_equilibrium.is_some()
    }

    /// Refuses a time (s) at which posts are not where the world of the problem has them.
    fn refuse_moved_posts(&self, time_s: f64) -> Result<(), SolveError> {
        match self.problem.posts_are_at(time_s) {
            true => Ok(()),
            false => Err(unsupported(Unsupported::MovingObstacle)),
        }
    }

    /// Advances without inertia by `dt_s` (s), in moves that are short beside the cable. `goes_on`,
    /// if given, is shown the nodes before the first move and after each, counted as the layout
    /// counts; the advance ends where it returns false.
    ///
    /// # Errors
    /// As [`Mechanics::advance`].
    pub(super) fn advance_while(
        &mut self,
        dt_s: f64,
        mut goes_on: Option<NodesWatch<'_>>,
    ) -> Result<StepReport, SolveError> {
        if !(dt_s > 0.0 && dt_s <= LONGEST_STEP_S) {
            return Err(SolveError::TimeStep { dt_s, longest_s: LONGEST_STEP_S });
        }
        self.refuse_moved_posts(self.time_s + dt_s)?;
        if self.cable_equilibrium.is_none() {
            self.settle()?;
        }
        let (start, end) = (self.time_s, self.time_s + dt_s);
        let Some(mut cable_equilibrium) = self.cable_equilibrium.take() else { return Ok(StepReport::default()) };
        let length = self.layout.problem.length;
        let [mut first, mut last, mut instant] = std::mem::take(&mut self.instants);
        self.layout.instant(&self.dragged, end, &mut last);
        let longest_move = self.layout.settings.continuation.max_move_fraction * length;
        let moves = (Self::travel(&cable_equilibrium.instant, &last) / longest_move).ceil().clamp(1.0, MAX_MOVES);
        let mut workspace = std::mem::take(&mut self.workspace);
        let mut sum = StepReport::default();
        first.clone_from(&cable_equilibrium.instant);
        let (mut failed, mut ran) = (None, 0);
        let mut stays = |here: &CableEquilibrium| match &mut goes_on {
            Some(goes_on) => goes_on(&results::report(&self.layout, here).nodes),
            None => true,
        };
        let mut on = stays(&cable_equilibrium);
        for k in 1..=moves as usize {
            if !on {
                break;
            }
            let f = k as f64 / moves;
            let time_s = if k == moves as usize { end } else { start + dt_s * f };
            self.layout.instant(&self.dragged, time_s, &mut instant);
            self.move_dragged_supports([&first, &last], f, &mut instant);
            match cable_equilibrium.advance_load(&self.layout, &instant, 1.0, &mut workspace) {
                Ok(stats) => {
                    let one = self.report_of(stats).cost;
                    sum.cost.iterations += one.iterations;
                    sum.cost.halved_steps += one.halved_steps;
                    sum.cost.residual_n = one.residual_n;
                    ran += stats.runaways;
                    self.time_s = time_s;
                    on = stays(&cable_equilibrium);
                }
                Err(stopped) => {
                    self.time_s += (time_s - self.time_s) * stopped.done;
                    failed = Some(stopped.failure);
                    break;
                }
            }
        }
        self.cable_equilibrium = Some(cable_equilibrium);
        (self.workspace, self.instants) = (workspace, [first, last, instant]);
        match failed {
            Some(failure) => Err(self.solve_error(None, failure)),
            None => {
                if ran > 0 {
                    sum.warnings.push(self.warning(WarningCause::SlidOn));
                }
                Ok(sum)
            }
        }
    }

    /// The report of the present state.
    fn present_report(&self) -> SpansAnswer {
        match &self.cable_equilibrium {
            Some(cable_equilibrium) => {
                let report = results::report(&self.layout, cable_equilibrium);
                if self.layout.is_reversed() { self.turned().report(&report) } else { report }
            }
            None => self.shown.clone(),
        }
    }

    /// The greatest distance that any support moves between two instants, m.
    fn travel(from: &BoundaryConditions, to: &BoundaryConditions) -> f64 {
        from.places.iter().zip(&to.places).map(|(a, b)| (b - a).norm()).fold(0.0, |m, d| if d > m { d } else { m })
    }

    /// Places dragged supports on their straight way to their hands; others follow their motion.
    fn move_dragged_supports(
        &self,
        [first, last]: [&BoundaryConditions; 2],
        done: f64,
        instant: &mut BoundaryConditions,
    ) {
        for (i, dragged) in self.dragged.iter().enumerate() {
            if dragged.is_some() {
                instant.places[i] = first.places[i] + (last.places[i] - first.places[i]) * done;
            }
        }
    }

    /// A failure as an error: a loss of tension if the last state, `stopped` or the present one,
    /// shows one.
    fn solve_error(&self, stopped: Option<&CableEquilibrium>, failure: Failure) -> SolveError {
        if let Some(cable_equilibrium) = stopped.or(self.cable_equilibrium.as_ref())
            && let Some((loss, arc_length_m, at_m)) =
                tension_loss::find(&cable_equilibrium.sections, &cable_equilibrium.context, &failure)
        {
            let arc_length_m = if self.layout.is_reversed() { self.turned().s(arc_length_m) } else { arc_length_m };
            return SolveError::TensionLost { model: Model::Spans, loss, arc_length_m, at_m };
        }
        self.plain_error(failure)
    }

    /// A failure of the layout as an error for the user.
    fn plain_error(&self, failure: Failure) -> SolveError {
        error_of(&self.problem, if self.layout.is_reversed() { self.turned().failure(failure) } else { failure })
    }

    /// The map from the layout's direction along the cable to that of the scene.
    fn turned(&self) -> Reversal<'_> {
        Reversal { problem: &self.problem }
    }

    /// Finds the first equilibrium: loose if the cable is too long for tension; else along the
    /// route, counted from the cable's upper end; else counted from the other end; else in heaps
    /// where the cable comes down.
    fn find_first_equilibrium(
        &mut self,
        instant: &mut BoundaryConditions,
        workspace: &mut Workspace,
    ) -> Result<StepStats, NotFound> {
        let lays_loose = self.lays_loose && self.problem.cable.friction_mobilised.is_default();
        let too_long = if lays_loose { CableEquilibrium::too_long_for_tension(&self.layout, instant) } else { None };
        let along_route = match too_long {
            Some(loose) => Ok((loose, StepStats::default())),
            None => CableEquilibrium::along_route(&self.layout, instant, workspace),
        };
        let (cable_equilibrium, stats) = match along_route {
            Ok(found) => found,
            Err(not_found) => {
                let (mut there, mut dragged) = (BoundaryConditions::default(), self.dragged.clone());
                dragged.reverse();
                let other = counted(&self.problem, self.layout.counted_from.other(), self.layout.settings.clone())
                    .ok()
                    .and_then(|other| {
                        other.instant(&dragged, self.time_s, &mut there);
                        Some((CableEquilibrium::along_route(&other, &there, workspace).ok()?, other))
                    });
                match (other, CableEquilibrium::in_heaps(&self.layout, instant)) {
                    (Some((found, other)), _) => {
                        (self.layout, self.dragged, *instant) = (other, dragged, there);
                        found
                    }
                    (None, Some(heap)) => (heap, StepStats::default()),
                    (None, None) => return Err(not_found),
                }
            }
        };
        self.cable_equilibrium = Some(cable_equilibrium);
        Ok(stats)
    }

    /// The report of a step from its statistics.
    fn report_of(&self, stats: StepStats) -> StepReport {
        let scale = self.layout.problem.force_scale();
        StepReport {
            cost: Cost {
                iterations: stats.solved.iterations,
                halved_steps: stats.halvings,
                residual_n: stats.solved.residual * scale,
                inner_step_s: 0.0,
            },
            warnings: Vec::new(),
        }
    }

    /// The tensions that other histories of the cable would have left: drawn towards either end, or
    /// laid down loose.
    ///
    /// An equilibrium that was found without friction is not sought in this way again: the search
    /// would come to the place from which the cable is drawn here. If drawing it leads to no
    /// equilibrium, the frictionless shape that friction would hold is another one.
    fn histories(&self, start: SearchStart, workspace: &mut Workspace) -> Histories {
        let Some(cable_equilibrium) = &self.cable_equilibrium else { return Histories::NotSought };
        let turned = self.layout.is_reversed();
        let tensions = |cable_equilibrium: &CableEquilibrium| self.tensions(cable_equilibrium);
        let tensions_here = tensions(cable_equilibrium);
        let drawn = [FrictionMobilised::TowardsStart, FrictionMobilised::TowardsEnd].map(|drawn| {
            let drawn = if turned { reversal::mobilised(drawn) } else { drawn };
            let found = cable_equilibrium.fully_mobilised(&self.layout, drawn.direction(), workspace);
            found.or_else(|| self.along_route_mobilised(drawn, start, workspace)).map(|n| tensions(&n))
        });
        // A cable that is longer than its way may also lie loose.
        let heap = CableEquilibrium::in_heaps(&self.layout, &cable_equilibrium.instant);
        let loose =
            heap.filter(|heap| heap.loose_lengths().is_some_and(|[material, _]| material > 0.0)).map(|n| tensions(&n));
        let seeks = start == SearchStart::Either && drawn.contains(&None);
        let frictionless = if seeks { self.frictionless_equilibrium(workspace).map(|n| tensions(&n)) } else { None };
        let all = || std::iter::once(tensions_here).chain(drawn.into_iter().flatten()).chain(loose).chain(frictionless);
        let range = |k: usize| {
            all().map(|t| t[k]).fold([tensions_here[k], tensions_here[k]], |[a, b], t| [smaller(a, t), larger(b, t)])
        };
        let greatest_n = tensions_here[2];
        // A range of a single history tells nothing about others.
        if loose.is_none() && frictionless.is_none() && drawn.iter().all(Option::is_none) {
            return Histories::NotFound { greatest_n };
        }
        let [towards_start_n, towards_end_n] = drawn.map(|of| of.map(|t| t[2]));
        Histories::Mobilised {
            greatest_n,
            towards_start_n,
            towards_end_n,
            loose_n: loose.map(|t| t[2]),
            frictionless_n: frictionless.map(|t| t[2]),
            start_n: range(0),
            end_n: range(1),
        }
    }

    /// Tensions of a cable equilibrium at the cable's start, at its end and at most, N.
    fn tensions(&self, cable_equilibrium: &CableEquilibrium) -> [f64; 3] {
        let [start, end, greatest] = results::tensions(cable_equilibrium);
        if self.layout.is_reversed() { [end, start, greatest] } else { [start, end, greatest] }
    }

    /// A warning of other equilibria of a frictionless cable, if there are any.
    pub(super) fn other_equilibria(&mut self) -> Option<Warning> {
        if self.rubs() || self.has_loose_cable() {
            return None;
        }
        let cable_equilibrium = self.cable_equilibrium.as_ref()?;
        let others = cable_equilibrium.other_equilibria(&self.layout, &mut self.workspace);
        let others: Vec<[f64; 3]> = others.iter().map(|n| self.tensions(n)).collect();
        let histories = Histories::slack_elsewhere(self.tensions(cable_equilibrium), &others)?;
        Some(self.warning(WarningCause::ManyEquilibria { shown: ShownEquilibrium::FromRoute, histories }))
    }

    fn warning(&self, cause: WarningCause) -> Warning {
        Warning::new(cause, &self.problem.cable.name, 0.0, [0.0; 2])
    }

    /// The first equilibrium of the cable along its route while it is drawn one way.
    fn along_route_mobilised(
        &self,
        drawn: FrictionMobilised,
        start: SearchStart,
        workspace: &mut Workspace,
    ) -> Option<CableEquilibrium> {
        let mut layout = self.layout.clone();
        Arc::make_mut(&mut layout.problem).cable.friction_mobilised = drawn;
        let instant = self.cable_equilibrium.as_ref()?.instant.clone();
        let found = CableEquilibrium::along_route_from(&layout, &instant, start, workspace);
        found.ok().map(|(cable_equilibrium, _)| cable_equilibrium).filter(|n| n.loose_lengths().is_none())
    }

    /// The equilibrium without friction, held by friction from then on.
    fn frictionless_equilibrium(&self, workspace: &mut Workspace) -> Option<CableEquilibrium> {
        let instant = self.cable_equilibrium.as_ref()?.instant.clone();
        let found = CableEquilibrium::along_route_from(&self.layout, &instant, SearchStart::Frictionless, workspace);
        found.ok().map(|(cable_equilibrium, _)| cable_equilibrium).filter(|n| n.loose_lengths().is_none())
    }

    /// The warning of other equilibria that another history of the cable would have left.
    fn history_warning(&self, stats: StepStats, histories: Histories) -> Option<Warning> {
        let cable_equilibrium = self.cable_equilibrium.as_ref()?;
        if let Some([material_m, ground_m]) = cable_equilibrium.loose_lengths() {
            // For any history, only friction on the loose cable can hold more.
            let held_n = cable_equilibrium.friction_of_loose();
            return Some(self.warning(WarningCause::Loose { material_m, ground_m, held_n }));
        }
        let mobilised = self.layout.problem.cable.friction_mobilised;
        if !self.rubs() || !mobilised.is_default() || self.is_history_independent(&histories) {
            return None;
        }
        let shown = match stats.found_without_friction {
            true => ShownEquilibrium::Frictionless,
            false => ShownEquilibrium::LeastSliding,
        };
        Some(self.warning(WarningCause::ManyEquilibria { shown, histories }))
    }

    /// True if some of the cable is held by friction alone.
    fn hangs_by_friction(&self) -> bool {
        self.layout.sections.iter().any(|s| s.supports.iter().all(Option::is_none))
    }

    /// True if the cable touches nothing with friction, and returns to the same tensions after
    /// being drawn towards either end: then no history was found that leaves others.
    fn is_history_independent(&self, histories: &Histories) -> bool {
        let Histories::Mobilised {
            greatest_n, towards_start_n: Some(_), towards_end_n: Some(_), start_n, end_n, ..
        } = histories
        else {
            return false;
        };
        let same = |[low, high]: &[f64; 2]| high - low <= SAME_TENSION_FRACTION * greatest_n;
        let answer = CableSolution { contacts: self.present_report().contacts, ..CableSolution::default() };
        same(start_n) && same(end_n) && !self.problem.rubs(&answer)
    }

    fn rubs(&self) -> bool {
        let p = &self.layout.problem;
        p.supports.iter().any(|s| s.friction > 0.0) || p.world.geometry().bodies().iter().any(|b| b.friction > 0.0)
    }
}

/// The layout of a cable counted from its start, or from its end.
fn counted(problem: &Arc<Problem>, from: CableEnd, settings: Arc<SpansSettings>) -> Result<SectionLayout, SolveError> {
    match from {
        CableEnd::Start => SectionLayout::new(problem, from, settings),
        CableEnd::End => SectionLayout::new(&Arc::new(reversal::problem(problem)), from, settings),
    }
}

/// A failure as an error for the user.
fn error_of(problem: &Problem, failure: Failure) -> SolveError {
    let name = |k: usize| problem.supports.get(k).map_or("", |s| s.name.as_str());
    match failure {
        Failure::Stalled { iterations, residual, s } => SolveError::NotConverged {
            model: Model::Spans,
            iterations,
            residual_n: residual * problem.force_scale(),
            place: Box::new(Place { arc_length_m: s, at_m: Vec2::repeat(f64::NAN), near: None }),
        },
        Failure::Compressed { s, at, tension } => {
            SolveError::Compressed { model: Model::Spans, tension_n: tension, place: problem.place(s, at, 0.0) }
        }
        Failure::ContactCycling { s } => unsupported(Unsupported::EndlessContacts { arc_length_m: s }),
        Failure::OffWheel { support } => unsupported(Unsupported::OffWheel { support: name(support).to_owned() }),
        Failure::Tunnelled { at } => unsupported(Unsupported::CornerPassed { at_m: at }),
        Failure::SupportInside { at } => unsupported(Unsupported::SupportInside { at_m: at }),
        Failure::LoadInContact { s } => unsupported(Unsupported::LoadOnObstacle { arc_length_m: s }),
        Failure::ContactImpossible { s, at } => {
            unsupported(Unsupported::ContactImpossible { arc_length_m: s, at_m: at })
        }
        Failure::SlackDragged { s } => unsupported(Unsupported::LooseCableDrawn { arc_length_m: s }),
        Failure::Unsound { what, s, at } => {
            unsupported(Unsupported::Unverified { finding: what, arc_length_m: s, at_m: at })
        }
    }
}

impl Mechanics for SpansModel {
    fn model(&self) -> Model {
        Model::Spans
    }

    fn reason(&self) -> Option<&ModelReason> {
        self.has_loose_cable().then_some(&ModelReason::LooseCable)
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        if self.layout.sections.is_empty() {
            return Err(unsupported(Unsupported::NothingHolds));
        }
        self.refuse_moved_posts(self.time_s)?;
        let mut instant = BoundaryConditions::default();
        self.layout.instant(&self.dragged, self.time_s, &mut instant);
        let mut workspace = std::mem::take(&mut self.workspace);
        // A loose cable has no memory.
        self.cable_equilibrium = self.cable_equilibrium.take().filter(|n| n.loose_lengths().is_none());
        let found = match &mut self.cable_equilibrium {
            Some(cable_equilibrium) => cable_equilibrium
                .advance_load(&self.layout, &instant, 1.0, &mut workspace)
                .map_err(|stopped| stopped.failure.into()),
            None => self.find_first_equilibrium(&mut instant, &mut workspace),
        };
        let (found, stable) = match &mut self.cable_equilibrium {
            Some(n) if found.is_ok() => match n.leave_unstable(&self.layout, &instant, &mut workspace) {
                Ok(left) => (found.map(|stats| stats.plus(left)), true),
                Err(_) => (found, false),
            },
            _ => (found, true),
        };
        let slides = found.is_err() && self.cable_equilibrium.is_none() && self.hangs_by_friction();
        let needed =
            if slides { CableEquilibrium::friction_needed(&self.layout, &instant, &mut workspace) } else { None };
        let loose = self.cable_equilibrium.as_ref().and_then(CableEquilibrium::loose_lengths);
        let histories = match &found {
            Ok(stats) if self.histories && loose.is_none() && self.rubs() => {
                let start = if stats.found_without_friction { SearchStart::Rubbing } else { SearchStart::Either };
                self.histories(start, &mut workspace)
            }
            _ => Histories::NotSought,
        };
        self.workspace = workspace;
        let others = if found.is_ok() && stable { self.other_equilibria() } else { None };
        if let Some(part) = needed {
            let why = NoEquilibrium::TooLittleFriction { friction_ratio: part };
            return Err(SolveError::NoRestingPlace { why });
        }
        let stats = found.map_err(|not_found| match slides && !self.rubs() {
            true => SolveError::NoRestingPlace { why: NoEquilibrium::NoFriction },
            false => self.solve_error(not_found.let_out.as_deref(), not_found.failure),
        })?;
        let mut report = self.report_of(stats);
        if !stable {
            report.warnings.push(self.warning(WarningCause::Unstable));
        }
        report.warnings.extend(self.history_warning(stats, histories));
        report.warnings.extend(others);
        if instant.hint > 0.0 {
            report.warnings.extend(slack_without_weight(&self.problem, &self.present_report().nodes));
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
        self.advance_while(dt_s, None)
    }

    fn time_s(&self) -> f64 {
        self.time_s
    }

    fn state(&self) -> State {
        State::of_nodes(&self.present_report().nodes, self.time_s)
    }

    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        if let Some(e) = state.refuse_non_finite() {
            return Err(e);
        }
        self.time_s = state.time_s;
        self.shown = self.present_report();
        self.cable_equilibrium = None;
        Ok(())
    }

    fn change_wheels(&mut self, problem: Arc<Problem>) -> bool {
        let Some(equilibrium) = &self.cable_equilibrium else { return false };
        let settings = self.layout.settings.clone();
        let Ok(layout) = counted(&problem, self.layout.counted_from, settings) else { return false };
        let Some(without) = equilibrium.without_wheels(&self.layout, &layout) else { return false };
        (self.problem, self.layout, self.cable_equilibrium) = (problem, layout, Some(without));
        true
    }

    fn warm_start(&mut self, answer: &CableSolution, time_s: f64) -> Result<(), SolveError> {
        self.refuse_moved_posts(time_s)?;
        let mut instant = BoundaryConditions::default();
        self.layout.instant(&self.dragged, time_s, &mut instant);
        let mut workspace = std::mem::take(&mut self.workspace);
        let nodes = self.layout.is_reversed().then(|| self.turned().nodes(&answer.nodes));
        let nodes = nodes.as_ref().unwrap_or(&answer.nodes);
        let adopted = CableEquilibrium::from_answer(&self.layout, &instant, nodes, &mut workspace);
        self.workspace = workspace;
        self.cable_equilibrium = Some(adopted.map_err(|t| self.plain_error(t))?);
        self.time_s = time_s;
        Ok(())
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        let n = self.dragged.len();
        let k = if self.layout.is_reversed() { n.checked_sub(support + 1) } else { Some(support) };
        if let Some(d) = k.and_then(|k| self.dragged.get_mut(k)) {
            *d = Some(target_m);
        }
    }

    fn solution(&self) -> CableSolution {
        let SpansAnswer { nodes, supports, contacts } = self.present_report();
        let name = self.problem.cable.name.clone();
        let answer = CableSolution { name, nodes, supports, contacts, ..CableSolution::default() };
        answer.rounded(&self.problem)
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    fn boxed_clone(&self) -> Box<dyn Mechanics> {
        Box::new(self.clone())
    }
}

//! `Dynamics` is a cable in contact: what its motion, its quasi-static steps and its equilibria
//! share.

use std::sync::Arc;

use crate::contact::barrier::Barrier;
use crate::error::{Place, SolveError, Unsupported};
use crate::math::{Vec2, bounded};
use crate::model::fem::mesh::sliding_node::Seat;
use crate::model::fem::newton::initial_guess::{lay, push_out, way};
use crate::model::fem::newton::minimize::Workspace;
use crate::model::fem::newton::mixed_free::FreeStep;
use crate::model::fem::state::history::{Checkpoint, Motion};
use crate::model::fem::state::moving_outline::MovingOutline;
use crate::model::fem::state::stepping::Sleep;
use crate::model::fem::state::stepping::StepSizeController;
use crate::model::fem::system::assembly::Mesh;
use crate::model::fem::system::friction_state::{ContactPair, ContactSet, SLIDE, slip_at_rest};
use crate::model::fem::system::loss::Loss;
use crate::model::fem::system::step_input::{Converged, Failure, FailureCause, Pose, StepInput, WorkBudget};
use crate::model::fem::system::step_input::{load_scale, tolerance};
use crate::model::fem::touches_nothing;
use crate::model::gauge::TensionGauge;
use crate::model::input_filter::held_warning;
use crate::model::{Inertia, Model, Settings, StepReport};
use crate::problem::{Problem, Series};
use crate::scene::SupportKind;
use crate::solution::{CableSolution, Cost, Warning, WarningCause};
use crate::state::State;

/// Longest inner time step, s. At 1/240 the tip of a falling chain of 10 m is within 5e-4 m of that
/// of rigid links (`tests/dynamics`).
pub(super) const INNER_STEP: f64 = 1.0 / 240.0;

/// Gap at which contact begins (d̂), m. Where the cable is taut a corner lifts it by this: 1e-3
/// adds 2 % to the tension of a soft cable of 12 m over two beams, 1e-4 nothing that shows.
pub const REACH: f64 = 1e-4;

/// Barrier stiffness in units of the weight of one element: 20 times smaller rebounds and costs 30
/// % more.
pub(super) const STIFFNESS: f64 = 20.0;

/// Barrier stiffness in units of the greatest tension, where that is more. With a hundredth of it
/// the gap of a node that a taut cable turns at is still a millionth of a metre; with the weight
/// alone a cable of 1e6 N came as near as 1e-9 m, and no Newton step moved it.
const TAUT_STIFFNESS: f64 = 0.05;

/// Times the barrier's stiffness for its tension that a step is tried again with: the tension may
/// grow in it.
const RETRY_STIFFENING_LIMIT: f64 = 8.0;

/// Change of the barrier's stiffness from one step to the next: up, so that it follows a snatch,
/// and down.
pub(super) const STIFFNESS_CHANGE: [f64; 2] = [2.0, 0.8];

/// Halvings of a step without inertia before the cable is let down to its rest instead. Fewer: on
/// the way down corners slip, and keep that (1 to 3 % of the tension in 4 of 200 scenes); more:
/// cables that need it take longer.
const QUIET_DEPTH: usize = 4;

/// A step is halved this often before the robot has to wait for the cable. Less: it jerks; more: it
/// costs.
const HALVINGS_BEFORE_ROBOT_WAITS: usize = 3;

/// A step is halved at most this often.
const MAX_DEPTH: usize = 10;

/// Part of a step that the first one of a motion takes, the next ones each as long as all before.
/// It has no history: implicit Euler carries a cable let go ½ a h² too far, and BDF2 makes ¾ a h²
/// of that. Larger: a free fall at 1/240 s is off by ¾ of this part's square times 1.7e-4 m;
/// smaller: one step more for each halving.
const FIRST_STEP_FRACTION: f64 = 0.125;

/// The minimiser's memory; a copy of the model makes its own.
#[derive(Debug, Default)]
pub(super) struct Memory(pub(super) Option<Box<Workspace>>);

impl Clone for Memory {
    fn clone(&self) -> Self {
        Self(None)
    }
}

/// Tension at the nodes of a mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct Gauged {
    /// Arc length of each node, m.
    pub(super) arc_length: Vec<f64>,
    /// Tension at each node, N.
    pub(super) tension: Vec<f64>,
    /// Tension of each bar, N.
    pub(super) bars: Vec<f64>,
}

/// How the cable is divided into bars, and what of the scene sits on which node.
#[derive(Clone, Debug)]
pub(super) struct Meshing {
    /// Whether corners and posts get sliding nodes.
    pub(super) slides: bool,
    /// Whether there is nothing that nodes could slide over: no obstacle and no pulley.
    pub(super) never_slides: bool,
    /// Number of bars of the even mesh.
    pub(super) even_bars: usize,
    /// What presses an even bar on flat ground, N.
    pub(super) bar_weight: f64,
    /// Node of each support; None for one that slides.
    pub(super) support_node: Vec<Option<usize>>,
    /// Node of each point load, and its force.
    pub(super) loads: Vec<(usize, Series)>,
    /// Whether the last step was found to touch nothing but its supports.
    pub(super) freely: bool,
}

/// The memory in which a step is solved; it holds nothing of the state.
#[derive(Clone, Debug)]
pub(super) struct SolverMemory {
    /// Room for the unknowns of a step.
    pub(super) pose: Pose,
    /// Room of the solver in contact.
    pub(super) memory: Memory,
    /// Room of the solver of a cable that touches nothing.
    pub(super) free: FreeStep,
    /// Room for what a step leaves of each branch of the loss.
    pub(super) decay: Vec<f64>,
    /// Room for the contacts among which corners are looked for.
    pub(super) touches: Vec<ContactPair>,
    /// The work that the search for an equilibrium may still do.
    pub(super) work_left: WorkBudget,
}

/// How hands lead supports.
#[derive(Clone, Debug)]
pub(super) struct HandDrive {
    /// Fastest hand, m/s.
    pub(super) hand_speed: f64,
    /// Stiffness of its spring, N/m, where that was asked for.
    pub(super) hand_stiffness: Option<f64>,
    /// Which of the dragged supports a hand holds by a spring.
    pub(super) pulled: Vec<bool>,
    /// Room for where hands draw supports in a part of a step.
    aims: Vec<Option<Vec2>>,
}

/// How time goes on.
#[derive(Clone, Debug)]
pub(super) struct Pacing {
    /// The length of inner steps.
    pub(super) pace: StepSizeController,
    /// Whether the cable sleeps.
    pub(super) sleep: Sleep,
    /// Part of its frequency that a vibration may be off by.
    pub(super) tolerance: f64,
    /// Until when the present advance goes, s.
    pub(super) due: f64,
}

/// What is reported of the last step.
#[derive(Clone, Debug)]
pub(super) struct StepAnswers {
    /// Force of the cable on each node that is held, N.
    pub(super) reaction: Vec<Vec2>,
    /// Supports that were stopped short of their target.
    pub(super) held_back: Vec<usize>,
    /// The answer of the last step of an advance, as it was balanced: the mesh is changed after it,
    /// for the next.
    pub(super) stepped: Option<Box<CableSolution>>,
    /// Whether the answer is kept before the mesh is changed.
    pub(super) keeps: bool,
    /// What was kept.
    pub(super) kept: Option<Box<CableSolution>>,
    /// Tension after the last step, on the mesh that it balanced.
    pub(super) gauged: Gauged,
}

/// The state to go back to where a step fails.
#[derive(Clone, Debug, Default)]
pub(super) struct Rollback {
    /// The last one that was saved, and its memory.
    pub(super) saved: Option<Box<Checkpoint>>,
    /// Whether it is of the present step.
    pub(super) can_restore: bool,
}

/// The moving cable, or the resting one where it can touch something.
#[derive(Clone, Debug)]
pub struct Dynamics {
    pub(super) problem: Arc<Problem>,
    pub(super) mesh: Mesh,
    pub(super) meshing: Meshing,
    pub(super) contacts: ContactSet,
    pub(super) motion: Motion,
    /// Loss of taut bars where the cable can touch nothing.
    pub(super) loss: Loss,
    /// The outline of the robot, if there is one.
    pub(super) rider: Option<MovingOutline>,
    pub(super) task: StepInput,
    pub(super) hand_drive: HandDrive,
    pub(super) pacing: Pacing,
    pub(super) solver: SolverMemory,
    pub(super) rollback: Rollback,
    pub(super) answers: StepAnswers,
    /// Whether it has come to rest, or moves from a state that did.
    pub(super) rested: bool,
}

impl Dynamics {
    /// Builds it at the route.
    ///
    /// # Errors
    /// None today: what it cannot do is refused when asked for.
    pub fn new(problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        let (rider, problem) = MovingOutline::of(problem);
        let way = way(&problem);
        let segments = segments(&problem, settings);
        let even = problem.length / segments as f64;
        let mut breaks = vec![0.0, problem.length];
        breaks.extend(problem.supports.iter().filter_map(|s| s.arc_length));
        breaks.extend(problem.loads.iter().map(|l| l.arc_length));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b < 1e-9 * problem.length);
        if !problem.world.is_empty() || problem.cable.self_contact {
            for (s, _) in &way {
                if breaks.iter().all(|b| (b - s).abs() > 0.3 * even) {
                    breaks.push(*s);
                }
            }
            breaks.sort_by(f64::total_cmp);
        }
        let mesh = Mesh::new(&problem, &breaks, segments, spreads_mass(&problem));
        let n = mesh.nodes();
        let support_node: Vec<Option<usize>> =
            problem.supports.iter().map(|s| s.arc_length.and_then(|a| mesh.node_at(a))).collect();
        let loads = problem.loads.iter().filter_map(|l| Some((mesh.node_at(l.arc_length)?, l.force.clone()))).collect();
        let (normal_per_m, whole) = load_scale(&problem);
        let barrier = Barrier { reach: REACH, stiffness: STIFFNESS * normal_per_m * even };
        let task = StepInput { tolerance: tolerance(&problem, whole), ..StepInput::default() };
        let mut this = Self {
            contacts: ContactSet::new(barrier, SLIDE, n),
            motion: Motion {
                x: lay(&mesh, &way),
                v: vec![Vec2::zeros(); n],
                x_before: vec![Vec2::zeros(); n],
                v_before: vec![Vec2::zeros(); n],
                x_older: vec![Vec2::zeros(); if mesh.spread.is_lumped() { 0 } else { n }],
                v_older: vec![Vec2::zeros(); if mesh.spread.is_lumped() { 0 } else { n }],
                s_before: mesh.arc_length.clone(),
                w: vec![0.0; n],
                w_before: vec![0.0; n],
                followers: vec![None; problem.supports.len()],
                hands: vec![None; problem.supports.len()],
                placement: problem.outline.as_ref().map(|o| o.placement),
                ..Motion::default()
            },
            rollback: Rollback::default(),
            meshing: Meshing {
                // A sliding node scales the forces of all that lies beyond it; what touches itself
                // has one scale.
                slides: !problem.cable.self_contact,
                never_slides: problem.world.is_empty()
                    && problem.supports.iter().all(|s| s.kind != SupportKind::Pulley),
                even_bars: segments,
                bar_weight: normal_per_m * even,
                support_node,
                loads,
                freely: false,
            },
            loss: if mesh.spread.is_lumped() { Loss::default() } else { Loss::of(&problem, even) },
            solver: SolverMemory {
                pose: Pose::default(),
                memory: Memory(None),
                free: FreeStep::default(),
                decay: Vec::new(),
                touches: Vec::with_capacity(n),
                work_left: WorkBudget::Unlimited,
            },
            pacing: Pacing {
                pace: StepSizeController::new(settings.inner_step_s.unwrap_or(INNER_STEP)),
                sleep: Sleep::default(),
                tolerance: settings.tolerance,
                due: f64::INFINITY,
            },
            hand_drive: HandDrive {
                hand_speed: settings.hand_speed_m_per_s,
                hand_stiffness: settings.hand_stiffness_n_per_m,
                pulled: vec![false; problem.supports.len()],
                aims: Vec::new(),
            },
            answers: StepAnswers {
                reaction: vec![Vec2::zeros(); n],
                held_back: Vec::new(),
                stepped: None,
                keeps: false,
                kept: None,
                gauged: Gauged::default(),
            },
            rested: false,
            rider,
            mesh,
            task,
            problem,
        };
        if this.problem.cable.self_contact {
            this.contacts.own.shape.diameter = this.problem.cable.diameter_m;
            this.contacts.own.friction = this.problem.cable.friction;
        }
        this.forget_history();
        this.prepare_task(0.0, None);
        for k in 0..n {
            if this.mesh.held[k] {
                this.motion.x[k] = this.task.target[k];
            }
        }
        this.thread_pulleys(None);
        let mut x = std::mem::take(&mut this.motion.x);
        push_out(&this.problem, &this.mesh, &mut x, 0.9 * REACH);
        this.motion.x = x;
        this.forget_history();
        Ok(this)
    }

    /// Sets the task anew after a change of the mesh, for what is read off it between steps.
    pub(super) fn renew_task(&mut self) {
        self.prepare_task(self.motion.time, None);
    }

    /// Where a pulley's centre is, m; None for other supports and pulleys that have let go.
    fn pulley_center(&self, support: usize) -> Option<Vec2> {
        self.mesh.sliding.iter().flatten().find(|s| s.seat == Seat::Pulley(support)).map(|s| s.end.center)
    }

    /// Where a support is, m.
    pub(super) fn support_position(&self, support: usize) -> Option<Vec2> {
        match self.meshing.support_node.get(support).copied().flatten() {
            Some(node) => self.motion.x.get(node).copied(),
            None => self.pulley_center(support),
        }
    }

    /// Where hands draw supports in a part of the way that is left.
    fn aim(&self, aims: &mut Vec<Option<Vec2>>, dragged: &[Option<Vec2>], part: f64) {
        aims.clear();
        aims.extend(dragged.iter().enumerate().map(|(k, target)| {
            let (target, now) = ((*target)?, self.support_position(k));
            Some(now.filter(|_| part < 1.0 - 1e-9).map_or(target, |now| now + (target - now) * part))
        }));
    }

    pub(super) fn forget_history(&mut self) {
        self.answers.stepped = None;
        let m = &mut self.motion;
        m.x_before.clone_from(&m.x);
        m.v_before.clone_from(&m.v);
        m.w_before.clone_from(&m.w);
        m.s_before.clone_from(&self.mesh.arc_length);
        m.step_before = 0.0;
        m.branch.clear();
        self.pacing.pace.forget();
        self.forget_account();
    }

    pub(super) fn refuse(&self) -> Result<(), SolveError> {
        let pulleys = self.mesh.sliding.iter().flatten().any(|s| matches!(s.seat, Seat::Pulley(_)));
        if self.problem.cable.self_contact && pulleys {
            let feature = Unsupported::SelfContactWithPulleys;
            return Err(SolveError::Unsupported { model: Model::Fem, feature });
        }
        Ok(())
    }

    /// Advances time.
    ///
    /// # Errors
    /// As `Mechanics::advance`.
    pub fn advance(&mut self, dt_s: f64, inertia: Inertia, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        self.advance_gauged(dt_s, inertia, dragged, &mut TensionGauge::off())
    }

    /// As [`Self::advance`]; every inner step with inertia passes its tension to `gauge`.
    ///
    /// # Errors
    /// As `Mechanics::advance`.
    pub fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        dragged: &[Option<Vec2>],
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        self.refuse()?;
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return Err(SolveError::TimeStep { dt_s, longest_s: f64::INFINITY });
        }
        if !self.rested {
            self.settle(dragged)?;
        }
        self.answers.held_back.clear();
        let end = self.motion.time + dt_s;
        self.pacing.due = end;
        self.begin_way(end);
        match inertia {
            Inertia::Dynamic => self.begin_account(),
            // Without inertia supports are where they are drawn to.
            Inertia::QuasiStatic => self.motion.hands.fill(None),
        }
        if inertia == Inertia::Dynamic && gauge.asks(self.motion.time) {
            self.gauge_tension();
            let at_rest = self.motion.v.iter().all(|v| *v == Vec2::zeros());
            gauge.begin(self.motion.time, at_rest, &self.answers.gauged.arc_length, |k| self.answers.gauged.tension[k]);
        }
        if inertia == Inertia::Dynamic && self.sleeps_until(end, dragged) {
            self.motion.time = end;
            gauge.stay(end);
            return Ok(self.report(Converged::default(), 0, 0.0));
        }
        if inertia == Inertia::Dynamic && self.motion.step_before == 0.0 && self.meets_nothing() {
            self.open_folds();
        }
        let pieces = match inertia {
            Inertia::Dynamic => (dt_s / self.pacing.pace.step - 1e-9).ceil().max(1.0),
            Inertia::QuasiStatic => self.pieces(end, dragged),
        };
        let h = dt_s / pieces;
        let (mut total, mut halved) = (Converged::default(), 0);
        for _ in 0..pieces as usize {
            let done = self.halving(h, end, inertia, dragged, &mut halved, gauge)?;
            total = Converged { iterations: total.iterations + done.iterations, ..done };
        }
        self.motion.time = end;
        if inertia == Inertia::Dynamic {
            self.motion.account.ends_at(end);
            self.set_pace(dt_s);
            self.watch();
        } else {
            total = self.polish(total, dragged);
            self.wake();
        }
        Ok(self.report(total, halved, h))
    }

    /// The barrier's stiffness follows the greatest tension; `change` bounds by how much, up and
    /// down; `ahead` is how many times that tension is reckoned with.
    pub(super) fn adapt_stiffness(&mut self, [up, down]: [f64; 2], ahead: f64) {
        if self.meets_nothing() {
            return;
        }
        let most = self.greatest_tension();
        let least = STIFFNESS * self.meshing.bar_weight;
        let wanted = if TAUT_STIFFNESS * most > least { TAUT_STIFFNESS * most } else { least };
        let now = self.contacts.barrier.stiffness;
        self.contacts.barrier.stiffness = bounded(wanted * ahead, now * down, now * up);
    }

    /// The same for the sliding at which friction is fully mobilised, where inertia does not count.
    pub(super) fn adapt_slip(&mut self) {
        let (weight, tension) = (load_scale(&self.problem).0 * self.problem.length, self.greatest_tension());
        self.contacts.set_slip(slip_at_rest(&self.problem, if tension > weight { tension } else { weight }));
    }

    /// Greatest tension of a bar, N.
    fn greatest_tension(&self) -> f64 {
        let tension = |e| self.mesh.bar(e).tension(self.mesh.path(e, &self.motion.x).length);
        (0..self.mesh.rest_length.len()).map(tension).fold(0.0, |most, t| if t > most { t } else { most })
    }

    /// `h` (s), or less where a support lets go on the way.
    fn until_release(&self, h: f64) -> f64 {
        let now = self.motion.time;
        let releases = self.problem.supports.iter().filter_map(|s| s.release_between(now, now + h));
        releases.fold(h, |least, r| if r - now < least { r - now } else { least })
    }

    /// One step of `h`; on failure back to its start and two of half the size, again and again.
    /// Without inertia hands draw supports evenly to where they are to be at `due` (s).
    fn halving(
        &mut self,
        h: f64,
        due: f64,
        inertia: Inertia,
        dragged: &[Option<Vec2>],
        halved: &mut usize,
        gauge: &mut TensionGauge,
    ) -> Result<Converged, SolveError> {
        let (mut left, mut size, mut depth) = (h, h, 0);
        let mut total = Converged::default();
        // What was left when a motion without history began.
        let mut began = None;
        loop {
            let begins = self.motion.step_before == 0.0 && inertia == Inertia::Dynamic && self.meets_nothing();
            if begins && depth == 0 && left > FIRST_STEP_FRACTION * h {
                (began, size) = (Some(left), FIRST_STEP_FRACTION * left);
            }
            self.save();
            let start = self.motion.time;
            let piece = match inertia {
                Inertia::Dynamic => self.until_release(size),
                Inertia::QuasiStatic => size,
            };
            let to = start + piece;
            let tried = match inertia {
                Inertia::Dynamic => self.dynamic_step(piece, dragged),
                Inertia::QuasiStatic => {
                    let mut aims = std::mem::take(&mut self.hand_drive.aims);
                    self.aim(&mut aims, dragged, piece / (due - start));
                    let tried = self.quiet_step(to, &aims).or_else(|failure| {
                        if failure.cause == FailureCause::CornerPulls || depth < QUIET_DEPTH {
                            return Err(failure);
                        }
                        self.restore();
                        self.save();
                        self.motion.time = start;
                        self.relax(to, &aims)
                    });
                    self.hand_drive.aims = aims;
                    tried
                }
            };
            let finite = self.motion.x.iter().chain(&self.motion.v).all(|p| p.iter().all(|c| c.is_finite()));
            match tried {
                Ok(done) if finite => {
                    total = Converged { iterations: total.iterations + done.iterations, ..done };
                    if inertia == Inertia::Dynamic {
                        gauge.note(to, &self.answers.gauged.arc_length, |k| self.answers.gauged.tension[k]);
                        gauge.keep();
                    }
                    left -= piece;
                    // Forces jump where a support lets go: with the history from before, BDF2 would
                    // feel them half a step late.
                    if self.problem.supports.iter().any(|s| s.holds_from(start) != s.holds_from(to)) {
                        self.motion.step_before = 0.0;
                    }
                    if left <= 1e-9 * h {
                        return Ok(total);
                    }
                    size = began.filter(|_| depth == 0).map_or(size, |b: f64| b - left).min(left);
                }
                other => {
                    let f = other.err().unwrap_or(Failure {
                        node: 0,
                        residual: f64::NAN,
                        cause: FailureCause::StateNotFinite,
                    });
                    self.restore();
                    if f.cause == FailureCause::CornerPulls && self.settle_down(f.node) {
                        self.renew_task();
                        continue;
                    }
                    // A cable that cannot get out of the way of the robot holds it.
                    if depth >= HALVINGS_BEFORE_ROBOT_WAITS && self.outline_waits() {
                        (depth, size) = (0, left);
                        continue;
                    }
                    // The barrier may be too soft for what this step does.
                    self.adapt_stiffness([2.0, 1.0], RETRY_STIFFENING_LIMIT);
                    *halved += 1;
                    depth += 1;
                    size *= 0.5;
                    if inertia == Inertia::QuasiStatic && depth == QUIET_DEPTH {
                        // Then all that is left at once.
                        size = left;
                    }
                    self.motion.step_before = 0.0;
                    if depth > MAX_DEPTH {
                        return Err(SolveError::StepFailed {
                            model: Model::Fem,
                            time_s: self.motion.time,
                            dt_s: size,
                            residual_n: f.residual,
                            place: self.place(f.node),
                            cause: f.cause,
                        });
                    }
                }
            }
        }
    }

    /// Where a node is, in the words of the scene.
    pub(super) fn place(&self, node: usize) -> Box<Place> {
        let arc_length = self.mesh.arc_length.get(node).copied().unwrap_or(f64::NAN);
        let at = self.motion.x.get(node).copied().unwrap_or(Vec2::repeat(f64::NAN));
        self.problem.place(arc_length, at, self.motion.time)
    }

    pub(super) fn report(&self, done: Converged, halved_steps: usize, inner_step_s: f64) -> StepReport {
        let cost = Cost { iterations: done.iterations, halved_steps, residual_n: done.residual, inner_step_s };
        let node_of = |k: usize| {
            let seat = Seat::Pulley(k);
            let sliding = || self.mesh.sliding.iter().position(|s| s.is_some_and(|s| s.seat == seat));
            self.meshing.support_node.get(k).copied().flatten().or_else(sliding)
        };
        let held = self.answers.held_back.iter().filter_map(|&k| {
            let (node, s) = (node_of(k)?, self.problem.supports.get(k)?);
            let behind = (self.task.target.get(node)? - self.motion.x[node]).norm();
            let cause = WarningCause::Blocked { support: s.name.clone() };
            Some(Warning::new(cause, &self.problem.cable.name, self.mesh.arc_length[node], [behind, 0.0]))
        });
        let drawn = self.motion.followers.iter().enumerate().filter_map(|(k, f)| {
            let (f, node) = (f.as_ref().filter(|f| f.behind_m() > 0.0)?, node_of(k)?);
            Some(held_warning(&self.problem, k, self.mesh.arc_length[node], f, self.hand_drive.hand_speed))
        });
        let warnings = held.chain(drawn).chain(self.hand_warnings()).collect();
        StepReport { cost, warnings }
    }

    /// Whether masses accelerate: it moves, or came here in a step with inertia.
    pub(super) fn inertia_counts(&self) -> bool {
        self.motion.step_before > 0.0 || self.motion.v.iter().any(|v| v.norm_squared() > 0.0)
    }

    /// Time reached, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.motion.time
    }

    /// Where the cable is.
    #[must_use]
    pub fn state(&self) -> State {
        State {
            time_s: self.motion.time,
            arc_length_m: self.mesh.arc_length.clone(),
            position_m: self.motion.x.clone(),
            velocity_m_per_s: self.motion.v.clone(),
            in_motion: false,
        }
    }

    /// The answer at this instant.
    #[must_use]
    pub fn solution(&self) -> CableSolution {
        self.answers.stepped.as_ref().map_or_else(|| self.solution_now(), |s| CableSolution::clone(s))
    }

    /// Keeps the answer of a step before the first change of its mesh.
    pub(super) fn keep_answer(&mut self) {
        if self.answers.keeps && self.answers.kept.is_none() {
            self.answers.kept = Some(Box::new(self.solution_now()));
        }
    }

    /// Smallest gap of any free node or segment, m (infinite if nothing is near).
    #[cfg(test)]
    pub(super) fn smallest_gap(&self) -> f64 {
        let mut touches = Vec::new();
        self.contacts.find(&self.problem, &self.mesh, &self.motion.x, &mut touches);
        touches.iter().map(|t| t.pair.gap.gap_m).fold(f64::INFINITY, |a, b| if b < a { b } else { a })
    }
}

/// Whether the mass is spread over the bars. Where the cable can touch something it is lumped all
/// the time: contacts take momentum of one node, nodes come and go with corners and pulleys, and a
/// mass that changed as contact begins would change the energy.
fn spreads_mass(problem: &Problem) -> bool {
    touches_nothing(problem) && problem.supports.iter().all(|s| s.kind != SupportKind::Pulley)
}

/// Elements of a cable where neither the scene nor the settings say: finer where it can touch
/// something.
fn segments(problem: &Problem, settings: Settings) -> usize {
    let element = if problem.world.is_empty() { 0.2 } else { 0.12 };
    let automatic = (problem.length / element).ceil().clamp(60.0, 200.0) as usize;
    settings.segments.or(problem.cable.segments).unwrap_or(automatic).max(2)
}

//! This module finds equilibria in contact, and takes quasi-static steps.

use crate::error::{NoEquilibrium, SolveError, Unsupported};
use crate::math::{Vec2, bounded, larger};
use crate::model::fem::dynamics::{Dynamics, REACH};
use crate::model::fem::newton::initial_guess::push_out;
use crate::model::fem::newton::minimize::DRIFT;
use crate::model::fem::results;
use crate::model::fem::state::moving_outline::MovingOutline;
use crate::model::fem::system::friction_state::SLIDE;
use crate::model::fem::system::step_input::{Converged, Failure, FailureCause, Pose, StepInput};
use crate::model::fem::system::step_input::{load_scale, tolerance};
use crate::model::fem::time::bdf2::ROUNDS_EACH;
use crate::model::fem::time::step_setup::StickSlipChanges;
use crate::model::{Inertia, Model, StepReport};
use crate::state::State;

/// Work budget of one search for an equilibrium: iterations times nodes. Smaller: scenes that
/// converge slowly are refused; larger: a search that fails reports it after minutes. The value is
/// 20 000 iterations of 200 nodes, and takes some 10 s.
pub(in crate::model::fem) const REST_WORK: usize = 4_000_000;

/// Newton iterations of a step without inertia.
const REST_ITERATIONS: usize = 150;

/// Rounds of refreshing the normal forces that friction uses, in a step without inertia.
const LAG_ROUNDS: usize = 25;

/// Rounds after which normal forces are taken halfway to the new ones only: where a contact that
/// rubs more lifts its neighbour, which then rubs less, they go round and round. Fewer: what
/// converges by itself takes longer; more: fewer rounds are left to halve what is off.
const PLAIN_ROUNDS: usize = 8;

/// Least part of the way that friction is taken towards its new normal forces, and by what that
/// part changes from round to round.
const LEAST_PART: f64 = 0.03;
const RESISTANCE_GROWTH: f64 = 1.1;
const RESISTANCE_SHRINKAGE: f64 = 0.6;

/// The same in a step of relaxation.
const RELAX_LAG_ROUNDS: usize = 8;

/// Steps of relaxation before it is given up.
const MAX_RELAX: usize = 600;

/// Whole load, in weights of the cable, from which dead loads set the first resistance. Less: a way
/// down with a little load is slower than it need be; more: loads of that many weights throw the
/// cable about.
const DEAD_LOAD_RATIO: f64 = 2.0;

/// Unbalanced force, in tolerances, that is accepted at rest where contact forces are known no
/// better: 1e-3 of the whole load. More: a node a rounding away from a corner makes any force a
/// rest (6e10 N were taken for one); less: cables that a support squeezes find none.
const RESIDUAL_LIMIT_TOLERANCES: f64 = 1e3;

/// Part of all loads on a cable that may be held by nothing. Larger: what slides slowly is said to
/// rest. Smaller: what rests is refused for what its nodes are let off with. Of slopes, posts,
/// beams and drapes at random those that held left up to 4e-5, those with 0.3 % too little friction
/// 3e-4 and more.
const UNHELD_LOAD_FRACTION: f64 = 1e-4;
/// Unbalanced force of a polished rest, in tolerances, and the iterations that each part of the way
/// to it may take. Less force left: nothing but rounding is gained; more: what is left at a hundred
/// nodes of a lay that all but slides is seen in the balance of the whole. The first has what the
/// search left by coming to its last iteration; fewer for it: what slides as a whole on smooth
/// ground is left as it slides.
const POLISH_STAGES: [(f64, usize); 3] = [(1.0, 600), (0.1, 30), (1e-2, 30)];

/// Times a resting place is sought again because corners were met or left on the way to it.
const CORNER_ROUNDS: usize = 8;

/// Turn (rad) the wrong way round a corner from which a step without inertia is taken again without
/// that corner. Larger: other corners slip by what it pulls (at 0.02 and 50 N by 2 %), and keep
/// that. Smaller: more steps are taken twice.
const LEAST_PULL: f64 = 1e-4;

/// What was found with refreshed normal forces, grips and factors.
#[derive(Clone, Copy, Debug)]
struct Lagged {
    done: Converged,
    grips: StickSlipChanges,
    /// By how much the friction of a contact changed in the last round, N.
    off: f64,
}

impl Lagged {
    /// Whether friction is what the normal forces allow, at sliding nodes and elsewhere.
    fn is_lawful(&self, task: &StepInput) -> bool {
        self.grips.hold() && self.off <= DRIFT * task.tolerance
    }
}

impl Dynamics {
    /// A step without inertia to the time `to`; friction remembers.
    pub(in crate::model::fem) fn rest_step(&mut self, to: f64, dragged: &[Option<Vec2>]) -> Result<Converged, Failure> {
        self.rest_rounds(to, dragged, f64::INFINITY)
    }

    /// The same of a cable whose friction counts.
    ///
    /// # Errors
    /// `CornerPulls` where a corner would have to pull, before anything is accepted: what slides
    /// meanwhile would keep what that did.
    pub(in crate::model::fem) fn quiet_step(
        &mut self,
        to: f64,
        dragged: &[Option<Vec2>],
    ) -> Result<Converged, Failure> {
        self.rest_rounds(to, dragged, LEAST_PULL)
    }

    fn rest_rounds(&mut self, to: f64, dragged: &[Option<Vec2>], pull: f64) -> Result<Converged, Failure> {
        let (mut total, mut settled) = (Converged::default(), false);
        for round in 0..CORNER_ROUNDS {
            self.prepare_way([to, to], Some(dragged));
            self.adapt_slip();
            self.adapt_stiffness([f64::INFINITY, 0.0], 1.0);
            self.task.max_iterations = REST_ITERATIONS;
            self.task.most_noise = RESIDUAL_LIMIT_TOLERANCES * self.task.tolerance;
            let mut pose = self.still_pose();
            let mut done = self.lag_wholly(&mut pose);
            if done.is_err_and(|f| f.cause != FailureCause::WorkSpent) && self.contacts.slip < SLIDE {
                // Where grips change all along the cable, as on a first lay, ground that gives way
                // is easier to come to rest on.
                self.contacts.set_slip(SLIDE);
                pose = self.still_pose();
                done = self.lag_wholly(&mut pose);
            }
            if round == 0
                && pull.is_finite()
                && let Some(node) = self.pulled_by(&pose.x, pull)
            {
                let residual = done.map_or_else(|f| f.residual, |d| d.residual);
                return Err(Failure { node, residual, cause: FailureCause::CornerPulls });
            }
            let done = done?;
            total = Converged { iterations: total.iterations + done.iterations, ..done };
            self.accept_pose(&pose, to);
            // Where corners are met and left by turns to the last, the mesh stays as it balances.
            if settled || round + 1 == CORNER_ROUNDS {
                break;
            }
            let found = self.remesh(Inertia::QuasiStatic);
            // Marks that are moved take strain from bar to bar, which has to be balanced once more.
            settled = !found.bars;
            if settled && !found.marks {
                break;
            }
        }
        Ok(total)
    }

    /// Reduces the residual of an equilibrium, which adds up along the cable, to the level of
    /// round-off. It starts from the present shape, and changes nothing where it does not converge.
    pub(in crate::model::fem) fn polish(&mut self, found: Converged, dragged: &[Option<Vec2>]) -> Converged {
        let kept = (self.rollback.saved.clone(), self.rollback.can_restore);
        let (exact, to) = (self.task.tolerance, self.motion.time);
        let mut all = found;
        for (part, iterations) in POLISH_STAGES {
            self.save();
            self.prepare_way([to, to], Some(dragged));
            self.task.most_noise = exact;
            (self.task.tolerance, self.task.max_iterations) = (part * exact, iterations);
            let mut pose = self.still_pose();
            let Ok(done) = self.lag(&mut pose, LAG_ROUNDS) else {
                self.restore();
                break;
            };
            all = Converged { iterations: all.iterations + done.iterations, ..done };
            // With the bars it balances on: new ones would have to be brought to rest again.
            self.accept_pose(&pose, to);
        }
        self.task.tolerance = exact;
        (self.rollback.saved, self.rollback.can_restore) = kept;
        all
    }

    /// Brings straight bars to rest that were laid on the sagging ones of statics: a step of the
    /// second order in their length, without which a run would begin with a jerk. Where they find
    /// no rest they stay as they were laid.
    pub(in crate::model::fem) fn come_to_rest(&mut self, dragged: &[Option<Vec2>]) {
        if !self.rested {
            return;
        }
        self.save();
        let reach = self.problem.length / self.meshing.even_bars as f64;
        let laid = self.motion.x.clone();
        let found = self.rest_step(self.motion.time, dragged).is_ok();
        let near = |(a, b): (&Vec2, &Vec2)| (a - b).norm() <= reach;
        if !(found && laid.len() == self.motion.x.len() && laid.iter().zip(&self.motion.x).all(near)) {
            self.restore();
        }
    }

    /// Minimises again and again with refreshed normal forces, grips and factors until nothing
    /// changes.
    fn lag(&mut self, pose: &mut Pose, rounds: usize) -> Result<Converged, Failure> {
        self.lag_until(pose, rounds).map(|found| found.done)
    }

    /// The same; says what was found.
    fn lag_until(&mut self, pose: &mut Pose, rounds: usize) -> Result<Lagged, Failure> {
        let (mut total, mut grips) = (Converged::default(), StickSlipChanges::FOUND);
        let (mut fewest, mut spare) = (usize::MAX, PLAIN_ROUNDS);
        let (mut off, mut part) = (0.0, 1.0);
        let mut before = Vec::with_capacity(self.contacts.rubs.capacity());
        for round in 0..rounds {
            self.contacts.look_around(&self.problem, &self.mesh, &pose.x, |_| 0.0);
            std::mem::swap(&mut before, &mut self.contacts.rubs);
            self.contacts.prepare(&self.problem, &self.mesh, &pose.x, &self.motion.x);
            if round > 0 {
                let now = self.contacts.ease(&before, part);
                // What goes to and fro gets no nearer by taking as much of the way.
                if round >= PLAIN_ROUNDS {
                    part = if now < (1.0 - 0.5 * part) * off {
                        bounded(RESISTANCE_GROWTH * part, 0.0, 1.0)
                    } else {
                        larger(RESISTANCE_SHRINKAGE * part, LEAST_PART)
                    };
                }
                off = now;
            }
            self.task.shift = self.soft_shift();
            let done = self.minimise(pose)?;
            total = Converged { iterations: total.iterations + done.iterations, ..done };
            grips = self.update_grips(pose, spare == 0);
            if grips.wrong < fewest {
                (fewest, spare) = (grips.wrong, PLAIN_ROUNDS);
            } else {
                spare = spare.saturating_sub(1);
            }
            // A round that needed no iteration found the normal forces it had used.
            let found = done.iterations == 0 && off <= self.task.tolerance;
            if (found || self.contacts.rubs.is_empty()) && grips.wrong == 0 && grips.same {
                return Ok(Lagged { done: total, grips, off: 0.0 });
            }
        }
        Ok(Lagged { done: total, grips, off })
    }

    /// The same, until the law holds at every sliding node.
    fn lag_wholly(&mut self, pose: &mut Pose) -> Result<Converged, Failure> {
        let sliding = self.mesh.sliding.iter().flatten().count();
        let found = self.lag_until(pose, LAG_ROUNDS + ROUNDS_EACH * sliding)?;
        if found.is_lawful(&self.task) {
            return Ok(found.done);
        }
        let node = self.mesh.sliding.iter().position(Option::is_some).unwrap_or(0);
        Err(Failure { node, residual: found.done.residual, cause: FailureCause::StickSlipUndecided })
    }

    /// Takes a pose as the state at rest at the time `to`; returns whether what the cable runs over
    /// changed.
    fn accept_rest(&mut self, pose: &Pose, to: f64) -> bool {
        self.accept_pose(pose, to);
        self.remesh(Inertia::QuasiStatic).seats
    }

    /// The same, corners as they are.
    fn accept_pose(&mut self, pose: &Pose, to: f64) {
        self.contacts.commit(&self.problem, &self.mesh, &pose.x, &self.motion.x, &pose.slide);
        self.contacts.carriage = None;
        self.motion.x.clone_from(&pose.x);
        self.motion.v.fill(Vec2::zeros());
        self.motion.w.fill(0.0);
        self.motion.time = to;
        self.slide(&pose.slide);
        self.mesh.sliding.iter_mut().flatten().for_each(|s| s.balanced = None);
        self.forget_history();
    }

    /// Weight of an element over a tenth of a metre: enough to keep slack nodes from wandering.
    fn soft_shift(&self) -> f64 {
        self.meshing.bar_weight / 0.1
    }

    /// The resistance that a way down begins with, N/m: what acts on an element over a tenth of a
    /// metre, dead loads with it where they are what counts. With the weight alone a cable of 5 g/m
    /// under 100 N, laid through a post, was thrown about and found no rest.
    fn first_resistance(&self) -> f64 {
        let whole = load_scale(&self.problem).1 / self.meshing.even_bars as f64;
        if whole > DEAD_LOAD_RATIO * self.meshing.bar_weight { whole / 0.1 } else { self.soft_shift() }
    }

    /// Follows the way down with ever weaker viscous resistance, then finds the resting place
    /// itself. On the way what rounding hides may be any force: a cable laid in touch begins there.
    /// Where that ends in no rest, it may not.
    pub(in crate::model::fem) fn relax(&mut self, to: f64, dragged: &[Option<Vec2>]) -> Result<Converged, Failure> {
        let kept = (self.rollback.saved.clone(), self.rollback.can_restore);
        self.save();
        let mut found = self.relax_within(f64::INFINITY, to, dragged);
        if found.is_err_and(|f| {
            f.cause != FailureCause::WorkSpent && f.residual > RESIDUAL_LIMIT_TOLERANCES * self.task.tolerance
        }) {
            self.restore();
            found = self.relax_within(RESIDUAL_LIMIT_TOLERANCES, to, dragged);
        }
        (self.rollback.saved, self.rollback.can_restore) = kept;
        found
    }

    /// The same; `noise` is the greatest force, in tolerances, that rounding may hide on the way.
    fn relax_within(&mut self, noise: f64, to: f64, dragged: &[Option<Vec2>]) -> Result<Converged, Failure> {
        // What the outline moves into goes out of its way before anything slides.
        self.prepare_way([to, to], Some(dragged));
        self.motion.x.clone_from_slice(self.task.begins());
        self.contacts.carriage = None;
        let laid = self.motion.x.clone();
        let mut resistance = self.first_resistance();
        let (full, floor) = (resistance, 1e-5 * resistance);
        // Set where Newton without resistance has failed: then steps are solved exactly, until what
        // resists is nothing.
        let mut stubborn = false;
        let mut total = 0;
        let mut last = Failure { node: 0, residual: f64::NAN, cause: FailureCause::StillMoves };
        for round in 0..MAX_RELAX {
            self.prepare_task(to, Some(dragged));
            self.adapt_slip();
            let even = self.problem.length / self.meshing.even_bars as f64;
            self.task.inertia.fill(resistance);
            for k in 0..self.mesh.nodes() {
                self.task.inertia[k] *= self.mesh.share(k) / even;
            }
            let exact = self.task.tolerance;
            self.task.tolerance = if stubborn { exact } else { 1e2 * exact };
            self.task.most_noise = noise * exact;
            // A first lay carries no normal force yet: without refreshing, it would slide as if on
            // ice.
            let mut pose = self.still_pose();
            let done = self.lag_until(&mut pose, RELAX_LAG_ROUNDS);
            self.task.tolerance = exact;
            match done {
                Ok(found) => {
                    let done = found.done;
                    total += done.iterations;
                    let (mut moved, mut resists, mut slowest): (f64, f64, usize) = (0.0, 0.0, 0);
                    // What resists adds up along what creeps.
                    let mut drift = Vec2::zeros();
                    for (k, (a, b)) in pose.x.iter().zip(&self.motion.x).enumerate() {
                        let way = (a - b).norm().max(pose.slide[k].abs());
                        moved = moved.max(way);
                        let free = if self.mesh.held[k] { 0.0 } else { self.task.inertia[k] };
                        drift = if free > 0.0 { drift + (a - b) * free } else { Vec2::zeros() };
                        let force = larger(way * free, drift.norm() / DRIFT);
                        if force > resists {
                            (resists, slowest) = (force, k);
                        }
                    }
                    last =
                        Failure { node: slowest, residual: done.residual + resists, cause: FailureCause::StillMoves };
                    let remeshed = self.accept_rest(&pose, self.motion.time);
                    if self.ran_away(&laid).is_some() {
                        return Err(Failure { node: 0, residual: f64::NAN, cause: FailureCause::SlidesAway });
                    }
                    if remeshed {
                        moved = moved.max(0.1);
                    } else if stubborn
                        && found.is_lawful(&self.task)
                        && resists <= exact
                        && done.residual <= RESIDUAL_LIMIT_TOLERANCES * exact
                    {
                        self.motion.time = to;
                        return Ok(Converged { iterations: total, residual: done.residual + resists });
                    }
                    resistance *= if moved < 0.3 { 0.6 } else { 1.0 };
                    if resistance < floor || (moved < 1e-4 && round % 8 == 7) || moved < 1e-7 {
                        match self.rest_step(to, dragged) {
                            Ok(done) => return Ok(Converged { iterations: total + done.iterations, ..done }),
                            Err(failure) if failure.cause == FailureCause::WorkSpent => return Err(failure),
                            Err(failure) => {
                                last = failure;
                                stubborn = true;
                                resistance = (resistance.max(floor) * 30.0).min(full);
                            }
                        }
                    }
                }
                Err(failure) if failure.cause == FailureCause::WorkSpent => return Err(failure),
                Err(failure) => {
                    last = failure;
                    resistance *= 8.0;
                    if resistance > 1e9 * full {
                        return Err(failure);
                    }
                }
            }
        }
        Err(last)
    }

    /// Finds the resting place with contact at the present time; `dragged` are the hand-set support
    /// positions, m.
    ///
    /// # Errors
    /// A typed reason when there is none, or none was found.
    pub fn settle(&mut self, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        self.refuse()?;
        self.wake();
        self.answers.held_back.clear();
        self.save();
        self.motion.followers.fill(None);
        self.motion.hands.fill(None);
        if !self.rested && self.put_outline() {
            let mut x = std::mem::take(&mut self.motion.x);
            push_out(&self.problem, &self.mesh, &mut x, 0.9 * REACH);
            self.motion.x = x;
            self.forget_history();
        }
        match self.find_rest(dragged)? {
            Ok(done) => {
                self.rested = true;
                let done = self.polish(done, dragged);
                Ok(self.report(done, 0, 0.0))
            }
            Err(f) => {
                let at_m = self.motion.x.get(f.node).copied().unwrap_or_default();
                let sought = self.motion.x.clone();
                self.restore();
                if self.ran_away(&sought).is_some() {
                    return Err(SolveError::NoRestingPlace { why: NoEquilibrium::SlidesOff });
                }
                if f.cause == FailureCause::WorkSpent {
                    let (model, segments) = (Model::Fem, self.mesh.rest_length.len());
                    let iterations = REST_WORK / self.mesh.nodes().max(1);
                    let (residual_n, place) = (f.residual, self.place(f.node));
                    return Err(SolveError::TooMuchWork { model, iterations, segments, residual_n, place });
                }
                if let Some(why) = self.through(&sought) {
                    return Err(SolveError::NoRestingPlace { why });
                }
                let arc_length = self.mesh.arc_length.get(f.node).copied().unwrap_or(f64::NAN);
                let place = self.problem.place(arc_length, at_m, self.motion.time);
                Err(SolveError::NotConverged {
                    model: Model::Fem,
                    iterations: MAX_RELAX,
                    residual_n: f.residual,
                    place,
                })
            }
        }
    }

    /// Begins at `shape`, a rest without contact, if the cable gets there from its lay without
    /// coming near to anything. The way down with contact takes as many rounds as a cable that
    /// hangs has bars.
    pub(in crate::model::fem) fn begin_at(&mut self, shape: &State, dragged: &[Option<Vec2>]) {
        let touched = self.problem.floor_friction.is_some() || self.contacts.own.shape.is_on();
        let alone = self.rider.is_none() && !touched && !self.problem.world.is_empty();
        if self.rested || !alone || self.mesh.sliding.iter().any(Option::is_some) {
            return;
        }
        let Some(to) = self.mesh.arc_length.iter().map(|&s| shape.position_at(s)).collect::<Option<Vec<Vec2>>>() else {
            return;
        };
        let (x, geometry) = (&self.motion.x, self.problem.world.geometry());
        let clear = (0..self.mesh.rest_length.len()).all(|e| {
            let [[a, b], [c, d]] = [self.mesh.straight(e, x), self.mesh.straight(e, &to)];
            geometry.parts(a.inf(&b).inf(&c.inf(&d)), a.sup(&b).sup(&c.sup(&d)), REACH).next().is_none()
        });
        if !clear {
            return;
        }
        self.motion.x = to;
        self.forget_history();
        // Its bars are straight: what sags between its nodes makes their tension wrong, evenly, so
        // that little force is left over.
        self.prepare_task(self.motion.time, Some(dragged));
        self.task.max_iterations = REST_ITERATIONS;
        let exact = self.task.tolerance;
        self.task.tolerance = tolerance(&self.problem, 0.0);
        let mut pose = self.still_pose();
        if self.solver.free.solve(&self.mesh, &self.task, &mut pose).is_some() {
            self.motion.x.clone_from(&pose.x);
            self.forget_history();
        }
        self.solver.pose = pose;
        self.task.tolerance = exact;
    }

    /// The resting place; one that the cable reaches without ever touching itself is found as if it
    /// could pass itself, for its first lay is no shape it could have.
    fn find_rest(&mut self, dragged: &[Option<Vec2>]) -> Result<Result<Converged, Failure>, SolveError> {
        let time = self.motion.time;
        let shape = self.contacts.own.shape;
        if !shape.is_on() {
            return Ok(self.relax(time, dragged));
        }
        if !self.rested {
            self.contacts.own.shape.diameter = 0.0;
            let found = self.relax(time, dragged);
            self.contacts.own.shape = shape;
            if found.is_ok() && !self.touches_itself() && !self.crosses_itself() {
                return Ok(found);
            }
            self.restore();
            self.save();
        }
        let overlap = self.contacts.own.smallest_gap(&self.mesh, &self.motion.x, 0.0);
        if overlap.is_some() || self.crosses_itself() {
            let arc_length_m = self.mesh.arc_length[overlap.map_or(0, |o| o.1)];
            let feature = Unsupported::SelfContactAtStart { arc_length_m };
            return Err(SolveError::Unsupported { model: Model::Fem, feature });
        }
        Ok(self.relax(time, dragged))
    }

    /// Why a cable that nothing but friction holds does not rest where it was brought: what each
    /// node alone is let off with adds up.
    pub(in crate::model::fem) fn slides_as_a_whole(&self) -> Option<NoEquilibrium> {
        if self.problem.supports.iter().any(|s| s.at.is_some()) || self.contacts.own.shape.is_on() {
            return None;
        }
        let left = results::unbalanced(self, &self.motion.x, self.motion.time).norm();
        let scale = load_scale(&self.problem).1;
        (left > UNHELD_LOAD_FRACTION * scale).then_some(NoEquilibrium::UnheldForce { left_n: left, loads_n: scale })
    }

    /// How far (m) both ends have moved to `sought` at least, if that is further than the cable is
    /// long.
    fn ran_away(&self, sought: &[Vec2]) -> Option<f64> {
        let moved = |a: Option<&Vec2>, b: Option<&Vec2>| Some((a? - b?).norm());
        let now = &self.motion.x;
        let way = moved(sought.first(), now.first())?.min(moved(sought.last(), now.last())?);
        (way > self.problem.length).then_some(way)
    }

    /// What a cable that found no rest at `x` runs through: out of there it cannot get.
    fn through(&self, x: &[Vec2]) -> Option<NoEquilibrium> {
        let (mesh, world) = (&self.mesh, &self.problem.world);
        if x.len() != mesh.nodes() {
            return None;
        }
        // Its centre line is in the thing itself, or nearly: what only touches is not through.
        let least = -0.9 * self.problem.radius;
        let clear = |e: usize| world.geometry().is_clear(mesh.straight(e, x), least, mesh.rounds(e));
        let e = (0..mesh.rest_length.len()).filter(|&e| mesh.is_free(e) || mesh.is_free(e + 1)).find(|&e| !clear(e))?;
        let [a, b] = mesh.straight(e, x);
        let gap = world.signed_gap((a + b) * 0.5, f64::INFINITY)?;
        let obstacle = world.obstacle_name(gap.obstacle).to_owned();
        Some(NoEquilibrium::ThroughObstacle { obstacle, at_m: gap.point, arc_length_m: mesh.arc_length[e] })
    }

    /// Whether the cable is in touch with itself.
    pub(in crate::model::fem) fn touches_itself(&self) -> bool {
        self.contacts.own.smallest_gap(&self.mesh, &self.motion.x, REACH).is_some()
    }

    /// Whether two bars of the cable cross.
    fn crosses_itself(&self) -> bool {
        !crate::contact::self_crossings::crossings(&self.motion.x, |_| true).is_empty()
    }

    /// Steps without inertia that keep every support's move below half an element.
    pub(in crate::model::fem) fn pieces(&self, end: f64, dragged: &[Option<Vec2>]) -> f64 {
        let even = self.problem.length / self.meshing.even_bars as f64;
        let mut most: f64 = 0.0;
        for (k, s) in self.problem.supports.iter().enumerate() {
            if let (Some((at, _)), Some(now)) = (s.position_at(end), self.support_position(k)) {
                let at = dragged.get(k).copied().flatten().unwrap_or(at);
                most = most.max((at - now).norm());
            }
        }
        let carried = self.rider.as_ref().map_or(0.0, MovingOutline::pieces);
        larger(most / (0.5 * even), carried).ceil().clamp(1.0, 1e4)
    }
}

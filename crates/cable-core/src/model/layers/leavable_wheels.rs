//! This layer lets a cable leave its wheels: if a model finds that the cable does not press on a
//! wheel, that wheel is replaced by a post ([`CableWheels`]), or taken away if it moves, until the
//! cable comes back to it. Posts, which move with their wheels, also stand in for wheels over which
//! a stiff cable bends and those of a cable that meets itself.
//!
//! A post acts on the cable like a wheel with the same friction, as long as it presses on it; its
//! force is reported as the reaction of the pulley. The other wheels stay, because a cable can
//! slide far over a wheel, but has to be followed in small steps over a post. The same model goes
//! on if it can, with its history: its wheel lets go. Else a model without the wheel takes over its
//! state, or its answer with the friction.

use std::any::Any;
use std::sync::Arc;

use super::Layer;
use crate::contact::distance::{nearest_fraction, segment_segment};
use crate::error::{NoEquilibrium, SolveError, Unsupported};
use crate::math::{RigidPose, Vec2, cross, larger};
use crate::model::mechanics::Constructor;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{Inertia, Mechanics, Model, Settings, StepReport};
use crate::problem::wheel_passage::{facing, turn_through_centre};
use crate::problem::wheels_as_posts::{StandIn, WheelLeft};
use crate::problem::{CableWheels, Problem, SupportPoint, WheelsLeft};
use crate::solution::{CableSolution, ModelReason, MomentumAccount, Node, SupportReaction, Warning, WarningCause};
use crate::state::State;

/// Depth to which a cable may lie within a wheel that it left, in radii: beyond it the cable has
/// come back. Smaller: a cable that leaves is taken back, because it still lies on the wheel to
/// round-off; larger: it comes back late, and jumps on it. A choice, tuned on no campaign.
const RETURN_DEPTH: f64 = 1e-3;

/// Greatest gap at which a cable may lie on a post, m: twice the reach of the barrier. Smaller: a
/// cable that lies on a small post counts as clear of the wheel; larger: one that is clear of it is
/// laid on it. A choice, tuned on no campaign.
const POST_GAP_M: f64 = 2e-4;

/// Multiple of that depth up to which a moving cable may have come back when it is laid on the
/// wheel. Smaller: the instant of the return is harder to find; larger: the cable jumps on the
/// wheel. A choice, tuned on no campaign.
const DEEPEST_RETURN_FACTOR: f64 = 2.0;

/// Trials for the instant at which a moving cable comes back to a wheel: each halves what is left
/// of the step at least every other time.
const MAX_RETURN_TRIALS: usize = 40;

/// Change of the greatest tension up to which a stiff cable on posts rests as it did on wheels, of
/// that tension. Smaller: coarse meshes, on which a contact in one point changes the tension by 8
/// %, neglect the whole bend instead; larger: a rest that was not found again is used. A choice,
/// tuned on no campaign.
const SAME_REST_TENSION_FRACTION: f64 = 0.25;

/// Number of times that a cable may come back to wheels in one step. More: cables that tremble on a
/// wheel take long; fewer: they are laid on it late. A choice, tuned on no campaign.
const MAX_RETURNS: usize = 8;

/// Fraction of a step that is lost in the rounding of its times.
const SAME_TIME_FRACTION: f64 = 1e-9;

/// Turn away from a wheel up to which a cable can be laid on it, rad: as long a path then differs
/// by 1e-4 radii. Larger: the tip of a fold is laid on a wheel as if it ran round it; smaller: a
/// cable that comes to a wheel where it is bent is refused. A choice, tuned on no campaign.
const MOST_TURN_AWAY: f64 = 0.1;

/// A wheel with nothing in its place, and the part of the cable nearest to it.
#[derive(Clone, Copy, Debug)]
struct WheelNearby {
    support: usize,
    /// Depth to which the cable lies within it, in radii; negative if it is clear.
    depth: f64,
    /// True if the cable can be laid on it there: it runs past on the side on which it is led, and
    /// does not turn away from the wheel.
    can_bear: bool,
}

/// A model of a cable over wheels, and of the same without those that it leaves.
pub struct LeavableWheels {
    problem: Arc<Problem>,
    wheels: Arc<CableWheels>,
    settings: Settings,
    construct: Arc<Constructor>,
    inner: Box<dyn Mechanics>,
    /// The wheels that the cable has left; None if it has left none.
    left: Option<Arc<WheelsLeft>>,
    /// True if those wheels are supports of the inner model which have let go; else it is one of
    /// the problem without them.
    let_go: bool,
    /// For each support, true if it is a wheel that moves and in whose place a post moves: one on
    /// which the cable bends by its own stiffness, or of a cable that meets itself.
    as_moving_post: Vec<bool>,
    /// Places to which supports were moved, m, and by what.
    support_moves: Vec<Option<SupportMove>>,
    /// Present places of wheels that were led while the cable was clear of them, m.
    places: Vec<Option<Vec2>>,
    robot_pose: Option<RigidPose>,
    /// True if the cable was brought to rest and has not moved since.
    rests: bool,
    /// The account of momentum of the parts of the present step before the last one.
    account: Option<MomentumAccount>,
}

/// A place to which a support was moved, m.
#[derive(Clone, Copy, Debug)]
enum SupportMove {
    /// The support is there.
    Dragged(Vec2),
    /// A hand holds it there by a spring.
    Pulled(Vec2),
}

impl SupportMove {
    fn place(self) -> Vec2 {
        match self {
            Self::Dragged(at) | Self::Pulled(at) => at,
        }
    }
}

/// The memory of a cable that had left some of its wheels, from which it goes on after an edit.
struct ContinuationWithoutWheels {
    /// For each support, true if it is such a wheel.
    replaced: Vec<bool>,
    /// As in [`LeavableWheels`].
    let_go: bool,
    /// For each support, true if a post was in its place.
    posts: Vec<bool>,
    /// Present places of those wheels, m.
    centers: Vec<Option<Vec2>>,
    time_s: f64,
    inner: Box<dyn Any + Send>,
}

/// The way in which a model continues.
enum Start<'a> {
    /// Along the route.
    Route,
    /// From a state of motion.
    Motion(&'a State),
    /// From an answer without motion, with its friction, at a time (s).
    Rest(&'a CableSolution, f64),
}

impl<'a> Start<'a> {
    /// From the present state of a model, or its answer without motion.
    fn of(inertia: Inertia, state: &'a State, answer: &'a CableSolution) -> Self {
        match inertia {
            Inertia::Dynamic => Self::Motion(state),
            Inertia::QuasiStatic => Self::Rest(answer, state.time_s),
        }
    }
}

/// Distance of a point from a bar, m.
fn distance(point: Vec2, from: Vec2, to: Vec2) -> f64 {
    (from + (to - from) * nearest_fraction(point, from, to) - point).norm()
}

/// The names of the wheels that the cable leaves, by an error.
fn wheels_left_by(error: &SolveError) -> Vec<&str> {
    match error {
        SolveError::NoRestingPlace { why: NoEquilibrium::LeavesWheel { pulley } } => vec![pulley],
        SolveError::Unsupported { feature: Unsupported::OffWheel { support }, .. } => vec![support],
        SolveError::Neither { clearer, other } => [wheels_left_by(clearer), wheels_left_by(other)].concat(),
        _ => Vec::new(),
    }
}

/// True if an error says that the cable is an obstacle to itself and runs over pulleys.
fn asks_for_posts(error: &SolveError) -> bool {
    match error {
        SolveError::Unsupported { feature, .. } => *feature == Unsupported::SelfContactWithPulleys,
        SolveError::Neither { clearer, other } => asks_for_posts(clearer) || asks_for_posts(other),
        _ => false,
    }
}

impl LeavableWheels {
    /// Wraps a model of the cable; `construct` builds those without some of its wheels.
    pub fn new(
        problem: Arc<Problem>,
        wheels: Arc<CableWheels>,
        settings: Settings,
        construct: Arc<Constructor>,
        inner: Box<dyn Mechanics>,
    ) -> Self {
        let n = problem.supports.len();
        let (support_moves, places) = (vec![None; n], vec![None; n]);
        Self {
            problem,
            wheels,
            settings,
            construct,
            inner,
            left: None,
            let_go: false,
            as_moving_post: vec![false; n],
            support_moves,
            places,
            robot_pose: None,
            rests: false,
            account: None,
        }
    }

    /// Index that a support has in the inner model; None for a wheel that was left.
    fn inner_index(&self, support: usize) -> Option<usize> {
        let Some(replaced) = self.left.as_ref().map(|left| &left.replaced) else { return Some(support) };
        match replaced.get(support) {
            Some(true) => None,
            Some(false) if !self.let_go => Some(replaced[..support].iter().filter(|r| !**r).count()),
            _ => Some(support),
        }
    }

    /// The support that has an index in the inner model.
    fn outer_index(&self, inner: usize) -> Option<usize> {
        (0..self.problem.supports.len()).find(|&k| self.inner_index(k) == Some(inner))
    }

    /// Continues a cable that had left some of its wheels before an edit of the scene; returns
    /// false, without a change, if that is impossible.
    fn continue_without_wheels(&mut self, before: &ContinuationWithoutWheels) -> bool {
        let are_wheels =
            |replaced: &[bool]| replaced.iter().zip(&self.wheels.wheels).all(|(replaced, wheel)| !replaced || *wheel);
        if self.left.is_some() || before.replaced.len() != self.support_moves.len() || !are_wheels(&before.replaced) {
            return false;
        }
        let moves = |k: usize| before.posts[k] && !self.wheels.standing[k];
        let moving: Vec<bool> = (0..before.posts.len()).map(moves).collect();
        // A post holds the cable for ever.
        let lets_go = |k: &usize| self.problem.supports[*k].release.is_some();
        if (0..moving.len()).filter(|k| moving[*k]).any(|k| lets_go(&k)) {
            return false;
        }
        let places =
            before.centers.iter().zip(&self.support_moves).map(|(center, moved)| center.filter(|_| moved.is_some()));
        let places_before = std::mem::replace(&mut self.places, places.collect());
        let as_moving_post = std::mem::replace(&mut self.as_moving_post, moving);
        let continued = self.without(&before.replaced, Inertia::Dynamic).and_then(|left| {
            let going_on = || left.going_on(&self.problem, &self.problem, &self.places, before.time_s);
            let problem = if before.let_go { going_on()? } else { left.problem.clone() };
            let inner = (self.construct)(problem, self.settings).ok()?;
            let mut next =
                Self { support_moves: self.support_moves.clone(), let_go: before.let_go, ..Self::empty(self, inner) };
            next.left = Some(left);
            if let Some(pose) = self.robot_pose {
                next.inner.set_robot_pose(pose);
            }
            next.move_all_inner_supports();
            next.inner.continue_from(&*before.inner).then_some(next)
        });
        match continued {
            Some(next) => (self.inner, self.left, self.let_go) = (next.inner, next.left, next.let_go),
            None => (self.places, self.as_moving_post) = (places_before, as_moving_post),
        }
        self.left.is_some()
    }

    /// Moves all supports of the inner model that were moved.
    fn move_all_inner_supports(&mut self) {
        for k in 0..self.support_moves.len() {
            if let Some(target) = self.support_moves[k] {
                self.move_support(k, target);
            }
        }
    }

    /// A model without the wheels that were left, with supports moved as in this one.
    fn built(&self, left: Option<&Arc<WheelsLeft>>, start: &Start<'_>) -> Result<Box<dyn Mechanics>, SolveError> {
        let problem = left.map_or(&self.problem, |left| &left.problem);
        let mut this =
            Self { left: left.cloned(), ..Self::empty(self, (self.construct)(problem.clone(), self.settings)?) };
        this.support_moves.clone_from(&self.support_moves);
        if let Some(pose) = self.robot_pose {
            this.inner.set_robot_pose(pose);
        }
        match start {
            Start::Route => {}
            Start::Motion(state) => this.inner.set_state(state)?,
            Start::Rest(answer, time_s) => this.inner.warm_start(answer, *time_s)?,
        }
        this.move_all_inner_supports();
        Ok(this.inner)
    }

    /// The same layer with another inner model, without moved supports.
    fn empty(of: &Self, inner: Box<dyn Mechanics>) -> Self {
        Self::new(of.problem.clone(), of.wheels.clone(), of.settings, of.construct.clone(), inner)
    }

    /// Continues with a model of the problem without the wheels that were left.
    fn continue_with(&mut self, inner: Box<dyn Mechanics>, left: Option<Arc<WheelsLeft>>) {
        (self.inner, self.left, self.let_go) = (inner, left, false);
    }

    /// Returns whether a wheel that was left moves to a place (m) clear of the cable.
    fn goes_clear(&self, support: usize, to: Vec2) -> bool {
        let radius = self.problem.supports.get(support).map(|s| s.wheel_radius);
        let (Some(wheel), Some(radius)) = (self.wheel_left(support), radius) else { return false };
        let (state, from) = (self.inner.state(), self.place_of(wheel));
        state.position_m.windows(2).all(|bar| segment_segment(bar[0], bar[1], from, to) > radius)
    }

    /// Moves a support; a wheel that was left goes there when the cable is next solved.
    fn move_support(&mut self, support: usize, target: SupportMove) {
        if let Some(move_of_it) = self.support_moves.get_mut(support) {
            *move_of_it = Some(target);
        }
        match (self.inner_index(support), target) {
            (Some(inner), SupportMove::Dragged(at)) => self.inner.drag_support(inner, at),
            (Some(inner), SupportMove::Pulled(at)) => self.inner.pull_support(inner, at),
            (None, _) => {}
        }
    }

    /// A wheel that was left.
    fn wheel_left(&self, support: usize) -> Option<&WheelLeft> {
        self.left.iter().flat_map(|left| &left.wheels).find(|wheel| wheel.support == support)
    }

    /// The present place of a wheel that was left, m.
    fn place_of(&self, wheel: &WheelLeft) -> Vec2 {
        let own = || self.problem.supports.get(wheel.support)?.place_at(self.inner.time_s()).map(|place| place.0);
        let by_motion = || own().filter(|_| !self.wheels.standing[wheel.support]);
        self.places[wheel.support].or_else(by_motion).unwrap_or(wheel.center)
    }

    /// The wheels that were left and have targets elsewhere than they are, with these targets, m.
    fn wheels_to_move(&self) -> Vec<(usize, Vec2)> {
        let wheels = self.left.iter().flat_map(|left| &left.wheels);
        let moved = wheels.filter_map(|wheel| {
            let to = self.support_moves[wheel.support].map(SupportMove::place)?;
            (self.place_of(wheel) != to).then_some((wheel.support, to))
        });
        moved.collect()
    }

    /// Puts wheels that were left at their targets, at once. One stays left if its path is
    /// clear of the cable, and no post moves in its place; else all become wheels again.
    fn put_at_rest(&mut self) {
        let moved = self.wheels_to_move();
        if moved.is_empty() {
            return;
        }
        let is_post = |support: usize| self.wheel_left(support).is_some_and(|wheel| wheel.post.is_some());
        let moves = |support: usize| self.as_moving_post[support] && is_post(support);
        let stays = |support: usize, to: Vec2| !moves(support) && self.goes_clear(support, to);
        let clear = moved.iter().all(|(support, to)| stays(*support, *to));
        let before = self.places.clone();
        for (support, to) in moved {
            self.places[support] = Some(to);
        }
        if clear && self.move_posts() {
            return;
        }
        if let Ok(inner) = self.built(None, &Start::Motion(&self.inner.state())) {
            self.continue_with(inner, None);
            self.places.fill(None);
        } else {
            self.places = before;
        }
    }

    /// Moves the wheels that were left towards their targets in a step of `dt_s` (s), no
    /// faster than a hand; those that were `known` to be left have been moved already.
    ///
    /// # Errors Those of the model without the posts of wheels that move.
    fn move_left_wheels(&mut self, dt_s: f64, known: &[bool]) -> Result<(), SolveError> {
        self.remove_moved_posts()?;
        let most = self.settings.hand_speed_m_per_s * dt_s;
        for (support, to) in self.wheels_to_move() {
            let from = self.wheel_left(support).map(|wheel| self.place_of(wheel));
            let Some(from) = from.filter(|_| !known[support]) else { continue };
            let way = to - from;
            let part = if way.norm() > most { most / way.norm() } else { 1.0 };
            self.places[support] = Some(if part < 1.0 { from + way * part } else { to });
        }
        Ok(())
    }

    /// Posts follow no hand: a cable that lies on the post of a wheel that moves is laid on the
    /// wheel again; else the post is removed.
    ///
    /// # Errors Those of the model without the post.
    fn remove_moved_posts(&mut self) -> Result<(), SolveError> {
        let moved = self.wheels_to_move();
        if moved.is_empty() {
            return Ok(());
        }
        let mut replaced = self.replaced();
        let (mut any, answer) = (false, self.inner.solution());
        for (support, _) in moved {
            let Some(post) = self.wheel_left(support).and_then(|wheel| wheel.post.as_ref()) else { continue };
            any = true;
            replaced[support] = answer.contacts.iter().all(|c| c.obstacle != *post);
        }
        if !any {
            return Ok(());
        }
        let left = self.without(&replaced, Inertia::Dynamic);
        let same = replaced == self.replaced();
        if !(same && left.as_ref().is_some_and(|left| self.goes_on(left.clone()))) {
            let inner = self.built(left.as_ref(), &Start::Motion(&self.inner.state()))?;
            self.continue_with(inner, left);
        }
        Ok(())
    }

    /// Moves the posts to the places of the wheels; false if that is impossible.
    fn move_posts(&mut self) -> bool {
        let replaced = self.replaced();
        let Some(posts) = self.without(&replaced, Inertia::QuasiStatic) else { return false };
        let Ok(inner) = self.built(Some(&posts), &Start::Motion(&self.inner.state())) else { return false };
        self.continue_with(inner, Some(posts));
        true
    }

    /// Records the present places of wheels that a hand leads and the cable leaves now.
    fn note_places(&mut self, replaced: &[bool]) {
        let (answer, before) = (self.outer_solution(self.inner.solution()), self.replaced());
        for (k, support) in answer.supports.iter().enumerate() {
            if replaced[k] && !before[k] && self.support_moves[k].is_some() {
                self.places[k] = Some(Vec2::new(support.x_m, support.y_m));
            }
        }
    }

    /// For each support, true if it is a wheel that the cable has left.
    fn replaced(&self) -> Vec<bool> {
        self.left.as_ref().map_or_else(|| vec![false; self.problem.supports.len()], |left| left.replaced.clone())
    }

    /// The wheels that were left already and those that the cable leaves by an error, or all that
    /// can be posts if it asks for posts; None if there is no other wheel.
    fn also_left(&self, mut replaced: Vec<bool>, error: &SolveError) -> Option<Vec<bool>> {
        let (names, posts) = (wheels_left_by(error), asks_for_posts(error));
        let before = replaced.clone();
        for (k, support) in self.problem.supports.iter().enumerate() {
            let leaves = self.wheels.wheels[k] && names.contains(&support.name.as_str());
            replaced[k] |= leaves || posts && self.can_be_post(k);
        }
        (replaced != before).then_some(replaced)
    }

    /// Returns whether a post can be in the place of a support: a wheel that holds the cable for
    /// ever, and that no hand leads.
    fn can_be_post(&self, support: usize) -> bool {
        let lets_go = self.problem.supports[support].release.is_some();
        self.wheels.wheels[support] && !lets_go && self.support_moves[support].is_none()
    }

    /// The things in place of wheels, some of which the cable has left.
    fn stand_ins(&self, replaced: &[bool], inertia: Inertia) -> Vec<StandIn> {
        let stand_in = |k: usize| match (replaced[k], self.support_moves[k]) {
            (false, _) => StandIn::Wheel,
            (true, Some(_)) if inertia == Inertia::Dynamic => StandIn::Nothing,
            (true, _) if self.wheels.standing[k] => StandIn::Post,
            (true, None) if self.as_moving_post[k] => StandIn::Post,
            (true, _) => StandIn::Nothing,
        };
        (0..replaced.len()).map(stand_in).collect()
    }

    /// The cable without some wheels, the others at their present places; None if that is the cable
    /// itself. Posts stand in for wheels that stand still: in a motion that is not so of those that
    /// a hand leads.
    fn without(&self, replaced: &[bool], inertia: Inertia) -> Option<Arc<WheelsLeft>> {
        let stand_ins = self.stand_ins(replaced, inertia);
        let at_rest = |k: usize| self.support_moves[k].filter(|_| replaced[k] && inertia == Inertia::QuasiStatic);
        let place = |k: usize| self.places[k].or(at_rest(k).map(SupportMove::place));
        let places: Vec<Option<Vec2>> = (0..replaced.len()).map(place).collect();
        let changed = replaced.contains(&true) || places.iter().any(Option::is_some);
        if changed { self.wheels.left(&stand_ins, &places) } else { None }
    }

    /// Continues without the wheels that the cable leaves by this error and by following ones;
    /// returns None, with nothing changed, if that fails.
    fn run_without(
        &mut self,
        error: &SolveError,
        start: &Start<'_>,
        inertia: Inertia,
        mut run: impl FnMut(&mut dyn Mechanics) -> Result<StepReport, SolveError>,
    ) -> Option<StepReport> {
        let before = self.as_moving_post.clone();
        let mut replaced = self.also_left(self.replaced(), error);
        let mut asks = asks_for_posts(error);
        while let Some(wheels) = replaced {
            for support in (0..wheels.len()).filter(|_| asks) {
                self.as_moving_post[support] |= !self.wheels.standing[support] && self.can_be_post(support);
            }
            let Some(left) = self.without(&wheels, inertia) else { break };
            let Ok(mut inner) = self.built(Some(&left), start) else { break };
            let found = run(&mut *inner);
            let refusal = match &found {
                Ok(_) => inner.refusal(),
                Err(error) => Some(error),
            };
            asks = refusal.is_some_and(asks_for_posts);
            replaced = refusal.and_then(|error| self.also_left(wheels, error));
            if let (None, Ok(report)) = (&replaced, found) {
                let known = self.replaced();
                for k in (0..known.len()).filter(|&k| left.replaced[k] && !known[k] && inertia == Inertia::QuasiStatic)
                {
                    self.places[k] = self.places[k].or(self.support_moves[k].map(SupportMove::place));
                }
                self.continue_with(inner, Some(left));
                return Some(report);
            }
        }
        self.as_moving_post = before;
        None
    }

    /// Lets the wheels go that the cable leaves by this error, in the model that holds the state;
    /// returns whether it can do so.
    fn let_go_of(&mut self, error: &SolveError, inertia: Inertia) -> bool {
        if asks_for_posts(error) {
            return false;
        }
        let Some(replaced) = self.also_left(self.replaced(), error) else { return false };
        self.note_places(&replaced);
        self.without(&replaced, inertia).is_some_and(|left| self.goes_on(left))
    }

    /// Goes on with wheels that let go or hold again, in the model that holds the state; returns
    /// whether it can do so.
    fn goes_on(&mut self, left: Arc<WheelsLeft>) -> bool {
        if self.replaced().contains(&true) && !self.let_go {
            return false;
        }
        let (present, time_s) = (self.inner.problem(), self.inner.time_s());
        let problem = left.going_on(present, &self.problem, &self.places, time_s);
        let goes_on = problem.is_some_and(|problem| self.inner.change_wheels(problem));
        if goes_on {
            (self.left, self.let_go) = (Some(left), true);
        }
        goes_on
    }

    /// Advances to a time (s), and on without the wheels that the cable leaves on the way.
    fn advance_to(&mut self, end_s: f64, inertia: Inertia, gauge: &mut TensionGauge) -> Result<StepReport, SolveError> {
        loop {
            let from_s = self.inner.time_s();
            let error = match self.inner.advance_gauged(end_s - from_s, inertia, gauge) {
                Ok(report) => return Ok(report),
                Err(error) => error,
            };
            let known = self.replaced();
            if self.let_go_of(&error, inertia) {
                self.keep_account();
                // A wheel that a hand leads goes on.
                if inertia == Inertia::Dynamic {
                    self.move_left_wheels(end_s - self.inner.time_s(), &known)?;
                }
                continue;
            }
            let (from_s, state, answer) = (self.inner.time_s(), self.inner.state(), self.inner.solution());
            let start = Start::of(inertia, &state, &answer);
            let run = |inner: &mut dyn Mechanics| inner.advance_gauged(end_s - from_s, inertia, gauge);
            return self.run_without(&error, &start, inertia, run).ok_or(error);
        }
    }

    /// The wheels that were left and have nothing in their place.
    fn wheels_nearby(&self) -> Vec<WheelNearby> {
        let gone = self.left.iter().flat_map(|left| &left.wheels).filter(|wheel| wheel.post.is_none());
        let gone: Vec<usize> = gone.map(|wheel| wheel.support).collect();
        if gone.is_empty() {
            return Vec::new();
        }
        let state = self.inner.state();
        let nearby = gone.into_iter().filter_map(|k| {
            let support = &self.problem.supports[k];
            let center = self.places[k].or_else(|| support.position_at(state.time_s).map(|place| place.0))?;
            let x = &state.position_m;
            let away = |e: &usize| distance(center, x[*e], x[*e + 1]);
            let bar = (0..x.len().saturating_sub(1)).min_by(|a, b| away(a).total_cmp(&away(b)))?;
            let travel = x[bar + 1] - x[bar];
            let fraction = nearest_fraction(center, x[bar], x[bar + 1]);
            let at = if fraction >= 1.0 { x[bar + 1] } else { x[bar] + travel * fraction };
            let outward = at - center;
            let side = facing(support.side, travel);
            // At a node it may turn.
            let next = x[(bar + 1..x.len()).find(|&j| x[j] != at)?];
            let before = x[(0..=bar).rev().find(|&j| x[j] != at)?];
            let turn = turn_through_centre(side, at - before, next - at);
            let can_bear = cross(travel, outward) * side > 0.0 && turn > -MOST_TURN_AWAY;
            let depth = 1.0 - outward.norm() / support.wheel_radius;
            Some(WheelNearby { support: k, depth, can_bear })
        });
        nearby.collect()
    }

    /// The greatest depth to which the cable lies within a wheel that it had left, in radii.
    fn return_depth(&self) -> f64 {
        self.wheels_nearby().iter().map(|wheel| wheel.depth).fold(f64::NEG_INFINITY, larger)
    }

    /// Adds the momentum that the model accounts for in a part of the step to that of the parts
    /// before.
    fn keep_account(&mut self) {
        self.account = self.whole_account(self.inner.solution().momentum);
    }

    /// The account of momentum of the parts of the step before, and of the present one.
    fn whole_account(&self, now: Option<MomentumAccount>) -> Option<MomentumAccount> {
        match (self.account, now) {
            (Some(before), Some(now)) => Some(before.then(&now)),
            (before, now) => now.or(before),
        }
    }

    /// Lays a stiff cable at rest on posts in place of wheels, before it is moved, where the model
    /// would neglect its bend on a wheel: a sliding node carries no moment. It stays on the wheels
    /// if it cannot be laid so.
    fn move_bends_to_posts(&mut self, inertia: Inertia) {
        let bent = self.inner.wheels_bent_over(inertia);
        let bent: Vec<usize> = bent.into_iter().filter_map(|k| self.outer_index(k)).collect();
        let mut replaced = self.replaced();
        for &support in bent.iter().filter(|&&support| self.can_be_post(support)) {
            replaced[support] = true;
        }
        let state = self.inner.state();
        if replaced == self.replaced() || state.moves() {
            return;
        }
        let stand_still = self.as_moving_post.clone();
        for &support in bent.iter().filter(|&&support| replaced[support]) {
            self.as_moving_post[support] = !self.wheels.standing[support];
        }
        if !self.lays_on_posts(&replaced, &state) {
            self.as_moving_post = stand_still;
        }
    }

    /// Lays a cable at rest on posts in place of wheels; returns whether it rests there as before.
    fn lays_on_posts(&mut self, replaced: &[bool], state: &State) -> bool {
        let Some(posts) = self.without(replaced, Inertia::QuasiStatic) else { return false };
        let start = self.inner.solution();
        let greatest = |answer: &CableSolution| answer.nodes.iter().map(|n| n.tension_n.abs()).fold(0.0, larger);
        let Ok(inner) = self.built(Some(&posts), &Start::Rest(&start, state.time_s)) else { return false };
        let (before, after) = (greatest(&start), greatest(&inner.solution()));
        let same = (after - before).abs() <= SAME_REST_TENSION_FRACTION * before;
        if same {
            self.continue_with(inner, Some(posts));
        }
        same
    }

    /// Advances up to a time (s), or to the instant at which a moving cable comes back to a wheel:
    /// laid on it later, it would jump out of it, and pull with 37 kN from 0.3.
    fn advance_until_return(
        &mut self,
        end_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        let may_return = inertia == Inertia::Dynamic && !self.wheels_nearby().is_empty();
        if !may_return {
            return self.advance_to(end_s, inertia, gauge);
        }
        let before_step = (self.around(self.inner.boxed_clone()), gauge.clone());
        // The times between which it comes back, with its depth in excess of the one asked for.
        let asked = 0.5 * (1.0 + DEEPEST_RETURN_FACTOR) * RETURN_DEPTH;
        let mut clear = (self.inner.time_s(), self.return_depth() - asked);
        let mut report = self.advance_to(end_s, inertia, gauge)?;
        let mut within = (end_s, self.return_depth() - asked);
        for trial in 0..MAX_RETURN_TRIALS {
            let depth = self.return_depth();
            if !(depth > DEEPEST_RETURN_FACTOR * RETURN_DEPTH) && (depth > RETURN_DEPTH || trial == 0) {
                break;
            }
            let part = if trial % 2 == 0 { clear.1 / (clear.1 - within.1) } else { 0.5 };
            let time_s = clear.0 + (within.0 - clear.0) * part;
            if !(time_s > clear.0 && time_s < within.0) {
                break;
            }
            *self = before_step.0.around(before_step.0.inner.boxed_clone());
            *gauge = before_step.1.clone();
            report = self.advance_to(time_s, inertia, gauge)?;
            let there = (time_s, self.return_depth() - asked);
            if there.1 > 0.0 { within = there } else { clear = there }
        }
        Ok(report)
    }

    /// Lays the cable on the wheels again that it left and to which it has come back, where no post
    /// stands.
    ///
    /// # Errors Those of the model on these wheels; `BackOnWheel` where the model does not follow
    /// that.
    fn come_back(&mut self, inertia: Inertia) -> Result<(), SolveError> {
        let back = self.wheels_nearby().into_iter().filter(|wheel| wheel.depth > RETURN_DEPTH);
        let back: Vec<WheelNearby> = back.collect();
        if back.is_empty() {
            return Ok(());
        }
        let state = self.inner.state();
        // From its other side a wheel would have to pass through the cable, and the tip of a fold
        // that strikes it does not run round it: there it is met as a post. In `mass-spring` the
        // wheel would push its node out at once, and stretch its two elements by all of that.
        let by_springs = self.inner.model() == Model::MassSpring;
        let lost = back.iter().filter(|wheel| by_springs || !wheel.can_bear).map(|wheel| wheel.support);
        let lost: Vec<usize> = lost.filter(|_| inertia == Inertia::Dynamic).collect();
        if let Some(&support) = lost.first() {
            if self.meets_as_posts(&lost) {
                return Ok(());
            }
            let support = self.problem.supports[support].name.clone();
            return Err(SolveError::Unsupported {
                model: self.inner.model(),
                feature: Unsupported::BackOnWheel { support },
            });
        }
        let mut replaced = self.replaced();
        for wheel in back {
            replaced[wheel.support] = false;
        }
        let stand_ins = self.stand_ins(&replaced, inertia);
        if inertia == Inertia::Dynamic
            && let Some(left) = self.wheels.left(&stand_ins, &self.places)
            && self.goes_on(left)
        {
            return Ok(());
        }
        let left = self.without(&replaced, inertia);
        let answer = self.inner.solution();
        let inner = self.built(left.as_ref(), &Start::of(inertia, &state, &answer))?;
        self.continue_with(inner, left);
        Ok(())
    }

    /// Puts posts that move in the place of wheels which the cable has left and meets again;
    /// returns false, with nothing changed, if that is impossible.
    fn meets_as_posts(&mut self, supports: &[usize]) -> bool {
        if !supports.iter().all(|&support| self.can_be_post(support)) {
            return false;
        }
        let before = self.as_moving_post.clone();
        for &support in supports {
            self.as_moving_post[support] = true;
        }
        let meets = self.without(&self.replaced(), Inertia::Dynamic).is_some_and(|left| self.goes_on(left));
        if !meets {
            self.as_moving_post = before;
        }
        meets
    }

    /// The warnings of a report, with one for each wheel of which the cable hangs clear.
    fn with_wheel_warnings(&self, mut report: StepReport) -> StepReport {
        if let Some(left) = &self.left {
            let name = &self.problem.cable.name;
            let wheels = self
                .outer_solution(self.inner.solution())
                .supports
                .into_iter()
                .zip(&left.replaced)
                .filter(|(_, replaced)| **replaced);
            let clear = wheels.map(|(s, _)| s).filter(|s| s.reaction_x_n == 0.0 && s.reaction_y_n == 0.0);
            report.warnings.extend(clear.map(|s| {
                let cause = WarningCause::ClearOfWheel { pulley: s.name };
                Warning::new(cause, name, s.arc_length_m, [0.0; 2]).at([s.x_m, s.y_m])
            }));
        }
        report
    }
}

/// The reaction of a wheel that was left, with its centre (m), from an answer without it.
fn reaction(problem: &Problem, wheel: &WheelLeft, center: Vec2, answer: &CableSolution) -> SupportReaction {
    let name = problem.supports.get(wheel.support).map(|s| s.name.clone()).unwrap_or_default();
    let mut out = SupportReaction { name, x_m: center.x, y_m: center.y, ..SupportReaction::default() };
    let on = || answer.contacts.iter().filter(|c| wheel.post.as_ref() == Some(&c.obstacle));
    if let (Some(first), Some(last)) = (on().next(), on().next_back()) {
        for c in on() {
            out.reaction_x_n -= c.force_n[0];
            out.reaction_y_n -= c.force_n[1];
        }
        out.arc_length_m = 0.5 * (first.begins_m + last.ends_m);
        out.tension_before_n = Some(first.tension_before_n);
        out.tension_after_n = Some(last.tension_after_n);
    } else {
        let distance = |n: &Node| (n.at() - center).norm();
        let nearest = answer.nodes.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(node) = nearest {
            out.arc_length_m = node.arc_length_m;
            out.tension_before_n = Some(node.tension_n);
            out.tension_after_n = Some(node.tension_n);
        }
    }
    out
}

impl Layer for LeavableWheels {
    fn inner(&self) -> &dyn Mechanics {
        &*self.inner
    }

    fn inner_mut(&mut self) -> &mut dyn Mechanics {
        &mut *self.inner
    }

    fn around(&self, inner: Box<dyn Mechanics>) -> Self {
        Self {
            problem: self.problem.clone(),
            wheels: self.wheels.clone(),
            settings: self.settings,
            construct: self.construct.clone(),
            inner,
            left: self.left.clone(),
            let_go: self.let_go,
            as_moving_post: self.as_moving_post.clone(),
            support_moves: self.support_moves.clone(),
            places: self.places.clone(),
            robot_pose: self.robot_pose,
            rests: self.rests,
            account: self.account,
        }
    }

    fn reason(&self) -> Option<&ModelReason> {
        let as_posts = self.left.as_ref().filter(|_| self.inner.model() == Model::Spans);
        self.inner.reason().or(as_posts.and(Some(&ModelReason::Obstacles)))
    }

    /// A moving cable is on the wheels on which its state lies; it has left the others.
    fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.account = None;
        let off = |(k, support): (usize, &SupportPoint)| {
            let center = self.places[k].or_else(|| support.position_at(state.time_s).map(|place| place.0));
            let far = support.wheel_radius * (1.0 + RETURN_DEPTH) + POST_GAP_M;
            let clear = |center| state.position_m.windows(2).all(|bar| distance(center, bar[0], bar[1]) > far);
            self.wheels.wheels[k] && center.is_some_and(clear)
        };
        let is_whole = || state.pieces().len() == 1;
        if state.moves() && state.first_non_finite().is_none() && is_whole() {
            let replaced: Vec<bool> = self.problem.supports.iter().enumerate().map(off).collect();
            if replaced != self.replaced() {
                let left = self.without(&replaced, Inertia::Dynamic);
                if let Ok(inner) = self.built(left.as_ref(), &Start::Motion(state)) {
                    self.continue_with(inner, left);
                    return Ok(());
                }
            }
        }
        self.inner.set_state(state)
    }

    fn continuation(&self) -> Option<Box<dyn Any + Send>> {
        let inner = self.inner.continuation()?;
        let Some(left) = &self.left else { return Some(inner) };
        let mut centers = self.places.clone();
        for wheel in &left.wheels {
            centers[wheel.support].get_or_insert(wheel.center);
        }
        let (replaced, let_go, time_s) = (left.replaced.clone(), self.let_go, self.inner.time_s());
        let is_post = |support: usize| self.wheel_left(support).is_some_and(|wheel| wheel.post.is_some());
        let posts = (0..replaced.len()).map(is_post).collect();
        Some(Box::new(ContinuationWithoutWheels { replaced, let_go, posts, centers, time_s, inner }))
    }

    fn continue_from(&mut self, before: &(dyn Any + Send)) -> bool {
        match before.downcast_ref::<ContinuationWithoutWheels>() {
            Some(before) => self.continue_without_wheels(before),
            None => self.left.is_none() && self.inner.continue_from(before),
        }
    }

    fn settle(&mut self) -> Result<StepReport, SolveError> {
        (self.rests, self.account) = (true, None);
        self.put_at_rest();
        let found = self.inner.settle();
        let refusal = match &found {
            Ok(_) => self.inner.refusal(),
            Err(error) => Some(error),
        };
        if let Some(refusal) = refusal.cloned() {
            let state = self.inner.state();
            let start = if self.inner.time_s() > 0.0 { Start::Motion(&state) } else { Start::Route };
            let run = |inner: &mut dyn Mechanics| inner.settle();
            if let Some(report) = self.run_without(&refusal, &start, Inertia::QuasiStatic, run) {
                return Ok(self.with_wheel_warnings(report));
            }
        }
        found.map(|report| self.with_wheel_warnings(report))
    }

    fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        self.account = None;
        match inertia {
            Inertia::Dynamic => self.move_left_wheels(dt_s, &vec![false; self.support_moves.len()])?,
            Inertia::QuasiStatic => self.put_at_rest(),
        }
        if std::mem::take(&mut self.rests) {
            self.move_bends_to_posts(inertia);
        }
        let end_s = self.inner.time_s() + dt_s;
        let mut report = self.advance_until_return(end_s, inertia, gauge)?;
        let mut returns = 0;
        while end_s - self.inner.time_s() > SAME_TIME_FRACTION * dt_s {
            self.keep_account();
            self.come_back(inertia)?;
            returns += 1;
            report.add(match returns < MAX_RETURNS {
                true => self.advance_until_return(end_s, inertia, gauge)?,
                false => self.advance_to(end_s, inertia, gauge)?,
            });
        }
        let report = self.with_wheel_warnings(report);
        self.come_back(inertia)?;
        Ok(report)
    }

    fn drag_support(&mut self, support: usize, target_m: Vec2) {
        self.move_support(support, SupportMove::Dragged(target_m));
    }

    fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.move_support(support, SupportMove::Pulled(hand_m));
    }

    fn set_robot_pose(&mut self, to: RigidPose) {
        self.robot_pose = Some(to);
        self.inner.set_robot_pose(to);
    }

    /// A wheel acts on the cable as a post does: where no answer over wheels is sound, one over
    /// posts is asked for. The elements of `mass-spring` run round wheels, but straight through
    /// posts that are smaller than they are long.
    fn fall_back(&mut self, why: &SolveError) -> bool {
        if self.inner.fall_back(why) {
            return true;
        }
        // Posts that move are for stiff cables: `spans` knows none.
        let moves = |k: usize| self.problem.bending_stiffness > 0.0 && !self.wheels.standing[k] && self.can_be_post(k);
        let moving: Vec<bool> = (0..self.support_moves.len()).map(moves).collect();
        let all: Vec<bool> =
            moving.iter().zip(&self.wheels.standing).map(|(moves, stands)| *moves || *stands).collect();
        let cuts_posts = self.inner.model() == Model::MassSpring;
        if cuts_posts || self.inner.time_s() > 0.0 || self.replaced() == all {
            return false;
        }
        let before = std::mem::replace(&mut self.as_moving_post, moving);
        let posts = self.without(&all, Inertia::QuasiStatic);
        match posts.and_then(|posts| Some((self.built(Some(&posts), &Start::Route).ok()?, posts))) {
            Some((inner, posts)) => {
                self.continue_with(inner, Some(posts));
                true
            }
            None => {
                self.as_moving_post = before;
                false
            }
        }
    }

    fn outer_solution(&self, mut answer: CableSolution) -> CableSolution {
        answer.momentum = self.whole_account(answer.momentum);
        let Some(left) = &self.left else { return answer };
        for wheel in &left.wheels {
            let placed = self.places.get(wheel.support).copied().flatten();
            let moved = || self.problem.supports.get(wheel.support)?.place_at(self.inner.time_s()).map(|place| place.0);
            let may_move = wheel.post.is_none() || self.as_moving_post[wheel.support];
            let center = placed.or_else(moved).filter(|_| may_move).unwrap_or(wheel.center);
            let reaction = reaction(&self.problem, wheel, center, &answer);
            match answer.supports.get_mut(wheel.support).filter(|_| self.let_go) {
                Some(of_let_go) => *of_let_go = reaction,
                None => answer.supports.insert(wheel.support.min(answer.supports.len()), reaction),
            }
        }
        answer.contacts.retain(|c| left.wheels.iter().all(|w| w.post.as_ref() != Some(&c.obstacle)));
        answer
    }

    fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }
}

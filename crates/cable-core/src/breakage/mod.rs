//! A breakable cable is one cable of a scene over time: whole, or the pieces it broke into.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | [`BreakableCable`]: its pieces in a step, and what becomes of one that breaks |
//! | `piece.rs` | one piece in a step: the search for the instant of a break |
//! | `partition.rs` | which supports and loads belong to which piece |
//! | `rupture.rs` | where and when the breaking tension is first reached |
//! | `answer.rs` | the pieces read as one cable |
//! | `support_speed_limit.rs` | motions of supports that are too fast to be followed |
//!
//! A model knows one unbroken cable. Where the tension reaches the breaking tension,
//! [`BreakableCable`] stops the model there, distributes supports and loads over two shorter
//! [`Problem`]s with free ends, and continues with a model for each, from the positions and
//! velocities of that instant. Every model can break, and none knows that it can.

mod answer;
mod partition;
mod piece;
mod rupture;
mod support_speed_limit;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use partition::{CablePart, Cut};
use piece::{BreakPoint, Piece, StepOutcome};
use support_speed_limit::too_fast;

use crate::error::{SolveError, Unsupported};
use crate::math::{RigidPose, Vec2, larger, smaller};
use crate::model::gauge::TensionGauge;
use crate::model::hand::default_hand_stiffness;
use crate::model::{Inertia, Mechanics, Model, ModelSource, OwnedResources, RobotContact, Settings, StepReport};
use crate::problem::Problem;
use crate::solution::{ModelReason, TensionPeaks};
use crate::state::State;

/// Steps after a break in which a piece is not watched: the models start with a first-order step,
/// and the free end is met by a wave of its own. Fewer: false breaks beside the first; more: true
/// ones are late. In motion it is also not watched until that wave, at c = √(EA/ρ), has crossed it
/// there and back (once is too short: a mesh blurs its front): where the break is not felt yet, a
/// cable of exactly even strength that was pulled evenly would break everywhere at once, which no
/// cable does.
const UNWATCHED_STEPS: u32 = 2;

/// Most pieces of one cable. More are no longer a cable that breaks but a step that fails.
const MAX_PIECES: usize = 32;

/// A break.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Break {
    /// When, s.
    pub time_s: f64,
    /// Place on the cable, m.
    pub arc_length_m: f64,
    /// Place in the plane, m.
    pub at: Vec2,
    /// The support it tore off, if it did.
    pub detached_from: Option<String>,
    /// The time over which its mean tension reached the breaking tension, s; 0 = at once.
    pub over_s: f64,
}

/// One cable of a scene.
pub(crate) struct BreakableCable {
    problem: Arc<Problem>,
    /// Builds the whole cable, and the pieces it breaks into.
    source: ModelSource,
    settings: Settings,
    pieces: Vec<Piece>,
    breaks: Vec<Break>,
    dragged: Vec<Option<Vec2>>,
    /// True for those that a hand holds by a spring.
    pulled: Vec<bool>,
    /// Pose to which the outline of the robot was led.
    robot_pose: Option<RigidPose>,
    /// The greatest tensions since they were last forgotten, in motion.
    peaks: Option<TensionPeaks>,
    /// The time when that was, s.
    peaks_since_s: f64,
    /// A motion that is too fast for masses that move.
    too_fast: Option<Unsupported>,
    /// True if it may come to obstacles that were out of its reach.
    leaves_reach: bool,
}

/// The hold that draws a support.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SupportGrip {
    /// The support goes where it is sent.
    Rigid,
    /// A spring pulls it there.
    Spring,
}

impl BreakableCable {
    /// Builds the model of a whole cable.
    pub fn new(source: ModelSource, problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        // A hand's spring is that of the whole cable, whatever breaks off.
        let stiffness = settings.hand_stiffness_n_per_m.unwrap_or_else(|| default_hand_stiffness(&problem));
        let settings = Settings { hand_stiffness_n_per_m: Some(stiffness), ..settings };
        let mechanics = source.build(problem.clone(), settings)?;
        let gauge = TensionGauge::over(problem.cable.breaking_time_s);
        let piece = Piece::new(mechanics, CablePart::whole(&problem), gauge);
        let dragged = vec![None; problem.supports.len()];
        let too_fast = problem.supports.iter().find_map(too_fast);
        Ok(Self {
            too_fast,
            leaves_reach: false,
            problem,
            source,
            settings,
            pieces: vec![piece],
            breaks: Vec::new(),
            pulled: vec![false; dragged.len()],
            dragged,
            robot_pose: None,
            peaks: None,
            peaks_since_s: 0.0,
        })
    }

    /// The same cable by another model: where it is, or at its route where it has not begun.
    pub fn rebuilt(&self, source: ModelSource) -> Result<Self, SolveError> {
        self.rebuilt_with(source, self.settings)
    }

    /// The same with other settings.
    pub fn rebuilt_with(&self, source: ModelSource, settings: Settings) -> Result<Self, SolveError> {
        let mut next = Self::new(source, self.problem.clone(), settings)?;
        if self.time_s() > 0.0 {
            next.carry(self)?;
        }
        for (k, target) in self.dragged.iter().enumerate() {
            match target {
                Some(target) if self.pulled[k] => next.pull_support(k, *target),
                Some(target) => next.drag_support(k, *target),
                None => {}
            }
        }
        Ok(next)
    }

    /// The model in use: of several pieces that of the first.
    pub fn model(&self) -> Model {
        self.pieces.first().map_or(self.source.model(), |p| p.mechanics.model())
    }

    /// Returns why it is that model, where that changed on the way.
    pub fn reason(&self) -> Option<&ModelReason> {
        self.pieces.iter().find_map(|p| p.mechanics.reason())
    }

    /// Returns why the model that was asked first has no answer, where another one gave the present
    /// one.
    pub fn refusal(&self) -> Option<&SolveError> {
        self.pieces.iter().find_map(|p| p.mechanics.refusal())
    }

    /// The settings with which it was built.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The whole cable's problem.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Returns where and when it broke, oldest first.
    pub fn breaks(&self) -> &[Break] {
        &self.breaks
    }

    /// Time reached, s: that of the piece that is least far.
    pub fn time_s(&self) -> f64 {
        self.pieces.iter().map(|p| p.mechanics.time_s()).fold(f64::INFINITY, |a, b| if b < a { b } else { a })
    }

    /// Finds where it rests: nothing breaks at rest, see `crate::warnings`.
    pub fn settle(&mut self) -> Result<StepReport, SolveError> {
        let mut sum = StepReport::default();
        self.peaks = None;
        self.meet_what_is_in_reach()?;
        loop {
            for piece in &mut self.pieces {
                piece.gauge.forget();
                sum.add(piece.mechanics.settle()?);
                piece.refresh_answer();
            }
            self.note_reach();
            if !self.leaves_reach {
                break;
            }
            self.meet_what_is_in_reach()?;
        }
        sum.warnings.extend(self.problem.notes.iter().cloned());
        Ok(sum)
    }

    /// A new step of the caller begins: the greatest tensions and the account of momentum are those
    /// of it from now on.
    pub(crate) fn forget_peaks(&mut self) {
        self.peaks = None;
        self.peaks_since_s = self.time_s();
        self.pieces.iter_mut().for_each(|p| p.account = None);
    }

    /// Advances time by exactly `dt_s`, breaking on the way where it must. Without inertia it stops
    /// where something turns back: one step from before a reversal to after it would be another
    /// history.
    pub fn advance(&mut self, dt_s: f64, inertia: Inertia) -> Result<StepReport, SolveError> {
        if let (Inertia::Dynamic, Some(feature)) = (inertia, &self.too_fast) {
            return Err(SolveError::Unsupported { model: self.model(), feature: feature.clone() });
        }
        let mut sum = StepReport::default();
        let (mut left, end_s) = (dt_s, self.time_s() + dt_s);
        while inertia == Inertia::QuasiStatic
            && let Some(at) = self.problem.turn_between(self.time_s(), end_s)
        {
            sum.add(self.advance_on(at - self.time_s(), inertia)?);
            left = end_s - self.time_s();
        }
        sum.add(self.advance_on(left, inertia)?);
        Ok(sum)
    }

    fn advance_on(&mut self, dt_s: f64, inertia: Inertia) -> Result<StepReport, SolveError> {
        let mut sum = StepReport::default();
        self.meet_what_is_in_reach()?;
        self.detach_from_pulleys(inertia)?;
        let Some(end_s) = self.pieces.first().map(|p| p.mechanics.time_s() + dt_s) else { return Ok(sum) };
        let breaking_n = self.problem.cable.breaking_tension_n;
        let mut k = 0;
        while k < self.pieces.len() {
            let may_break = self.settings.breaks && self.pieces.len() < MAX_PIECES;
            let Some(piece) = self.pieces.get_mut(k) else { break };
            // A whole cable takes the very step it was asked for.
            let rest_s = if self.breaks.is_empty() { dt_s } else { end_s - piece.mechanics.time_s() };
            if !self.breaks.is_empty() && rest_s <= 1e-9 * dt_s {
                k += 1;
                continue;
            }
            let done = piece.advance(rest_s, inertia, may_break.then_some(breaking_n), &mut sum)?;
            self.peaks = match (self.peaks, piece.peaks()) {
                (Some(a), Some(b)) => Some(a.with(b)),
                (a, b) => b.or(a),
            };
            match done {
                StepOutcome::Intact => k += 1,
                StepOutcome::Broke(at) => self.split(k, &at, inertia)?,
            }
        }
        self.note_reach();
        Ok(sum)
    }

    /// Notes whether the cable is stretched beyond what its reach was reckoned with.
    fn note_reach(&mut self) {
        let Some(most_n) = self.problem.max_tension_within_reach_n() else { return };
        let tensions = self.pieces.iter().flat_map(|p| p.answer.nodes.iter().map(|n| n.tension_n));
        let peak_n = self.peaks.map_or(0.0, |p| p.greatest.tension_n);
        self.leaves_reach |= tensions.fold(peak_n, larger) > most_n;
    }

    /// Puts all obstacles in the way of a cable that may leave the reach which it had. It touches
    /// none of them yet, so that a new model goes on where the old one is.
    fn meet_what_is_in_reach(&mut self) -> Result<(), SolveError> {
        if !self.leaves_reach {
            return Ok(());
        }
        let Some(problem) = self.problem.with_all_obstacles() else {
            self.leaves_reach = false;
            return Ok(());
        };
        for k in 0..self.pieces.len() {
            let mut mechanics = self.source.build(problem.clone(), self.settings)?;
            self.draw_supports(&self.pieces[k].part, mechanics.as_mut());
            mechanics.set_state(&self.pieces[k].mechanics.state())?;
            self.pieces[k].mechanics = mechanics;
        }
        // Not before: a cable that could not go on among them is asked again.
        (self.problem, self.leaves_reach) = (problem, false);
        Ok(())
    }

    /// Replaces a piece by those it breaks into.
    fn split(&mut self, k: usize, point: &BreakPoint, inertia: Inertia) -> Result<(), SolveError> {
        let BreakPoint { time_s, state, at } = point;
        let (support_arc_lengths, cleared_wheels) = (self.support_arc_lengths(), self.cleared_wheels());
        // The pieces come to what the whole could not.
        if let Some(problem) = self.problem.with_all_obstacles() {
            self.problem = problem;
        }
        let Some(piece) = self.pieces.get(k) else { return Ok(()) };
        let nodes = &piece.answer.nodes;
        let Some(node) = nodes.get(at.node) else { return Ok(()) };
        let tension = |i: Option<usize>| i.and_then(|i| nodes.get(i)).map_or(0.0, |n| n.tension_n);
        let cut = Cut {
            at: piece.part.from + node.arc_length_m,
            near: 0.5 * piece.element(),
            after: tension(Some(at.node + 1)) > tension(at.node.checked_sub(1)),
            support_arc_lengths: &support_arc_lengths,
            cleared_wheels: &cleared_wheels,
        };
        let parts = piece.part.cut(&self.problem, &cut);
        let end =
            if cut.at - piece.part.from <= cut.near { piece.part.supports.first() } else { piece.part.supports.last() };
        let detached = (parts.len() == 1).then(|| end.copied().flatten()).flatten();
        let event = Break {
            time_s: *time_s,
            arc_length_m: cut.at,
            at: state.position_at(node.arc_length_m).unwrap_or_default(),
            over_s: if inertia == Inertia::Dynamic { self.problem.cable.breaking_time_s } else { 0.0 },
            detached_from: detached.and_then(|k| self.problem.supports.get(k)).map(|s| s.name.clone()),
        };
        let from = piece.part.from;
        let mut new_pieces = Vec::with_capacity(2);
        for part in parts {
            let mut own = rupture::section(state, part.from - from, part.to - from);
            // A piece that broke at rest is not at rest any more.
            own.in_motion = inertia == Inertia::Dynamic;
            let there_and_back_s =
                2.0 * part.length() * (self.problem.linear_density / self.problem.axial_stiffness).sqrt();
            let mut new_piece = self.build(part, &own)?;
            new_piece.unwatched_steps = UNWATCHED_STEPS;
            new_piece.unwatched_until_s = time_s + there_and_back_s;
            new_pieces.push(new_piece);
        }
        self.pieces.splice(k..=k, new_pieces);
        self.breaks.push(event);
        Ok(())
    }

    /// A piece from where it is; `state` in its own arc lengths.
    fn build(&self, part: CablePart, state: &State) -> Result<Piece, SolveError> {
        let problem = Arc::new(part.problem(&self.problem, state));
        let mut mechanics = self.source.build(problem, Settings { segments: None, ..self.settings })?;
        self.draw_supports(&part, mechanics.as_mut());
        mechanics.set_state(state)?;
        Ok(Piece::new(mechanics, part, TensionGauge::over(self.problem.cable.breaking_time_s)))
    }

    /// Has the model of a part follow what draws the cable now.
    fn draw_supports(&self, part: &CablePart, mechanics: &mut dyn Mechanics) {
        for (own, k) in part.supports.iter().enumerate() {
            let drawn = k.and_then(|k| Some((self.dragged.get(k).copied().flatten()?, self.pulled[k])));
            match drawn {
                Some((target, true)) => mechanics.pull_support(own, target),
                Some((target, false)) => mechanics.drag_support(own, target),
                None => {}
            }
        }
        if let Some(pose) = self.robot_pose {
            mechanics.set_robot_pose(pose);
        }
    }

    /// A piece whose new end has come to a pulley is off it.
    fn detach_from_pulleys(&mut self, inertia: Inertia) -> Result<(), SolveError> {
        if self.breaks.is_empty() {
            return Ok(());
        }
        for k in 0..self.pieces.len() {
            while let Some(piece) = self.pieces.get(k)
                && let Some(support) = piece.pulley_at_new_end(&self.problem)
            {
                let mut state = piece.mechanics.state();
                state.in_motion = inertia == Inertia::Dynamic;
                let next = self.build(piece.part.without(support), &state)?;
                if let Some(piece) = self.pieces.get_mut(k) {
                    *piece = next;
                }
            }
        }
        Ok(())
    }

    /// From now on a support follows what leads it.
    pub fn drag_support(&mut self, support: usize, target_m: Vec2) {
        self.draw_support(support, target_m, SupportGrip::Rigid);
    }

    /// From now on a hand holds a support by a spring.
    pub fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.draw_support(support, hand_m, SupportGrip::Spring);
    }

    fn draw_support(&mut self, support: usize, to: Vec2, grasp: SupportGrip) {
        if !to.iter().all(|c| c.is_finite()) {
            return;
        }
        if let (Some(d), Some(pulled)) = (self.dragged.get_mut(support), self.pulled.get_mut(support)) {
            (*d, *pulled) = (Some(to), grasp == SupportGrip::Spring);
        }
        self.leaves_reach = true;
        for piece in &mut self.pieces {
            let own = piece.part.supports.iter().position(|k| *k == Some(support));
            match own {
                Some(own) if grasp == SupportGrip::Spring => piece.mechanics.pull_support(own, to),
                Some(own) => piece.mechanics.drag_support(own, to),
                None => {}
            }
        }
    }

    /// Leads the outline of the robot: it goes there in the next advance.
    pub(crate) fn set_robot_pose(&mut self, to: RigidPose) {
        self.robot_pose = Some(to);
        for piece in &mut self.pieces {
            piece.mechanics.set_robot_pose(to);
        }
    }

    /// Bounds the work of a search for an equilibrium and of an advance without inertia: see
    /// [`Mechanics::limit_work`](crate::model::Mechanics::limit_work).
    pub(crate) fn limit_work(&mut self, work: usize) {
        for piece in &mut self.pieces {
            piece.mechanics.limit_work(work);
        }
    }

    /// Does not ask `spans` for the first equilibrium: see
    /// [`Mechanics::start_without_spans`](crate::model::Mechanics::start_without_spans).
    pub(crate) fn start_without_spans(&mut self) {
        for piece in &mut self.pieces {
            piece.mechanics.start_without_spans();
        }
    }

    /// Gives the whole cable to the next model: see
    /// [`Mechanics::fall_back`](crate::model::Mechanics::fall_back).
    pub(crate) fn fall_back(&mut self, why: &SolveError) -> bool {
        match self.pieces.as_mut_slice() {
            [whole] if self.breaks.is_empty() => whole.mechanics.fall_back(why),
            _ => false,
        }
    }

    /// Returns what the cable does to the outline of the robot, all pieces together; None where no
    /// model knows of it.
    pub(crate) fn robot_contact(&self) -> Option<RobotContact> {
        self.pieces
            .iter()
            .filter_map(|p| p.mechanics.robot_contact())
            .reduce(|a, b| RobotContact { force_n: a.force_n + b.force_n, ..if b.left_m > a.left_m { b } else { a } })
    }

    /// Longest inner step of the next step with inertia, s.
    pub fn inner_step_s(&self) -> f64 {
        self.pieces.iter().map(|p| p.mechanics.inner_step_s()).fold(f64::INFINITY, smaller)
    }

    /// From now on it does not break.
    pub(crate) fn prevent_breaks(&mut self) {
        self.settings.breaks = false;
    }

    /// Returns what it does to a support now, N.
    pub(crate) fn pull_on(&self, support: usize) -> Vec2 {
        let r = self.reaction(support);
        Vec2::new(r.reaction_x_n, r.reaction_y_n)
    }

    /// A copy to go back to.
    pub(crate) fn checkpoint(&self) -> Self {
        self.with(self.pieces.iter().map(Piece::checkpoint).collect())
    }

    /// Becomes what it was when `kept` was copied from it.
    pub(crate) fn restore(&mut self, kept: &Self) {
        let mut own: Vec<Option<OwnedResources>> = self.pieces.iter_mut().map(|p| p.mechanics.lend()).collect();
        own.resize_with(kept.pieces.len(), || None);
        // Pieces of a break since then have nothing of the whole.
        let same = self.breaks.len() == kept.breaks.len() && Arc::ptr_eq(&self.problem, &kept.problem);
        *self = kept.checkpoint();
        for (piece, own) in self.pieces.iter_mut().zip(own) {
            piece.mechanics.borrow(own.filter(|_| same));
        }
    }

    /// Takes over a state of the whole cable.
    pub fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        self.leaves_reach |= self.problem.is_beyond_reach(&state.position_m);
        self.meet_what_is_in_reach()?;
        match self.pieces.as_mut_slice() {
            [whole] if self.breaks.is_empty() => {
                whole.mechanics.set_state(state)?;
                whole.gauge.forget();
                whole.refresh_answer();
                self.peaks = None;
                Ok(())
            }
            pieces => {
                let model = pieces.first().map_or(Model::Auto, |p| p.mechanics.model());
                let feature = Unsupported::StateOfWholeCable;
                Err(SolveError::Unsupported { model, feature })
            }
        }
    }

    /// Goes on where `old`, the same cable before an edit, is: broken where that one broke.
    pub fn carry(&mut self, old: &Self) -> Result<(), SolveError> {
        let (Some(own), Some(first)) = (self.pieces.first(), old.pieces.first()) else { return Ok(()) };
        if old.breaks.is_empty() {
            self.set_state(&first.mechanics.state())?;
            let same = |p: &Problem| (p.length, p.cable.breaking_time_s);
            if let (Some(own), true) = (self.pieces.first_mut(), same(&self.problem) == same(&old.problem)) {
                own.gauge.clone_from(&first.gauge);
            }
            return Ok(());
        }
        let model = own.mechanics.model();
        let names = |s: &Self| s.problem.supports.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
        if names(self) != names(old)
            || self.problem.length != old.problem.length
            || self.problem.loads.len() != old.problem.loads.len()
        {
            let feature = Unsupported::EditOfBrokenCable;
            return Err(SolveError::Unsupported { model, feature });
        }
        self.dragged.clone_from(&old.dragged);
        self.pulled.clone_from(&old.pulled);
        let mut pieces = Vec::with_capacity(old.pieces.len());
        for p in &old.pieces {
            pieces.push(self.build(p.part.clone(), &p.mechanics.state())?);
        }
        self.pieces = pieces;
        self.breaks.clone_from(&old.breaks);
        Ok(())
    }
}

impl Clone for BreakableCable {
    fn clone(&self) -> Self {
        self.with(self.pieces.clone())
    }
}

impl BreakableCable {
    /// A copy with copies of its pieces.
    fn with(&self, pieces: Vec<Piece>) -> Self {
        Self {
            problem: self.problem.clone(),
            source: self.source.clone(),
            settings: self.settings,
            pieces,
            breaks: self.breaks.clone(),
            dragged: self.dragged.clone(),
            pulled: self.pulled.clone(),
            robot_pose: self.robot_pose,
            peaks: self.peaks,
            peaks_since_s: self.peaks_since_s,
            too_fast: self.too_fast.clone(),
            leaves_reach: self.leaves_reach,
        }
    }
}

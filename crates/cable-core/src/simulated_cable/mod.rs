//! A simulated cable is one cable of a scene over time: whole, or in the pieces it broke into.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | [`SimulatedCable`]: how it is built, asked and copied |
//! | `advance.rs` | its equilibrium and its steps, all pieces together |
//! | `piece.rs` | one piece with its model, and its last answer |
//! | `break_search.rs` | a step of a piece, and the instant in it at which the piece breaks |
//! | `split.rs` | the pieces that replace one that broke, and pulleys that their ends run off |
//! | `energy_over_breaks.rs`, `former_energy.rs` | the energy account of a cable whose models were replaced |
//! | `support_targets.rs` | supports that are dragged or pulled, and the robot's pose |
//! | `obstacles_in_reach.rs` | obstacles that a cable comes to which were out of its reach |
//! | `handover.rs` | the same cable in another state, by another model or after an edit |
//! | `answer_of_pieces.rs` | the pieces read as one cable |
//! | `support_speed_limit.rs` | motions of supports that are too fast to be followed |
//!
//! Most models know unbroken cables only. Where the tension reaches the breaking tension,
//! [`SimulatedCable`] stops the model there, distributes supports and loads over two shorter
//! [`Problem`]s with free ends (`crate::breakage`), and continues with a model for each, from the
//! positions and velocities of that instant. So every model can break. Pieces of models of their
//! own do not meet each other; a model that lets a cable touch itself keeps the pieces in one mesh
//! ([`Mechanics::break_at`](crate::model::Mechanics::break_at)), and is one [`CablePiece`] here.

mod advance;
mod answer_of_pieces;
mod break_search;
mod energy_over_breaks;
mod former_energy;
mod handover;
mod obstacles_in_reach;
mod piece;
mod split;
mod support_speed_limit;
mod support_targets;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use self::former_energy::FormerEnergy;
use self::piece::CablePiece;
use self::support_speed_limit::too_fast;
use self::support_targets::{SupportGrip, SupportTarget, Targets};
use crate::breakage::{Break, CablePart};
use crate::error::{SolveError, Unsupported};
use crate::math::{RigidPose, Vec2, smaller};
use crate::model::hand::default_hand_stiffness;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{Inertia, Model, ModelSource, OwnedResources, RobotContact, Settings};
use crate::problem::Problem;
use crate::solution::{ModelReason, TensionPeaks};

/// One cable of a scene.
pub(crate) struct SimulatedCable {
    problem: Arc<Problem>,
    /// Builds the whole cable, and the pieces it breaks into.
    source: ModelSource,
    settings: Settings,
    pieces: Vec<CablePiece>,
    breaks: Vec<Break>,
    /// The energy account of the models that pieces replaced; None where there is none.
    former_energy: Option<FormerEnergy>,
    targets: Targets,
    /// The greatest tensions since they were last forgotten, in motion.
    peaks: Option<TensionPeaks>,
    /// The time when that was, s.
    peaks_since_s: f64,
    /// A motion that is too fast for masses that move.
    too_fast: Option<Unsupported>,
    /// True if it may come to obstacles that were out of its reach.
    leaves_reach: bool,
}

impl SimulatedCable {
    /// Builds the model of a whole cable.
    pub fn new(source: ModelSource, problem: Arc<Problem>, settings: Settings) -> Result<Self, SolveError> {
        // A hand's spring is that of the whole cable, whatever breaks off.
        let stiffness = settings.hand_stiffness_n_per_m.unwrap_or_else(|| default_hand_stiffness(&problem));
        let settings = Settings { hand_stiffness_n_per_m: Some(stiffness), ..settings };
        let mechanics = source.build(problem.clone(), settings)?;
        let gauge = TensionGauge::over(problem.cable.breaking_time_s);
        let piece = CablePiece::new(mechanics, CablePart::whole(&problem), gauge);
        let targets = Targets { supports: vec![None; problem.supports.len()], robot_pose: None };
        let too_fast = problem.supports.iter().find_map(too_fast);
        Ok(Self {
            too_fast,
            leaves_reach: false,
            problem,
            source,
            settings,
            pieces: vec![piece],
            breaks: Vec::new(),
            former_energy: None,
            targets,
            peaks: None,
            peaks_since_s: 0.0,
        })
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

    /// Number of pieces of the cable.
    fn count_pieces(&self) -> usize {
        self.pieces.iter().map(|p| 1 + p.breaks.len()).sum()
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

    /// From now on a support follows a place.
    pub fn drag_support(&mut self, support: usize, target_m: Vec2) {
        self.draw_support(support, SupportTarget { place_m: target_m, grip: SupportGrip::Rigid });
    }

    /// From now on a hand pulls a support by a spring.
    pub fn pull_support(&mut self, support: usize, hand_m: Vec2) {
        self.draw_support(support, SupportTarget { place_m: hand_m, grip: SupportGrip::Spring });
    }

    /// Passes the target of a dragged support to the piece that it holds.
    fn draw_support(&mut self, support: usize, target: SupportTarget) {
        if !target.place_m.iter().all(|c| c.is_finite()) {
            return;
        }
        if let Some(known) = self.targets.supports.get_mut(support) {
            *known = Some(target);
        }
        self.leaves_reach = true;
        for piece in &mut self.pieces {
            if let Some(own) = piece.part.supports.iter().position(|k| *k == Some(support)) {
                target.draw(piece.mechanics.as_mut(), own);
            }
        }
    }

    /// Sends supports that an edit placed elsewhere on, for `dt_s`.
    fn place_supports(&mut self, dt_s: f64, inertia: Inertia) {
        for k in 0..self.targets.supports.len() {
            if let Some(next) = self.targets.supports.get(k).copied().flatten().and_then(|t| t.after(dt_s, inertia)) {
                self.draw_support(k, next);
            }
        }
    }

    /// Leads the outline of the robot: it goes there in the next advance.
    pub(crate) fn set_robot_pose(&mut self, to: RigidPose) {
        self.targets.robot_pose = Some(to);
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

    /// Returns the action of all pieces on the outline of the robot; None where no model knows of
    /// it.
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

    /// Returns its force on a support now, N.
    pub(crate) fn force_on_support(&self, support: usize) -> Vec2 {
        let r = self.reaction(support);
        Vec2::new(r.reaction_x_n, r.reaction_y_n)
    }

    /// A copy to go back to.
    pub(crate) fn checkpoint(&self) -> Self {
        self.with(self.pieces.iter().map(CablePiece::checkpoint).collect())
    }

    /// Becomes what it was when `kept` was copied from it.
    pub(crate) fn restore(&mut self, copy: &Self) {
        let mut own: Vec<Option<OwnedResources>> = self.pieces.iter_mut().map(|p| p.mechanics.lend()).collect();
        own.resize_with(copy.pieces.len(), || None);
        // Pieces of a break since then have nothing of the whole.
        let same = self.breaks.len() == copy.breaks.len() && Arc::ptr_eq(&self.problem, &copy.problem);
        *self = copy.checkpoint();
        for (piece, own) in self.pieces.iter_mut().zip(own) {
            piece.mechanics.borrow(own.filter(|_| same));
        }
    }
}

impl Clone for SimulatedCable {
    fn clone(&self) -> Self {
        self.with(self.pieces.clone())
    }
}

impl SimulatedCable {
    /// A copy with copies of its pieces.
    fn with(&self, pieces: Vec<CablePiece>) -> Self {
        Self {
            problem: self.problem.clone(),
            source: self.source.clone(),
            settings: self.settings,
            pieces,
            breaks: self.breaks.clone(),
            former_energy: self.former_energy,
            targets: self.targets.clone(),
            peaks: self.peaks,
            peaks_since_s: self.peaks_since_s,
            too_fast: self.too_fast.clone(),
            leaves_reach: self.leaves_reach,
        }
    }
}

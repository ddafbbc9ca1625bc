//! This module computes the forces of a loose cable on its ends and obstacles, and its lengths that
//! hang and lie.

use crate::math::Vec2;
use crate::model::spans::boundary::{LooseSection, SlackForm, SlackPart};
use crate::model::spans::section::SolveContext;
use crate::model::spans::slack::upper_surfaces::NONE_M;

impl LooseSection {
    /// Force in the cable at a support, N.
    pub fn end_force(&self, context: &SolveContext, side: usize) -> Vec2 {
        let part = if side == 0 { self.parts.first() } else { self.parts.last() };
        part.map_or_else(Vec2::zeros, |part| part.force(context, side))
    }

    /// Force with which obstacles carry it, N.
    pub fn obstacle_force(&self, context: &SolveContext) -> Vec2 {
        let ends = [0, 1].map(|side| self.end_force(context, side));
        let s = self.parts.first().zip(self.parts.last()).map_or(0.0, |(a, b)| b.arc_lengths[1] - a.arc_lengths[0]);
        ends[0] - ends[1] - context.law.load * s - self.drawn
    }

    /// Greatest friction force on the lying cable, N.
    pub fn friction(&self, context: &SolveContext) -> f64 {
        let press = |p: &SlackPart| p.obstacle_force(context).norm() * p.form.friction(context);
        self.parts.iter().map(press).sum()
    }

    /// True if no lying cable has tension. (A section drawn over crests, or with all its surplus
    /// heaped in a kink, is nearly equal to a section under very small tension, which can be
    /// followed as it moves.)
    pub fn spreads(&self) -> bool {
        let is_slack = |p: &SlackPart| matches!(p.form, SlackForm::Hangs(_)) || p.is_loose();
        self.parts.iter().all(is_slack)
            && self.parts.iter().any(|p| p.is_loose() && p.arc_lengths[1] - p.arc_lengths[0] > NONE_M)
    }

    /// Material that hangs, m.
    pub(super) fn hangs(&self) -> f64 {
        self.parts
            .iter()
            .filter(|p| matches!(p.form, SlackForm::Hangs(_)))
            .map(|p| p.arc_lengths[1] - p.arc_lengths[0])
            .sum()
    }

    /// Material that lies, and the length of ground it lies on, m.
    pub fn lying_lengths(&self, context: &SolveContext) -> [f64; 2] {
        let lying = self.parts.iter().filter(|p| p.is_loose() || matches!(p.form, SlackForm::Heap(_)));
        lying.fold([0.0; 2], |[material, ground], p| {
            let way = if let SlackForm::Lies(s) = &p.form {
                (s.coordinates[1] - s.coordinates[0]) * s.place(context, s.coordinates[0]).stretch
            } else {
                0.0
            };
            [material + p.arc_lengths[1] - p.arc_lengths[0], ground + way]
        })
    }
}

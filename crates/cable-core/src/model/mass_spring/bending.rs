//! This module adds the bending forces of the chain (see [`crate::energy::bending`]). A pulley
//! bends the cable without a moment of its own.

use crate::energy::Energy;
use crate::energy::bending::{BendingEnergy, ClampBend};
use crate::math::Vec2;
use crate::model::mass_spring::MassSpringModel;
use crate::scene::SupportKind;

impl MassSpringModel {
    /// The direction a clamp gives at a node now.
    pub(super) fn clamp_at(&self, node: usize) -> Option<Vec2> {
        let k = self.chain.node_of.iter().position(|&n| n == node)?;
        let support = &self.problem.supports[k];
        let angle = support.angle.filter(|_| support.kind == SupportKind::Clamped && self.drives.held[node])?;
        Some(Vec2::new(angle.cos(), angle.sin()))
    }

    /// The bend at an inner node, if it resists.
    pub(super) fn bend_at(&self, n: usize) -> Option<BendingEnergy> {
        let inner = n > 0 && n + 1 < self.chain.x.len() && self.wheels.pulley_at[n].is_none();
        inner.then(|| BendingEnergy {
            stiffness: self.problem.bending_stiffness,
            length: 0.5 * (self.chain.rest[n - 1] + self.chain.rest[n]),
            from: 0.0,
        })
    }

    /// The bend of element `e` against a clamp at one of its ends.
    pub(super) fn clamp_bend(&self, e: usize, direction: Vec2) -> ClampBend {
        ClampBend { stiffness: self.problem.bending_stiffness, length: 0.5 * self.chain.rest[e], direction, from: 0.0 }
    }

    /// Adds the forces of bending.
    pub(super) fn bend(&mut self) {
        if !(self.problem.bending_stiffness > 0.0) {
            return;
        }
        for n in 0..self.chain.x.len() {
            if let Some(direction) = self.clamp_at(n) {
                for e in n.saturating_sub(1)..(n + 1).min(self.chain.rest.len()) {
                    let g = self.clamp_bend(e, direction).gradient(&[self.chain.x[e], self.chain.x[e + 1]]);
                    self.chain.f[e] -= g[0];
                    self.chain.f[e + 1] -= g[1];
                }
            } else if let Some(bend) = self.bend_at(n) {
                let g = bend.gradient(&[self.chain.x[n - 1], self.chain.x[n], self.chain.x[n + 1]]);
                for (j, g) in g.iter().enumerate() {
                    self.chain.f[n - 1 + j] -= *g;
                }
            }
        }
    }
}

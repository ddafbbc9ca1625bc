//! A contact pair is a node, or the inside of a segment, near a feature of an obstacle.

use crate::contact::barrier::Barrier;
use crate::contact::obstacle_pairs::Pair;
use crate::math::Vec2;

/// One contact pair of the mesh: a node, or the inside of a segment (from `node` to `node + 1`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPair {
    /// Node, or first node of the segment.
    pub node: usize,
    /// True if the segment touches (a corner or a circle) between its nodes.
    pub on_segment: bool,
    /// The pair that the search found.
    pub pair: Pair,
}

impl ContactPair {
    /// Weights of the two nodes that carry it.
    #[inline]
    #[must_use]
    pub fn shares(&self) -> [f64; 2] {
        if self.on_segment { [1.0 - self.pair.gap.fraction, self.pair.gap.fraction] } else { [1.0, 0.0] }
    }

    /// The fraction of its force that acts on material nodes, for which `moves` is true.
    #[must_use]
    pub fn material_share(&self, moves: impl Fn(usize) -> bool) -> f64 {
        let [a, b] = self.shares();
        (if moves(self.node) { a } else { 0.0 }) + (if b != 0.0 && moves(self.node + 1) { b } else { 0.0 })
    }

    /// A field's value at the touching point.
    #[inline]
    #[must_use]
    pub fn interpolate(&self, x: &[Vec2]) -> Vec2 {
        let [a, b] = self.shares();
        if self.on_segment { x[self.node] * a + x[self.node + 1] * b } else { x[self.node] }
    }

    /// Direction in which friction acts: the normal turned clockwise.
    #[inline]
    #[must_use]
    pub fn tangent(&self) -> Vec2 {
        Vec2::new(self.pair.gap.normal.y, -self.pair.gap.normal.x)
    }

    /// Normal force, N.
    #[inline]
    #[must_use]
    pub fn load(&self, barrier: &Barrier) -> f64 {
        -barrier.at(self.pair.gap.gap_m).slope * self.pair.weight
    }
}

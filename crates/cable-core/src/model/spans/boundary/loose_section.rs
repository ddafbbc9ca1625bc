//! This module describes a section without tension as a row of parts that hang, lie, or rest in a
//! heap.

use crate::math::Vec2;

/// A section without tension.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::model::spans) struct LooseSection {
    pub parts: Vec<SlackPart>,
    /// Dead loads on free ends that lie, N.
    pub drawn: Vec2,
}

/// A part of it, in order along the cable.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::model::spans) struct SlackPart {
    /// Material at its ends, m.
    pub arc_lengths: [f64; 2],
    /// Tension at its ends, N.
    pub tension: [f64; 2],
    pub form: SlackForm,
}

/// The form of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) enum SlackForm {
    /// It hangs plumb, from one point to another.
    Hangs([Vec2; 2]),
    /// It lies on a piece of a boundary.
    Lies(LyingStretch),
    /// It is heaped in one place.
    Heap(Heap),
    /// It spans freely between a support and a crest, with tension: from a point, with a force in
    /// the cable there (N).
    Spans { from: Vec2, force: Vec2 },
}

/// A stretch of a boundary between two coordinates, with the mobilised friction coefficient against
/// forward motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct LyingStretch {
    pub curve: usize,
    pub piece: i64,
    pub coordinates: [f64; 2],
    pub mobilised: f64,
}

/// A heap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct Heap {
    pub at: Vec2,
    /// The edges that carry it.
    pub edges: [Option<BearingEdge>; 2],
}

/// The share of a heap that an edge carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct BearingEdge {
    /// Index of the boundary.
    pub curve: usize,
    pub normal: Vec2,
    /// Force on the cable along the normal and along the boundary, N.
    pub press: f64,
    pub friction: f64,
    pub tangent: Vec2,
}

impl BearingEdge {
    pub fn force(&self) -> Vec2 {
        self.normal * self.press + self.tangent * self.friction
    }
}

//! Cable that lies without tension is a row of parts that hang, lie, or rest in a heap.

use crate::math::Vec2;

/// A section that lies without tension.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::model::spans) struct LooseSection {
    pub parts: Vec<SlackPart>,
    /// Dead loads on free ends, which lie, N.
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

/// The line on which a part is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) enum SlackForm {
    /// Plumb, from one point to another.
    Hangs([Vec2; 2]),
    /// On a piece of a boundary.
    Lies(LyingStretch),
    /// In one place.
    Heap(Heap),
    /// Free between a support and a crest, with tension: from a point, with a force in the cable
    /// there (N).
    Spans { from: Vec2, force: Vec2 },
}

/// A stretch of a boundary between two coordinates, with the friction that is mobilised against
/// going on, as a coefficient.
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

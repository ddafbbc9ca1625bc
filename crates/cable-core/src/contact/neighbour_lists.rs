//! A neighbour list (Verlet list) remembers the parts of obstacles that a segment of a chain can
//! come near to while the chain moves little.
//!
//! A search of the trees for every segment, in every iteration of a step, costs more than the
//! step's equations. So each segment keeps a list of all parts within R of the box of its ends a₀,
//! b₀. The list answers a query of the segment (a, b) with the reach r as long as
//! ```text
//! max(|a − a₀|, |b − b₀|) + r ≤ R
//! ```
//! since every point of it is then within R − r of the box. Else the trees are asked: the list
//! never decides what is found.
//!
//! Most segments whose list holds parts are still clear of them. So the gap G from the nearest of
//! them is measured once a step, with the ends of the segment at a₁, b₁, and nothing is within r of
//! the segment as long as
//! ```text
//! max(|a − a₁|, |b − b₁|) + r < G
//! ```

use super::distance::{point_segment, segment_segment};
use super::geometry::{Geometry, ObstaclePart};
use crate::math::{Vec2, smaller};

/// Allowance for the rounding of a gap, m: a segment is clear only by more than this.
const GAP_ROUNDING: f64 = 1e-9;

/// The list of one segment.
#[derive(Clone, Copy, Debug)]
struct NeighbourList {
    ends: [Vec2; 2],
    within: f64,
    first: usize,
    /// Ends of the segment when its gap was measured, m.
    measured: [Vec2; 2],
    /// The gap of the segment at that time, m.
    gap: f64,
}

impl NeighbourList {
    /// Returns whether a segment whose ends pass through all these places (m) is never within
    /// `reach` (m) of anything.
    #[inline]
    fn is_clear<const N: usize>(&self, at: [[Vec2; 2]; N], reach: f64) -> bool {
        stays_within(self.gap - reach - GAP_ROUNDING, self.measured, at)
    }
}

/// Returns whether all these places (m) of the ends of a segment are within `room` (m) of their
/// former place.
#[inline]
fn stays_within<const N: usize>(room: f64, from: [Vec2; 2], at: [[Vec2; 2]; N]) -> bool {
    let inside = |p: Vec2, from: Vec2| room > 0.0 && (p - from).norm_squared() <= room * room;
    at.iter().all(|ends| inside(ends[0], from[0]) && inside(ends[1], from[1]))
}

/// The lists of all segments of a chain, by their number.
#[derive(Clone, Debug, Default)]
pub struct NeighbourLists {
    entries: Vec<NeighbourList>,
    parts: Vec<ObstaclePart>,
}

impl NeighbourLists {
    /// Forgets all lists.
    pub fn clear(&mut self) {
        self.entries.clear();
        self.parts.clear();
    }

    /// Reserves memory for this many lists of one part each.
    pub(crate) fn reserve(&mut self, lists: usize) {
        self.entries.reserve(lists);
        self.parts.reserve(lists);
    }

    /// Number of lists.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Appends the list of the next segment: all parts within `within` (m) of the box of its ends.
    pub fn push(&mut self, geometry: &Geometry, ends: [Vec2; 2], within: f64) {
        let [a, b] = ends;
        self.entries.push(NeighbourList { ends, within, first: self.parts.len(), measured: ends, gap: within });
        self.parts.extend(geometry.parts(a.inf(&b), a.sup(&b), within));
        self.measure(geometry, self.entries.len() - 1, ends);
    }

    /// Measures the gap of segment `e`, with its ends at `ends` (m), from the parts on its list.
    pub fn measure(&mut self, geometry: &Geometry, e: usize, ends: [Vec2; 2]) {
        let parts = self.parts_of(e);
        if parts.is_empty() {
            return;
        }
        let gaps = parts.iter().map(|part| gap(geometry, *part, ends));
        let nearest = gaps.fold(f64::INFINITY, smaller);
        let Some(entry) = self.entries.get_mut(e) else { return };
        let moved = [0, 1].map(|k| (ends[k] - entry.ends[k]).norm_squared());
        let unlisted = entry.within - if moved[0] > moved[1] { moved[0] } else { moved[1] }.sqrt();
        (entry.measured, entry.gap) = (ends, smaller(nearest, unlisted));
    }

    #[inline]
    fn parts_of(&self, e: usize) -> &[ObstaclePart] {
        let Some(entry) = self.entries.get(e) else { return &[] };
        let end = self.entries.get(e + 1).map_or(self.parts.len(), |next| next.first);
        self.parts.get(entry.first..end).unwrap_or_default()
    }

    /// Returns whether segment `e`, whose ends pass through all these places (m), is known never to
    /// be within `reach` (m) of anything.
    #[inline]
    #[must_use]
    pub fn is_clear<const N: usize>(&self, e: usize, at: [[Vec2; 2]; N], reach: f64) -> bool {
        self.entries.get(e).is_some_and(|entry| entry.is_clear(at, reach))
    }

    /// The list of segment `e` if it holds all parts within `reach` (m) of the segment at each of
    /// the places `at` (m) of its ends; an empty list if it is known that there are none.
    #[inline]
    #[must_use]
    pub fn of<const N: usize>(&self, e: usize, at: [[Vec2; 2]; N], reach: f64) -> Option<&[ObstaclePart]> {
        if self.entries.get(e)?.is_clear(at, reach) { Some(&[]) } else { self.listed(e, at, reach) }
    }

    /// Does the same as `of`, without use of the measured gap of the segment.
    #[inline]
    #[must_use]
    pub fn listed<const N: usize>(&self, e: usize, at: [[Vec2; 2]; N], reach: f64) -> Option<&[ObstaclePart]> {
        let entry = self.entries.get(e)?;
        stays_within(entry.within - reach, entry.ends, at).then(|| self.parts_of(e))
    }
}

/// Gap of a segment from a part, m.
fn gap(geometry: &Geometry, part: ObstaclePart, [a, b]: [Vec2; 2]) -> f64 {
    let Some(body) = geometry.bodies().get(part.body) else { return f64::INFINITY };
    let distance = match (part.edge.and_then(|k| body.edges.get(k)), body.center) {
        (Some(e), _) => segment_segment(a, b, e.from, e.to),
        (None, Some(c)) => point_segment(c, a, b),
        (None, None) => return f64::INFINITY,
    };
    distance - body.offset
}

#[cfg(test)]
mod tests {
    use super::super::obstacle_pairs::Pair;
    use super::*;
    use crate::scene::{Obstacle, Shape};
    use proptest::prelude::*;

    fn world() -> Geometry {
        let shapes = [
            Shape::Terrain { points_m: (0..40).map(|k| [0.25 * f64::from(k), 0.3 * f64::from(k * 7 % 5)]).collect() },
            Shape::Circle { center_m: [4.0, 2.0], radius_m: 0.4 },
            Shape::Polyline { points_m: vec![[2.0, 3.0], [5.0, 3.2], [6.0, 2.4]], thickness_m: 0.05 },
        ];
        let obstacles: Vec<Obstacle> =
            shapes.map(|shape| Obstacle { name: "o".to_owned(), shape, friction: None }).into();
        Geometry::new(&obstacles, 0.5, 0.01)
    }

    fn sorted(mut pairs: Vec<Pair>) -> Vec<(usize, u64, u64)> {
        pairs.sort_by_key(|p| (p.gap.feature, p.gap.gap_m.to_bits()));
        pairs.iter().map(|p| (p.gap.feature, p.gap.gap_m.to_bits(), p.weight.to_bits())).collect()
    }

    proptest! {
        /// A list gives the same answers as the trees: the pairs of nodes and segments, and the
        /// free fractions of a move.
        #[test]
        fn lists_find_what_the_trees_find(
            at in (0.0f64..9.0, 0.5f64..4.0), length in (-0.6f64..0.6, -0.6f64..0.6),
            moves in prop::array::uniform4((-0.4f64..0.4, -0.4f64..0.4)), within in 0.05f64..0.8, reach in 0.01f64..0.3,
        ) {
            let geometry = world();
            let moves = moves.map(|(x, y)| Vec2::new(x, y));
            let a = Vec2::new(at.0, at.1);
            let ends = [a, a + Vec2::new(length.0, length.1)];
            let mut near = NeighbourLists::default();
            near.push(&geometry, ends, within);
            let now = [ends[0] + moves[0], ends[1] + moves[1]];
            let then = [now[0] + moves[2], now[1] + moves[3]];
            if let Some(parts) = near.of(0, [now], reach) {
                let (mut listed, mut found) = (Vec::new(), Vec::new());
                let chain = [None, Some(now[0]), Some(now[1])];
                geometry.node_pairs_among(parts.iter().copied(), &chain, reach, &mut |p| listed.push(p));
                geometry.segment_pairs_among(parts.iter().copied(), now, reach, &mut |p| listed.push(p));
                geometry.node_pairs(None, now[0], Some(now[1]), reach, &mut |p| found.push(p));
                geometry.segment_pairs(now[0], now[1], reach, &mut |p| found.push(p));
                prop_assert_eq!(sorted(listed), sorted(found));
            }
            let sweep = super::super::sweep::Sweep::new(now, then, 0.2);
            if let Some(parts) = near.of(0, [now, then], sweep.margin) {
                let listed = geometry.free_fraction_among(parts.iter().copied(), &sweep, [None; 2]);
                prop_assert!((listed - geometry.free_fraction(now, then, 0.2)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn what_moved_too_far_is_not_answered() {
        let mut near = NeighbourLists::default();
        near.push(&world(), [Vec2::new(1.0, 2.0), Vec2::new(1.5, 2.0)], 0.3);
        let moved = |by: f64| [Vec2::new(1.0, 2.0 + by), Vec2::new(1.5, 2.0)];
        assert!(near.of(0, [moved(0.19)], 0.1).is_some());
        assert!(near.of(0, [moved(0.21)], 0.1).is_none());
        assert!(near.of(0, [moved(0.1), moved(0.25)], 0.1).is_none());
        assert!(near.of(0, [moved(f64::NAN)], 0.1).is_none());
        assert!(near.of(1, [moved(0.0)], 0.1).is_none());
    }
}

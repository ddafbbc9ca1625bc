//! A terrain or beam is refused if its line crosses or touches itself: it then has no inside and
//! outside.
//!
//! Boxes of ever longer runs of edges form a binary tree; pairs of runs whose boxes lie apart
//! cannot meet. The boxes have eight sides (x, y, x + y, x − y), so that slanting combs come apart
//! too.

use crate::math::Point;
use crate::scene::LineEnds;

/// Edges in a leaf. Fewer: more boxes. More: more pairs of edges to look at.
const LEAF_EDGES: usize = 4;
/// Pairs of boxes looked at before a line is given up as too tangled, about a second's work. A
/// million points of rough ground take 1e7.
const MAX_PAIRS: usize = 60_000_000;

/// Kind of a line's contact with itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineSelfTouch {
    /// These edges cross, touch or lie on each other; edge k goes from point k to the next.
    Edges(usize, usize),
    /// Too many edges lie too close together to tell.
    Tangled,
}

/// Least and greatest along x, y, x + y, x − y.
type Sides = [[f64; 2]; 4];

struct EdgeTree<'a> {
    points: &'a [Point],
    edges: usize,
    closed: bool,
    /// Binary tree from 1: the children of k are 2k and 2k + 1, the leaves the last half.
    boxes: Vec<Sides>,
}

/// The first crossing that is found, if any. A closed line has an edge from its last point to its
/// first.
pub(super) fn first_self_touch(points: &[Point], ends: LineEnds) -> Option<LineSelfTouch> {
    let rises = |axis: usize| points.windows(2).all(|w| w[1][axis] > w[0][axis]);
    if ends == LineEnds::Open && (rises(0) || rises(1)) {
        return None;
    }
    EdgeTree::new(points, ends).search()
}

impl<'a> EdgeTree<'a> {
    /// The line with a binary tree of octagons about its edges.
    fn new(points: &'a [Point], ends: LineEnds) -> Self {
        let closed = ends == LineEnds::Joined;
        let edges = if closed { points.len() } else { points.len().saturating_sub(1) };
        let leaves = edges.div_ceil(LEAF_EDGES).next_power_of_two();
        let mut line = Self { points, edges, closed, boxes: vec![[[f64::INFINITY, f64::NEG_INFINITY]; 4]; 2 * leaves] };
        for edge in 0..edges {
            let (from, to) = line.edge(edge);
            let sides = &mut line.boxes[leaves + edge / LEAF_EDGES];
            for [x, y] in [from, to] {
                for (side, value) in sides.iter_mut().zip([x, y, x + y, x - y]) {
                    *side =
                        [if value < side[0] { value } else { side[0] }, if value > side[1] { value } else { side[1] }];
                }
            }
        }
        for k in (1..leaves).rev() {
            let (a, b) = (line.boxes[2 * k], line.boxes[2 * k + 1]);
            for (i, side) in line.boxes[k].iter_mut().enumerate() {
                *side = [
                    if a[i][0] < b[i][0] { a[i][0] } else { b[i][0] },
                    if a[i][1] > b[i][1] { a[i][1] } else { b[i][1] },
                ];
            }
        }
        line
    }

    fn edge(&self, k: usize) -> (Point, Point) {
        (self.points[k], self.points[if k + 1 < self.points.len() { k + 1 } else { 0 }])
    }

    /// The first two edges that touch, searched for by pairs of boxes that overlap.
    fn search(&self) -> Option<LineSelfTouch> {
        let leaves = self.boxes.len() / 2;
        let mut pairs = vec![(1, 1)];
        let mut seen = 0;
        while let Some((a, b)) = pairs.pop() {
            seen += 1;
            if seen > MAX_PAIRS {
                return Some(LineSelfTouch::Tangled);
            }
            let apart =
                |i: usize| self.boxes[a][i][1] < self.boxes[b][i][0] || self.boxes[b][i][1] < self.boxes[a][i][0];
            if a != b && (0..4).any(apart) {
                continue;
            }
            if a < leaves {
                pairs.extend([(2 * a, 2 * b), (2 * a, 2 * b + 1), (2 * a + 1, 2 * b + 1)]);
                if a != b {
                    pairs.push((2 * a + 1, 2 * b));
                }
            } else if let Some(found) = self.leaves_meet(a - leaves, b - leaves) {
                return Some(found);
            }
        }
        None
    }

    /// The first two edges of two leaves that touch.
    fn leaves_meet(&self, a: usize, b: usize) -> Option<LineSelfTouch> {
        for i in a * LEAF_EDGES..self.edges.min((a + 1) * LEAF_EDGES) {
            for j in (b * LEAF_EDGES).max(i + 1)..self.edges.min((b + 1) * LEAF_EDGES) {
                if self.edges_meet(i, j) {
                    return Some(LineSelfTouch::Edges(i, j));
                }
            }
        }
        None
    }

    /// Returns whether two edges meet, i < j; neighbours share a point and meet where they turn
    /// back on themselves.
    fn edges_meet(&self, i: usize, j: usize) -> bool {
        let ((a, b), (c, d)) = (self.edge(i), self.edge(j));
        if j == i + 1 {
            turns_back(b, a, d)
        } else if self.closed && i == 0 && j + 1 == self.edges {
            turns_back(a, b, c)
        } else {
            meet(a, b, c, d)
        }
    }
}

/// Twice the area of the triangle, m², positive counter-clockwise.
fn turn(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn turns_back(corner: Point, a: Point, b: Point) -> bool {
    let along = (a[0] - corner[0]) * (b[0] - corner[0]) + (a[1] - corner[1]) * (b[1] - corner[1]);
    turn(corner, a, b) == 0.0 && along > 0.0
}

/// True if the segments from `a` to `b` and from `c` to `d` touch.
fn meet(a: Point, b: Point, c: Point, d: Point) -> bool {
    let (c_side, d_side, a_side, b_side) = (turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b));
    let between = |side: f64, p: Point, from: Point, to: Point| {
        side == 0.0 && (0..2).all(|k| (p[k] >= from[k].min(to[k])) && p[k] <= from[k].max(to[k]))
    };
    let opposite = |s: f64, t: f64| (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0);
    (opposite(c_side, d_side) && opposite(a_side, b_side))
        || between(c_side, c, a, b)
        || between(d_side, d, a, b)
        || between(a_side, a, c, d)
        || between(b_side, b, c, d)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_touches_and_folds_are_found() {
        let bow: &[Point] = &[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
        assert_eq!(first_self_touch(bow, LineEnds::Joined), Some(LineSelfTouch::Edges(0, 2)));
        assert_eq!(first_self_touch(bow, LineEnds::Open), Some(LineSelfTouch::Edges(0, 2)));
        // Through a corner, onto an edge, back on itself, back on itself where it closes, along
        // another edge.
        let through = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [2.0, 1.0], [2.0, -1.0], [1.0, 0.0], [0.5, -1.0]];
        assert!(first_self_touch(&through, LineEnds::Joined).is_some());
        let onto = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]];
        assert_eq!(first_self_touch(&onto, LineEnds::Joined), Some(LineSelfTouch::Edges(0, 2)));
        assert_eq!(
            first_self_touch(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]], LineEnds::Open),
            Some(LineSelfTouch::Edges(0, 1))
        );
        let at_close = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0]];
        assert!(first_self_touch(&at_close, LineEnds::Joined).is_some());
        let along = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [3.0, 1.0], [3.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
        assert!(first_self_touch(&along, LineEnds::Open).is_some());
    }

    #[test]
    fn overhangs_steps_slots_and_straight_runs_are_not_crossings() {
        let overhang = [[0.0, 0.0], [4.0, 0.0], [3.0, 1.0], [6.0, 1.0], [5.0, 0.0], [9.0, 0.0]];
        assert_eq!(first_self_touch(&overhang, LineEnds::Open), None);
        let slot = [[0.0, 0.0], [1.0, 0.0], [1.0, -5.0], [1.0 + 1e-9, -5.0], [1.0 + 1e-9, 0.0], [2.0, 0.0]];
        assert_eq!(first_self_touch(&slot, LineEnds::Open), None);
        let spike = [[0.0, 0.0], [1.0, 0.0], [1.0 + 1e-12, 9.0], [1.0 + 2e-12, 0.0], [2.0, 0.0]];
        assert_eq!(first_self_touch(&spike, LineEnds::Open), None);
        let straight = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        assert_eq!(first_self_touch(&straight, LineEnds::Joined), None);
        assert_eq!(first_self_touch(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], LineEnds::Joined), None);
        for few in [&[][..], &[[0.0, 0.0]][..], &[[0.0, 0.0], [1.0, 0.0]][..]] {
            assert_eq!(first_self_touch(few, LineEnds::Open), None);
        }
    }

    /// Against every pair of edges, on random lines.
    #[test]
    fn the_tree_finds_what_every_pair_finds() {
        let mut seed: u64 = 7;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from((seed >> 40) as u32) / f64::from(1_u32 << 24)
        };
        let mut crossed = 0;
        for case in 0..2000 {
            let n = 3 + case % 60;
            // A walk that mostly goes right: about half of them cross.
            let mut at = [0.0, 0.0];
            let points: Vec<Point> = (0..n)
                .map(|_| {
                    at = [at[0] + random() - 0.25, at[1] + random() - 0.5];
                    at
                })
                .collect();
            for ends in [LineEnds::Open, LineEnds::Joined] {
                let line = EdgeTree::new(&points, ends);
                let any = (0..line.edges).any(|i| (i + 1..line.edges).any(|j| line.edges_meet(i, j)));
                let found = first_self_touch(&points, ends);
                assert_eq!(found.is_some(), any, "{points:?}");
                if let Some(LineSelfTouch::Edges(i, j)) = found {
                    assert!(line.edges_meet(i, j));
                }
                crossed += usize::from(any);
            }
        }
        assert!(crossed > 400 && crossed < 3600, "{crossed}");
    }

    #[test]
    fn combs_of_many_long_teeth_end() {
        // Long teeth side by side, upright and slanting, without a crossing; and a spider's web
        // that is given up or found.
        for slant in [0.0, 1.0, 0.3] {
            let comb: Vec<Point> = (0..100_000)
                .map(|k| {
                    let (x, y) = (f64::from(k) * 1e-3, if k % 2 == 0 { 0.0 } else { 100.0 });
                    [x + slant * y, y]
                })
                .collect();
            assert!(
                !matches!(first_self_touch(&comb, LineEnds::Joined), Some(LineSelfTouch::Edges(i, j)) if j + 1 < comb.len() && i > 0)
            );
        }
    }
}

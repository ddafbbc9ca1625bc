//! This search finds every crossing of a line with itself, in order.
//!
//! Boxes of ever longer runs of segments form a binary tree; two runs whose boxes lie apart cannot
//! cross. A line that does not fill the plane is searched in O(n log n + crossings).

use crate::math::{Vec2, cross};

/// Segments in a leaf. Fewer segments mean more boxes, more segments mean more pairs to test.
const LEAF_SEGMENTS: usize = 4;

/// A crossing of segment `first` with the later segment `second`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SelfCrossing {
    /// Index of a segment.
    pub first: usize,
    /// Index of a later one.
    pub second: usize,
    /// Position on each of them, from 0 (included) to 1 (excluded), so that a crossing at a joint
    /// is found once.
    pub fractions: [f64; 2],
    /// Sine of the angle between them.
    pub sine: f64,
}

/// The lowest and the highest corner of the box round a run of segments, m.
type BoundingBox = [Vec2; 2];

/// All crossings of the segments `points[k]`–`points[k + 1]`, ordered by first and second segment.
/// `joined(k)` tells whether segment k exists; it does not at a break of the line.
pub(crate) fn crossings(points: &[Vec2], joined: impl Fn(usize) -> bool) -> Vec<SelfCrossing> {
    let segments = points.len().saturating_sub(1);
    // A line that always advances in one direction does not come back.
    let goes_on = |way: fn(&[Vec2]) -> f64| points.windows(2).all(|w| way(w) > 0.0);
    if goes_on(|w| w[1].x - w[0].x) || goes_on(|w| w[0].x - w[1].x) {
        return Vec::new();
    }
    let leaves = segments.div_ceil(LEAF_SEGMENTS).next_power_of_two();
    let boxes = boxes(points, segments, leaves);
    let apart = |a: usize, b: usize| {
        let ([a0, a1], [b0, b1]) = (boxes[a], boxes[b]);
        a1.x < b0.x || b1.x < a0.x || a1.y < b0.y || b1.y < a0.y
    };
    let mut out = Vec::new();
    let mut pairs = vec![(1, 1)];
    while let Some((a, b)) = pairs.pop() {
        if a != b && apart(a, b) {
            continue;
        }
        if a < leaves {
            pairs.extend([(2 * a, 2 * b), (2 * a, 2 * b + 1), (2 * a + 1, 2 * b + 1)]);
            if a != b {
                pairs.push((2 * a + 1, 2 * b));
            }
            continue;
        }
        let run = |leaf: usize| (leaf - leaves) * LEAF_SEGMENTS..segments.min((leaf - leaves + 1) * LEAF_SEGMENTS);
        for i in run(a).filter(|&i| joined(i)) {
            // Neighbours share a point and cannot cross.
            for j in run(b).filter(|&j| j > i + 1 && joined(j)) {
                out.extend(meet(points, i, j));
            }
        }
    }
    out.sort_by_key(|c: &SelfCrossing| (c.first, c.second));
    out
}

/// A binary tree of bounding boxes: the root at 1, the children of k at 2k and 2k + 1.
fn boxes(points: &[Vec2], segments: usize, leaves: usize) -> Vec<BoundingBox> {
    let empty = [Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY)];
    let mut boxes = vec![empty; 2 * leaves];
    for k in 0..segments {
        let b = &mut boxes[leaves + k / LEAF_SEGMENTS];
        for p in &points[k..k + 2] {
            *b = [b[0].inf(p), b[1].sup(p)];
        }
    }
    for k in (1..leaves).rev() {
        let (a, b) = (boxes[2 * k], boxes[2 * k + 1]);
        boxes[k] = [a[0].inf(&b[0]), a[1].sup(&b[1])];
    }
    boxes
}

/// p + t r = q + u s: t = (q − p)×s/(r×s), u = (q − p)×r/(r×s).
pub(crate) fn meet(points: &[Vec2], first: usize, second: usize) -> Option<SelfCrossing> {
    let (p, q) = (*points.get(first)?, *points.get(second)?);
    let (r, s) = (points.get(first + 1)? - p, points.get(second + 1)? - q);
    let area = cross(r, s);
    let (t, u) = (cross(q - p, s) / area, cross(q - p, r) / area);
    let inside = |f: f64| (0.0..1.0).contains(&f);
    let sine = area.abs() / (r.norm() * s.norm());
    (inside(t) && inside(u)).then_some(SelfCrossing { first, second, fractions: [t, u], sine })
}

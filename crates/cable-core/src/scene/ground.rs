//! The ground is the highest terrain of a scene; a rigid track rests on it. The ground under a
//! robot is level where the scene shows none: seen from above, and without terrain.

use super::obstacle::{Obstacle, Shape};
use crate::math::Point;

/// The terrains of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ground {
    stretches: Vec<[Point; 2]>,
    columns: Columns,
    /// Height of ground that is level everywhere and no obstacle, m.
    level: Option<f64>,
}

/// Lists of the stretches over each part of x, so that one place asks a few of them and not a
/// million.
#[derive(Clone, Debug, Default, PartialEq)]
struct Columns {
    /// Left end, m, and how wide each is, m.
    left: f64,
    width: f64,
    /// Start of the list of each column in `items`; one more at the end.
    starts: Vec<usize>,
    /// Indices of stretches.
    items: Vec<usize>,
}

/// Most columns for each stretch that a list may hold over all: ground that folds back over itself
/// many times would fill the memory with fine ones.
const MAX_STACK: usize = 4;

impl Columns {
    /// Sorts stretches of ground into columns of equal width.
    fn of(stretches: &[[Point; 2]]) -> Self {
        let ends = |k: usize| stretches.iter().flatten().map(move |p| p[k]);
        let left = ends(0).fold(f64::INFINITY, f64::min);
        let right = ends(0).fold(f64::NEG_INFINITY, f64::max);
        let mut count = stretches.len();
        loop {
            let width = (right - left) / count.max(1) as f64;
            let mut columns = Self { left, width, starts: vec![0; count + 1], items: Vec::new() };
            if count == 0 || !(width > 0.0 && width.is_finite()) {
                // A wall, or nothing: one column.
                columns.starts = vec![0, stretches.len()];
                columns.items = (0..stretches.len()).collect();
                return columns;
            }
            let total: usize = stretches.iter().map(|s| columns.range(s).count()).sum();
            if total > MAX_STACK * stretches.len() && count > 1 {
                count /= 2;
                continue;
            }
            columns.fill(stretches, total);
            return columns;
        }
    }

    /// Lists the stretches of each column, by counting sort.
    fn fill(&mut self, stretches: &[[Point; 2]], total: usize) {
        for s in stretches {
            for c in self.range(s) {
                self.starts[c + 1] += 1;
            }
        }
        for c in 1..self.starts.len() {
            self.starts[c] += self.starts[c - 1];
        }
        let mut next = self.starts.clone();
        self.items = vec![0; total];
        for (k, s) in stretches.iter().enumerate() {
            for c in self.range(s) {
                self.items[next[c]] = k;
                next[c] += 1;
            }
        }
    }

    /// The column of a place; those beyond the ends belong to the last ones.
    fn column(&self, x: f64) -> usize {
        (((x - self.left) / self.width) as usize).min(self.starts.len().saturating_sub(2))
    }

    fn range(&self, s: &[Point; 2]) -> std::ops::RangeInclusive<usize> {
        self.column(s[0][0].min(s[1][0]))..=self.column(s[0][0].max(s[1][0]))
    }

    /// Stretches that may lie over a part of x; one may come twice.
    fn over(&self, low: f64, high: f64) -> &[usize] {
        if self.starts.len() < 2 {
            return &[];
        }
        let (from, to) = (self.column(low), self.column(high));
        self.items.get(self.starts[from]..self.starts[to.max(from) + 1]).unwrap_or_default()
    }
}

/// Resting pose of a track.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stand {
    /// Height of its middle, m.
    pub height: f64,
    /// Its slope, rad, positive where it climbs to the right.
    pub pitch: f64,
}

impl Ground {
    /// The terrains among some obstacles.
    pub(super) fn of_obstacles(obstacles: &[Obstacle]) -> Self {
        let lines = obstacles.iter().filter_map(|o| match &o.shape {
            Shape::Terrain { points_m } => Some(points_m.as_slice()),
            _ => None,
        });
        Self::of_lines(lines)
    }

    fn of_lines<'a>(lines: impl Iterator<Item = &'a [Point]>) -> Self {
        let stretches: Vec<[Point; 2]> =
            lines.flat_map(|points| points.windows(2)).filter_map(|w| w.try_into().ok()).collect();
        Self { columns: Columns::of(&stretches), stretches, level: None }
    }

    /// Level ground of this height (m), or of this place across the way of what is seen from above.
    pub(super) fn level(height_m: f64) -> Self {
        Self { level: Some(height_m), ..Self::default() }
    }

    /// Returns whether there is none anywhere.
    pub(super) fn is_empty(&self) -> bool {
        self.stretches.is_empty() && self.level.is_none()
    }

    /// The height of the highest terrain at `x` (m), m; `None` if there is no terrain at `x`.
    #[must_use]
    pub fn height(&self, x: f64) -> Option<f64> {
        if self.level.is_some() {
            return self.level;
        }
        let near = self.columns.over(x, x).iter().filter_map(|k| self.stretches.get(*k));
        let heights = near.filter_map(|&[[ax, ay], [bx, by]]| {
            if !(ax.min(bx) <= x && x <= ax.max(bx)) {
                return None;
            }
            Some(if ax == bx { ay.max(by) } else { ay + (by - ay) * (x - ax) / (bx - ax) })
        });
        heights.reduce(f64::max)
    }

    /// Returns how a rigid track with its middle at `x` that reaches `half` to both sides (both m,
    /// measured level) rests.
    ///
    /// A rod on bumps touches two of them, one on each side of its centre of mass, and no ground is
    /// above it: it lies on that edge of the upper convex hull of the ground below it which spans
    /// its middle. `None` if the ground ends below the rod.
    #[must_use]
    pub fn stand(&self, x: f64, half: f64) -> Option<Stand> {
        if let Some(height) = self.level {
            return Some(Stand { height, pitch: 0.0 });
        }
        let (low, high) = (x - half, x + half);
        let mut points = vec![[low, self.height(low)?], [high, self.height(high)?]];
        let near = self.columns.over(low, high).iter().filter_map(|k| self.stretches.get(*k)).flatten();
        let inside = near.filter(|p| low < p[0] && p[0] < high);
        // Of ground under an overhang only the highest part is touched.
        points.extend(inside.filter_map(|p| Some([p[0], self.height(p[0])?])));
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let [a, b] = edge_over(&upper_hull(&points), x)?;
        let slope = (b[1] - a[1]) / (b[0] - a[0]);
        Some(Stand { height: a[1] + slope * (x - a[0]), pitch: slope.atan() })
    }
}

/// Corners of the upper convex hull of points in order of x (A. M. Andrew, "Another efficient
/// algorithm for convex hulls in two dimensions", Information Processing Letters 9(5), 1979).
fn upper_hull(points: &[Point]) -> Vec<Point> {
    let mut hull: Vec<Point> = Vec::with_capacity(points.len());
    for &p in points {
        while let [.., a, b] = hull.as_slice()
            && (b[0] - a[0]) * (p[1] - a[1]) >= (b[1] - a[1]) * (p[0] - a[0])
        {
            hull.pop();
        }
        hull.push(p);
    }
    hull
}

fn edge_over(hull: &[Point], x: f64) -> Option<[Point; 2]> {
    let edge = hull.windows(2).find(|w| w[0][0] <= x && x <= w[1][0] && w[0][0] < w[1][0])?;
    Some([edge[0], edge[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ground(points: &[Point]) -> Ground {
        Ground::of_lines(std::iter::once(points))
    }

    #[test]
    fn on_a_plane_it_has_the_plane_s_slope() {
        for slope in [-0.4, 0.0, 0.25] {
            let g = ground(&[[-10.0, -10.0 * slope], [10.0, 10.0 * slope]]);
            let s = g.stand(1.5, 0.6).unwrap();
            assert!((s.height - 1.5 * slope).abs() < 1e-12 && (s.pitch - f64::atan(slope)).abs() < 1e-12, "{s:?}");
        }
    }

    #[test]
    fn it_rests_on_a_bump_and_on_the_ground_behind_its_middle() {
        // A bump of 0.2 m half a metre ahead of the middle: the rod leans on it and on its own rear
        // end.
        let g = ground(&[[-5.0, 0.0], [0.45, 0.0], [0.5, 0.2], [0.55, 0.0], [5.0, 0.0]]);
        let s = g.stand(0.0, 0.6).unwrap();
        assert!((s.pitch - f64::atan(0.2 / 1.1)).abs() < 1e-12, "{s:?}");
        assert!((s.height - 0.6 * 0.2 / 1.1).abs() < 1e-12, "{s:?}");
    }

    #[test]
    fn it_bridges_a_ditch_and_ends_with_the_ground() {
        let g = ground(&[[-5.0, 1.0], [-0.2, 1.0], [0.0, -3.0], [0.2, 1.0], [5.0, 1.0]]);
        assert_eq!(g.stand(0.0, 0.6), Some(Stand { height: 1.0, pitch: 0.0 }));
        assert_eq!(g.stand(4.9, 0.6), None);
        assert_eq!(Ground::default().stand(0.0, 1.0), None);
    }

    proptest! {
        /// Nothing of the ground is above the rod, and it touches on both sides of its middle.
        #[test]
        fn nothing_is_above_the_rod(heights in prop::collection::vec(-1.0..1.0_f64, 12), x in 3.0..8.0_f64) {
            let points: Vec<Point> = heights.iter().enumerate().map(|(k, h)| [k as f64, *h]).collect();
            let g = ground(&points);
            let s = g.stand(x, 2.5).unwrap();
            let gap = |at: f64| s.height + s.pitch.tan() * (at - x) - g.height(at).unwrap();
            let places: Vec<f64> = points.iter().map(|p| p[0]).chain([x - 2.5, x + 2.5]).filter(|at| (at - x).abs() < 2.5 + 1e-9).collect();
            prop_assert!(places.iter().all(|at| gap(*at) > -1e-9));
            prop_assert!(places.iter().any(|at| *at <= x && gap(*at) < 1e-9));
            prop_assert!(places.iter().any(|at| *at >= x && gap(*at) < 1e-9));
        }
    }
}

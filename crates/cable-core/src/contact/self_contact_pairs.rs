//! Self-contact pairs the nodes of a cable with its own segments.
//!
//! A line in the plane can only cross itself where a node passes a segment, so pairs of nodes and
//! segments are sufficient. As with obstacles, nodes where two segments meet enter by inclusion and
//! exclusion (see `obstacle_pairs`), so that the sum is one barrier along a straight stretch and is
//! continuous round a bend.
//!
//! Gaps are distances of centre lines less one diameter. Two places whose arc lengths differ by
//! less than the cable needs to bend back on itself are no contact: the two legs of a bend of the
//! diameter d touch after π d/2 of arc length.
//!
//! At a break two nodes have the same place in the cable, and the segment between them does not
//! exist. Across it arc lengths mean nothing: the ends of the two pieces touch like any other parts
//! of the cable. But they begin at the same point, without a gap. So a pair across a break that was
//! no contact of the unbroken cable keeps the distance that it has come to since: what has parted
//! does not come together again. Its barrier begins where it is, at the reach, where its force is
//! zero, and moves out with it, until the centre lines are a diameter and the reach may_touch.

use super::distance::{from_segment, nearest_fraction, point_segment};
use super::sweep::{MovingPoint, advance};
use crate::math::{Vec2, larger};

/// Arc length (diameters) along the cable within which it cannot touch itself: a half-turn of the
/// radius d/2 takes 1.57, and segments need some room beside that.
const MIN_ARC_DIAMETERS: f64 = 2.4;

/// Distances are taken to be accurate to this many units in the last place of the coordinates.
const ROUNDING_ULPS: f64 = 16.0;

/// A node near a segment of the same cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfPair {
    /// The node.
    pub node: usize,
    /// First node of the segment.
    pub segment: usize,
    /// Position of the nearest point along the segment, 0 to 1.
    pub fraction: f64,
    /// Unit vector from the segment to the node.
    pub normal: Vec2,
    /// Distance of the surfaces, m.
    pub gap_m: f64,
    /// Distance of the centre lines, m.
    pub distance_m: f64,
    /// +1 or −1.
    pub weight: f64,
}

impl SelfPair {
    /// The nodes that the pair acts on, each with its factor in the gradient of the gap.
    #[must_use]
    pub fn shares(&self) -> [(usize, f64); 3] {
        [(self.node, 1.0), (self.segment, self.fraction - 1.0), (self.segment + 1, -self.fraction)]
    }

    /// The value of a field at the node minus its value at the nearest point of the segment.
    #[must_use]
    pub fn difference(&self, field: &[Vec2]) -> Vec2 {
        self.shares().iter().fold(Vec2::zeros(), |sum, (k, part)| sum + field[*k] * *part)
    }

    /// Direction in which friction acts on the node: the normal turned clockwise.
    #[must_use]
    pub fn tangent(&self) -> Vec2 {
        Vec2::new(self.normal.y, -self.normal.x)
    }
}

/// The cable as an obstacle to itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SelfContact {
    /// Diameter of the cable, m; 0 = it can pass itself.
    pub diameter: f64,
    /// Breaks: the segments that do not exist.
    breaks: Vec<usize>,
    /// Pairs across a break that have not come may_touch by a diameter since.
    parting: Vec<PartingPair>,
}

/// A node and a segment on both sides of a break.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PartingPair {
    node: usize,
    segment: usize,
    /// Distance of the centre lines to which they may come together again, m; 0: they may cross.
    least_m: f64,
}

impl PartingPair {
    /// The distance of the centre lines at positions `x`, m.
    fn distance(&self, x: &[Vec2]) -> f64 {
        point_segment(x[self.node], x[self.segment], x[self.segment + 1])
    }

    /// The pair at positions `x` for a barrier that reaches this far (m).
    fn parted(self, x: &[Vec2], reach: f64) -> Self {
        Self { least_m: larger(self.least_m, self.distance(x) - reach), ..self }
    }
}

/// Nodes sorted by x, and kept from search to search: a nearly sorted list is sorted quickly.
#[derive(Clone, Debug, Default)]
pub struct SortedNodes(Vec<usize>);

impl SortedNodes {
    fn sort(&mut self, x: &[Vec2]) {
        if self.0.len() != x.len() {
            self.0 = (0..x.len()).collect();
        }
        self.0.sort_by(|a, b| x[*a].x.total_cmp(&x[*b].x));
    }

    /// The nodes whose x lies between two values.
    fn between(&self, x: &[Vec2], low: f64, high: f64) -> impl Iterator<Item = usize> {
        let first = self.0.partition_point(|&k| x[k].x < low);
        let last = self.0.partition_point(|&k| x[k].x <= high);
        self.0[first..last.max(first)].iter().copied()
    }
}

/// A node, and the point of a segment that is nearest to it.
#[derive(Clone, Copy)]
struct Pairing {
    node: usize,
    segment: usize,
    fraction: f64,
    weight: f64,
    /// Distance of the centre lines where the surfaces touch, m.
    diameter: f64,
}

impl Pairing {
    /// Appends the pair to `out` if it is nearer than `reach` (m).
    fn push(self, x: &[Vec2], reach: f64, out: &mut Vec<SelfPair>) {
        let Self { node, segment, fraction, weight, diameter } = self;
        let away = x[node] - (x[segment] * (1.0 - fraction) + x[segment + 1] * fraction);
        let distance_m = away.norm();
        if distance_m > 0.0 && distance_m - diameter < reach {
            let (normal, gap_m) = (away / distance_m, distance_m - diameter);
            out.push(SelfPair { node, segment, fraction, normal, gap_m, distance_m, weight });
        }
    }
}

impl SelfContact {
    /// An unbroken cable of a diameter (m).
    #[must_use]
    pub(crate) fn of_diameter(diameter: f64) -> Self {
        Self { diameter, ..Self::default() }
    }

    /// Becomes a copy of `other`, reusing its memory where possible.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.diameter = other.diameter;
        self.breaks.clone_from(&other.breaks);
        self.parting.clone_from(&other.parting);
    }

    /// Breaks the cable at node `k`, whose copy for the second piece has become node `k` + 1 at
    /// positions `x` (m) with arc lengths `arc` (m).
    pub(crate) fn break_at(&mut self, k: usize, x: &[Vec2], arc: &[f64], reach: f64) {
        let moved = |node: usize| if node > k { node + 1 } else { node };
        let moved_segment = |e: usize| if e >= k { e + 1 } else { e };
        self.breaks.iter_mut().for_each(|e| *e = moved_segment(*e));
        // A pair of the broken node is one of both its copies.
        for pair in std::mem::take(&mut self.parting) {
            let segment = moved_segment(pair.segment);
            self.parting.push(PartingPair { node: moved(pair.node), segment, ..pair });
            if pair.node == k {
                self.parting.push(PartingPair { node: k + 1, segment, ..pair });
            }
        }
        let first = self.breaks.partition_point(|&e| e < k);
        let (low, high) = (
            first.checked_sub(1).map_or(0, |b| self.breaks[b] + 1),
            self.breaks.get(first).copied().unwrap_or(x.len() - 1),
        );
        let pair = |(node, segment): (usize, usize)| PartingPair { node, segment, least_m: 0.0 }.parted(x, reach);
        let before = (low..=k).flat_map(|p| (k + 1..high).map(move |e| (p, e)));
        let after = (k + 1..=high).flat_map(|p| (low..k).map(move |e| (p, e)));
        let near = before.chain(after).filter(|&(p, e)| !self.is_beyond_bend(arc, p, e)).map(pair);
        let parting: Vec<PartingPair> = near.filter(|pair| pair.least_m < self.diameter).collect();
        self.parting.extend(parting);
        self.breaks.insert(first, k);
    }

    /// Keeps the distances to which the pairs at breaks have come at positions `x` (m), with a
    /// barrier of this `reach` (m).
    pub(crate) fn part(&mut self, x: &[Vec2], reach: f64) {
        let diameter = self.diameter;
        self.parting.iter_mut().for_each(|pair| *pair = pair.parted(x, reach));
        self.parting.retain(|pair| pair.least_m < diameter);
    }

    /// Returns whether the node `p` and the segment `e` are still parting at a break.
    fn is_parting(&self, p: usize, e: usize) -> bool {
        self.parting.iter().any(|pair| (pair.node, pair.segment) == (p, e))
    }

    /// Returns whether the cable meets itself at all.
    #[must_use]
    pub(crate) fn is_on(&self) -> bool {
        self.diameter > 0.0
    }

    /// Returns whether the node `p` may touch segment `e` of a cable with nodes at these arc
    /// lengths, m.
    fn may_touch(&self, arc: &[f64], p: usize, e: usize) -> bool {
        if self.breaks.is_empty() {
            return self.is_beyond_bend(arc, p, e);
        }
        let between = if p <= e { p..=e } else { e..=p - 1 };
        let first = self.breaks.partition_point(|b| b < between.start());
        match self.breaks.get(first).filter(|b| between.contains(b)) {
            Some(_) => self.breaks.binary_search(&e).is_err() && !self.is_parting(p, e),
            None => self.is_beyond_bend(arc, p, e),
        }
    }

    /// Returns whether the cable is long enough between node `p` and segment `e` to bend back on
    /// itself.
    fn is_beyond_bend(&self, arc: &[f64], p: usize, e: usize) -> bool {
        let between = if p <= e { arc[e] - arc[p] } else { arc[p] - arc[e + 1] };
        between >= MIN_ARC_DIAMETERS * self.diameter
    }

    /// All pairs nearer than `reach` (m) at positions `x` with arc lengths `arc` (m), in a fixed
    /// order.
    pub fn pairs(&self, x: &[Vec2], arc: &[f64], reach: f64, order: &mut SortedNodes, out: &mut Vec<SelfPair>) {
        out.clear();
        if !self.is_on() || x.len() < 3 {
            return;
        }
        order.sort(x);
        let diameter = self.diameter;
        let near = diameter + reach;
        let last = x.len() - 2;
        for e in 0..=last {
            let (low, high) = (x[e].inf(&x[e + 1]), x[e].sup(&x[e + 1]));
            for p in order.between(x, low.x - near, high.x + near) {
                if x[p].y < low.y - near || x[p].y > high.y + near || !self.may_touch(arc, p, e) {
                    continue;
                }
                let fraction = nearest_fraction(x[p], x[e], x[e + 1]);
                if fraction > 0.0 && fraction < 1.0 {
                    Pairing { node: p, segment: e, fraction, weight: 1.0, diameter }.push(x, reach, out);
                }
                // Each segment handles the joint at its end, the first segment also the one at its
                // start.
                let joints = [(e == 0).then_some(0), Some(e + 1)];
                for v in joints.into_iter().flatten() {
                    let weight = self.joint_weight(x, arc, p, v);
                    if weight != 0.0 {
                        let fraction = if v == e { 0.0 } else { 1.0 };
                        Pairing { node: p, segment: e, fraction, weight, diameter }.push(x, reach, out);
                    }
                }
                // If only the later segment of a joint is far enough along the cable, no other
                // segment handles that joint.
                if e > 0 && !self.may_touch(arc, p, e - 1) {
                    let weight = self.joint_weight(x, arc, p, e);
                    if weight != 0.0 {
                        Pairing { node: p, segment: e, fraction: 0.0, weight, diameter }.push(x, reach, out);
                    }
                }
            }
        }
        for &PartingPair { node, segment, least_m } in self.parting.iter().filter(|pair| pair.least_m > 0.0) {
            let fraction = nearest_fraction(x[node], x[segment], x[segment + 1]);
            Pairing { node, segment, fraction, weight: 1.0, diameter: least_m }.push(x, reach, out);
        }
        out.sort_by_key(|pair| (pair.node, pair.segment));
    }

    /// Returns the weight that inclusion and exclusion leave of joint `v` for node `p`.
    fn joint_weight(&self, x: &[Vec2], arc: &[f64], p: usize, v: usize) -> f64 {
        let clamped = |e: usize, end: f64| {
            (e + 1 < x.len() && self.may_touch(arc, p, e)).then(|| nearest_fraction(x[p], x[e], x[e + 1]) == end)
        };
        let before = if v > 0 { clamped(v - 1, 1.0) } else { None };
        let after = clamped(v, 0.0);
        let count = f64::from(u8::from(before == Some(true)) + u8::from(after == Some(true)));
        if before.is_some() && after.is_some() { count - 1.0 } else { count }
    }

    /// The largest fraction (at most `limit`) of the move from `x` to `x` + `step` (m) that leaves
    /// of every gap the fraction `keep`, or `most` (m) if that is less.
    pub fn free_fraction(
        &self,
        x: &[Vec2],
        arc: &[f64],
        step: &dyn Fn(usize) -> Vec2,
        [keep, most, limit]: [f64; 3],
        order: &mut SortedNodes,
    ) -> f64 {
        if !self.is_on() || x.len() < 3 {
            return limit;
        }
        order.sort(x);
        let mut free = limit;
        let (mut widest, mut size) = (0.0, 0.0);
        for (k, at) in x.iter().enumerate() {
            let (far, large) = (step(k).norm(), at.abs().max());
            widest = if far > widest { far } else { widest };
            size = if large > size { large } else { size };
        }
        let noise = ROUNDING_ULPS * f64::EPSILON * (size + widest);
        for e in 0..x.len() - 1 {
            let [a, b] = [step(e), step(e + 1)];
            let (low, high) = (x[e].inf(&x[e + 1]), x[e].sup(&x[e + 1]));
            // Nothing farther than this can come too near: both may move by the largest step and
            // still keep the required fraction of the gap.
            let near = self.diameter + 2.0 * widest * limit / (1.0 - keep) + noise;
            for p in order.between(x, low.x - near, high.x + near) {
                if x[p].y < low.y - near || x[p].y > high.y + near || !self.may_touch(arc, p, e) {
                    continue;
                }
                free = until_near(x, [p, e], [step(p), a, b], self.diameter, [keep, most, noise], free);
            }
        }
        for &PartingPair { node: p, segment: e, least_m } in self.parting.iter().filter(|pair| pair.least_m > 0.0) {
            let ways = [p, e, e + 1].map(step);
            free = until_near(x, [p, e], ways, least_m, [keep, most, noise], free);
        }
        free
    }

    /// The smallest gap (m) within `within` (m) and the node that has it; `None` if there is no
    /// such gap.
    pub fn smallest_gap(&self, x: &[Vec2], arc: &[f64], within: f64) -> Option<(f64, usize)> {
        let mut pairs = Vec::new();
        self.pairs(x, arc, within, &mut SortedNodes::default(), &mut pairs);
        pairs.iter().filter(|p| p.weight > 0.0).map(|p| (p.gap_m, p.node)).min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// The fraction, at most `free`, of a move of the node `p` and of both ends of the segment `e` that
/// leaves of the distance beyond `diameter` (m) what is asked.
fn until_near(x: &[Vec2], [p, e]: [usize; 2], [c, a, b]: [Vec2; 3], diameter: f64, keep: [f64; 3], free: f64) -> f64 {
    // In the frame of the node, which is then at rest, the segment moves.
    let moving = [MovingPoint { at: x[e] - x[p], go: a - c }, MovingPoint { at: x[e + 1] - x[p], go: b - c }];
    let way = |[a, b]: [Vec2; 2]| -from_segment(Vec2::zeros(), a, b);
    advance(moving, way, [Vec2::zeros(); 2], diameter, keep, free)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::barrier::Barrier;
    use proptest::prelude::*;

    fn arc(x: &[Vec2]) -> Vec<f64> {
        let mut s = vec![0.0];
        for pair in x.windows(2) {
            s.push(s[s.len() - 1] + (pair[1] - pair[0]).norm());
        }
        s
    }

    /// Barrier energy of the last node, J.
    fn energy(shape: &SelfContact, barrier: &Barrier, x: &[Vec2], s: &[f64]) -> f64 {
        let mut pairs = Vec::new();
        shape.pairs(x, s, barrier.reach, &mut SortedNodes::default(), &mut pairs);
        // Only the pairs of the last node are counted: near another node that it passes, the pairs
        // of that node would come on top.
        pairs.iter().filter(|p| p.node + 1 == x.len()).map(|p| p.weight * barrier.at(p.gap_m).value).sum()
    }

    /// A cable that comes back above itself at the height `h` (m), its end at `end` (m).
    fn bight(h: f64, end: f64) -> Vec<Vec2> {
        let mut x: Vec<Vec2> = (0..=20).map(|k| Vec2::new(0.1 * f64::from(k), 0.0)).collect();
        x.extend([Vec2::new(2.1, 0.3), Vec2::new(2.0, 0.5), Vec2::new(1.5, 0.4)]);
        x.push(Vec2::new(end, h));
        x
    }

    #[test]
    fn a_node_drawn_along_a_straight_stretch_feels_no_joint() {
        let (shape, barrier) = (SelfContact::of_diameter(0.02), Barrier { reach: 1e-3, stiffness: 5.0 });
        let s = arc(&bight(0.0205, 1.0));
        let at = |end: f64| energy(&shape, &barrier, &bight(0.0205, end), &s);
        let first = at(0.95);
        assert!(first > 0.0);
        for k in 0..=200 {
            let there = at(0.95 + 1e-3 * f64::from(k));
            assert!((there - first).abs() < 1e-9 * first, "{k}: {there} {first}");
        }
    }

    #[test]
    fn neighbours_along_the_cable_are_no_contact() {
        let shape = SelfContact::of_diameter(0.02);
        let x: Vec<Vec2> = (0..50).map(|k| Vec2::new(0.005 * f64::from(k), 0.0)).collect();
        assert_eq!(shape.smallest_gap(&x, &arc(&x), 0.1).map(|g| g.0 > 0.02), Some(true));
        let mut pairs = Vec::new();
        shape.pairs(&x, &arc(&x), 0.01, &mut SortedNodes::default(), &mut pairs);
        assert!(pairs.is_empty());
        assert!(!SelfContact::default().is_on());
    }

    #[test]
    fn strands_that_move_together_or_along_each_other_do_not_stop_each_other() {
        let shape = SelfContact::of_diameter(0.02);
        let x = bight(0.02 + 1e-6, 1.0);
        let s = arc(&x);
        let free = |step: &dyn Fn(usize) -> Vec2| {
            shape.free_fraction(&x, &s, step, [0.5, 5e-7, 1.0], &mut SortedNodes::default())
        };
        assert_eq!(free(&|_| Vec2::new(0.3, -0.4)), 1.0);
        // The strand below slides along.
        assert_eq!(free(&|k| if k <= 20 { Vec2::new(-0.04, 0.0) } else { Vec2::zeros() }), 1.0);
        let towards = free(&|k| if k <= 20 { Vec2::new(-0.04, 1e-6) } else { Vec2::zeros() });
        assert!((towards - 0.5).abs() < 1e-6, "{towards}");
    }

    /// A straight cable that breaks at its middle: the ends begin at one point and part.
    #[test]
    fn ends_at_a_break_touch_once_they_have_parted() {
        let reach = 1e-3;
        let mut shape = SelfContact::of_diameter(0.02);
        let mut x: Vec<Vec2> = (0..=40).map(|k| Vec2::new(0.05 * f64::from(k), 0.0)).collect();
        let mut s = arc(&x);
        x.insert(21, x[20]);
        s.insert(21, s[20]);
        shape.break_at(20, &x, &s, reach);
        let pairs = |shape: &SelfContact, x: &[Vec2]| {
            let mut found = Vec::new();
            shape.pairs(x, &s, reach, &mut SortedNodes::default(), &mut found);
            found
        };
        let free = |shape: &SelfContact, x: &[Vec2], way: Vec2| {
            let step = |k: usize| if k > 20 { way } else { Vec2::zeros() };
            shape.free_fraction(x, &s, &step, [0.5, f64::INFINITY, 1.0], &mut SortedNodes::default())
        };
        let moved =
            |way: Vec2| -> Vec<Vec2> { x.iter().enumerate().map(|(k, p)| if k > 20 { p + way } else { *p }).collect() };
        // The ends do not touch where they begin, nor keep each other there.
        assert!(pairs(&shape, &x).is_empty() && free(&shape, &x, Vec2::new(0.01, 0.0)) == 1.0);
        let nearly = moved(Vec2::new(0.0, 0.0205));
        shape.part(&nearly, reach);
        assert!(pairs(&shape, &nearly).is_empty());
        // They may part further, but not come together again: nearer than the reach they repel.
        let back = Vec2::new(0.0, -0.0205);
        let free_way = |way: Vec2| {
            let step = |k: usize| if k > 20 { way } else { Vec2::zeros() };
            shape.free_fraction(&nearly, &s, &step, [0.5, f64::INFINITY, 1.0], &mut SortedNodes::default())
        };
        assert!(free_way(-back) == 1.0 && free_way(back) < 0.05);
        let nearer = pairs(&shape, &moved(Vec2::new(0.0, 0.02)));
        assert!(nearer.iter().any(|p| (p.gap_m - 5e-4).abs() < 1e-12 && (p.distance_m - 0.02).abs() < 1e-12));
        // Once they have parted they do: end against end, and laid over each other anywhere.
        shape.part(&moved(Vec2::new(0.03, 0.0)), reach);
        assert_eq!(pairs(&shape, &moved(Vec2::new(0.0205, 0.0))).iter().map(|p| p.weight).sum::<f64>(), 2.0);
        for along in [-0.02, -0.31, -0.525] {
            let over = moved(Vec2::new(along, 0.03));
            let fraction = free(&shape, &over, Vec2::new(0.0, -0.04));
            assert!(fraction > 0.0 && fraction < 0.25, "{along}: {fraction}");
            let near = pairs(&shape, &moved(Vec2::new(along, 0.0205)));
            assert!(!near.is_empty() && near.iter().all(|p| (p.gap_m - 5e-4).abs() < 1e-12), "{along}: {near:?}");
        }
        // Neighbours of the same piece still do not.
        assert!(!shape.may_touch(&s, 5, 5) && !shape.may_touch(&s, 30, 30) && !shape.may_touch(&s, 5, 20));
    }

    proptest! {
        #[test]
        fn no_move_within_the_free_way_crosses(
            points in prop::collection::vec((0.0_f64..1.0, 0.0_f64..1.0), 8..20),
            moves in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0), 20),
        ) {
            let x: Vec<Vec2> = points.iter().map(|p| Vec2::new(p.0, p.1)).collect();
            let s: Vec<f64> = (0..x.len()).map(|k| k as f64).collect();
            let shape = SelfContact::of_diameter(0.01);
            let before = shape.smallest_gap(&x, &s, 1.0).map_or(1.0, |g| g.0);
            prop_assume!(before > 1e-6);
            let step = |k: usize| Vec2::new(moves[k].0, moves[k].1);
            let free = shape.free_fraction(&x, &s, &step, [0.2, f64::INFINITY, 1.0], &mut SortedNodes::default());
            prop_assert!((0.0..=1.0).contains(&free));
            for part in 1..=20 {
                let t = free * f64::from(part) / 20.0;
                let there: Vec<Vec2> = x.iter().enumerate().map(|(k, p)| p + step(k) * t).collect();
                let gap = shape.smallest_gap(&there, &s, 1.0).map_or(1.0, |g| g.0);
                prop_assert!(gap > 0.1 * before, "{gap} of {before} at {t} of {free}");
            }
        }

        #[test]
        fn every_near_pair_is_found(points in prop::collection::vec((0.0_f64..1.0, 0.0_f64..1.0), 4..16)) {
            let x: Vec<Vec2> = points.iter().map(|p| Vec2::new(p.0, p.1)).collect();
            let s: Vec<f64> = (0..x.len()).map(|k| k as f64).collect();
            let shape = SelfContact::of_diameter(0.01);
            let found = shape.smallest_gap(&x, &s, 2.0).map(|g| g.0);
            let mut least = f64::INFINITY;
            for p in 0..x.len() {
                for e in (0..x.len() - 1).filter(|&e| e != p && e + 1 != p) {
                    let d = crate::contact::distance::point_segment(x[p], x[e], x[e + 1]) - 0.01;
                    least = if d < least { d } else { least };
                }
            }
            prop_assert!(found.is_some_and(|f| (f - least).abs() < 1e-12), "{found:?} {least}");
        }
    }
}

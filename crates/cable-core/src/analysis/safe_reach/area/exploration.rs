//! The exploration moves an end from place to place, outwards from its present position.
//!
//! On each grid places are reached in the order of the length of their way (E. W. Dijkstra, "A note
//! on two problems in connexion with graphs", Numerische Mathematik 1, 1959; ways go to the eight
//! neighbours, a diagonal counts 7/5 of a side). The first grid is coarse: it shows in a few steps
//! what the map will look like. Each finer one has twice as many places side by side and goes on
//! from the cables kept at those of the coarser ones, so that all grids together take hardly more
//! steps than the finest alone. Between four places that agree, with only free places between them,
//! finer grids would show nothing new and skip the cell: where a cable lies slack all over a tank
//! these are most places.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::rc::Rc;

use super::super::{STEP_S, UNREACHABLE_FACTOR, at_rest};
use super::map::{Area, ReachQuery};
use crate::contact::World;
use crate::math::{Vec2, larger, vec2};
use crate::simulation::Simulation;

/// Longest way between two answers, m. Larger: an edge that the cable slips over is missed;
/// smaller: more answers.
const STEP_M: f64 = 0.25;

/// Number of parts in which a step without an answer is taken again. Smaller: white spots where a
/// slack cable falls over an edge.
const RETRY_PARTS: usize = 4;

/// Costs of a way to a neighbour beside and across: 7/5 is near enough to √2, and whole numbers
/// have no ties that rounding breaks.
const COSTS: [u64; 2] = [5, 7];

/// The neighbours of a place.
const NEIGHBOURS: [[i64; 2]; 8] = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, 1], [1, -1], [-1, -1]];

/// Shortest step of the search for obstacles along a way, m. Larger: obstacles thinner than a cable
/// are missed; smaller: ways along the ground take longer.
const MIN_PROBE_STEP_M: f64 = 2e-3;

/// Least number of places in a row of the coarsest grid. Smaller: the map shows nothing; larger: it
/// takes longer.
const MIN_PLACES_ACROSS: usize = 6;

/// Maximum number of places whose cables are kept for the next grid. Larger: memory (half a
/// megabyte each); smaller: finer grids begin farther back.
const MAX_KEPT_CABLES: usize = 600;

/// Difference of tensions within which four places agree, as a fraction of the service tension.
/// Larger: a snag between them is missed; smaller: slack parts of the map, which take longest, are
/// explored completely.
const AGREEMENT_FRACTION: f64 = 0.02;

/// Growth of tension in one step of finite elements from which it is checked, because nodes catch
/// on corners: the cable is laid anew from its last state, and the smaller tension counts. Smaller:
/// laid anew more often, which forgets friction; larger: false spots on the map, and all places
/// behind them false (on the tank 68 kN and 233 N for 106 N).
const SNAG_GROWTH: f64 = 2.0;

/// Tension below which no check is made, as a fraction of the service tension: nothing depends on
/// it.
const NEGLIGIBLE_FRACTION: f64 = 0.1;

/// Distance, as a fraction of the farthest one, within which a cable that stops short is held by an
/// obstacle, so that other ways to the place are tried. Larger: each place at the edge of the map
/// is tried from all sides; smaller: false spots near obstacles.
const RETRY_DISTANCE_FRACTION: f64 = 0.8;

/// The end at a place, and the cable there.
struct ReachedPlace {
    place: usize,
    simulation: Simulation,
    /// Length of the way there, fifths of the finest spacing.
    cost: u64,
    /// The largest tension on the way there, N.
    most_n: f64,
}

/// A search in progress.
pub(super) struct Exploration<'a> {
    pub query: &'a ReachQuery,
    pub world: World,
    /// The other supports of the cable, m.
    pub holds: Vec<Vec2>,
    /// Greatest distance from these supports that is tried, m.
    pub far_m: f64,
    /// The place of the start.
    pub first: usize,
    /// Places that are free and within that distance.
    pub free: Vec<bool>,
    /// Places that were answered.
    pub known: Vec<bool>,
    /// Places between others that agree.
    pub settled: Vec<bool>,
    /// Places near enough that the cable did not reach: another way may lead there.
    pub beyond: Vec<bool>,
    /// The place from which each place was reached.
    pub parents: Vec<Option<usize>>,
    pub found: Area,
}

/// A function that receives the progress of a map.
type AreaProgress<'a> = &'a mut dyn FnMut(&Area, f64) -> ControlFlow<()>;

impl Exploration<'_> {
    /// Explores outwards from the start, grid after grid; at the end no place is only guessed from
    /// a coarser grid.
    pub fn spread(&mut self, start: Simulation, progress: AreaProgress<'_>) {
        self.free = (0..self.found.most_n.len()).map(|k| self.is_candidate(k)).collect();
        let most_n = self.tension_n(&start);
        self.found.most_n[self.first] = most_n;
        self.known[self.first] = true;
        let mut reached_places = vec![Rc::new(ReachedPlace { place: self.first, simulation: start, cost: 0, most_n })];
        let strides = self.strides();
        // A step takes as long on every grid: a coarse one has few places and many steps to each.
        let steps = |stride: usize| (self.found.spacing_m * stride as f64 / STEP_M).ceil();
        let places = |stride: usize| self.places(stride).count() as f64;
        let new = |k: usize| places(strides[k]) - if k > 0 { places(strides[k - 1]) } else { 0.0 };
        let total = (0..strides.len()).map(|k| new(k) * steps(strides[k])).sum::<f64>().max(1.0);
        let parts: Vec<[f64; 2]> = (0..strides.len()).map(|k| [new(k), steps(strides[k]) / total]).collect();
        let mut before = 0.0;
        for (stride, [new, one]) in strides.into_iter().zip(parts) {
            let mut progress = |area: &Area, count: usize| progress(area, (before + one * count as f64).min(1.0));
            if self.grid(stride, &mut reached_places, &mut progress).is_break() {
                break;
            }
            before += one * new;
            if stride > 1 {
                self.settle(stride);
            }
        }
        for k in 0..self.known.len() {
            self.found.guessed[k] = self.settled[k] && !self.known[k];
            if !self.known[k] && !self.settled[k] {
                self.found.most_n[k] = if self.beyond[k] { f64::INFINITY } else { f64::NAN };
            }
        }
    }

    /// Finds the places between others that agree.
    fn settle(&mut self, stride: usize) {
        let mut open = vec![false; self.known.len()];
        let mut inside = vec![false; self.known.len()];
        let columns = self.found.columns;
        let [column, row] = [self.first % columns % stride, self.first / columns % stride];
        let cells = (0..self.known.len()).filter(|k| k % columns % stride == column && k / columns % stride == row);
        // Cells at the lower and left edge, of which only a part is there, begin outside; they stay
        // open as nothing settles them.
        for low in cells {
            let agree = self.agree(low, stride);
            if agree {
                self.interpolate_cell(low, stride);
            }
            for at in self.cell(low, stride) {
                (if agree { &mut inside } else { &mut open })[at] = true;
            }
        }
        for k in 0..self.settled.len() {
            self.settled[k] |= inside[k] && !open[k] && !self.known[k];
        }
    }

    /// The corners of a cell of a grid, counted from its lower left one.
    fn corners(&self, low: usize, stride: usize) -> [usize; 4] {
        [low, low + stride, low + stride * self.found.columns, low + stride * (self.found.columns + 1)]
    }

    /// The places of a cell of a grid and on its sides, as far as they are there.
    fn cell(&self, low: usize, stride: usize) -> impl Iterator<Item = usize> + use<> {
        let (columns, count) = (self.found.columns, self.known.len());
        let wide = (columns - low % columns).min(stride + 1);
        (0..=stride).flat_map(move |j| (0..wide).map(move |i| low + i + j * columns)).filter(move |k| *k < count)
    }

    /// Returns whether a cell of a grid is all there and nothing is in it: nothing lies across
    /// sides and diagonals of its finest squares.
    fn is_empty(&self, low: usize, stride: usize) -> bool {
        let columns = self.found.columns;
        if low % columns + stride >= columns || low + stride * (columns + 1) >= self.known.len() {
            return false;
        }
        let clear = |k: usize| {
            let [a, b, c, d] = self.corners(k, 1).map(|k| self.at(k));
            [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]].iter().all(|[p, q]| self.clear(*p, *q))
        };
        self.cell(low, stride).all(|k| self.free[k])
            && (self.world.is_empty() || (0..stride * stride).all(|k| clear(low + k % stride + k / stride * columns)))
    }

    /// Returns whether the corners of a cell agree and nothing is in it.
    fn agree(&self, low: usize, stride: usize) -> bool {
        if !self.is_empty(low, stride) {
            return false;
        }
        let corners = self.corners(low, stride);
        if !corners.iter().all(|k| self.is_decided(*k)) {
            return false;
        }
        let values = corners.map(|k| self.found.most_n[k]);
        let (low_n, high_n) =
            values.into_iter().fold((f64::INFINITY, 0.0), |(a, b), v| (if v < a { v } else { a }, larger(b, v)));
        high_n - low_n <= AGREEMENT_FRACTION * self.found.service_n
    }

    /// The stride of each grid in places, the coarsest first. All but the last are small enough
    /// that their cables can be kept.
    fn strides(&self) -> Vec<usize> {
        let columns = self.found.columns;
        let rows = self.found.most_n.len() / columns.max(1);
        let coarsest = (columns.max(rows) / MIN_PLACES_ACROSS).max(1).ilog2();
        let all = (0..=coarsest).rev().map(|k| 1_usize << k);
        all.filter(|stride| *stride == 1 || self.places(*stride).count() <= MAX_KEPT_CABLES).collect()
    }

    /// The free places of a grid.
    fn places(&self, stride: usize) -> impl Iterator<Item = usize> + use<'_> {
        let columns = self.found.columns;
        let [column, row] = [self.first % columns, self.first / columns];
        let on =
            move |k: &usize| (k % columns).abs_diff(column) % stride == 0 && (k / columns).abs_diff(row) % stride == 0;
        (0..self.free.len()).filter(move |k| self.free[*k]).filter(on)
    }

    /// Answers all places of a grid that can be reached from those kept, and keeps theirs for the
    /// next one.
    fn grid(
        &mut self,
        stride: usize,
        reached_places: &mut Vec<Rc<ReachedPlace>>,
        progress: &mut dyn FnMut(&Area, usize) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        // The key is cost, place and origin: if one way has no answer, another one of the same
        // length may have one.
        let mut open = BTreeMap::new();
        for from in reached_places.iter() {
            self.open(from, stride, &mut open);
        }
        let mut count = 0;
        while let Some(((cost, place, parent), from)) = open.pop_first() {
            if self.known[place] {
                continue;
            }
            progress(&self.found, count)?;
            let mut simulation = from.simulation.clone();
            let before_n = from.most_n;
            drop(from);
            // If this way has no answer, another one may have one.
            let Some(out_n) = self.greatest_tension_on_way(&mut simulation, [self.at(parent), self.at(place)]) else {
                continue;
            };
            let most_n = larger(before_n, out_n);
            if most_n.is_infinite() && self.is_easily_reached(place) {
                self.beyond[place] = true;
                continue;
            }
            (self.known[place], count) = (true, count + 1);
            self.found.guessed[place] = false;
            self.found.most_n[place] = most_n;
            if most_n.is_finite() {
                self.parents[place] = Some(parent);
                self.found.most_n[place] = if self.query.back {
                    self.back(&mut simulation.clone(), place).map_or(f64::NAN, |back_n| larger(most_n, back_n))
                } else {
                    self.tension_n(&simulation)
                };
                let reached = Rc::new(ReachedPlace { place, simulation, cost, most_n });
                self.open(&reached, stride, &mut open);
                if stride > 1 {
                    reached_places.push(reached);
                }
            }
            if stride > 1 {
                self.interpolate_places(place, stride);
            }
        }
        ControlFlow::Continue(())
    }

    /// Opens the ways to all neighbours of a place on a grid.
    fn open(&self, from: &Rc<ReachedPlace>, stride: usize, open: &mut BTreeMap<(u64, usize, usize), Rc<ReachedPlace>>) {
        for (next, cost) in self.neighbours(from.place, stride) {
            if !self.known[next]
                && !self.settled[next]
                && self.free[next]
                && self.clear(self.at(from.place), self.at(next))
            {
                open.insert((from.cost + cost * stride as u64, next, from.place), Rc::clone(from));
            }
        }
    }

    /// Interpolates the places between four neighbours on a coarse grid until a finer one computes
    /// them.
    fn interpolate_places(&mut self, place: usize, stride: usize) {
        let around: Vec<usize> = self.neighbours(place, stride).map(|(k, _)| k).chain([place]).collect();
        for low in around.iter().copied() {
            let is_known = |k: &usize| around.contains(k) && self.is_decided(*k);
            if self.corners(low, stride).iter().all(is_known) && self.is_empty(low, stride) {
                self.interpolate_cell(low, stride);
            }
        }
    }

    /// Returns whether the tension of a place is known, or taken from others for good.
    fn is_decided(&self, place: usize) -> bool {
        let [known, settled] = [&self.known, &self.settled].map(|l| l.get(place) == Some(&true));
        (known || settled) && self.found.most_n[place].is_finite()
    }

    /// Gives the places of a cell whose tension is not known that between its corners (N),
    /// bilinear; the cell has `stride` places a side from its lower left one, `low`.
    fn interpolate_cell(&mut self, low: usize, stride: usize) {
        let [a, b, c, d] = self.corners(low, stride).map(|k| self.found.most_n[k]);
        for k in 0..(stride + 1) * (stride + 1) {
            let [i, j] = [k % (stride + 1), k / (stride + 1)];
            let at = low + i + j * self.found.columns;
            let [u, v] = [i, j].map(|n| n as f64 / stride as f64);
            if !self.known[at] && !self.settled[at] {
                self.found.guessed[at] = true;
                self.found.most_n[at] = (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
            }
        }
    }

    fn at(&self, place: usize) -> Vec2 {
        vec2(self.found.at(place))
    }

    /// Returns whether a place is free and within the greatest distance.
    fn is_candidate(&self, place: usize) -> bool {
        let p = self.at(place);
        place == self.first || (self.is_free(p) && self.holds.iter().all(|h| (p - h).norm() <= self.far_m))
    }

    /// Returns whether a cable that no obstacle holds would easily reach a place.
    fn is_easily_reached(&self, place: usize) -> bool {
        self.holds.iter().all(|h| (self.at(place) - h).norm() <= RETRY_DISTANCE_FRACTION * self.far_m)
    }

    fn is_free(&self, p: Vec2) -> bool {
        self.world.is_empty() || self.world.signed_gap(p, f64::INFINITY).is_none_or(|g| g.gap_m >= 0.0)
    }

    /// Returns whether no obstacle lies between two free places, in steps no longer than the
    /// distance to the nearest obstacle.
    fn clear(&self, from: Vec2, to: Vec2) -> bool {
        let (way, mut gone, mut before) = (to - from, 0.0, f64::NEG_INFINITY);
        while !self.world.is_empty() && gone < way.norm() {
            let Some(gap) = self.world.signed_gap(from + way * (gone / way.norm()), f64::INFINITY) else { return true };
            // The end may leave an obstacle that it touches at the start, or is a little inside of.
            if !(gap.gap_m >= 0.0 || gap.gap_m > before) {
                return false;
            }
            before = gap.gap_m;
            gone += larger(gap.gap_m, MIN_PROBE_STEP_M);
        }
        true
    }

    /// Neighbours of a place on a grid, and what the way there costs over the grid's spacing.
    fn neighbours(&self, place: usize, stride: usize) -> impl Iterator<Item = (usize, u64)> + use<> {
        let (columns, count, stride) = (self.found.columns as i64, self.found.most_n.len() as i64, stride as i64);
        let [column, row] = [place as i64 % columns, place as i64 / columns];
        NEIGHBOURS.into_iter().filter_map(move |[dx, dy]| {
            let (c, r) = (column + stride * dx, row + stride * dy);
            let inside = c >= 0 && c < columns && r >= 0 && r * columns + c < count;
            inside.then(|| ((r * columns + c) as usize, COSTS[usize::from(dx != 0 && dy != 0)]))
        })
    }

    /// Moves the end back from a place to the start; returns the largest tension, infinite if the
    /// cable holds it back, None without an answer.
    fn back(&self, simulation: &mut Simulation, place: usize) -> Option<f64> {
        let (mut at, mut most) = (place, 0.0);
        while let Some(before) = self.parents.get(at).copied().flatten().filter(|_| f64::is_finite(most)) {
            most = larger(most, self.greatest_tension_on_way(simulation, [self.at(at), self.at(before)])?);
            at = before;
        }
        Some(most)
    }

    /// Moves the end straight from one place to another; returns the largest tension, infinite if
    /// the cable stops it, None without an answer.
    pub fn greatest_tension_on_way(&self, simulation: &mut Simulation, [from, to]: [Vec2; 2]) -> Option<f64> {
        let steps = ((to - from).norm() / STEP_M).ceil();
        let mut most = self.tension_n(simulation);
        for k in 1..=steps as usize {
            let ends = [k - 1, k].map(|k| from + (to - from) * (k as f64 / steps));
            most = larger(most, self.step_with_retries(simulation, ends)?);
            if !(most <= UNREACHABLE_FACTOR * self.found.breaking_n) {
                return Some(f64::INFINITY);
            }
        }
        Some(most)
    }

    /// Moves the end from one place to another in a step; without an answer, or with a doubtful
    /// one, it tries again in parts and from the cable at rest. Returns the smallest tension found
    /// (N), None without an answer.
    fn step_with_retries(&self, simulation: &mut Simulation, ends: [Vec2; 2]) -> Option<f64> {
        let before = simulation.clone();
        let before_n = self.tension_n(&before);
        let good = |simulation: &Simulation, n: Option<f64>| {
            let caught = |n: f64| n > NEGLIGIBLE_FRACTION * self.found.service_n && n > SNAG_GROWTH * before_n;
            n.is_some_and(|n| !simulation.model().capabilities().nodes_catch || !caught(n))
        };
        let mut found_n = self.step(simulation, ends, 1);
        for (parts, start) in
            [(RETRY_PARTS, RetryStart::AsItIs), (1, RetryStart::AtRest), (RETRY_PARTS, RetryStart::AtRest)]
        {
            if good(simulation, found_n) {
                break;
            }
            let mut other = before.clone();
            if start == RetryStart::AtRest && other.resume(&at_rest(&before.solution())).is_err() {
                continue;
            }
            if let Some(n) = self.step(&mut other, ends, parts)
                && found_n.is_none_or(|f| n < f)
            {
                (*simulation, found_n) = (other, Some(n));
            }
        }
        found_n
    }

    fn tension_n(&self, simulation: &Simulation) -> f64 {
        simulation.largest_n([self.query.cable])
    }

    /// Takes a step in so many parts; returns the largest tension in it, None without an answer.
    fn step(&self, simulation: &mut Simulation, [from, to]: [Vec2; 2], parts: usize) -> Option<f64> {
        let mut most = 0.0;
        for k in 1..=parts {
            simulation.drag_support(
                self.query.cable,
                self.query.support,
                from + (to - from) * (k as f64 / parts as f64),
            );
            simulation.step_quasi_static(STEP_S).ok()?;
            most = larger(most, self.tension_n(simulation));
        }
        Some(most)
    }
}

/// The state from which a step is tried again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RetryStart {
    /// The state before it.
    AsItIs,
    /// The state before, with the cable brought to rest anew.
    AtRest,
}

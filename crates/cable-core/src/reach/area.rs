//! Where an end of a cable can be taken by a hand or a crane: everywhere in the plane that a way through free space leads to.
//!
//! From where it is the end is taken outwards from place to place of a grid, along the shortest ways that pass no obstacle
//! (E. W. Dijkstra, "A note on two problems in connexion with graphs", Numerische Mathematik 1, 1959; ways go to the eight
//! neighbours, a diagonal counts 7/5 of a side). Each place goes on from the cable as it was at the one before: with the friction
//! and the wraps of the way there. The way back is the same way.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::rc::Rc;

use super::{HOPELESS, STEP_S, least, stilled, unsupported};
use crate::contact::World;
use crate::error::Error;
use crate::math::{Point, Vec2, larger, vec2};
use crate::model::auto::Question;
use crate::model::{Inertia, Model, Settings};
use crate::scene::{Scene, Support, SupportKind};
use crate::simulation::Simulation;

/// Longest way between two answers, m. Longer: an edge that the cable slips over is passed unseen; shorter: more answers.
const STEP_M: f64 = 0.25;

/// A step without an answer is taken again in so many parts. Fewer: white spots where a slack cable falls over an edge.
const PARTS: usize = 4;

/// Length of a bar where the cable hangs slack and finite elements answer, m. Longer: nodes catch on rough ground and pull by
/// thousands of newtons that no cable feels (0.6 m over ground of 0.23 m: 800 kN); shorter: longer by as much.
const BAR_M: f64 = 0.2;

/// Most places that are looked at: more is a slip of the unit.
const MOST_PLACES: usize = 100_000;

/// Costs of a way to a neighbour beside and across: 7/5 is near enough to √2, and whole numbers have no ties that rounding breaks.
const COSTS: [u64; 2] = [5, 7];

/// The neighbours of a place.
const NEIGHBOURS: [[i64; 2]; 8] = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, 1], [1, -1], [-1, -1]];

/// How much farther than its length a cable is tried, of its length: more than any cable stretches before it breaks.
const STRETCHED: f64 = 1.1;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Ask {
    /// The scene.
    pub scene: Scene,
    /// Mesh and accuracy.
    pub settings: Settings,
    /// The cable whose support is moved.
    pub cable: usize,
    /// The support that is moved.
    pub support: usize,
    /// Lower left and upper right corner of what is looked at, m.
    pub corners_m: [Point; 2],
    /// Side of a place, m.
    pub spacing_m: f64,
    /// Asks for the way there and back instead of the place itself: by the number of places on a way as much work again.
    pub back: bool,
}

/// What there is to know of every place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Area {
    /// The middle of the first place, m.
    pub origin_m: Point,
    /// Between neighbours, m.
    pub spacing_m: f64,
    /// Places side by side.
    pub columns: usize,
    /// Largest tension with the end there, or on the way there and back, N, row by row from below. Not a number: nothing is known
    /// of it, no free way leads there or no answer was found; infinite: the cable does not reach.
    pub most_n: Vec<f64>,
    /// Where the end starts, m.
    pub start_m: Point,
    /// Service tension of the cable, N.
    pub service_n: f64,
    /// Breaking tension of the cable, N.
    pub breaking_n: f64,
}

impl Area {
    /// The middle of a place, m.
    #[must_use]
    pub fn at(&self, place: usize) -> Point {
        let columns = self.columns.max(1);
        let [column, row] = [(place % columns) as f64, (place / columns) as f64];
        [self.origin_m[0] + column * self.spacing_m, self.origin_m[1] + row * self.spacing_m]
    }

    /// How much of the plane is below a tension (N), m², and the corners of the rectangle round it, m; None where nothing is.
    #[must_use]
    pub fn below(&self, tension_n: f64) -> Option<(f64, [Point; 2])> {
        let within = self.most_n.iter().enumerate().filter(|(_, t)| **t <= tension_n).map(|(k, _)| self.at(k));
        let (mut count, mut low, mut high) = (0_u32, [f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in within {
            count += 1;
            for k in 0..2 {
                (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
            }
        }
        (count > 0).then(|| (f64::from(count) * self.spacing_m * self.spacing_m, [low, high]))
    }
}

/// Looks at all places; `progress` hears what is known so far and the share done (0 to 1), and can end it.
///
/// # Errors
/// The scene is wrong, the support is none that has a place, or its start has no answer.
pub fn area(ask: &Ask, mut progress: impl FnMut(&Area, f64) -> ControlFlow<()>) -> Result<Area, Error> {
    let still = unmanned(&stilled(&ask.scene))?;
    let cable = still.cables.get(ask.cable).ok_or_else(|| unsupported("a cable that is not there"))?;
    let start = cable.supports.get(ask.support).and_then(|s| s.at_m);
    let start = vec2(start.ok_or_else(|| unsupported("a support without a place"))?);
    if !(ask.spacing_m > 0.0 && ask.corners_m.iter().flatten().all(|v| v.is_finite())) {
        return Err(unsupported("a grid without places"));
    }
    // The start is a place of the grid.
    let before = [0, 1].map(|k| ((start[k] - ask.corners_m[0][k]) / ask.spacing_m).floor().max(0.0));
    let after = [0, 1].map(|k| ((ask.corners_m[1][k] - start[k]) / ask.spacing_m).floor().max(0.0));
    let [columns, rows] = [0, 1].map(|k| (before[k] + after[k]) as usize + 1);
    if columns.saturating_mul(rows) > MOST_PLACES {
        return Err(unsupported("a grid of so many places"));
    }
    let found = Area {
        origin_m: [0, 1].map(|k| start[k] - before[k] * ask.spacing_m),
        spacing_m: ask.spacing_m,
        columns,
        most_n: vec![f64::NAN; columns * rows],
        start_m: [start.x, start.y],
        service_n: least(&ask.scene, &[ask.cable], |c| c.service_tension_n),
        breaking_n: least(&ask.scene, &[ask.cable], |c| c.breaking_tension_n),
    };
    let held = cable.supports.iter().enumerate().filter(|(k, _)| *k != ask.support);
    let radius_m = 0.5 * cable.diameter_m;
    let mut flood = Flood {
        ask,
        world: World::new(&still.obstacles, cable.friction, radius_m),
        holds: held.filter_map(|(_, s)| s.at_m.map(vec2)).collect(),
        far_m: cable.length_m * STRETCHED,
        first: before[1] as usize * columns + before[0] as usize,
        parents: vec![None; found.most_n.len()],
        found,
    };
    let question = Question::History(Inertia::QuasiStatic);
    let bars = still.cables.iter().map(|c| (c.length_m / BAR_M).ceil()).fold(1.0, larger);
    let settings = Settings { segments: Some(ask.settings.segments.unwrap_or(bars as usize)), ..ask.settings };
    let mut laid = Simulation::for_question(still.clone(), Model::Auto, settings, question)?;
    laid.settle()?;
    // Ended early, what is known so far is the answer.
    let _ = flood.spread(laid, &mut progress);
    Ok(flood.found)
}

/// Without its robot: where its cable hangs on it, it is held.
fn unmanned(scene: &Scene) -> Result<Scene, Error> {
    let mut scene = scene.clone();
    let hitch = scene.hitch_m();
    for support in scene.cables.iter_mut().flat_map(|c| &mut c.supports).filter(|s| s.kind == SupportKind::Robot) {
        let at = hitch.ok_or_else(|| unsupported("a cable on a robot that is not there"))?;
        *support = Support { arc_length_m: support.arc_length_m, ..Support::fixed(support.name.clone(), at) };
    }
    scene.robot = None;
    Ok(scene)
}

/// A search in progress.
struct Flood<'a> {
    ask: &'a Ask,
    world: World,
    /// The other supports of the cable, m.
    holds: Vec<Vec2>,
    /// Farther from those it is not tried, m.
    far_m: f64,
    /// The place of the start.
    first: usize,
    /// From where each place was reached.
    parents: Vec<Option<usize>>,
    found: Area,
}

impl Flood<'_> {
    fn at(&self, place: usize) -> Vec2 {
        vec2(self.found.at(place))
    }

    /// Whether a place is free and not hopelessly far.
    fn may(&self, place: usize) -> bool {
        let p = self.at(place);
        place == self.first || (self.free(p) && self.holds.iter().all(|h| (p - h).norm() <= self.far_m))
    }

    fn free(&self, p: Vec2) -> bool {
        self.world.is_empty() || self.world.signed_gap(p, f64::INFINITY).is_none_or(|g| g.gap_m >= 0.0)
    }

    /// Whether nothing lies between two free places.
    fn clear(&self, from: Vec2, to: Vec2) -> bool {
        let mut gaps = Vec::new();
        self.world.segment_gaps(from, to, 0.0, &mut gaps);
        // What the start touches it may leave.
        gaps.iter().all(|g| g.fraction <= 0.0)
    }

    fn neighbours(&self, place: usize) -> impl Iterator<Item = (usize, u64)> + use<> {
        let (columns, count) = (self.found.columns as i64, self.found.most_n.len() as i64);
        let [column, row] = [place as i64 % columns, place as i64 / columns];
        NEIGHBOURS.into_iter().filter_map(move |[dx, dy]| {
            let (c, r) = (column + dx, row + dy);
            let inside = c >= 0 && c < columns && r >= 0 && r * columns + c < count;
            inside.then(|| ((r * columns + c) as usize, COSTS[usize::from(dx != 0 && dy != 0)]))
        })
    }

    /// Goes outwards from the start.
    fn spread(&mut self, laid: Simulation, heard: &mut impl FnMut(&Area, f64) -> ControlFlow<()>) -> ControlFlow<()> {
        let total = (0..self.found.most_n.len()).filter(|k| self.may(*k)).count().max(1);
        let mut closed = vec![false; self.found.most_n.len()];
        let start_n = laid.largest_n([self.ask.cable]);
        let mut open = BTreeMap::from([((0_u64, self.first), (Rc::new(laid), self.first, start_n))]);
        let mut done = 0;
        while let Some(((cost, place), (before, parent, most_n))) = open.pop_first() {
            if closed.get(place).copied().unwrap_or(true) {
                continue;
            }
            heard(&self.found, (f64::from(done) / total as f64).min(1.0))?;
            let mut there = (*before).clone();
            drop(before);
            // Without an answer on this way there may be one on another.
            let Some(out_n) = self.go(&mut there, [self.at(parent), self.at(place)]) else { continue };
            let most_n = larger(most_n, out_n);
            (closed[place], done) = (true, done + 1);
            if most_n.is_infinite() {
                self.found.most_n[place] = most_n;
                continue;
            }
            self.parents[place] = (place != self.first).then_some(parent);
            self.found.most_n[place] = if self.ask.back {
                self.back(&mut there.clone(), place).map_or(f64::NAN, |back_n| larger(most_n, back_n))
            } else {
                there.largest_n([self.ask.cable])
            };
            let there = Rc::new(there);
            for (next, step) in self.neighbours(place) {
                if !closed[next] && self.may(next) && self.clear(self.at(place), self.at(next)) {
                    open.entry((cost + step, next)).or_insert_with(|| (Rc::clone(&there), place, most_n));
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// The way back from a place to the start; the largest tension on it, infinite where the cable holds it back, None without an
    /// answer.
    fn back(&self, simulation: &mut Simulation, place: usize) -> Option<f64> {
        let (mut at, mut most) = (place, 0.0);
        while let Some(before) = self.parents.get(at).copied().flatten().filter(|_| f64::is_finite(most)) {
            most = larger(most, self.go(simulation, [self.at(at), self.at(before)])?);
            at = before;
        }
        Some(most)
    }

    /// Moves the end straight from one place to another; the largest tension on the way, infinite where it gets no farther, None
    /// without an answer.
    fn go(&self, simulation: &mut Simulation, [from, to]: [Vec2; 2]) -> Option<f64> {
        let cable = self.ask.cable;
        let steps = ((to - from).norm() / STEP_M).ceil();
        let mut most = simulation.largest_n([cable]);
        for k in 1..=steps as usize {
            let ends = [k - 1, k].map(|k| from + (to - from) * (k as f64 / steps));
            let before = simulation.clone();
            if !self.step(simulation, ends, 1, &mut most) {
                *simulation = before;
                if !self.step(simulation, ends, PARTS, &mut most) {
                    return None;
                }
            }
            if !(most <= HOPELESS * self.found.breaking_n) {
                return Some(f64::INFINITY);
            }
        }
        Some(most)
    }

    /// A step in so many parts; whether there was an answer.
    fn step(&self, simulation: &mut Simulation, [from, to]: [Vec2; 2], parts: usize, most: &mut f64) -> bool {
        (1..=parts).all(|k| {
            simulation.drag_support(self.ask.cable, self.ask.support, from + (to - from) * (k as f64 / parts as f64));
            let answered = simulation.step_quasi_static(STEP_S).is_ok();
            if answered {
                *most = larger(*most, simulation.largest_n([self.ask.cable]));
            }
            answered
        })
    }
}

#[cfg(test)]
mod tests;

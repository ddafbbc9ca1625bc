//! The map of an area holds the greatest tension for each place of a grid.

use std::sync::Arc;

use crate::math::Point;
use crate::model::Settings;
use crate::scene::Scene;
use crate::solution::Solution;

/// The query.
#[derive(Clone, Debug, PartialEq)]
pub struct ReachQuery {
    /// The scene.
    pub scene: Scene,
    /// The present state of its cables; None: as the scene lays them.
    pub now: Option<Arc<Solution>>,
    /// Mesh and accuracy.
    pub settings: Settings,
    /// The cable whose support is moved.
    pub cable: usize,
    /// The support that is moved.
    pub support: usize,
    /// Lower left and upper right corner of the map, m.
    pub corners_m: [Point; 2],
    /// Side of a place, m.
    pub spacing_m: f64,
    /// True for the way there and back instead of the place itself: as many more steps as there are
    /// places on the ways.
    pub back: bool,
}

/// The results at every place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Area {
    /// The middle of the first place, m.
    pub origin_m: Point,
    /// Between neighbours, m.
    pub spacing_m: f64,
    /// Places side by side.
    pub columns: usize,
    /// Largest tension with the end there, or on the way there and back, N, row by row from below.
    /// NaN if nothing is known: no free way leads there or no answer was found. Infinite if the
    /// cable does not reach the place.
    pub most_n: Vec<f64>,
    /// For each place, true if its tension is interpolated from four agreeing ones round it, or,
    /// while the map is unfinished, taken from the nearest one of a coarser grid.
    pub guessed: Vec<bool>,
    /// Position at which the end starts, m.
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

    /// Returns the area of the plane below a tension (N), m², and the corners of its bounding
    /// rectangle, m; None if there is none.
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

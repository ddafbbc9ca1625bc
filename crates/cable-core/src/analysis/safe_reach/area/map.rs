//! The map of an area holds the greatest tension for each place of a grid.

use std::sync::Arc;

use crate::math::Point;
use crate::model::Settings;
use crate::scene::Scene;
use crate::solution::Solution;

/// The question.
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
    /// Lower left and upper right corner of what is looked at, m.
    pub corners_m: [Point; 2],
    /// Side of a place, m.
    pub spacing_m: f64,
    /// Asks for the way there and back instead of the place itself: by the number of places on a
    /// way as much work again.
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
    /// Not a number: nothing is known of it, no free way leads there or no answer was found;
    /// infinite: the cable does not reach.
    pub most_n: Vec<f64>,
    /// Of each place: its tension is taken from four round it that agree, or, while the map is not
    /// done, from the nearest of a coarser grid.
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

    /// Returns how much of the plane is below a tension (N), m², and the corners of the rectangle
    /// round it, m; None where nothing is.
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

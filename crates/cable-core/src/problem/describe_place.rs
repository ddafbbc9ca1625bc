//! A place of a cable is described in the words of the scene: metres along it, and the name of what
//! is near.

use super::definition::Problem;
use crate::error::{Near, NearKind, Place};
use crate::math::Vec2;

impl Problem {
    /// The place `arc_length` (m) along the cable, which lies at `at` (m), and the support or
    /// obstacle nearest to it.
    #[must_use]
    pub fn place(&self, arc_length: f64, at: Vec2, time_s: f64) -> Box<Place> {
        let finite = at.iter().all(|c| c.is_finite());
        let supports = self.supports.iter().filter_map(|s| {
            let (place, _) = s.place_at(time_s)?;
            let away = (at - place).norm() - s.wheel_radius;
            let distance_m = if away > 0.0 { away } else { 0.0 };
            Some(Near { kind: NearKind::Support, name: s.name.clone(), distance_m })
        });
        let ground = self.world.signed_gap(at, f64::INFINITY).filter(|_| finite);
        let obstacle = ground.map(|g| {
            let distance_m = if g.gap_m > 0.0 { g.gap_m } else { 0.0 };
            Near { kind: NearKind::Obstacle, name: self.world.obstacle_name(g.obstacle).to_owned(), distance_m }
        });
        let near = if finite {
            supports.chain(obstacle).fold(None, |best: Option<Near>, n| match best {
                Some(b) if b.distance_m <= n.distance_m => Some(b),
                _ => Some(n),
            })
        } else {
            None
        };
        Box::new(Place { arc_length_m: arc_length, at_m: at, near })
    }
}

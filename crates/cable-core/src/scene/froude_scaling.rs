//! A similar copy is a scene at another scale.
//!
//! Froude similarity (W. Froude, 1868): lengths by λ, times by √λ, forces and gravity as they are.
//! Masses then stay, mass per metre, weight and wind per metre go by 1/λ, EI by λ², EA stays;
//! strain, angle and friction have no unit. A cable and its copy do the same at every instant, so a
//! solver whose tolerances were found at one scale answers at all of them.

use super::{Motion, Scene, Shape};
use crate::math::{Point, Vec2, vec2};

/// Factors of lengths and times, and the point of the scene that is the copy's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// λ: length of the copy over that of the scene.
    pub length: f64,
    /// √λ: time of the copy over that of the scene.
    pub time: f64,
    /// The point of the scene that is at (0, 0) in the copy, m.
    pub origin: Vec2,
}

/// Lengths of a cable for which no copy is made, m: what the solvers' tolerances were found on.
/// Wider: the shortest and longest cables feel lengths that are fixed in the solvers; at 0.1 m by
/// 0.2 % of the tension, at 0.01 m by 0.5 %, at 1 mm by 10 %. Narrower: no harm but that answers of
/// scenes that were well before change in their last digits.
const NATURAL_LENGTHS_M: [f64; 2] = [2.0, 1000.0];
/// Length of the copy of a short cable at least, m; at most it is four times that.
const COPY_OF_SHORT_M: f64 = 8.0;
/// Distance of a cable from (0, 0) in its lengths from which its copy is made at (0, 0): there
/// coordinates have lost two digits.
const MAX_ORIGIN_DISTANCE: f64 = 100.0;

impl Similarity {
    /// The similarity that brings a cable of a length (m), one end of which is near `origin` (m),
    /// to the scale that solvers are made for; None where it has it. Factors are powers of two: no
    /// digit is lost by them.
    #[must_use]
    pub fn to_natural(length_m: f64, origin: Vec2) -> Option<Self> {
        let [shortest, longest] = NATURAL_LENGTHS_M;
        let natural = (shortest..=longest).contains(&length_m);
        if natural && origin.amax() <= MAX_ORIGIN_DISTANCE * length_m {
            return None;
        }
        let mut time = 1.0f64;
        while length_m < shortest && length_m * time * time < COPY_OF_SHORT_M {
            time *= 2.0;
        }
        // No shorter than it must be: the gap at which a contact pushes grows with what the copy is
        // shortened by.
        while length_m * time * time > longest {
            time *= 0.5;
        }
        Some(Self { length: time * time, time, origin })
    }

    /// A place of the scene in the copy, m.
    #[must_use]
    pub fn place(&self, at: Vec2) -> Vec2 {
        (at - self.origin) * self.length
    }

    /// A place of the copy in the scene, m.
    #[must_use]
    pub fn place_back(&self, at: Vec2) -> Vec2 {
        at / self.length + self.origin
    }

    fn points(&self, points: &mut [Point]) {
        for p in points {
            let q = self.place(vec2(*p));
            *p = [q.x, q.y];
        }
    }

    fn point(&self, p: &mut Point) {
        self.points(std::slice::from_mut(p));
    }

    fn times(&self, times: &mut [f64]) {
        times.iter_mut().for_each(|t| *t *= self.time);
    }

    fn motion(&self, motion: &mut Motion) {
        self.times(&mut motion.times_s);
        self.points(&mut motion.points_m);
    }

    /// The similar scene; the robot, whose size is its maker's, is left out.
    #[must_use]
    pub(crate) fn scaled(&self, scene: &Scene) -> Scene {
        let mut out = Scene { robot: None, ..scene.clone() };
        let l = self.length;
        let per_m = |force: &mut Point| *force = [force[0] / l, force[1] / l];
        per_m(&mut out.environment.wind_n_per_m);
        out.environment.winds_n_per_m.iter_mut().for_each(per_m);
        self.times(&mut out.environment.wind_times_s);
        for c in &mut out.cables {
            c.length_m *= l;
            c.linear_density_kg_per_m /= l;
            c.bending_stiffness_n_m2 *= l * l;
            c.diameter_m *= l;
            c.min_bend_radius_m *= l;
            c.breaking_time_s *= self.time;
            if let Some(limit) = &mut c.sidewall_limit_n_per_m {
                *limit /= l;
            }
            self.points(&mut c.route_m);
            for s in &mut c.supports {
                for length in [&mut s.arc_length_m, &mut s.radius_m].into_iter().flatten() {
                    *length *= l;
                }
                if let Some(at) = &mut s.at_m {
                    self.point(at);
                }
                if let Some(motion) = &mut s.motion {
                    self.motion(motion);
                }
                if let Some(release) = &mut s.release_s {
                    *release *= self.time;
                }
                self.times(&mut s.times_s);
            }
        }
        for o in &mut out.obstacles {
            match &mut o.shape {
                Shape::Terrain { points_m } | Shape::Polygon { points_m } => self.points(points_m),
                Shape::Polyline { points_m, thickness_m } => {
                    self.points(points_m);
                    *thickness_m *= l;
                }
                Shape::Circle { center_m, radius_m } => {
                    self.point(center_m);
                    *radius_m *= l;
                }
            }
        }
        for load in &mut out.loads {
            load.arc_length_m *= l;
            self.times(&mut load.times_s);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_similarity_is_none_where_solvers_are_at_home() {
        assert!(Similarity::to_natural(12.0, Vec2::new(3.0, 5.0)).is_none());
        for length in [1e-3, 0.5, 5e3, 1e6] {
            let by = Similarity::to_natural(length, Vec2::new(3.0, 5.0)).unwrap();
            // A long cable is made no shorter than it must be.
            let copy = if length < 2.0 { 8.0..32.0 } else { 250.0..1000.0 };
            assert!(copy.contains(&(length * by.length)) && by.length == by.time * by.time, "{length}: {by:?}");
            assert_eq!(by.place_back(by.place(Vec2::new(7.25, -1.5))), Vec2::new(7.25, -1.5));
        }
    }
}

//! Obstacles that a cable cannot come to are not there for it.
//!
//! A point of a cable between two places that hold it is on a way from one to the other that is no
//! longer than the stretched cable between them: it lies in the ellipse with these as foci. Beyond
//! the outermost held place it lies in a circle. A cable none of whose ellipses, wherever its
//! supports go, meets an obstacle has the answer that it has without obstacles, to the bit: mass
//! and loss of a free cable, and no search for contacts.
//!
//! This holds while nothing draws a support aside, while the cable is whole, and up to the tension
//! [`Problem::max_tension_within_reach_n`]; from then on all obstacles are there
//! ([`Problem::with_all_obstacles`]).

use std::sync::Arc;

use super::definition::{Problem, SupportPoint};
use crate::contact::World;
use crate::contact::geometry::{Body, Edge};
use crate::math::{Vec2, larger, smaller};
use crate::scene::SupportKind;

/// The greatest tension with which reach is reckoned, in parts of the breaking tension. A cable may
/// have more for less than its breaking time. Less: all obstacles are there for the rest of a run
/// after a jerk; more: obstacles are within reach that no cable comes to.
const TENSION_MARGIN: f64 = 1.2;

/// Distance from an obstacle that counts as touching it, in parts of the cable's radius. Less: a
/// taut cable that just does not touch is free, although barriers of models push from 1e-3 of the
/// radius on; more: a cable that hangs close above the ground is not free.
const CLEARANCE_RADII: f64 = 1.0;

/// Halvings of a motion between two of its knots. Fewer: long quick motions have obstacles within
/// reach that they only pass by; more: time to set up a scene.
const MAX_MOTION_HALVINGS: u32 = 8;

/// Two places that hold the cable and the length of the cable between them: every point of it is in
/// the ellipse about them.
struct ReachEllipse<'a> {
    supports: [&'a SupportPoint; 2],
    /// The longest way from one over a point of the cable to the other, m.
    way: f64,
}

impl Problem {
    /// Leaves out all obstacles if the cable can come to none of them.
    pub(super) fn leave_out_unreachable(&mut self) {
        if self.world.is_empty() || !is_free_of(self, &self.world) {
            return;
        }
        self.leave_out_obstacles();
        if let Some((_, similar)) = &mut self.similar {
            Arc::make_mut(similar).leave_out_obstacles();
        }
    }

    fn leave_out_obstacles(&mut self) {
        self.unreachable = Some(std::mem::take(&mut self.world));
    }

    /// The same with the obstacles that were out of reach; None if there are none.
    #[must_use]
    pub(crate) fn with_all_obstacles(&self) -> Option<Arc<Self>> {
        let world = self.unreachable.clone()?;
        let similar = self.similar.as_ref().map(|(by, copy)| (*by, copy.with_all_obstacles().unwrap_or(copy.clone())));
        Some(Arc::new(Self { world, unreachable: None, similar, ..self.clone() }))
    }

    /// The tension up to which obstacles are out of reach that were left out, N; None if there are
    /// none.
    #[must_use]
    pub(crate) fn max_tension_within_reach_n(&self) -> Option<f64> {
        self.unreachable.as_ref().map(|_| TENSION_MARGIN * self.cable.breaking_tension_n)
    }

    /// True if the cable at these places (m) is at or in obstacles that were left out: it does not
    /// come there by itself.
    #[must_use]
    pub(crate) fn is_beyond_reach(&self, places: &[Vec2]) -> bool {
        let Some(world) = &self.unreachable else { return false };
        let touches = |at: &Vec2| world.signed_gap(*at, self.length).is_some_and(|gap| gap.gap_m < self.radius);
        places.iter().any(touches)
    }
}

/// True if the cable can come to nothing of a world, as long as it is held.
fn is_free_of(problem: &Problem, world: &World) -> bool {
    // A robot goes where it is sent, and a cable that is let go falls without end.
    let wanders = |s: &SupportPoint| s.kind == SupportKind::Robot || s.release.is_some();
    if problem.has_moving_bodies() || problem.supports.iter().any(wanders) {
        return false;
    }
    let ellipses = ellipses(problem);
    !ellipses.is_empty() && ellipses.iter().all(|ellipse| ellipse.is_clear_of(world, CLEARANCE_RADII * problem.radius))
}

/// The ellipses in which a cable is; none if nothing holds a point of its material.
fn ellipses(problem: &Problem) -> Vec<ReachEllipse<'_>> {
    let strain = TENSION_MARGIN * problem.cable.breaking_tension_n / problem.axial_stiffness;
    let stretched = |length: f64| length * problem.thermal_stretch * (1.0 + strain);
    let is_held = |s: &&SupportPoint| matches!(s.kind, SupportKind::Fixed | SupportKind::Clamped) && s.at.is_some();
    let supports_in_place: Vec<(&SupportPoint, f64)> =
        problem.supports.iter().filter(is_held).filter_map(|s| Some((s, s.arc_length?))).collect();
    let (Some(&(first, from)), Some(&(last, to))) = (supports_in_place.first(), supports_in_place.last()) else {
        return Vec::new();
    };
    // There and back.
    let circle = |s, length: f64| ReachEllipse { supports: [s, s], way: 2.0 * stretched(length) };
    let between = supports_in_place
        .windows(2)
        .map(|pair| ReachEllipse { supports: [pair[0].0, pair[1].0], way: stretched(pair[1].1 - pair[0].1) });
    between.chain([circle(first, from), circle(last, problem.length - to)]).collect()
}

impl ReachEllipse<'_> {
    /// True if at no time a point of a world is in it, or nearer to it than `clearance` (m).
    fn is_clear_of(&self, world: &World, clearance: f64) -> bool {
        let mut times: Vec<f64> =
            self.supports.iter().filter_map(|s| s.motion.as_ref()).flat_map(|m| m.times_s.iter().copied()).collect();
        times.sort_by(f64::total_cmp);
        times.insert(0, 0.0);
        times.push(times.last().map_or(0.0, |last| last + 1.0));
        times.windows(2).all(|span| self.is_clear_between([span[0], span[1]], world, clearance, MAX_MOTION_HALVINGS))
    }

    /// The same between two times (s), between which each coordinate of a support goes one way.
    fn is_clear_between(&self, [from, to]: [f64; 2], world: &World, clearance: f64, halvings: u32) -> bool {
        let place = |k: usize, time: f64| self.supports[k].place_at(time).map_or_else(Vec2::zeros, |(at, _)| at);
        // A support is within half a diagonal of the middle of the box of its way.
        let boxes = [0, 1].map(|k| [place(k, from), place(k, to)]);
        let foci = boxes.map(|[a, b]| (a + b) / 2.0);
        let aside: f64 = boxes.iter().map(|[a, b]| (b - a).norm() / 2.0).sum();
        if is_clear_of(world, foci, self.way + aside, clearance) {
            return true;
        }
        let middle = from + (to - from) / 2.0;
        aside > 0.0
            && halvings > 0
            && [[from, middle], [middle, to]]
                .into_iter()
                .all(|part| self.is_clear_between(part, world, clearance, halvings - 1))
    }
}

/// True if no point of a world is on a way of at most `way` (m) from one focus to the other, or
/// nearer to such a point than `clearance` (m).
fn is_clear_of(world: &World, foci: [Vec2; 2], way: f64, clearance: f64) -> bool {
    let [p, q] = foci;
    let half = Vec2::repeat(way / 2.0);
    let middle = (p + q) / 2.0;
    world.geometry().bodies().iter().all(|body: &Body| {
        let off = body.offset + clearance;
        let beyond = |way_over: f64| way_over - 2.0 * off > way;
        match body.center {
            Some(center) => beyond((center - p).norm() + (center - q).norm()),
            None => {
                let margin = half + Vec2::repeat(off);
                body.candidates(middle - margin, middle + margin).all(|k| beyond(way_over(&body.edges[k], foci)))
            }
        }
    })
}

/// The shortest way from one place over a point of an edge to another, m.
///
/// It meets the line of the edge where a ray of light would be reflected, or the end of the edge
/// next to that.
fn way_over(edge: &Edge, [p, q]: [Vec2; 2]) -> f64 {
    let (normal, length) = (edge.normal(), edge.length());
    let height = |at: Vec2| (at - edge.from).dot(&normal).abs();
    let foot = |at: Vec2| (at - edge.from).dot(&edge.tangent);
    let heights = height(p) + height(q);
    let along = if heights > 0.0 { (foot(p) * height(q) + foot(q) * height(p)) / heights } else { foot(p) };
    let at = edge.from + edge.tangent * smaller(larger(along, 0.0), length);
    (at - p).norm() + (at - q).norm()
}

#[cfg(test)]
#[allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic
mod tests {
    use super::*;
    use crate::problem::problems;
    use crate::scene::{Motion, Obstacle, Scene, Shape, Support, catalog};

    #[test]
    fn the_shortest_way_over_an_edge_is_that_of_light() {
        let edge = Edge::between(Vec2::new(0.0, 0.0), Vec2::new(10.0, 0.0));
        let way = |p, q| way_over(&edge, [p, q]);
        // Mirrored: 4 aside and 2 + 1 down.
        assert!((way(Vec2::new(3.0, 2.0), Vec2::new(7.0, 1.0)) - 5.0).abs() < 1e-12);
        // Through it.
        assert!((way(Vec2::new(3.0, 2.0), Vec2::new(7.0, -1.0)) - 5.0).abs() < 1e-12);
        // Over its end.
        assert!((way(Vec2::new(13.0, 4.0), Vec2::new(13.0, -4.0)) - 10.0).abs() < 1e-12);
        // Both on its line.
        assert!((way(Vec2::new(2.0, 0.0), Vec2::new(5.0, 0.0)) - 3.0).abs() < 1e-12);
    }

    /// A cable of 10 m over 8 m, 3 m high, with the deepest sag that any point of it can have 3 m.
    fn over_a_floor(down_m: f64, change: impl FnOnce(&mut Scene)) -> bool {
        let mut scene = catalog::hanging_span();
        let points_m = vec![[-50.0, 3.0 - down_m], [50.0, 3.0 - down_m]];
        scene.obstacles =
            vec![Obstacle { name: "floor".into(), shape: Shape::Terrain { points_m }, friction: Some(0.3) }];
        let cable = &mut scene.cables[0];
        (cable.length_m, cable.axial_stiffness_n, cable.breaking_tension_n) = (10.0, 1e7, 1e4);
        cable.supports = vec![Support::fixed("left", [-4.0, 3.0]), Support::fixed("right", [4.0, 3.0])];
        change(&mut scene);
        problems(&scene).unwrap()[0].unreachable.is_some()
    }

    #[test]
    fn a_floor_is_out_of_reach_below_the_ellipse_of_the_cable() {
        assert!(over_a_floor(3.1, |_| ()));
        assert!(!over_a_floor(2.99, |_| ()));
        // A cable that stretches by a tenth before it breaks.
        assert!(!over_a_floor(3.1, |s| s.cables[0].axial_stiffness_n = 1.2e5));
        assert!(over_a_floor(4.0, |s| s.cables[0].axial_stiffness_n = 1.2e5));
    }

    #[test]
    fn supports_that_go_take_the_reach_along() {
        let motion = |to: [f64; 2]| Some(Motion { times_s: vec![0.0, 5.0], points_m: vec![[4.0, 3.0], to] });
        // Ends that come together let the cable hang down 5 m.
        assert!(!over_a_floor(4.0, |s| s.cables[0].supports[1].motion = motion([-3.0, 3.0])));
        assert!(over_a_floor(5.1, |s| s.cables[0].supports[1].motion = motion([-3.0, 3.0])));
        assert!(over_a_floor(3.1, |s| s.cables[0].supports[1].motion = motion([4.0, 8.0])));
    }

    #[test]
    fn what_is_let_go_or_held_by_nothing_comes_to_everything() {
        assert!(!over_a_floor(50.0, |s| s.cables[0].supports[1].release_s = Some(1.0)));
        // A free end reaches the length of the cable.
        let free_end = |s: &mut Scene| s.cables[0].supports[1] = Support::free("end");
        assert!(over_a_floor(10.1, free_end));
        assert!(!over_a_floor(9.9, free_end));
    }
}

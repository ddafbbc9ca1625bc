//! A wheel is a round that the cable may leave: this copy of a cable is without some of its wheels.
//!
//! A pulley of the models keeps the cable on its wheel. Where the cable does not press on it, it
//! hangs clear. A wheel is then what a post of the same radius and friction is. One that moves is
//! taken away until the cable comes to it again, if its post would have to follow a hand, or the
//! cable is better laid on the wheel again.

use std::f64::consts::PI;

use nalgebra::Rotation2;

use super::wheel_passage::{facing, turn_through_centre};
use crate::math::{Vec2, larger, perp, vec2};
use crate::scene::{Cable, Obstacle, Scene, Shape, Support, SupportKind};

/// Distance of the route from the centre of a wheel, in radii of the centre line round it. Smaller:
/// the route cuts wheels whose neighbours are narrower; larger: it comes nearer to what else is
/// there.
const ROUTE_RADII: f64 = 1.2;
/// Longest arc of a wheel between two points of the route, rad: at that distance from the wheel the
/// line between them is clear of it up to 1.17. Smaller: more points than needed.
const LONGEST_ARC: f64 = PI / 3.0;

/// A scene with posts in place of some wheels of a cable.
#[derive(Clone, Debug)]
pub(super) struct WithPosts {
    pub scene: Scene,
    /// The cable without those supports, by its own route if it has one, and past the wheels from
    /// support to support.
    pub cables: Vec<Cable>,
    pub wheels: Vec<WheelLeft>,
}

/// The thing that a copy has in the place of a wheel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StandIn {
    /// The wheel itself.
    #[default]
    Wheel,
    /// A post.
    Post,
    /// Nothing.
    Nothing,
}

/// A wheel that is a support no more in the copy.
#[derive(Clone, Debug)]
pub struct WheelLeft {
    /// Index of its support.
    pub support: usize,
    /// Name of the post, which no obstacle of the scene has; None if nothing stands there.
    pub post: Option<String>,
    /// Centre when it was left, m.
    pub center: Vec2,
}

/// For each support of a cable, whether it is a wheel.
pub(super) fn wheels(cable: &Cable) -> Vec<bool> {
    let last = cable.supports.len().saturating_sub(1);
    let is_wheel = |(k, s): (usize, &Support)| {
        let round = s.kind == SupportKind::Pulley && s.radius_m.is_some_and(|r| r > 0.0);
        k > 0 && k < last && round && s.at_m.is_some()
    };
    cable.supports.iter().enumerate().map(is_wheel).collect()
}

/// Returns whether a wheel stands where it is.
pub(super) fn stands_still(wheel: &Support) -> bool {
    wheel.motion.is_none() && wheel.release_s.is_none()
}

/// Returns the scene with these things in place of the wheels of a cable; None where all are
/// wheels.
pub(super) fn with_posts(scene: &Scene, cable: &Cable, stand_ins: &[StandIn]) -> Option<WithPosts> {
    let replaced: Vec<bool> = stand_ins.iter().map(|s| *s != StandIn::Wheel).collect();
    let mut scene = scene.clone();
    let mut wheels = Vec::new();
    for k in (0..replaced.len()).filter(|k| replaced[*k]) {
        let support = &cable.supports[k];
        let center = support.at_m?;
        if stand_ins[k] == StandIn::Nothing {
            wheels.push(WheelLeft { support: k, post: None, center: vec2(center) });
            continue;
        }
        let mut post = support.name.clone();
        while scene.obstacles.iter().any(|o| o.name == post) {
            post.push('\'');
        }
        let shape = Shape::Circle { center_m: center, radius_m: support.radius_m? };
        scene.obstacles.push(Obstacle { name: post.clone(), shape, friction: Some(support.friction.unwrap_or(0.0)) });
        wheels.push(WheelLeft { support: k, post: Some(post), center: vec2(center) });
    }
    let own = (!cable.route_m.is_empty()).then(|| cable.route_m.clone());
    let past_posts = route(&scene, cable, &replaced).map(|r| r.into_iter().map(Into::into).collect());
    let by = |route_m| {
        let mut keep = replaced.iter().map(|r| !r);
        let mut cable = Cable { route_m, ..cable.clone() };
        cable.supports.retain(|_| keep.next().unwrap_or(true));
        cable
    };
    let cables = own.into_iter().chain(past_posts).map(by).collect();
    Some(WithPosts { scene, cables, wheels })
}

/// The way from support to support, past each wheel on its side; None where an inner support has no
/// place. An end without one is where its load draws it, or the weight.
fn route(scene: &Scene, cable: &Cable, replaced: &[bool]) -> Option<Vec<Vec2>> {
    let place = |k: usize| match cable.supports[k].kind {
        SupportKind::Robot => scene.hitch_m(),
        _ => cable.supports[k].at_m,
    };
    let mut places: Vec<Option<Vec2>> = (0..replaced.len()).map(|k| place(k).map(vec2)).collect();
    let inner: Vec<Vec2> = places.iter().flatten().copied().collect();
    let way: f64 = inner.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    let last = replaced.len() - 1;
    for (end, beside) in [(0, inner.first()), (last, inner.last())] {
        let force = cable.supports[end].force_n.map_or_else(Vec2::zeros, vec2);
        let drawn = force.try_normalize(0.0).unwrap_or_else(|| Vec2::new(0.0, -1.0));
        places[end] = places[end].or(Some(beside? + drawn * larger(cable.length_m - way, 0.0)));
    }
    let places: Vec<Vec2> = places.into_iter().collect::<Option<_>>()?;
    let mut route = Vec::new();
    for (k, at) in places.iter().enumerate() {
        if !replaced[k] {
            route.push(*at);
            continue;
        }
        let s = &cable.supports[k];
        let [before, after] = [at - places[k - 1], places[k + 1] - at];
        let facing = facing(s.side.unwrap_or_default(), before + after);
        let out = ROUTE_RADII * (s.radius_m? + 0.5 * cable.diameter_m);
        let turn = turn_through_centre(facing, before, after);
        let Some(arrives) = before.try_normalize(0.0).map(|t| perp(t) * facing * out) else { continue };
        // A way that turns away from its wheel passes it in one point, halfway of its turn.
        let (legs, first) = if turn > 0.0 { ((turn / LONGEST_ARC).ceil(), 0.0) } else { (0.0, 0.5 * turn) };
        let leg = if legs > 0.0 { turn / legs } else { 0.0 };
        route.extend((0..=legs as usize).map(|k| at + Rotation2::new(-facing * (first + k as f64 * leg)) * arrives));
    }
    Some(route)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a failing test is meant to panic

    use crate::contact::distance::segment_segment;
    use crate::math::{Vec2, smaller};
    use crate::problem::problems;
    use crate::problem::wheels_as_posts::StandIn;
    use crate::scene::{Support, catalog};

    /// Over the first and the last wheel the way turns by more than 150°. Points of it stood on the
    /// wrong sides there, so that it led through the posts.
    #[test]
    fn issue_015_the_way_past_posts_turns_with_the_cable() {
        let mut scene = catalog::hanging_span();
        scene.loads.clear();
        let wheel = |name: &str, radius, at| Support { radius_m: Some(radius), ..Support::pulley(name, at) };
        let c = &mut scene.cables[0];
        (c.length_m, c.diameter_m, c.route_m) = (10.5, 0.02, Vec::new());
        c.supports = vec![
            Support::fixed("a", [0.0, -0.63]),
            wheel("high", 0.016, [0.52, 2.07]),
            wheel("low", 0.041, [1.03, 1.38]),
            wheel("highest", 0.024, [1.55, 2.71]),
            Support::fixed("b", [2.06, -0.99]),
        ];
        let problem = &problems(&scene).unwrap()[0];
        let wheels = problem.wheels.as_ref().unwrap();
        assert_eq!(wheels.standing, [false, true, true, true, false]);
        let posts = wheels.all_as_posts().unwrap();
        assert_eq!(posts.problem.supports.len(), 2);
        for wheel in &posts.wheels {
            let clear = |leg: &[Vec2]| segment_segment(leg[0], leg[1], wheel.center, wheel.center);
            let nearest = posts.problem.route.windows(2).map(clear).fold(f64::INFINITY, smaller);
            let radius = problem.supports[wheel.support].wheel_radius;
            assert!(nearest > radius && nearest < 1.3 * radius, "{nearest} m from {:?} of {radius} m", wheel.post);
        }
        let same = wheels.left(&[StandIn::Wheel; 5], &[]).unwrap();
        assert!(same.wheels.is_empty() && same.problem.supports.len() == 5, "none is left");
    }
}

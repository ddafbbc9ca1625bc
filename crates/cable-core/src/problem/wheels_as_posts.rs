//! A wheel that stands still is a round that the cable may leave: this copy of a cable has posts in
//! place of its wheels.
//!
//! A pulley of the models keeps the cable on its wheel. Where the cable does not press on it, it
//! hangs clear, and the wheel is what a post of the same radius and friction is.

use std::sync::Arc;

use super::{Problem, ground_route, problem, route_check, support_clearance};
use crate::error::SceneError;
use crate::math::{Vec2, perp, vec2};
use crate::scene::{Cable, Obstacle, PulleySide, Scene, Shape, SupportKind};

/// Distance of the route from the centre of a wheel, in radii of the centre line round it. Smaller:
/// the route cuts wheels whose neighbours are narrower; larger: it comes nearer to what else is
/// there.
const ROUTE_RADII: f64 = 1.2;

/// A cable with posts in place of wheels.
#[derive(Clone, Debug)]
pub struct WheelsAsPosts {
    /// The cable without those supports.
    pub problem: Arc<Problem>,
    /// The wheels.
    pub wheels: Vec<WheelPost>,
    /// Whether each support of the scene is one of them.
    pub replaced: Vec<bool>,
}

/// A wheel that is a post in the copy.
#[derive(Clone, Debug)]
pub struct WheelPost {
    /// Index of its support.
    pub support: usize,
    /// Name of the post, which no obstacle of the scene has.
    pub post: String,
    /// Centre, m.
    pub center: Vec2,
}

/// Returns whether a support is a wheel that stands where it is.
fn stands(cable: &Cable, k: usize) -> bool {
    let s = &cable.supports[k];
    let inner = k > 0 && k + 1 < cable.supports.len();
    let wheel = s.kind == SupportKind::Pulley && s.radius_m.is_some_and(|r| r > 0.0);
    inner && wheel && s.motion.is_none() && s.release_s.is_none() && s.at_m.is_some()
}

/// Returns the copy; None without such a wheel, or where the cable is laid by a route of its own or
/// cannot be laid round the posts.
pub(super) fn copy(scene: &Scene, index: usize, cable: &Cable) -> Option<Arc<WheelsAsPosts>> {
    let replaced: Vec<bool> = (0..cable.supports.len()).map(|k| stands(cable, k)).collect();
    if !replaced.contains(&true) || !cable.route_m.is_empty() {
        return None;
    }
    let mut scene = scene.clone();
    let mut wheels = Vec::new();
    for k in (0..replaced.len()).filter(|k| replaced[*k]) {
        let support = &cable.supports[k];
        let center = support.at_m?;
        let mut post = support.name.clone();
        while scene.obstacles.iter().any(|o| o.name == post) {
            post.push('\'');
        }
        let shape = Shape::Circle { center_m: center, radius_m: support.radius_m? };
        scene.obstacles.push(Obstacle { name: post.clone(), shape, friction: Some(support.friction.unwrap_or(0.0)) });
        wheels.push(WheelPost { support: k, post, center: vec2(center) });
    }
    let mut cable = cable.clone();
    cable.route_m = route(&scene, &cable, &replaced)?.into_iter().map(Into::into).collect();
    let mut keep = replaced.iter().map(|r| !r);
    cable.supports.retain(|_| keep.next().unwrap_or(true));
    let laid = || -> Result<Problem, SceneError> {
        let mut this = problem(&scene, index, &cable)?;
        support_clearance::clear_supports(&mut this)?;
        ground_route::lift_route(&mut this);
        route_check::check_route(&this)?;
        Ok(this)
    };
    let problem = Arc::new(laid().ok()?);
    Some(Arc::new(WheelsAsPosts { problem, wheels, replaced }))
}

/// The way from support to support, past each wheel on its side; None where a support has no place.
fn route(scene: &Scene, cable: &Cable, replaced: &[bool]) -> Option<Vec<Vec2>> {
    let place = |k: usize| match cable.supports[k].kind {
        SupportKind::Robot => scene.hitch_m(),
        _ => cable.supports[k].at_m,
    };
    let places: Vec<Vec2> = (0..replaced.len()).map(|k| place(k).map(vec2)).collect::<Option<_>>()?;
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
        let aside = |way: Vec2| way.try_normalize(0.0).map(|t| perp(t) * facing * out);
        route.extend([before, before + after, after].into_iter().filter_map(aside).map(|off| at + off));
    }
    Some(route)
}

/// Returns on which side of its wheel a cable runs, seen along it: 1 on the left (it turns
/// clockwise), −1 on the right. Over means above where it travels to the right.
pub(crate) fn facing(side: PulleySide, travel: Vec2) -> f64 {
    let right = if travel.x < 0.0 { -1.0 } else { 1.0 };
    match side {
        PulleySide::Over => right,
        PulleySide::Under => -right,
    }
}

//! A route is refused where it leads through a beam or a post, since it then does not say on which
//! side the cable lies. The ground has one side only, and a route below it is lifted.

use super::definition::Problem;
use crate::error::{SceneError, SceneFault};
use crate::scene::read::key_path::Path;

/// Greatest depth to which a route may cut into a beam besides the cable's diameter, m: drawn along
/// a surface by a few points it cuts corners off. Smaller: such routes are refused. Larger: more of
/// those that lead through something are not noticed.
const MAX_CUT: f64 = 0.05;
/// The same of small scenes, of the cable's length: where a metre of cable is drawn, routes cut a
/// centimetre.
const MAX_CUT_FRACTION: f64 = 0.01;
/// Part of the radius of a post that a route may cut into it: drawn round it as a polygon of four
/// points it cuts in 0.3.
const MAX_POST_CUT_FRACTION: f64 = 0.5;
/// Distance of the points of a route that are looked at, m, and how many at most: of longer ones
/// they are farther apart.
const SAMPLE_SPACING: f64 = 0.05;
const MAX_SAMPLES: f64 = 20_000.0;

/// Returns how deep a route may cut into something before that is not its coarseness, m: at small
/// scenes a part of the cable.
pub(super) fn allowed_depth(problem: &Problem) -> f64 {
    let cut = MAX_CUT_FRACTION * problem.length;
    (if cut < MAX_CUT { cut } else { MAX_CUT }) + 2.0 * problem.radius
}

/// Refuses a route of which a point is deep inside a beam or a post.
pub(super) fn check_route(problem: &Problem) -> Result<(), SceneError> {
    let world = problem.world.geometry();
    let length: f64 = problem.route.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    // A cable without a route in the scene is laid past everything.
    if problem.cable.route_m.is_empty() || world.is_empty() || !length.is_finite() {
        return Ok(());
    }
    let step = SAMPLE_SPACING.max(length / MAX_SAMPLES);
    for (leg, w) in problem.route.windows(2).enumerate() {
        let points = ((w[1] - w[0]).norm() / step).ceil();
        let mut deepest: Option<(f64, SceneFault)> = None;
        // Both ends of the route are supports, which are looked at by themselves.
        for k in 1..points as usize {
            let at = w[0] + (w[1] - w[0]) * (k as f64 / points);
            for body in world.bodies().iter().filter(|b| !b.is_ground()) {
                let Some(gap) = body.signed_gap(at, f64::INFINITY) else { continue };
                let (depth_m, allowed) = match body.center {
                    Some(_) => (-gap.gap_m, MAX_POST_CUT_FRACTION * body.offset),
                    None => (-gap.gap_m - body.offset, allowed_depth(problem)),
                };
                if depth_m > allowed && deepest.as_ref().is_none_or(|d| depth_m > d.0) {
                    let obstacle = body.name.clone();
                    deepest = Some((depth_m, SceneFault::RouteInside { obstacle, depth_m, x_m: at.x, y_m: at.y }));
                }
            }
        }
        if let Some((_, fault)) = deepest {
            return Err(Path::Root.key("cables").index(problem.cable_index).key("route_m").index(leg).fault(fault));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

    use crate::error::SceneFault;
    use crate::problem::problems;
    use crate::scene::{Obstacle, Scene, Shape, Support, catalog};

    /// A cable along a route past a hill, a beam and a post.
    fn along(route_m: &[[f64; 2]]) -> Scene {
        let mut scene = catalog::hanging_span();
        scene.loads.clear();
        let shapes = [
            Shape::Terrain { points_m: vec![[-5.0, 0.0], [3.0, 0.0], [5.0, 2.0], [7.0, 0.0], [30.0, 0.0]] },
            Shape::Polygon { points_m: vec![[10.0, 1.0], [11.0, 1.0], [11.0, 1.5], [10.0, 1.5]] },
            Shape::Circle { center_m: [15.0, 2.0], radius_m: 0.5 },
        ];
        let named = |(k, shape)| Obstacle { name: format!("obstacle {k}"), shape, friction: None };
        scene.obstacles = shapes.into_iter().enumerate().map(named).collect();
        let c = &mut scene.cables[0];
        (c.length_m, c.diameter_m, c.route_m) = (30.0, 0.02, route_m.to_vec());
        c.supports = vec![Support::fixed("A", route_m[0]), Support::fixed("B", route_m[route_m.len() - 1])];
        scene
    }

    #[test]
    fn a_route_through_something_solid_is_refused_where_it_is_deep() {
        let past = [[0.0, 1.0], [5.0, 2.2], [9.0, 2.0], [12.0, 2.0], [14.4, 2.5], [15.6, 2.5], [18.0, 1.0]];
        assert!(problems(&along(&past)).is_ok());
        // Through the hill: there is one side of it. A beam's corner cut off by 4 cm, a post gone
        // round by four points.
        let near =
            [[0.0, 0.5], [9.96, 1.5], [10.04, 1.46], [12.0, 2.0], [14.5, 2.0], [15.0, 2.5], [15.5, 2.0], [18.0, 1.0]];
        assert!(problems(&along(&near)).is_ok());
        let through = [
            (vec![[0.0, 3.0], [9.0, 3.0], [9.0, 1.25], [12.0, 1.25], [18.0, 3.0]], "obstacle 1", 2, 0.25, 10.5),
            (vec![[0.0, 3.0], [10.0, 3.0], [13.0, 2.0], [18.0, 2.0]], "obstacle 2", 2, 0.5, 15.0),
        ];
        for (route, name, leg, least, x) in through {
            let error = problems(&along(&route)).unwrap_err();
            assert_eq!(error.path, format!("cables[0].route_m[{leg}]"));
            let SceneFault::RouteInside { obstacle, depth_m, x_m, .. } = error.fault else { panic!("{error}") };
            assert_eq!(obstacle, name);
            assert!((depth_m - least).abs() < 0.03 && (x_m - x).abs() < 0.3, "{name}: {depth_m} m at {x_m} m");
        }
    }
}

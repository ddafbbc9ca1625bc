//! This scene leads a taut cable over so many ridges, with as many corners in the ground as is
//! wished.

use cable_core::Scene;
use cable_core::scene::{Obstacle, Shape, Support, catalog};

/// Height at which the route passes over all ridges, m, and over the highest of them.
const ABOVE_M: [f64; 2] = [9.0, 5.0];

/// A flexible cable with friction over ground.
fn over(points_m: Vec<[f64; 2]>, (a, b): ([f64; 2], [f64; 2]), length_m: f64) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    scene.obstacles =
        vec![Obstacle { name: "ground".to_owned(), shape: Shape::Terrain { points_m }, friction: Some(0.3) }];
    let top = scene
        .obstacles
        .iter()
        .map(|o| if let Shape::Terrain { points_m } = &o.shape { points_m.as_slice() } else { &[] });
    let top = top.flatten().map(|p| p[1] + ABOVE_M[1]).fold(ABOVE_M[0], f64::max);
    let c = &mut scene.cables[0];
    (c.bending_stiffness_n_m2, c.axial_stiffness_n, c.diameter_m) = (0.0, 1e6, 0.02);
    (c.service_tension_n, c.breaking_tension_n, c.length_m) = (1e15, 1e15, length_m);
    c.route_m = vec![a, [a[0], top], [b[0], top], b];
    c.supports = vec![Support::fixed("A", a), Support::fixed("B", b)];
    scene
}

/// So many ridges a metre apart, on a rise, so that a taut cable bends at each; with `fine` more
/// corners on each flank.
#[must_use]
pub fn ridges(count: usize, fine: usize) -> Scene {
    arched(count, fine, 0.02 * (count as f64 + 1.0))
}

/// The same on a rise that is so steep at its foot.
#[must_use]
pub fn arched(count: usize, fine: usize, steep: f64) -> Scene {
    let height = |x: f64| steep * x * (1.0 - x / (count as f64 + 1.0));
    let mut points = vec![[-5.0, -1.0], [0.5, -1.0]];
    for k in 1..=count {
        let x = k as f64;
        points.push([x, height(x)]);
        // A hollow of many corners between two ridges.
        for i in 1..fine {
            let u = i as f64 / fine as f64;
            let sag = 0.4 + 0.4 * (1.0 - (2.0 * u - 1.0).powi(2));
            if k < count {
                points.push([x + u, height(x) + u * (height(x + 1.0) - height(x)) - sag]);
            }
        }
        if k < count && fine <= 1 {
            points.push([x + 0.5, height(x + 0.5) - 0.5]);
        }
    }
    let end = count as f64 + 1.0;
    points.extend([[end - 0.5, -1.0], [end + 5.0, -1.0]]);
    let way: f64 = (0..=count).map(|k| (height(k as f64 + 1.0) - height(k as f64)).hypot(1.0)).sum();
    over(points, ([0.0, 0.0], [end, 0.0]), way * 1.0005)
}

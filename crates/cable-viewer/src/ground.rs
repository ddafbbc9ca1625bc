//! How high the ground is under a point, for things that stand on it.

use cable_core::Scene;
use cable_core::scene::Shape;

/// The highest terrain at `x_m`, m; None where there is none.
#[must_use]
pub fn height_at(scene: &Scene, x_m: f64) -> Option<f64> {
    let terrains = scene.obstacles.iter().filter_map(|o| match &o.shape {
        Shape::Terrain { points_m } => Some(points_m),
        _ => None,
    });
    let stretches = terrains.flat_map(|points| points.windows(2));
    let heights = stretches.filter(|s| s[0][0].min(s[1][0]) <= x_m && x_m <= s[0][0].max(s[1][0])).map(|s| {
        let ([ax, ay], [bx, by]) = (s[0], s[1]);
        if ax == bx { ay.max(by) } else { ay + (by - ay) * (x_m - ax) / (bx - ax) }
    });
    heights.reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ground_is_that_of_the_tank() {
        let scene = cable_core::scene::catalog::tank();
        let at_zero = height_at(&scene, 0.0).expect("ground");
        assert!((at_zero - 0.4604).abs() < 1e-9, "{at_zero}");
        assert_eq!(height_at(&scene, 100.0), None);
        assert_eq!(height_at(&scene, f64::NAN), None);
    }
}

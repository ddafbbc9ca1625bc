//! These functions draw random scenes of cables with more length than they need, for the campaign
//! of folds and the example that prints one.

#[path = "../dice/mod.rs"]
mod dice;

use cable_core::scene::{Obstacle, Scene, Shape, Support, View, catalog};
use dice::MmixDice;

pub const GRAVITY: f64 = 9.80665;
pub const RADIUS: f64 = 0.014;
pub const FAMILIES: [&str; 7] = ["terrain", "floor", "inside", "one place", "no ground", "route", "plan"];

/// Height of a polyline at x.
pub fn height(ground: &[[f64; 2]], x: f64) -> f64 {
    let k = ground.windows(2).position(|p| x <= p[1][0]).unwrap_or(0);
    let ([a, b], [c, d]) = (ground[k], ground[k + 1]);
    b + (d - b) * (x - a) / (c - a)
}

fn box_at(x: f64, y: f64, wide: f64, high: f64) -> Shape {
    Shape::Polygon { points_m: vec![[x, y], [x + wide, y], [x + wide, y + high], [x, y + high]] }
}

/// A scene of family `seed` modulo their number, and its name.
pub fn scene(seed: u64) -> (&'static str, Scene) {
    let mut r = MmixDice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1);
    for _ in 0..8 {
        r.unit();
    }
    let name = FAMILIES[(seed % FAMILIES.len() as u64) as usize];
    let mut s = catalog::hanging_span();
    s.loads.clear();
    s.obstacles.clear();
    let width = r.within(3.0, 20.0);
    let ground: Vec<[f64; 2]> = match name {
        "terrain" => {
            let n = 12;
            let high = r.log(0.05, 0.6);
            let at = |k: usize| -5.0 + (width + 10.0) * k as f64 / n as f64;
            (0..=n).map(|k| [at(k), r.within(-high, high)]).collect()
        }
        _ => vec![[-50.0, 0.0], [width + 50.0, 0.0]],
    };
    let above = RADIUS + 1e-3;
    let (mut a, mut b) = ([0.0, r.log(0.1, 3.0)], [width, r.log(0.1, 3.0)]);
    if name == "one place" {
        b = if r.unit() < 0.5 { a } else { [a[0], a[1] + r.within(0.0, 1.0)] };
    }
    a[1] += height(&ground, a[0]) + above;
    b[1] += height(&ground, b[0]) + above;
    if name == "one place" && b[1] - a[1] < 0.1 {
        b = a;
    }
    let count = match name {
        "inside" | "route" | "no ground" | "plan" => 1 + (r.unit() * 3.0) as usize,
        _ => (r.unit() * 4.0) as usize,
    };
    let mut route = vec![a];
    for k in 0..count {
        let spread = if name == "one place" {
            r.within(-3.0, 3.0)
        } else {
            width * (k as f64 + r.within(0.1, 0.9)) / count as f64
        };
        let x = spread;
        let low = height(&ground, x);
        let friction = Some(r.pick(&[0.0, 0.2, 0.3, 0.4, 0.6]));
        let (round, size) = (r.unit() < 0.4, r.within(0.1, 0.4));
        let on_ground = r.unit() < 0.3;
        let mut y = low + r.within(0.3, 3.2);
        let shape = if round {
            Shape::Circle { center_m: [x, y], radius_m: size }
        } else {
            let (wide, high) = (r.within(0.2, if name == "inside" { 3.0 } else { 1.0 }), r.within(0.2, 1.5));
            if on_ground && name != "no ground" && name != "plan" {
                y = low.min(height(&ground, x + wide)) - 0.2;
            }
            box_at(x, y, wide, high + if on_ground { 0.2 } else { 0.0 })
        };
        let top = match &shape {
            Shape::Polygon { points_m } => points_m.iter().map(|p| p[1]).fold(0.0, f64::max),
            _ => y + size,
        };
        // A support on or a little over a thing.
        if name == "inside" {
            let middle = match &shape {
                Shape::Polygon { points_m } => 0.5 * (points_m[0][0] + points_m[1][0]),
                _ => x,
            };
            let over = top + above + if r.unit() < 0.5 { 0.0 } else { r.log(0.01, 1.0) };
            if k == 0 {
                a = [middle, over];
                route = vec![a];
            } else if k + 1 == count {
                b = [middle, over];
            }
        }
        if name == "route" || name == "plan" {
            let side = if r.unit() < 0.6 || name == "plan" { 1.0 } else { -1.0 };
            let side = if name == "plan" && r.unit() < 0.5 { -1.0 } else { side };
            let wide = match &shape {
                Shape::Polygon { points_m } => [points_m[0][0], points_m[1][0]],
                _ => [x - size, x + size],
            };
            let bottom = match &shape {
                Shape::Polygon { points_m } => points_m[0][1],
                _ => y - size,
            };
            let clear = if name == "plan" { 0.03 } else { 0.1 };
            let at = if side > 0.0 { top + clear } else { bottom - clear };
            if at > low + 0.05 || name == "plan" {
                route.extend(wide.map(|x| [x, at]));
            }
        }
        s.obstacles.push(Obstacle { name: format!("o{k}"), shape, friction });
    }
    if name != "no ground" && name != "plan" {
        let friction = Some(r.pick(&[0.0, 0.1, 0.3, 0.6, 0.9]));
        s.obstacles
            .insert(0, Obstacle { name: "ground".to_owned(), shape: Shape::Terrain { points_m: ground }, friction });
    }
    if name == "inside" && (a[0] - b[0]).abs() < 0.5 {
        b[0] = a[0] + width;
    }
    route.push(b);
    let along = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
    let way: f64 = if route.len() > 2 {
        route.windows(2).map(|p| along(p[0], p[1])).sum()
    } else {
        // Up, over everything, and down.
        let top = s.obstacles.iter().map(|o| match &o.shape {
            Shape::Polygon { points_m } => points_m.iter().map(|p| p[1]).fold(0.0, f64::max),
            Shape::Circle { center_m, radius_m } => center_m[1] + radius_m,
            _ => 0.0,
        });
        let top = top.fold(a[1].max(b[1]), f64::max);
        if count == 0 { along(a, b) } else { 2.0 * top - a[1] - b[1] + (a[0] - b[0]).abs() }
    };
    let c = &mut s.cables[0];
    (c.bending_stiffness_n_m2, c.diameter_m, c.segments) = (0.0, 2.0 * RADIUS, None);
    c.axial_stiffness_n = r.log(1e5, 1e8);
    c.linear_density_kg_per_m = r.log(0.1, 5.0);
    c.friction = 0.5;
    let factor = if name == "plan" { 1.0 + r.log(1e-4, 0.1) } else { 1.0 + r.log(0.02, 3.0) };
    c.length_m = (way + if name == "one place" { 0.5 } else { 0.02 }) * factor;
    (c.service_tension_n, c.breaking_tension_n) = (1e7, 1e7);
    c.supports = vec![Support::fixed("a", a), Support::fixed("b", b)];
    if name == "plan" {
        s.view = View::Plan;
        c.friction = r.pick(&[0.0, 0.3]);
    }
    if name == "route" || name == "plan" {
        c.route_m = route;
    }
    (name, s)
}

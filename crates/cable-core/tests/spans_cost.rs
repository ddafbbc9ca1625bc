//! Temporary shape.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, missing_docs)]

use cable_core::Vec2;
use cable_core::model::spans::SpansModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::scene::{Obstacle, Scene, Shape, Support, catalog};

fn over(points_m: Vec<[f64; 2]>, (a, b): ([f64; 2], [f64; 2]), length_m: f64) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    scene.obstacles =
        vec![Obstacle { name: "ground".to_owned(), shape: Shape::Terrain { points_m }, friction: Some(0.3) }];
    let c = &mut scene.cables[0];
    (c.bending_stiffness_n_m2, c.axial_stiffness_n, c.diameter_m) = (0.0, 1e6, 0.02);
    (c.service_tension_n, c.breaking_tension_n, c.length_m) = (1e15, 1e15, length_m);
    c.route_m = vec![a, [a[0], 6.0], [b[0], 6.0], b];
    c.supports = vec![Support::fixed("A", a), Support::fixed("B", b)];
    scene
}

fn ridges(count: usize, fine: usize) -> Scene {
    let height = |x: f64| 0.02 * x * (count as f64 + 1.0 - x);
    let mut points = vec![[-5.0, -1.0], [0.5, -1.0]];
    for k in 1..=count {
        let x = k as f64;
        points.push([x, height(x)]);
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

#[test]
fn counts() {
    for (id, count, fine) in
        [("1 corner", 1, 1), ("10 corners", 10, 1), ("36 corners", 36, 1), ("10 corners, 1000 in the ground", 10, 110)]
    {
        if std::env::var("ONLY").is_ok_and(|o| o != id) {
            continue;
        }
        let scene = ridges(count, fine);
        let last = scene.cables[0].supports[1].at_m.expect("a place");
        let at = Vec2::new(last[0], last[1]);
        let mut model =
            SpansModel::new(problems(&scene).expect("valid").remove(0), Settings::default()).expect("a model");
        let begun = std::time::Instant::now();
        let settled = model.settle();
        let rest = begun.elapsed().as_secs_f64() * 1e6;
        match settled {
            Err(e) => {
                println!("{id}: {rest:.0} µs {e}");
                continue;
            }
            Ok(r) => println!(
                "{id}: rest {rest:.0} µs {} iterations {} contacts",
                r.cost.iterations,
                model.solution().contacts.len()
            ),
        }
        let most = std::env::var("STEPS").map_or(300u64, |s| s.parse().unwrap());
        let (mut sum, mut least) = (0, f64::INFINITY);
        for k in 1..=most {
            let side = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            model.drag_support(1, at + Vec2::new(0.0, 1e-3 * side));
            let begun = std::time::Instant::now();
            let r = model.advance(0.1, Inertia::QuasiStatic).expect("a step");
            least = least.min(begun.elapsed().as_secs_f64() * 1e6);
            if k <= 3 {
                println!("  {} iterations, {} halved", r.cost.iterations, r.cost.halved_steps);
            }
            sum += r.cost.iterations;
        }
        println!("  mean {:.2} iterations, best {least:.1} µs", sum as f64 / most as f64);
    }
}

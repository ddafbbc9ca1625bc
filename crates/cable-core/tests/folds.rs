//! These tests ask random scenes of cables with more length than they need, over posts, boxes and
//! rough ground: what hangs down from a contact lies in folds below it. What is found is looked at
//! with what is written here alone: contacts and supports carry the weight, nothing pushes, nothing
//! is inside anything, and what lies in folds has no tension.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod fold_scenes;

use std::time::Instant;

use cable_core::analysis::{Bending, settle_with_bending};
use cable_core::scene::{Obstacle, Scene, Shape, Support, View, catalog};
use cable_core::solution::{Solution, WarningCause};
use cable_core::{Model, Settings, Simulation};

use fold_scenes::{FAMILIES, GRAVITY, RADIUS, height, scene};

/// Returns how deep a point is inside an obstacle, of the cable's centre line, m.
fn depth(shape: &Shape, [x, y]: [f64; 2]) -> f64 {
    let to = |p: [f64; 2], q: [f64; 2]| {
        let (d, e) = ([q[0] - p[0], q[1] - p[1]], [x - p[0], y - p[1]]);
        let f = ((d[0] * e[0] + d[1] * e[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
        (e[0] - f * d[0]).hypot(e[1] - f * d[1])
    };
    match shape {
        Shape::Circle { center_m: [u, v], radius_m } => RADIUS + radius_m - (x - u).hypot(y - v),
        Shape::Polygon { points_m } => {
            let n = points_m.len();
            let edge = |k: usize| (points_m[k], points_m[(k + 1) % n]);
            let crosses =
                |([a, b], [c, d]): ([f64; 2], [f64; 2])| (b > y) != (d > y) && x < a + (c - a) * (y - b) / (d - b);
            let inside = (0..n).filter(|&k| crosses(edge(k))).count() % 2 == 1;
            let d = (0..n).map(|k| to(edge(k).0, edge(k).1)).fold(f64::INFINITY, f64::min);
            if inside { RADIUS + d } else { RADIUS - d }
        }
        Shape::Terrain { points_m } | Shape::Polyline { points_m, .. } => {
            let d = points_m.windows(2).map(|p| to(p[0], p[1])).fold(f64::INFINITY, f64::min);
            if y < height(points_m, x) { RADIUS + d } else { RADIUS - d }
        }
    }
}

/// The faults of an answer.
fn faults(s: &Scene, answer: &Solution) -> Vec<String> {
    let (c, found) = (&s.cables[0], &answer.cables[0]);
    let weight = c.length_m * c.linear_density_kg_per_m * GRAVITY;
    let mut out = Vec::new();
    let top = found.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max);
    if !(found.nodes.iter().all(|n| n.tension_n >= -1e-9 * weight) && top.is_finite()) {
        out.push("it pushes".to_owned());
    }
    if s.view != View::Plan {
        let sum = |axis: usize| -> f64 {
            let felt = |r: &cable_core::solution::SupportReaction| [r.reaction_x_n, r.reaction_y_n][axis];
            found.contacts.iter().map(|c| c.force_n[axis]).sum::<f64>() - found.supports.iter().map(felt).sum::<f64>()
        };
        let off = sum(0).hypot(sum(1) - weight);
        if !(off <= 1e-6 * weight.max(top)) {
            out.push(format!("{:.2e} of the weight are not carried", off / weight));
        }
    }
    let mut worst = (0.0, String::new());
    for pair in found.nodes.windows(2) {
        let (ds, d) = (pair[1].arc_length_m - pair[0].arc_length_m, (pair[1].at() - pair[0].at()).norm());
        let strain = pair[0].tension_n.max(pair[1].tension_n) / c.axial_stiffness_n;
        if d > ds * (1.0 + strain) + 1e-4 * ds + 1e-4 {
            out.push(format!("{ds:.3} m of material are {d:.3} m long at {:.3} m", pair[0].arc_length_m));
        }
        // Cable in folds between two nodes has no tension at either.
        let pull = pair[0].tension_n.min(pair[1].tension_n) / weight;
        if d < 0.8 * ds && ds > 1e-9 * c.length_m && pull > 1e-2 {
            out.push(format!("folds under {pull:.2e} of the weight at {:.3} m", pair[0].arc_length_m));
        }
        for f in [0.0, 0.5] {
            let at = pair[0].at() + (pair[1].at() - pair[0].at()) * f;
            let bent = pair[0].curvature_per_m.abs().max(pair[1].curvature_per_m.abs()) * d * d / 8.0;
            for o in &s.obstacles {
                let deep = depth(&o.shape, at.into()) - bent;
                if deep > worst.0 {
                    worst = (deep, format!("{deep:.1e} m inside `{}` at {:.3} m", o.name, pair[0].arc_length_m));
                }
            }
        }
    }
    if worst.0 > 1e-3 {
        out.push(worst.1);
    }
    out
}

#[derive(Debug)]
enum Told {
    Right(Model, String),
    Wrong(Model, Vec<String>),
    Refused(String),
    /// Not a scene.
    Invalid,
}

fn ask(s: &Scene) -> (Told, f64) {
    let begun = Instant::now();
    let mut sim = match Simulation::new(s.clone(), Model::Auto) {
        Ok(sim) => sim,
        Err(cable_core::Error::Scene(_)) => return (Told::Invalid, 0.0),
        Err(e) => return (Told::Refused(e.to_string()), 0.0),
    };
    let found = sim.settle();
    let took = begun.elapsed().as_secs_f64();
    let told = match found {
        Err(e) => Told::Refused(e.to_string()),
        Ok(answer) => match faults(s, &answer) {
            faults if faults.is_empty() => Told::Right(answer.model, answer.reason.to_string()),
            faults => Told::Wrong(answer.model, faults),
        },
    };
    (told, took)
}

fn campaign(seeds: std::ops::Range<u64>) {
    let (mut wrong, mut refused, mut meshed) = (Vec::new(), Vec::new(), Vec::new());
    let mut counts = [[0usize; 5]; FAMILIES.len()];
    let mut spent = [0.0; FAMILIES.len()];
    for seed in seeds {
        let (name, s) = scene(seed);
        let family = (seed % FAMILIES.len() as u64) as usize;
        let (told, took) = ask(&s);
        spent[family] += took;
        let column = match told {
            Told::Right(Model::Fem, why) => {
                meshed.push(format!("{name} {seed} {took:.2} s: {why}"));
                1
            }
            Told::Right(..) => 0,
            Told::Wrong(model, faults) => {
                wrong.push(format!("{name} {seed} {model} {took:.2} s: {faults:?}"));
                2
            }
            Told::Refused(why) => {
                refused.push(format!("{name} {seed} {took:.2} s: {why}"));
                3
            }
            Told::Invalid => 4,
        };
        counts[family][column] += 1;
    }
    println!("family: exact, by fem, wrong, refused, not a scene; seconds");
    for ((name, counts), spent) in FAMILIES.iter().zip(&counts).zip(&spent) {
        println!("{name:12} {counts:?} {spent:.1}");
    }
    println!("by fem: {meshed:#?}\n{wrong:#?}\n{refused:#?}");
    assert!(wrong.is_empty(), "{} wrong", wrong.len());
    for counts in &counts {
        let asked: usize = counts[..4].iter().sum();
        assert!(counts[3] * 50 <= asked, "{} of {asked} refused", counts[3]);
    }
}

/// Material that hangs plumb over a height, by bisection of h = s + w s²/2EA.
fn plumb(height: f64, weight: f64, stiffness: f64) -> f64 {
    let (mut low, mut high) = (0.0, height);
    for _ in 0..200 {
        let s = 0.5 * (low + high);
        if s + weight * s * s / (2.0 * stiffness) < height { low = s } else { high = s }
    }
    low
}

/// A cable over a post above a floor, its supports aside.
fn over_a_post(length_m: f64, a: [f64; 2], friction: f64) -> Scene {
    let (_, mut s) = scene(1);
    let c = &mut s.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (length_m, 1.0, 1e6);
    c.supports = vec![Support::fixed("a", a), Support::fixed("b", [8.0, 1.0])];
    c.route_m = vec![a, [4.0, 3.0], [8.0, 1.0]];
    let floor = Shape::Terrain { points_m: vec![[-50.0, 0.0], [50.0, 0.0]] };
    let post = Shape::Circle { center_m: [4.0, 2.0], radius_m: 0.3 };
    let named = |(name, shape): (&str, Shape)| Obstacle { name: name.to_owned(), shape, friction: Some(friction) };
    s.obstacles = [("floor", floor), ("post", post)].into_iter().map(named).collect();
    s
}

#[test]
fn a_post_between_folds_carries_what_hangs_on_both_its_sides() {
    // Even without friction: both sides hang down as far.
    for friction in [0.0, 0.4] {
        let s = over_a_post(30.0, [0.0, 1.5], friction);
        let answer = Simulation::new(s.clone(), Model::Auto).unwrap().settle().unwrap();
        assert_eq!((answer.model, faults(&s, &answer)), (Model::Spans, Vec::new()));
        let found = &answer.cables[0];
        let hangs = |h: f64| GRAVITY * plumb(h - RADIUS, GRAVITY, 1e6);
        for (r, h) in found.supports.iter().zip([1.5, 1.0]) {
            assert!(r.reaction_x_n.abs() < 1e-9 && (r.reaction_y_n + hangs(h)).abs() < 1e-9, "{r:?}");
        }
        let post = found.contacts.iter().find(|c| c.obstacle == "post").unwrap();
        for t in [post.tension_before_n, post.tension_after_n] {
            assert!((t - hangs(2.0)).abs() < 1e-9, "{t}");
        }
        assert!((post.turn_deg.abs() - 180.0).abs() < 1e-6, "{}", post.turn_deg);
        let around = (0.3 + RADIUS) * std::f64::consts::PI * GRAVITY;
        assert!((post.force_n[1] - 2.0 * hangs(2.0) - around).abs() < 1e-3 * around, "{:?}", post.force_n);
    }
}

#[test]
fn a_support_close_above_a_post_is_drawn_to_it_by_what_hangs_beyond() {
    let mut s = over_a_post(20.0, [4.0, 2.5], 0.3);
    s.cables[0].route_m.clear();
    let answer = Simulation::new(s.clone(), Model::Auto).unwrap().settle().unwrap();
    assert_eq!((answer.model, faults(&s, &answer)), (Model::Spans, Vec::new()));
    let found = &answer.cables[0];
    let post = found.contacts.iter().find(|c| c.obstacle == "post").unwrap();
    let hangs = GRAVITY * plumb(2.0 - RADIUS, GRAVITY, 1e6);
    assert!((post.tension_after_n - hangs).abs() < 1e-9);
    // All friction holds it; light as the cable on the post is, that is Euler's.
    let euler = hangs * (-0.3 * post.turn_deg.to_radians().abs()).exp();
    assert!((post.tension_before_n - euler).abs() < 0.2 * euler, "{} {euler}", post.tension_before_n);
    assert!(found.supports[0].reaction_x_n.hypot(found.supports[0].reaction_y_n) > post.tension_before_n);
}

/// Rough ground, two boxes and a post in the air, twice as much cable as the way: a scene in which
/// `fem` worked for 20 s. Of 39.67 m it hangs plumb everywhere.
const ROUGH: &str = r#"
version = 1
[[cables]]
name = "c"
preset = "soow-6-4"
length_m = 40.0
supports = [ { name = "a", kind = "fixed", at_m = [0.0, 1.4075263453063656] }, { name = "b", kind = "fixed", at_m = [19.10751614642799, 2.6022084877309495] } ]
[[obstacles]]
name = "o0"
kind = "terrain"
points_m = [[-5.0, -0.3142672970641274], [-2.5743736544643343, 0.35555932498768783], [-0.1487473089286686, -0.1291757007072864], [2.2768790366069966, 0.05283786974052962], [4.702505382142663, 0.02054439254579571], [7.12813172767833, 0.13350587781596612], [9.553758073213993, 0.00694635720347031], [11.97938441874966, -0.3523814814204377], [14.405010764285326, -0.16446108413610558], [16.830637109820994, 0.1823151801013434], [19.25626345535666, 0.19381067861306533], [21.681889800892325, 0.1166675069669949], [24.107516146427987, 0.18415957469275257]]
friction = 0.6
[[obstacles]]
name = "o1"
kind = "polygon"
points_m = [[3.1064625168975186, 2.8296102054376404], [3.438533455778889, 2.8296102054376404], [3.438533455778889, 3.2898488903362137], [3.1064625168975186, 3.2898488903362137]]
friction = 0.4
[[obstacles]]
name = "o2"
kind = "circle"
center_m = [11.220591192291279, 1.8873095680133682]
radius_m = 0.25596673464080405
friction = 0.3
[[obstacles]]
name = "o3"
kind = "polygon"
points_m = [[14.381694824931767, 2.26366781943657], [14.608560669569938, 2.26366781943657], [14.608560669569938, 2.640532905184166], [14.381694824931767, 2.640532905184166]]
friction = 0.4
"#;

#[test]
fn folds_on_rough_ground_leave_the_ends_what_hangs_on_them() {
    let s = Scene::from_toml(ROUGH).unwrap();
    let begun = Instant::now();
    let answer = Simulation::new(s.clone(), Model::Auto).unwrap().settle().unwrap();
    println!("{:.1} ms", 1e3 * begun.elapsed().as_secs_f64());
    assert_eq!((answer.model, faults(&s, &answer)), (Model::Spans, Vec::new()));
    let (c, found) = (&s.cables[0], &answer.cables[0]);
    let Shape::Terrain { points_m } = &s.obstacles[0].shape else { panic!() };
    let w = c.linear_density_kg_per_m * GRAVITY;
    for (r, support) in found.supports.iter().zip(&c.supports) {
        let [x, y] = support.at_m.unwrap();
        let slope = (height(points_m, x + 1e-3) - height(points_m, x - 1e-3)) / 2e-3;
        let down = y - height(points_m, x) - 0.5 * c.diameter_m * 1.0f64.hypot(slope);
        let hangs = w * plumb(down, w, c.axial_stiffness_n);
        let off = r.reaction_x_n.hypot(r.reaction_y_n + hangs);
        assert!(off < 1e-6 * hangs, "{}: {off:e} of {hangs} N", r.name);
    }
}

/// A cable laid along flat ground and up a slope of 12°, its start free; friction 0.5 holds it
/// there. The way along the middle of the cable is 14.99706 m long.
fn laid_out(length_m: f64, drawn_m: f64) -> Scene {
    let up = [0.978_147_600_733_805_6, 0.207_911_690_817_759_34];
    let end = |along: f64| [-0.014 * up[1] + along * up[0], 0.014 * up[0] + along * up[1]];
    let ([x, y], [u, v]) = (end(4.0), end(4.0 + drawn_m));
    Scene::from_toml(&format!(
        r#"
version = 1
[[cables]]
name = "cable"
length_m = {length_m}
linear_density_kg_per_m = 1.246
axial_stiffness_n = 50000.0
bending_stiffness_n_m2 = 0.0
service_tension_n = 1e6
breaking_tension_n = 2e6
diameter_m = 0.028
friction = 0.5
route_m = [[-11.0, 0.014], [-0.0014715, 0.014], [{x}, {y}]]
supports = [
  {{ name = "free", kind = "free" }},
  {{ name = "hand", kind = "fixed", at_m = [{x}, {y}], motion = {{ times_s = [0.0, 2.0], points_m = [[{x}, {y}], [{u}, {v}]] }} }},
]
[[obstacles]]
name = "ground"
kind = "terrain"
points_m = [[-60.0, 0.0], [0.0, 0.0], [39.125904, 8.3164676]]
friction = 0.5
"#
    ))
    .unwrap()
}

#[test]
fn a_cable_laid_out_on_ground_that_holds_it_has_no_tension() {
    // Longer than its route, as long, and shorter: the free end is nearer to the hand then.
    for (length_m, free_x) in [(15.3, -11.0), (15.003, -11.0), (14.0, -10.00294), (6.0, -2.00294)] {
        let s = laid_out(length_m, 1.0);
        let answer = Simulation::new(s.clone(), Model::Auto).unwrap().settle().unwrap();
        assert_eq!((answer.model, faults(&s, &answer)), (Model::Spans, Vec::new()), "{length_m}");
        let nodes = &answer.cables[0].nodes;
        // The hand is a rounding of its seven digits above the ground: that much hangs.
        assert!(nodes.iter().all(|n| n.tension_n < 1e-5), "{length_m}");
        assert!((nodes[0].x_m - free_x).abs() < 1e-4, "{length_m}: {}", nodes[0].x_m);
        let along: f64 = nodes.windows(2).map(|w| (w[1].x_m - w[0].x_m).hypot(w[1].y_m - w[0].y_m)).sum();
        assert!((along - length_m.min(14.99706)).abs() < 1e-4, "{length_m}: {along}");
    }
}

/// Drawn up the slope, all of it slides: what it takes follows from the weight of what lies and the
/// span over the kink alone.
#[test]
fn what_was_laid_out_without_tension_is_followed_as_it_is_drawn() {
    let drawn = |model: Model| {
        let s = laid_out(15.0, 2.0);
        let mut sim = Simulation::new(s, model).unwrap();
        sim.settle().unwrap();
        for _ in 0..120 {
            sim.step_quasi_static(1.0 / 60.0).unwrap();
        }
        (sim.solution().model, sim.solution().cables[0].nodes.last().unwrap().tension_n)
    };
    let (model, tension) = drawn(Model::Auto);
    assert_eq!(model, Model::Spans);
    let (w, mu, turn) = (1.246 * GRAVITY, 0.5f64, 12f64.to_radians());
    // Without the span: H is drawn along the flat, climbs the slope. The span over the kink carries
    // itself: between these two.
    let flat = 15.0 - 6.0;
    let least = mu * w * (flat - 1.5) + w * (6.0 - 1.5) * (turn.sin() + mu * turn.cos());
    let most = mu * w * flat + w * 6.0 * (turn.sin() + mu * turn.cos());
    assert!(tension > least && tension < most, "{least} {tension} {most}");
    let (_, by_fem) = drawn(Model::Fem);
    assert!((by_fem - tension).abs() < 5e-3 * tension, "{by_fem} {tension}");
}

/// In the tank little friction holds: what lies on its slopes draws at what lies above, through
/// kinks, up walls and over crests.
#[test]
fn loose_cable_in_a_slippery_tank_is_drawn_by_its_slopes() {
    let tank = |friction: f64, length_m: f64, by: [f64; 2]| {
        let mut s = catalog::tank();
        s.cables[0].length_m = length_m;
        let at = |p: &mut [f64; 2]| *p = [p[0] + by[0], p[1] + by[1]];
        s.cables[0].route_m.iter_mut().for_each(at);
        for support in &mut s.cables[0].supports {
            support.at_m.iter_mut().for_each(at);
            support.motion = None;
        }
        for obstacle in &mut s.obstacles {
            obstacle.friction = Some(friction);
            match &mut obstacle.shape {
                Shape::Terrain { points_m } | Shape::Polygon { points_m } => points_m.iter_mut().for_each(at),
                Shape::Circle { center_m, .. } => at(center_m),
                _ => {}
            }
        }
        s
    };
    for (friction, length_m) in [(0.13, 70.6), (0.22, 26.5), (0.18, 50.0)] {
        let rest = |by: [f64; 2]| {
            let s = tank(friction, length_m, by);
            let answer = Simulation::new(s.clone(), Model::Auto).unwrap().settle().unwrap();
            assert_eq!((answer.model, faults(&s, &answer)), (Model::Spans, Vec::new()), "{friction} {length_m}");
            let supports = &answer.cables[0].supports;
            supports.iter().flat_map(|r| [r.reaction_x_n, r.reaction_y_n]).collect::<Vec<f64>>()
        };
        let (here, far) = (rest([0.0, 0.0]), rest([1000.0, -300.0]));
        assert!(here.iter().zip(&far).all(|(a, b)| (a - b).abs() < 1e-6 * here[1].abs()), "{here:?} {far:?}");
    }
}

/// Folds have no width: any bending stiffness opens them, so that the likely one counts there.
#[test]
fn bending_matters_where_cable_lies_in_folds() {
    let mut s = catalog::hanging_span();
    s.loads.clear();
    s.cables[0].length_m = 9.0;
    s.cables[0].supports = vec![Support::fixed("a", [0.0, 0.1]), Support::fixed("b", [5.0, 0.1])];
    let shape = Shape::Terrain { points_m: vec![[-10.0, 0.0], [20.0, 0.0]] };
    s.obstacles = vec![Obstacle { name: "floor".into(), shape, friction: Some(0.5) }];
    let asked = |bending| settle_with_bending(&s, Model::Auto, Settings::default(), bending).unwrap();
    let (_, flexible) = asked(Bending::AsWritten);
    let causes: Vec<_> = flexible.warnings.iter().map(|w| &w.cause).collect();
    assert!(causes.iter().any(|c| matches!(c, WarningCause::Folds { .. })), "{causes:?}");
    let (scene, stiff) = asked(Bending::WhereItMatters);
    assert_eq!(scene.cables[0].bending_stiffness_n_m2, 1.4, "{}", stiff.reason);
    assert!(stiff.reason.to_string().contains("lies in folds"), "{}", stiff.reason);
    assert!(stiff.max_tension().tension_n > 2.0 * flexible.max_tension().tension_n);
    // A long part with little tension is slack, too, and no fold: that is as it may be.
    let drag = catalog::floor_drag();
    let (scene, _) = settle_with_bending(&drag, Model::Auto, Settings::default(), Bending::WhereItMatters).unwrap();
    assert_eq!(scene.cables[0].bending_stiffness_n_m2, 0.0);
}

#[test]
fn a_part_of_the_campaign() {
    campaign(0..70);
}

#[test]
#[ignore = "minutes: FOLDS_FIRST=0 FOLDS_CASES=700 cargo test -p cable-core --test folds -- --ignored --nocapture"]
fn what_is_over_lies_in_folds() {
    let number = |name: &str, other: u64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(other);
    let first = number("FOLDS_FIRST", 0);
    campaign(first..first + number("FOLDS_CASES", 700));
}

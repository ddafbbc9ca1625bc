//! These tests take `data/statics.json` through the whole of `spans`: free spans, pegs, cable on
//! flat and sloping ground, capstans light and heavy, cables draped over posts, beams and pegs.
//! Each is a scene that is settled or moved, never the formula alone.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::{ContactReport, ContactState};
use cable_core::{Model, Simulation, Solution, SolveError};
use serde_json::Value;

const G: f64 = 10.0;
/// Of a cable that does not stretch, N: the greatest a scene may have.
const RIGID: f64 = 1e12;
/// Radius of a cable that is a line, m.
const THIN: f64 = 1e-5;

fn family(name: &str) -> Vec<(String, Value)> {
    let all: Value = serde_json::from_str(include_str!("../data/statics.json")).unwrap();
    all["cases"][name].as_object().unwrap().iter().map(|(k, v)| (k.clone(), v.clone())).collect()
}

fn cable(length: f64, w: f64, ea: f64, supports: Vec<Support>) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    scene.obstacles.clear();
    scene.environment.gravity_m_per_s2 = G;
    scene.environment.temperature_change_k = 0.0;
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (length, w / G, ea);
    (c.bending_stiffness_n_m2, c.thermal_expansion_per_k) = (0.0, 0.0);
    (c.service_tension_n, c.breaking_tension_n, c.diameter_m) = (1e15, 1e15, 2.0 * THIN);
    c.route_m.clear();
    c.supports = supports;
    scene
}

fn moving(name: &str, from: [f64; 2], to: [f64; 2]) -> Support {
    let motion = Some(Motion { times_s: vec![0.0, 1.0], points_m: vec![from, to] });
    Support { motion, ..Support::fixed(name, from) }
}

fn load(name: &str, force: [f64; 2]) -> Support {
    Support { force_n: Some(force), ..Support::new(name, SupportKind::Load) }
}

fn obstacle(shape: Shape, friction: f64) -> Obstacle {
    Obstacle { name: "it".to_owned(), shape, friction: Some(friction) }
}

fn settle(scene: Scene) -> Result<Solution, SolveError> {
    Simulation::new(scene, Model::Spans).unwrap().settle()
}

fn draw(scene: Scene, steps: usize) -> Result<Solution, SolveError> {
    let mut simulation = Simulation::new(scene, Model::Spans).unwrap();
    simulation.settle()?;
    for _ in 0..steps {
        simulation.step_quasi_static(1.0 / steps as f64)?;
    }
    Ok(simulation.solution())
}

struct Worst(f64, String);

impl Worst {
    fn take(&mut self, name: &str, what: &str, found: f64, expected: f64, scale: f64, bound: f64) {
        let off = (found - expected).abs() / scale;
        assert!(off <= bound, "{name}: {what} {found}, expected {expected} (off by {off:.2e})");
        if off >= self.0 {
            *self = Self(off, format!("{name}, {what}"));
        }
    }
}

fn number(v: &Value, group: &str, key: &str) -> f64 {
    v[group][key].as_f64().unwrap_or(f64::NAN)
}

#[test]
fn free_spans() {
    let mut worst = Worst(0.0, String::new());
    for (name, case) in family("catenary") {
        let of = |key: &str| number(&case, "in", key);
        let ea = case["in"]["EA"].as_f64().unwrap_or(RIGID);
        let ends = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [of("X"), of("Z")])];
        let answer = settle(cable(of("L"), of("w"), ea, ends)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let a = &answer.cables[0].supports[0];
        let top = number(&case, "out", "Tmax");
        // A cable that shall not stretch stretches by T/EA of what it has to spare.
        let slack = (of("L") / of("X").hypot(of("Z")) - 1.0).abs();
        let bound = 1e-9 + if case["in"]["EA"].is_null() { 2.0 * top / ea / slack } else { 0.0 };
        worst.take(&name, "H", a.reaction_x_n, number(&case, "out", "H"), top, bound);
        worst.take(&name, "VA", a.reaction_y_n, number(&case, "out", "VA"), top, bound);
    }
    println!("free spans: worst {:.1e} ({})", worst.0, worst.1);
}

#[test]
fn two_pegs() {
    for (name, case) in family("pulley") {
        let d = number(&case, "in", "half_spacing");
        let length = number(&case, "in", "Ltot");
        let pegs = [-d, d].map(|x| Support::pulley(format!("peg {x}"), [x, 0.0]));
        let [a, b] = pegs;
        let scene = cable(length, 20.0, RIGID, vec![Support::free("left"), a, b, Support::free("right")]);
        let answer = settle(scene).unwrap();
        let tail = answer.cables[0].supports[1].arc_length_m;
        let mut worst = Worst(0.0, String::new());
        worst.take(&name, "tail", tail, number(&case, "out", "stable_tail"), length, 1e-8);
        let h = (answer.cables[0].supports[1].tension_after_n.unwrap() / 20.0).powi(2);
        let half = number(&case, "out", "stable_halfspan_arc");
        worst.take(&name, "a", (h - half * half).sqrt(), number(&case, "out", "stable_a"), length, 1e-7);
        println!("two pegs: worst {:.1e} ({})", worst.0, worst.1);
    }
}

/// A line anchored at the origin on ground of slope α and held at (X, Z), pulled in to there.
fn anchored(case: &Value) -> Scene {
    let of = |key: &str| number(case, "in", key);
    let (sin, cos) = of("alpha_deg").to_radians().sin_cos();
    let end = [of("X"), of("Z")];
    // From half way to where all of it would lie or hang straight down, and not farther than a
    // twentieth of it.
    let least = (of("L") - of("Z")) / (1.0 - sin) * cos;
    let back = (0.5 * (end[0] - least)).clamp(1e-3, 0.05 * of("L")) / cos;
    let near = [end[0] - back * cos, end[1] - back * sin];
    let ends = vec![Support::fixed("A", [0.0, 0.0]), moving("B", near, end)];
    let mut scene = cable(of("L"), of("w"), of("EA"), ends);
    let down = [sin * THIN, -cos * THIN];
    let at = |l: f64| [l * cos + down[0], l * sin + down[1]];
    scene.obstacles = vec![obstacle(Shape::Terrain { points_m: vec![at(-10.0), at(2.0 * of("L"))] }, of("mu"))];
    let lies = 0.6 * (of("X") / cos);
    scene.cables[0].route_m = vec![[0.0, 0.0], [lies * cos, lies * sin], near];
    scene
}

#[test]
fn on_the_ground() {
    let mut worst = Worst(0.0, String::new());
    let mut held = 0;
    for (name, case) in family("ground") {
        if case["in"]["X"].is_null() {
            continue;
        }
        let found = draw(anchored(&case), 20);
        if name == "flat_fully_slack_L" {
            // Its ground part has more cable than way: a cable cannot push.
            assert!(found.is_err(), "{name}");
            continue;
        }
        let answer = found.unwrap_or_else(|e| panic!("{name}: {e}"));
        let top = number(&case, "out", "T_B");
        let (a, b) = (&answer.cables[0].supports[0], &answer.cables[0].supports[1]);
        worst.take(&name, "H", -b.reaction_x_n, number(&case, "out", "H"), top, 1e-6);
        worst.take(&name, "V_B", -b.reaction_y_n, number(&case, "out", "V_B"), top, 1e-6);
        let anchor = a.reaction_x_n.hypot(a.reaction_y_n);
        worst.take(&name, "T_anchor", anchor, number(&case, "out", "T_anchor"), top, 1e-6);
        held += 1;
    }
    assert!(held >= 9);
    println!("on the ground: worst {:.1e} ({}) of {held}", worst.0, worst.1);
}

#[test]
fn drawn_over_flat_ground_and_held_on_a_slope() {
    for (name, case) in family("ground") {
        let of = |key: &str| number(&case, "in", key);
        let (length, w, mu) = (of("L"), of("w"), of("mu"));
        let mut worst = Worst(0.0, String::new());
        let slope = |alpha: f64, move_by: f64| {
            let (sin, cos) = alpha.to_radians().sin_cos();
            let on = |l: f64| [l * cos, l * sin];
            let ends = vec![Support::free("tail"), moving("hand", on(length), on(length + move_by))];
            let mut scene = cable(length, w, 1e9, ends);
            let under = |l: f64| [l * cos + sin * THIN, l * sin - cos * THIN];
            scene.obstacles =
                vec![obstacle(Shape::Terrain { points_m: vec![under(-length), under(3.0 * length)] }, mu)];
            scene.cables[0].route_m = vec![on(0.0), on(length)];
            scene
        };
        match name.as_str() {
            "drag_on_flat" => {
                let answer = draw(slope(0.0, 1.0), 4).unwrap();
                let pull = -answer.cables[0].supports[1].reaction_x_n;
                worst.take(&name, "pull", pull, number(&case, "out", "T_pull"), w * length, 1e-9);
            }
            n if n.starts_with("slope_hold") => {
                for (by, key) in [(1.0, "T_top_max"), (-1.0, "T_top_min")] {
                    let answer = draw(slope(of("alpha_deg"), by), 8).unwrap();
                    let s = &answer.cables[0].supports[1];
                    let pull = s.reaction_x_n.hypot(s.reaction_y_n);
                    worst.take(&name, key, pull, number(&case, "out", key), w * length, 1e-9);
                }
            }
            _ => continue,
        }
        println!("{name}: worst {:.1e}", worst.0);
    }
}

/// A cable drawn round a post by a hand against a dead load: the post's contact, which slides. φ
/// counts from the top along the cable; `from` where the load's tail comes up to it, `turn` how far
/// it goes round.
fn round_a_post(
    (w, ea): (f64, f64),
    radius: f64,
    mu: f64,
    t1: f64,
    (from, turn): (f64, f64),
    pull: f64,
) -> ContactReport {
    let r = radius + THIN;
    // The line of the load and of the hand, tangent to the post at φ: point r(sin φ, cos φ),
    // direction (cos φ, −sin φ).
    let tangent = |phi: f64| ([r * phi.sin(), r * phi.cos()], [phi.cos(), -phi.sin()]);
    let (a, t) = tangent(from);
    let (b, u) = tangent(from + turn);
    let tail = 2.0 * radius + 1.0;
    let hand = |l: f64| [b[0] + u[0] * l, b[1] + u[1] * l];
    let length = tail + r * turn + tail;
    let ends = vec![load("load", [-t[0] * t1, -t[1] * t1]), moving("hand", hand(tail), hand(tail + pull))];
    let mut scene = cable(length, w, ea, ends);
    scene.obstacles = vec![obstacle(Shape::Circle { center_m: [0.0, 0.0], radius_m: radius }, mu)];
    let mut route = vec![[a[0] - t[0] * tail, a[1] - t[1] * tail]];
    let steps = (turn / 0.3).ceil() as usize;
    route.extend((0..=steps).map(|k| {
        let phi = from + turn * k as f64 / steps as f64;
        [1.01 * r * phi.sin(), 1.01 * r * phi.cos()]
    }));
    route.push(hand(tail));
    scene.cables[0].route_m = route;
    let answer = draw(scene, 10).unwrap_or_else(|e| panic!("mu {mu}, {from} to {turn}: {e}"));
    let contacts = &answer.cables[0].contacts;
    assert_eq!(contacts.len(), 1);
    contacts[0].clone()
}

#[test]
fn capstans_multiply() {
    let mut worst = Worst(0.0, String::new());
    for (name, case) in family("capstan") {
        let (mu, turn) = (number(&case, "in", "mu"), number(&case, "in", "theta_deg").to_radians());
        for pull in if number(&case, "out", "ratio") > 1e2 { vec![0.5] } else { vec![0.1, -0.1] } {
            // As light as a scene allows.
            let c = round_a_post((1e-5, 1e9), 0.5, mu, 100.0, (-FRAC_PI_2, turn), pull);
            assert_eq!(c.state, ContactState::Slip, "{name}");
            let ratio = c.tension_after_n / c.tension_before_n;
            let turned = c.turn_deg.abs().to_radians();
            assert!((turned - turn).abs() < 1e-5, "{name}: turned by {turned} of {turn}");
            let exact = number(&case, "out", "ratio").powf(turned / turn);
            let found = if pull > 0.0 { ratio } else { 1.0 / ratio };
            worst.take(&name, "ratio", found / exact, 1.0, 1.0, 2e-6);
        }
    }
    println!("capstans: worst {:.1e} ({})", worst.0, worst.1);
}

/// T = C e^{μφ} + wR[(1 − μ²) cos φ + 2μ sin φ]/(1 + μ²).
fn heavy(t1: f64, w: f64, r: f64, mu: f64, [from, to]: [f64; 2]) -> f64 {
    let own = |phi: f64| w * r * ((1.0 - mu * mu) * phi.cos() + 2.0 * mu * phi.sin()) / (1.0 + mu * mu);
    (t1 - own(from)) * (mu * (to - from)).exp() + own(to)
}

#[test]
fn heavy_capstans_follow_their_law() {
    let mut worst = Worst(0.0, String::new());
    for (name, case) in family("capstan_heavy") {
        if case["out"]["valid"] == false {
            continue;
        }
        let of = |key: &str| number(&case, "in", key);
        let [from, to] = ["phi1_deg", "phi2_deg"].map(|k| of(k).to_radians());
        let mu = of("mu");
        // The formula is what the table says …
        let table = heavy(of("T1"), of("w"), of("R"), mu, [from, to]);
        worst.take(&name, "formula", table, number(&case, "out", "T2_max"), table, 1e-12);
        // … and what a scene of that post does between where the cable comes and where it leaves.
        for pull in [0.5, -0.5] {
            let c = round_a_post((of("w"), 1e10), of("R"), mu, of("T1"), (from, to - from), pull);
            if pull < 0.0 && c.state == ContactState::Stick {
                continue;
            }
            assert_eq!(c.state, ContactState::Slip, "{name}");
            let m = mu * pull.signum();
            let middle = c.x_m.atan2(c.y_m);
            let middle = middle + TAU * ((0.5 * (from + to) - middle) / TAU).round();
            let half = 0.5 * c.turn_deg.abs().to_radians();
            let t2 = heavy(c.tension_before_n, of("w"), of("R") + THIN, m, [middle - half, middle + half]);
            worst.take(&name, "T2", c.tension_after_n, t2, t2, 1e-6);
        }
    }
    println!("heavy capstans: worst {:.1e} ({})", worst.0, worst.1);
}

/// Returns whether two tails hanging over something hold each other.
fn holds(tails: [f64; 2], shape: Option<Shape>, over: f64, mu: f64, route: &[[f64; 2]]) -> Result<(), SolveError> {
    let length = tails[0] + over + tails[1];
    let (a, b) = (route[0], route[route.len() - 1]);
    let mut way = vec![[a[0], a[1] - tails[0]]];
    way.extend(route);
    way.push([b[0], b[1] - tails[1]]);
    let mut ends = vec![Support::free("left"), Support::free("right")];
    if shape.is_none() {
        let peg = Support { friction: Some(mu), ..Support::pulley("peg", [0.0, 0.0]) };
        ends.insert(1, peg);
    }
    let mut scene = cable(length, 20.0, 1e8, ends);
    scene.obstacles = shape.map(|s| obstacle(s, mu)).into_iter().collect();
    scene.cables[0].route_m = way;
    settle(scene).map(|_| ())
}

#[test]
fn draped_cables_hold_to_the_limit() {
    for (name, case) in family("draped") {
        let of = |key: &str| number(&case, "in", key);
        let (mu, h1) = (of("mu"), of("h1"));
        let holds: Box<dyn Fn(f64) -> Result<(), SolveError>> =
            if case["in"]["R"].as_f64().is_some_and(|r| r > 0.0) && mu.is_finite() {
                let r = of("R") - THIN;
                Box::new(move |h2| {
                    let ring: Vec<[f64; 2]> = (0..=90)
                        .map(|k| -FRAC_PI_2 + PI * f64::from(k) / 90.0)
                        .map(|phi| [(r + THIN) * phi.sin(), (r + THIN) * phi.cos()])
                        .collect();
                    let way: f64 = ring.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
                    let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: r };
                    holds([h1, h2], Some(shape), way, mu, &ring)
                })
            } else if let Some(b) = case["in"]["b"].as_f64() {
                let half = 0.5 * b;
                Box::new(move |h2| {
                    let points_m = vec![[-half, 0.0], [-half, -200.0], [half, -200.0], [half, 0.0]];
                    let (x, y) = (half + THIN, THIN);
                    holds([h1, h2], Some(Shape::Polygon { points_m }), 2.0 * x, mu, &[[-x, y], [x, y]])
                })
            } else {
                continue;
            };
        for key in ["h2_max", "h2_min"] {
            let limit = number(&case, "out", key);
            if limit < 0.05 {
                continue;
            }
            // The route of a polygon inside a round is shorter than its arc, which takes as much
            // off the tails.
            let off = 1e-3;
            let (inside, outside) = if key == "h2_max" { (1.0 - off, 1.0 + off) } else { (1.0 + off, 1.0 - off) };
            holds(limit * inside).unwrap_or_else(|e| panic!("{name}: {key} {limit} does not hold just inside: {e}"));
            assert!(holds(limit * outside).is_err(), "{name}: {key} {limit} holds just outside");
        }
    }
}

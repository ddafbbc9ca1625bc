//! This test asks whether every figure's stated error covers its true one, and how closely: `fem`
//! and `mass-spring` beside answers without a mesh (`catenary`, `spans`), or where there are none
//! beside a much finer mesh, over random scenes in twelve families.
//!
//! Of a finer mesh only differences of the two are known, and so they are called. What is below
//! `ROUNDED` counts as nothing on both sides. The ratio of stated to true error is asked of four
//! quantities: the greatest tension, the forces on supports, those of each obstacle, and the shape
//! (how far any node is from where its material is).
//!
//! `cargo test --locked -p cable-core --test errors -- --ignored --nocapture` makes the tables of
//! docs/errors.md (`ERRORS_CASES=60` a family, `ERRORS_FIRST=1000` seeds, `ERRORS_MODEL=fem`,
//! `ERRORS_FAMILY=posts` alone, `ERRORS_SHOW=1` each case, `ERRORS_TRUTH=mesh` judges by a mesh six
//! times finer of the same model alone).

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use std::fmt::Write as _;
use std::ops::Range;

use cable_core::scene::{Obstacle, PulleySide, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::{CableSolution, ContactReport, Node, SupportReaction};
use cable_core::{Error, Load, Model, Settings, Simulation, SolveError, Vec2};

use self::dice::Dice;

const FAMILIES: [&str; 12] = [
    "free spans",
    "loaded spans",
    "floors",
    "slopes",
    "posts",
    "beams",
    "pulleys",
    "stick bands",
    "reversals",
    "stiff cables",
    "slack",
    "closed form",
];
const QUANTITIES: [&str; 4] = ["tension", "supports", "contacts", "shape"];
/// Errors of this part of the greatest tension are those of two answers' rounding and of what ends
/// their iterations.
const ROUNDED: f64 = 1e-8;
/// And of this part of the length: by as much the truth's own nodes leave it open where the cable
/// is between them.
const READ: f64 = 1e-5;
/// Factor by which the reference has more elements where no model without a mesh answers.
const FINER: usize = 6;

/// A cable on a level floor that holds, drawn at one end until a front of sliding has gone
/// `fronts[0]` of it, let back and drawn again: tension falls away from the hand by μw per metre as
/// far as each front, and is what it was beyond.
#[derive(Clone)]
struct Drawn {
    /// Friction times weight per metre, N/m, and weight per metre.
    hold: f64,
    weight: f64,
    fronts: [f64; 3],
    length: f64,
    stiffness: f64,
}

impl Drawn {
    /// Tension (N) at a distance from the hand after all strokes.
    fn tension(&self, u: f64) -> f64 {
        let [a, b, c] = self.fronts;
        let drawn = (a - u).max(0.0);
        let back = drawn.min(a - 2.0 * b + u);
        self.hold * back.max(a - 2.0 * b + 2.0 * c - u)
    }

    /// Returns how far the hand is from its start after each stroke: the change of tension, a
    /// triangle over each front, over EA.
    fn moves(&self) -> [f64; 3] {
        let stretch = |k: usize, slope: f64| 0.5 * slope * self.hold * self.fronts[k].powi(2) / self.stiffness;
        let (drawn, back, again) = (stretch(0, 1.0), stretch(1, 2.0), stretch(2, 2.0));
        [drawn, drawn - back, drawn - back + again]
    }

    fn answer(&self) -> CableSolution {
        const POINTS: usize = 4000;
        let step = self.length / POINTS as f64;
        let (mut x, mut nodes) = (0.0, Vec::new());
        for k in 0..=POINTS {
            let s = step * k as f64;
            let tension_n = self.tension(self.length - s);
            nodes.push(Node { arc_length_m: s, x_m: x, y_m: RADIUS, tension_n, ..Node::default() });
            x += step * (1.0 + self.tension(self.length - s - 0.5 * step) / self.stiffness);
        }
        let [anchor, hand] = [self.tension(self.length), self.tension(0.0)];
        let support = |n: f64| SupportReaction { reaction_x_n: n, ..SupportReaction::default() };
        let force_n = [anchor - hand, self.weight * self.length];
        let contact = ContactReport { obstacle: "thing".to_owned(), force_n, ..ContactReport::default() };
        CableSolution {
            nodes: nodes.into(),
            supports: vec![support(anchor), support(-hand)],
            contacts: vec![contact],
            ..CableSolution::default()
        }
    }
}

/// A scene, its mesh, and where the hand at its last support goes step by step.
struct Case {
    scene: Scene,
    segments: Option<usize>,
    hand: Vec<Vec2>,
    drawn: Option<Drawn>,
}

/// A cable between two points of a scene without obstacles.
fn plain(ends: [[f64; 2]; 2], (length, density, stiffness): (f64, f64, f64)) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = 9.80665;
    (scene.environment.temperature_change_k, scene.environment.wind_n_per_m) = (0.0, [0.0, 0.0]);
    scene.loads.clear();
    scene.obstacles.clear();
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (length, density, stiffness);
    (c.bending_stiffness_n_m2, c.thermal_expansion_per_k, c.diameter_m) = (0.0, 0.0, 0.004);
    (c.service_tension_n, c.breaking_tension_n, c.segments) = (1e15, 1e15, None);
    c.route_m.clear();
    c.supports = vec![Support::fixed("A", ends[0]), Support::fixed("B", ends[1])];
    scene
}

fn led(shape: Shape, friction: f64, (route, longer, density): (Vec<[f64; 2]>, f64, f64), stiffness: f64) -> Scene {
    let way: f64 = route.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
    let mut scene = plain([route[0], route[route.len() - 1]], (way * (1.0 + longer), density, stiffness));
    scene.cables[0].route_m = route;
    scene.obstacles = vec![Obstacle { name: "thing".to_owned(), shape, friction: Some(friction) }];
    scene
}

const RADIUS: f64 = 0.002;

fn floor(dice: &mut Dice, slope: f64, friction: f64) -> Scene {
    let size = dice.log(2.0, 60.0);
    let y = |x: f64| slope * x;
    let line = vec![[-size, y(-size)], [3.0 * size, y(3.0 * size)]];
    let a = [0.0, RADIUS * (1.0 + slope * slope).sqrt() + if dice.unit() < 0.5 { 0.0 } else { 0.05 * size }];
    let b = [size, y(size) + size * dice.log(0.01, 0.4)];
    let (longer, density, stiffness) = (dice.log(1e-4, 0.05), dice.log(0.1, 3.0), dice.log(1e4, 1e8));
    led(Shape::Terrain { points_m: line }, friction, (vec![a, b], longer, density), stiffness)
}

fn post(dice: &mut Dice, friction: f64) -> Scene {
    let size = dice.log(2.0, 60.0);
    let radius_m = dice.log(0.01, 0.1) * size;
    let at = [dice.within(0.3, 0.7) * size, 0.0];
    let ends = [dice.within(0.0, 0.3), dice.within(0.0, 0.3)].map(|d| -d * size);
    let route = vec![[0.0, ends[0]], [at[0], radius_m + RADIUS], [size, ends[1]]];
    let (longer, density, stiffness) = (dice.log(1e-4, 0.03), dice.log(0.1, 3.0), dice.log(1e4, 1e8));
    led(Shape::Circle { center_m: at, radius_m }, friction, (route, longer, density), stiffness)
}

fn beam(dice: &mut Dice, friction: f64) -> Scene {
    let size = dice.log(2.0, 60.0);
    let (left, right) = (dice.within(0.3, 0.45) * size, dice.within(0.5, 0.7) * size);
    let low = -0.4 * size;
    let points_m = vec![[left, low], [right, low], [right, 0.0], [left, 0.0]];
    let ends = [dice.within(0.02, 0.3), dice.within(0.02, 0.3)].map(|d| -d * size);
    let route = vec![[0.0, ends[0]], [left, RADIUS], [right, RADIUS], [size, ends[1]]];
    let (longer, density, stiffness) = (dice.log(1e-4, 0.03), dice.log(0.1, 3.0), dice.log(1e4, 1e8));
    led(Shape::Polygon { points_m }, friction, (route, longer, density), stiffness)
}

/// Returns where the hand goes from the last support: to and fro along its cable, in steps that add
/// up to some of its stretch and of its slack.
fn strokes(dice: &mut Dice, scene: &Scene, turns: usize) -> Vec<Vec2> {
    let c = &scene.cables[0];
    let end = c.supports[c.supports.len() - 1].at_m.unwrap();
    let from = c.route_m[c.route_m.len() - 2];
    let along = Vec2::new(end[0] - from[0], end[1] - from[1]).normalize();
    let w = c.linear_density_kg_per_m * 9.80665 * c.length_m;
    let reach = (3.0 * w / c.axial_stiffness_n * c.length_m).max(1e-4 * c.length_m) * dice.log(0.1, 1.0);
    let mut hand = Vec::new();
    let mut at = 0.0;
    for turn in 0..turns {
        let to = if turn % 2 == 0 { reach } else { reach * dice.within(0.2, 0.9) };
        for k in 1..=3 {
            let f = f64::from(k) / 3.0;
            hand.push(Vec2::new(end[0], end[1]) + along * (at + (to - at) * f));
        }
        at = to;
    }
    hand
}

fn case(family: usize, number: u64) -> Case {
    let mut dice = Dice(0xe770_0000 + 1_000_003 * number + 7919 * family as u64);
    let (mut hand, mut drawn) = (Vec::new(), None);
    let friction = if dice.unit() < 0.2 { 0.0 } else { dice.within(0.05, 0.8) };
    let scene = match family {
        0 | 1 => {
            let chord = dice.log(0.5, 1e3);
            let slope = dice.within(-1.3, 1.3);
            let ratio = match number % 3 {
                0 => 1.0 + dice.log(1e-6, 1e-2),
                1 => 1.0 + dice.log(1e-2, 1.0),
                _ => dice.log(2.0, 5.0),
            };
            let density = dice.log(0.05, 10.0);
            let weight = density * 9.80665 * chord * ratio;
            let stiffness = weight * dice.log(1e2, 1e6);
            let end = [chord * f64::cos(slope), chord * f64::sin(slope)];
            let mut scene = plain([[0.0, 0.0], end], (chord * ratio, density, stiffness));
            for _ in 0..family * (1 + (dice.unit() * 3.0) as usize) {
                let (cable, at) = (scene.cables[0].name.clone(), dice.within(0.1, 0.9) * chord * ratio);
                let force = [dice.within(-0.3, 0.3) * weight, -dice.within(0.1, 1.0) * weight];
                scene.loads.push(Load {
                    cable,
                    arc_length_m: at,
                    force_n: Some(force),
                    times_s: vec![],
                    forces_n: vec![],
                });
            }
            scene
        }
        2 => floor(&mut dice, 0.0, friction),
        3 => {
            let slope = dice.within(-0.2, 0.2);
            floor(&mut dice, slope, friction)
        }
        4 => post(&mut dice, friction),
        5 => beam(&mut dice, friction),
        6 => {
            let size = dice.log(2.0, 60.0);
            let at = [dice.within(0.3, 0.7) * size, dice.within(0.0, 0.3) * size];
            let (longer, density, stiffness) = (dice.log(1e-3, 0.3), dice.log(0.1, 3.0), dice.log(1e4, 1e8));
            let end = [size, -dice.within(0.0, 0.3) * size];
            let way = at[0].hypot(at[1]) + (end[0] - at[0]).hypot(end[1] - at[1]);
            let mut scene = plain([[0.0, 0.0], end], (way * (1.0 + longer), density, stiffness));
            let mut wheel = Support::new("wheel", SupportKind::Pulley);
            wheel.at_m = Some(at);
            wheel.side = Some(PulleySide::Over);
            wheel.radius_m = Some(if dice.unit() < 0.3 { 0.0 } else { dice.log(0.005, 0.05) * size });
            wheel.friction = Some(if dice.unit() < 0.5 { 0.0 } else { dice.within(0.02, 0.5) });
            let c = &mut scene.cables[0];
            c.supports.insert(1, wheel);
            c.route_m = vec![[0.0, 0.0], at, end];
            scene
        }
        7 | 8 => {
            let friction = dice.within(0.1, 0.8);
            let scene = match number % 3 {
                0 => floor(&mut dice, 0.0, friction),
                1 => post(&mut dice, friction),
                _ => beam(&mut dice, friction),
            };
            hand = strokes(&mut dice, &scene, if family == 7 { 1 } else { 3 });
            scene
        }
        11 => {
            let (length, density, friction) = (dice.log(2.0, 60.0), dice.log(0.1, 3.0), dice.within(0.1, 0.8));
            let weight = density * 9.80665;
            let first = dice.within(0.4, 0.9) * length;
            let second = dice.within(0.2, 0.45) * first;
            let fronts = [first, second, dice.within(0.3, 0.9) * second];
            let it = Drawn { hold: friction * weight, weight, fronts, length, stiffness: dice.log(1e4, 1e8) };
            let line = vec![[-length, 0.0], [3.0 * length, 0.0]];
            let way = vec![[0.0, RADIUS], [length, RADIUS]];
            let mut from = 0.0;
            for to in it.moves() {
                let at = |f: f64| Vec2::new(length + from + (to - from) * f, RADIUS);
                hand.extend([0.2, 0.4, 0.6, 0.8, 1.0].map(at));
                from = to;
            }
            let stiffness = it.stiffness;
            drawn = Some(it);
            led(Shape::Terrain { points_m: line }, friction, (way, 0.0, density), stiffness)
        }
        10 => {
            let mut scene =
                if number.is_multiple_of(2) { floor(&mut dice, 0.0, friction) } else { beam(&mut dice, friction) };
            scene.cables[0].length_m *= dice.within(1.15, 1.5);
            scene
        }
        _ => {
            let mut scene = match number % 3 {
                0 => {
                    let chord = dice.log(1.0, 30.0);
                    let (ratio, density) = (1.0 + dice.log(1e-3, 0.1), dice.log(0.1, 3.0));
                    plain([[0.0, 0.0], [chord, 0.0]], (chord * ratio, density, dice.log(1e4, 1e7)))
                }
                1 => post(&mut dice, 0.0),
                _ => floor(&mut dice, 0.0, 0.0),
            };
            let c = &mut scene.cables[0];
            let w = c.linear_density_kg_per_m * 9.80665;
            c.bending_stiffness_n_m2 = w * c.length_m.powi(3) * dice.log(1e-6, 1e-3);
            scene
        }
    };
    let segments = (dice.unit() < 0.5).then(|| dice.log(16.0, 120.0) as usize);
    Case { scene, segments, hand, drawn }
}

/// The answer at the end of a case.
fn solve(case: &Case, model: Model, settings: Settings) -> Result<CableSolution, String> {
    let mut sim = Simulation::with_settings(case.scene.clone(), model, settings).map_err(|e| e.to_string())?;
    sim.settle().map_err(|e| e.to_string())?;
    let last = case.scene.cables[0].supports.len() - 1;
    for to in &case.hand {
        sim.drag_support(0, last, *to);
        sim.step_quasi_static(0.1).map_err(|e| e.to_string())?;
    }
    if sim.model() != model {
        return Err(format!("answered by {}", sim.model()));
    }
    Ok(sim.solution().cables.remove(0))
}

/// The answer that the others are judged by, and where it comes from (`Auto`: a closed form).
fn truth(case: &Case, model: Model) -> Option<(CableSolution, Model)> {
    if let Some(drawn) = &case.drawn {
        return Some((drawn.answer(), Model::Auto));
    }
    let exact = Settings::default();
    // If the friction of a wheel leaves a choice of histories, the one with the least sliding is
    // asked for.
    let rubs = case.scene.cables[0].supports.iter().any(|s| s.friction.is_some_and(|f| f > 0.0));
    let by_mesh = std::env::var("ERRORS_TRUTH").is_ok_and(|t| t == "mesh");
    let models = [(Model::Catenary, !rubs), (Model::Spans, true)];
    for by in models.into_iter().filter(|(_, asked)| *asked && !by_mesh).map(|m| m.0) {
        if let Ok(found) = solve(case, by, exact) {
            return Some((found, by));
        }
    }
    let stiff = case.scene.cables[0].bending_stiffness_n_m2 > 0.0;
    if stiff {
        return solve(case, Model::Fem, Settings { tolerance: 1e-8, ..exact }).ok().map(|c| (c, Model::Fem));
    }
    let segments = Some(FINER * case.segments.unwrap_or(100));
    solve(case, model, Settings { segments, ..exact }).ok().map(|c| (c, model))
}

fn greatest(c: &CableSolution) -> f64 {
    c.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max)
}

fn on_obstacles(c: &CableSolution) -> std::collections::BTreeMap<&str, Vec2> {
    let mut sum = std::collections::BTreeMap::new();
    for contact in &c.contacts {
        *sum.entry(contact.obstacle.as_str()).or_insert_with(Vec2::zeros) +=
            Vec2::new(contact.force_n[0], contact.force_n[1]);
    }
    sum
}

/// True errors of the four quantities, N, N, N and m.
fn errors(found: &CableSolution, exact: &CableSolution) -> [f64; 4] {
    let pairs = found.supports.iter().zip(&exact.supports);
    let supports = pairs.map(|(a, b)| (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n));
    let (a, b) = (on_obstacles(found), on_obstacles(exact));
    let names: std::collections::BTreeSet<_> = a.keys().chain(b.keys()).collect();
    let of = |m: &std::collections::BTreeMap<&str, Vec2>, n: &str| m.get(n).copied().unwrap_or_else(Vec2::zeros);
    let contacts = names.iter().map(|n| (of(&a, n) - of(&b, n)).norm());
    let shape = found.nodes.iter().filter_map(|n| Some((exact.position_at(n.arc_length_m)? - n.at()).norm()));
    [
        (greatest(found) - greatest(exact)).abs(),
        supports.fold(0.0, f64::max),
        contacts.fold(0.0, f64::max),
        shape.fold(0.0, f64::max),
    ]
}

/// The errors that an answer states.
fn stated(c: &CableSolution) -> [Option<f64>; 4] {
    let e = c.errors;
    [e.max_tension_n, e.support_force_n, e.contact_force_n, e.position_m]
}

/// The results of one family and model: ratios of stated to true error, one list a quantity; None =
/// no error is stated.
#[derive(Default)]
struct Tally {
    ratios: [Vec<Option<f64>>; 4],
    refused: usize,
    without_truth: usize,
    by_mesh: usize,
}

fn judge(family: usize, model: Model, numbers: Range<u64>) -> Tally {
    let mut tally = Tally::default();
    let show = std::env::var("ERRORS_SHOW").is_ok();
    for number in numbers {
        let case = case(family, number);
        let settings = Settings { segments: case.segments, ..Settings::default() };
        let found = match solve(&case, model, settings) {
            Ok(found) => found,
            Err(why) => {
                tally.refused += 1;
                if show {
                    println!("{} {number} {model}: {why}", FAMILIES[family]);
                }
                continue;
            }
        };
        let Some((exact, by)) = truth(&case, model) else {
            tally.without_truth += 1;
            continue;
        };
        tally.by_mesh += usize::from(matches!(by, Model::Fem | Model::MassSpring));
        let (off, said) = (errors(&found, &exact), stated(&found));
        let most = exact.supports.iter().map(|s| s.reaction_x_n.hypot(s.reaction_y_n)).fold(greatest(&exact), f64::max);
        let (force, length) = (ROUNDED * most, READ * case.scene.cables[0].length_m);
        let touches = !(found.contacts.is_empty() && exact.contacts.is_empty());
        for q in (0..4).filter(|q| *q != 2 || touches) {
            let least = if q == 3 { length } else { force };
            tally.ratios[q].push(said[q].map(|s| (s + least) / off[q].max(least)));
        }
        if show {
            let part = |q: usize, v: f64| v * if q == 3 { READ / length } else { ROUNDED / force };
            let text: String = (0..4).fold(String::new(), |mut t, q| {
                let _ = write!(t, "  {:.1e}/{:.1e}", said[q].map_or(f64::NAN, |s| part(q, s)), part(q, off[q]));
                t
            });
            println!("{} {number} {model} by {by}, {} nodes:{text}", FAMILIES[family], found.nodes.len());
        }
    }
    tally
}

/// Share of what is said that covers, share that is within 0.5 to 10 times, and how many say
/// nothing.
fn shares(ratios: &[Option<f64>]) -> (f64, f64, usize) {
    let said: Vec<f64> = ratios.iter().copied().flatten().collect();
    let part = |of: usize| 100.0 * of as f64 / said.len() as f64;
    let covers = said.iter().filter(|r| **r >= 1.0).count();
    let close = said.iter().filter(|r| (0.5..=10.0).contains(*r)).count();
    (part(covers), part(close), ratios.len() - said.len())
}

/// Ratios of stated to true error by classes, as a row of a chart.
fn histogram(ratios: &[Option<f64>]) -> String {
    let edges = [0.5, 1.0, 2.0, 5.0, 10.0, 100.0, f64::INFINITY];
    let mut counts = [0; 7];
    for r in ratios.iter().flatten() {
        counts[edges.iter().position(|e| r < e).unwrap_or(6)] += 1;
    }
    counts.iter().fold(String::new(), |mut t, n| {
        let _ = write!(t, " {n:>6}");
        t
    })
}

/// Runs families for a model and prints the table; the ratios of all of them, one list a quantity.
fn campaign(model: Model, numbers: Range<u64>) -> [Vec<Option<f64>>; 4] {
    let only = std::env::var("ERRORS_FAMILY").ok();
    let mut all: [Vec<Option<f64>>; 4] = Default::default();
    println!("{model}: covered % / within 0.5 to 10 times % (says nothing)");
    println!("{:12} {:>5}  {:>18} {:>18} {:>18} {:>18}", "family", "cases", "tension", "supports", "contacts", "shape");
    let cell = |r: &[Option<f64>]| {
        let (covers, close, nothing) = shares(r);
        format!("{covers:>5.0} / {close:<4.0} ({nothing})")
    };
    for (family, name) in FAMILIES.iter().enumerate() {
        if only.as_ref().is_some_and(|o| o != name) {
            continue;
        }
        let tally = judge(family, model, numbers.clone());
        let row: Vec<String> = tally.ratios.iter().map(|r| cell(r)).collect();
        println!(
            "{name:12} {:>5}  {:>18} {:>18} {:>18} {:>18}   refused {}, without truth {}, truth by a mesh {}",
            tally.ratios[0].len(),
            row[0],
            row[1],
            row[2],
            row[3],
            tally.refused,
            tally.without_truth,
            tally.by_mesh
        );
        for (sum, one) in all.iter_mut().zip(tally.ratios) {
            sum.extend(one);
        }
    }
    let row: Vec<String> = all.iter().map(|r| cell(r)).collect();
    println!("{:12} {:>5}  {:>18} {:>18} {:>18} {:>18}", "all", all[0].len(), row[0], row[1], row[2], row[3]);
    println!("stated/true     <0.5  <1     <2     <5     <10    <100   more");
    for (name, ratios) in QUANTITIES.iter().zip(&all) {
        println!("  {name:10} {}", histogram(ratios));
    }
    all
}

fn number(name: &str, other: u64) -> u64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(other)
}

#[test]
fn settings_out_of_range_are_refused() {
    let asked = |tolerance: f64, segments: Option<usize>| Settings { tolerance, segments, ..Settings::default() };
    let wrong = [asked(f64::NAN, None), asked(0.0, None), asked(-1e-3, None), asked(1e-3, Some(0))];
    for settings in wrong.into_iter().chain([asked(f64::INFINITY, None), asked(1e-3, Some(usize::MAX))]) {
        for model in Model::SOLVERS {
            let found = Simulation::with_settings(catalog::hanging_span(), model, settings).map(|_| ());
            let refused = matches!(found, Err(Error::Solve(SolveError::Setting { .. })));
            assert!(refused, "{model} takes {settings:?}: {found:?}");
        }
    }
}

/// A part of them: what is said covers, and is no wild guess.
#[test]
fn stated_errors_cover_the_true_ones_and_are_close() {
    for model in [Model::Fem, Model::MassSpring] {
        let ratios = campaign(model, 9000..9003);
        for (quantity, ratios) in QUANTITIES.iter().zip(&ratios) {
            let (covers, close, nothing) = shares(ratios);
            assert!(covers >= 90.0 && close >= 80.0, "{model}, {quantity}: {covers:.0} % and {close:.0} %");
            assert!(10 * nothing <= ratios.len(), "{model}, {quantity}: {nothing} of {} say nothing", ratios.len());
        }
    }
}

/// The tables of docs/errors.md.
#[test]
#[ignore = "720 scenes by each model, minutes"]
fn stated_errors_of_720_scenes() {
    let only = std::env::var("ERRORS_MODEL").ok();
    for model in [Model::Fem, Model::MassSpring] {
        if only.as_ref().is_none_or(|o| o == model.name()) {
            let first = number("ERRORS_FIRST", 1000);
            campaign(model, first..first + number("ERRORS_CASES", 60));
        }
    }
}

//! FEM statics with bending stiffness is compared with every case of the families `elastica` and
//! `stiff_catenary` of `tests/data/statics.json`: a ladder in the number of bars for every value
//! the references give, identities that need no solver beside them, and what is said of sharp
//! bends.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Scene, Support, SupportKind, catalog};
use cable_core::solution::{CableSolution, Node, WarningKind};
use cable_core::{Model, Settings, Simulation};
use serde_json::Value;

/// Bars of each rung.
const RUNGS: [usize; 5] = [12, 25, 50, 100, 200];
/// Largest error of any value with 200 bars, in parts of its scale.
const BOUND: f64 = 3e-7;

/// A bent cable: what bends it, and what the reference says of it.
struct Bent {
    name: String,
    scene: Scene,
    /// EI, N·m².
    bending: f64,
    /// Reference values by name, and the size each error is measured by.
    values: Vec<(&'static str, f64, f64)>,
}

fn statics(family: &str) -> Vec<(String, Value)> {
    let all: Value = serde_json::from_str(include_str!("../../../tests/data/statics.json")).unwrap();
    all["cases"][family].as_object().unwrap().iter().map(|(k, v)| (k.clone(), v.clone())).collect()
}

fn number(v: &Value, group: &str, key: &str) -> Option<f64> {
    v[group][key].as_f64()
}

/// A cable of weight `w` (N/m) clamped along x at the origin.
fn clamped(length: f64, w: f64, ea: f64, ei: f64, end: Support) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = if w > 0.0 { 10.0 } else { 0.0 };
    scene.loads.clear();
    let cable = &mut scene.cables[0];
    cable.length_m = length;
    cable.linear_density_kg_per_m = if w > 0.0 { w / 10.0 } else { 1.0 };
    cable.axial_stiffness_n = ea;
    cable.bending_stiffness_n_m2 = ei;
    cable.thermal_expansion_per_k = 0.0;
    cable.breaking_tension_n = 1e15;
    cable.service_tension_n = 1e15;
    cable.segments = None;
    cable.route_m.clear();
    cable.supports = vec![clamp("A", [0.0, 0.0]), end];
    scene
}

fn clamp(name: &str, at: [f64; 2]) -> Support {
    Support { at_m: Some(at), angle_deg: Some(0.0), ..Support::new(name, SupportKind::Clamped) }
}

fn load(force: [f64; 2]) -> Support {
    Support { force_n: Some(force), ..Support::new("B", SupportKind::Load) }
}

/// So stiff that the stretch is below 1e-9 of any length here.
const INEXTENSIBLE: f64 = 1e12;

fn stiff_catenaries() -> Vec<Bent> {
    let case = |(name, v): (String, Value)| {
        let input = |key| number(&v, "in", key).unwrap();
        let (bending, ea) = (input("EI"), number(&v, "in", "EA").unwrap_or(INEXTENSIBLE));
        let scene = clamped(input("L"), input("w"), ea, bending, clamp("B", [input("X"), input("Z")]));
        let mut values = Vec::new();
        for key in ["H", "VA", "VB", "M_A", "M_B", "M_mid", "x_mid", "z_mid"] {
            if let Some(value) = number(&v, "out", key) {
                let scale = if key.ends_with("_mid") && !key.starts_with('M') { input("L") } else { value.abs() };
                values.push((key, value, scale));
            }
        }
        Bent { name, scene, bending, values }
    };
    statics("stiff_catenary").into_iter().map(case).collect()
}

fn elasticas() -> Vec<Bent> {
    let case = |(name, v): (String, Value)| {
        let out = |key| number(&v, "out", key).unwrap();
        let input = |key| number(&v, "in", key);
        let moment = ("M_clamp", if name.starts_with("pure") { out("M_full_circle") } else { out("M_clamp") });
        let (scene, mut values) = if name.starts_with("column") {
            let scene = clamped(1.0, 0.0, INEXTENSIBLE, 1.0, load([-out("PL2_over_EI"), 0.0]));
            let angle = input("alpha_deg").unwrap().to_radians();
            let tip = [("x_tip", out("axial_tip")), ("side_tip", out("lateral_tip")), ("turn_tip", angle)];
            (scene, tip.to_vec())
        } else if name.starts_with("pure") {
            // The moment that rolls it up is that of a second clamp at the origin, of the same
            // direction. Its route winds it once round.
            let mut scene = clamped(1.0, 0.0, INEXTENSIBLE, 1.0, clamp("B", [0.0, 0.0]));
            let corner = |k: u32| (f64::from(k) / 16.0 * std::f64::consts::TAU).sin_cos();
            scene.cables[0].route_m = (0..=16).map(corner).map(|(sin, cos)| [0.15 * sin, 0.15 * (1.0 - cos)]).collect();
            (scene, vec![("x_tip", out("x_tip")), ("y_tip", out("z_tip"))])
        } else {
            let w = input("w").unwrap_or(0.0);
            let end = input("PL2_over_EI").map_or(Support::free("B"), |p| load([0.0, -p]));
            let tip = [("x_tip", out("x_tip")), ("y_tip", out("z_tip")), ("turn_tip", out("theta_tip_rad"))];
            (clamped(1.0, w, INEXTENSIBLE, 1.0, end), tip.to_vec())
        };
        values.push(moment);
        let values = values.into_iter().map(|(k, x)| (k, x, if k == "M_clamp" { x } else { 1.0 })).collect();
        Bent { name, scene, bending: 1.0, values }
    };
    statics("elastica").into_iter().map(case).collect()
}

/// A nodal quantity in the middle of the cable, by the polynomial through the six nodes around it.
fn in_the_middle(nodes: &[Node], quantity: impl Fn(&Node) -> f64) -> f64 {
    let middle = 0.5 * nodes[nodes.len() - 1].arc_length_m;
    let after = nodes.partition_point(|n| n.arc_length_m < middle);
    let six = &nodes[after - 3..after + 3];
    let weight = |a: &Node| -> f64 {
        let others = six.iter().map(|b| b.arc_length_m).filter(|&b| b != a.arc_length_m);
        others.map(|b| (middle - b) / (a.arc_length_m - b)).product()
    };
    six.iter().map(|a| weight(a) * quantity(a)).sum()
}

/// A value of the answer by the reference's name.
fn value(cable: &CableSolution, bending: f64, key: &str) -> f64 {
    let (nodes, n) = (&cable.nodes, cable.nodes.len());
    let (first, last) = (&nodes[0], &nodes[n - 1]);
    match key {
        "H" => cable.supports[0].reaction_x_n,
        "VA" => cable.supports[0].reaction_y_n,
        "VB" => -cable.supports[1].reaction_y_n,
        "M_A" => bending * first.curvature_per_m,
        "M_B" => bending * last.curvature_per_m,
        "M_mid" => bending * in_the_middle(nodes, |n| n.curvature_per_m),
        "M_clamp" => bending * first.curvature_per_m.abs(),
        "x_mid" => in_the_middle(nodes, |n| n.x_m),
        "z_mid" => in_the_middle(nodes, |n| n.y_m),
        "x_tip" => last.x_m,
        "y_tip" => last.y_m,
        "side_tip" => last.y_m.abs(),
        "turn_tip" => {
            // The last bar's own direction, and the turn in it of a curvature a u + b u² at u from
            // the tip.
            let [two, one] = [&nodes[n - 3], &nodes[n - 2]];
            let from_tip = |n: &Node| last.arc_length_m - n.arc_length_m;
            let [ratio_one, ratio_two] = [one, two].map(|n| n.curvature_per_m / from_tip(n));
            let (u, v) = (from_tip(one), from_tip(two));
            let b = (ratio_two - ratio_one) / (v - u);
            let chord = (last.y_m - one.y_m).atan2(last.x_m - one.x_m);
            (chord + (ratio_one - b * u) * u * u / 6.0 + b * u * u * u / 12.0).abs()
        }
        other => panic!("unknown value {other}"),
    }
}

fn simulation(scene: &Scene, segments: Option<usize>) -> Simulation {
    let settings = Settings { segments, ..Settings::default() };
    let mut simulation = Simulation::with_settings(scene.clone(), Model::Fem, settings).unwrap();
    simulation.settle().unwrap_or_else(|e| panic!("{}: {e}", scene.name));
    simulation
}

fn solve(scene: &Scene, segments: Option<usize>) -> CableSolution {
    simulation(scene, segments).solution().cables.remove(0)
}

/// The error of every value at every rung; of fourth order wherever it is above what stretch and
/// rounding leave.
fn ladder(cases: &[Bent]) {
    let mut orders = 0;
    for case in cases {
        let cables = RUNGS.map(|n| solve(&case.scene, Some(n)));
        let estimate = cables[4].error_estimate.unwrap();
        assert!(estimate < BOUND, "{}: estimate {estimate:.1e}", case.name);
        let cable = &case.scene.cables[0];
        let force = cable.linear_density_kg_per_m * 10.0 * cable.length_m;
        let stretch = if cable.axial_stiffness_n == INEXTENSIBLE { 50.0 * force / INEXTENSIBLE } else { 0.0 };
        for &(key, expected, scale) in &case.values {
            let errors: Vec<f64> =
                cables.iter().map(|c| (value(c, case.bending, key) - expected).abs() / scale).collect();
            let shown: Vec<String> = errors.iter().map(|e| format!("{e:.1e}")).collect();
            println!("{:30} {key:9} {}", case.name, shown.join(" "));
            assert!(errors[4] < BOUND, "{} {key}: {errors:?}", case.name);
            // The finest pair of rungs that is above the floor.
            if let Some(pair) = errors[1..].windows(2).rfind(|p| p[1] > 1e-10 + stretch) {
                let order = (pair[0] / pair[1]).log2();
                assert!((3.4..5.6).contains(&order), "{} {key}: order {order:.2} in {errors:?}", case.name);
                orders += 1;
            }
        }
    }
    println!("{orders} orders seen");
    assert!(orders > 2 * cases.len(), "only {orders} values are above rounding");
}

#[test]
fn every_stiff_catenary_is_of_fourth_order() {
    ladder(&stiff_catenaries());
}

#[test]
fn every_elastica_is_of_fourth_order() {
    ladder(&elasticas());
}

/// First integrals of the weightless elastica: M = P·(lever of the tip), M²/2EI = P (sin or 1 − cos
/// of the turn).
#[test]
fn references_and_answers_keep_the_first_integrals() {
    for case in elasticas() {
        let Some(tip) = case.scene.cables[0].supports[1].force_n else { continue };
        let of = |name: &str| case.values.iter().find(|v| v.0 == name).unwrap().1;
        let cable = solve(&case.scene, Some(100));
        for found in [&|key: &str| of(key), &|key: &str| value(&cable, 1.0, key)] as [&dyn Fn(&str) -> f64; 2] {
            let (moment, turn) = (found("M_clamp"), found("turn_tip"));
            let (lever, work) = if tip[0] == 0.0 {
                (-tip[1] * found("x_tip"), -tip[1] * turn.sin())
            } else {
                (-tip[0] * found("side_tip"), -tip[0] * (1.0 - turn.cos()))
            };
            assert!((moment - lever).abs() < 1e-8 * moment, "{}: {moment} and {lever}", case.name);
            assert!((0.5 * moment * moment - work).abs() < 1e-7 * work, "{}: {moment}, turn {turn}", case.name);
        }
    }
}

/// Balance of moments of a whole clamped span: M_B − M_A = H Z − (VA + wL) X + w ∫x ds.
#[test]
fn clamp_moments_balance_the_weight() {
    for case in stiff_catenaries() {
        let cable = solve(&case.scene, Some(400));
        let found = |key: &str| value(&cable, case.bending, key);
        let w = case.scene.cables[0].linear_density_kg_per_m * 10.0;
        let last = cable.nodes.last().unwrap();
        let moment: f64 =
            cable.nodes.windows(2).map(|p| 0.5 * (p[0].x_m + p[1].x_m) * (p[1].arc_length_m - p[0].arc_length_m)).sum();
        let balance = found("H") * last.y_m - found("VA") * last.x_m - w * (last.arc_length_m * last.x_m - moment);
        let whole = w * last.arc_length_m * last.x_m;
        let off = (found("M_B") - found("M_A") - balance).abs() / whole;
        assert!(off < 1e-5, "{}: {off:.1e} of the weight's moment", case.name);
    }
}

#[test]
fn meshes_of_its_own_choice_are_as_good() {
    for case in stiff_catenaries().iter().chain(&elasticas()) {
        let cable = solve(&case.scene, None);
        for &(key, expected, scale) in &case.values {
            let off = (value(&cable, case.bending, key) - expected).abs() / scale;
            assert!(off < 1e-4, "{} {key}: {off:.1e} with {} nodes", case.name, cable.nodes.len());
        }
    }
}

/// Read along straight lines between its nodes a stiff cable is where it is, however few bars its
/// forces need.
#[test]
fn places_between_nodes_lie_on_the_cable() {
    for case in stiff_catenaries() {
        let (cable, fine) = (solve(&case.scene, None), solve(&case.scene, Some(3000)));
        let length = case.scene.cables[0].length_m;
        for node in &fine.nodes {
            let k = cable.nodes.partition_point(|n| n.arc_length_m < node.arc_length_m).clamp(1, cable.nodes.len() - 1);
            let (a, b) = (&cable.nodes[k - 1], &cable.nodes[k]);
            let f = (node.arc_length_m - a.arc_length_m) / (b.arc_length_m - a.arc_length_m);
            let off = (a.at() + (b.at() - a.at()) * f - node.at()).norm() / length;
            assert!(off < 3e-5, "{}: {off:.1e} of the length at {} m", case.name, node.arc_length_m);
        }
    }
}

/// A stiff cable longer than its way pushes where it runs back: T = H cos θ + V sin θ, at every
/// node.
#[test]
fn what_pushes_has_less_than_no_tension() {
    let end = clamp("B", [3.76, -0.70]);
    let cable = solve(&clamped(4.52, 4.79, 1e7, 5.95, end), None);
    let [h, v] = [cable.supports[0].reaction_x_n, cable.supports[0].reaction_y_n];
    let (first, last) = (cable.nodes.first().unwrap(), cable.nodes.last().unwrap());
    assert!((first.tension_n - h).abs() < 1e-6 && (last.tension_n - h).abs() < 1e-6, "{first:?} {last:?}");
    assert!(h < -4.0, "it pushes its clamps with {h} N");
    // The direction is that of the nodes beside it: 1 % of the push.
    for p in cable.nodes.windows(3) {
        let along = p[2].at() - p[0].at();
        let expected = (h * along.x + (v + 4.79 * p[1].arc_length_m) * along.y) / along.norm();
        assert!(
            (p[1].tension_n - expected).abs() < 0.06,
            "{} and {expected} N at {} m",
            p[1].tension_n,
            p[1].arc_length_m
        );
    }
}

/// A route that winds the other way, or twice, is kept: M = 2π n EI/L.
#[test]
fn a_stiff_cable_keeps_the_loops_of_its_route() {
    let circle = elasticas().into_iter().find(|c| c.name.starts_with("pure")).unwrap();
    for turns in [-2.0, -1.0, 1.0, 2.0] {
        let mut scene = circle.scene.clone();
        let corner = |k: u32| (f64::from(k) / 32.0 * std::f64::consts::TAU * turns).sin_cos();
        let point = |(sin, cos): (f64, f64)| [0.15 * turns.signum() * sin, 0.15 * turns.signum() * (1.0 - cos)];
        scene.cables[0].route_m = (0..=32).map(corner).map(point).collect();
        let cable = solve(&scene, Some(40));
        for node in &cable.nodes {
            let expected = std::f64::consts::TAU * turns;
            assert!((node.curvature_per_m - expected).abs() < 1e-8, "{turns}: {}", node.curvature_per_m);
        }
    }
}

#[test]
fn sharp_bends_are_told_with_their_radius() {
    let case = stiff_catenaries().into_iter().find(|c| c.name == "clamped0_EI1000").unwrap();
    let expected = case.bending / case.values.iter().find(|v| v.0 == "M_A").unwrap().1.abs();
    // At the clamp the cable is led; a tip moment's circle bends freely.
    for (limit, warned) in [(0.9 * expected, false), (1.1 * expected, true)] {
        let mut scene = case.scene.clone();
        scene.cables[0].min_bend_radius_m = limit;
        let answer = simulation(&scene, Some(200)).solution();
        let bend = answer.cables[0].tightest_bend.unwrap();
        assert!((bend.radius_m / expected - 1.0).abs() < 1e-6, "{bend:?}");
        assert_eq!(answer.warnings.iter().any(|w| w.kind == WarningKind::BendRadius), warned, "{:?}", answer.warnings);
    }
    let circle = elasticas().into_iter().find(|c| c.name.starts_with("pure")).unwrap();
    let expected = 1.0 / std::f64::consts::TAU;
    for (limit, warned) in [(0.9 * expected, false), (1.1 * expected, true)] {
        let mut scene = circle.scene.clone();
        scene.cables[0].min_bend_radius_m = limit;
        let answer = simulation(&scene, Some(200)).solution();
        let kink = answer.warnings.iter().find(|w| w.kind == WarningKind::Kink);
        assert_eq!(kink.is_some(), warned, "{:?}", answer.warnings);
        assert!(kink.is_none_or(|w| (w.value / expected - 1.0).abs() < 1e-6), "{kink:?}");
    }
}

/// Length, density, EI, far end, angles of both clamps (°). Without bending stiffness each sags;
/// with it the clamps turn it upwards, or aside, and on the way up in EI its shape snaps over.
const SNAPPING: [([f64; 3], [f64; 2], [f64; 2]); 4] = [
    ([1.77, 0.877, 16.56], [1.667, 0.0838], [25.9, -41.2]),
    ([1.44, 0.114, 0.2476], [1.3376, 0.418], [41.5, -19.9]),
    ([2.585, 3.365, 153.4], [2.271, 1.0889], [51.9, 17.5]),
    ([1.1605, 0.6135, 15.4], [1.1027, -0.2559], [8.2, -26.4]),
];

#[test]
fn clamps_that_turn_a_sagging_cable_over_are_answered() {
    for ([length, density, bending], end, angles) in SNAPPING {
        let angled = |name, at, k: usize| Support { angle_deg: Some(angles[k]), ..clamp(name, at) };
        let mut scene = clamped(length, 10.0 * density, 1e6, bending, angled("B", end, 1));
        scene.cables[0].supports[0] = angled("A", [0.0, 0.0], 0);
        let answer = Simulation::new(scene, Model::Auto).unwrap().settle().unwrap();
        let [a, b] = [0, 1].map(|k| &answer.cables[0].supports[k]);
        let weight = 10.0 * density * length;
        let off = (a.reaction_x_n + b.reaction_x_n).hypot(a.reaction_y_n + b.reaction_y_n + weight);
        let scale = weight.max(a.reaction_x_n.hypot(a.reaction_y_n));
        assert!(off <= 1e-9 * scale, "{length}: {off} of {scale}");
        let [node, next] = [0, 1].map(|k| answer.cables[0].nodes[k]);
        let way = (next.y_m - node.y_m).atan2(next.x_m - node.x_m).to_degrees();
        let bow = (0.5 * node.curvature_per_m * (next.arc_length_m - node.arc_length_m)).to_degrees();
        assert!((way - bow - angles[0]).abs() < 0.5, "{length}: leaves at {way}");
    }
}

//! Equilibria that were refused, or were others than the same cable has in other words:
//! - a clamp between the ends of a stiff cable takes a moment, which the verification missed;
//! - seen from above, a floor without friction was a contact everywhere, so that wheels and stiff
//!   cables had no equilibrium; and a rubbing one acts anywhere between two nodes, so that a cable
//!   was refused over 0.2 µm;
//! - a stiff cable that could touch itself, and does not, had another equilibrium or none.

#![allow(clippy::expect_used, clippy::unwrap_used, missing_docs)] // a failing test is meant to panic

use cable_core::scene::{Obstacle, PulleySide, Shape, Support, SupportKind, View, catalog};
use cable_core::solution::{ShownEquilibrium, WarningCause};
use cable_core::{Model, Scene, Simulation, Solution};

/// A cable of this length (m), bending stiffness (N·m²) and friction between supports.
fn scene(view: View, [length_m, stiffness, friction]: [f64; 3], supports: Vec<Support>) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.view = view;
    scene.obstacles.clear();
    let cable = &mut scene.cables[0];
    (cable.length_m, cable.bending_stiffness_n_m2, cable.friction) = (length_m, stiffness, friction);
    (cable.axial_stiffness_n, cable.diameter_m, cable.linear_density_kg_per_m) = (1e6, 0.02, 1.2);
    cable.route_m.clear();
    cable.supports = supports;
    scene
}

fn rest(scene: &Scene, model: Model) -> Solution {
    Simulation::new(scene.clone(), model).unwrap().settle().unwrap()
}

fn pull(answer: &Solution, support: usize) -> [f64; 2] {
    let s = &answer.cables[0].supports[support];
    [s.reaction_x_n, s.reaction_y_n]
}

fn clamp(at: [f64; 2], angle_deg: f64) -> Support {
    Support { at_m: Some(at), angle_deg: Some(angle_deg), ..Support::new("clamp", SupportKind::Clamped) }
}

#[test]
fn a_clamp_between_the_ends_divides_a_stiff_cable_in_two() {
    let (a, m, b) = ([0.0, 2.0], [2.0, 1.97], [3.0, 1.58]);
    let (first, second) = (2.63, 1.32);
    for angle_deg in [12.7, -40.0] {
        let ends = [Support::fixed("A", a), Support::fixed("B", b)];
        let between = Support { arc_length_m: Some(first), ..clamp(m, angle_deg) };
        let whole = vec![ends[0].clone(), between, ends[1].clone()];
        let whole = rest(&scene(View::Elevation, [first + second, 0.5, 0.4], whole), Model::Auto);
        let halves = [
            scene(View::Elevation, [first, 0.5, 0.4], vec![ends[0].clone(), clamp(m, angle_deg)]),
            scene(View::Elevation, [second, 0.5, 0.4], vec![clamp(m, angle_deg), ends[1].clone()]),
        ];
        let [before, after] = halves.map(|half| rest(&half, Model::Auto));
        let (sum, held) = ([0, 1].map(|k| pull(&before, 1)[k] + pull(&after, 0)[k]), pull(&whole, 1));
        assert!((held[0] - sum[0]).hypot(held[1] - sum[1]) < 1e-3 * sum[0].hypot(sum[1]), "{held:?} {sum:?}");
        // Both sides of the clamp are bent as the halves are, just beside it.
        let bend = |answer: &Solution, s: f64| {
            let nodes = &answer.cables[0].nodes;
            let k = nodes.partition_point(|n| n.arc_length_m < s).clamp(1, nodes.len() - 1);
            let f = (s - nodes[k - 1].arc_length_m) / (nodes[k].arc_length_m - nodes[k - 1].arc_length_m);
            nodes[k - 1].curvature_per_m * (1.0 - f) + nodes[k].curvature_per_m * f
        };
        for (half, at, here) in [(&before, first - 0.1, first - 0.1), (&after, 0.1, first + 0.1)] {
            let (there, here) = (bend(half, at), bend(&whole, here));
            assert!((here - there).abs() < 0.02 * there.abs().max(0.1), "{angle_deg}: {here} {there}");
        }
    }
}

/// A cable over a wheel, seen from above, that is longer than its way by these parts of it.
fn round_a_wheel(longer: f64, friction: f64) -> (Scene, f64) {
    let (p, b, radius) = ([3.09_f64, 1.37_f64], [4.69, 0.0], 0.26_f64);
    let legs = [p, [p[0] - b[0], p[1] - b[1]]].map(|v| (v, v[0].hypot(v[1])));
    // The angle between the legs, seen from the wheel, on the side where the cable is not.
    let between = ((legs[0].0[0] * legs[1].0[0] + legs[0].0[1] * legs[1].0[1]) / (legs[0].1 * legs[1].1)).acos();
    let arc = 2.0 * std::f64::consts::PI - between - legs.iter().map(|l| (radius / l.1).acos()).sum::<f64>();
    let way = legs.iter().map(|l| (l.1 * l.1 - radius * radius).sqrt()).sum::<f64>() + radius * arc;
    let wheel = Support {
        at_m: Some(p),
        radius_m: Some(0.25),
        friction: Some(0.0),
        side: Some(PulleySide::Over),
        ..Support::new("wheel", SupportKind::Pulley)
    };
    let supports = vec![Support::fixed("A", [0.0, 0.0]), wheel, Support::fixed("B", b)];
    let length = way * (1.0 + longer);
    (scene(View::Plan, [length, 0.0, friction], supports), 1e6 * (way / length - 1.0))
}

#[test]
fn seen_from_above_a_cable_goes_round_a_wheel() {
    let (taut, tension) = round_a_wheel(-1e-3, 0.0);
    let answer = rest(&taut, Model::Auto);
    assert!((answer.max_tension().tension_n / tension - 1.0).abs() < 1e-6, "{tension}");
    for (longer, friction) in [(0.05, 0.0), (0.05, 0.3), (-1e-3, 0.3)] {
        let (scene, tension) = round_a_wheel(longer, friction);
        let answer = rest(&scene, Model::Auto);
        let [greatest, expected] = [answer.max_tension().tension_n, tension.max(0.0)];
        // Friction on the floor holds at most its weight times that.
        let floor = friction * 1.2 * 9.80665 * scene.cables[0].length_m;
        assert!((greatest - expected).abs() <= floor + 1e-6 * expected + 1e-3, "{greatest} {expected} {floor}");
    }
}

#[test]
fn masses_and_springs_on_a_rubbing_floor_follow_their_mesh_round_a_wheel() {
    for longer in [-1e-3, 0.05] {
        // An error is an answer, too; it must not end the program.
        let answer = Simulation::new(round_a_wheel(longer, 0.3).0, Model::MassSpring).unwrap().settle();
        assert!(answer.is_ok_and(|a| a.max_tension().tension_n.is_finite()));
    }
}

/// Complete elliptic integrals K and E of the parameter m by the arithmetic-geometric mean.
fn elliptic(m: f64) -> [f64; 2] {
    // E/K = 1 − Σ 2ⁿ⁻¹ cₙ², with c₀² = m and cₙ = (aₙ₋₁ − bₙ₋₁)/2.
    let (mut a, mut b, mut sum, mut power) = (1.0_f64, (1.0 - m).sqrt(), 0.5 * m, 1.0);
    for _ in 0..8 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        sum += power * c * c;
        power *= 2.0;
    }
    let k = std::f64::consts::FRAC_PI_2 / a;
    [k, k * (1.0 - sum)]
}

/// A stiff cable pinned nearer than it is long bows to an elastica with the thrust
/// `EI (2K(m)/L)²`, where `2E/K − 1 = D/L`.
#[test]
fn a_stiff_slack_cable_seen_from_above_bows() {
    let (length, chord, stiffness) = (3.7, 2.6, 1.0);
    let (mut low, mut high) = (0.0, 0.999);
    for _ in 0..60 {
        let m = 0.5 * (low + high);
        let [k, e] = elliptic(m);
        if 2.0 * e / k - 1.0 > chord / length { low = m } else { high = m }
    }
    let thrust = stiffness * (2.0 * elliptic(low)[0] / length).powi(2);
    for friction in [0.0, 0.3] {
        let pinned = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [chord, 0.0])];
        let answer = rest(&scene(View::Plan, [length, stiffness, friction], pinned), Model::Auto);
        let found = -pull(&answer, 0)[0];
        assert!((found.abs() / thrust - 1.0).abs() < 1e-3, "μ {friction}: {found} N, by hand {thrust} N");
        let shown =
            |w: &WarningCause| matches!(w, WarningCause::ManyEquilibria { shown: ShownEquilibrium::Frictionless, .. });
        assert_eq!(answer.warnings.iter().any(|w| shown(&w.cause)), friction > 0.0, "{:?}", answer.warnings);
    }
}

fn data(text: &str) -> Scene {
    Scene::from_toml(text).unwrap()
}

#[test]
fn on_a_rubbing_floor_a_way_is_not_refused_over_a_fifth_of_a_micrometre() {
    let mut scene = data(include_str!("data/plan_s_bend.toml"));
    for stiffness_n in [1e5, scene.cables[0].axial_stiffness_n, 5e7] {
        scene.cables[0].axial_stiffness_n = stiffness_n;
        rest(&scene, Model::Auto);
    }
}

#[test]
fn a_stiff_cable_that_could_touch_itself_and_does_not_rests_as_if_it_could_not() {
    for text in
        [include_str!("data/stiff_slack_on_smooth_floor.toml"), include_str!("data/stiff_fold_beside_itself.toml")]
    {
        let touching = data(text);
        let mut passing = touching.clone();
        passing.cables[0].self_contact = false;
        let [a, b] = [touching, passing].map(|s| rest(&s, Model::Auto));
        let ([p, q], [r, s]) = ([pull(&a, 0), pull(&a, 1)], [pull(&b, 0), pull(&b, 1)]);
        let off = (p[0] - r[0]).hypot(p[1] - r[1]) + (q[0] - s[0]).hypot(q[1] - s[1]);
        assert!(off < 1e-6, "{p:?} {q:?} {r:?} {s:?}");
    }
}

#[test]
fn a_straight_cable_has_no_bend() {
    let pinned = vec![Support::fixed("A", [0.1, 0.3]), Support::fixed("B", [3.13, 0.77])];
    for stiffness in [0.0, 1.0] {
        let answer = rest(&scene(View::Plan, [3.06, stiffness, 0.0], pinned.clone()), Model::Auto);
        assert_eq!(answer.cables[0].tightest_bend, None);
    }
}

/// Over a smooth wheel a stiff cable rests as over a smooth post, which it did where over the wheel
/// nothing was found.
#[test]
fn a_stiff_cable_rests_on_a_wheel_as_on_a_post() {
    let (p, radius_m) = ([2.303, 0.702], 0.195);
    let wheel = Support {
        at_m: Some(p),
        radius_m: Some(radius_m),
        friction: Some(0.0),
        ..Support::new("wheel", SupportKind::Pulley)
    };
    let ends = [clamp([0.0, 0.0], 35.9), Support::fixed("B", [4.695, -0.546])];
    let with_wheel = vec![ends[0].clone(), wheel, ends[1].clone()];
    let mut over_wheel = scene(View::Elevation, [5.48, 16.4, 0.0], with_wheel);
    let cable = &mut over_wheel.cables[0];
    (cable.axial_stiffness_n, cable.diameter_m, cable.linear_density_kg_per_m) = (1e5, 0.01, 0.48);
    let mut over_post = over_wheel.clone();
    over_post.cables[0].route_m = vec![[0.0, 0.0], [p[0], p[1] + 0.25], [4.695, -0.546]];
    over_post.cables[0].supports = ends.to_vec();
    over_post.obstacles.push(Obstacle {
        name: "post".to_owned(),
        shape: Shape::Circle { center_m: p, radius_m },
        friction: Some(0.0),
    });
    let [wheel, post] = [over_wheel, over_post].map(|s| rest(&s, Model::Auto));
    let (a, b) = ([pull(&wheel, 0), pull(&wheel, 2)], [pull(&post, 0), pull(&post, 1)]);
    let off: f64 = a.iter().zip(&b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).sum();
    assert!(off < 1e-6, "{a:?} {b:?}");
}

/// Elements of an elastica, or bars of a chain, are longer than a thin beam: the cable went through
/// the beam between two nodes that are clear of it on both sides, and the answer was refused.
#[test]
fn a_stiff_cable_does_not_cut_through_a_thin_beam() {
    let cases = [
        ([10.034, 1.379, 0.2], 0.4865, [[0.0, 1.1887], [9.0452, 0.02]], [[4.4247, 0.62196], [4.5788, 0.72196]]),
        ([11.0438, 4.3741, 0.5], 1.1544, [[0.0, 3.6729], [8.4816, 1.5]], [[3.5496, 0.2438], [3.9893, 0.3438]]),
    ];
    for (cable, density, [a, b], beam) in cases {
        let ends = vec![Support::fixed("A", a), Support::fixed("B", b)];
        let mut s = scene(View::Elevation, cable, ends);
        let cable = &mut s.cables[0];
        (cable.linear_density_kg_per_m, cable.axial_stiffness_n, cable.diameter_m) = (density, 1e6, 0.02);
        let floor = Shape::Terrain { points_m: vec![[-20.0, 0.0], [40.0, 0.0]] };
        let shapes = [("floor", floor), ("beam", Shape::Polyline { points_m: beam.to_vec(), thickness_m: 0.0 })];
        s.obstacles = shapes.map(|(name, shape)| Obstacle { name: name.into(), shape, friction: Some(0.3) }).into();
        let answer = rest(&s, Model::Auto);
        assert!(answer.cables[0].errors.support_force_n.is_some_and(|e| e < 1e-3), "{:?}", answer.cables[0].errors);
    }
}

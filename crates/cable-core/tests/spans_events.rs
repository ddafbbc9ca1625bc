//! Around events `spans` obeys these rules: tension does not jump where contacts come, go, join or
//! fall slack; what is held still stays; several supports, loads in wind, undersides and turns
//! round posts.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::Vec2;
use cable_core::model::spans::SpansModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::scene::{Load, Obstacle, Scene, Shape, Support, catalog};
use cable_core::solution::{CableSolution, ContactReport};

/// A flexible cable from a to b along a route over shapes.
fn scene(shapes: Vec<Shape>, route_m: Vec<[f64; 2]>, (length_m, friction): (f64, f64)) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    let named = |(k, shape)| Obstacle { name: format!("obstacle {k}"), shape, friction: None };
    scene.obstacles = shapes.into_iter().enumerate().map(named).collect();
    let c = &mut scene.cables[0];
    (c.bending_stiffness_n_m2, c.axial_stiffness_n, c.diameter_m) = (0.0, 1e6, 0.02);
    (c.service_tension_n, c.breaking_tension_n) = (1e15, 1e15);
    (c.length_m, c.friction) = (length_m, friction);
    c.supports = vec![Support::fixed("A", route_m[0]), Support::fixed("B", *route_m.last().unwrap())];
    c.route_m = route_m;
    scene
}

fn model(scene: &Scene) -> SpansModel {
    let mut model = SpansModel::new(problems(scene).unwrap().remove(0), Settings::default()).unwrap();
    model.settle().unwrap();
    model
}

fn ground(points_m: &[[f64; 2]]) -> Shape {
    Shape::Terrain { points_m: points_m.to_vec() }
}

fn beam(x: [f64; 2], y: [f64; 2]) -> Shape {
    Shape::Polygon { points_m: vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]] }
}

/// Tension at both ends.
fn pulls(answer: &CableSolution) -> [f64; 2] {
    [answer.nodes.first().unwrap().tension_n, answer.nodes.last().unwrap().tension_n]
}

/// Contacts, and nodes without tension: what an event changes.
fn signature(answer: &CableSolution) -> (usize, usize) {
    (answer.contacts.len(), answer.nodes.iter().filter(|n| n.tension_n == 0.0).count())
}

/// Moves the far end from where it is by `way`, looks for events in so many steps and draws each in
/// by halving.
fn continuous(scene: &Scene, way: Vec2, steps: usize) -> usize {
    let mut now = model(scene);
    let last = scene.cables[0].supports[1].at_m.unwrap();
    let from = Vec2::new(last[0], last[1]);
    let moved = |model: &SpansModel, u: f64| {
        let mut model = model.clone();
        model.drag_support(1, from + way * u);
        model.advance(0.1, Inertia::QuasiStatic).unwrap();
        model
    };
    let mut events = 0;
    for k in 0..steps {
        let (mut low, mut high) = (k as f64 / steps as f64, (k + 1) as f64 / steps as f64);
        let after = moved(&now, high);
        let was = signature(&now.solution());
        if signature(&after.solution()) != was {
            events += 1;
            let (mut below, mut above) = (now.clone(), after.clone());
            while high - low > 1e-11 {
                let u = 0.5 * (low + high);
                let middle = moved(&below, u);
                if signature(&middle.solution()) == was {
                    (low, below) = (u, middle);
                } else {
                    (high, above) = (u, middle);
                }
            }
            let (a, b) = (pulls(&below.solution()), pulls(&above.solution()));
            for side in 0..2 {
                let jump = (a[side] - b[side]).abs() / a[side];
                assert!(jump <= 1e-6, "tension jumps by {jump:e} at {low} of the way: {was:?}");
            }
        }
        now = after;
    }
    events
}

#[test]
fn tension_does_not_jump_where_contacts_come_and_go() {
    for friction in [0.0, 0.3] {
        let floor = ground(&[[-5.0, 0.0], [20.0, 0.0]]);
        let low = scene(vec![floor], vec![[0.0, 3.0], [10.0, 3.0]], (11.0, friction));
        assert!(continuous(&low, Vec2::new(0.0, -2.8), 40) >= 1);
        let post = Shape::Circle { center_m: [5.0, 2.0], radius_m: 0.3 };
        let route = vec![[0.0, 2.0], [5.0, 2.6], [10.0, 2.0]];
        assert!(continuous(&scene(vec![post], route, (10.2, friction)), Vec2::new(0.0, 2.0), 40) >= 1);
        let hills = ground(&[[-5.0, 0.0], [3.0, 0.0], [4.0, 0.4], [5.0, 0.5], [6.0, 0.4], [7.0, 0.0], [15.0, 0.0]]);
        let route = vec![[0.0, 2.0], [10.0, 2.0]];
        assert!(continuous(&scene(vec![hills], route, (10.7, friction)), Vec2::new(0.0, -1.6), 40) >= 1);
    }
}

/// A load comes down, what is beside it does, and all of it lifts off again; an end that is drawn
/// comes down.
#[test]
fn tension_does_not_jump_where_loads_come_down_and_lift_off() {
    let floor = || ground(&[[-5.0, 0.0], [20.0, 0.0]]);
    let weight = |s: &mut Scene, arc_length_m: f64, force: [f64; 2]| {
        let cable = s.cables[0].name.clone();
        s.loads.push(Load { cable, arc_length_m, force_n: Some(force), times_s: vec![], forces_n: vec![] });
    };
    for friction in [0.0, 0.3] {
        let mut s = scene(vec![floor()], vec![[0.0, 2.0], [10.0, 2.5]], (11.0, friction));
        weight(&mut s, 5.0, [0.0, -100.0]);
        assert!(continuous(&s, Vec2::new(0.3, -1.8), 40) >= 1);
        let mut s = scene(vec![floor()], vec![[0.0, 1.0], [5.0, 0.01], [10.0, 1.0]], (11.0, friction));
        weight(&mut s, 5.5, [0.0, -100.0]);
        assert!(continuous(&s, Vec2::new(0.3, 3.0), 40) >= 2);
    }
}

/// A valley between two hills: as the end comes nearer the span over the kink shrinks, the cable
/// falls slack in it, and is drawn taut again on the way back.
#[test]
fn tension_does_not_jump_where_the_cable_falls_slack_in_a_kink() {
    for friction in [0.0, 0.2] {
        let valley = ground(&[[-5.0, 0.5], [0.5, 0.5], [4.0, 0.0], [7.5, 0.5], [15.0, 0.5]]);
        let s = scene(vec![valley], vec![[0.0, 1.0], [8.0, 1.0]], (8.5, friction));
        let mut m = model(&s);
        let mut slack = 0;
        for x in [7.95, 7.9, 7.85, 7.9, 7.95, 8.0, 8.1, 8.2] {
            m.drag_support(1, Vec2::new(x, 1.0));
            m.advance(0.1, Inertia::QuasiStatic).unwrap();
            slack += usize::from(signature(&m.solution()).1 > 0);
        }
        assert!(slack > 0, "no pocket at friction {friction}");
        assert_eq!(signature(&m.solution()).1, 0, "slack that is drawn out is gone");
        assert!(continuous(&s, Vec2::new(0.2, 0.0), 40) >= 1);
    }
}

#[test]
fn holding_still_changes_nothing() {
    let hills = ground(&[[-5.0, 0.0], [3.0, 0.0], [4.0, 0.4], [5.0, 0.5], [6.0, 0.4], [7.0, 0.0], [15.0, 0.0]]);
    for friction in [0.0, 0.3] {
        let s = scene(vec![hills.clone()], vec![[0.0, 1.0], [10.0, 1.0]], (10.7, friction));
        let mut m = model(&s);
        m.drag_support(1, Vec2::new(10.2, 1.1));
        m.advance(0.1, Inertia::QuasiStatic).unwrap();
        let before = m.solution();
        for _ in 0..20 {
            m.advance(1.0, Inertia::QuasiStatic).unwrap();
        }
        let after = m.solution();
        assert_eq!(before.nodes.len(), after.nodes.len());
        for (a, b) in before.nodes.iter().zip(&after.nodes) {
            assert!((a.x_m - b.x_m).abs() <= 1e-12 * 10.7 && (a.y_m - b.y_m).abs() <= 1e-12 * 10.7);
            assert!((a.tension_n - b.tension_n).abs() <= 1e-12 * pulls(&before)[0], "{friction}");
        }
    }
}

/// Without friction only where the supports are counts, whichever of them went there, and in
/// whatever order.
#[test]
fn both_supports_may_move() {
    let hills = ground(&[[-5.0, 0.0], [3.0, 0.0], [4.0, 0.4], [5.0, 0.5], [6.0, 0.4], [7.0, 0.0], [15.0, 0.0]]);
    let s = scene(vec![hills], vec![[0.0, 1.0], [10.0, 1.0]], (10.7, 0.0));
    let (a, b) = (Vec2::new(-0.3, 1.4), Vec2::new(10.3, 0.8));
    let (mut at_once, mut in_turn) = (model(&s), model(&s));
    at_once.drag_support(0, a);
    at_once.drag_support(1, b);
    at_once.advance(1.0, Inertia::QuasiStatic).unwrap();
    for (k, at) in [(1, b), (0, a)] {
        in_turn.drag_support(k, at);
        in_turn.advance(1.0, Inertia::QuasiStatic).unwrap();
    }
    let (p, q) = (pulls(&at_once.solution()), pulls(&in_turn.solution()));
    assert!((0..2).all(|k| (p[k] - q[k]).abs() <= 1e-9 * p[k]), "{p:?} {q:?}");
}

/// A rope led under a beam is pulled up against its underside: its corners hold it, the edge
/// between them does not.
#[test]
fn an_underside_is_held_by_its_corners() {
    let s =
        scene(vec![beam([4.0, 6.0], [1.0, 1.3])], vec![[0.0, 3.0], [3.9, 0.8], [6.1, 0.8], [10.0, 3.0]], (11.2, 0.0));
    let mut m = model(&s);
    for x in [10.2, 10.4, 10.6, 10.8] {
        m.drag_support(1, Vec2::new(x, 3.0));
        m.advance(0.1, Inertia::QuasiStatic).unwrap();
        let answer = m.solution();
        // Every node below the beam is below its underside by the radius, and hangs.
        for n in answer.nodes.iter().filter(|n| n.x_m > 4.0 && n.x_m < 6.0) {
            assert!(n.y_m <= 1.0 - 0.01 + 1e-9, "({}, {})", n.x_m, n.y_m);
        }
    }
    let answer = m.solution();
    assert_eq!(answer.contacts.len(), 2);
    // Both corners push down.
    assert!(answer.contacts.iter().all(|c| c.normal[1] < 0.0));
    // Without friction T is the same before and after, and the corner is pressed by T times the
    // turn.
    for c in &answer.contacts {
        let [t, u] = [c.tension_before_n, c.tension_after_n];
        assert!((t - u).abs() <= 1e-5 * t, "{t} {u}");
        let law = 0.5 * (t + u) * c.turn_deg.abs().to_radians();
        assert!((c.normal_n / law - 1.0).abs() <= 1e-5, "{} {law}", c.normal_n);
    }
}

/// Three and a half turns round a post: e^{μθ} each way.
#[test]
fn a_post_may_be_wound_by_several_turns() {
    let (friction, radius) = (0.1, 0.2);
    let mut route = vec![[-3.0, 0.0]];
    for k in 0..=84 {
        let angle = std::f64::consts::FRAC_PI_2 - std::f64::consts::TAU * f64::from(k) / 24.0;
        route.push([0.21 * angle.cos(), 0.21 * angle.sin()]);
    }
    route.push([-3.0, -0.5]);
    let way: f64 = route.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
    let post = Shape::Circle { center_m: [0.0, 0.0], radius_m: radius };
    let mut s = scene(vec![post], route, (way * 1.001, friction));
    s.cables[0].linear_density_kg_per_m = 1e-6;
    let mut m = model(&s);
    for k in 1..=40 {
        m.drag_support(1, Vec2::new(-3.0 - 0.02 * f64::from(k), -0.5));
        m.advance(0.1, Inertia::QuasiStatic).unwrap();
    }
    let answer = m.solution();
    let c = &answer.contacts[0];
    assert!(c.turn_deg.abs() > 1200.0, "{}", c.turn_deg);
    let ratio = c.tension_after_n / c.tension_before_n;
    let law = (friction * c.turn_deg.abs().to_radians()).exp();
    // Drawn far enough it slides all the way.
    assert!((ratio / law - 1.0).abs() <= 1e-6, "{ratio} {law}");
}

/// Loads within the spans, in wind, over a post, moved: forces sum up to nothing.
#[test]
fn loads_and_wind_over_a_post() {
    let post = Shape::Circle { center_m: [5.0, 2.0], radius_m: 0.3 };
    let mut s = scene(vec![post], vec![[0.0, 2.0], [5.0, 2.6], [10.0, 2.0]], (10.5, 0.2));
    s.environment.wind_n_per_m = [3.0, 1.0];
    for (arc_length_m, force_n) in [(2.0, [5.0, -40.0]), (7.5, [0.0, -25.0])] {
        let cable = s.cables[0].name.clone();
        s.loads.push(Load { cable, arc_length_m, force_n: Some(force_n), times_s: vec![], forces_n: vec![] });
    }
    let mut m = model(&s);
    for k in 1..=10 {
        m.drag_support(1, Vec2::new(10.0 + 0.02 * f64::from(k), 2.0 - 0.05 * f64::from(k)));
        m.advance(0.1, Inertia::QuasiStatic).unwrap();
    }
    let (answer, problem) = (m.solution(), problems(&s).unwrap().remove(0));
    let (c, given) = (&answer.contacts[0], problem.body_force(0.0) * problem.length + Vec2::new(5.0, -65.0));
    let held = answer.supports.iter().fold(Vec2::zeros(), |sum, s| sum + Vec2::new(s.reaction_x_n, s.reaction_y_n));
    let pressed = held - given;
    // The force that remains is the post's: its normal and its friction.
    let size = c.normal_n.hypot(c.friction_n);
    assert!(pressed.norm() > 0.2 * size && pressed.norm() < size * (1.0 + 1e-9), "{pressed} {c:?}");
    assert_eq!(answer.contacts.len(), 1);
    assert!(answer.contacts[0].tension_after_n / answer.contacts[0].tension_before_n < (0.2f64 * 2.0).exp());
}

/// Returns whether a point is below the ground, by the points of the ground alone.
fn below(points: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    points.windows(2).any(|w| {
        let [[x0, y0], [x1, y1]] = [w[0], w[1]];
        x0 <= x && x < x1 && y < y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    })
}

/// A cable with too much length for its way hangs in a narrow fold beside its end, through the
/// ground: nearest to its deepest point is the kink of a valley, which no edge's own stretch lies
/// above.
#[test]
fn a_fold_does_not_rest_inside_the_ground_below_a_valley() {
    let heap =
        [[-9.0, 1.4], [-5.715, 0.432], [-5.334, 0.346], [-4.953, 0.411], [-4.572, 0.484], [-4.191, 0.486], [0.0, 0.3]];
    for length in [12.8, 13.2, 13.65, 14.5] {
        let mut s = scene(vec![ground(&heap)], vec![[-6.0, 11.0], [-4.889, 0.874]], (length, 0.7));
        s.cables[0].linear_density_kg_per_m = 1.2;
        let mut m = SpansModel::new(problems(&s).unwrap().remove(0), Settings::default()).unwrap();
        // It may be refused, but no answer is inside.
        if m.settle().is_err() {
            continue;
        }
        for n in m.solution().nodes {
            assert!(!below(&heap, [n.x_m, n.y_m - 0.01 + 1e-6]), "{length}: ({}, {})", n.x_m, n.y_m);
        }
    }
}

/// A stiff cable so taut that its weight turns it by no more than 1e-6 along an edge comes to lie
/// on a beam from its near corner to its far one, in one step and from whichever direction.
#[test]
fn a_taut_stiff_cable_comes_to_lie_on_an_edge_from_corner_to_corner() {
    for friction in [0.0, 0.2] {
        let mut s =
            scene(vec![beam([1.0, 1.4], [0.5, 1.0])], vec![[0.0, 0.0], [1.0, 1.2], [3.0, 1.06]], (3.0, friction));
        s.cables[0].axial_stiffness_n = 1e8;
        let rest = model(&s);
        for k in 1..=60 {
            let mut m = rest.clone();
            m.drag_support(1, Vec2::new(3.0, 1.06 - 0.01 * f64::from(k)));
            m.advance(0.1, Inertia::QuasiStatic).unwrap_or_else(|e| panic!("{friction}, {k}: {e}"));
            let answer = m.solution();
            let [first, last] = [&answer.contacts[0], answer.contacts.last().unwrap()];
            // (level with the edge it sags on to it)
            assert_eq!(last.ends_m - first.begins_m > 0.3, k >= 5, "{friction}, {k}");
        }
    }
}

/// Over the nose of an overhang and back in below it: two corners hold it, a half turn and no more,
/// e^{μθ} from end to end once it has been drawn along.
#[test]
fn a_cable_bends_round_the_nose_of_an_overhang() {
    let friction = 0.15;
    let nose =
        Shape::Polygon { points_m: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [3.0, 2.0], [3.0, 2.4], [0.0, 2.4]] };
    let mut s = scene(vec![nose], vec![[-1.0, 2.8], [3.2, 2.7], [3.2, 1.7], [1.5, 1.2]], (6.1, friction));
    s.cables[0].linear_density_kg_per_m = 1e-6;
    let mut m = model(&s);
    for k in 1..=40 {
        m.drag_support(1, Vec2::new(1.5, 1.2 - 0.01 * f64::from(k)));
        m.advance(0.1, Inertia::QuasiStatic).unwrap();
    }
    let answer = m.solution();
    assert!(!answer.contacts.is_empty());
    let turn: f64 = answer.contacts.iter().map(|c| c.turn_deg.abs().to_radians()).sum();
    let law = (friction * turn).exp();
    let [t, u] = pulls(&answer);
    assert!(turn > 1.5 && turn < 3.2 && (u / t / law - 1.0).abs() <= 1e-6, "{turn}: {t} {u} {law}");
    // In the notch below the nose, and never in it.
    for n in &answer.nodes {
        let [x, y] = [n.x_m, n.y_m];
        assert!(!(x < 3.0 && y > 2.0 && y < 2.4 && x > 0.0), "({x}, {y})");
    }
}

/// Under a keel of three corners: each bends it up, without friction all tensions are one, and the
/// hull pushes it down by what the ends pull it up.
#[test]
fn a_keel_is_held_from_below_by_all_its_corners() {
    let keel = Shape::Polygon { points_m: vec![[2.0, 3.0], [2.0, 2.0], [4.0, 1.4], [6.0, 2.0], [6.0, 3.0]] };
    let mut s = scene(vec![keel], vec![[0.0, 3.0], [1.8, 1.8], [4.0, 1.0], [6.2, 1.8], [8.0, 3.0]], (8.9, 0.0));
    s.cables[0].linear_density_kg_per_m = 1e-6;
    let mut m = model(&s);
    for k in 1..=30 {
        m.drag_support(1, Vec2::new(8.0 + 0.005 * f64::from(k), 3.0 + 0.02 * f64::from(k)));
        m.advance(0.1, Inertia::QuasiStatic).unwrap();
    }
    let answer = m.solution();
    let [t, u] = pulls(&answer);
    assert!((t / u - 1.0).abs() <= 1e-5, "{t} {u}");
    assert!(answer.contacts.len() == 3 && answer.contacts.iter().all(|c| c.normal[1] < 0.0), "{:?}", answer.contacts);
    // T on both sides of a turn δ push with 2T sin δ/2.
    let push = |c: &ContactReport| 2.0 * t * (0.5 * c.turn_deg.abs().to_radians()).sin() * c.normal[1];
    let pushed: f64 = answer.contacts.iter().map(push).sum();
    let held: f64 = answer.supports.iter().map(|s| s.reaction_y_n).sum();
    assert!((pushed - held).abs() <= 1e-4 * held.abs(), "{pushed} {held}");
}

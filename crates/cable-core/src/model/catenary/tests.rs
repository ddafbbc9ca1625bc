//! These tests ask the model `catenary` for scenes with known answers.

use super::*;
use crate::problem::problems;
use crate::scene::{PulleySide, Scene, Support, SupportKind, catalog};

/// A cable of 1 kg/m over 2 mm, EA 1e5 N, with these supports.
fn scene(length_m: f64, supports: Vec<Support>) -> Scene {
    let mut s = catalog::hanging_span();
    let c = &mut s.cables[0];
    c.preset = None;
    c.length_m = length_m;
    c.linear_density_kg_per_m = 1.0;
    c.axial_stiffness_n = 1e5;
    c.diameter_m = 0.002;
    c.bending_stiffness_n_m2 = 0.0;
    (c.service_tension_n, c.breaking_tension_n) = (1e12, 1e12);
    c.supports = supports;
    s
}

fn model(scene: &Scene) -> CatenaryModel {
    let p = problems(scene).expect("a scene").remove(0);
    CatenaryModel::new(p, Settings::default()).expect("a model")
}

fn wheel(at: [f64; 2], radius_m: f64, side: PulleySide, friction: f64) -> Support {
    Support { radius_m: Some(radius_m), side: Some(side), friction: Some(friction), ..Support::pulley("wheel", at) }
}

fn load(force_n: [f64; 2]) -> Support {
    Support { force_n: Some(force_n), ..Support::new("load", SupportKind::Load) }
}

/// Σ reactions = whole load, and the cable stays off the wheel's inside.
fn balance(m: &CatenaryModel) {
    let p = m.problem();
    let sum = m.reactions.iter().fold(Vec2::zeros(), |s, r| s + Vec2::new(r.reaction_x_n, r.reaction_y_n));
    let load = p.body_force(m.time_s) * p.length + p.loads.iter().fold(Vec2::zeros(), |s, l| s + l.force.at(m.time_s));
    // The pull of a dead load is in the sum with its own sign: reaction −P on the load, P on the
    // rest.
    assert!((sum - load).norm() < 1e-8 * (1.0 + load.norm()), "{sum:?} {load:?}");
    for s in p.supports.iter().filter(|s| s.wheel_radius > 0.0) {
        let c = s.at.expect("a centre");
        for n in &m.nodes {
            let d = (Vec2::new(n.x_m, n.y_m) - c).norm() - s.wheel_radius;
            assert!(d > -1e-9, "inside the wheel by {d:e}");
        }
    }
    for w in m.nodes.windows(2) {
        assert!(w[1].arc_length_m >= w[0].arc_length_m);
    }
}

#[test]
fn a_smooth_wheel_conserves_tension_energy_and_height() {
    for (side, y) in [(PulleySide::Over, 3.0), (PulleySide::Under, -3.0)] {
        let supports =
            vec![Support::fixed("a", [0.0, 0.0]), wheel([5.0, y], 0.5, side, 0.0), Support::fixed("b", [11.0, 0.5])];
        let mut m = model(&scene(13.5, supports));
        m.settle().unwrap_or_else(|e| panic!("{e}"));
        balance(&m);
        let r = &m.reactions[1];
        let (tb, ta) = (r.tension_before_n.expect("a pulley"), r.tension_after_n.expect("a pulley"));
        let e = m.balance.as_ref().expect("a balance");
        let (layout, arc) = (SupportLayout::new(m.problem(), &m.dragged, 0.0).expect("a layout"), e.arcs[1]);
        let a = &layout.anchors[1];
        let rise = (a.touch(arc.arrive - a.facing * arc.turn) - a.touch(arc.arrive)).y;
        let psi = |t: f64| t + t * t / 2e5;
        // dψ = w dy along a smooth wheel.
        assert!((psi(ta) - psi(tb) - 9.80665 * rise).abs() < 1e-7 * tb, "{tb} {ta} {rise}");
        // Tangency: the nodes' polyline has no corner sharper than the finest arc step.
        assert!(arc.turn > 0.3);
    }
}

#[test]
fn a_small_wheel_tends_to_a_point() {
    let at = |radius: f64| {
        let supports = vec![
            Support::fixed("a", [0.0, 0.0]),
            wheel([5.0, 3.0], radius, PulleySide::Over, 0.0),
            Support::fixed("b", [11.0, 0.5]),
        ];
        let mut m = model(&scene(13.5, supports));
        m.settle().expect("rest");
        m.nodes[0].tension_n
    };
    // The cable's own radius adds 1 mm to each. First order in R, and the second order is large
    // (−0.65 R + 8.5 R² newtons here).
    let (point, d1, d2) = (at(0.0), at(0.019), at(0.009));
    let ratio = (d1 - point) / (d2 - point);
    assert!((ratio - 2.0).abs() < 0.4, "{point} {d1} {d2} {ratio}");
}

#[test]
fn a_rubbing_wheel_slips_by_the_heavy_capstan() {
    // A dead load lowered over a wheel of 180°, stiff: T = C e^{μφ} + wR[(1−μ²)cos φ + 2μ sin
    // φ]/(1+μ²) where the cable moves with growing φ (from the left horizontal over the top: φ from
    // −90° to 90°).
    let (mu, r) = (0.3, 0.4);
    let mut s = scene(
        8.0,
        vec![Support::fixed("a", [-r - 0.001, -3.0]), wheel([0.0, 0.0], r, PulleySide::Over, mu), load([0.0, -500.0])],
    );
    s.cables[0].axial_stiffness_n = 1e9;
    let mut m = model(&s);
    m.settle().expect("rest");
    balance(&m);
    let e = m.balance.as_ref().expect("a balance");
    let (before, after) =
        (m.reactions[1].tension_before_n.expect("a pulley"), m.reactions[1].tension_after_n.expect("a pulley"));
    let turn = e.arcs[1].turn;
    assert!((turn - std::f64::consts::PI).abs() < 1e-3, "{turn}");
    // Inside or on the cone.
    let (w, rr) = (9.80665, r + 0.001);
    let part = |phi: f64| w * rr * ((1.0 - mu * mu) * phi.cos() + 2.0 * mu * phi.sin()) / (1.0 + mu * mu);
    let half = std::f64::consts::FRAC_PI_2;
    let most = (before - part(-half)) * (mu * turn).exp() + part(half);
    match e.modes[1] {
        PulleyMode::Slip(m) if m > 0.0 => assert!((after - most).abs() < 1e-5 * most, "{after} {most}"),
        _ => assert!(after <= most * (1.0 + 1e-9), "{after} {most}"),
    }
}

#[test]
fn hanging_cables_are_exact() {
    // Free end: elongation wL²/2EA; a load at the end adds PL/EA.
    for (end, p) in [(Support::free("end"), 0.0), (load([0.0, -70.0]), 70.0)] {
        let mut m = model(&scene(10.0, vec![Support::fixed("top", [1.0, 2.0]), end]));
        m.settle().expect("rest");
        balance(&m);
        let last = m.nodes.last().expect("nodes");
        let expected = 2.0 - 10.0 - 9.80665 * 100.0 / 2e5 - p * 10.0 / 1e5;
        assert!((last.y_m - expected).abs() < 1e-11 && (last.x_m - 1.0).abs() < 1e-11, "{} {expected}", last.y_m);
        assert!((m.nodes[0].tension_n - 98.0665 - p).abs() < 1e-10);
    }
}

#[test]
fn what_nothing_holds_has_no_resting_place() {
    let start = |force_n| Support { name: "start".to_owned(), ..load(force_n) };
    let cases = [
        vec![start([-10.0, 0.0]), load([10.0, 0.0])],
        vec![start([0.0, -50.0]), Support::pulley("p", [0.0, 3.0]), load([0.0, -200.0])],
        vec![Support::free("a"), Support::pulley("p", [0.0, 3.0]), load([0.0, -200.0])],
    ];
    for supports in cases {
        let mut m = model(&scene(10.0, supports));
        let e = m.settle().expect_err("nothing holds it");
        assert!(matches!(e, SolveError::NoRestingPlace { .. }), "{e}");
    }
}

#[test]
fn two_pegs_rest_where_the_closed_form_says() {
    // L/2 = a e^{d/a}, the branch with the larger a is stable; tails end on the directrix.
    let (d, length) = (50.0, 300.0);
    let supports =
        vec![Support::free("a"), Support::pulley("p", [-d, 0.0]), Support::pulley("q", [d, 0.0]), Support::free("b")];
    let mut s = scene(length, supports);
    s.cables[0].axial_stiffness_n = 1e9;
    let mut m = model(&s);
    m.settle().expect("rest");
    let a = m.reactions[1].tension_before_n.expect("a pulley") / 9.80665;
    assert!((a - 96.744_601_939_995_68).abs() < 1e-3, "tail {a}");
}

#[test]
fn refusals_name_the_feature() {
    let mut s = scene(12.0, vec![Support::fixed("a", [0.0, 5.0]), Support::fixed("b", [10.0, 5.0])]);
    let mut m = model(&s);
    m.settle().expect("rest");
    assert!(matches!(m.advance(0.1, Inertia::Dynamic), Err(SolveError::Unsupported { .. })));
    assert!(matches!(m.advance(f64::NAN, Inertia::QuasiStatic), Err(SolveError::TimeStep { .. })));
    s.cables[0].bending_stiffness_n_m2 = 1.0;
    let p = problems(&s).expect("a scene").remove(0);
    assert!(matches!(CatenaryModel::new(p, Settings::default()), Err(SolveError::Unsupported { .. })));
}

#[test]
fn nodes_are_close_enough_to_draw_straight_lines_between() {
    let mut m = model(&scene(24.0, vec![Support::fixed("a", [0.0, 5.0]), Support::fixed("b", [10.0, 6.0])]));
    m.settle().expect("rest");
    let layout = SupportLayout::new(m.problem(), &m.dragged, 0.0).expect("a layout");
    let e = m.balance.as_ref().expect("a balance");
    let slide = sliding_problem::SlidingProblem { problem: m.problem(), layout: &layout, arcs: &e.arcs };
    let s = e.stretches.all[1].expect("a stretch");
    let (_, at, c) = slide.chain(s.from, s.to).spans(s.start, layout.anchors[0].at).next().expect("a span");
    for w in m.nodes.windows(2) {
        let mid = 0.5 * (w[0].arc_length_m + w[1].arc_length_m);
        let y = 0.5 * (w[0].y_m + w[1].y_m);
        let t = 0.5 * (w[0].tension_n + w[1].tension_n);
        assert!(((at + c.position_at(mid)).y - y).abs() < 1e-5 * 24.0);
        assert!((c.tension_at(mid) - t).abs() < 1e-4 * (c.tension_at(mid) + 0.02 * c.max_tension()));
    }
    assert!(m.nodes.len() < 2000, "{} nodes", m.nodes.len());
}

#[test]
fn a_cable_laid_over_or_round_an_obstacle_is_refused() {
    for s in [catalog::over_beam(), catalog::round_post(), catalog::slack_to_floor()] {
        let e = model(&s).settle().expect_err("the cable touches");
        assert!(matches!(e, SolveError::Unsupported { .. }), "{}: {e}", s.name);
    }
}

#[test]
fn every_catalogue_scene_is_answered_or_refused() {
    for (id, s) in catalog::all() {
        for p in problems(&s).expect("a scene") {
            match CatenaryModel::new(p, Settings::default()) {
                Ok(mut m) => match m.settle() {
                    Ok(r) => println!("{id}: {} iterations, {} nodes", r.cost.iterations, m.nodes.len()),
                    Err(SolveError::Unsupported { feature, .. }) => println!("{id}: {feature}"),
                    Err(e) => panic!("{id}: {e}"),
                },
                Err(e) => println!("{id}: {e}"),
            }
        }
    }
}

/// A dead load (N) over a wheel of a friction and a radius (m), laid from `a` (m) with a length to
/// spare (m): the tensions obey the heavy capstan, and friction that is called upon in full is
/// called upon against the slip.
fn rests_by_the_heavy_capstan([mu, r, axial_stiffness, pull]: [f64; 4], a: [f64; 2], spare: f64) {
    let length = f64::hypot(a[0], a[1]) + std::f64::consts::PI * r + spare;
    let mut s =
        scene(length, vec![Support::fixed("a", a), wheel([0.0, 0.0], r, PulleySide::Over, mu), load([0.0, -pull])]);
    s.cables[0].axial_stiffness_n = axial_stiffness;
    let mut m = model(&s);
    m.settle().unwrap_or_else(|e| panic!("{e}"));
    balance(&m);
    let r = &m.reactions[1];
    let (tb, ta) = (r.tension_before_n.expect("a pulley"), r.tension_after_n.expect("a pulley"));
    let layout = SupportLayout::new(m.problem(), &m.dragged, 0.0).expect("a layout");
    let e = m.balance.as_ref().expect("a balance");
    let slide = sliding_problem::SlidingProblem { problem: m.problem(), layout: &layout, arcs: &e.arcs };
    let (from, turn) = (e.arcs[1].arrive, e.arcs[1].turn);
    let by = |mu: f64| wheel::traverse_wheel(&slide.chain(0.0, 1.0), &layout.anchors[1], tb, from, turn, mu).tension;
    assert!(ta > by(-mu) * (1.0 - 1e-6) && ta < by(mu) * (1.0 + 1e-6), "{ta} {} {}", by(-mu), by(mu));
    if let PulleyMode::Slip(m) = e.modes[1] {
        assert!((ta - by(m)).abs() < 1e-6 * ta, "{ta} {}", by(m));
    }
}

/// The material on the wheel jumped where it began to slip, and it neither held nor slipped.
#[test]
fn issue_015_a_wheel_that_hardly_holds_rests() {
    rests_by_the_heavy_capstan(
        [0.505, 0.555_007_931_953_447_8, 158_054.0, 431.925],
        [-2.104_046_971_978_777_7, -3.474_609_239_918_190_7],
        7.766,
    );
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig { cases: 400, failure_persistence: None, ..Default::default() })]

    /// A dead load over a rubbing wheel rests at every stiffness.
    #[test]
    fn a_dead_load_over_a_rubbing_wheel_always_rests(
        mu in 0.02..0.8f64,
        r in 0.05..0.6f64,
        log_ea in 4.5..9.0f64,
        pull in 30.0..2000.0f64,
        a in (-4.0..0.5f64, -5.0..-1.0f64),
        spare in 2.0..8.0f64,
    ) {
        rests_by_the_heavy_capstan([mu, r, 10f64.powf(log_ea), pull], [a.0 - r, a.1], spare);
    }
}

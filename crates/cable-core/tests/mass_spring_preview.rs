//! These tests compare previews of stiff cables with closed forms, and ask that nothing is held
//! back in silence.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::model::Stepping;
use cable_core::scene::{Motion, Scene, Support, SupportKind, catalog};
use cable_core::solution::WarningKind;
use cable_core::{Model, Settings, Simulation, Vec2};

const G: f64 = 9.80665;

/// A cable alone: its length (m), density (kg/m) and EA (N).
fn cable([length, density, ea]: [f64; 3], segments: usize, supports: Vec<Support>) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = G;
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (length, density, ea);
    (c.bending_stiffness_n_m2, c.diameter_m, c.damping_ratio) = (0.0, 0.01, 0.02);
    (c.service_tension_n, c.breaking_tension_n) = (1e5, 1e5);
    c.segments = Some(segments);
    c.supports = supports;
    scene
}

fn lump(name: &str, mass_kg: f64) -> Support {
    Support { mass_kg: Some(mass_kg), force_n: Some([0.0, 0.0]), ..Support::new(name, SupportKind::Load) }
}

/// A pulley whose cable runs at `radius` (m).
fn pulley(radius: f64, friction: f64) -> Support {
    let wheel = if radius > 0.0 { radius - 0.005 } else { 0.0 };
    Support { radius_m: Some(wheel), friction: Some(friction), ..Support::pulley("pulley", [0.0, 0.0]) }
}

fn begun(scene: &Scene, stepping: Stepping) -> Simulation {
    let settings = Settings { stepping, ..Settings::default() };
    Simulation::with_settings(scene.clone(), Model::MassSpring, settings).unwrap()
}

fn arc(sim: &Simulation) -> f64 {
    sim.solution().cables[0].supports[1].arc_length_m
}

/// Two weights (kg) at equal height over a pulley, from rest. So stiff that nothing bounces when
/// they are let go.
fn weights([m1, m2]: [f64; 2], density: f64, (radius, friction): (f64, f64), segments: usize) -> Scene {
    let mut scene = cable(
        [10.0, density, 1e10],
        segments,
        vec![lump("lighter", m1), pulley(radius, friction), lump("heavier", m2)],
    );
    let deep = 0.5 * std::f64::consts::PI * radius - 5.0;
    let round = (0..=2000).filter(|_| radius > 0.0).map(|k| f64::from(k) / 2000.0 * std::f64::consts::PI);
    let mut route = vec![[-radius, deep]];
    route.extend(round.map(|a| [-radius * a.cos(), radius * a.sin()]));
    route.extend((radius == 0.0).then_some([0.0, 0.0]));
    route.push([radius, deep]);
    scene.cables[0].route_m = route;
    scene
}

/// Returns how far the cable has run over the pulley after 1 s in steps of `h` (s), m.
fn ran(scene: &Scene, h: f64) -> f64 {
    let mut sim = begun(scene, Stepping::Preview);
    let start = arc(&sim);
    for _ in 0..(1.0 / h).round() as usize {
        sim.step(h).unwrap();
    }
    start - arc(&sim)
}

/// Errors at steps halved: of first order, as implicit Euler's are.
fn first_order(name: &str, errors: &[f64], bound: f64) {
    let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).abs().log2()).collect();
    println!("{name}: {errors:?}, order {orders:.2?}");
    assert!(errors[0].abs() < bound, "{name}: {errors:?}");
    assert!(orders.iter().all(|o| (0.85..1.15).contains(o)), "{name}: order {orders:?}");
}

/// A rope that weighs little, kg/m.
const LIGHT: f64 = 1e-3;

/// ẍ = g (M₂ − q M₁)/(M₂ + q M₁ + ρπR) with M₁ = m₁ + ρ(l − x), M₂ = m₂ + ρ(l + x), l = 5 m − πR/2,
/// from rest for `time` (s), by Runge–Kutta 4; m.
fn slipped([m1, m2]: [f64; 2], radius: f64, q: f64, time: f64) -> f64 {
    let arc = std::f64::consts::PI * radius;
    let pull = |x: f64| {
        let hangs = 5.0 - 0.5 * arc;
        let (a, b) = (q * (m1 + LIGHT * (hangs - x)), m2 + LIGHT * (hangs + x));
        G * (b - a) / (b + a + LIGHT * arc)
    };
    let (h, mut x, mut v) = (time / 1000.0, 0.0, 0.0);
    for _ in 0..1000 {
        let (v1, a1) = (v, pull(x));
        let (v2, a2) = (v + 0.5 * h * a1, pull(x + 0.5 * h * v1));
        let (v3, a3) = (v + 0.5 * h * a2, pull(x + 0.5 * h * v2));
        let (v4, a4) = (v + h * a3, pull(x + h * v3));
        x += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
        v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    x
}

/// G. Atwood's machine with its rope's own weight: x = c (cosh kt − 1), c = (m₂ − m₁ + ρd)/2ρ, k² =
/// 2ρg/M, d the difference of the hanging lengths at the start. With friction T₂ = q T₁, q =
/// e^{μπ}, where the rope comes and goes.
#[test]
fn two_weights_move_as_atwood_says_and_as_friction_lets_them() {
    let [m1, m2] = [5.0, 8.0];
    for radius in [0.0, 0.2] {
        let (density, mass) = (0.4, m1 + m2 + 4.0);
        let c: f64 = (m2 - m1) / (2.0 * density);
        let exact = c * ((2.0 * density * G / mass).sqrt().cosh() - 1.0);
        // Longer ones are shortened: the rope is light for its pull.
        let steps = [2400.0, 4800.0, 9600.0].map(|n| 1.0 / n);
        let smooth = steps.map(|h| ran(&weights([m1, m2], density, (radius, 0.0), 20), h) / exact - 1.0);
        first_order(&format!("Atwood, R {radius}"), &smooth, 4e-3);
        for friction in [0.05, 0.1] {
            let q = (friction * std::f64::consts::PI).exp();
            let exact = slipped([m1, m2], radius, q, 1.0);
            let rough = steps.map(|h| ran(&weights([m1, m2], LIGHT, (radius, friction), 20), h) / exact - 1.0);
            first_order(&format!("Atwood, R {radius}, friction {friction}"), &rough, 1e-2);
        }
    }
}

/// L. Euler and J. A. Eytelwein: held up to e^{μπ} for a minute, not beyond.
#[test]
fn a_rubbing_pulley_holds_up_to_eulers_ratio() {
    for radius in [0.0, 0.2] {
        for (part, holds) in [(0.98, true), (1.02, false)] {
            let q = (0.3 * std::f64::consts::PI).exp() * part;
            let mut sim = begun(&weights([5.0, 5.0 * q], LIGHT, (radius, 0.3), 20), Stepping::Preview);
            sim.settle().unwrap_or_else(|_| sim.solution());
            let start = arc(&sim);
            for _ in 0..if holds { 3600 } else { 120 } {
                sim.step(1.0 / 60.0).unwrap();
            }
            let slid = start - arc(&sim);
            println!("R {radius}, {part} of Euler's ratio: slid {slid:.2e} m");
            if holds {
                assert!(slid.abs() < 1e-6, "slid {slid} m below the ratio");
            } else {
                let exact = slipped([5.0, 5.0 * q], radius, q / part, 2.0);
                assert!((slid / exact - 1.0).abs() < 0.02, "{slid} m instead of {exact}");
            }
        }
    }
}

/// Drawn over a pulley by hand against a weight, slowly and fast, either way: e^{μφ} in every frame
/// while it slides.
#[test]
fn sliding_keeps_the_capstans_ratio_in_every_frame() {
    for (radius, friction) in [(0.0, 0.1), (0.0, 0.5), (0.2, 0.3)] {
        let hand = Support {
            motion: Some(Motion {
                times_s: vec![0.0, 1.0, 2.0],
                points_m: vec![[2.0, -4.0], [2.0, -4.8], [2.0, -4.0]],
            }),
            ..Support::fixed("hand", [2.0, -4.0])
        };
        let scene = cable([8.0, 0.005, 1e7], 40, vec![lump("weight", 10.0), pulley(radius, friction), hand]);
        let mut sim = begun(&scene, Stepping::Preview);
        sim.settle().unwrap();
        let mut worst = 0.0f64;
        for k in 0..120 {
            sim.step(1.0 / 60.0).unwrap();
            // Near the ends of a stroke it turns round.
            if (12..48).contains(&(k % 60)) {
                let s = sim.solution();
                let (wheel, hand) = (&s.cables[0].supports[1], &s.cables[0].supports[2]);
                let way = 2.0f64.hypot(hand.y_m);
                let turn = std::f64::consts::FRAC_PI_2 + (-hand.y_m).atan2(2.0) + (radius / way).asin();
                let sense = if k < 60 { 1.0 } else { -1.0 };
                let ratio = wheel.tension_after_n.unwrap() / wheel.tension_before_n.unwrap();
                let off = ratio / (sense * friction * turn).exp() - 1.0;
                worst = if off.abs() > worst { off.abs() } else { worst };
            }
        }
        println!("R {radius}, friction {friction}: ratio off by {worst:.1e}");
        assert!(worst < 5e-3, "R {radius}, friction {friction}: {worst}");
    }
}

/// Frames of 0.01 and 0.5 s in turn end where fixed ones do, explicit or previewed (an end swung to
/// and fro).
#[test]
fn uneven_frames_end_where_even_ones_do() {
    for (ea, stepping) in [(2e4, Stepping::Explicit), (1e9, Stepping::Preview)] {
        let hand = Support {
            motion: Some(Motion {
                times_s: vec![0.0, 0.7, 1.4, 2.1],
                points_m: vec![[9.0, 4.0], [9.5, 4.5], [8.5, 4.0], [9.0, 4.2]],
            }),
            ..Support::fixed("hand", [9.0, 4.0])
        };
        let scene = cable([10.5, 1.246, ea], 40, vec![Support::fixed("left", [0.0, 5.0]), hand]);
        let run = |frames: &[f64]| {
            let mut sim = begun(&scene, stepping);
            sim.settle().unwrap();
            for dt in frames.iter().cycle() {
                sim.step(*dt).unwrap();
                if sim.time_s() > 2.04 - 1e-9 {
                    return sim.solution();
                }
            }
            unreachable!()
        };
        let (even, uneven) = (run(&[0.01]), run(&[0.01, 0.5]));
        assert!((even.time_s - uneven.time_s).abs() < 1e-9);
        let mut worst = 0.0f64;
        for (a, b) in even.cables[0].nodes.iter().zip(&uneven.cables[0].nodes) {
            worst = worst.max((a.x_m - b.x_m).hypot(a.y_m - b.y_m));
        }
        let pull = |s: &cable_core::Solution| s.cables[0].supports[1].reaction_x_n;
        let off = pull(&even) / pull(&uneven) - 1.0;
        println!("{stepping:?}: {worst:.1e} m of 10.5 m, pull {off:.1e}");
        assert!(worst < 0.01 * 10.5 && off.abs() < 0.01, "{stepping:?}: {worst} m, {off}");
    }
}

/// A motion that no step can follow is cut and braked, and reported with place and time, by either
/// way of stepping.
#[test]
fn what_runs_away_is_held_back_and_said_with_place_and_time() {
    for stepping in [Stepping::Explicit, Stepping::Preview] {
        let ends = vec![Support::fixed("left", [0.0, 5.0]), Support::fixed("right", [9.0, 4.0])];
        let mut sim = begun(&cable([10.5, 1.246, 1e6], 40, ends), stepping);
        sim.settle().unwrap();
        let mut states = sim.states();
        states[0].velocity_m_per_s[17] = Vec2::new(0.0, 1e4);
        sim.set_states(&states).unwrap();
        sim.step(0.02).unwrap();
        let s = sim.solution();
        let said: Vec<_> = s.warnings.iter().filter(|w| w.kind == WarningKind::Stabilised).collect();
        for what in ["speed was limited", "kinetic energy"] {
            let w = said.iter().find(|w| w.to_string().contains(what)).unwrap_or_else(|| panic!("{what}: {said:?}"));
            assert!(w.value > w.limit && w.since_s.is_some_and(|t| t <= 0.02), "{w:?}");
            let place = sim.states()[0].arc_length_m[17];
            assert!((w.arc_length_m - place).abs() < 1.0 && w.at_m.is_some(), "{w:?}");
        }
        assert!(s.cables[0].nodes.iter().all(|n| n.vx_m_per_s.hypot(n.vy_m_per_s) <= 300.0 + 1e-9));
        // A sound motion is left alone: the same cable let go at one end, and swung.
        let mut ends = vec![Support::fixed("left", [0.0, 5.0]), Support::fixed("right", [9.0, 4.0])];
        ends[1].release_s = Some(0.05);
        let mut sim = begun(&cable([10.5, 1.246, 1e6], 40, ends), stepping);
        sim.settle().unwrap();
        for _ in 0..120 {
            sim.step(1.0 / 60.0).unwrap();
            let s = sim.solution();
            assert!(s.warnings.iter().all(|w| w.kind != WarningKind::Stabilised), "{:?}", s.warnings);
        }
    }
}

/// Falling freely, however fast, is no runaway.
#[test]
fn a_free_fall_is_not_braked() {
    let mut ends = vec![Support::fixed("left", [0.0, 0.0]), Support::fixed("right", [9.0, 0.0])];
    for e in &mut ends {
        e.release_s = Some(0.0);
    }
    let mut sim = begun(&cable([10.5, 1.246, 1e6], 20, ends), Stepping::Preview);
    for _ in 0..600 {
        sim.step(1.0 / 60.0).unwrap();
        let s = sim.solution();
        assert!(s.warnings.iter().all(|w| w.kind != WarningKind::Stabilised), "{:?}", s.warnings);
    }
    let lowest = sim.states()[0].velocity_m_per_s.iter().map(|v| v.y).fold(0.0, f64::min);
    assert!((lowest / (-10.0 * G) - 1.0).abs() < 0.02, "{lowest} m/s after 10 s");
}

/// A cable at rest over a beam in 1000 elements is played as a preview, and stays what it is.
#[test]
fn a_preview_does_not_break_a_cable_at_rest() {
    let mut scene = catalog::over_beam();
    scene.cables[0].segments = Some(1000);
    let mut sim = begun(&scene, Stepping::Auto);
    let rest = sim.settle().unwrap();
    let at_rest = sim.max_tension().tension_n;
    let [mut most, mut last] = [0.0_f64; 2];
    for _ in 0..60 {
        sim.step(1.0 / 60.0).unwrap();
        let now = sim.answers()[0].peaks_at(sim.time_s()).greatest.tension_n;
        (most, last) = (most.max(now), now);
    }
    let previewed = sim.warnings().any(|w| w.to_string().contains("preview"));
    println!("{at_rest:.2} N at rest, at most {most:.2} N played, {last:.2} N after a second, preview {previewed}");
    assert!(previewed && rest.cables[0].breaks.is_empty() && sim.answers()[0].breaks.is_empty());
    // It was 240 kN. What is left are nodes that pass the corner, which makes tension jump.
    let breaking = scene.cables[0].breaking_tension_n;
    assert!(most < 0.1 * breaking, "{most} N of {breaking} N");
    assert!((last / at_rest - 1.0).abs() < 0.1, "{last} N after a second, {at_rest} N at rest");
}

/// The tension of a cable drawn over a sharp corner is uncertain in every frame, and each says so.
#[test]
fn corners_are_said_in_every_frame() {
    let mut sim = begun(&catalog::draped_slipping(), Stepping::Auto);
    sim.settle().unwrap();
    for frame in 0..90 {
        sim.step(1.0 / 60.0).unwrap();
        let said = sim.warnings().any(|w| w.kind == WarningKind::Accuracy);
        let pressed = sim.answers()[0].contacts.iter().any(|c| c.turn_deg.abs() > 5.0);
        assert!(said || !pressed, "frame {frame}: nothing is said of the corner");
    }
}

//! After the supports let go, the middle of mass falls by ½g t², whatever the cable does; the end
//! of a soft hanging cable stays where it is for L/c.

use cable_core::scene::{Support, SupportKind};
use cable_core::state::State;
use cable_core::{Model, Simulation, Vec2};

use super::measure::{G, Mass, cable, ladder, masses, settled};

const RELEASE: f64 = 0.1;

/// Middle of mass, m, and angular momentum about it, kg m²/s.
fn middle(sim: &Simulation) -> (Vec2, f64) {
    let state: State = sim.states().remove(0);
    let lumped = Mass { node: masses(sim.scene(), &state), coupling: Vec::new() };
    let mass = if sim.solution().model == Model::Fem { Mass::of(sim.scene(), &state) } else { lumped };
    let whole: f64 = mass.node.iter().sum();
    let sum = |v: &[Vec2]| mass.times(v).into_iter().sum::<Vec2>() / whole;
    let (x, v) = (sum(&state.position_m), sum(&state.velocity_m_per_s));
    let momentum = mass.times(&state.velocity_m_per_s.iter().map(|u| u - v).collect::<Vec<_>>());
    let turn = |(r, p): (&Vec2, Vec2)| (r.x - x.x) * p.y - (r.y - x.y) * p.x;
    let spin = state.position_m.iter().zip(momentum).map(turn).sum();
    (x, spin)
}

#[test]
fn a_span_let_go_at_both_ends_falls_as_a_stone() {
    let free = |name: &str, at| Support { release_s: Some(RELEASE), ..Support::fixed(name, at) };
    let scene = cable([10.5, 1.0, 1e6], 20, vec![free("A", [0.0, 0.0]), free("B", [10.0, 1.0])]);
    // The middle one does not divide the time of release: a step ends there all the same.
    let errors = [1.0 / 240.0, 1.0 / 470.0, 1.0 / 960.0].map(|h| {
        let mut sim = settled(&scene, Model::Fem);
        sim.step(h).unwrap();
        let (start, mut t) = (middle(&sim).0, h);
        while t + h < RELEASE {
            sim.step(h).unwrap();
            t += h;
        }
        let moved = (middle(&sim).0 - start).norm();
        assert!(moved < 1e-8, "it moved by {moved} m while it was held");
        while t < 5.0 * RELEASE {
            sim.step(h).unwrap();
            t += h;
        }
        let (at, spin) = middle(&sim);
        println!("h {h:.5}: held to {moved:.1e} m, then spin {spin:.1e} kg m²/s, sideways {:.1e} m", at.x - start.x);
        assert!(spin.abs() < 1e-6 && (at.x - start.x).abs() < 1e-7, "{spin} {}", at.x - start.x);
        (at - start).y + 0.5 * G * (t - RELEASE).powi(2)
    });
    // ¾ g h² of a first step of h by implicit Euler would be 1.3e-4 m; it is an eighth as long.
    ladder("span let go, fall in m", &errors, 2.0, 2.5e-6);
}

#[test]
fn masses_and_springs_fall_as_a_stone_too() {
    let free = |name: &str, at| Support { release_s: Some(RELEASE), ..Support::fixed(name, at) };
    let scene = cable([10.5, 1.0, 1e5], 20, vec![free("A", [0.0, 0.0]), free("B", [10.0, 1.0])]);
    // The second one does not divide the time of release.
    for h in [1.0 / 60.0, 1.0 / 470.0] {
        let mut sim = settled(&scene, Model::MassSpring);
        let (start, mut t) = (middle(&sim).0, 0.0);
        while t < 5.0 * RELEASE {
            sim.step(h).unwrap();
            t += h;
        }
        let (at, spin) = middle(&sim);
        let fall = (at - start).y + 0.5 * G * (t - RELEASE).powi(2);
        // The leapfrog's parabola is the true one, begun with half a kick at the very instant of
        // the release: with a whole one, or a sub-step k early, it would fall by g k t/2 too far,
        // 2e-3 m.
        println!("steps of {h:.1e} s: off by {fall:.2e} m, spin {spin:.1e}");
        assert!(fall.abs() < 1e-12, "{fall} m off");
        assert!(spin.abs() < 1e-9 && (at.x - start.x).abs() < 1e-9, "{spin} {}", at.x - start.x);
    }
}

#[test]
fn the_end_of_a_soft_cable_learns_of_it_late() {
    let (length, ea) = (10.0, 1e3f64);
    let top = Support { release_s: Some(RELEASE), ..Support::fixed("top", [0.0, 0.0]) };
    let scene = cable([length, 1.0, ea], 100, vec![top, Support::new("end", SupportKind::Free)]);
    let mut sim = settled(&scene, Model::Fem);
    let h = 1.0 / 960.0;
    sim.step(h).unwrap();
    let (rest, start, arrival) = (sim.states()[0].position_m[100].y, middle(&sim).0.y, length / ea.sqrt());
    let mut t = h;
    while t - RELEASE < 0.85 * arrival {
        sim.step(h).unwrap();
        t += h;
    }
    let moved = sim.states()[0].position_m[100].y - rest;
    let fallen = middle(&sim).0.y - start + 0.5 * G * (t - RELEASE).powi(2);
    println!("after 0.85 L/c the end has moved by {moved:.1e} m; the middle of mass is {fallen:.1e} m from a stone");
    // The model's least damping (τ = 1 ms) blurs the front to √(τt) = 0.017 s; 2.7 of these ahead
    // of it, where the end jumps to 2gL/c, it is due to have moved by 1.3e-4 m.
    assert!(moved.abs() < 3e-4, "the end moved by {moved} m");
    assert!(fallen.abs() < 1e-4, "the middle is off by {fallen} m");
}

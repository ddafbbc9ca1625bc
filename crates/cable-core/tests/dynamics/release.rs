//! Supports that let go: the middle of mass then falls by ½g t², whatever the cable does; the end of a soft hanging cable
//! does not know of it for L/c.

use cable_core::scene::{Support, SupportKind};
use cable_core::state::State;
use cable_core::{Model, Simulation, Vec2};

use super::measure::{G, cable, ladder, masses, settled};

const RELEASE: f64 = 0.1;

/// Middle of mass, m, and angular momentum about it, kg m²/s.
fn middle(sim: &Simulation) -> (Vec2, f64) {
    let state: State = sim.states().remove(0);
    let mass = masses(sim.scene(), &state);
    let whole: f64 = mass.iter().sum();
    let sum = |v: &[Vec2]| v.iter().zip(&mass).map(|(v, m)| v * *m).sum::<Vec2>() / whole;
    let (x, v) = (sum(&state.position_m), sum(&state.velocity_m_per_s));
    let spin = (0..mass.len())
        .map(|k| {
            let (r, u) = (state.position_m[k] - x, state.velocity_m_per_s[k] - v);
            mass[k] * (r.x * u.y - r.y * u.x)
        })
        .sum();
    (x, spin)
}

#[test]
fn a_span_let_go_at_both_ends_falls_as_a_stone() {
    let free = |name: &str, at| Support { release_s: Some(RELEASE), ..Support::fixed(name, at) };
    let scene = cable([10.5, 1.0, 1e6], 20, vec![free("A", [0.0, 0.0]), free("B", [10.0, 1.0])]);
    let errors = [24, 48, 96].map(|steps| {
        let mut sim = settled(&scene, Model::Fem);
        let h = RELEASE / f64::from(steps);
        let start = middle(&sim).0;
        for _ in 0..steps {
            sim.step(h).unwrap();
        }
        println!("moved while held {:?}", middle(&sim).0 - start);
        for _ in 0..5 * steps {
            sim.step(h).unwrap();
        }
        let (at, spin) = middle(&sim);
        let t = 5.0 * RELEASE;
        println!("h {h:.5}: spin {spin:.1e} kg m²/s, sideways {:.1e} m", at.x - start.x);
        (at - start).y + 0.5 * G * t * t
    });
    println!("{errors:?}");
    let _ = ladder;
}

#[test]
fn the_end_of_a_soft_cable_learns_of_it_late() {
    let (length, ea) = (10.0, 1e3f64);
    let top = Support { release_s: Some(RELEASE), ..Support::fixed("top", [0.0, 0.0]) };
    let scene = cable([length, 1.0, ea], 100, vec![top, Support::new("end", SupportKind::Free)]);
    let mut sim = settled(&scene, Model::Fem);
    let arrival = length / ea.sqrt();
    let h = 1.0 / 960.0;
    let (rest, mut t, mut heard) = (sim.states()[0].position_m[100].y, 0.0, 0.0);
    while heard == 0.0 {
        sim.step(h).unwrap();
        t += h;
        // The wave front brings the end to the speed g·2L/c at once.
        let v = sim.states()[0].velocity_m_per_s[100].y;
        if v < -0.5 * G * 2.0 * length / ea.sqrt() {
            heard = t - RELEASE;
        }
        let moved = sim.states()[0].position_m[100].y - rest;
        if t - RELEASE < 0.8 * arrival {
            assert!(moved.abs() < 1e-3, "moved by {moved} m after {}", t - RELEASE);
        }
        assert!(t < 1.0, "it never hears of it");
    }
    println!("heard after {heard:.4} s of {arrival:.4}");
}

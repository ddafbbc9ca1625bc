//! A hanging chain swings at ω_k = (j₀ₖ/2) √(g/L) in the shape J₀(j₀ₖ √(s/L)), s from the free end
//! (D. Bernoulli 1738; H. Lamb, "Hydrodynamics", 1895).

use cable_core::scene::{Support, SupportKind};

use super::measure::{G, behind, cable, climbs, masses, ring, sampled, started};

/// Swing of each mode in lengths of the chain. Larger: a pendulum of 1e-2 is slower by 4e-6, and
/// the lowest bars, which only pull, go slack in the third mode; smaller: what a step leaves
/// unbalanced shows in the first.
const SWING: [f64; 3] = [2e-3, 5e-4, 3e-4];

/// Zeros of J₀ (M. Abramowitz, I. Stegun, "Handbook of mathematical functions", 1964, table 9.5).
pub const ZEROS: [f64; 3] = [2.404825557695773, 5.520078110286311, 8.653727912911013];

/// J₀ by its power series: to 1e-13 up to 9.
pub fn j0(x: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..60 {
        term *= -0.25 * x * x / f64::from(k * k);
        sum += term;
    }
    sum
}

/// Frequency of mode `k` with `segments` bars, over the closed form; the slowness of the steps
/// taken out.
fn frequency(k: usize, segments: usize) -> f64 {
    let length = 10.0;
    let supports = vec![Support::fixed("top", [0.0, 0.0]), Support::new("end", SupportKind::Free)];
    // It stretches by a part of 1e-6.
    let scene = cable([length, 1.0, 1e8], segments, supports);
    let exact = 0.5 * ZEROS[k] * (G / length).sqrt();
    let shape = |s: f64| j0(ZEROS[k] * (1.0 - s / length).max(0.0).sqrt());
    let mut sim = started(&scene, |state| {
        for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            p.x = SWING[k] * length * shape(*s);
        }
    });
    let mass = masses(&scene, &sim.states()[0]);
    let h = 1.0 / 240.0;
    let every = (std::f64::consts::TAU / exact / h / 5.0).round() as usize;
    let found = ring(
        &sampled(&mut sim, (h, every), 40, |state| {
            (0..mass.len()).map(|i| mass[i] * shape(state.arc_length_m[i]) * state.position_m[i].x).sum()
        }),
        h * every as f64,
    );
    behind(found, h).omega / exact - 1.0
}

#[test]
fn swings_at_the_zeros_of_bessels_function() {
    // The third mode of 10 bars has three to a half wave.
    for (k, bars, bound) in [(1, [10, 20, 40], 4e-3), (2, [20, 40, 80], 5e-3)] {
        let errors = bars.map(|n| frequency(k, n));
        climbs(&format!("hanging chain, mode {}", k + 1), &errors, 3.5, bound);
    }
    let first = [20, 40].map(|n| frequency(0, n));
    println!("hanging chain, mode 1: {first:?}");
    assert!(first.iter().all(|off| off.abs() < 2e-6), "{first:?}");
}

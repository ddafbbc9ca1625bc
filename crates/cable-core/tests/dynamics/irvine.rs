//! The in-plane modes of a shallow suspended cable follow from closed forms (H. M. Irvine and T. K.
//! Caughey, "The linear theory of free vibrations of a suspended cable", Proc. R. Soc. A 341,
//! 1974). Span l, ω̄ = ωl √(m/H):
//! ```text
//! antisymmetric   ω̄ = 2nπ                                     symmetric   tan(ω̄/2) = ω̄/2 − (4/λ²)(ω̄/2)³
//! λ² = (ml/H · g)² · EA l/(H Lₑ),   Lₑ ≈ l(1 + 8(d/l)²)
//! ```
//! At λ² = 4π² the first symmetric mode crosses the first antisymmetric one. The theory is that of
//! a parabola: its own error is of the order (d/l)².

use cable_core::scene::{Scene, Support};
use cable_core::{Load, Model};

use super::measure::{G, Ring, behind, cable, climbs, ring, sampled, settled};

const SPAN: f64 = 50.0;
/// Sag over span.
const SAG: f64 = 1.0 / 300.0;
const DENSITY: f64 = 1.0;

/// Parts of the cable with a load between any two. More: what lies between them has too few bars to
/// tell how they bend.
const LOADS: usize = 5;

/// H of the parabola, N.
fn pull() -> f64 {
    DENSITY * G * SPAN / (8.0 * SAG)
}

/// The cable whose λ² is given.
fn suspended(lambda2: f64, segments: usize) -> Scene {
    let h = pull();
    let longer = 1.0 + 8.0 * SAG * SAG;
    let ea = lambda2 * h * longer / (DENSITY * G * SPAN / h).powi(2);
    // Arc length of the parabola, less its stretch: ∫T ds/EA = H·Lₑ'/EA with Lₑ' ≈ l(1 + 16/3
    // (d/l)²).
    let arc = SPAN * (1.0 + 8.0 / 3.0 * SAG * SAG);
    let stretch = h / ea * (1.0 + 8.0 / 3.0 * SAG * SAG);
    let supports = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [SPAN, 0.0])];
    // m is per metre of the stretched cable in the theory.
    cable([arc / (1.0 + stretch), DENSITY * (1.0 + stretch), ea], segments, supports)
}

/// ω̄ of the first symmetric mode, by halving in (π, 3π) where the equation changes sign without a
/// pole.
fn symmetric(lambda2: f64) -> f64 {
    // sin(z) − (z − 4z³/λ²) cos(z) with z = ω̄/2 has no poles.
    let f = |z: f64| z.sin() - (z - 4.0 * z.powi(3) / lambda2) * z.cos();
    let (mut a, mut b) = (0.5 * std::f64::consts::PI, 1.5 * std::f64::consts::PI);
    assert!(f(a) * f(b) < 0.0);
    for _ in 0..80 {
        let c = 0.5 * (a + b);
        if f(a) * f(c) <= 0.0 {
            b = c;
        } else {
            a = c;
        }
    }
    a + b
}

/// Pulls the cable into `shape` by some small loads, lets go in the first step and fits the swing
/// of that shape.
fn frequency(model: Model, lambda2: f64, segments: usize, (bar, shape): (f64, &dyn Fn(f64) -> f64)) -> f64 {
    let mut scene = suspended(lambda2, segments);
    let exact = bar / SPAN * (pull() / DENSITY).sqrt();
    let steps = 180;
    let h = std::f64::consts::TAU / exact / f64::from(steps);
    let length = scene.cables[0].length_m;
    let node = length / LOADS as f64;
    scene.loads = (1..LOADS)
        .map(|k| {
            let at = k as f64 * node;
            let force = 1e-3 * DENSITY * node * exact * exact * shape(at / length);
            Load {
                cable: scene.cables[0].name.clone(),
                arc_length_m: at,
                force_n: None,
                times_s: vec![0.0, h],
                forces_n: vec![[0.0, force], [0.0, 0.0]],
            }
        })
        .collect();
    let mut sim = settled(&scene, model);
    let samples = sampled(&mut sim, (h, 36), 40, |state| {
        state.position_m.iter().zip(&state.arc_length_m).map(|(p, s)| p.y * shape(s / length)).sum()
    });
    let found = ring(&samples, 36.0 * h);
    // Explicit steps of at most 1.2e-4 s add less than 1e-6.
    let Ring { omega, .. } = if model == Model::Fem { behind(found, h) } else { found };
    omega / exact - 1.0
}

/// Frequencies at ever more bars against Irvine's: of the order of the model, and in the limit off
/// by the theory's own (d/l)².
fn check(model: Model, name: &str, lambda2: f64, mode: (f64, &dyn Fn(f64) -> f64)) {
    // The error left at 40 bars is as small as a sixth of the terms that the theory leaves out.
    let (order, least, bound) = if model == Model::Fem { (4.0, 1.5, 2e-4) } else { (2.0, 1.75, 2e-2) };
    let bars = if model == Model::Fem { [20, 40, 80] } else { [10, 20, 40] };
    let e = bars.map(|n| frequency(model, lambda2, n, mode));
    let limit = e[2] + (e[2] - e[1]) / (2f64.powf(order) - 1.0);
    println!("{model}, λ² {lambda2:.1}, {name}: limit off by {limit:.1e}");
    assert!(limit.abs() < 16.0 * SAG * SAG, "λ² {lambda2}, {name}: {limit:.2e}");
    climbs(&format!("{model}, Irvine {lambda2:.1}, {name}"), &[e[0] - limit, e[1] - limit], least, bound);
}

fn modes_of(model: Model, lambda2: f64) {
    let anti = 2.0 * std::f64::consts::PI;
    let bar = symmetric(lambda2);
    let shape = |u: f64| 1.0 - (0.5 * bar).tan() * (bar * u).sin() - (bar * u).cos();
    let largest = shape(0.5).abs();
    check(model, "symmetric", lambda2, (bar, &|u| shape(u) / largest));
    check(model, "antisymmetric", lambda2, (anti, &|u| (anti * u).sin()));
}

/// λ² at which the first symmetric mode crosses the first antisymmetric one.
const CROSSING: f64 = 4.0 * std::f64::consts::PI * std::f64::consts::PI;

#[test]
fn modes_cross_where_irvine_says() {
    assert!((symmetric(CROSSING) / (2.0 * std::f64::consts::PI) - 1.0).abs() < 1e-9);
    for lambda2 in [4.0, 20.0, CROSSING, 80.0] {
        modes_of(Model::Fem, lambda2);
    }
}

#[test]
fn masses_and_springs_have_irvines_modes_too() {
    for lambda2 in [4.0, CROSSING, 80.0] {
        modes_of(Model::MassSpring, lambda2);
    }
}

//! A weightless taut string swings at kπ/L √(T/(λρ)), λ its stretch: L, ρ unstretched. N bars come
//! to that as 1/N⁴; with their mass in their nodes (J. L. Lagrange's loaded string) they swing at
//! (2N/L) √(T/(λρ)) sin(kπ/2N), which comes to it as 1/N².

use cable_core::scene::{Scene, Support};
use cable_core::state::State;
use cable_core::{Settings, Simulation};

use super::measure::{
    Ring, behind, cable, climbs, damps, ladder, masses, ring, sampled, slows, started, started_within,
};

/// m.
pub const LENGTH: f64 = 10.0;
const STRETCH: f64 = 1.05;
const EA: f64 = 1e5;
const DENSITY: f64 = 10.0;

/// Frequency and decay of mode `k` at step `h` (s).
fn swing(k: usize, segments: usize, h: f64) -> Ring {
    heated_swing(0.0, k, segments, h)
}

/// The string, heated so that it is longer by `growth` at rest.
pub fn scene(growth: f64, segments: usize) -> Scene {
    let supports = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [STRETCH * LENGTH, 0.0])];
    let mut scene = cable([LENGTH, DENSITY, EA], segments, supports);
    scene.environment.gravity_m_per_s2 = 0.0;
    scene.environment.temperature_change_k = 100.0;
    scene.cables[0].thermal_expansion_per_k = growth / 100.0;
    scene
}

/// The same of a string heated so that it is longer by `growth` at rest.
fn heated_swing(growth: f64, k: usize, segments: usize, h: f64) -> Ring {
    let scene = scene(growth, segments);
    let every = (std::f64::consts::TAU / continuous(k) / h / 5.0).round() as usize;
    let samples = swung(started(&scene, |state| bow(state, k)), (&scene, k), (h, every), 60);
    ring(&samples, h * every as f64)
}

/// The shape of mode `k`.
fn shape(k: usize, s: f64) -> f64 {
    (k as f64 * std::f64::consts::PI * s / LENGTH).sin()
}

/// Drawn aside by 1 mm in mode `k`.
fn bow(state: &mut State, k: usize) {
    for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
        p.y = 1e-3 * shape(k, *s);
    }
}

/// The part of mode `k` in the motion, `count` + 1 times.
fn swung(mut sim: Simulation, (scene, k): (&Scene, usize), step: (f64, usize), count: usize) -> Vec<f64> {
    let mass = masses(scene, &sim.states()[0]);
    sampled(&mut sim, step, count, |state| {
        (0..mass.len()).map(|i| mass[i] * shape(k, state.arc_length_m[i]) * state.position_m[i].y).sum()
    })
}

/// Of a continuous string, 1/s.
pub fn continuous(k: usize) -> f64 {
    k as f64 * std::f64::consts::PI / LENGTH * (EA * (STRETCH - 1.0) / (STRETCH * DENSITY)).sqrt()
}

/// Of as many bars, 1/s.
pub fn discrete(k: usize, segments: usize) -> f64 {
    let part = k as f64 * std::f64::consts::PI / (2.0 * segments as f64);
    continuous(k) * part.sin() / part
}

#[test]
fn bars_swing_at_the_strings_frequencies() {
    for (k, bound) in [(1, 5e-4), (2, 6e-3), (3, 2.5e-2)] {
        let h = 1.0 / 960.0;
        let errors = [8, 16, 32].map(|n| behind(swing(k, n, h), h).omega / continuous(k) - 1.0);
        climbs(&format!("taut string, mode {k}"), &errors, 3.5, bound);
        assert!(errors[2].abs() < 0.03 * (discrete(k, 32) / continuous(k) - 1.0).abs(), "mode {k}: {}", errors[2]);
    }
}

#[test]
fn the_error_in_time_is_that_of_the_steps() {
    let steps = [1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0];
    let found = steps.map(|h| swing(2, 16, h));
    let exact = [0, 1, 2].map(|k| behind(found[k], steps[k]));
    let omega = exact[2].omega;
    for (ring, h) in exact.iter().zip(steps) {
        let off = ring.omega / omega - 1.0;
        println!("h {h:.5}: {off:.1e} from the finest, decay {:.1e} beside that of the steps", ring.decay);
        assert!(off.abs() < 1e-6 && ring.decay.abs() < 3e-6, "h {h}: {off} {}", ring.decay);
    }
    ladder("taut string in time", &found.map(|f| 1.0 - f.omega / omega), 2.0, slows(omega, steps[0]));
    // The order h⁵, 1/9 ω⁶h⁵ at β = ½, is as much again at the longest of the steps.
    let damped = found.map(|f| f.decay);
    println!("decay by the steps {damped:?}, {:.1e} of it of the order h³", damps(omega, steps[0]));
    assert!(damped[0] < 2.0 * damps(omega, steps[0]) && damped[0] > 6.0 * damped[1], "{damped:?}");
}

/// Heat takes tension: T = EA (λ/(1 + αΔT) − 1), with λ and ρ still per metre of the cold cable.
#[test]
fn a_heated_string_swings_more_slowly() {
    let (h, n) = (1.0 / 960.0, 16);
    for growth in [-0.005, 0.01, 0.03] {
        let slower = ((STRETCH / (1.0 + growth) - 1.0) / (STRETCH - 1.0)).sqrt();
        let exact = continuous(1) * slower;
        let off = behind(heated_swing(growth, 1, n, h), h).omega / exact - 1.0;
        println!("longer by {growth} in the heat: frequency off by {off:.1e}");
        assert!(off.abs() < 2e-5, "{growth}: {off}");
    }
}

/// In frames of 1/60 s fast strings get the steps that their tone needs: at 1/240 s they are flat
/// by (1 − β)(ωh)²/3.
#[test]
fn fast_strings_are_in_tune_in_frames() {
    const FRAME: f64 = 1.0 / 60.0;
    for (k, n) in [(1, 16), (4, 32), (8, 64), (12, 96)] {
        let scene = scene(0.0, n);
        let omega = continuous(k);
        let asked = Settings::default().tolerance;
        let tone = |tolerance: f64| {
            // Slow ones are sampled more widely, for the fit; and it takes some frames to notice.
            let stride = (std::f64::consts::TAU / omega / FRAME / 5.0).max(1.0) as usize;
            let sim = started_within(tolerance, &scene, |state| bow(state, k));
            let samples = swung(sim, (&scene, k), (FRAME, 1), 8 + 60 * stride);
            let samples: Vec<f64> = samples[8..].iter().step_by(stride).copied().collect();
            ring(&samples, FRAME * stride as f64).omega / omega - 1.0
        };
        let (off, flat) = (tone(asked), tone(1e9));
        println!(
            "mode {k}: {:.1} Hz off by {off:.1e}, with steps of 1/240 s by {flat:.1e}",
            omega / std::f64::consts::TAU
        );
        assert!(off.abs() <= 1.2 * asked, "mode {k}: {off:.2e}");
        assert!((flat / slows(omega, 1.0 / 240.0) + 1.0).abs() < 0.2, "mode {k}: {flat:.2e}");
    }
}

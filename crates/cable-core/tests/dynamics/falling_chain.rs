//! This test compares a chain of 10 m that is let go from the horizontal with rigid links with
//! their masses in their joints, so many that what they leave out is no more than 2e-6 m.

use cable_core::Vec2;
use cable_core::scene::{Support, SupportKind};

use super::linked_rods::Rods;
use super::measure::{G, cable, climbs, spread_energy, started};

const LENGTH: f64 = 10.0;

/// The looks at it in a second.
const LOOKS: usize = 20;

/// Way of the tip of so many links in the first second, m.
fn by_links(links: usize) -> Vec<Vec2> {
    let mut rods = Rods::new(LENGTH / links as f64, vec![0.0; links]);
    let (whole, steps) = (rods.energy(), links);
    let mut path = Vec::new();
    for _ in 0..LOOKS {
        for _ in 0..steps {
            rods.step(1.0 / (LOOKS * steps) as f64);
        }
        path.push(rods.tip());
    }
    assert!((rods.energy() - whole).abs() < 1e-8 * G * LENGTH * LENGTH, "the links lose {}", rods.energy() - whole);
    path
}

/// The same of a chain, whose links are second order (L. F. Richardson).
fn of_a_chain() -> Vec<Vec2> {
    let [coarse, fine] = [200, 400].map(by_links);
    coarse.iter().zip(&fine).map(|(a, b)| b + (b - a) / 3.0).collect()
}

/// The same of bars at step `h` (s), and the energy that they lose, in mgL.
fn by_bars(bars: usize, h: f64) -> (Vec<Vec2>, f64) {
    let supports = vec![Support::fixed("wall", [0.0, 0.0]), Support::new("tip", SupportKind::Free)];
    let scene = cable([LENGTH, 1.0, 1e8], bars, supports);
    let mut sim = started(&scene, |state| {
        for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            *p = Vec2::new(*s, 0.0);
        }
    });
    let start = spread_energy(&scene, &sim.states()[0]);
    let mut path = Vec::new();
    for _ in 0..LOOKS {
        for _ in 0..(1.0 / (h * LOOKS as f64)).round() as usize {
            sim.step(h).unwrap();
        }
        path.push(sim.states()[0].position_m[bars]);
    }
    (path, (start - spread_energy(&scene, &sim.states()[0])) / (G * LENGTH * LENGTH))
}

fn off(a: &[Vec2], b: &[Vec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// In step and mesh. Bars lie outside of the curve by h² κ/24, which at the tip is an error of the
/// second order.
#[test]
fn the_tip_follows_that_of_a_chain() {
    let exact = of_a_chain();
    let links = off(&by_links(50), &exact);
    let (tip, lost) = by_bars(50, 1.0 / 240.0);
    let tip = off(&tip, &exact);
    println!("50 bars at 1/240 s: tip {tip:.2e} m, energy {lost:.1e} mgL; 50 links in no steps: {links:.2e} m");
    assert!(tip < 4.5e-4 && tip < 0.25 * links && lost.abs() < 2e-5, "{tip} {links} {lost}");
    let meshes = [25, 50, 100].map(|n| off(&by_bars(n, 1.0 / 1920.0).0, &exact));
    climbs("falling chain, tip in m, mesh", &meshes, 1.8, 1.5e-3);
    let finest = by_bars(50, 1.0 / 3840.0).0;
    let steps = [1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0].map(|h| off(&by_bars(50, h).0, &finest));
    climbs("falling chain, tip in m, step", &steps, 1.7, 3.5e-4);
}

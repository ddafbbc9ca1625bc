//! A weight at the end of a hanging cable rests at L + (WL + ½ρgL²)/EA.

use cable_core::Model;
use cable_core::scene::Support;

use super::measure::{G, cable, lump, settled, started};

const LENGTH: f64 = 10.0;
const MASS: f64 = 100.0;
const DENSITY: f64 = 0.5;

fn depth(ea: f64) -> f64 {
    LENGTH + (MASS * G * LENGTH + 0.5 * DENSITY * G * LENGTH * LENGTH) / ea
}

#[test]
fn a_hundred_kilograms_stay_where_they_hang() {
    for model in [Model::Fem, Model::MassSpring] {
        for ea in [1e5, 2e6] {
            for segments in [5, 40] {
                let supports = vec![Support::fixed("top", [0.0, 0.0]), lump("mass", MASS)];
                let mut sim = settled(&cable([LENGTH, DENSITY, ea], segments, supports), model);
                let mut worst = 0.0f64;
                for _ in 0..60 {
                    sim.step(1.0 / 60.0).unwrap();
                    worst = worst.max((sim.states()[0].position_m[segments].y + depth(ea)).abs());
                }
                println!("{model}, EA {ea:.0e}, {segments} elements: off by {worst:.1e} m in a second at 60 Hz");
                assert!(worst <= 1e-5, "{model}, EA {ea:e}, {segments}: {worst} m");
            }
        }
    }
}

#[test]
fn it_comes_to_rest_there() {
    let ea = 1e5;
    let mut scene = cable([LENGTH, DENSITY, ea], 5, vec![Support::fixed("top", [0.0, 0.0]), lump("mass", MASS)]);
    // Time constant 2·0.5/ω₁: the weight loses ω²τ/2 = 0.36 of its swing a second.
    scene.cables[0].damping_ratio = 0.5;
    let mut sim = started(&scene, |state| {
        for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            p.y -= 0.01 * s / LENGTH;
        }
    });
    for _ in 0..30 * 60 {
        sim.step(1.0 / 60.0).unwrap();
    }
    let off = sim.states()[0].position_m[5].y + depth(ea);
    println!("drawn down by 1 cm, after 30 s off by {off:.1e} m");
    assert!(off.abs() <= 1e-5, "{off} m");
}

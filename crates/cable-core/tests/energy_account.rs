//! The energy of a moving cable comes from somewhere and goes somewhere: over every step what it
//! has gained is the work of each kind of force on it, within 1e-3 of what was exchanged.
//!
//! All of it, with the figures: `cargo test --locked -p cable-core --test energy_account --
//! --nocapture`.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::Scene;
use cable_core::solution::EnergyAccount;
use cable_core::{Model, Settings, Simulation};

/// A motion and the worst imbalance in it.
struct Motion {
    last: EnergyAccount,
    /// Greatest energy that is not accounted for at an instant, of all that had been exchanged by
    /// then.
    worst: f64,
}

fn say(name: &str, m: &Motion) {
    let a = &m.last;
    println!(
        "{name}: {:.1e} at worst, {:.1e} at the end of {:.3} J: gained {:.3?}, supports {:.4}, loads {:.4}, outlines {:.4}, friction {:.4}, material {:.4}, impacts {:.4}, edits {:.4}, numerical {:.4}, unaccounted {:.2e}",
        m.worst,
        a.unaccounted_j().abs() / a.exchanged_j,
        a.exchanged_j,
        [a.gained.kinetic_j, a.gained.gravity_j, a.gained.stretch_j, a.gained.bending_j],
        a.supports_j,
        a.loads_j,
        a.outlines_j,
        a.friction_j,
        a.material_j,
        a.impacts_j,
        a.edits_j,
        a.numerical_j,
        a.unaccounted_j(),
    );
}

fn run(name: &str, scene: &Scene, seconds: f64, dt_s: f64) -> Motion {
    let mut sim = Simulation::with_settings(scene.clone(), Model::Fem, Settings::default()).expect("a sound scene");
    sim.settle().expect("it rests");
    let mut m = Motion { last: EnergyAccount::default(), worst: 0.0 };
    for _ in 0..(seconds / dt_s).round() as usize {
        sim.step(dt_s).expect("it runs");
        let Some(account) = sim.solution().cables[0].energy_account else { continue };
        m.worst = m.worst.max(account.unaccounted_j().abs() / account.exchanged_j.max(1e-9));
        m.last = account;
    }
    say(name, &m);
    m
}

fn scene(text: &str) -> Scene {
    Scene::from_toml(&format!("version = 1\n{text}")).expect("a sound scene")
}

const CABLE: &str = r#"
[[cables]]
name = "cable"
preset = "soow-6-4"
"#;

#[test]
fn a_swing_in_the_air_loses_what_its_material_takes() {
    let swing = scene(&format!(
        r#"{CABLE}
length_m = 8.0
segments = 40
damping_ratio = 0.02
supports = [
    {{ name = "a", kind = "fixed", at_m = [0.0, 5.0] }},
    {{ name = "b", kind = "fixed", at_m = [6.0, 5.0], release_s = 0.1 }},
]
"#
    ));
    let m = run("swing", &swing, 4.0, 1.0 / 60.0);
    assert!(m.worst < 1e-3 && m.last.exchanged_j > 10.0, "{:?}", m.last);
}

#[test]
fn what_is_exchanged_in_the_catalogue() {
    let only = std::env::var("SCENE").ok();
    for (name, scene) in cable_core::scene::catalog::all() {
        if only.as_deref().is_some_and(|o| o != name) || Simulation::new(scene.clone(), Model::Fem).is_err() {
            continue;
        }
        run(name, &scene, 2.0, 1.0 / 60.0);
    }
}

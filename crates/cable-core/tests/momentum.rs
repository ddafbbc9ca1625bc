//! Over every step of a motion momentum changes by the impulse of what acts, impacts included. The
//! account is the model's own; that it is one of what is shown (momentum of the nodes, weight of
//! the scene, the answer before) is asked here as well.
//!
//! All of it: `cargo test --locked -p cable-core --test momentum -- --nocapture` (violent scenes:
//! `--test violent`).
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod momentum_balance;

use cable_core::answer_verifier::{Depth, Law, Verifier};
use cable_core::scene::{Scene, catalog};
use cable_core::solution::{MomentumAccount, Solution, WarningKind};
use cable_core::{Model, Settings, Simulation};

/// Steps with an account, and momentum from nowhere in each with its place.
fn run(name: &str, scene: &Scene, model: Model, (seconds, dt_s): (f64, f64), found: &mut Vec<(f64, String)>) -> usize {
    let mut sim = Simulation::with_settings(scene.clone(), model, Settings::default()).expect("a sound scene");
    sim.settle().expect("it rests");
    let mut before: Vec<Option<MomentumAccount>> = vec![None; scene.cables.len()];
    let mut count = 0;
    for step in 0..(seconds / dt_s) as usize {
        sim.step(dt_s).expect("it runs");
        let answer = sim.solution();
        let grown: Vec<_> = answer.warnings.iter().filter(|w| w.kind == WarningKind::EnergyGrows).collect();
        assert!(grown.is_empty(), "{name} by {model}, step {step}: {grown:?}");
        for (cable, before) in answer.cables.iter().zip(&mut before) {
            if let (Some(was), Some(now)) = (*before, cable.momentum) {
                assert_eq!(was.after_kg_m_per_s, now.before_kg_m_per_s, "{name} by {model}, step {step}");
                assert!((now.over_s - dt_s).abs() < 1e-9, "{name} by {model}, step {step}: {now:?}");
            }
            if let Some(account) = cable.momentum {
                count += 1;
                found.push((
                    momentum_balance::imbalance(&account),
                    format!("{name} by {model}, step {step}: {account:?}"),
                ));
            }
            *before = cable.momentum;
        }
    }
    count
}

#[test]
fn momentum_is_kept_in_the_motions_of_the_catalogue() {
    let only = std::env::var("SCENE").ok();
    for model in [Model::Fem, Model::MassSpring] {
        let mut found = Vec::new();
        for (name, scene) in catalog::all() {
            if only.as_deref().is_some_and(|o| o != name) || Simulation::new(scene.clone(), model).is_err() {
                continue;
            }
            let moves =
                scene.robot.is_some() || scene.cables.iter().flat_map(|c| &c.supports).any(|s| s.motion.is_some());
            if moves {
                let count = run(name, &scene, model, (1.0, 1.0 / 60.0), &mut found);
                println!("{name} by {model}: {count} steps");
            }
        }
        momentum_balance::tell_imbalance(&found);
        let worst = found.iter().map(|f| f.0).fold(0.0, f64::max);
        assert!(found.len() > 20 && worst < 1e-4, "{worst}");
    }
}

/// A cable let go at one end that falls on a floor: the last answer, by a model.
fn fallen(model: Model) -> (Scene, Solution) {
    let text = r#"
version = 1
[[cables]]
name = "cable"
preset = "soow-6-4"
length_m = 8.0
segments = 40
friction = 0.4
supports = [
    { name = "a", kind = "fixed", at_m = [0.0, 2.0] },
    { name = "b", kind = "fixed", at_m = [5.0, 2.0], release_s = 0.05 },
]
[[obstacles]]
name = "floor"
kind = "terrain"
points_m = [[-5.0, 0.0], [15.0, 0.0]]
"#;
    let scene = Scene::from_toml(text).expect("a scene");
    let mut sim = Simulation::with_settings(scene.clone(), model, Settings::default()).expect("a sound scene");
    sim.settle().expect("it rests");
    for _ in 0..40 {
        sim.step(1.0 / 60.0).expect("it falls");
    }
    (scene, sim.solution())
}

/// The account is one of what is shown, and faults in it are seen.
#[test]
fn a_lost_impact_and_nine_tenths_of_a_support_are_seen() {
    for model in [Model::Fem, Model::MassSpring] {
        let (scene, answer) = fallen(model);
        let account = answer.cables[0].momentum.expect("it moves");
        println!("{model}: {account:?}");
        let check = |answer: &Solution| {
            let found = Verifier::new(&scene).check(&scene, answer, Depth::Always);
            assert!(found.checked.contains(&Law::Momentum), "{:?}", found.checked);
            found.findings.iter().any(|f| f.law == Law::Momentum)
        };
        assert!(!check(&answer), "{model}: sound before");
        let nodes = &answer.cables[0].nodes;
        let density = scene.cables[0].linear_density_kg_per_m;
        let [x, y] = nodes.windows(2).fold([0.0; 2], |sum, n| {
            let half = 0.5 * density * (n[1].arc_length_m - n[0].arc_length_m);
            [sum[0] + half * (n[0].vx_m_per_s + n[1].vx_m_per_s), sum[1] + half * (n[0].vy_m_per_s + n[1].vy_m_per_s)]
        });
        let [px, py] = account.after_kg_m_per_s;
        assert!((px - x).hypot(py - y) < 1e-9 * px.hypot(py), "{model}: [{x}, {y}] and {account:?}");
        let weight = -density * 8.0 * scene.environment.gravity_m_per_s2 / 60.0;
        assert!((account.weight_n_s[1] / weight - 1.0).abs() < 1e-2, "{model}: {weight} and {account:?}");
        let changes: [fn(&mut MomentumAccount); 5] = [
            |a| a.contacts_n_s = [0.0; 2],
            |a| a.supports_n_s = a.supports_n_s.map(|j| 0.9 * j),
            |a| a.weight_n_s[1] *= 1.01,
            |a| a.after_kg_m_per_s[1] *= 1.01,
            |a| a.contacts_n_s[1] = f64::NAN,
        ];
        for (k, change) in changes.into_iter().enumerate() {
            let mut other = answer.clone();
            change(other.cables[0].momentum.as_mut().expect("it moves"));
            assert!(check(&other), "{model}: fault {k} is not seen");
        }
    }
}

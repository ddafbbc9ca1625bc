//! Every catalogue scene by every model, at rest, in motion and in slow motion, is the same to the
//! bit as when `tests/data/fingerprints.txt` was written.
//!
//! A change of the code's plan must not change a number; one that means to writes the file anew and
//! says so:
//! ```text
//! cargo test --locked -p cable-tests --test fingerprints -- --ignored
//! UPDATE_FINGERPRINTS=1 cargo test --locked -p cable-tests --test fingerprints -- --ignored
//! ```
//! Ignored by default: functions such as the sine differ by a rounding between machines, which a
//! chaotic motion makes a whole difference of.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::fmt::Write as _;
use std::path::Path;

use cable_core::model::{Inertia, Question};
use cable_core::record::Fingerprint;
use cable_core::scene::catalog;
use cable_core::{Model, Scene, Settings, Simulation, Solution};

const FRAMES: usize = 120;
const FRAME_S: f64 = 1.0 / 60.0;
/// Frames between two answers that are looked at.
const LOOK: usize = 20;

/// Takes in an answer, forces on supports and contacts included.
fn push(print: &mut Fingerprint, answer: &Solution) {
    print.push(answer);
    for cable in &answer.cables {
        let supports = cable.supports.iter().flat_map(|s| [s.reaction_x_n, s.reaction_y_n]);
        let contacts = cable.contacts.iter().flat_map(|c| [c.arc_length_m, c.force_n[0], c.force_n[1]]);
        supports.chain(contacts).for_each(|value| print.bytes(&value.to_bits().to_le_bytes()));
    }
}

/// The kind of an error; its words may change.
fn kind(error: &impl std::fmt::Debug) -> String {
    format!("{error:?}").split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().to_owned()
}

fn print_of(scene: &Scene, model: Model, question: Question) -> String {
    let settings = Settings::default();
    let mut simulation = match Simulation::for_question(scene.clone(), model, settings, question) {
        Ok(simulation) => simulation,
        Err(error) => return kind(&error),
    };
    let mut print = Fingerprint::default();
    match simulation.settle() {
        Ok(answer) => push(&mut print, &answer),
        Err(error) => return kind(&error),
    }
    let Question::History(inertia) = question else { return format!("{:016x}", print.0) };
    for frame in 1..=FRAMES {
        let stepped = match inertia {
            Inertia::Dynamic => simulation.step(FRAME_S),
            Inertia::QuasiStatic => simulation.step_quasi_static(FRAME_S),
        };
        if frame % LOOK == 0 || stepped.is_err() {
            push(&mut print, &simulation.solution());
        }
        if let Err(error) = stepped {
            return format!("{:016x} {} at frame {frame}", print.0, kind(&error));
        }
    }
    format!("{:016x}", print.0)
}

#[test]
#[ignore = "half a minute: not a bit of any catalogue scene has changed"]
fn no_bit_has_changed() {
    let questions = [
        ("rest", Question::Rest),
        ("motion", Question::History(Inertia::Dynamic)),
        ("slow", Question::History(Inertia::QuasiStatic)),
    ];
    let mut found = String::new();
    for (name, scene) in catalog::all() {
        for model in [Model::Auto].into_iter().chain(Model::SOLVERS) {
            for (asked, question) in questions {
                let _ = writeln!(found, "{name} {model} {asked}: {}", print_of(&scene, model, question));
            }
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/fingerprints.txt");
    if std::env::var_os("UPDATE_FINGERPRINTS").is_some() {
        std::fs::write(&path, &found).unwrap();
        return;
    }
    let pinned = std::fs::read_to_string(&path).unwrap();
    let changed: Vec<_> = found.lines().zip(pinned.lines()).filter(|(a, b)| a != b).collect();
    assert!(changed.is_empty() && found.lines().count() == pinned.lines().count(), "{changed:#?}");
}

//! Halves and doubles each tuned constant of a model, one at a time, over the catalogue, and prints which answers move.
//!
//! Run from the root of the repository: `cargo run --release -p cable-benches --bin tuned-settings -- mass-spring`; words after the
//! model keep the constants whose names contain one of them. Each scene is solved at rest, for a second of motion and for a second of
//! quasi-static motion. `docs/notes/settings.md` explains the table.

use std::collections::BTreeMap;
use std::error::Error;
use std::sync::Arc;

use cable_core::model::mass_spring::MassSpringModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::{Problem, problems};
use cable_core::scene::catalog;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Frames of a motion, and the length of one, s.
const FRAMES: usize = 60;
const FRAME_S: f64 = 1.0 / 60.0;
/// Frames between two answers that are compared.
const COMPARED_EVERY: usize = 10;
/// Relative change of tension below which an answer counts as unmoved: round-off of a motion.
const UNMOVED: f64 = 1e-9;

type Build<T> = fn(Arc<Problem>, Settings, T) -> Result<Box<dyn Mechanics>, cable_core::SolveError>;

/// A question of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Question {
    Rest,
    Motion,
    QuasiStatic,
}

/// The answer of one question: figures, or the error that refused it.
#[derive(Clone, Debug, Default)]
struct Outcome {
    refused: Option<String>,
    /// Greatest tension and forces on supports of each compared answer, N.
    forces: Vec<f64>,
    work: usize,
}

type Outcomes = BTreeMap<(String, Question), Outcome>;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let model = words.next().unwrap_or_default();
    let names: Vec<String> = words.collect();
    match model.as_str() {
        "mass-spring" => measure(&names, |problem, settings, tuning| {
            Ok(Box::new(MassSpringModel::with_tuning(problem, settings, Arc::new(tuning))?))
        }),
        _ => Err("name a model: mass-spring".into()),
    }
}

/// Prints a line for each constant and factor.
fn measure<T: Serialize + DeserializeOwned + Default>(names: &[String], build: Build<T>) -> Result<(), Box<dyn Error>> {
    let default = serde_json::to_value(T::default())?;
    let mut paths = Vec::new();
    constants(&default, "", &mut paths);
    let before = solve_all(build, &default)?;
    let total: usize = before.values().map(|o| o.work).sum();
    println!("{} questions, {} refused, {total} iterations or sub-steps", before.len(), refusals(&before));
    println!("| constant | factor | moved | refused anew | answered anew | greatest change | work |");
    println!("|---|---|---|---|---|---|---|");
    for path in paths.iter().filter(|p| names.is_empty() || names.iter().any(|n| p.contains(n))) {
        for factor in [0.5, 2.0] {
            let Some(changed) = scaled(&default, path, factor) else { continue };
            let after = solve_all(build, &changed)?;
            println!("| {path} | {factor} | {} |", compared(&before, &after));
        }
    }
    Ok(())
}

/// Paths of all numbers of a value (`group/name`).
fn constants(value: &Value, path: &str, out: &mut Vec<String>) {
    match value {
        Value::Object(fields) => fields.iter().for_each(|(name, v)| constants(v, &format!("{path}/{name}"), out)),
        Value::Number(_) => out.push(path.to_owned()),
        _ => {}
    }
}

/// A value with one of its numbers scaled; None if that leaves it as it is.
fn scaled(value: &Value, path: &str, factor: f64) -> Option<Value> {
    let mut out = value.clone();
    let number = out.pointer_mut(path)?;
    *number = match number.as_u64() {
        Some(n) if factor < 1.0 => Value::from((n / 2).max(1)),
        Some(n) => Value::from(n * 2),
        None => Value::from(number.as_f64()? * factor),
    };
    (out != *value).then_some(out)
}

fn solve_all<T: DeserializeOwned>(build: Build<T>, tuning: &Value) -> Result<Outcomes, Box<dyn Error>> {
    let mut out = Outcomes::new();
    for (name, scene) in catalog::all() {
        for (k, problem) in problems(&scene)?.into_iter().enumerate() {
            for question in [Question::Rest, Question::Motion, Question::QuasiStatic] {
                let tuning = serde_json::from_value(tuning.clone())?;
                let mut outcome = Outcome::default();
                let solved = build(problem.clone(), Settings::default(), tuning)
                    .and_then(|mut model| solve(model.as_mut(), question, &mut outcome));
                // Two errors of one kind are the same refusal.
                let kind = |e| format!("{e:?}").split(|c: char| !c.is_alphanumeric()).next().map(str::to_owned);
                outcome.refused = solved.err().and_then(kind);
                out.insert((format!("{name}/{k}"), question), outcome);
            }
        }
    }
    Ok(out)
}

fn solve(model: &mut dyn Mechanics, question: Question, outcome: &mut Outcome) -> Result<(), cable_core::SolveError> {
    outcome.work += model.settle()?.cost.iterations;
    push(outcome, model);
    let inertia = match question {
        Question::Rest => return Ok(()),
        Question::Motion => Inertia::Dynamic,
        Question::QuasiStatic => Inertia::QuasiStatic,
    };
    for frame in 1..=FRAMES {
        outcome.work += model.advance(FRAME_S, inertia)?.cost.iterations;
        if frame % COMPARED_EVERY == 0 {
            push(outcome, model);
        }
    }
    Ok(())
}

fn push(outcome: &mut Outcome, model: &dyn Mechanics) {
    let answer = model.solution();
    outcome.forces.push(answer.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max));
    outcome.forces.extend(answer.supports.iter().flat_map(|s| [s.reaction_x_n, s.reaction_y_n]));
}

fn refusals(outcomes: &Outcomes) -> usize {
    outcomes.values().filter(|o| o.refused.is_some()).count()
}

/// Greatest difference of the forces of two outcomes, of the greatest force.
fn change(before: &Outcome, after: &Outcome) -> f64 {
    let scale = before.forces.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let pairs = before.forces.iter().zip(&after.forces);
    pairs.map(|(a, b)| (a - b).abs() / scale).fold(0.0, f64::max)
}

/// The columns of a line.
fn compared(before: &Outcomes, after: &Outcomes) -> String {
    let (mut moved, mut refused, mut answered) = (0, Vec::new(), 0);
    let mut worst = (0.0, String::new());
    for (key, old) in before {
        let Some(new) = after.get(key) else { continue };
        match (&old.refused, &new.refused) {
            (None, Some(kind)) => refused.push(format!("{} {:?} {kind}", key.0, key.1)),
            (Some(_), None) => answered += 1,
            _ => {}
        }
        let change = change(old, new);
        moved += usize::from(change > UNMOVED || old.refused != new.refused);
        if change > worst.0 {
            worst = (change, format!("{} {:?}", key.0, key.1));
        }
    }
    let work = |o: &Outcomes| o.values().map(|o| o.work).sum::<usize>() as f64;
    let refused = if refused.is_empty() { "0".to_owned() } else { refused.join(", ") };
    format!("{moved} | {refused} | {answered} | {:.1e} {} | {:.3}", worst.0, worst.1, work(after) / work(before))
}

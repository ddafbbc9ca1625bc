//! This program halves and doubles each tuned constant of a model, one at a time, and prints which
//! answers move.
//!
//! Run from the root of the repository:
//! `cargo run --release -p cable-benches --bin tuned-settings -- spans 50 newton/max drag`
//!
//! Words that name models choose these (all without any), a number is that of random scenes, and
//! other words keep the constants whose names contain one of them. Each cable of the catalogue is
//! solved at rest, in a motion where the model has one, and in slow motion; a random scene is a
//! cable over hills and posts, or over pulleys where the model has no contact, whose end a hand
//! draws slowly. `docs/notes/settings.md` has the
//! tables.

use std::error::Error;
use std::sync::Arc;

use cable_core::model::catenary::{CatenaryModel, CatenarySettings};
use cable_core::model::fem::{self, FemModel};
use cable_core::model::mass_spring::{self, MassSpringModel};
use cable_core::model::spans::{SpansModel, SpansSettings};
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::{Problem, problems};
use cable_core::scene::{Shape, Support, SupportKind, catalog};
use cable_core::{Model, Obstacle, Scene, SolveError, Vec2};
use serde_json::Value;

/// Random scenes unless told otherwise.
const RANDOM_SCENES: u64 = 20;
/// Frames of a motion, and the length of one, s.
const FRAMES: usize = 30;
const FRAME_S: f64 = 1.0 / 60.0;
/// Steps of a slow motion, and the length of one, s.
const SLOW_STEPS: usize = 10;
const SLOW_STEP_S: f64 = 0.1;
/// Frames between two answers that are compared.
const COMPARED_EVERY: usize = 10;
/// Change of a force, of the greatest, below which an answer counts as unmoved: rounding.
const ROUNDING: f64 = 1e-6;
/// Change of the work, of itself, below which it counts as unmoved.
const SAME_WORK: f64 = 0.01;
/// Work, of that with the values of the program, beyond which a motion is not followed further.
const MOST_WORK: usize = 20;

/// A model with the default values of its tuned constants.
struct Tuned {
    model: Model,
    constants: Value,
    build: fn(Arc<Problem>, Value) -> Built,
}

type Built = Result<Box<dyn Mechanics>, Box<dyn Error>>;

fn tuned_models() -> Result<Vec<Tuned>, Box<dyn Error>> {
    Ok(vec![
        Tuned {
            model: Model::Catenary,
            constants: serde_json::to_value(CatenarySettings::default())?,
            build: |problem, c| Ok(Box::new(CatenaryModel::with_settings(problem, serde_json::from_value(c)?)?)),
        },
        Tuned {
            model: Model::Spans,
            constants: serde_json::to_value(SpansSettings::default())?,
            build: |problem, c| {
                Ok(Box::new(SpansModel::with_settings(
                    problem,
                    Settings::default(),
                    Arc::new(serde_json::from_value(c)?),
                )?))
            },
        },
        Tuned {
            model: Model::Fem,
            constants: serde_json::to_value(fem::Tuning::default())?,
            build: |problem, c| {
                let tuning = Arc::new(serde_json::from_value(c)?);
                Ok(Box::new(FemModel::with_tuning(problem, Settings::default(), tuning)?))
            },
        },
        Tuned {
            model: Model::MassSpring,
            constants: serde_json::to_value(mass_spring::Tuning::default())?,
            build: |problem, c| {
                Ok(Box::new(MassSpringModel::with_tuning(
                    problem,
                    Settings::default(),
                    Arc::new(serde_json::from_value(c)?),
                )?))
            },
        },
    ])
}

/// A motion that is asked of a cable after its rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Question {
    Motion,
    Slow,
}

/// A cable, a motion of it, and where a hand draws its last support, m.
struct Case {
    name: String,
    problem: Arc<Problem>,
    question: Question,
    hand: Option<Vec2>,
}

/// The answers to a case.
#[derive(Clone, Debug, Default)]
struct Outcome {
    /// Kind of the error that ended it.
    refused: Option<String>,
    /// Greatest tension, its stated error and forces on supports of each compared answer, N.
    forces: Vec<f64>,
    work: usize,
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut models, mut names, mut random) = (Vec::new(), Vec::new(), RANDOM_SCENES);
    for word in std::env::args().skip(1) {
        match (Model::SOLVERS.into_iter().find(|m| m.to_string() == word), word.parse()) {
            (Some(model), _) => models.push(model),
            (_, Ok(number)) => random = number,
            _ => names.push(word),
        }
    }
    for tuned in tuned_models()?.iter().filter(|t| models.is_empty() || models.contains(&t.model)) {
        measure(tuned, random, &names)?;
    }
    Ok(())
}

/// Prints a line for each constant of a model.
fn measure(tuned: &Tuned, random: u64, names: &[String]) -> Result<(), Box<dyn Error>> {
    let cases = cases(tuned.model, random)?;
    let solve_all = |constants: &Value, usual: Option<&[Outcome]>| -> Vec<Outcome> {
        let limit = |k: usize| usual.map_or(usize::MAX, |u| MOST_WORK * u[k].work.max(100));
        cases.iter().enumerate().map(|(k, case)| solve(tuned, constants, case, limit(k))).collect()
    };
    let usual = solve_all(&tuned.constants, None);
    let refused = usual.iter().filter(|o| o.refused.is_some()).count();
    let work: usize = usual.iter().map(|o| o.work).sum();
    println!("`{}`: {} questions, {refused} of them refused, {work} iterations or sub-steps", tuned.model, usual.len());
    println!("\n| constant | value | answers moved | greatest change | refused anew | answered anew | work |");
    println!("|---|---|---|---|---|---|---|");
    let mut paths = Vec::new();
    constants(&tuned.constants, "", &mut paths);
    let mut without_effect = Vec::new();
    for (path, value) in paths.iter().filter(|(p, _)| names.is_empty() || names.iter().any(|n| p.contains(n))) {
        let effects = [0.5, 2.0].map(|factor| {
            scaled(&tuned.constants, path, factor)
                .map_or_else(Effect::default, |c| compared(&cases, &usual, &solve_all(&c, Some(&usual))))
        });
        let cell = |text: fn(&Effect) -> String| effects.each_ref().map(text).join(" / ");
        println!(
            "| {} | {value} | {} | {} | {} | {} | {} |",
            path.trim_start_matches('/'),
            cell(|e| e.moved.to_string()),
            cell(|e| if e.greatest > ROUNDING { format!("{:.0e}", e.greatest) } else { "0".to_owned() }),
            cell(|e| e.refused.len().to_string()),
            cell(|e| e.answered.to_string()),
            cell(|e| format!("{:+.0} %", 100.0 * e.work)),
        );
        for (effect, factor) in effects.iter().zip(["halved", "doubled"]) {
            effect.refused.iter().for_each(|case| eprintln!("{path} {factor}: {case}"));
        }
        if effects.iter().all(Effect::is_none) {
            without_effect.push(path.trim_start_matches('/').to_owned());
        }
    }
    println!("\nWithout effect: {}\n", without_effect.join(", "));
    Ok(())
}

/// Names (`/group/name`) and values of all numbers.
fn constants<'a>(value: &'a Value, path: &str, out: &mut Vec<(String, &'a Value)>) {
    match value {
        Value::Object(fields) => fields.iter().for_each(|(name, v)| constants(v, &format!("{path}/{name}"), out)),
        Value::Array(parts) => parts.iter().enumerate().for_each(|(k, v)| constants(v, &format!("{path}/{k}"), out)),
        Value::Number(_) => out.push((path.to_owned(), value)),
        _ => {}
    }
}

/// The constants with one of them scaled; None if that leaves it as it is.
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

/// The catalogue and random scenes.
fn cases(model: Model, random: u64) -> Result<Vec<Case>, Box<dyn Error>> {
    let (moves, touches) = (model.info().capabilities.inertia, model.info().capabilities.contact);
    let mut all = Vec::new();
    for (name, scene) in catalog::all() {
        for (k, problem) in problems(&scene)?.into_iter().enumerate() {
            for question in [Question::Motion, Question::Slow].into_iter().filter(|q| moves || *q == Question::Slow) {
                let name = format!("{name}, cable {k}, {question:?}");
                all.push(Case { name, problem: problem.clone(), question, hand: None });
            }
        }
    }
    for seed in 0..random {
        let (scene, hand) = if touches { over_hills(seed) } else { over_pulleys(seed) };
        for problem in problems(&scene)? {
            let name = format!("random {seed}");
            all.push(Case { name, problem, question: Question::Slow, hand: Some(hand) });
        }
    }
    Ok(all)
}

/// A cable over hills and posts, and where a hand draws its end, m.
fn over_hills(seed: u64) -> (Scene, Vec2) {
    let mut dice = Dice(seed);
    let width = dice.between(5.0, 30.0);
    let support = |name: &str, at_m| Support { at_m: Some(at_m), ..Support::new(name, SupportKind::Fixed) };
    let ends = [[0.0, dice.between(0.5, 6.0)], [width, dice.between(0.5, 6.0)]];
    let length = width * dice.between(1.02, 1.4) + (ends[0][1] - ends[1][1]).abs();
    let stiffness = 10f64.powf(dice.between(4.0, 6.5));
    let mut scene = catalog::cable_alone(
        [length, dice.between(0.1, 2.0), stiffness],
        vec![support("left", ends[0]), support("right", ends[1])],
    );
    scene.cables[0].friction = if dice.between(0.0, 1.0) < 0.3 { 0.0 } else { dice.between(0.05, 0.6) };
    let points_m = (0..=8).map(|k| [width * f64::from(k - 1) / 6.0, dice.between(-3.0, 0.3)]).collect();
    let ground = Shape::Terrain { points_m };
    scene.obstacles.push(Obstacle { name: "ground".to_owned(), shape: ground, friction: None });
    for k in 0..3 {
        let center_m = [width * (0.2 + 0.3 * f64::from(k)), dice.between(0.5, 3.0)];
        let shape = Shape::Circle { center_m, radius_m: dice.between(0.05, 0.4) };
        scene.obstacles.push(Obstacle { name: format!("post {k}"), shape, friction: None });
    }
    let hand = Vec2::new(width + dice.between(-3.0, 1.0), ends[1][1] + dice.between(-1.0, 2.0));
    (scene, hand)
}

/// A cable over up to three pulleys in the air, and where a hand draws its end, m.
fn over_pulleys(seed: u64) -> (Scene, Vec2) {
    let mut dice = Dice(seed);
    let width = dice.between(5.0, 30.0);
    let ends = [[0.0, dice.between(0.5, 6.0)], [width, dice.between(0.5, 6.0)]];
    let mut supports = vec![Support::fixed("left", ends[0])];
    for k in 0..seed % 4 {
        #[expect(clippy::cast_precision_loss, reason = "at most three")]
        let x = width * (k + 1) as f64 / (seed % 4 + 1) as f64;
        let pulley = Support::pulley(format!("pulley {k}"), [x, dice.between(4.0, 9.0)]);
        let radius_m = (dice.between(0.0, 1.0) < 0.5).then(|| dice.between(0.05, 0.3));
        supports.push(Support { radius_m, friction: Some(dice.between(0.0, 0.4)), ..pulley });
    }
    supports.push(Support::fixed("right", ends[1]));
    let straight = |s: &[Support]| {
        let at = |s: &Support| s.at_m.unwrap_or_default();
        let legs = s.windows(2).map(|w| [at(&w[0]), at(&w[1])]);
        legs.map(|[a, b]| (a[0] - b[0]).hypot(a[1] - b[1])).sum::<f64>()
    };
    let length = straight(&supports) * dice.between(1.01, 1.4);
    let stiffness = 10f64.powf(dice.between(4.0, 6.5));
    let scene = catalog::cable_alone([length, dice.between(0.1, 2.0), stiffness], supports);
    let hand = Vec2::new(width + dice.between(-1.0, 0.2), ends[1][1] + dice.between(-0.5, 0.5));
    (scene, hand)
}

/// Random numbers: splitmix64.
struct Dice(u64);

impl Dice {
    #[expect(clippy::cast_precision_loss, reason = "53 bits are exact")]
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Answers a case, with at most so much work.
fn solve(tuned: &Tuned, constants: &Value, case: &Case, most_work: usize) -> Outcome {
    let mut outcome = Outcome::default();
    let built = (tuned.build)(case.problem.clone(), constants.clone());
    outcome.refused = match built.map(|mut model| follow(model.as_mut(), case, most_work, &mut outcome)) {
        Ok(Ok(())) => None,
        // Two errors of one kind are the same refusal.
        Ok(Err(error)) => format!("{error:?}").split(|c: char| !c.is_alphanumeric()).next().map(str::to_owned),
        Err(_) => Some("Unsupported".to_owned()),
    };
    outcome
}

fn follow(model: &mut dyn Mechanics, case: &Case, most_work: usize, out: &mut Outcome) -> Result<(), SolveError> {
    out.work += model.settle()?.cost.iterations;
    push(out, model);
    let (steps, dt_s, inertia, every) = match case.question {
        Question::Motion => (FRAMES, FRAME_S, Inertia::Dynamic, COMPARED_EVERY),
        Question::Slow => (SLOW_STEPS, SLOW_STEP_S, Inertia::QuasiStatic, 1),
    };
    let start = case.problem.supports.last().and_then(|s| s.at);
    for step in 1..=steps {
        if let (Some(hand), Some(start)) = (case.hand, start) {
            #[expect(clippy::cast_precision_loss, reason = "few steps")]
            let part = step as f64 / steps as f64;
            model.drag_support(case.problem.supports.len() - 1, start + (hand - start) * part);
        }
        out.work += model.advance(dt_s, inertia)?.cost.iterations;
        if step % every == 0 {
            push(out, model);
        }
        if out.work > most_work {
            break;
        }
    }
    Ok(())
}

fn push(outcome: &mut Outcome, model: &dyn Mechanics) {
    let answer = model.solution();
    let greatest = answer.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max);
    outcome.forces.extend([greatest, greatest * answer.error_estimate.unwrap_or(0.0)]);
    outcome.forces.extend(answer.supports.iter().flat_map(|s| [s.reaction_x_n, s.reaction_y_n]));
}

/// The effect of a constant scaled.
#[derive(Default)]
struct Effect {
    moved: usize,
    /// Greatest change of a force, of the greatest one of its case.
    greatest: f64,
    /// Cases that are refused now.
    refused: Vec<String>,
    answered: usize,
    /// Change of the work, of itself, over the cases that are answered both times.
    work: f64,
}

impl Effect {
    fn is_none(&self) -> bool {
        self.moved == 0 && self.work.abs() < SAME_WORK
    }
}

fn compared(cases: &[Case], before: &[Outcome], after: &[Outcome]) -> Effect {
    let mut effect = Effect::default();
    let mut work = [0usize; 2];
    for ((case, old), new) in cases.iter().zip(before).zip(after) {
        match (&old.refused, &new.refused) {
            (None, Some(kind)) => effect.refused.push(format!("{} {kind}", case.name)),
            (Some(_), None) => effect.answered += 1,
            _ => work = [work[0] + old.work, work[1] + new.work],
        }
        let scale = old.forces.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let pairs = old.forces.iter().zip(&new.forces);
        let change = pairs.map(|(a, b)| (a - b).abs() / scale).fold(0.0, f64::max);
        let longer = old.forces.len() != new.forces.len();
        effect.moved += usize::from(change > ROUNDING || longer || old.refused != new.refused);
        effect.greatest = effect.greatest.max(change);
    }
    #[expect(clippy::cast_precision_loss, reason = "far below 2^53")]
    let [old, new] = work.map(|w| w as f64);
    effect.work = if old > 0.0 { new / old - 1.0 } else { 0.0 };
    effect
}

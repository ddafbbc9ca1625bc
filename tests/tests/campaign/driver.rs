//! The driver makes verdicts of families and seeds.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use cable_core::scene::Scene;
use cable_core::solution::{Histories, WarningCause};
use cable_core::{Model, Settings, Simulation, Solution};

use crate::case::{Case, Expect, Point};
use crate::chance::Chance;
use crate::families::{FAMILIES, Family};
use crate::judge;
use crate::relations::{COUNT, end_forces, relation};

/// The questions of a campaign.
pub struct Plan {
    pub first: u64,
    pub cases: usize,
    /// Parts of names of families; empty: all.
    pub names: Vec<String>,
    /// Number of relations that each case is asked.
    pub relations: usize,
    /// True if `fem` with 300 elements is asked for a second opinion.
    pub second_model: bool,
    /// Longest time for an answer, s; what takes longer is refused.
    pub limit_s: u64,
    pub out: Option<PathBuf>,
}

impl Default for Plan {
    fn default() -> Self {
        Self { first: 0, cases: 1, names: Vec::new(), relations: 0, second_model: false, limit_s: 60, out: None }
    }
}

/// The outcome of a family.
#[derive(Default)]
pub struct Tally {
    pub family: &'static str,
    pub cases: usize,
    pub answered: usize,
    /// Scenes without a resting place that were told so.
    pub told: usize,
    /// Refusals of scenes that may be refused.
    pub excused: usize,
    pub refused: Vec<String>,
    pub causes: BTreeMap<String, usize>,
    pub wrong: Vec<String>,
    pub outside: Vec<String>,
    /// Another of the equilibria, within the range that the answer states for other histories.
    pub other: usize,
    pub private: Vec<String>,
    pub slowest: (f64, u64),
}

/// The outcome of a case.
#[derive(Default)]
struct Verdict {
    answered: bool,
    told: bool,
    excused: bool,
    refused: Option<String>,
    wrong: Vec<String>,
    outside: Vec<String>,
    other: usize,
    private: Option<String>,
    seconds: f64,
}

/// Runs a plan on a few threads and prints what came out of each family.
pub fn run(plan: &Plan) -> Vec<Tally> {
    let chosen: Vec<&Family> = FAMILIES
        .iter()
        .filter(|f| plan.names.is_empty() || plan.names.iter().any(|n| f.0.contains(n.as_str())))
        .collect();
    let tallies: Vec<Mutex<Tally>> =
        chosen.iter().map(|f| Mutex::new(Tally { family: f.0, cases: plan.cases, ..Tally::default() })).collect();
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(8);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    let (Some(family), seed) = (chosen.get(k / plan.cases), plan.first + (k % plan.cases) as u64)
                    else {
                        return;
                    };
                    let case = family.1(&mut Chance::new(family.0, seed));
                    let verdict = judge_case(plan, &case, seed);
                    note(plan, family.0, seed, &case, &verdict);
                    let mut tally = tallies[k / plan.cases].lock().unwrap();
                    add(&mut tally, seed, verdict);
                }
            });
        }
    });
    let tallies: Vec<Tally> = tallies.into_iter().map(|t| t.into_inner().unwrap()).collect();
    print(&tallies);
    tallies
}

fn add(t: &mut Tally, seed: u64, v: Verdict) {
    t.answered += usize::from(v.answered);
    t.told += usize::from(v.told);
    t.excused += usize::from(v.excused);
    t.other += v.other;
    if let Some(why) = v.refused {
        *t.causes.entry(cause(&why)).or_default() += 1;
        t.refused.push(format!("{seed}: {why}"));
    }
    if !v.wrong.is_empty() {
        t.wrong.push(format!("{seed}: {}", v.wrong.join("; ")));
    }
    if !v.outside.is_empty() {
        t.outside.push(format!("{seed}: {}", v.outside.join("; ")));
    }
    if let Some(why) = v.private {
        t.private.push(format!("{seed}: {why}"));
    }
    if v.seconds > t.slowest.0 {
        t.slowest = (v.seconds, seed);
    }
}

fn print(tallies: &[Tally]) {
    println!(
        "{:28} {:>5} {:>5} {:>4} {:>4} {:>5} {:>5} {:>5} {:>5}  slowest",
        "family", "cases", "answ", "told", "exc", "refus", "wrong", "outs", "other"
    );
    for t in tallies {
        println!(
            "{:28} {:5} {:5} {:4} {:4} {:5} {:5} {:5} {:5}  {:.1} s ({})",
            t.family,
            t.cases,
            t.answered,
            t.told,
            t.excused,
            t.refused.len(),
            t.wrong.len(),
            t.outside.len(),
            t.other,
            t.slowest.0,
            t.slowest.1
        );
        let mut causes: Vec<_> = t.causes.iter().collect();
        causes.sort_by_key(|c| std::cmp::Reverse(c.1));
        for (cause, count) in causes {
            println!("    {count} refused: {cause}");
        }
    }
    let sum = |f: fn(&Tally) -> usize| tallies.iter().map(f).sum::<usize>();
    println!(
        "{} scenes: {} answered, {} refused, {} wrong, {} outside of what they say, {} rest elsewhere within what they say",
        sum(|t| t.cases),
        sum(|t| t.answered),
        sum(|t| t.refused.len()),
        sum(|t| t.wrong.len()),
        sum(|t| t.outside.len()),
        sum(|t| t.other)
    );
}

/// A refusal without its figures.
fn cause(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        let digit = c.is_ascii_digit();
        if !(digit && out.ends_with('#')) && out.len() < 150 {
            out.push(if digit { '#' } else { c });
        }
    }
    out
}

/// Words that say nothing to a user, and figures that no scene has.
pub fn is_private(text: &str) -> bool {
    let words = [
        "iteration",
        "iterations",
        "node",
        "nodes",
        "residual",
        "nan",
        "inf",
        "infinity",
        "newton",
        "converge",
        "converged",
    ];
    let mut tokens = text.split(|c: char| !(c.is_alphanumeric() || c == '.' || c == '-' || c == '+'));
    tokens.any(|t| {
        let t = t.trim_matches(['.', '-', '+']).to_lowercase();
        words.contains(&t.as_str()) || t.parse::<f64>().is_ok_and(|v| !(v.abs() < 1e14))
    })
}

/// The answer, or why there is none.
fn solve(scene: &Scene, model: Model, segments: Option<usize>, limit_s: u64) -> Result<Solution, String> {
    let (tell, hear) = mpsc::channel();
    let scene = scene.clone();
    std::thread::spawn(move || {
        let settings = Settings { segments, ..Settings::default() };
        let answer = std::panic::catch_unwind(|| {
            let mut simulation = Simulation::with_settings(scene, model, settings).map_err(|e| e.to_string())?;
            simulation.settle().map_err(|e| e.to_string())
        });
        // Nobody listens where it took too long.
        let _ = tell.send(answer);
    });
    match hear.recv_timeout(Duration::from_secs(limit_s)) {
        Ok(Ok(answer)) => answer,
        Ok(Err(panic)) => {
            let text = panic.downcast_ref::<String>().cloned();
            Err(format!("PANIC {}", text.unwrap_or_default()))
        }
        Err(_) => Err(format!("TIME no answer in {limit_s} s")),
    }
}

/// Returns whether the answer says itself that it breaks a law: only `mass-spring` may, where it
/// was asked for by name.
fn unsound(answer: &Solution) -> bool {
    answer.model == Model::MassSpring && answer.verification.as_ref().is_some_and(|v| !v.is_sound())
}

/// True if an answer with `own` forces at its ends says that other histories of the cable leave
/// tensions there as large as those of `other` forces, N.
fn states(answer: &Solution, own: [Point; 2], other: [Point; 2]) -> bool {
    let mut ranges = answer.warnings.iter().filter_map(|w| match &w.cause {
        WarningCause::ManyEquilibria {
            histories:
                Histories::Mobilised { start_n, end_n, .. }
                | Histories::EndsMoved { start_n, end_n, .. }
                | Histories::SlackElsewhere { start_n, end_n, .. },
            ..
        } => Some([*start_n, *end_n]),
        // A cable that pushes is sheared at its ends, too: their forces are a little more than
        // the tensions.
        WarningCause::ManyEquilibria { histories: Histories::BowedElsewhere { start_n, end_n, .. }, .. } => {
            Some([*start_n, *end_n].map(|[a, b]| [0.95 * a.abs().min(b.abs()), 1.05 * a.abs().max(b.abs())]))
        }
        WarningCause::Loose { held_n, .. } => {
            Some(own.map(|f| [f64::max(distance(f, [0.0; 2]) - held_n, 0.0), distance(f, [0.0; 2]) + held_n]))
        }
        _ => None,
    });
    let greatest = own.iter().chain(&other).map(|f| distance(*f, [0.0; 2])).fold(0.0, f64::max);
    ranges.any(|ranges| {
        ranges.iter().zip(other).all(|(range, f)| {
            let (tension, rounding) = (distance(f, [0.0; 2]), 1e-3 * greatest);
            tension >= range[0] - rounding && tension <= range[1] + rounding
        })
    })
}

pub fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn judge_case(plan: &Plan, case: &Case, seed: u64) -> Verdict {
    let begun = Instant::now();
    let answer = solve(&case.scene, case.model, None, plan.limit_s);
    let mut v = Verdict { seconds: begun.elapsed().as_secs_f64(), ..Verdict::default() };
    let answer = match answer {
        Ok(answer) => answer,
        Err(why) => {
            if why.starts_with("PANIC") {
                v.wrong.push(why);
                return v;
            }
            if is_private(&why) {
                v.private = Some(why.clone());
            }
            match case.expect {
                Expect::Slides => {
                    v.told = ["resting place: ", "cannot come to rest: "].iter().any(|words| why.contains(words));
                    v.refused = (!v.told).then(|| why.clone());
                }
                Expect::Perhaps => v.excused = true,
                _ => v.refused = Some(why.clone()),
            }
            // A refusal by `fem` does not hide that of `spans`, unless that says no more than that
            // the scene is not for it.
            if case.model == Model::Auto
                && why.starts_with("the answer of fem")
                && let Err(first) = solve(&case.scene, Model::Spans, None, plan.limit_s)
                && !first.starts_with("spans cannot answer")
            {
                v.wrong.push(format!("hides: {first}"));
            }
            return v;
        }
    };
    v.answered = true;
    if unsound(&answer) {
        v.excused = true;
        return v;
    }
    v.wrong = judge::faults(&case.scene, &answer);
    if case.expect == Expect::Slides {
        v.wrong.push("it slides, and an answer was given".to_owned());
    }
    let cable = &case.scene.cables[0];
    let greatest = judge::greatest(&case.scene, cable, &answer.cables[0]);
    let said = answer.cables[0].error_estimate.unwrap_or(0.0);
    let forces = end_forces(&answer);
    if let Expect::Forces(right, within) = case.expect {
        let off = (0..2).map(|k| distance(forces[k], right[k])).fold(0.0, f64::max) / greatest;
        // A cable of hardly any weight for its stiffness is known to rounding of its lengths alone.
        let rounding = 1e-14 * cable.axial_stiffness_n / greatest;
        if !(off <= within.max(said) + rounding) {
            let text =
                format!("forces {forces:?} are off by {off:.2e} of {greatest:.3e} N from {right:?}, {said:.1e} said");
            if answer.cables[0].error_estimate.is_some() { v.outside.push(text) } else { v.wrong.push(text) }
        }
    }
    if case.expect == Expect::Slides {
        return v;
    }
    let slowly = v.seconds > 0.2 * plan.limit_s as f64;
    for k in 0..if slowly { 0 } else { plan.relations } {
        let changed = relation(&case.scene, (seed as usize + 3 * k) % COUNT);
        // Some are beyond the ranges of a scene file.
        if changed.scene.validate().is_err() {
            continue;
        }
        match solve(&changed.scene, case.model, None, plan.limit_s) {
            Ok(other) if unsound(&other) => {}
            Ok(other) => {
                v.wrong.extend(
                    judge::faults(&changed.scene, &other).into_iter().map(|f| format!("{}: {f}", changed.name)),
                );
                let seen = (changed.back)(end_forces(&other));
                let off = (0..2).map(|k| distance(forces[k], seen[k])).fold(0.0, f64::max) / greatest;
                let both = said + other.cables[0].error_estimate.unwrap_or(0.0);
                let limit = if changed.name == "a touch more" { 0.02 } else { 1e-4 };
                let rounding = 1e-12 * cable.axial_stiffness_n / greatest;
                let differs = !(off <= limit + both + rounding);
                if differs && (states(&answer, forces, seen) || states(&other, seen, forces)) {
                    v.other += 1;
                } else if differs {
                    v.outside.push(format!(
                        "{}: {off:.2e} of {greatest:.3e} N apart, {both:.1e} said, {} and {}",
                        changed.name, answer.model, other.model
                    ));
                }
            }
            Err(why) if case.expect != Expect::Perhaps => {
                if is_private(&why) && v.private.is_none() {
                    v.private = Some(why.clone());
                }
                v.outside.push(format!("{}: refused: {why}", changed.name));
            }
            Err(_) => {}
        }
    }
    let flexible = cable.bending_stiffness_n_m2 == 0.0 && answer.model != Model::Fem;
    if plan.second_model
        && flexible
        && case.model == Model::Auto
        && seed.is_multiple_of(4)
        && !slowly
        && let Ok(other) = solve(&case.scene, Model::Fem, Some(300), plan.limit_s)
    {
        v.wrong.extend(judge::faults(&case.scene, &other).into_iter().map(|f| format!("fem: {f}")));
        let seen = end_forces(&other);
        let off = (0..2).map(|k| distance(forces[k], seen[k])).fold(0.0, f64::max) / greatest;
        let both = said + other.cables[0].error_estimate.unwrap_or(1e-3);
        let differs = !(off <= 1e-5 + both);
        if differs && (states(&answer, forces, seen) || states(&other, seen, forces)) {
            v.other += 1;
        } else if differs {
            v.outside.push(format!("fem 300: {off:.2e} of {greatest:.3e} N apart, {both:.1e} said"));
        }
    }
    v
}

/// Writes down at once what went wrong, with its scene.
fn note(plan: &Plan, family: &str, seed: u64, case: &Case, v: &Verdict) {
    let Some(folder) = &plan.out else { return };
    let slow = v.seconds > 10.0;
    if v.wrong.is_empty() && v.refused.is_none() && v.outside.is_empty() && v.private.is_none() && !slow {
        return;
    }
    let _ = std::fs::create_dir_all(folder);
    let name = format!("{}-{seed}.toml", family.replace([' ', ','], "_"));
    let _ = std::fs::write(folder.join(&name), case.scene.to_toml());
    let Ok(mut log) = std::fs::OpenOptions::new().create(true).append(true).open(folder.join("log.txt")) else {
        return;
    };
    for k in 0..plan.relations {
        let changed = relation(&case.scene, (seed as usize + 3 * k) % COUNT);
        if v.wrong.iter().chain(&v.outside).any(|w| w.starts_with(changed.name)) {
            let file = format!("{}-{seed}-{}.toml", family.replace([' ', ','], "_"), changed.name.replace(' ', "_"));
            let _ = std::fs::write(folder.join(file), changed.scene.to_toml());
        }
    }
    let kind = [
        ("WRONG", !v.wrong.is_empty()),
        ("REFUSED", v.refused.is_some()),
        ("OUTSIDE", !v.outside.is_empty()),
        ("SLOW", slow),
    ];
    let kinds: Vec<&str> = kind.iter().filter(|k| k.1).map(|k| k.0).collect();
    let text = [v.wrong.join("; "), v.outside.join("; "), v.refused.clone().unwrap_or_default()].join(" | ");
    let _ = writeln!(log, "{name} [{}] {} {:.1} s: {text}", case.model, kinds.join("+"), v.seconds);
}

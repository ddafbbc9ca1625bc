//! The stability atlas shows what each model does where methods are known to fail.
//!
//! Every regime has an answer that does not come from the model asked: a closed form, a balance, a
//! bound on energy, a wall nothing may enter. A model may be right, may refuse with a typed error,
//! or may say how uncertain it is. Wrong in silence fails the test. The verdicts stand in
//! `docs/charts/stability.csv` and `.md`;
//! `UPDATE_CHARTS=1 cargo test -p cable-tests --test stability_atlas` writes them, without it they
//! are compared.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod motion;
mod rest;
mod slow;

use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use cable_core::scene::{Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::{Solution, WarningKind};
use cable_core::{Error, Model, Settings, Simulation, SolveError};

/// Gravity, m/s².
pub const G: f64 = cable_core::scene::STANDARD_GRAVITY;

/// Height of the centre line of a cable that lies on a floor, m.
pub const ON_FLOOR: f64 = 0.01;

/// The outcome of a model in a regime.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Right, to this relative error.
    Right(f64),
    /// Off by more than a right answer may be, but it says so: error, and what it says.
    Said(f64, f64),
    /// A typed error.
    Refused(&'static str),
    /// Wrong, and does not say so.
    Wrong(f64),
}

impl Verdict {
    /// The word for it in tables.
    fn name(&self) -> String {
        match self {
            Self::Right(_) => "right".to_owned(),
            Self::Said(..) => "says how uncertain".to_owned(),
            Self::Refused(kind) => format!("refuses: {kind}"),
            Self::Wrong(_) => "WRONG".to_owned(),
        }
    }

    /// Of an error that may be `most`, of an answer that may say that it is uncertain.
    pub fn of(error: f64, most: f64, answer: &Solution) -> Self {
        let said = answer.cables[0].error_estimate.unwrap_or(0.0);
        let marked = answer.warnings.iter().any(|w| matches!(w.kind, WarningKind::Accuracy | WarningKind::Stabilised));
        if error <= most {
            Self::Right(error)
        } else if error <= said || marked {
            Self::Said(error, said)
        } else {
            Self::Wrong(error)
        }
    }

    /// Of a typed error.
    pub fn refused(e: &SolveError) -> Self {
        Self::Refused(match e {
            SolveError::NotConverged { .. } => "not converged",
            SolveError::Compressed { .. } => "compressed",
            SolveError::TensionLost { .. } => "tension lost",
            SolveError::Indefinite { .. } => "not stable",
            SolveError::NoRestingPlace { .. } => "no resting place",
            SolveError::Unsupported { .. } => "not supported",
            SolveError::NonFinite { .. } => "not finite",
            SolveError::Buried { .. } => "inside an obstacle",
            SolveError::Setting { .. } => "setting",
            SolveError::TimeStep { .. } => "time step",
            SolveError::StepFailed { .. } => "step failed",
            SolveError::TooMuchWork { .. } => "too much work",
            SolveError::Neither { .. } => "no model",
            SolveError::Unsound { .. } => "not sound",
            _ => "another error",
        })
    }
}

/// A regime: its name, what the figure is, and what a model does in it.
pub struct Regime {
    /// The reason why it is hard.
    pub name: &'static str,
    /// The quantity of the error.
    pub figure: &'static str,
    /// The behaviour of a model there.
    pub judge: fn(Model) -> Result<Verdict, SolveError>,
}

/// A cable alone, see [`catalog::cable_alone`], of 100 elements, slightly damped.
pub fn cable(figures: [f64; 3], supports: Vec<Support>) -> Scene {
    let mut scene = catalog::cable_alone(figures, supports);
    let c = &mut scene.cables[0];
    (c.damping_ratio, c.diameter_m, c.segments) = (0.02, 0.02, Some(100));
    scene
}

/// Five metres on a floor that rubs with μ = 0.5, from one support to another, 40 elements.
pub fn on_a_floor(ea: f64, supports: Vec<Support>) -> Scene {
    let mut scene = cable([5.0, 1.0, ea], supports);
    scene.cables[0].segments = Some(40);
    scene.cables[0].route_m = vec![[0.0, ON_FLOOR], [5.0, ON_FLOOR]];
    scene.obstacles = vec![Obstacle {
        name: "floor".to_owned(),
        shape: Shape::Terrain { points_m: vec![[-5.0, 0.0], [20.0, 0.0]] },
        friction: Some(0.5),
    }];
    scene
}

/// A dead load on an end, N.
pub fn load(name: &str, force_n: [f64; 2]) -> Support {
    Support { force_n: Some(force_n), ..Support::new(name, SupportKind::Load) }
}

/// The simulation of a scene; a scene that is no scene is a fault of the regime.
pub fn simulation(scene: Scene, model: Model) -> Result<Simulation, SolveError> {
    // Hands are thrown about.
    match Simulation::with_settings(scene, model, Settings { hand_speed_m_per_s: 20.0, ..Settings::default() }) {
        Ok(s) => Ok(s),
        Err(Error::Solve(e)) => Err(e),
        Err(e) => panic!("the scene of a regime is refused: {e}"),
    }
}

fn charts() -> PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/charts")
}

/// Regime and model of each row of a table, and how good its verdict is. Its figures are left out:
/// they differ in the last digits from machine to machine.
fn ranks(csv: &str) -> Vec<(String, u8)> {
    let rank = |verdict: &str| match verdict {
        "right" => 3,
        "says how uncertain" => 2,
        v if v.starts_with("refuses") => 1,
        _ => 0,
    };
    let row = |l: &str| {
        let cells: Vec<&str> = l.splitn(4, ',').collect();
        (cells[..2].join(", "), rank(cells[2]))
    };
    csv.lines().skip(1).map(row).collect()
}

/// Returns what every model does in every regime, by regime; each thread takes the next one that
/// nobody has begun.
fn verdicts(regimes: &[Regime]) -> Vec<Vec<Verdict>> {
    let jobs: Vec<(usize, Model)> = (0..regimes.len()).flat_map(|r| Model::SOLVERS.map(|m| (r, m))).collect();
    let (next, done) = (AtomicUsize::new(0), Mutex::new(vec![Vec::new(); regimes.len()]));
    let work = || {
        while let Some(&(r, model)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let verdict = (regimes[r].judge)(model).unwrap_or_else(|e| Verdict::refused(&e));
            done.lock().unwrap()[r].push((model, verdict));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    std::thread::scope(|s| (0..threads).for_each(|_| drop(s.spawn(work))));
    let of = |found: &Vec<(Model, Verdict)>, m: Model| found.iter().find(|f| f.0 == m).unwrap().1.clone();
    let done = done.into_inner().unwrap();
    done.iter().map(|found| Model::SOLVERS.map(|m| of(found, m)).to_vec()).collect()
}

#[test]
fn no_model_is_wrong_in_silence() {
    let regimes: Vec<Regime> = rest::regimes().into_iter().chain(slow::regimes()).chain(motion::regimes()).collect();
    let mut csv = "regime,model,verdict,error,said,figure\n".to_owned();
    let mut table = "# Stability atlas\n\nWhere methods are known to fail, and what each model does there. Written by `UPDATE_CHARTS=1 cargo test -p cable-tests --test stability_atlas`,\nwhich fails where a model is wrong without saying so. Figures are relative errors of what the last column names.\n\n| regime | catenary | spans | fem | mass-spring | figure |\n|---|---|---|---|---|---|\n".to_owned();
    let mut wrong = Vec::new();
    for (r, found) in regimes.iter().zip(verdicts(&regimes)) {
        let _ = write!(table, "| {} |", r.name);
        for (model, verdict) in Model::SOLVERS.into_iter().zip(found) {
            let (error, said) = match verdict {
                Verdict::Right(e) | Verdict::Wrong(e) => (format!("{e:.1e}"), String::new()),
                Verdict::Said(e, said) => (format!("{e:.1e}"), format!("{said:.1e}")),
                Verdict::Refused(_) => (String::new(), String::new()),
            };
            println!("{}, {model}: {} {error} {said}", r.name, verdict.name());
            let _ = writeln!(csv, "{},{model},{},{error},{said},{}", r.name, verdict.name(), r.figure);
            let _ = match &verdict {
                Verdict::Said(..) => write!(table, " {} ({error}, says {said}) |", verdict.name()),
                Verdict::Refused(_) => write!(table, " {} |", verdict.name()),
                _ => write!(table, " {} ({error}) |", verdict.name()),
            };
            if matches!(verdict, Verdict::Wrong(_)) || error == "NaN" {
                wrong.push(format!("{}: {model} is off by {error}", r.name));
            }
        }
        let _ = writeln!(table, " {} |", r.figure);
    }
    if std::env::var_os("UPDATE_CHARTS").is_some() {
        std::fs::create_dir_all(charts()).unwrap();
        std::fs::write(charts().join("stability.csv"), &csv).unwrap();
        std::fs::write(charts().join("stability.md"), &table).unwrap();
    }
    assert!(wrong.is_empty(), "wrong in silence:\n{}", wrong.join("\n"));
    let kept = std::fs::read_to_string(charts().join("stability.csv")).expect("docs/charts/stability.csv");
    let (kept, now) = (ranks(&kept), ranks(&csv));
    assert!(kept.iter().map(|r| &r.0).eq(now.iter().map(|r| &r.0)), "other regimes than the table: UPDATE_CHARTS=1");
    for ((case, before), (_, rank)) in kept.iter().zip(&now) {
        assert!(rank >= before, "{case}: worse than docs/charts/stability.csv says");
        if rank > before {
            println!("{case}: better than docs/charts/stability.csv says, UPDATE_CHARTS=1 writes it");
        }
    }
}

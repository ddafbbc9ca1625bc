//! `cable solve`, `cable check` and `cable schema`.

use std::path::Path;
use std::time::Instant;

use cable_core::model::Settings;
use cable_core::{Model, Scene, Simulation, SolveError, files};

use crate::Done;
use crate::answer::{NoAnswer, answer};
use crate::args::{Common, SolveArguments};
use crate::output::{Failure, Printer};
use crate::table::table;

/// Reads and validates a scene.
pub fn read_scene(path: &Path) -> Result<Scene, Failure> {
    files::load_scene(path).map_err(Failure::File)
}

/// The scene, with what arguments say of it.
pub fn asked_scene(a: &Common) -> Result<Scene, Failure> {
    let mut scene = read_scene(&a.scene)?;
    if let Some(mobilised) = a.mobilised {
        scene.cables.iter_mut().for_each(|cable| cable.friction_mobilised = mobilised);
    }
    Ok(scene)
}

/// The settings that arguments ask for.
pub fn settings(a: &Common) -> Settings {
    Settings { tolerance: a.tolerance, ..Settings::default() }
}

/// Says, in JSON, that there is no answer; hands back the failure.
pub fn no_answer(to: &mut Printer, model: Model, reason: &str, time_s: Option<f64>, error: &SolveError) -> Done {
    let error = error.to_string();
    to.json(&NoAnswer { time_s, model: model.name(), reason, converged: false, error })?;
    to.flush()
}

/// Finds where everything rests.
pub fn solve(a: &SolveArguments) -> Done {
    let a = &a.common;
    let scene = asked_scene(a)?;
    let mut out = Printer::new();
    let began = Instant::now();
    let built = Simulation::with_settings(scene, a.model, settings(a));
    let solved = built.and_then(|mut s| s.settle().map_err(Into::into));
    let wall_time_s = began.elapsed().as_secs_f64();
    match solved {
        Ok(solution) => {
            let printable = answer(&solution, wall_time_s, None).map_err(Failure::NonFinite)?;
            if a.json {
                out.json(&printable)?;
            } else {
                out.line(table(&solution).trim_end())?;
            }
            out.flush()
        }
        Err(e) => {
            if let (true, cable_core::Error::Solve(e)) = (a.json, &e) {
                no_answer(&mut out, a.model, "no answer", None, e)?;
            }
            Err(Failure::from_core(&a.scene, e))
        }
    }
}

/// Says whether a scene can be solved.
pub fn check(path: &Path) -> Done {
    let scene = read_scene(path)?;
    let mut out = Printer::new();
    let count = |n: usize, one: &str, many: &str| format!("{n} {}", if n == 1 { one } else { many });
    out.line(&format!(
        "{}: sound, {}, {}, {}",
        path.display(),
        count(scene.cables.len(), "cable", "cables"),
        count(scene.obstacles.len(), "obstacle", "obstacles"),
        count(scene.loads.len(), "load", "loads"),
    ))?;
    out.flush()
}

/// Prints the JSON Schema of a scene file.
pub fn schema() -> Done {
    let mut out = Printer::new();
    out.line(&format!("{:#}", Scene::json_schema()))?;
    out.flush()
}

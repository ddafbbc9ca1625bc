//! This program measures how the errors of motions decrease with finer meshes and shorter steps. It
//! runs each motion of [`cable_benches::motion`] on a series of meshes with the shortest step, and
//! with a series of steps on the finest mesh, and writes `docs/convergence.md`.
//!
//! Run from the root of the repository: `cargo run --release -p cable-benches --bin convergence`;
//! `-- swing fold` takes some motions and prints their tables without writing them.

use std::error::Error;
use std::fmt::Write as _;

use cable_benches::machine::measured_now;
use cable_benches::motion::{Measured, Motion, motions};
use cable_core::{Model, Vec2};

const FILE: &str = "docs/convergence.md";

/// The series of steps, s. `mass-spring` takes its own steps within them, see [`STABLE_FRACTIONS`].
const STEPS: [f64; 5] = [1.0 / 120.0, 1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0, 1.0 / 1920.0];

/// The series of sub-steps of `mass-spring`, as fractions of the longest stable sub-step of its
/// mesh; the first is the one that the simulator uses.
const STABLE_FRACTIONS: [f64; 4] = [0.8, 0.4, 0.2, 0.1];

/// The series of sub-steps uses the finest mesh on which a run took at most this long, s: the
/// shortest sub-steps take 16 times as long.
const LONGEST_OF_LADDER_S: f64 = 2.0;

/// A mesh is not tried if the one before took longer than this, s.
const LONGEST_S: f64 = 20.0;

/// A line of a table: its name, the error and what it cost.
struct Line {
    name: String,
    /// Ratio of the mesh or step of the line before to that of this line.
    finer: f64,
    run: Result<Measured, String>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let mut tables = String::new();
    for motion in motions().iter().filter(|m| asked.is_empty() || asked.iter().any(|a| a == m.id)) {
        let table = measured(motion)?;
        print!("{table}");
        tables.push_str(&table);
    }
    if asked.is_empty() {
        std::fs::write(FILE, format!("{HEAD}\n{}\n{tables}", measured_now()))?;
    }
    Ok(())
}

const HEAD: &str = "# How errors of motions fall

`cargo run --release -p cable-benches --bin convergence` makes this page. Each motion is followed on a ladder of meshes with the shortest step, and of steps on the
finest mesh, where the error is of the step alone: against half of the shortest. Elsewhere it is that of the figure named, relative to what it should be; the order is the exponent by which it fell
from the line before. `mass-spring` takes steps of its own, 0.8 of the longest that its mesh is stable with; its ladder of steps is of parts of that, on the finest mesh that takes
at most 2 s, against half of the shortest. Times are of the motion alone, on one core, each measured once.
";

fn measured(motion: &Motion) -> Result<String, Box<dyn Error>> {
    let finest = motion.meshes.last().copied().ok_or("a motion without meshes")?;
    let step = STEPS[STEPS.len() - 1];
    let exact = match motion.exact {
        Some(exact) => exact(),
        None => extrapolated(motion, finest, step)?,
    };
    let mut text = format!("\n## {}\n\n{}.\n", motion.id, motion.about);
    let scale = exact.norm();
    let _ = match motion.exact {
        Some(_) => writeln!(text, "It should be {:.6}.", exact.x + exact.y),
        None => {
            writeln!(text, "It should be ({:.6}, {:.6}): the finest runs of `fem`, extrapolated.", exact.x, exact.y)
        }
    };
    for model in [Model::Fem, Model::MassSpring] {
        let by = |elements: usize, step_s: f64| motion.measure(model, elements, step_s).map_err(|e| e.to_string());
        let coarser = |k: usize| k.checked_sub(1).map_or(1.0, |j| motion.meshes[k] as f64 / motion.meshes[j] as f64);
        let mut lines: Vec<Line> = Vec::new();
        for (k, &n) in motion.meshes.iter().enumerate() {
            let slow = lines.iter().any(|l| l.run.as_ref().is_ok_and(|run| run.spent.seconds() > LONGEST_S));
            let run = if slow { Err("not tried: it would take minutes".to_owned()) } else { by(n, step) };
            lines.push(Line { name: n.to_string(), finer: coarser(k), run });
        }
        table(&mut text, &format!("`{model}`, elements"), &lines, (exact, scale));
        if model == Model::Fem {
            let line = |(k, &h): (usize, &f64)| Line {
                name: format!("1/{:.0} s", 1.0 / h),
                finer: k.checked_sub(1).map_or(1.0, |j| STEPS[j] / h),
                run: by(finest, h),
            };
            let lines: Vec<Line> = STEPS.iter().enumerate().map(line).collect();
            // The error of the step alone is the difference from half the shortest step on the same
            // mesh.
            if let Ok(limit) = by(finest, 0.5 * step) {
                table(&mut text, &format!("`{model}`, steps"), &lines, (limit.figure, scale));
            }
        } else {
            sub_steps(&mut text, motion, &lines, scale);
        }
    }
    Ok(text)
}

/// Appends the series of sub-steps of `mass-spring`, if its runs on the given meshes of the motion
/// were quick enough.
fn sub_steps(text: &mut String, motion: &Motion, meshes: &[Line], scale: f64) {
    let quick = |line: &Line| line.run.as_ref().is_ok_and(|run| run.spent.seconds() <= LONGEST_OF_LADDER_S);
    let Some(&mesh) = meshes.iter().rposition(quick).and_then(|k| motion.meshes.get(k)) else { return };
    let step = STEPS[STEPS.len() - 1];
    let by = |fraction: f64| motion.measure_in_sub_steps(mesh, step, fraction).map_err(|e| e.to_string());
    let lines = STABLE_FRACTIONS.iter().enumerate().map(|(k, &fraction)| Line {
        name: format!("{fraction} of the stable"),
        finer: k.checked_sub(1).map_or(1.0, |j| STABLE_FRACTIONS[j] / fraction),
        run: by(fraction),
    });
    let lines: Vec<Line> = lines.collect();
    if let Ok(limit) = by(0.5 * STABLE_FRACTIONS[STABLE_FRACTIONS.len() - 1]) {
        table(text, &format!("`mass-spring`, sub-steps on {mesh} elements"), &lines, (limit.figure, scale));
    }
}

/// The figure extrapolated to zero mesh size and step, with both errors taken to be of the second
/// order.
fn extrapolated(motion: &Motion, finest: usize, step: f64) -> Result<Vec2, Box<dyn Error>> {
    let at = |elements: usize, step_s: f64| motion.measure(Model::Fem, elements, step_s).map(|m| m.figure);
    let fine = at(finest, step)?;
    let [mesh, steps] = [at(finest / 2, step)?, at(finest, 2.0 * step)?];
    Ok(fine + (fine - mesh) / 3.0 + (fine - steps) / 3.0)
}

fn table(text: &mut String, what: &str, lines: &[Line], (exact, scale): (Vec2, f64)) {
    let _ = writeln!(text, "\n| {what} | figure | error | order | time (ms) |\n|---|---|---|---|---|");
    let mut before = None;
    for line in lines {
        match &line.run {
            Ok(run) => {
                let error = (run.figure - exact).norm() / scale;
                let order = before
                    .map_or_else(String::new, |last: f64| format!("{:.2}", (last / error).ln() / line.finer.ln()));
                let second = if run.figure.y == 0.0 { String::new() } else { format!(", {:.6}", run.figure.y) };
                let [name, time] = [line.name.clone(), format!("{:.1}", 1e3 * run.spent.seconds())];
                let _ = writeln!(text, "| {name} | {:.6}{second} | {error:.1e} | {order} | {time} |", run.figure.x);
                before = Some(error);
            }
            Err(why) => {
                let _ = writeln!(text, "| {} | {why} | | | |", line.name);
                before = None;
            }
        }
    }
}

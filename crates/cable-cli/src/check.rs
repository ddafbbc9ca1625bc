//! The command `cable check` says whether a scene can be solved, and whether the folder of a run is
//! complete, without solving anything.

use std::path::Path;

use cable_core::files;

use crate::CommandResult;
use crate::failure::CommandFailure;
use crate::input::read_scene;
use crate::output::Printer;

/// Largest table of a run that is checked, bytes. More would not fit into the memory of a small
/// machine.
const MAX_TABLE_BYTES: u64 = 2 << 30;

/// Reports whether a scene can be solved, or how far a run came.
pub fn check(path: &Path) -> CommandResult {
    if files::is_run(path) {
        return check_run(path);
    }
    let scene = read_scene(path)?;
    let notes = cable_core::problem::check(&scene).map_err(|e| CommandFailure::from_core(path, e.into()))?;
    let mut out = Printer::new();
    let count = |n: usize, one: &str, many: &str| format!("{n} {}", if n == 1 { one } else { many });
    out.line(&format!(
        "{}: valid, {}, {}, {}",
        path.display(),
        count(scene.cables.len(), "cable", "cables"),
        count(scene.obstacles.len(), "obstacle", "obstacles"),
        count(scene.loads.len(), "load", "loads"),
    ))?;
    for note in notes {
        out.line(&format!("Note: {note}"))?;
    }
    out.flush()
}

/// Reports how far the run in a folder came, and which part of its tables was ignored.
fn check_run(path: &Path) -> CommandResult {
    let run = files::load_run(path, MAX_TABLE_BYTES).map_err(CommandFailure::File)?;
    let kind = match run.is_complete() {
        Some(true) => "a complete run",
        Some(false) => "a partial run",
        None => "a run that does not say whether it is complete",
    };
    let history = &run.tables.history;
    let mut out = Printer::new();
    out.line(&format!(
        "{}: {kind}, {} instants to {} s, {} rows of nodes, {} events",
        path.display(),
        history.time_s.len(),
        history.time_s.last().copied().unwrap_or(0.0),
        run.tables.nodes.len(),
        run.tables.events.len(),
    ))?;
    for remark in run.remarks() {
        out.line(&format!("{remark}."))?;
    }
    out.flush()
}

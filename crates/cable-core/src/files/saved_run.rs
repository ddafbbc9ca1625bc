//! Runs as they are read from their folders.

use std::io;
use std::path::Path;

use super::run_folder::{MANIFEST_NAME, SCENE_NAME, TABLE_NAMES, is_plain_file, read_manifest, successor};
use super::{FileError, load_scene, read_limited};
use crate::record::{LeftOut, Manifest, RunStatus, RunStop, RunTables, read_run};
use crate::scene::Scene;

/// Remarks for the reader of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum RunRemark {
    /// It did not come to its end.
    Partial {
        /// Time of its last instant, s; None: it has none.
        reached_s: Option<f64>,
        /// The reason why it stopped, if it said so: else it was cut off, or is still being
        /// written.
        stop: Option<RunStop>,
    },
    /// Part of a table was not read.
    LeftOut(LeftOut),
}

/// A run as it lies in a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedRun {
    /// Its scene.
    pub scene: Scene,
    /// Its manifest; None for a run of a version before there was such a file.
    pub manifest: Option<Manifest>,
    /// Its tables.
    pub tables: RunTables,
}

impl SavedRun {
    /// Returns whether it came to its end; None where it does not say.
    #[must_use]
    pub fn is_complete(&self) -> Option<bool> {
        self.manifest.as_ref().map(|m| m.status == RunStatus::Complete)
    }

    /// Returns what its reader should know: that it is partial, and what was left out of its
    /// tables.
    #[must_use]
    pub fn remarks(&self) -> Vec<RunRemark> {
        let partial = (self.is_complete() == Some(false)).then(|| RunRemark::Partial {
            reached_s: self.tables.history.time_s.last().copied(),
            stop: self.manifest.as_ref().and_then(|m| m.ended.clone()),
        });
        partial.into_iter().chain(self.tables.left_out.iter().cloned().map(RunRemark::LeftOut)).collect()
    }
}

/// Reads a run folder, whole or partial, up to the last instant that is whole in all its tables. No
/// table may have more than `limit_bytes`.
///
/// # Errors An error names the missing or broken part and its place.
pub fn load_run(folder: impl AsRef<Path>, limit_bytes: u64) -> Result<SavedRun, FileError> {
    let folder = folder.as_ref();
    let manifest = read_manifest(folder);
    // If a newer run has replaced the old one only in part, its remaining files are still in the
    // folder from which they are moved.
    let from = manifest.as_ref().and_then(|m| successor(folder, m));
    let place =
        |name: &str| from.iter().map(|f| f.join(name)).find(|p| p.exists()).unwrap_or_else(|| folder.join(name));
    let manifest = from.as_deref().and_then(read_manifest).or(manifest);
    let scene = load_scene(place(SCENE_NAME))?;
    let read = |name: &str| match read_limited(place(name), limit_bytes) {
        // A run that ended before its first instant.
        Err(FileError::Read { kind: io::ErrorKind::NotFound, .. }) if manifest.is_some() => Ok(Vec::new()),
        other => other,
    };
    // In this order: the run may go on while it is read.
    let [history, nodes, events] = TABLE_NAMES;
    let (history, nodes, events) = (read(history)?, read(nodes)?, read(events)?);
    let tables = read_run(history.as_slice(), nodes.as_slice(), events.as_slice())
        .map_err(|fault| FileError::Table { path: folder.display().to_string(), fault: Box::new(fault) })?;
    Ok(SavedRun { scene, manifest, tables })
}

/// Returns whether a folder looks like that of a run: what [`load_run`] can be asked to read.
#[must_use]
pub fn is_run(folder: impl AsRef<Path>) -> bool {
    let folder = folder.as_ref();
    let [history, ..] = TABLE_NAMES;
    is_plain_file(&folder.join(MANIFEST_NAME)) || is_plain_file(&folder.join(history))
}

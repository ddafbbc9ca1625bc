//! The folder into which a run is written.
//!
//! | room | content |
//! |---|---|
//! | `file_names.rs` | file names of a run: manifest, scene, tables, lock |
//! | `table_file.rs` | one table on the disk: header, appended rows, rewind when rows do not fit |
//! | `atomic_write.rs` | writing a whole file atomically: temporary file, sync, rename |
//! | `lock.rs` | file lock that lets one run at a time write into a folder |
//! | `ownership.rs` | manifest and file hashes checked: foreign or changed files are not touched |
//! | `replacement.rs` | a complete run put in the place of an earlier one, resumable after a stop |

mod atomic_write;
mod file_names;
mod lock;
mod ownership;
mod replacement;
mod table_file;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use self::atomic_write::{put, remove_files};
use self::file_names::RUN_FILES;
use self::lock::lock;
use self::ownership::{check_own, has_instant, look};
use self::replacement::{new_unfinished, remove_unfinished, replace_if_begun};
use self::table_file::TableFile;
use super::{FileError, RunFolderFault};
use crate::record::{
    FileRecord, Fingerprint, Manifest, NodeChoice, RobotColumns, RunRequest, RunStatus, RunStop, RunWriter, WriteError,
};
use crate::scene::Scene;
use crate::solution::Solution;

pub(super) use self::atomic_write::is_plain_file;
pub(super) use self::file_names::{MANIFEST_NAME, SCENE_NAME, TABLE_NAMES};
pub(super) use self::ownership::read_manifest;
pub(super) use self::replacement::successor;

/// The end of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RunEnd {
    /// With everything that was asked.
    Complete,
    /// Before, for a reason.
    Partial(RunStop),
}

/// A run folder that is being written. What it holds is readable at any moment, and marked as
/// partial until [`Self::finish`] says otherwise.
///
/// Three rules keep what was there before. Every file is made new in a folder that was new, empty
/// or a run's; nothing is opened to be overwritten, so nothing is followed. Where the folder holds
/// a run already, the new one is written into a folder `unfinished-N` in it, and takes its place
/// only when it is complete. And a lock is held, which the system lets go of however the process
/// ends.
pub struct RunFolder {
    folder: PathBuf,
    /// The folder into which the files are written: the run's, or `unfinished-N` in it.
    place: PathBuf,
    manifest: Manifest,
    node_choice: NodeChoice,
    writer: Option<RunWriter<TableFile>>,
    _locks: Vec<fs::File>,
}

impl std::fmt::Debug for RunFolder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RunFolder").field("folder", &self.folder).field("place", &self.place).finish_non_exhaustive()
    }
}

impl RunFolder {
    /// Begins a run in a folder that is new, empty, or a run's own (those above it are made):
    /// writes its scene and that it is partial.
    ///
    /// # Errors
    /// The reason why the folder takes no run, or a file in it cannot be made.
    pub fn create(
        folder: impl AsRef<Path>,
        scene: &Scene,
        request: RunRequest,
        node_choice: NodeChoice,
    ) -> Result<Self, FileError> {
        // Without a slash at its end, which would follow a link.
        let folder: PathBuf = folder.as_ref().components().collect();
        make_folder(&folder)?;
        // Looked at before, so that nothing is laid into a folder that takes no run; and again with
        // the lock.
        look(&folder)?;
        let mut locks = Vec::from_iter(lock(&folder)?);
        let mut place = folder.clone();
        if let Some(manifest) = look(&folder)? {
            let manifest = replace_if_begun(&folder, manifest)?;
            check_own(&folder, &manifest)?;
            if has_instant(&folder) {
                place = new_unfinished(&folder)?;
                locks.extend(lock(&place)?);
            } else {
                remove_files(&folder, &RUN_FILES)?;
            }
        }
        let text = scene.to_toml();
        let mut hash = Fingerprint::default();
        hash.bytes(text.as_bytes());
        let manifest = Manifest::new(request, node_choice, FileRecord::new(SCENE_NAME, text.len() as u64, hash));
        // First that the folder is a run's: a run that dies before its scene is there can be begun
        // again.
        put(&place, MANIFEST_NAME, manifest.to_toml().as_bytes())?;
        put(&place, SCENE_NAME, text.as_bytes())?;
        Ok(Self { folder, place, manifest, node_choice, writer: None, _locks: locks })
    }

    /// Returns where its files are for now: the folder asked for, or one in it while that holds an
    /// earlier run.
    #[must_use]
    pub fn place(&self) -> &Path {
        &self.place
    }

    /// Appends an instant to the tables, whole or not at all.
    ///
    /// # Errors An error is returned if a number is not finite or the disk refuses; the tables are
    /// then unchanged.
    pub fn push(&mut self, solution: &Solution) -> Result<(), WriteError> {
        self.append(solution, RunWriter::push)
    }

    /// As [`Self::push`], for the last instant ([`RunWriter::push_last`]).
    ///
    /// # Errors
    /// As [`Self::push`].
    pub fn push_last(&mut self, solution: &Solution) -> Result<(), WriteError> {
        self.append(solution, RunWriter::push_last)
    }

    /// Notes that answers of the run took so long, s, beside what was noted before; what is no time
    /// is left out.
    pub fn add_wall_time(&mut self, wall_s: f64) {
        if wall_s.is_finite() && wall_s >= 0.0 {
            self.manifest.wall_time_s = Some(self.manifest.wall_time_s.unwrap_or(0.0) + wall_s);
        }
    }

    /// Makes the tables, with headers alone ([`RunWriter::begin`]).
    ///
    /// # Errors
    /// As [`Self::push`].
    pub fn begin(&mut self, scene: &Scene, robot: RobotColumns) -> Result<(), WriteError> {
        self.write(|writer| writer.begin(scene, robot))
    }

    /// Writes an instant, and notes in the manifest its time and the model that solved it.
    fn append(
        &mut self,
        solution: &Solution,
        push: impl FnOnce(&mut RunWriter<TableFile>, &Solution) -> Result<(), WriteError>,
    ) -> Result<(), WriteError> {
        self.write(|writer| push(writer, solution))?;
        self.manifest.reached_s = Some(solution.time_s);
        let model = solution.model.name();
        if !solution.model.is_automatic() && !self.manifest.solved_by.iter().any(|known| known == model) {
            self.manifest.solved_by.push(model.to_owned());
        }
        Ok(())
    }

    /// Writes to the tables, which are made if need be; if that fails they are as before.
    fn write(
        &mut self,
        write: impl FnOnce(&mut RunWriter<TableFile>) -> Result<(), WriteError>,
    ) -> Result<(), WriteError> {
        let writer = match &mut self.writer {
            Some(writer) => writer,
            none => {
                let [history, nodes, events] = TABLE_NAMES.map(|name| TableFile::new(self.place.join(name)));
                none.insert(RunWriter::new(history, nodes, events).with_nodes(self.node_choice))
            }
        };
        let marks = writer.places().map(|table| table.mark());
        write(writer).inspect_err(|_| {
            for (table, mark) in writer.places().into_iter().zip(marks) {
                table.rewind(mark);
            }
        })
    }

    /// Ends the run. One that is complete takes the place of an earlier one in its folder, and of
    /// those that were not finished there. Where the run lies then.
    ///
    /// # Errors An error names the part that could not be written, or the reason why an earlier run
    /// was not replaced. The written part stays readable, and is marked as partial if the end of a
    /// complete run could not be noted.
    pub fn finish(mut self, end: RunEnd) -> Result<PathBuf, FileError> {
        if let Some(writer) = &mut self.writer {
            for (table, name) in writer.places().into_iter().zip(TABLE_NAMES) {
                table.sync().map_err(|e| FileError::write(&self.place.join(name), &e))?;
                let (bytes, hash) = table.written();
                self.manifest.files.push(FileRecord::new(name, bytes, hash));
            }
        }
        match end {
            RunEnd::Complete => self.manifest.status = RunStatus::Complete,
            RunEnd::Partial(why) => self.manifest.ended = Some(why),
        }
        put(&self.place, MANIFEST_NAME, self.manifest.to_toml().as_bytes())?;
        if self.manifest.status != RunStatus::Complete || self.place == self.folder {
            return Ok(self.place);
        }
        // Open files cannot be renamed everywhere.
        self.writer = None;
        let Some(earlier) = look(&self.folder)? else { return Ok(self.place) };
        check_own(&self.folder, &earlier)?;
        let successor = self.place.file_name().map(|name| name.to_string_lossy().into_owned());
        let earlier = Manifest { status: RunStatus::Replacing, successor, ..earlier };
        put(&self.folder, MANIFEST_NAME, earlier.to_toml().as_bytes())?;
        replace_if_begun(&self.folder, earlier)?;
        remove_unfinished(&self.folder);
        Ok(self.folder)
    }
}

/// Makes a folder and those above it, unless it is there.
fn make_folder(folder: &Path) -> Result<(), FileError> {
    match fs::symlink_metadata(folder) {
        Ok(about) if about.is_symlink() => Err(FileError::folder(folder, RunFolderFault::Link)),
        Ok(about) if !about.is_dir() => Err(FileError::folder(folder, RunFolderFault::NotAFolder)),
        Ok(_) => Ok(()),
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            fs::create_dir_all(folder).map_err(|e| FileError::write(folder, &e))
        }
        Err(e) => Err(FileError::write(folder, &e)),
    }
}

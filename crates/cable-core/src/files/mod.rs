//! Nothing else in the core touches the file system: files are read with a limit, and saved so that
//! at every moment either the old file or the new one is whole.
//!
//! | room | content |
//! |---|---|
//! | `run_folder/` | writing a run: tables that grow instant by instant, lock, replacement |
//! | `saved_run.rs` | reading a run folder, whole or partial, with remarks on what is missing |

mod run_folder;
mod saved_run;

use std::fs;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

use atomic_write_file::AtomicWriteFile;

use crate::error::SceneError;
use crate::record::ReadError;
use crate::scene::Scene;
use crate::scene::read::file::MAX_TEXT_BYTES;

pub use self::run_folder::{RunEnd, RunFolder};
pub use self::saved_run::{RunRemark, SavedRun, is_run, load_run};

/// The reason why a file could not be read or written. The data in memory is untouched, and so is
/// the old file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FileError {
    /// It cannot be opened or read.
    Read {
        /// The file.
        path: String,
        /// The system's kind of failure.
        kind: io::ErrorKind,
        /// The system's own words.
        reason: String,
    },
    /// It is a folder or a device.
    NotAFile {
        /// Its name.
        path: String,
    },
    /// It is larger than what is asked for can be.
    TooLarge {
        /// The file.
        path: String,
        /// The limit, bytes.
        limit_bytes: u64,
    },
    /// Its content is not a scene that can be solved.
    Scene {
        /// The file.
        path: String,
        /// The fault.
        fault: Box<SceneError>,
    },
    /// Its content is not a table of a run.
    Table {
        /// The folder.
        path: String,
        /// The fault, and in which table.
        fault: Box<ReadError>,
    },
    /// No run may be written there.
    RunFolder {
        /// The folder.
        path: String,
        /// The reason why it is not.
        fault: RunFolderFault,
    },
    /// It cannot be written.
    Write {
        /// The file.
        path: String,
        /// The system's kind of failure.
        kind: io::ErrorKind,
        /// The system's own words.
        reason: String,
    },
}

/// The reason why a folder takes no run. Nothing in it was touched.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RunFolderFault {
    /// It is no run's.
    Foreign {
        /// One of the things in it.
        found: String,
    },
    /// A symbolic link, which might lead anywhere.
    Link,
    /// A file, a device, a pipe.
    NotAFolder,
    /// In the place of a file of the run there is something else.
    NotAFile {
        /// Its name.
        name: String,
    },
    /// A file of the run is not as the run wrote it.
    Changed {
        /// The file.
        name: String,
    },
    /// A run is being written there.
    InUse,
    /// There are as many unfinished runs in it as have numbers.
    Full {
        /// Their number.
        count: usize,
    },
}

impl FileError {
    /// Returns whether something could not be written, not read.
    #[must_use]
    pub fn is_of_writing(&self) -> bool {
        matches!(self, Self::Write { .. } | Self::RunFolder { .. })
    }

    fn folder(path: &Path, fault: RunFolderFault) -> Self {
        Self::RunFolder { path: path.display().to_string(), fault }
    }

    fn read(path: &Path, e: &io::Error) -> Self {
        Self::Read { path: path.display().to_string(), kind: e.kind(), reason: e.to_string() }
    }

    fn write(path: &Path, e: &io::Error) -> Self {
        Self::Write { path: path.display().to_string(), kind: e.kind(), reason: e.to_string() }
    }
}

/// Reads and validates a scene file.
///
/// # Errors
/// The reason why it cannot be read, or what is wrong with the scene.
pub fn load_scene(path: impl AsRef<Path>) -> Result<Scene, FileError> {
    let path = path.as_ref();
    // Three bytes more for a byte order mark.
    let bytes = read_limited(path, MAX_TEXT_BYTES as u64 + 3)?;
    Scene::from_toml_bytes(&bytes)
        .map_err(|fault| FileError::Scene { path: path.display().to_string(), fault: Box::new(fault) })
}

/// Saves a scene: whole or not at all. Comments of a file it replaces are lost.
///
/// # Errors
/// The reason why it cannot be written; the old file is then as it was.
pub fn save_scene(path: impl AsRef<Path>, scene: &Scene) -> Result<(), FileError> {
    write_atomic(path, scene.to_toml().as_bytes())
}

/// Reads a whole file of at most `limit_bytes`, and no byte more of a larger one.
///
/// # Errors
/// The reason why it cannot be read.
pub fn read_limited(path: impl AsRef<Path>, limit_bytes: u64) -> Result<Vec<u8>, FileError> {
    let path = path.as_ref();
    // Asked before opening: opening a pipe would wait for its other end.
    let about = fs::metadata(path).map_err(|e| FileError::read(path, &e))?;
    if !about.is_file() {
        return Err(FileError::NotAFile { path: path.display().to_string() });
    }
    let too_large = || FileError::TooLarge { path: path.display().to_string(), limit_bytes };
    if about.len() > limit_bytes {
        return Err(too_large());
    }
    let file = fs::File::open(path).map_err(|e| FileError::read(path, &e))?;
    let mut bytes = Vec::new();
    file.take(limit_bytes + 1).read_to_end(&mut bytes).map_err(|e| FileError::read(path, &e))?;
    if bytes.len() as u64 > limit_bytes { Err(too_large()) } else { Ok(bytes) }
}

/// Writes a whole file: into a temporary file beside it, flushed to the disk, then renamed over it.
///
/// # Errors
/// The reason why it cannot be written; the old file is then as it was.
pub fn write_atomic(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), FileError> {
    write_atomic_with(path, |out| out.write_all(bytes))
}

/// As [`write_atomic`], for what is too large to hold in memory: `fill` writes into a buffer before
/// the file.
///
/// # Errors
/// The reason why it cannot be written, or what `fill` met; the old file is then as it was.
pub fn write_atomic_with(
    path: impl AsRef<Path>,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), FileError> {
    let path = path.as_ref();
    let write = || -> io::Result<()> {
        let mut out = BufWriter::new(AtomicWriteFile::open(path)?);
        fill(&mut out)?;
        // A buffer dropped unflushed would lose its error.
        out.into_inner().map_err(io::IntoInnerError::into_error)?.commit()
    };
    write().map_err(|e| FileError::write(path, &e))
}

/// Removes a file. One that is not there is removed already.
///
/// # Errors
/// The reason why it cannot be removed.
pub fn remove(path: impl AsRef<Path>) -> Result<(), FileError> {
    let path = path.as_ref();
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(FileError::write(path, &e)),
        _ => Ok(()),
    }
}

/// Makes a folder and those above it, for a run.
///
/// # Errors
/// The reason why it cannot be made.
pub fn create_folder(path: impl AsRef<Path>) -> Result<(), FileError> {
    let path = path.as_ref();
    fs::create_dir_all(path).map_err(|e| FileError::write(path, &e))
}

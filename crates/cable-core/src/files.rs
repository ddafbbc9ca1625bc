//! The only file of the core that touches the file system: reading with a limit, saving without a moment in
//! which neither the old file nor the new one is whole.

use std::fs;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

use atomic_write_file::AtomicWriteFile;
use thiserror::Error;

use crate::error::SceneError;
use crate::record::RunWriter;
use crate::scene::Scene;
use crate::scene::file::MAX_TEXT_BYTES;

/// Why a file could not be read or written. The data in memory is untouched, and so is the old file.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FileError {
    /// It cannot be opened or read.
    #[error("cannot read {path}: {reason}")]
    Read {
        /// The file.
        path: String,
        /// The system's kind of failure.
        kind: io::ErrorKind,
        /// The system's own words.
        reason: String,
    },
    /// It is a folder or a device.
    #[error("cannot read {path}: it is not a file")]
    NotAFile {
        /// What it is called.
        path: String,
    },
    /// It is larger than what is asked for can be.
    #[error("cannot read {path}: it has more than the {limit_bytes} bytes allowed")]
    TooLarge {
        /// The file.
        path: String,
        /// The limit, bytes.
        limit_bytes: u64,
    },
    /// What it holds is not a scene that can be solved.
    #[error("{path}: {fault}")]
    Scene {
        /// The file.
        path: String,
        /// What is wrong.
        fault: Box<SceneError>,
    },
    /// It cannot be written.
    #[error("cannot write {path}: {reason}")]
    Write {
        /// The file.
        path: String,
        /// The system's kind of failure.
        kind: io::ErrorKind,
        /// The system's own words.
        reason: String,
    },
}

impl FileError {
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
/// Why it cannot be read, or what is wrong with the scene.
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
/// Why it cannot be written; the old file is then as it was.
pub fn save_scene(path: impl AsRef<Path>, scene: &Scene) -> Result<(), FileError> {
    write_atomic(path, scene.to_toml().as_bytes())
}

/// Reads a whole file of at most `limit_bytes`, and no byte more of a larger one.
///
/// # Errors
/// Why it cannot be read.
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
/// Why it cannot be written; the old file is then as it was.
pub fn write_atomic(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), FileError> {
    write_atomic_with(path, |out| out.write_all(bytes))
}

/// As [`write_atomic`], for what is too large to hold in memory: `fill` writes into a buffer before the file.
///
/// # Errors
/// Why it cannot be written, or what `fill` met; the old file is then as it was.
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
/// Why it cannot be removed.
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
/// Why it cannot be made.
pub fn create_folder(path: impl AsRef<Path>) -> Result<(), FileError> {
    let path = path.as_ref();
    fs::create_dir_all(path).map_err(|e| FileError::write(path, &e))
}

/// The open tables of a run folder.
pub type RunFolder = RunWriter<BufWriter<fs::File>>;

/// Makes a run folder (and those above it), writes `scene.toml` and opens its tables, which grow as the run goes.
/// Those of an earlier run in the same folder are replaced.
///
/// # Errors
/// Why the folder or a file in it cannot be made.
pub fn create_run(folder: impl AsRef<Path>, scene: &Scene) -> Result<RunFolder, FileError> {
    let folder = folder.as_ref();
    create_folder(folder)?;
    save_scene(folder.join("scene.toml"), scene)?;
    let open = |name: &str| {
        let path = folder.join(name);
        fs::File::create(&path).map(BufWriter::new).map_err(|e| FileError::write(&path, &e))
    };
    Ok(RunWriter::new(open("history.csv")?, open("nodes.csv")?, open("events.csv")?))
}

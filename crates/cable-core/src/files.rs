//! No other file of the core touches the file system: it reads with a limit, and saves so that at
//! every moment either the old file or the new one is whole.

use std::fs;
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use atomic_write_file::AtomicWriteFile;

use crate::error::SceneError;
use crate::record::{
    FileRecord, Fingerprint, LeftOut, MANIFEST_HEAD, Manifest, NodeChoice, Pages, ReadError, RobotColumns, RunRequest,
    RunStatus, RunStop, RunTables, RunWriter, WriteError, has_rows, read_run,
};
use crate::scene::Scene;
use crate::scene::file::MAX_TEXT_BYTES;
use crate::solution::Solution;

/// The reason why a file could not be read or written. The data in memory is untouched, and so is
/// the old file.
#[derive(Clone, Debug, PartialEq)]
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

/// Name of the file in which a run folder describes itself.
const MANIFEST_NAME: &str = "run.toml";
/// The scene of a run.
const SCENE_NAME: &str = "scene.toml";
/// Held while a run is written; an empty file, which stays, since a lock on a file that is removed
/// excludes nobody.
const LOCK_NAME: &str = "run.lock";
/// The tables of a run, in the order of [`RunWriter::places`].
const TABLE_NAMES: [&str; 3] = ["history.csv", "nodes.csv", "events.csv"];
/// Files of a run beside its manifest.
const RUN_FILES: [&str; 4] = [SCENE_NAME, "history.csv", "nodes.csv", "events.csv"];
/// Folders, in a run folder, of runs that may one day take the place of the run there.
const UNFINISHED_PREFIX: &str = "unfinished-";
/// Most of these folders. More than anybody keeps; without a limit a script that never succeeds
/// fills a disk.
const MAX_UNFINISHED: usize = 999;

/// A table of a run on the disk: rows that do not fit on it leave it as it was.
struct TableFile {
    file: fs::File,
    bytes: u64,
    hash: Fingerprint,
    pages: Pages,
}

/// The content of a [`TableFile`] at some moment.
#[derive(Clone)]
struct Mark {
    bytes: u64,
    hash: Fingerprint,
    pages: Pages,
}

impl TableFile {
    /// Makes a file that is not there yet.
    fn create(path: &Path) -> io::Result<Self> {
        let file = fs::OpenOptions::new().append(true).create_new(true).open(path)?;
        Ok(Self { file, bytes: 0, hash: Fingerprint::default(), pages: Pages::default() })
    }

    fn mark(&self) -> Mark {
        Mark { bytes: self.bytes, hash: self.hash, pages: self.pages }
    }

    /// Takes back what was written since.
    fn rewind(&mut self, mark: Mark) {
        let Mark { bytes, hash, pages } = mark;
        // Where even that fails the table ends within a line, which readers leave out.
        let _ = self.file.set_len(bytes);
        (self.bytes, self.hash, self.pages) = (bytes, hash, pages);
    }
}

impl Write for TableFile {
    fn write(&mut self, rows: &[u8]) -> io::Result<usize> {
        let before = self.mark();
        for part in self.pages.lay_out(rows) {
            if let Err(e) = self.file.write_all(&part) {
                self.rewind(before);
                return Err(e);
            }
            self.bytes += part.len() as u64;
            self.hash.bytes(&part);
        }
        Ok(rows.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

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
    /// # Errors
    /// When a number is not finite or the disk refuses; the tables are then as before.
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

    /// Makes the tables, with headers alone ([`RunWriter::begin`]).
    ///
    /// # Errors
    /// As [`Self::push`].
    pub fn begin(&mut self, scene: &Scene, robot: RobotColumns) -> Result<(), WriteError> {
        self.write(|writer| writer.begin(scene, robot))
    }

    fn append(
        &mut self,
        solution: &Solution,
        push: impl FnOnce(&mut RunWriter<TableFile>, &Solution) -> Result<(), WriteError>,
    ) -> Result<(), WriteError> {
        self.write(|writer| push(writer, solution))?;
        self.manifest.reached_s = Some(solution.time_s);
        Ok(())
    }

    fn write(
        &mut self,
        write: impl FnOnce(&mut RunWriter<TableFile>) -> Result<(), WriteError>,
    ) -> Result<(), WriteError> {
        let writer = match &mut self.writer {
            Some(writer) => writer,
            none => {
                let open = |table| {
                    TableFile::create(&self.place.join(table)).map_err(|source| WriteError::Io { table, source })
                };
                let [history, nodes, events] = TABLE_NAMES;
                let writer = RunWriter::new(open(history)?, open(nodes)?, open(events)?).with_nodes(self.node_choice);
                none.insert(writer)
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
    /// # Errors
    /// What could not be written, or why an earlier run was not replaced; what was written stays
    /// readable, and is partial where the end of a complete run could not be noted.
    pub fn finish(mut self, end: RunEnd) -> Result<PathBuf, FileError> {
        if let Some(writer) = &mut self.writer {
            for (table, name) in writer.places().into_iter().zip(TABLE_NAMES) {
                table.file.sync_all().map_err(|e| FileError::write(&self.place.join(name), &e))?;
                self.manifest.files.push(FileRecord::new(name, table.bytes, table.hash));
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

/// Returns what the manifest of a folder says; None where the folder is empty.
fn look(folder: &Path) -> Result<Option<Manifest>, FileError> {
    let listed = fs::read_dir(folder).and_then(|entries| {
        entries.map(|e| e.map(|e| e.file_name().to_string_lossy().into_owned())).collect::<io::Result<Vec<_>>>()
    });
    let mut names = listed.map_err(|e| FileError::write(folder, &e))?;
    names.sort();
    if names.iter().any(|name| name == MANIFEST_NAME) {
        let foreign = || FileError::folder(folder, RunFolderFault::Foreign { found: MANIFEST_NAME.to_owned() });
        return read_manifest(folder).map(Some).ok_or_else(foreign);
    }
    // A run that died before it had a manifest.
    names.retain(|name| {
        name != LOCK_NAME && !(*name == temporary(MANIFEST_NAME) && is_part_of_manifest(&folder.join(name)))
    });
    match names.into_iter().next() {
        None => Ok(None),
        Some(found) => Err(FileError::folder(folder, RunFolderFault::Foreign { found })),
    }
}

/// Largest manifest read, bytes: one has below 2 kB. More would only cost memory.
const MAX_MANIFEST_BYTES: u64 = 1 << 16;

fn read_manifest(folder: &Path) -> Option<Manifest> {
    let path = folder.join(MANIFEST_NAME);
    if !is_plain_file(&path) {
        return None;
    }
    let bytes = read_limited(path, MAX_MANIFEST_BYTES).ok()?;
    Manifest::from_toml(std::str::from_utf8(&bytes).ok()?)
}

/// A manifest whose writing was cut off.
fn is_part_of_manifest(path: &Path) -> bool {
    let head = MANIFEST_HEAD.as_bytes();
    is_plain_file(path)
        && read_limited(path, MAX_MANIFEST_BYTES).is_ok_and(|bytes| bytes.starts_with(head) || head.starts_with(&bytes))
}

/// Returns whether it is a file: no link, folder, pipe or device.
fn is_plain_file(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|about| about.is_file())
}

/// Returns whether there is anything of a name.
fn exists(path: &Path) -> bool {
    !matches!(fs::symlink_metadata(path), Err(e) if e.kind() == io::ErrorKind::NotFound)
}

/// Locks a folder for one run; the file is unlocked when it is closed. None where the file system
/// knows no locks.
fn lock(folder: &Path) -> Result<Option<fs::File>, FileError> {
    let path = folder.join(LOCK_NAME);
    let mut options = fs::OpenOptions::new();
    options.write(true);
    let made = match options.clone().create_new(true).open(&path) {
        Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {
            if !is_plain_file(&path) {
                return Err(FileError::folder(folder, RunFolderFault::NotAFile { name: LOCK_NAME.to_owned() }));
            }
            options.open(&path)
        }
        made => made,
    };
    let file = made.map_err(|e| FileError::write(&path, &e))?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(fs::TryLockError::WouldBlock) => Err(FileError::folder(folder, RunFolderFault::InUse)),
        // Two runs at once then write into folders of their own still, since each file and folder
        // is made new.
        Err(fs::TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => Ok(None),
        Err(fs::TryLockError::Error(e)) => Err(FileError::write(&path, &e)),
    }
}

/// Refuses where a file of the run is not as the run wrote it.
fn check_own(folder: &Path, manifest: &Manifest) -> Result<(), FileError> {
    RUN_FILES.iter().try_for_each(|name| check_file(folder, manifest, name))
}

fn check_file(folder: &Path, manifest: &Manifest, name: &str) -> Result<(), FileError> {
    let path = folder.join(name);
    if !exists(&path) {
        return Ok(());
    }
    if !is_plain_file(&path) {
        return Err(FileError::folder(folder, RunFolderFault::NotAFile { name: name.to_owned() }));
    }
    let own = match manifest.file(name) {
        Some(record) => record_of(&path, name).map(|now| now == *record),
        // A run that ended without a word left tables of unknown length.
        None => begins_as_table(&path),
    };
    if own.map_err(|e| FileError::read(&path, &e))? {
        Ok(())
    } else {
        Err(FileError::folder(folder, RunFolderFault::Changed { name: name.to_owned() }))
    }
}

fn record_of(path: &Path, name: &str) -> io::Result<FileRecord> {
    let mut file = fs::File::open(path)?;
    let (mut bytes, mut hash) = (0, Fingerprint::default());
    let mut part = vec![0; 1 << 16];
    loop {
        let count = match file.read(&mut part) {
            Err(e) if e.kind() == io::ErrorKind::Interrupted => continue,
            other => other?,
        };
        let Some(read) = part.get(..count).filter(|read| !read.is_empty()) else { break };
        bytes += count as u64;
        hash.bytes(read);
    }
    Ok(FileRecord::new(name, bytes, hash))
}

fn begins_as_table(path: &Path) -> io::Result<bool> {
    let mut head = Vec::new();
    fs::File::open(path)?.take(7).read_to_end(&mut head)?;
    Ok(head.is_empty() || head == b"time_s,")
}

/// Returns whether the run in a folder came to an instant that would be lost.
fn has_instant(folder: &Path) -> bool {
    let [history, ..] = TABLE_NAMES;
    fs::File::open(folder.join(history)).is_ok_and(has_rows)
}

/// Makes the folder of a run that may take the place of the one there.
fn new_unfinished(folder: &Path) -> Result<PathBuf, FileError> {
    for k in 1..=MAX_UNFINISHED {
        let place = folder.join(format!("{UNFINISHED_PREFIX}{k}"));
        match fs::create_dir(&place) {
            Ok(()) => return Ok(place),
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            Err(e) => return Err(FileError::write(&place, &e)),
        }
    }
    Err(FileError::folder(folder, RunFolderFault::Full { count: MAX_UNFINISHED }))
}

/// Puts a complete successor in the place of a run, where that was begun: each file is in the one
/// folder or in the other, the manifest is the last that moves, and so it can be gone on with
/// wherever it stopped. The manifest that holds then.
fn replace_if_begun(folder: &Path, manifest: Manifest) -> Result<Manifest, FileError> {
    let Some(from) = successor(folder, &manifest) else { return Ok(manifest) };
    for name in RUN_FILES {
        let (source, target) = (from.join(name), folder.join(name));
        if is_plain_file(&source) {
            check_file(folder, &manifest, name)?;
            fs::rename(&source, &target).map_err(|e| FileError::write(&target, &e))?;
        }
    }
    let target = folder.join(MANIFEST_NAME);
    fs::rename(from.join(MANIFEST_NAME), &target).map_err(|e| FileError::write(&target, &e))?;
    // Only its lock is left of it.
    let _ = remove_files(&from, &[LOCK_NAME]).map(|()| fs::remove_dir(&from));
    sync_folder(folder);
    read_manifest(folder)
        .ok_or_else(|| FileError::folder(folder, RunFolderFault::Changed { name: MANIFEST_NAME.to_owned() }))
}

/// The folder of the run that is being put in the place of the one in a folder.
fn successor(folder: &Path, manifest: &Manifest) -> Option<PathBuf> {
    let name = manifest.successor.as_deref().filter(|name| is_unfinished(name))?;
    (manifest.status == RunStatus::Replacing).then(|| folder.join(name))
}

fn is_unfinished(name: &str) -> bool {
    name.strip_prefix(UNFINISHED_PREFIX)
        .is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
}

/// Removes the runs in a folder that were not finished and that nobody writes or has changed, as
/// far as that can be done.
fn remove_unfinished(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let place = entry.path();
        let ours = is_unfinished(&entry.file_name().to_string_lossy())
            && fs::symlink_metadata(&place).is_ok_and(|about| about.is_dir());
        // One without a manifest is empty but for its lock.
        let Some(Ok(manifest)) = ours.then(|| look(&place)) else { continue };
        let Ok(held) = lock(&place) else { continue };
        if manifest.is_none_or(|manifest| check_own(&place, &manifest).is_ok()) {
            let _ = remove_files(&place, &RUN_FILES)
                .and_then(|()| remove_files(&place, &[MANIFEST_NAME, &temporary(MANIFEST_NAME), LOCK_NAME]))
                .map(|()| fs::remove_dir(&place));
        }
        drop(held);
    }
}

fn remove_files(folder: &Path, names: &[&str]) -> Result<(), FileError> {
    names.iter().try_for_each(|name| remove(folder.join(name)))
}

fn temporary(name: &str) -> String {
    format!("{name}.new")
}

/// Writes a whole file of a run folder that is locked: beside its place, to the disk, then into its
/// place.
fn put(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), FileError> {
    let (path, beside) = (folder.join(name), folder.join(temporary(name)));
    let write = || -> io::Result<()> {
        // Left by a run that was killed within these lines; a link is removed, not followed.
        remove_left(&beside)?;
        let mut file = fs::OpenOptions::new().write(true).create_new(true).open(&beside)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&beside, &path)
    };
    write().map_err(|e| {
        let _ = remove_left(&beside);
        FileError::write(&path, &e)
    })?;
    sync_folder(folder);
    Ok(())
}

fn remove_left(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

/// Names of files reach the disk, where the system has a way to say so.
fn sync_folder(folder: &Path) {
    let _ = fs::File::open(folder).and_then(|folder| folder.sync_all());
}

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
/// # Errors
/// What is missing or broken, and where.
pub fn load_run(folder: impl AsRef<Path>, limit_bytes: u64) -> Result<SavedRun, FileError> {
    let folder = folder.as_ref();
    let manifest = read_manifest(folder);
    // Where a successor is half way into its place, what has not moved yet is still in the folder
    // it comes from.
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

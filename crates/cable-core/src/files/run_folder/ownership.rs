//! Only a folder, and files in it, that are as a run left them are touched.

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use super::super::{FileError, RunFolderFault, read_limited};
use super::atomic_write::{exists, is_plain_file, temporary};
use super::file_names::{LOCK_NAME, MANIFEST_NAME, RUN_FILES, TABLE_NAMES};
use crate::record::{FileRecord, Fingerprint, MANIFEST_HEAD, Manifest, has_rows};

/// Largest manifest read, bytes: one has below 2 kB. More would only cost memory.
pub(super) const MAX_MANIFEST_BYTES: u64 = 1 << 16;

/// Returns what the manifest of a folder says; None where the folder is empty.
pub(super) fn look(folder: &Path) -> Result<Option<Manifest>, FileError> {
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

/// The manifest of a run folder; None if there is none that can be read.
pub(in crate::files) fn read_manifest(folder: &Path) -> Option<Manifest> {
    let path = folder.join(MANIFEST_NAME);
    if !is_plain_file(&path) {
        return None;
    }
    let bytes = read_limited(path, MAX_MANIFEST_BYTES).ok()?;
    Manifest::from_toml(std::str::from_utf8(&bytes).ok()?)
}

/// A manifest whose writing was cut off.
pub(super) fn is_part_of_manifest(path: &Path) -> bool {
    let head = MANIFEST_HEAD.as_bytes();
    is_plain_file(path)
        && read_limited(path, MAX_MANIFEST_BYTES).is_ok_and(|bytes| bytes.starts_with(head) || head.starts_with(&bytes))
}

/// Refuses where a file of the run is not as the run wrote it.
pub(super) fn check_own(folder: &Path, manifest: &Manifest) -> Result<(), FileError> {
    RUN_FILES.iter().try_for_each(|name| check_file(folder, manifest, name))
}

/// Returns an error if a file of the run is not as the manifest has it.
pub(super) fn check_file(folder: &Path, manifest: &Manifest, name: &str) -> Result<(), FileError> {
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

/// Length and fingerprint of a file.
pub(super) fn record_of(path: &Path, name: &str) -> io::Result<FileRecord> {
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

pub(super) fn begins_as_table(path: &Path) -> io::Result<bool> {
    let mut head = Vec::new();
    fs::File::open(path)?.take(7).read_to_end(&mut head)?;
    Ok(head.is_empty() || head == b"time_s,")
}

/// Returns whether the run in a folder came to an instant that would be lost.
pub(super) fn has_instant(folder: &Path) -> bool {
    let [history, ..] = TABLE_NAMES;
    fs::File::open(folder.join(history)).is_ok_and(has_rows)
}

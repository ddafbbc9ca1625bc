//! A complete run takes the place of an earlier one in its folder; wherever that stops, it can be
//! gone on with.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::super::{FileError, RunFolderFault};
use super::atomic_write::{is_plain_file, remove_files, sync_folder, temporary};
use super::file_names::{LOCK_NAME, MANIFEST_NAME, RUN_FILES};
use super::lock::lock;
use super::ownership::{check_file, check_own, look, read_manifest};

use crate::record::{Manifest, RunStatus};

/// Folders, in a run folder, of runs that may one day take the place of the run there.
const UNFINISHED_PREFIX: &str = "unfinished-";
/// Most of these folders. More than anybody keeps; without a limit a script that never succeeds
/// fills a disk.
const MAX_UNFINISHED: usize = 999;

/// Makes the folder of a run that may take the place of the one there.
pub(super) fn new_unfinished(folder: &Path) -> Result<PathBuf, FileError> {
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
pub(super) fn replace_if_begun(folder: &Path, manifest: Manifest) -> Result<Manifest, FileError> {
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
pub(in crate::files) fn successor(folder: &Path, manifest: &Manifest) -> Option<PathBuf> {
    let name = manifest.successor.as_deref().filter(|name| is_unfinished(name))?;
    (manifest.status == RunStatus::Replacing).then(|| folder.join(name))
}

pub(super) fn is_unfinished(name: &str) -> bool {
    name.strip_prefix(UNFINISHED_PREFIX)
        .is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
}

/// Removes the runs in a folder that were not finished and that nobody writes or has changed, as
/// far as that can be done.
pub(super) fn remove_unfinished(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let place = entry.path();
        let ours = is_unfinished(&entry.file_name().to_string_lossy())
            && fs::symlink_metadata(&place).is_ok_and(|about| about.is_dir());
        // One without a manifest is empty but for its lock.
        let Some(Ok(manifest)) = ours.then(|| look(&place)) else { continue };
        let Ok(place_lock) = lock(&place) else { continue };
        if manifest.is_none_or(|manifest| check_own(&place, &manifest).is_ok()) {
            let cut_off = RUN_FILES.map(temporary);
            let _ = remove_files(&place, &RUN_FILES)
                .and_then(|()| remove_files(&place, &cut_off.each_ref().map(String::as_str)))
                .and_then(|()| remove_files(&place, &[MANIFEST_NAME, &temporary(MANIFEST_NAME), LOCK_NAME]))
                .map(|()| fs::remove_dir(&place));
        }
        drop(place_lock);
    }
}

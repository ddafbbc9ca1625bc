//! Files of a run folder: each is written whole beside its place and then put there.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use super::super::{FileError, remove};

/// Returns whether it is a file: no link, folder, pipe or device.
pub(in crate::files) fn is_plain_file(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|about| about.is_file())
}

/// Returns whether there is anything of a name.
pub(super) fn exists(path: &Path) -> bool {
    !matches!(fs::symlink_metadata(path), Err(e) if e.kind() == io::ErrorKind::NotFound)
}

pub(super) fn remove_files(folder: &Path, names: &[&str]) -> Result<(), FileError> {
    names.iter().try_for_each(|name| remove(folder.join(name)))
}

pub(super) fn temporary(name: &str) -> String {
    format!("{name}.new")
}

/// Writes a whole file of a run folder that is locked: beside its place, to the disk, then into its
/// place.
pub(super) fn put(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), FileError> {
    let path = folder.join(name);
    write_temporary_and_rename(&path, bytes).map_err(|e| FileError::write(&path, &e))?;
    sync_folder(folder);
    Ok(())
}

/// As [`put`], where there is nothing of that name yet.
pub(super) fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if exists(path) { Err(io::ErrorKind::AlreadyExists.into()) } else { write_temporary_and_rename(path, bytes) }
}

fn write_temporary_and_rename(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let beside = path.with_file_name(temporary(&name));
    let write = || -> io::Result<()> {
        // Left by a run that was killed within these lines; a link is removed, not followed.
        remove_if_present(&beside)?;
        let mut file = fs::OpenOptions::new().write(true).create_new(true).open(&beside)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&beside, path)
    };
    write().inspect_err(|_| {
        let _ = remove_if_present(&beside);
    })
}

pub(super) fn remove_if_present(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

/// Names of files reach the disk, where the system has a way to say so.
pub(super) fn sync_folder(folder: &Path) {
    let _ = fs::File::open(folder).and_then(|folder| folder.sync_all());
}

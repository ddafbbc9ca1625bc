//! One run at a time in a folder: a lock that the system lets go of however the process ends.

use std::fs;
use std::io;
use std::path::Path;

use super::super::{FileError, RunFolderFault};
use super::atomic_write::is_plain_file;
use super::file_names::LOCK_NAME;

/// Locks a folder for one run; the file is unlocked when it is closed. None where the file system
/// knows no locks.
pub(super) fn lock(folder: &Path) -> Result<Option<fs::File>, FileError> {
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

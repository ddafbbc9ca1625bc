//! A table of a run on the disk: it appears with its header, and rows that do not fit leave it as
//! it was.

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use super::atomic_write::{remove_if_present, write_new};
use crate::record::{Fingerprint, Pages};

/// A table of a run on the disk.
pub(super) struct TableFile {
    path: PathBuf,
    /// None until something was written: a run that is killed leaves no table without its header.
    file: Option<fs::File>,
    bytes: u64,
    hash: Fingerprint,
    pages: Pages,
}

/// The content of a [`TableFile`] at some moment.
#[derive(Clone)]
pub(super) struct ContentMark {
    bytes: u64,
    hash: Fingerprint,
    pages: Pages,
}

impl TableFile {
    /// A table that is made with the first that is written into it.
    pub(super) fn new(path: PathBuf) -> Self {
        Self { path, file: None, bytes: 0, hash: Fingerprint::default(), pages: Pages::default() }
    }

    /// Number of bytes and hash of what was written.
    pub(super) fn written(&self) -> (u64, Fingerprint) {
        (self.bytes, self.hash)
    }

    /// Waits until the disk has it.
    pub(super) fn sync(&self) -> io::Result<()> {
        self.file.as_ref().map_or(Ok(()), fs::File::sync_all)
    }

    /// Appends bytes to the file, which the first ones create.
    fn append(&mut self, part: &[u8]) -> io::Result<()> {
        match &mut self.file {
            Some(file) => file.write_all(part),
            none => {
                write_new(&self.path, part)?;
                *none = Some(fs::OpenOptions::new().append(true).open(&self.path)?);
                Ok(())
            }
        }
    }

    pub(super) fn mark(&self) -> ContentMark {
        ContentMark { bytes: self.bytes, hash: self.hash, pages: self.pages }
    }

    /// Takes back what was written since.
    pub(super) fn rewind(&mut self, mark: ContentMark) {
        let ContentMark { bytes, hash, pages } = mark;
        // If even that fails, the table ends within a line, and readers ignore that line.
        let _ = match &self.file {
            Some(file) if bytes > 0 => file.set_len(bytes),
            Some(_) => {
                self.file = None;
                remove_if_present(&self.path)
            }
            None => Ok(()),
        };
        (self.bytes, self.hash, self.pages) = (bytes, hash, pages);
    }
}

impl Write for TableFile {
    fn write(&mut self, rows: &[u8]) -> io::Result<usize> {
        let before = self.mark();
        for part in self.pages.lay_out(rows) {
            if let Err(e) = self.append(&part) {
                self.rewind(before);
                return Err(e);
            }
            self.bytes += part.len() as u64;
            self.hash.bytes(&part);
        }
        Ok(rows.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), fs::File::flush)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a failing test is meant to panic

    use super::*;

    const HEADER: &[u8] = b"time_s,cable\n";

    #[test]
    fn a_table_is_there_with_its_header_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let mut table = TableFile::new(path.clone());
        let before = table.mark();
        assert!(!path.exists());
        table.write_all(HEADER).unwrap();
        table.write_all(b"0.0,umbilical\n").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"time_s,cable\n0.0,umbilical\n");
        table.rewind(before);
        assert!(!path.exists());
        table.write_all(HEADER).unwrap();
        let header = table.mark();
        table.write_all(b"0.0,umbil").unwrap();
        table.rewind(header);
        assert_eq!(fs::read(&path).unwrap(), HEADER);
        assert_eq!(table.written().0, HEADER.len() as u64);
    }

    #[test]
    fn a_file_that_was_there_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        fs::write(&path, "mine").unwrap();
        let fault = TableFile::new(path.clone()).write_all(HEADER).unwrap_err();
        assert_eq!(fault.kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(fs::read(&path).unwrap(), b"mine");
    }
}

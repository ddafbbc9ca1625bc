//! Unsaved changes are kept on disk in case the program is killed: a display server that ends takes
//! every program with it, without notice, so that nothing can be saved at that moment.

use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use cable_core::{Scene, files};

/// Time from a change to its copy on disk. Longer: more is lost; shorter: a long drag writes all
/// the time.
const PERIOD: Duration = Duration::from_secs(5);

/// The changes of a scene since its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Changes {
    /// There are no changes.
    None,
    /// The changed scene can be read again.
    Readable,
    /// The changed scene has a fault, and could not be read again.
    Faulty,
}

/// The file that holds unsaved changes, while there are any.
#[derive(Debug)]
pub struct Autosave {
    path: PathBuf,
    /// The text that the file holds, if this window wrote it.
    written: Option<Scene>,
    /// The time when the scene first differed from it.
    changed: Option<Instant>,
    /// Writing to a disk can take long: the window does not wait.
    writer: Option<JoinHandle<Result<(), String>>>,
    fault: Option<String>,
}

/// Returns the path of the recovery file; None on a machine without a place for it.
#[must_use]
pub fn default_path() -> Option<PathBuf> {
    let folder = |variable: &str| std::env::var_os(variable).map(PathBuf::from).filter(|p| p.is_absolute());
    let state = folder("XDG_STATE_HOME").or_else(|| folder("LOCALAPPDATA"));
    let state = state.or_else(|| Some(folder("HOME")?.join(".local").join("state")))?;
    Some(state.join("cable-viewer").join("recovery.toml"))
}

impl Autosave {
    /// Makes an autosave that keeps changes in a file.
    #[must_use]
    pub fn new(path: PathBuf) -> Self {
        Self { path, written: None, changed: None, writer: None, fault: None }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the reason why the last copy was not written.
    #[must_use]
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Returns the copy that a killed program has left: none, a scene, or the fault of the file.
    #[must_use]
    pub fn found(&self) -> Option<Result<Scene, String>> {
        match files::load_scene(&self.path) {
            Err(files::FileError::Read { kind: std::io::ErrorKind::NotFound, .. }) => None,
            other => Some(other.map_err(|e| e.to_string())),
        }
    }

    /// Compares the scene with the copy and writes it if it is due; returns the time until the next
    /// call, if one is needed.
    pub fn update(&mut self, scene: &Scene, changes: Changes, now: Instant) -> Option<Duration> {
        self.take_result();
        if changes == Changes::None {
            if self.written.is_some() {
                self.forget();
            }
            self.changed = None;
            return None;
        }
        if self.written.as_ref() == Some(scene) {
            self.changed = None;
            return None;
        }
        let due = *self.changed.get_or_insert(now) + PERIOD;
        if now < due {
            return Some(due - now);
        }
        if changes == Changes::Readable && self.writer.is_none() {
            self.write(scene.clone());
            self.changed = None;
            return None;
        }
        Some(PERIOD)
    }

    /// Removes the file: its changes are saved elsewhere, or not wanted.
    pub fn forget(&mut self) {
        self.finish();
        self.written = None;
        if let Err(e) = files::remove(&self.path) {
            self.fault = Some(e.to_string());
        }
    }

    /// Waits for a copy being written.
    pub fn finish(&mut self) {
        if let Some(writer) = self.writer.take() {
            self.keep(writer);
        }
    }

    /// Writes a copy of a scene on a thread of its own.
    fn write(&mut self, scene: Scene) {
        let (path, copy) = (self.path.clone(), scene.clone());
        let job = move || {
            if let Some(folder) = path.parent() {
                files::create_folder(folder).map_err(|e| e.to_string())?;
            }
            files::save_scene(&path, &copy).map_err(|e| e.to_string())
        };
        match std::thread::Builder::new().name("autosave".to_owned()).spawn(job) {
            Ok(writer) => self.writer = Some(writer),
            Err(e) => self.fault = Some(e.to_string()),
        }
        self.written = Some(scene);
    }

    fn take_result(&mut self) {
        if self.writer.as_ref().is_some_and(JoinHandle::is_finished) {
            self.finish();
        }
    }

    /// Stores how a writer ended.
    fn keep(&mut self, writer: JoinHandle<Result<(), String>>) {
        self.fault = match writer.join() {
            Ok(Ok(())) => None,
            Ok(Err(text)) => Some(text),
            Err(_) => Some("the thread that saves has stopped".to_owned()),
        };
        if self.fault.is_some() {
            // The copy is tried again after the next period.
            self.written = None;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a failing test is meant to panic
mod tests {
    use super::*;
    use cable_core::scene::catalog;

    #[test]
    fn changes_are_on_disk_within_ten_seconds_and_gone_once_saved() {
        let folder = tempfile::tempdir().unwrap();
        let mut autosave = Autosave::new(folder.path().join("deep").join("recovery.toml"));
        let mut scene = catalog::tank();
        let began = Instant::now();
        assert_eq!(autosave.update(&scene, Changes::None, began), None);
        scene.name = "changed".to_owned();
        let wait = autosave.update(&scene, Changes::Readable, began).unwrap();
        assert!(wait <= Duration::from_secs(10));
        assert!(autosave.found().is_none());
        assert_eq!(autosave.update(&scene, Changes::Readable, began + wait), None);
        autosave.finish();
        assert_eq!(autosave.fault(), None);
        assert_eq!(autosave.found().unwrap().unwrap(), scene);
        // A half-typed scene does not replace the last whole one.
        let whole = scene.clone();
        scene.name = "half typed".to_owned();
        let later = began + Duration::from_secs(60);
        autosave.update(&scene, Changes::Faulty, later);
        autosave.update(&scene, Changes::Faulty, later + Duration::from_secs(60));
        autosave.finish();
        assert_eq!(autosave.found().unwrap().unwrap(), whole);
        autosave.update(&scene, Changes::None, later);
        assert!(autosave.found().is_none());
    }

    #[test]
    fn a_disk_that_refuses_is_said_and_tried_again() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "in the way").unwrap();
        let mut autosave = Autosave::new(file.join("recovery.toml"));
        let scene = catalog::tank();
        let began = Instant::now();
        autosave.update(&scene, Changes::Readable, began);
        autosave.update(&scene, Changes::Readable, began + PERIOD);
        autosave.finish();
        assert!(autosave.fault().is_some());
        assert!(autosave.update(&scene, Changes::Readable, began + PERIOD).is_some());
    }

    #[test]
    fn a_damaged_file_is_reported_and_not_taken_for_a_scene() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("recovery.toml");
        let text = catalog::tank().to_toml();
        std::fs::write(&path, &text[..text.len() / 2]).unwrap();
        assert!(Autosave::new(path).found().unwrap().is_err());
    }
}

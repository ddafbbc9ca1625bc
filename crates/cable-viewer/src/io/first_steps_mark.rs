//! The file that marks the first steps as done stands beside the recovery file, so that the window
//! shows its hints once.

use std::path::Path;

use cable_core::files;

/// Returns true if the first steps were done in an earlier window.
#[must_use]
pub fn are_done(mark: &Path) -> bool {
    mark.exists()
}

/// Writes the mark; if that fails, the hints come again, which is not worth a message.
pub fn remember(mark: &Path) {
    if let Some(folder) = mark.parent() {
        let _ = std::fs::create_dir_all(folder);
    }
    let _ = files::write_atomic(mark, b"The hints of the first minute were followed or hidden.\n");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_steps_are_remembered() {
        let folder = tempfile::tempdir().unwrap();
        let mark = folder.path().join("state/first-steps.txt");
        assert!(!are_done(&mark));
        remember(&mark);
        assert!(are_done(&mark));
    }
}

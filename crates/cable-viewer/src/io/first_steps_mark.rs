//! The file that marks the first steps as done stands beside the recovery file, so that the window
//! shows its hints once.

use std::path::Path;

use cable_core::files;

/// Returns whether an earlier window saw the first steps done.
#[must_use]
pub fn are_done(mark: &Path) -> bool {
    mark.exists()
}

/// Remembers it; where that fails the hints come again, which is no loss worth a message.
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

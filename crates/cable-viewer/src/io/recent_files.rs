//! The files opened last are kept in a small list beside the recovery file, a path a line.

use std::path::{Path, PathBuf};

use cable_core::files;

/// Longest list that is read, bytes: a file of another kind is none.
const MAX_BYTES: u64 = 64 << 10;

/// Those of an earlier window that still exist; none where there is no list.
#[must_use]
pub fn load(list: &Path) -> Vec<PathBuf> {
    let small = std::fs::metadata(list).is_ok_and(|m| m.len() <= MAX_BYTES);
    let text = if small { std::fs::read_to_string(list).unwrap_or_default() } else { String::new() };
    text.lines().map(PathBuf::from).filter(|p| p.is_absolute() && p.is_file()).collect()
}

/// Keeps them; a list that cannot be written is no loss worth a message.
pub fn save(list: &Path, recent: &[PathBuf]) {
    let lines = recent.iter().filter_map(|p| p.to_str()).filter(|p| !p.contains('\n'));
    let text: String = lines.map(|p| format!("{p}\n")).collect();
    if let Some(folder) = list.parent() {
        let _ = std::fs::create_dir_all(folder);
    }
    let _ = files::write_atomic(list, text.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_exist_are_remembered() {
        let folder = tempfile::tempdir().unwrap();
        let (list, scene) = (folder.path().join("state/recent.txt"), folder.path().join("a.toml"));
        std::fs::write(&scene, "").unwrap();
        save(&list, &[scene.clone(), folder.path().join("gone.toml")]);
        assert_eq!(load(&list), vec![scene]);
        assert!(load(&folder.path().join("none.txt")).is_empty());
    }
}

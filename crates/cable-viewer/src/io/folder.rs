//! The contents of a folder are listed for a dialog that asks for a path, on machines with and
//! without a file dialog of their own.

use std::path::{Path, PathBuf};

/// Greatest number of entries that are listed: nobody searches more by eye.
const MAX_ENTRIES: usize = 2000;

/// The listing of a folder in a dialog.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Listing {
    /// The folder, absolute.
    pub folder: PathBuf,
    /// Its folders by name, hidden ones left out.
    pub folders: Vec<String>,
    /// Its files with an ending asked for, by name.
    pub files: Vec<String>,
}

/// The folder that a typed path is in, or is.
#[must_use]
pub fn of(typed: &str) -> PathBuf {
    let path = std::path::absolute(typed.trim()).unwrap_or_default();
    let present = || std::env::current_dir().unwrap_or_default();
    path.ancestors().find(|p| p.is_dir()).map_or_else(present, Path::to_owned)
}

/// Lists a folder; `endings` are those of the files shown, such as `toml`.
///
/// # Errors
/// In words: the folder cannot be read.
pub fn list(folder: &Path, endings: &[&str]) -> Result<Listing, String> {
    let mut listing = Listing { folder: folder.to_owned(), ..Listing::default() };
    let entries = std::fs::read_dir(folder).map_err(|e| e.to_string())?;
    for entry in entries.take(MAX_ENTRIES).flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        if name.starts_with('.') {
            continue;
        }
        if path.is_dir() {
            listing.folders.push(name);
        } else if path.extension().and_then(|e| e.to_str()).is_some_and(|e| endings.contains(&e)) {
            listing.files.push(name);
        }
    }
    listing.folders.sort_by_key(|name| name.to_lowercase());
    listing.files.sort_by_key(|name| name.to_lowercase());
    Ok(listing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_listed_by_name_and_ending() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        for name in ["b.toml", "A.toml", "notes.txt", ".hidden.toml"] {
            std::fs::write(root.join(name), "").unwrap();
        }
        std::fs::create_dir(root.join("runs")).unwrap();
        let found = list(root, &["toml"]).unwrap();
        assert_eq!(
            (found.folders, found.files),
            (vec!["runs".to_owned()], vec!["A.toml".to_owned(), "b.toml".to_owned()])
        );
        assert!(list(root, &[]).unwrap().files.is_empty());
        assert!(list(&root.join("none"), &[]).is_err());
        // A path that does not exist yet belongs to the nearest folder that does.
        assert_eq!(of(&root.join("new/deep.toml").display().to_string()), root);
        assert_eq!(of(&root.display().to_string()), root);
        assert!(of("").is_dir());
    }
}

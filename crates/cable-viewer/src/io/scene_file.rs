//! Scenes are read from and written to files, with errors in words a dialog can show.

use std::path::Path;

use cable_core::{Scene, files};

/// Reads a scene.
///
/// # Errors
/// The fault and its place, in words.
pub fn load(path: &Path) -> Result<Scene, String> {
    files::load_scene(path).map_err(|e| e.to_string())
}

/// Writes a scene; the old file stays whole until the new one is.
///
/// # Errors
/// The reason why it could not, in words.
pub fn save(path: &Path, scene: &Scene) -> Result<(), String> {
    files::save_scene(path, scene).map_err(|e| e.to_string())
}

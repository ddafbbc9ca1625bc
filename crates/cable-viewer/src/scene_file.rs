//! Scenes from and to files, with errors in words a dialog can show.

use std::path::Path;

use cable_core::Scene;

/// Reads a scene.
///
/// # Errors
/// What is wrong and where, in words.
pub fn load(path: &Path) -> Result<Scene, String> {
    let text = std::fs::read_to_string(path).map_err(|e| e.to_string())?;
    Scene::from_toml(&text).map_err(|e| e.to_string())
}

/// Writes a scene.
///
/// # Errors
/// Why it could not, in words.
pub fn save(path: &Path, scene: &Scene) -> Result<(), String> {
    std::fs::write(path, scene.to_toml()).map_err(|e| e.to_string())
}

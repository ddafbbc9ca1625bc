//! Scene files: TOML in and out (placeholder: plain serde).

use super::Scene;
use crate::error::{SceneError, SceneFault};

impl Scene {
    /// Reads and validates a scene.
    ///
    /// # Errors
    /// What is wrong, with path, value, allowed range, line and column.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        let scene: Self = toml::from_str(text).map_err(|e| SceneError {
            path: String::new(),
            fault: SceneFault::Syntax { message: e.message().to_owned() },
            at: None,
        })?;
        scene.validate()?;
        Ok(scene)
    }

    /// Writes the scene.
    #[must_use]
    pub fn to_toml(&self) -> String {
        toml::to_string_pretty(self).unwrap_or_default()
    }
}

//! Whether a scene can be solved (placeholder).

use super::Scene;
use crate::error::SceneError;

impl Scene {
    /// Checks every number and name.
    ///
    /// # Errors
    /// The first thing wrong.
    pub fn validate(&self) -> Result<(), SceneError> {
        Ok(())
    }
}

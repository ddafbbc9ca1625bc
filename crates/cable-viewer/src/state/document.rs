//! The document is the scene being edited, where it comes from and whether it is saved.

use std::path::PathBuf;

use cable_core::{Scene, SceneError};

use crate::state::undo::Undo;

/// The scene being edited.
#[derive(Clone, Debug)]
pub struct Document {
    /// The scene; may be half-typed.
    pub scene: Scene,
    /// The fault of the present scene, if any.
    pub fault: Option<SceneError>,
    /// Its file, if it has one.
    pub path: Option<PathBuf>,
    /// The scene as it was last saved or loaded.
    pub saved: Scene,
    /// True if the scene comes from the recovery file of a window that died: no file of the user's
    /// holds it.
    pub recovered: bool,
    /// Scenes before and after the present one.
    pub undo: Undo,
}

impl Document {
    /// A scene as it is when opened.
    #[must_use]
    pub fn new(scene: Scene, path: Option<PathBuf>) -> Self {
        let (fault, saved) = (scene.validate().err(), scene.clone());
        Self { scene, fault, path, saved, recovered: false, undo: Undo::default() }
    }

    /// Returns true if the scene differs from its file.
    #[must_use]
    pub fn unsaved(&self) -> bool {
        self.recovered || self.scene != self.saved
    }

    /// Checks the scene again and stores its fault.
    pub fn validate(&mut self) {
        self.fault = self.scene.validate().err();
    }
}

//! The document is the scene being edited, where it comes from and whether it is saved.

use std::path::PathBuf;

use cable_core::Scene;

/// Where the scene comes from.
#[derive(Clone, Debug)]
pub struct Document {
    /// Its file, if it has one.
    pub path: Option<PathBuf>,
    /// As it was when last saved or loaded.
    pub saved: Scene,
    /// It comes from what a window that died had kept: it is in no file of the user's.
    pub recovered: bool,
}

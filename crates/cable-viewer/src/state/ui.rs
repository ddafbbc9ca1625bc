//! The window itself has a dialog, a tutorial and what concerns closing it.

use crate::state::dialog::Dialog;
use crate::state::tutorial_place::TutorialPlace;

/// The window around the scene.
#[derive(Debug, Default)]
pub struct Ui {
    /// The dialog that is open.
    pub dialog: Option<Dialog>,
    /// The tutorial that is on.
    pub tutorial: Option<TutorialPlace>,
    /// Why unsaved changes could not be kept for recovery.
    pub autosave_fault: Option<String>,
    /// The user agreed to close the window without saving.
    pub closing: bool,
}

//! The one dialog that may be open, as data; `app/dialogs.rs` draws it.

use std::path::PathBuf;

use cable_core::Scene;

use crate::io::feedback::Answers;
use crate::io::graph_sheet::Sheet;

/// An action that takes the place of the present scene, and so asks first if it is not saved.
#[derive(Clone, Debug, PartialEq)]
pub enum Replacement {
    /// A new scene.
    New,
    /// Opens a scene file.
    Open(PathBuf),
    /// Opens the folder of a run.
    OpenRun(PathBuf),
    /// Opens a catalogue scene by its short id.
    OpenCatalogue(String),
    /// Opens the scene of a tutorial.
    OpenTutorial {
        /// Index of the tutorial.
        tutorial: usize,
        /// Short id of its scene.
        scene: &'static str,
    },
    /// Closes the window.
    Quit,
}

/// What the user is asked or told.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialog {
    /// Something went wrong; the old scene is kept.
    Message {
        /// One line.
        title: String,
        /// What, where, why, what to do.
        text: String,
    },
    /// Where to read a scene from.
    Open {
        /// The path as typed so far.
        path: String,
    },
    /// Where to save to.
    SaveAs {
        /// The path as typed so far.
        path: String,
    },
    /// Where to export a graph to; the ending says how.
    Export {
        /// The path as typed so far.
        path: String,
        /// What was in view.
        sheet: Box<Sheet>,
    },
    /// Where to save what was recorded.
    SaveRun {
        /// The folder as typed so far.
        path: String,
    },
    /// Which run to open.
    OpenRun {
        /// The folder as typed so far.
        path: String,
        /// It is to be held beside the present scene, not opened in its place.
        hold: bool,
    },
    /// Terrain and beams to read, from a file or pasted.
    ImportMap {
        /// The path as typed so far; empty: what was pasted.
        path: String,
        /// What was pasted.
        text: String,
        /// Length of a unit of it as typed so far, m.
        unit_m: String,
    },
    /// Everything that can be done, by name.
    Palette {
        /// What was typed so far.
        text: String,
    },
    /// What the user thinks.
    Feedback {
        /// So far.
        answers: Answers,
        /// Where to keep it, as typed so far.
        path: String,
    },
    /// The guides, and what else to begin with.
    StartHere,
    /// What was validated and what was not.
    About,
    /// A window that did not close has left unsaved changes.
    Recover {
        /// The scene as it was last kept.
        scene: Box<Scene>,
    },
    /// The scene has unsaved changes and something is about to replace it.
    Unsaved {
        /// What goes on once the user agrees.
        then: Replacement,
    },
    /// Keys and pointer.
    Help,
}

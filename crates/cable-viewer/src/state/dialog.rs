//! The dialog that is open is data here; `app/dialogs.rs` draws it.

use std::path::PathBuf;

use cable_core::Scene;

use crate::io::feedback::Answers;
use crate::io::graph_in_view::GraphInView;

/// An action that takes the place of the present scene, and so asks first if it is not saved.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneReplacement {
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

/// A question to the user, or a message.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialog {
    /// Something went wrong; the old scene is kept.
    Message {
        /// One line.
        title: String,
        /// The text says what is wrong, where, why and what to do.
        text: String,
    },
    /// The path from which a scene is read.
    Open {
        /// The path as typed so far.
        path: String,
    },
    /// The path to which the scene is saved.
    SaveAs {
        /// The path as typed so far.
        path: String,
    },
    /// The path to which a graph is exported; its ending gives the format.
    Export {
        /// The path as typed so far.
        path: String,
        /// The part that was in view.
        sheet: Box<GraphInView>,
    },
    /// The path to which the canvas is drawn.
    ExportPicture {
        /// The path as typed so far.
        path: String,
    },
    /// The folder in which the recording is saved.
    SaveRun {
        /// The folder as typed so far.
        path: String,
    },
    /// The folder of the run to open.
    OpenRun {
        /// The folder as typed so far.
        path: String,
        /// True if the run is pinned beside the present scene, not opened in its place.
        hold: bool,
    },
    /// Terrain and beams to read, from a file or pasted.
    ImportMap {
        /// The path as typed so far; empty: what was pasted.
        path: String,
        /// The text that was pasted.
        text: String,
        /// Length of a unit of it as typed so far, m.
        unit_m: String,
    },
    /// Everything that can be done, by name.
    Palette {
        /// The text as typed so far.
        text: String,
    },
    /// The user's opinion.
    Feedback {
        /// The answers so far.
        answers: Answers,
        /// The place to keep it at, as typed so far.
        path: String,
    },
    /// The guides, and what else to begin with.
    StartHere,
    /// The list of what was validated and what was not.
    About,
    /// A window that did not close has left unsaved changes.
    Recover {
        /// The scene as it was last kept.
        scene: Box<Scene>,
    },
    /// The scene has unsaved changes and something is about to replace it.
    Unsaved {
        /// The action that goes on once the user agrees.
        then: SceneReplacement,
    },
    /// Keys and pointer.
    Help,
}

//! The window itself has a dialog, a tutorial and what concerns closing it.

use std::path::PathBuf;

use crate::record::plotted_quantity::Measure;
use crate::state::dialog::{Dialog, SceneReplacement};
use crate::state::first_steps::FirstSteps;
use crate::state::tutorial_place::TutorialPlace;

/// The open parts of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OpenPanels {
    /// The form on the left, in which things are edited.
    pub edit: bool,
    /// The panel on the right, from which figures are read.
    pub results: bool,
    /// Timeline and graphs, below.
    pub graphs: bool,
}

impl Default for OpenPanels {
    fn default() -> Self {
        Self { edit: true, results: true, graphs: true }
    }
}

/// Something asked of the graphs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GraphRequest {
    /// A measure to show alone.
    Measure(Measure),
    /// To keep up with the data, or not any more.
    Follow,
}

/// A part of the panel on the right that answers a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolSection {
    /// The sum that a tension is at the marked place.
    MarkedPlace,
    /// The figures of the answer.
    Readouts,
    /// The places that an end or the robot reaches.
    SafeReach,
    /// Pinned results.
    Compare,
    /// Less and more friction.
    FrictionRange,
    /// The form of the solver, with error over cost.
    Solver,
}

/// The window around the scene.
#[derive(Debug, Default)]
pub struct Ui {
    /// The open parts of the window.
    pub panels: OpenPanels,
    /// Results have a panel of their own on the right.
    pub results_beside: bool,
    /// The dialog that is open.
    pub dialog: Option<Dialog>,
    /// The action that goes on once the scene is saved.
    pub after_save: Option<SceneReplacement>,
    /// The dialog that comes back once the message over it is closed.
    pub after_message: Option<Dialog>,
    /// Files opened and saved last, the latest first.
    pub recent: Vec<PathBuf>,
    /// The first steps that are still to be done.
    pub first_steps: FirstSteps,
    /// The tutorial that is on.
    pub tutorial: Option<TutorialPlace>,
    /// The reason why unsaved changes could not be kept for recovery.
    pub autosave_fault: Option<String>,
    /// The file or folder that was exported or saved last, until another dialog opens.
    pub written: Option<PathBuf>,
    /// The graph (by its title) whose export was asked for elsewhere than beside it.
    pub graph_to_export: Option<&'static str>,
    /// The last request made of the graphs elsewhere than above them, and the count of all.
    pub graph_request: (u64, Option<GraphRequest>),
    /// The section that was asked for last elsewhere than in it, and the count of all requests.
    pub section_request: (u64, Option<ToolSection>),
    /// Number of scenes opened so far.
    pub scenes_opened: u64,
    /// The user agreed to close the window without saving.
    pub closing: bool,
}

/// Most recent files that are offered: more is a list to search.
const MAX_RECENT: usize = 8;

impl Ui {
    /// Remembers a file that was opened or saved.
    pub fn add_recent(&mut self, path: PathBuf) {
        let path = std::path::absolute(&path).unwrap_or(path);
        self.recent.retain(|p| *p != path);
        self.recent.insert(0, path);
        self.recent.truncate(MAX_RECENT);
    }
}

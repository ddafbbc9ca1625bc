//! [`AppState`] consists of parts; each owns its fields and the functions that need nothing else.

use std::path::PathBuf;

use cable_core::Scene;

use crate::state::analysis::Analysis;
use crate::state::document::Document;
use crate::state::live::Live;
use crate::state::selection::{Item, Selection};
use crate::state::solver::Solver;
use crate::state::ui::Ui;
use crate::state::view::Appearance;

/// Everything the window shows.
#[derive(Debug)]
pub struct AppState {
    /// The scene being edited.
    pub document: Document,
    /// What is picked, hovered, dragged and copied.
    pub selection: Selection,
    /// How the scene is drawn.
    pub view: Appearance,
    /// What the worker is asked for.
    pub solver: Solver,
    /// What it answered, and how time runs.
    pub live: Live,
    /// What is asked beyond the answer itself.
    pub analysis: Analysis,
    /// The window around the scene.
    pub ui: Ui,
}

impl AppState {
    /// The window's contents when it opens on a scene.
    #[must_use]
    pub fn new(scene: Scene, path: Option<PathBuf>) -> Self {
        Self {
            document: Document::new(scene, path),
            selection: Selection::default(),
            view: Appearance::default(),
            solver: Solver::default(),
            live: Live::default(),
            analysis: Analysis::default(),
            ui: Ui::default(),
        }
    }

    /// The cable that panels edit: the selected one, else that of the selected support, else the
    /// first.
    #[must_use]
    pub fn current_cable(&self) -> usize {
        let scene = &self.document.scene;
        let index = match self.selection.selected {
            Some(Item::Cable(cable) | Item::Support { cable, .. }) => cable,
            Some(Item::Load(k) | Item::Head(k)) => {
                let load = scene.loads.get(k);
                load.and_then(|l| scene.cables.iter().position(|c| c.name == l.cable)).unwrap_or(0)
            }
            _ => 0,
        };
        index.min(scene.cables.len().saturating_sub(1))
    }
}

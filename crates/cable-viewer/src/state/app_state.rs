//! The state of the window, [`AppState`], consists of parts; each owns its fields and the functions
//! that need no other part.

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
    /// The items that are selected, hovered, dragged and copied.
    pub selection: Selection,
    /// The view of the scene.
    pub view: Appearance,
    /// The settings that the worker is asked for.
    pub solver: Solver,
    /// The answer of the worker, and the run of time.
    pub live: Live,
    /// The questions beyond the answer itself.
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
            Some(Item::Load(k) | Item::LoadHead(k)) => {
                let load = scene.loads.get(k);
                load.and_then(|l| scene.cables.iter().position(|c| c.name == l.cable)).unwrap_or(0)
            }
            _ => 0,
        };
        index.min(scene.cables.len().saturating_sub(1))
    }

    /// A thing of the scene in words.
    #[must_use]
    pub fn describe(&self, item: Item) -> String {
        let scene = &self.document.scene;
        let cable = |k: usize| scene.cables.get(k).map_or("?", |c| &c.name);
        let obstacle = |k: usize| scene.obstacles.get(k).map_or("?", |o| &o.name);
        match item {
            Item::Cable(k) => format!("cable “{}”", cable(k)),
            Item::Support { cable: k, support } => {
                let s = scene.cables.get(k).and_then(|c| c.supports.get(support));
                format!("support “{}” of “{}”", s.map_or("?", |s| &s.name), cable(k))
            }
            Item::Obstacle(k) => format!("obstacle “{}”", obstacle(k)),
            Item::Corner { obstacle: k, corner } => format!("corner {} of “{}”", corner + 1, obstacle(k)),
            Item::Load(k) => format!("load {}", k + 1),
            Item::LoadHead(k) => format!("force of load {}", k + 1),
            Item::Robot => "the robot".to_owned(),
            Item::PathLeg(k) => format!("leg {} of the robot's path", k + 1),
            Item::Scene => "the scene".to_owned(),
            Item::Environment => "the environment".to_owned(),
            Item::Solver => "the solver".to_owned(),
        }
    }
}

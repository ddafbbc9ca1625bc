//! [`AppState`] consists of parts; each owns its fields and the functions that need nothing else.

use std::path::PathBuf;

use cable_core::math::Point;
use cable_core::{Model, Scene, SceneError, Settings, Solution};

use crate::jobs::{friction_range, model_comparison, neglected_bending, safe_reach};
use crate::record::recording::Recording;
use crate::record::samples::History;
use crate::render::colour::ColourScale;
use crate::state::camera::Camera;
use crate::state::clipboard::Clipboard;
use crate::state::compare::Held;
use crate::state::dialog::Dialog;
use crate::state::document::Document;
use crate::state::live::{Playback, Snapshot, WorkerStatus};
use crate::state::selection::{Grab, Item, Probe};
use crate::state::tutorial_place::TutorialPlace;
use crate::state::undo::Undo;
use crate::state::view::Layers;
use crate::units::system::System;

/// Everything the window shows.
#[derive(Debug)]
pub struct AppState {
    /// The scene being edited; may be half-typed.
    pub scene: Scene,
    /// What is wrong with it now, if anything.
    pub scene_fault: Option<SceneError>,
    /// Where the scene comes from and whether it is saved.
    pub document: Document,
    /// Scenes before and after the present one.
    pub undo: Undo,
    /// What the user picked.
    pub selected: Option<Item>,
    /// What was picked besides: moved, copied and removed with it.
    pub also: Vec<Item>,
    /// Two corners of the frame being drawn round things to pick, m.
    pub frame_m: Option<[Point; 2]>,
    /// What was copied.
    pub clipboard: Clipboard,
    /// Where on a cable it is shown where the tension comes from.
    pub probe: Option<Probe>,
    /// What the pointer is over.
    pub hovered: Option<Item>,
    /// What is being dragged.
    pub grabbed: Option<Grab>,
    /// The support (cable, support) that the pointer holds by a spring while time runs.
    pub pulled: Option<(usize, usize)>,
    /// Where the pointer is, m; None outside the canvas.
    pub cursor_m: Option<Point>,
    /// The part of the world on screen.
    pub camera: Camera,
    /// Whether and how fast time runs.
    pub playback: Playback,
    /// The model asked for.
    pub model: Model,
    /// Mesh and accuracy asked for.
    pub settings: Settings,
    /// How the cable is coloured.
    pub colour: ColourScale,
    /// What is drawn.
    pub layers: Layers,
    /// The answer on screen: the latest, or an earlier one of the recording.
    pub snapshot: Snapshot,
    /// The latest answer.
    pub live: Snapshot,
    /// Every answer since the last start, and which of them is on screen.
    pub recording: Recording,
    /// Instants of a run that was opened, to be recorded once its scene is solved.
    pub reopened: Vec<Solution>,
    /// Answers kept on screen to compare with.
    pub held: Vec<Held>,
    /// Speed of the robot by hand, m/s, positive to the right; None: it follows its path.
    pub robot_order: Option<f64>,
    /// Speed the robot is driven with by hand, m/s; None: its greatest.
    pub robot_speed: Option<f64>,
    /// Where the robot or an end can be taken.
    pub reach: safe_reach::View,
    /// The part of the world that the canvas shows, lower left and upper right corner, m.
    pub visible_m: [Point; 2],
    /// What every model says of a scene.
    pub models: model_comparison::Progress,
    /// What neglecting bending stiffness changes.
    pub bending: neglected_bending::View,
    /// What less and more friction does.
    pub spread: friction_range::View,
    /// The guided scene that is on.
    pub guide: Option<TutorialPlace>,
    /// How the solver thread is doing.
    pub worker: WorkerStatus,
    /// Tension and reactions against time since the last start.
    pub history: History,
    /// Number of the last edit sent to the worker.
    pub edits_sent: u64,
    /// Time from the last edit to the first picture that shows it, s.
    pub edit_latency_s: Option<f64>,
    /// Why unsaved changes could not be kept for recovery.
    pub autosave_fault: Option<String>,
    /// The user agreed to close the window without saving.
    pub closing: bool,
    /// The dialog that is open.
    pub dialog: Option<Dialog>,
    /// Units on screen; files stay SI.
    pub units: System,
    /// Light or dark.
    pub theme: egui::ThemePreference,
}

impl AppState {
    /// The window's contents when it opens on a scene.
    #[must_use]
    pub fn new(scene: Scene, path: Option<PathBuf>) -> Self {
        Self {
            scene_fault: scene.validate().err(),
            document: Document { path, saved: scene.clone(), recovered: false },
            scene,
            undo: Undo::default(),
            selected: None,
            also: Vec::new(),
            frame_m: None,
            clipboard: Clipboard::default(),
            probe: None,
            hovered: None,
            grabbed: None,
            pulled: None,
            cursor_m: None,
            camera: Camera::default(),
            playback: Playback { paused: true, speed: 1.0 },
            model: Model::Auto,
            settings: Settings::default(),
            colour: ColourScale::default(),
            layers: Layers {
                grid: true,
                labels: true,
                contacts: true,
                forces: true,
                components: false,
                nodes: false,
                snap: false,
            },
            snapshot: Snapshot::default(),
            live: Snapshot::default(),
            recording: Recording::default(),
            reopened: Vec::new(),
            held: Vec::new(),
            robot_order: None,
            robot_speed: None,
            reach: safe_reach::View::default(),
            visible_m: [[-1.0; 2], [1.0; 2]],
            models: model_comparison::Progress::None,
            bending: neglected_bending::View::default(),
            spread: friction_range::View::default(),
            guide: None,
            worker: WorkerStatus::Idle,
            history: History::default(),
            edits_sent: 0,
            edit_latency_s: None,
            autosave_fault: None,
            closing: false,
            dialog: None,
            units: System::Si,
            theme: egui::ThemePreference::System,
        }
    }

    /// The scene differs from its file.
    #[must_use]
    pub fn unsaved(&self) -> bool {
        self.document.recovered || self.scene != self.document.saved
    }

    /// Takes in the latest answer, which is on screen unless an earlier one is.
    pub fn take(&mut self, snapshot: Snapshot) {
        self.live = snapshot;
        self.refresh();
    }

    /// Shows an earlier time of the recording (s), or the present.
    pub fn show_time(&mut self, time_s: Option<f64>) {
        if self.recording.shown_s.is_some() || time_s.is_some() {
            self.recording.shown_s = time_s;
            self.refresh();
        }
    }

    /// Puts what is to be shown on screen.
    pub fn refresh(&mut self) {
        self.snapshot = self.live.clone();
        if let Some(shown) = self.recording.shown() {
            self.snapshot.solution = Some(shown);
            self.snapshot.real_speed = None;
        }
    }

    /// Everything picked.
    #[must_use]
    pub fn picks(&self) -> Vec<Item> {
        self.selected.into_iter().chain(self.also.iter().copied()).collect()
    }

    /// Whether a thing is picked.
    #[must_use]
    pub fn picked(&self, item: Item) -> bool {
        self.selected == Some(item) || self.also.contains(&item)
    }

    /// The cable that panels edit: the selected one, else that of the selected support, else the first.
    #[must_use]
    pub fn current_cable(&self) -> usize {
        let index = match self.selected {
            Some(Item::Cable(cable) | Item::Support { cable, .. }) => cable,
            Some(Item::Load(k) | Item::Head(k)) => self
                .scene
                .loads
                .get(k)
                .and_then(|l| self.scene.cables.iter().position(|c| c.name == l.cable))
                .unwrap_or(0),
            _ => 0,
        };
        index.min(self.scene.cables.len().saturating_sub(1))
    }
}

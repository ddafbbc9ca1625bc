//! The state is what is on screen: everything panels and the canvas read.
//!
//! Only [`crate::command::apply`] changes it.
//! - [`camera`]: the part of the world on screen
//! - [`dialog`]: the dialog that is open
//! - [`undo`]: scenes before and after the present one

pub mod camera;
pub mod dialog;
pub mod undo;
use std::path::PathBuf;
use std::sync::Arc;

use cable_core::math::Point;
use cable_core::timeline::RunPeaks;
use cable_core::{Model, Scene, SceneError, Settings, Solution};

use crate::app::tutorials;
use crate::command::clipboard::Clipboard;
use crate::jobs::friction_range;
use crate::jobs::model_comparison;
use crate::jobs::neglected_bending;
use crate::jobs::safe_reach;
use crate::record::recording::Recording;
use crate::record::run::Run;
use crate::record::samples::History;
use crate::render::colour::ColourScale;
use crate::state::camera::Camera;
use crate::state::dialog::Dialog;
use crate::state::undo::Undo;
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
    pub guide: Option<tutorials::Place>,
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

/// A thing on the canvas that can be picked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Item {
    /// A whole cable.
    Cable(usize),
    /// A support of a cable.
    Support {
        /// Index of the cable.
        cable: usize,
        /// Index of the support.
        support: usize,
    },
    /// A whole obstacle.
    Obstacle(usize),
    /// A corner of an obstacle.
    Corner {
        /// Index of the obstacle.
        obstacle: usize,
        /// Index of the corner.
        corner: usize,
    },
    /// A point load.
    Load(usize),
    /// The head of a load's arrow: its force.
    Head(usize),
    /// The robot.
    Robot,
    /// Where a leg of the robot's path ends.
    Leg(usize),
}

/// A place on a cable whose tension is taken apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Index of the cable.
    pub cable: usize,
    /// Where on it, m.
    pub arc_length_m: f64,
    /// The end the sum begins at.
    pub from: cable_core::analysis::tension_budget::StartEnd,
}

/// A thing being dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grab {
    /// What.
    pub item: Item,
    /// From the pointer to it when it was picked up, m.
    pub offset_m: Point,
}

/// Whether and how fast time runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Time stands still.
    pub paused: bool,
    /// Simulated seconds per second, 0.01 to 4.
    pub speed: f64,
}

impl Playback {
    /// Slowest speed factor.
    pub const MIN_SPEED: f64 = 0.01;
    /// Fastest speed factor.
    pub const MAX_SPEED: f64 = 4.0;
}

/// What is drawn on the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Grid lines and axes.
    pub grid: bool,
    /// Names and coordinates.
    pub labels: bool,
    /// Contact normals and friction.
    pub contacts: bool,
    /// Loads, reactions and wind.
    pub forces: bool,
    /// The parts of each force to the right and upwards.
    pub components: bool,
    /// The model's nodes.
    pub nodes: bool,
    /// Dragged points land on the grid.
    pub snap: bool,
}

/// The latest answer of the worker.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// The scene it answers, as it was then.
    pub scene: Option<Arc<Scene>>,
    /// The last good answer.
    pub solution: Option<Arc<Solution>>,
    /// The greatest tensions of each cable in the run so far; empty where it is not known from its start.
    pub peaks: Vec<RunPeaks>,
    /// Wall time of the solve or of the steps it took, s.
    pub solve_wall_s: f64,
    /// Why the present scene has no answer.
    pub error: Option<String>,
    /// `solution` is not of the present scene (it failed, or is still being solved).
    pub stale: bool,
    /// `solution` has few segments, to follow the hand; the answer comes once the hand rests.
    pub draft: bool,
    /// Simulated seconds per second actually reached; None while paused.
    pub real_speed: Option<f64>,
    /// Number of the last edit it includes.
    pub edit: u64,
}

/// An answer that is kept to compare with.
#[derive(Clone, Debug)]
pub struct Held {
    /// What it is of.
    pub name: String,
    /// The scene it answers.
    pub scene: Arc<Scene>,
    /// The answer.
    pub solution: Arc<Solution>,
    /// Wall time it took, s.
    pub wall_s: f64,
    /// The run it is the end of, where time ran.
    pub run: Option<Arc<Run>>,
}

impl Held {
    /// Most that are held: more lines cannot be told apart.
    pub const MOST: usize = 8;

    /// What to draw beside a picture of a time, s: the same time of its run.
    #[must_use]
    pub fn picture(&self, time_s: f64) -> &Solution {
        self.run.as_ref().and_then(|r| r.at(time_s)).unwrap_or(&self.solution)
    }
}

/// How the solver thread is doing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum WorkerStatus {
    /// Waiting for work.
    #[default]
    Idle,
    /// Working on an edit.
    Busy,
    /// Gone, with what it said last.
    Dead(String),
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

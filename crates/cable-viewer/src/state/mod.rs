//! The state is what is on screen: everything panels and the canvas read.
//!
//! Only [`crate::command::apply`] changes it.
//! - `app_state`: the parts put together
//! - `document`, `undo`: the scene being edited, and the scenes before and after it
//! - `selection`, `clipboard`: what is picked, hovered, dragged and copied
//! - `view`, `camera`: how the scene is drawn
//! - `live`: what the worker answered, and how time runs
//! - `answer_freshness`: whether what is on screen answers the scene as it is
//! - `solver`: what the worker is asked for
//! - `analysis`, `job_questions`: what is asked beyond the answer, and of which scene
//! - `ui`, `dialog`: the window itself and its dialog
//! - `first_steps`, `tutorial_place`: the hints that are still open, and the tutorial that is on

pub mod analysis;
pub mod answer_freshness;
pub mod app_state;
pub mod camera;
pub mod clipboard;
pub mod dialog;
pub mod document;
pub mod first_steps;
pub mod job_questions;
pub mod live;
pub mod selection;
pub mod solver;
pub mod tutorial_place;
pub mod ui;
pub mod undo;
pub mod view;

pub use crate::state::analysis::{Reference, TensionMarker};
pub use crate::state::answer_freshness::Freshness;
pub use crate::state::app_state::AppState;
pub use crate::state::document::Document;
pub use crate::state::first_steps::{FirstStep, FirstSteps};
pub use crate::state::live::{NoAnswer, Playback, Snapshot};
pub use crate::state::selection::{Grab, Item};
pub use crate::state::solver::WorkerStatus;
pub use crate::state::ui::{GraphRequest, OpenPanels, ToolSection};
pub use crate::state::view::Layers;

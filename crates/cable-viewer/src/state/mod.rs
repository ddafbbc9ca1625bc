//! The state is what is on screen: everything panels and the canvas read.
//!
//! Only [`crate::command::apply`] changes it.
//! - `app_state`: the parts put together
//! - `document`, `undo`: the scene being edited, and the scenes before and after it
//! - `selection`, `clipboard`: what is picked, hovered, dragged and copied
//! - `view`, `camera`: how the scene is drawn
//! - `live`: what the worker answered, and how time runs
//! - `compare`, `questions`: answers kept beside the present one, and what the jobs are asked
//! - `dialog`, `tutorial_place`: what the user is asked, and the tutorial that is on

pub mod app_state;
pub mod camera;
pub mod clipboard;
pub mod compare;
pub mod dialog;
pub mod document;
pub mod live;
pub mod questions;
pub mod selection;
pub mod tutorial_place;
pub mod undo;
pub mod view;

pub use crate::state::app_state::AppState;
pub use crate::state::compare::Held;
pub use crate::state::document::Document;
pub use crate::state::live::{Playback, Snapshot, WorkerStatus};
pub use crate::state::selection::{Grab, Item, Probe};
pub use crate::state::view::Layers;

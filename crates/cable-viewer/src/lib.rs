//! The cable simulator's window is a library under a thin `main`.
//!
//! [`state::AppState`] is what is on screen. Panels and canvas read it and push
//! [`command::Command`]s; [`command::apply`] is the one place that changes it. The [`worker`] owns
//! the simulation on a thread of its own.
//!
//! The rooms, each importing only from those above it:
//! - `units`: numbers with their unit, SI or US, as text and back
//! - `render`: colours, themes, drawing without a GPU or without a window
//! - `widgets`: fields, icons, rows and tables that panels are made of
//! - `record`: what was seen since the last start, and runs kept to compare with
//! - `io`: every file the window reads or writes
//! - `jobs`: long computations beside the window
//! - `state`: everything the window shows, in parts
//! - `geometry`: where things of the scene are, and what lies under the pointer
//! - `worker`: the simulation, on its thread
//! - `command`: every edit and action, and the one place that applies them
//! - `plot`, `panels`, `canvas`: the graphs, the forms beside the picture of the scene, the picture
//! - `app`: the window that puts them together

pub mod app;
pub mod canvas;
pub mod command;
pub mod geometry;
pub mod io;
pub mod jobs;
pub mod panels;
pub mod plot;
pub mod record;
pub mod render;
pub mod state;
pub mod units;
pub mod widgets;
pub mod worker;

pub use crate::app::ViewerApp;

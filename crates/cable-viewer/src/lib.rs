//! The cable simulator's window: a library under a thin `main`.
//!
//! [`state::AppState`] is what is on screen. Panels and canvas read it and push [`command::Command`]s;
//! [`command::apply`] is the one place that changes it. The [`worker`] owns the simulation.

pub mod app;
pub mod autosave;
pub mod background;
pub mod bending;
pub mod camera;
pub mod canvas;
pub mod colour;
pub mod command;
pub mod dialog;
pub mod feedback;
pub mod guide;
pub mod history;
pub mod models;
pub mod panels;
pub mod plot;
pub mod reach;
pub mod recording;
pub mod run;
pub mod scene_file;
pub mod screenshot;
pub mod software;
pub mod spread;
pub mod state;
pub mod theme;
pub mod undo;
pub mod units;
pub mod worker;

pub use app::ViewerApp;

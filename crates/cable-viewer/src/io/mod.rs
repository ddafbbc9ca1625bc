//! This wing reads and writes every file of the window; its errors are sentences that a dialog can
//! show.
//!
//! - `scene_file`: scenes
//! - `recent_files`, `first_steps_mark`: what was opened last, and that the hints were followed
//! - `folder`: what is in a folder, for dialogs that ask for a path
//! - `saved_run`: the folder of a run, read again
//! - `graph_file`: what is in view of a graph, as CSV, SVG or PNG
//! - `graph_in_view`, `graph_drawing`: what that is, and how it is drawn, once for SVG and PNG
//! - `picture_file`: a picture as PNG
//! - `autosave`: unsaved changes, kept for a window that dies
//! - `feedback`: what a user thinks, as a row of a table

pub mod autosave;
pub mod feedback;
pub mod first_steps_mark;
pub mod folder;
pub mod graph_drawing;
pub mod graph_file;
pub mod graph_in_view;
pub mod picture_file;
pub mod recent_files;
pub mod saved_run;
pub mod scene_file;

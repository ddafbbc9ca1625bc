//! The panels are the forms beside the canvas. A panel only reads the state and pushes commands.
//!
//! - `scene`: the outline on the left, and the forms of what stands in it
//! - `selected_item`, `cable`, `environment`, `robot`, `solver`: the form of what is selected, on
//!   the right
//! - `readouts`, `warnings`, `analysis`: what was answered, on the right
//! - `quality`: how far the answer can be relied on, in the solver panel
//! - `plots`, `playback`, `timeline`: graphs and time, below
//! - `scene_errors`: what is wrong with the scene, beside the field where it was typed
//! - `display_names`: keys of scene files and names of models as the window says them
//! - `pin_names`: pinned results, named by what they are of

pub mod analysis;
pub mod cable;
pub mod display_names;
pub mod environment;
pub mod pin_names;
pub mod playback;
pub mod plots;
pub mod quality;
pub mod readouts;
pub mod robot;
pub mod scene;
pub mod scene_errors;
pub mod selected_item;
pub mod solver;
pub mod timeline;
pub mod warnings;

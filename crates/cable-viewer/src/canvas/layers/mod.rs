//! The picture of the scene consists of these layers, which [`crate::canvas::ui`] draws back to
//! front.
//!
//! - `grid`, `obstacles`, `robot`, `robot_path`: the surroundings
//! - `cable`, `breaks`, `contact`, `supports`, `forces`: the answer
//! - `surface_offset`: a cable that is drawn thicker than it is lies on surfaces, not in them
//! - `compare_overlay`, `tension_marker`, `safe_reach`: analyses drawn over it
//! - `annotations`, `legend`: names and figures, and what the colours mean
//! - `no_answer`: why there is no new answer

pub mod annotations;
pub mod breaks;
pub mod cable;
pub mod compare_overlay;
pub mod contact;
pub mod forces;
pub mod grid;
pub mod legend;
pub mod no_answer;
pub mod obstacles;
pub mod robot;
pub mod robot_path;
pub mod safe_reach;
pub mod supports;
pub mod surface_offset;
pub mod tension_marker;

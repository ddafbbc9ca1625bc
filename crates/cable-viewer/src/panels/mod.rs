//! The panels: each reads the state and pushes commands, nothing else.

pub mod cable;
pub mod environment;
pub mod playback;
pub mod plots;
pub mod readouts;
pub mod scene;
pub mod solver;
pub mod warnings;

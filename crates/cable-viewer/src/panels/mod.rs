//! The panels: each reads the state and pushes commands, nothing else.

pub mod cable;
pub mod compare;
pub mod environment;
pub mod fault;
pub mod field;
pub mod icon;
pub mod origin;
pub mod playback;
pub mod plots;
pub mod property;
pub mod reach;
pub mod readouts;
pub mod robot;
pub mod scene;
pub mod solver;
pub mod spread;
pub mod system;
pub mod timeline;
pub mod times;
pub mod translate;
pub mod unit;
pub mod warnings;

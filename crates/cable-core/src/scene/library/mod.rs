//! The library holds what comes with the program: named scenes (`catalog.rs`) and presets of
//! cables, robots and maps (`preset.rs`).

pub mod catalog;
pub mod preset;

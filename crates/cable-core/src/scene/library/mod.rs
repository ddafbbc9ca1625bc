//! The library holds what comes with the program: named scenes (`catalog.rs`) and presets of
//! cables, robots and maps (`preset.rs`).
//!
//! | room | content |
//! |---|---|
//! | `catalog.rs` | named scenes embedded from `assets/scenes/` |
//! | `preset.rs` | presets of cables, robots and maps; each figure with source and confidence |

pub mod catalog;
pub mod preset;

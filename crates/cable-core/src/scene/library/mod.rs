//! The library holds the built-in named scenes (`catalog.rs`) and the built-in presets of cables,
//! robots and maps (`preset.rs`).
//!
//! | room | content |
//! |---|---|
//! | `catalog.rs` | named scenes embedded from `assets/scenes/` |
//! | `preset.rs` | presets of cables, robots and maps; each figure with source and confidence |

pub mod catalog;
pub mod preset;

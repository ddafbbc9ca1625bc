//! This wing says how things are drawn: colours, themes, and renderers for machines without a GPU
//! or window.
//!
//! - `colour`: a quantity along the cable as a colour
//! - `theme`: the palettes of light and dark
//! - `software_adapter_shader`: egui's picture, drawn faster where there is no GPU
//! - `changed_tiles`: the parts of a frame that differ from the frame before
//! - `offscreen`, `triangle_rasteriser`: frames without a window, and their pixels without a
//!   graphics adapter
//! - `svg`: a frame's shapes as a drawing

pub mod changed_tiles;
pub mod colour;
pub mod offscreen;
pub mod software_adapter_shader;
pub mod svg;
pub mod theme;
pub mod triangle_rasteriser;

//! This wing says how things are drawn: colours, themes, and renderers for machines without a GPU
//! or window.
//!
//! - `colour`: a quantity along the cable as a colour
//! - `theme`: the palettes of light and dark
//! - `software`: egui's picture, drawn faster where there is no GPU
//! - `offscreen`, `raster`: frames without a window, and their pixels without a graphics adapter
//! - `svg`: a frame's shapes as a drawing

pub mod colour;
pub mod offscreen;
pub mod raster;
pub mod software;
pub mod svg;
pub mod theme;

//! The window drawn to a picture file, without a window.

use std::path::Path;

use cable_core::Scene;
use egui_kittest::Harness;

use crate::ViewerApp;

/// Draws a scene at a size in points and writes a PNG.
///
/// # Errors
/// What is missing, in one sentence with the remedy.
pub fn save(scene: Scene, path: &Path, size: [u32; 2]) -> Result<(), String> {
    let mut harness = Harness::builder()
        .with_size([size[0] as f32, size[1] as f32])
        .with_render_cursor(false)
        .allow_missing_glyphs()
        .build_eframe(|cc| ViewerApp::inline(&cc.egui_ctx, scene, None));
    harness.run_steps(4);
    let picture = harness.render()?;
    picture.save(path).map_err(|e| format!("{} could not be written: {e}", path.display()))
}

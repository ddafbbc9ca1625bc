//! The window is drawn to a picture file, without a window.

use std::path::Path;
use std::time::{Duration, Instant};

use cable_core::Scene;
use egui_kittest::Harness;
use image::RgbaImage;

use crate::ViewerApp;
use crate::jobs::safe_reach::Progress;
use crate::render::offscreen::renderer;

/// Frames after which a picture is taken: the first lays out, the second fits and solves, the
/// others settle scroll bars.
const FRAMES: usize = 6;
/// Longest time that a job beside the window is waited for.
const LONGEST_WAIT: Duration = Duration::from_secs(300);

/// Draws a scene at a size in points and writes a PNG; `prepare` sets what is to be shown.
///
/// # Errors
/// The missing thing, in one sentence with the remedy.
pub fn save(
    scene: Scene,
    path: &Path,
    size: [u32; 2],
    prepare: impl FnOnce(&mut ViewerApp, &egui::Context),
) -> Result<(), String> {
    let picture = draw(scene, size, prepare)?;
    picture.save(path).map_err(|e| format!("{} could not be written: {e}", path.display()))
}

/// Draws a scene at a size in points.
///
/// # Errors
/// The missing thing, in one sentence with the remedy.
pub fn draw(
    scene: Scene,
    size: [u32; 2],
    prepare: impl FnOnce(&mut ViewerApp, &egui::Context),
) -> Result<RgbaImage, String> {
    draw_after(scene, size, FRAMES, prepare)
}

/// Draws a scene at a size in points after some frames, and once what is computed beside the window
/// is done.
///
/// # Errors
/// The missing thing, in one sentence with the remedy.
pub fn draw_after(
    scene: Scene,
    size: [u32; 2],
    frames: usize,
    prepare: impl FnOnce(&mut ViewerApp, &egui::Context),
) -> Result<RgbaImage, String> {
    let mut harness = Harness::builder()
        .with_size([size[0] as f32, size[1] as f32])
        .with_step_dt(1.0 / 60.0)
        .with_render_cursor(false)
        .allow_missing_glyphs()
        .with_accessibility_check(false)
        .renderer(renderer()?)
        .build_eframe(|cc| {
            let mut app = ViewerApp::inline(&cc.egui_ctx, scene, None);
            // A picture is of the scene, not of hints for a hand.
            app.state.ui.first_steps.hide();
            prepare(&mut app, &cc.egui_ctx);
            app
        });
    harness.run_steps(frames);
    let began = Instant::now();
    while matches!(harness.state().state.analysis.safe_reach.progress, Progress::Running(..)) {
        if began.elapsed() > LONGEST_WAIT {
            return Err("the map of the safe reach takes too long on this machine".to_owned());
        }
        std::thread::sleep(Duration::from_millis(50));
        harness.step();
    }
    harness.render()
}

//! The window is drawn to a picture file, without a window.

use std::path::Path;
use std::time::{Duration, Instant};

use cable_core::Scene;
use image::RgbaImage;

use crate::ViewerApp;
use crate::jobs::safe_reach::Progress;
use crate::render::offscreen::Offscreen;

/// Frames after which a picture is taken: the first lays out, the second fits and solves, the
/// others settle scroll bars.
const FRAMES: usize = 6;
/// Longest time that a job beside the window is waited for.
const MAX_WAIT: Duration = Duration::from_secs(300);

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
    let mut offscreen = Offscreen::new(size, 1.0);
    let ctx = offscreen.ctx().clone();
    let mut app = ViewerApp::inline(&ctx, scene, None);
    // A picture is of the scene, not of hints for a hand.
    app.state.ui.first_steps.hide();
    prepare(&mut app, &ctx);
    for _ in 0..frames {
        offscreen.frame(|ui| app.frame(ui));
    }
    let began = Instant::now();
    while matches!(app.state.analysis.safe_reach.progress, Progress::Running(..)) {
        if began.elapsed() > MAX_WAIT {
            return Err("the map of the safe reach takes too long on this machine".to_owned());
        }
        std::thread::sleep(Duration::from_millis(50));
        offscreen.frame(|ui| app.frame(ui));
    }
    Ok(offscreen.picture(ctx.global_style().visuals.panel_fill))
}

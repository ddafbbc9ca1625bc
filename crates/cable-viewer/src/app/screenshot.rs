//! The window drawn to a picture file, without a window.

use std::future::Future;
use std::path::Path;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

use cable_core::Scene;
use eframe::egui_wgpu;
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, default_wgpu_setup};
use image::RgbaImage;

use crate::ViewerApp;

/// Frames after which a picture is taken: the first lays out, the second fits and solves, the others settle scroll bars.
const FRAMES: usize = 6;

/// Draws a scene at a size in points and writes a PNG; `prepare` sets what is to be shown.
///
/// # Errors
/// What is missing, in one sentence with the remedy.
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
/// What is missing, in one sentence with the remedy.
pub fn draw(
    scene: Scene,
    size: [u32; 2],
    prepare: impl FnOnce(&mut ViewerApp, &egui::Context),
) -> Result<RgbaImage, String> {
    let mut harness = Harness::builder()
        .with_size([size[0] as f32, size[1] as f32])
        .with_render_cursor(false)
        .allow_missing_glyphs()
        .with_accessibility_check(false)
        .renderer(renderer()?)
        .build_eframe(|cc| {
            let mut app = ViewerApp::inline(&cc.egui_ctx, scene, None);
            prepare(&mut app, &cc.egui_ctx);
            app
        });
    harness.run_steps(FRAMES);
    harness.render()
}

/// A renderer on whatever adapter there is.
///
/// # Errors
/// There is none.
pub fn renderer() -> Result<WgpuTestRenderer, String> {
    render_state(egui_wgpu::RendererOptions::PREDICTABLE).map(WgpuTestRenderer::from_render_state)
}

/// What draws on whatever adapter there is, without a window.
///
/// # Errors
/// There is none.
pub fn render_state(options: egui_wgpu::RendererOptions) -> Result<egui_wgpu::RenderState, String> {
    let setup = default_wgpu_setup();
    let configuration = egui_wgpu::WgpuConfiguration { wgpu_setup: setup.clone(), ..Default::default() };
    let state = ready(async move {
        let instance = setup.new_instance().await;
        egui_wgpu::RenderState::create(&configuration, &instance, None, options).await
    });
    state.map_err(|e| {
        format!(
            "no graphics adapter was found ({e}); install a Vulkan driver (Debian: mesa-vulkan-drivers) or try WGPU_BACKEND=gl"
        )
    })
}

/// Waits for a future; the native ones of wgpu are ready at once, so that polling is enough.
fn ready<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
        std::thread::yield_now();
    }
}

//! This file makes a renderer on whatever graphics adapter there is, for pictures and measurements
//! of what the window draws.

use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

use eframe::egui_wgpu;
use egui_kittest::wgpu::{WgpuTestRenderer, default_wgpu_setup};

/// A renderer on whatever adapter there is.
///
/// # Errors
/// There is none.
pub fn renderer() -> Result<WgpuTestRenderer, String> {
    render_state(egui_wgpu::RendererOptions::PREDICTABLE).map(WgpuTestRenderer::from_render_state)
}

/// A renderer on whatever adapter there is, without a window.
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

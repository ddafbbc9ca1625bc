//! Colours and spacing of the window, light and dark.

use egui::Context;

/// Sets up both themes.
pub fn install(ctx: &Context) {
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(8.0, 5.0);
    });
}

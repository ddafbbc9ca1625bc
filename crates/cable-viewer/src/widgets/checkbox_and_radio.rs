//! Boxes to tick and rings to choose by: empty ones are paper with an outline. With egui's own
//! fill, which rails of sliders need to stand off the panel, an empty box looks like a chosen one.

use egui::{Response, Stroke, Ui, WidgetText};

/// A box to tick.
pub fn checkbox(ui: &mut Ui, on: &mut bool, text: impl Into<WidgetText>) -> Response {
    outlined(ui, |ui| ui.checkbox(on, text.into()))
}

/// A radio button to choose by.
pub fn radio_button(ui: &mut Ui, chosen: bool, text: impl Into<WidgetText>) -> Response {
    outlined(ui, |ui| ui.radio(chosen, text.into()))
}

/// A radio button that sets a value.
pub fn radio_value<T: PartialEq>(ui: &mut Ui, value: &mut T, of: T, text: impl Into<WidgetText>) -> Response {
    let mut response = radio_button(ui, *value == of, text);
    if response.clicked() && *value != of {
        *value = of;
        response.mark_changed();
    }
    response
}

/// Adds a widget whose empty box has an outline.
fn outlined(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> Response) -> Response {
    let before = ui.visuals().widgets.inactive;
    let paper = ui.visuals().extreme_bg_color;
    let inactive = &mut ui.visuals_mut().widgets.inactive;
    (inactive.bg_stroke, inactive.bg_fill) = (Stroke::new(1.0, before.bg_fill), paper);
    let response = add(ui);
    ui.visuals_mut().widgets.inactive = before;
    response
}

#[cfg(test)]
mod tests {
    use egui::{Color32, Theme};

    use super::*;
    use crate::render::offscreen::Offscreen;
    use crate::render::theme;

    #[test]
    fn an_empty_box_is_empty_and_a_ticked_one_is_not() {
        for of in [Theme::Dark, Theme::Light] {
            let mut offscreen = Offscreen::new([100, 40], 2.0);
            theme::install(offscreen.ctx());
            offscreen.ctx().set_theme(of);
            let mut places = Vec::new();
            for _ in 0..3 {
                offscreen.frame(|ui| {
                    places = [false, true].map(|mut on| checkbox(ui, &mut on, "Grid").rect).to_vec();
                });
            }
            let visuals = offscreen.ctx().global_style().visuals.clone();
            let width = offscreen.ctx().global_style().spacing.icon_width;
            let picture = offscreen.picture(visuals.panel_fill);
            let inked = |rect: egui::Rect| {
                let square = egui::Rect::from_center_size(
                    egui::pos2(rect.left() + 0.5 * width, rect.center().y),
                    egui::Vec2::splat(width - 4.0),
                );
                let (low, high) = (square.min * 2.0, square.max * 2.0);
                let columns = || low.x as u32..high.x as u32;
                let pixels = (low.y as u32..high.y as u32).flat_map(|y| columns().map(move |x| (x, y)));
                let paper = visuals.extreme_bg_color;
                let ink = |(x, y): &(u32, u32)| {
                    let [r, g, b, _] = picture.get_pixel(*x, *y).0;
                    Color32::from_rgb(r, g, b) != paper
                };
                pixels.filter(ink).count()
            };
            assert_eq!(inked(places[0]), 0, "{of:?}");
            assert!(inked(places[1]) > 20, "{of:?}: {}", inked(places[1]));
        }
    }
}

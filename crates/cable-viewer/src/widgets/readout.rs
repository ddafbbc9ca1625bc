//! A readout is a name, a figure on the right, and at most a button beside it. It keeps to the
//! width of its panel: what is too long is cut and stands in full in the hover text.

use egui::{Align, Label, Layout, Ui};

/// Draws one; `beside` draws a button at the right end.
pub fn row(ui: &mut Ui, name: &str, value: &str, help: &str, beside: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 5.0;
        ui.add(Label::new(egui::RichText::new(name).weak()).extend()).on_hover_text(help);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            beside(ui);
            ui.add(Label::new(value).truncate()).on_hover_text(help);
        });
    });
}

/// A table that may be wider than its panel scrolls by itself: it must not widen what stands below.
pub fn wide(ui: &mut Ui, id: &str, contents: impl FnOnce(&mut Ui)) {
    egui::ScrollArea::horizontal().id_salt(id).auto_shrink([false, true]).show(ui, |ui| {
        contents(ui);
        // The bar must not lie over the last row.
        ui.add_space(ui.spacing().scroll.bar_width);
    });
}

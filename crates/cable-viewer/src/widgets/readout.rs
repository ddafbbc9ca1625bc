//! A readout is a name, a figure on the right, and at most a button beside it. It keeps to the
//! width of its panel: what is too long is cut and stands in full in the hover text.

use egui::{Align, Label, Layout, Ui};

use crate::widgets::icon::{self, Icon};

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

/// A row that says in the colour of warnings where something is wrong.
pub fn assessed_row(ui: &mut Ui, name: &str, value: &str, help: &str, wrong: Option<&str>) {
    let help = wrong.map_or_else(|| help.to_owned(), |wrong| format!("{wrong}. {help}"));
    row(ui, name, value, &help, |ui| {
        if wrong.is_some() {
            icon::sign(ui, Icon::Caution, ui.visuals().warn_fg_color);
        }
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

//! A property row edits one quantity: name, slider, typed value with its unit, reset.

use egui::{Response, RichText, Ui};

use crate::units::unit::Unit;
use crate::widgets::field;
use crate::widgets::icon::{self, Icon};
use crate::widgets::slider::{self, SliderRange};

/// The name, unit and usual values of a quantity.
#[derive(Clone, Copy, Debug)]
pub struct PropertyQuantity {
    /// Its name on screen, found by tests.
    pub name: &'static str,
    /// The unit it is shown and typed in.
    pub unit: Unit,
    /// Ends of the slider, SI; other values can be typed.
    pub usual: [f64; 2],
    /// Even steps of the slider are even factors.
    pub logarithmic: bool,
    /// A sentence or two on the quantity and its effect.
    pub help: &'static str,
}

/// The present value and what is known about it.
#[derive(Clone, Debug, Default)]
pub struct Provenance {
    /// Now, SI.
    pub value: f64,
    /// The value to which reset returns, SI, and its origin in a few words.
    pub origin: Option<(f64, String)>,
    /// The source of the value and how sure it is, for the hover text.
    pub source: Option<String>,
    /// The value is estimated: a mark says so.
    pub estimated: bool,
}

/// The edit that a row asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PropertyEdit {
    /// A new value, SI.
    pub value: Option<f64>,
    /// The edit is complete: the next one is undone by itself.
    pub done: bool,
}

/// Width of the typed value, points: “9.807 m/s²” and “17.00 ppm/K” fit.
const FIELD_WIDTH: f32 = 84.0;
/// Narrowest slider that can still be aimed at, points.
const MIN_SLIDER_WIDTH: f32 = 36.0;
/// Width of the reset button, points.
const RESET_WIDTH: f32 = 18.0;
/// Width of the names, points: “Bending stiffness ≈” fits.
pub const NAME_WIDTH: f32 = 122.0;

/// Draws the row; faults stand below it.
pub fn row(ui: &mut Ui, quantity: &PropertyQuantity, known: &Provenance) -> PropertyEdit {
    let mut change = PropertyEdit::default();
    let mut fault = None;
    let spent = NAME_WIDTH + FIELD_WIDTH + RESET_WIDTH + 3.0 * 4.0;
    // In a narrow panel the slider has a line of its own: it is aimed at with a hand.
    let narrow = ui.available_width() < spent + MIN_SLIDER_WIDTH;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let left = ui.available_width();
        let name_width = if narrow { left - FIELD_WIDTH - 8.0 - RESET_WIDTH - 2.0 * 4.0 } else { NAME_WIDTH };
        let mark = if known.estimated { " ≈" } else { "" };
        let label = ui
            .allocate_ui_with_layout(
                egui::vec2(name_width, ui.spacing().interact_size.y),
                egui::Layout::left_to_right(egui::Align::Center),
                |ui| {
                    ui.set_min_width(name_width);
                    ui.add(egui::Label::new(format!("{}{mark}", quantity.name)).truncate().selectable(false))
                },
            )
            .inner;
        let label_id = label.on_hover_ui(|ui| explanation(ui, quantity, known)).id;
        if !narrow {
            ui.spacing_mut().slider_width = (left - spent).max(MIN_SLIDER_WIDTH);
            slide(ui, quantity, known, &mut change);
        }
        let entry = field::number(ui, quantity.name, quantity.unit, known.value, FIELD_WIDTH);
        let response = entry.response.labelled_by(label_id);
        field::name(&response, quantity.name);
        response.on_hover_ui(|ui| explanation(ui, quantity, known));
        if let Some(value) = entry.value {
            change = PropertyEdit { value: Some(value), done: true };
        }
        fault = entry.fault;
        if reset(ui, quantity, known, fault.is_some()) {
            field::forget(ui, quantity.name);
            fault = None;
            change = PropertyEdit { value: known.origin.as_ref().map(|(v, _)| *v), done: true };
        }
    });
    if narrow {
        ui.spacing_mut().slider_width = ui.available_width() - 4.0;
        let mut slid = PropertyEdit::default();
        slide(ui, quantity, known, &mut slid);
        if change.value.is_none() {
            change = PropertyEdit { done: change.done || slid.done, ..slid };
        }
    }
    if let Some(fault) = fault {
        field::fault(ui, &fault);
    }
    change
}

/// The slider of a property.
fn slide(ui: &mut Ui, quantity: &PropertyQuantity, known: &Provenance, change: &mut PropertyEdit) {
    let si = quantity.unit.display().si;
    let rail = SliderRange { ends: quantity.usual.map(|v| v / si), logarithmic: quantity.logarithmic };
    let slid = slider::ui(ui, known.value / si, rail);
    field::name(&slid.response, &format!("{} slider", quantity.name));
    if let Some(value) = slid.value {
        change.value = Some(value * si);
    }
    change.done |= slid.done;
    slid.response.on_hover_ui(|ui| {
        explanation(ui, quantity, known);
        ui.weak(slider::drag_help(quantity.logarithmic));
    });
}

/// The button that resets a property; returns whether it was clicked.
fn reset(ui: &mut Ui, quantity: &PropertyQuantity, known: &Provenance, typed_wrong: bool) -> bool {
    let differs = known.origin.as_ref().is_some_and(|(v, _)| *v != known.value) || typed_wrong;
    let response = icon::plain_button_if(differs, ui, Icon::Reset);
    field::name(&response, &format!("Reset {}", quantity.name.to_lowercase()));
    let text = known.origin.as_ref().map_or_else(
        || "No default to go back to".to_owned(),
        |(v, from)| format!("Back to {} ({from})", quantity.unit.brief(*v)),
    );
    response.on_hover_text(&text).on_disabled_hover_text(text).clicked()
}

/// The explanation of a property on hover.
fn explanation(ui: &mut Ui, quantity: &PropertyQuantity, known: &Provenance) {
    ui.set_max_width(300.0);
    ui.label(RichText::new(quantity.name).strong());
    ui.label(quantity.help);
    ui.label(format!("Now {}", quantity.unit.brief(known.value)));
    let [low, high] = quantity.usual;
    ui.weak(format!(
        "Usually {} to {}; other values can be typed",
        quantity.unit.brief(low),
        quantity.unit.brief(high)
    ));
    if let Some(source) = &known.source {
        ui.separator();
        ui.label(source);
    }
}

/// A text in the column of names, and the widget it names beside it; `name` is what tests
/// and screen readers call it.
pub fn labelled(ui: &mut Ui, text: &str, name: &str, contents: impl FnOnce(&mut Ui) -> Response) {
    // In a narrow panel the name gives way: what is typed must be read.
    let name_width = NAME_WIDTH.min(ui.available_width() - FIELD_WIDTH - 24.0).max(MIN_SLIDER_WIDTH);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let height = ui.spacing().interact_size.y;
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let label = ui.allocate_ui_with_layout(egui::vec2(name_width, height), layout, |ui| {
            ui.set_min_width(name_width);
            ui.add(egui::Label::new(text).truncate().selectable(false)).on_hover_text(text)
        });
        let named = contents(ui).labelled_by(label.inner.id);
        field::name(&named, name);
    });
}

//! The lists of the scene panel are made of these cells, headings and fields.

use cable_core::math::Point;
use egui::{Atom, Button, Ui};

use crate::command::{Command, SceneCommand, ViewCommand};
use crate::state::{AppState, Item};
use crate::units::unit::Unit;
use crate::widgets::field;
use crate::widgets::icon::{self, Icon};
use crate::widgets::property::labelled;

/// Width of a number in a list, points: “−12.345” fits; in a narrow window “−12.34”.
const NUMBER_WIDTHS: [f32; 2] = [47.0, 41.0];
/// Narrower windows (points) have narrow panels.
const NARROW_WINDOW: f32 = 1400.0;
/// What a field has beside its text, points.
const FIELD_MARGIN: f32 = 8.0;

fn is_narrow(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() < NARROW_WINDOW
}

/// Width of a number in a list, points.
pub fn number_width(ui: &Ui) -> f32 {
    NUMBER_WIDTHS[usize::from(is_narrow(ui))]
}

/// Width of a number with its unit, points: “−123.456 m” fits.
pub const VALUE_WIDTH: f32 = 84.0;

/// Narrowest and widest column of names, points: what is left of the panel beside the others.
pub const NAME_WIDTH: [f32; 2] = [36.0, 100.0];

/// Width of the kind in a list, points.
pub const KIND_WIDTH: f32 = 60.0;

/// Gap between columns, points.
pub const GAP: f32 = 3.0;

/// The name of a thing in a list: picks it.
pub fn selectable_name(ui: &mut Ui, state: &AppState, item: Item, name: &str, commands: &mut Vec<Command>) {
    let selected = state.selection.selected == Some(item);
    let button = Button::selectable(selected, (name, Atom::grow())).truncate();
    let width = name_width(ui);
    let response = cell(ui, width, |ui| ui.add(button.min_size(egui::vec2(width, 0.0))));
    field::name(&response, &format!("Select {name}"));
    if response.on_hover_text(format!("{name}: click to see and edit everything about it")).clicked() {
        let item = if selected { None } else { Some(item) };
        commands.push(Command::View(ViewCommand::Select(item)));
    }
}

/// Width of the column of names at the start of a line, points.
pub fn name_width(ui: &Ui) -> f32 {
    // The other columns and the cross at the end.
    let beside = KIND_WIDTH + 2.0 * (number_width(ui) + FIELD_MARGIN) + 3.0 * GAP + 17.0;
    (ui.available_width() - beside).clamp(NAME_WIDTH[0], NAME_WIDTH[1])
}

/// A cell of a list, so that columns stand under each other.
pub fn cell<R>(ui: &mut Ui, width: f32, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let size = egui::vec2(width, ui.spacing().interact_size.y);
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let shown = ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_width(width);
        ui.set_max_width(width);
        contents(ui)
    });
    shown.inner
}

/// The headings of a list; the last two or three stand over numbers.
pub fn headings(ui: &mut Ui, texts: &[(&str, f32)]) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for (k, (text, width)) in texts.iter().enumerate() {
            cell(ui, *width, |ui| {
                if k == 0 {
                    ui.add_space(4.0);
                }
                ui.weak(*text);
            });
        }
    });
}

/// The button that takes a thing out.
pub fn remove(ui: &mut Ui, item: Item, name: &str, help: &str, commands: &mut Vec<Command>) {
    let response = icon::plain_button(ui, Icon::Remove, true);
    field::name(&response, &format!("Remove {name}"));
    if response.on_hover_text(help).clicked() {
        commands.push(Command::Scene(SceneCommand::Remove(item)));
    }
}

/// Two typed coordinates; the point once one was entered.
pub fn coordinates(ui: &mut Ui, of: &str, at_m: Point, faults: &mut Vec<String>) -> Option<Point> {
    components(ui, ["x of ", "y of "].map(|c| format!("{c}{of}")), Unit::COORDINATE, at_m, faults)
}

/// Two typed components of a vector; the unit stands in the heading.
pub fn components(
    ui: &mut Ui,
    labels: [String; 2],
    unit: Unit,
    value: Point,
    faults: &mut Vec<String>,
) -> Option<Point> {
    let mut entered = None;
    // In a narrow list the last decimal is left to the hover text and to who types.
    let decimals = if is_narrow(ui) { unit.decimals.map(|d| d.min(2)) } else { unit.decimals };
    let (shown, width) = (Unit { decimals, ..unit.bare() }, number_width(ui));
    for (k, label) in labels.iter().enumerate() {
        let entry = field::number(ui, label, shown, value[k], width);
        if let Some(component) = entry.value {
            let mut changed = value;
            changed[k] = component;
            entered = Some(changed);
        }
        faults.extend(entry.fault);
        entry.response.on_hover_text(format!("{label}: {}", unit.brief(value[k])));
    }
    entered
}

/// A named number that may be left out; `Some` once it was entered.
pub fn optional(
    ui: &mut Ui,
    [name, help]: [&str; 2],
    unit: Unit,
    value: Option<f64>,
    faults: &mut Vec<String>,
) -> Option<f64> {
    let mut entered = None;
    labelled(ui, name, name, |ui| {
        let entry = field::number(ui, name, unit, value.unwrap_or(0.0), VALUE_WIDTH);
        entered = entry.value;
        faults.extend(entry.fault);
        entry.response.on_hover_text(help)
    });
    entered
}

/// Faults below the row they belong to.
pub fn show_faults(ui: &mut Ui, faults: &[String]) {
    for text in faults {
        field::fault(ui, text);
    }
}

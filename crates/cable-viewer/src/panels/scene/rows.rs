//! The outline is made of these rows, the forms of supports, obstacles and loads of these cells and
//! fields.

use cable_core::math::Point;
use egui::{Atom, AtomExt, Button, Ui};

use crate::command::{Command, ViewCommand};
use crate::panels::display_names::capital;
use crate::panels::readouts::OUTDATED_FIGURE_OPACITY;
use crate::state::{AppState, Item};
use crate::units::unit::Unit;
use crate::widgets::field;
use crate::widgets::property::labelled;

/// Width of a number beside another, points: “−12.345” fits.
pub const NUMBER_WIDTH: f32 = 47.0;
/// Between a line and the canvas, points: a text that is cut may be a little wider than it is
/// given.
const RIGHT_MARGIN: f32 = 6.0;
/// Width of a field beyond its text, points.
const FIELD_MARGIN: f32 = 8.0;

/// Least and greatest width of the name of two numbers, points.
const NAME_WIDTH: [f32; 2] = [56.0, 122.0];

/// Width of a number with its unit, points: “−123.456 m” fits.
pub const VALUE_WIDTH: f32 = 84.0;

/// Gap between columns, points.
pub const GAP: f32 = 3.0;

/// A row with the name of an item, and a word about it at the right end.
pub fn row(ui: &mut Ui, state: &AppState, item: Item, name: &str, about: &str, commands: &mut Vec<Command>) {
    let selected = state.selection.selected == Some(item);
    let colour = if selected { ui.visuals().text_color() } else { ui.visuals().weak_text_color() };
    let opacity = if state.is_current() { 1.0 } else { OUTDATED_FIGURE_OPACITY };
    let about = egui::RichText::new(about).color(colour.gamma_multiply(opacity));
    // A name given by the user gives way to the word about it, but what is always called the same
    // does not.
    let about = about
        .atom_shrink(matches!(item, Item::Scene | Item::Robot | Item::PathLeg(_) | Item::Environment | Item::Solver));
    let button = Button::selectable(selected, (name, Atom::grow(), about)).truncate();
    let width = ui.available_width() - RIGHT_MARGIN;
    let row = ui.scope(|ui| {
        ui.set_max_width(width);
        ui.add(button.min_size(egui::vec2(width, 0.0)))
    });
    let response = row.inner;
    field::name(&response, &format!("Select {name}"));
    if response.on_hover_text(format!("{}: click to select it", capital(&state.describe(item)))).clicked() {
        commands.push(Command::View(ViewCommand::Select((!selected).then_some(item))));
    }
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

/// Two numbers beside one name.
pub fn pair(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let beside = 2.0 * (NUMBER_WIDTH + FIELD_MARGIN) + 2.0 * GAP;
        let width = (ui.available_width() - beside).clamp(NAME_WIDTH[0], NAME_WIDTH[1]);
        cell(ui, width, |ui| ui.add(egui::Label::new(name).truncate().selectable(false)).on_hover_text(name));
        contents(ui);
    });
}

/// A row with the coordinates of an item beside their name.
pub fn place(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    named_place(ui, "Position", contents);
}

/// The same with another name than “Position”.
pub fn named_place(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui)) {
    pair(ui, &format!("{name}, {}", Unit::M.display().symbol), contents);
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
    for (k, label) in labels.iter().enumerate() {
        let entry = field::number(ui, label, unit.bare(), value[k], NUMBER_WIDTH);
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

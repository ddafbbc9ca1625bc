//! The point loads: on which cable, where, how much.

use cable_core::Load;
use egui::{ComboBox, Ui};

use super::{GAP, KIND_WIDTH, NAME_WIDTH, NUMBER_WIDTH, components, headings, remove, selectable_name, show_faults};
use crate::command::{Command, SceneCommand};
use crate::panels::property::{Known, Quantity, row};
use crate::panels::unit::Unit;
use crate::panels::{fault, field};
use crate::state::{AppState, Item};

/// Force of a new load, N.
const FIRST_LOAD_N: [f64; 2] = [0.0, -100.0];

const STRENGTH: Quantity = Quantity {
    name: "Load force",
    unit: Unit::N,
    usual: [1.0, 5000.0],
    logarithmic: true,
    help: "How strong the selected load is, in the direction it has; the cable follows while the slider moves.",
};

/// Draws them.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    if !state.scene.loads.is_empty() {
        let (length, force) = (Unit::M.shown().symbol, Unit::N.shown().symbol);
        let [at, right, up] = [format!("At, {length}"), format!("Right, {force}"), format!("Up, {force}")];
        let columns = [("Name", NAME_WIDTH), (&*at, KIND_WIDTH), (&*right, NUMBER_WIDTH), (&*up, NUMBER_WIDTH)];
        headings(ui, &columns);
    }
    for (k, load) in state.scene.loads.iter().enumerate() {
        ui.push_id(k, |ui| line(ui, state, k, load, commands));
        fault::inline(ui, state, &format!("loads[{k}]"), commands);
    }
    let Some(cable) = state.scene.cables.get(state.current_cable()) else { return };
    if ui.button("Add load").on_hover_text("A force on the middle of the cable, 100 N down").clicked() {
        let load = Load {
            cable: cable.name.clone(),
            arc_length_m: cable.length_m / 2.0,
            force_n: Some(FIRST_LOAD_N),
            times_s: Vec::new(),
            forces_n: Vec::new(),
        };
        commands.push(Command::Scene(SceneCommand::AddLoad(load)));
    }
}

fn line(ui: &mut Ui, state: &AppState, k: usize, load: &Load, commands: &mut Vec<Command>) {
    let item = Item::Load(k);
    let name = format!("load {}", k + 1);
    let mut faults = Vec::new();
    let set = |value: Load, commands: &mut Vec<Command>| {
        commands.push(Command::Scene(SceneCommand::SetLoad { load: k, value }));
        commands.push(Command::Scene(SceneCommand::EditDone));
    };
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        selectable_name(ui, state, item, &name, commands);
        let entry =
            field::number(ui, &format!("Place of {name}"), Unit::COORDINATE.bare(), load.arc_length_m, KIND_WIDTH);
        if let Some(arc_length_m) = entry.value {
            set(Load { arc_length_m, ..load.clone() }, commands);
        }
        faults.extend(entry.fault);
        entry.response.on_hover_text("Where on the cable, m of unstretched length from its start");
        match load.force_n {
            Some(force_n) => {
                let labels = [format!("Force to the right of {name}"), format!("Force upwards of {name}")];
                if let Some(force_n) = components(ui, labels, Unit::N, force_n, &mut faults) {
                    set(Load { force_n: Some(force_n), ..load.clone() }, commands);
                }
            }
            None => {
                ui.weak("changes with time").on_hover_text("Edit times_s and forces_n in the scene file");
            }
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            remove(ui, item, &name, "Takes it off", commands);
        });
    });
    if let (Some(force_n), true) = (load.force_n, state.selected == Some(item)) {
        strength(ui, load, (k, force_n), commands);
    }
    if state.scene.cables.len() > 1 {
        ui.horizontal(|ui| {
            ui.label("    on");
            let shown = ComboBox::from_id_salt("cable").selected_text(&load.cable).show_ui(ui, |ui| {
                for cable in &state.scene.cables {
                    if ui.selectable_label(cable.name == load.cable, &cable.name).clicked() {
                        set(Load { cable: cable.name.clone(), ..load.clone() }, commands);
                    }
                }
            });
            field::name(&shown.response, &format!("Cable of {name}"));
        });
    }
    show_faults(ui, &faults);
}

/// The slider of a selected load: how much, in the direction it has.
fn strength(ui: &mut Ui, load: &Load, (k, force_n): (usize, [f64; 2]), commands: &mut Vec<Command>) {
    let size = force_n[0].hypot(force_n[1]);
    let known = Known { value: size, ..Known::default() };
    let change = row(ui, &STRENGTH, &known);
    if let Some(wanted) = change.value.filter(|v| v.is_finite() && *v >= 0.0) {
        let direction = if size > 0.0 { force_n.map(|f| f / size) } else { [0.0, -1.0] };
        let value = Load { force_n: Some(direction.map(|d| d * wanted)), ..load.clone() };
        commands.push(Command::Scene(SceneCommand::SetLoad { load: k, value }));
    }
    if change.done {
        commands.push(Command::Scene(SceneCommand::EditDone));
    }
}

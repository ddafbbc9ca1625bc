//! The list of point loads shows the size of each load; a form shows all properties of one load.

use cable_core::Load;
use egui::{ComboBox, Ui};

use crate::command::{Command, SceneCommand};
use crate::panels::scene::rows::{self, VALUE_WIDTH, components, show_faults};
use crate::panels::scene_errors;
use crate::state::{AppState, Item};
use crate::units::format;
use crate::units::unit::Unit;
use crate::widgets::field;
use crate::widgets::property::{PropertyQuantity, Provenance, labelled, row};
use crate::widgets::time_table::{self, Knots, Table};

/// Force of a new load, N.
const FIRST_LOAD_N: [f64; 2] = [0.0, -100.0];

/// Time over which what begins to change with time does so at first, s.
pub const FIRST_SPAN_S: f64 = 5.0;

const STRENGTH: PropertyQuantity = PropertyQuantity {
    name: "Load force",
    unit: Unit::N,
    usual: [1.0, 5000.0],
    logarithmic: true,
    help: "How strong the selected load is, in the direction it has; the cable follows while the slider moves.",
};

/// Lists them.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    for (k, load) in state.document.scene.loads.iter().enumerate() {
        let about = load.force_n.map_or("changes with time".to_owned(), |[x, y]| format::force(x.hypot(y)));
        ui.push_id(k, |ui| rows::row(ui, state, Item::Load(k), &format!("load {}", k + 1), &about, commands));
    }
    let Some(load) = new_load(state) else { return };
    if ui.button("Add load").on_hover_text("A force on the middle of the cable, 100 N down").clicked() {
        commands.push(Command::Scene(load));
    }
}

/// A load on the middle of the current cable.
#[must_use]
pub fn new_load(state: &AppState) -> Option<SceneCommand> {
    let cable = state.document.scene.cables.get(state.current_cable())?;
    Some(SceneCommand::AddLoad(Load {
        cable: cable.name.clone(),
        arc_length_m: cable.length_m / 2.0,
        force_n: Some(FIRST_LOAD_N),
        times_s: Vec::new(),
        forces_n: Vec::new(),
    }))
}

/// Place and strength of the load.
fn head(ui: &mut Ui, state: &AppState, k: usize, load: &Load, commands: &mut Vec<Command>, faults: &mut Vec<String>) {
    let name = format!("load {}", k + 1);
    let set = |value: Load, commands: &mut Vec<Command>| {
        commands.push(Command::Scene(SceneCommand::SetLoad { load: k, value }));
        commands.push(Command::Scene(SceneCommand::EditDone));
    };
    if state.document.scene.cables.len() > 1 {
        labelled(ui, "On", &format!("Cable of {name}"), |ui| {
            let combo = ComboBox::from_id_salt("cable").selected_text(&load.cable).width(ui.available_width() - 14.0);
            let shown = combo.show_ui(ui, |ui| {
                for cable in &state.document.scene.cables {
                    if ui.selectable_label(cable.name == load.cable, &cable.name).clicked() {
                        set(Load { cable: cable.name.clone(), ..load.clone() }, commands);
                    }
                }
            });
            shown.response.on_hover_text("The cable it acts on")
        });
    }
    labelled(ui, "At", &format!("Place of {name}"), |ui| {
        let entry = field::number(ui, &format!("Place of {name}"), Unit::COORDINATE, load.arc_length_m, VALUE_WIDTH);
        if let Some(arc_length_m) = entry.value {
            set(Load { arc_length_m, ..load.clone() }, commands);
        }
        faults.extend(entry.fault);
        entry.response.on_hover_text("Where on the cable, unstretched length from its start")
    });
    let Some(force_n) = load.force_n else { return };
    rows::pair(ui, &format!("Right, up, {}", Unit::N.display().symbol), |ui| {
        let labels = [format!("Force to the right of {name}"), format!("Force upwards of {name}")];
        if let Some(force_n) = components(ui, labels, Unit::N, force_n, faults) {
            set(Load { force_n: Some(force_n), ..load.clone() }, commands);
        }
    });
}

/// Everything about a load.
pub fn form(ui: &mut Ui, state: &AppState, k: usize, commands: &mut Vec<Command>) {
    let Some(load) = state.document.scene.loads.get(k) else { return };
    let mut faults = Vec::new();
    head(ui, state, k, load, commands, &mut faults);
    if let Some(force_n) = load.force_n {
        strength(ui, load, k, force_n, commands);
    }
    if let Some(value) = timed(ui, &format!("load {}", k + 1), load, &mut faults) {
        commands.push(Command::Scene(SceneCommand::SetLoad { load: k, value }));
        commands.push(Command::Scene(SceneCommand::EditDone));
    }
    show_faults(ui, &faults);
    scene_errors::inline(ui, state, &format!("loads[{k}]"), commands);
}

/// A force that changes with time, or does from now on.
fn timed(ui: &mut Ui, name: &str, load: &Load, faults: &mut Vec<String>) -> Option<Load> {
    let knots = Knots::of(&load.times_s, &load.forces_n);
    let on = load.force_n.is_none();
    let help = "A force at each of several times, linear in between";
    if let Some(on) = time_table::toggle(ui, &format!("{name} changes with time"), on, help) {
        let force_n = load.force_n.or(knots.values.first().copied()).unwrap_or(FIRST_LOAD_N);
        let knots = if on { Knots::steady(force_n, FIRST_SPAN_S) } else { Knots::default() };
        return Some(with(load, (!on).then_some(force_n), knots));
    }
    let table = Table { of: name, columns: ["Right", "Up"], unit: Unit::N, least: 1 };
    let changed = if on { time_table::ui(ui, &table, &knots, faults) } else { None };
    changed.map(|knots| with(load, None, knots))
}

fn with(load: &Load, force_n: Option<[f64; 2]>, knots: Knots) -> Load {
    Load { force_n, times_s: knots.times_s, forces_n: knots.values, ..load.clone() }
}

/// The slider of a selected load: how much, in the direction it has.
fn strength(ui: &mut Ui, load: &Load, k: usize, force_n: [f64; 2], commands: &mut Vec<Command>) {
    let size = force_n[0].hypot(force_n[1]);
    let known = Provenance { value: size, ..Provenance::default() };
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

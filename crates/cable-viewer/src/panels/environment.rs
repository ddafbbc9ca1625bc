//! The environment panel edits gravity, wind, temperature and view.

use cable_core::scene::{Environment, View};
use egui::Ui;

use crate::command::{Command, SceneCommand};
use crate::panels::scene_errors;
use crate::state::AppState;
use crate::units::unit::Unit;
use crate::widgets::field;
use crate::widgets::property::{PropertyQuantity, Provenance, row};
use crate::widgets::time_table::{self, Knots, Table};

/// A number of the environment that the panel edits.
struct EnvironmentRow {
    quantity: PropertyQuantity,
    /// Its path in the scene.
    path: &'static str,
    /// True for a component of the wind, which gives way to a table where the wind changes with
    /// time.
    is_wind: bool,
    get: fn(&Environment) -> f64,
    set: fn(&mut Environment, f64),
}

const GRAVITY: EnvironmentRow = EnvironmentRow {
    quantity: PropertyQuantity {
        name: "Gravity",
        unit: Unit::M_PER_S2,
        usual: [0.0, 25.0],
        logarithmic: false,
        help: "Acceleration of free fall: down in a side view, into the page in a plan view. Standard is 9.80665 m/s², the Moon's 1.62 m/s².",
    },
    path: "environment.gravity_m_per_s2",
    is_wind: false,
    get: |e| e.gravity_m_per_s2,
    set: |e, v| e.gravity_m_per_s2 = v,
};
const WIND_X: EnvironmentRow = EnvironmentRow {
    quantity: PropertyQuantity {
        name: "Wind to the right",
        unit: Unit::N_PER_M,
        usual: [-50.0, 50.0],
        logarithmic: false,
        help: "Force of wind or stream on each metre of unstretched cable, to the right. Negative: to the left.",
    },
    path: "environment.wind_n_per_m[0]",
    is_wind: true,
    get: |e| e.wind_n_per_m[0],
    set: |e, v| e.wind_n_per_m[0] = v,
};
const WIND_Y: EnvironmentRow = EnvironmentRow {
    quantity: PropertyQuantity {
        name: "Wind upwards",
        unit: Unit::N_PER_M,
        usual: [-50.0, 50.0],
        logarithmic: false,
        help: "Force of wind or stream on each metre of unstretched cable, upwards. Negative: downwards.",
    },
    path: "environment.wind_n_per_m[1]",
    is_wind: true,
    get: |e| e.wind_n_per_m[1],
    set: |e, v| e.wind_n_per_m[1] = v,
};
const TEMPERATURE: EnvironmentRow = EnvironmentRow {
    quantity: PropertyQuantity {
        name: "Temperature rise",
        unit: Unit::K,
        usual: [-60.0, 120.0],
        logarithmic: false,
        help: "Degrees above the temperature at which the lengths are given. Changes each length by its thermal expansion.",
    },
    path: "environment.temperature_change_k",
    is_wind: false,
    get: |e| e.temperature_change_k,
    set: |e, v| e.temperature_change_k = v,
};

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    view(ui, state, commands);
    let environment = &state.document.scene.environment;
    for EnvironmentRow { quantity, path, is_wind, get, set } in [GRAVITY, WIND_X, WIND_Y, TEMPERATURE] {
        if is_wind && !environment.winds_n_per_m.is_empty() {
            continue;
        }
        let known = Provenance {
            value: get(environment),
            origin: Some((get(&state.document.saved.environment), "as loaded".to_owned())),
            ..Provenance::default()
        };
        let change = row(ui, &quantity, &known);
        if let Some(value) = change.value {
            let mut changed = environment.clone();
            set(&mut changed, value);
            commands.push(Command::Scene(SceneCommand::SetEnvironment(changed)));
        }
        if change.done {
            commands.push(Command::Scene(SceneCommand::EditDone));
        }
        scene_errors::inline(ui, state, path, commands);
    }
    wind(ui, state, commands);
}

/// Wind that changes with time, or does from now on.
fn wind(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    /// Time over which it changes at first, s.
    const FIRST_SPAN_S: f64 = 5.0;
    let environment = &state.document.scene.environment;
    let knots = Knots::of(&environment.wind_times_s, &environment.winds_n_per_m);
    let on = !environment.winds_n_per_m.is_empty();
    let (mut faults, mut changed) = (Vec::new(), None);
    let help = "A wind at each of several times, linear in between";
    if let Some(on) = time_table::toggle(ui, "Wind changes with time", on, help) {
        let steady = Knots::steady(environment.wind_n_per_m, FIRST_SPAN_S);
        changed = Some(if on { steady } else { Knots::default() });
    } else if on {
        let table = Table { of: "wind", columns: ["Right", "Up"], unit: Unit::N_PER_M, least: 1 };
        changed = time_table::ui(ui, &table, &knots, &mut faults);
    }
    if let Some(Knots { times_s, values }) = changed {
        let environment = Environment { wind_times_s: times_s, winds_n_per_m: values, ..environment.clone() };
        commands.push(Command::Scene(SceneCommand::SetEnvironment(environment)));
        commands.push(Command::Scene(SceneCommand::EditDone));
    }
    for text in faults {
        field::fault(ui, &text);
    }
    for path in ["environment.wind_times_s", "environment.winds_n_per_m"] {
        scene_errors::inline(ui, state, path, commands);
    }
}

/// The choice of side view or plan view.
fn view(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let mut view = state.document.scene.view;
        let side = ui.selectable_value(&mut view, View::Elevation, "Side view");
        side.on_hover_text("Seen from the side: gravity points down");
        let plan = ui.selectable_value(&mut view, View::Plan, "Plan view");
        plan.on_hover_text("Seen from above: gravity points into the page and the floor rubs everywhere");
        if view != state.document.scene.view {
            let scene = cable_core::Scene { view, ..state.document.scene.clone() };
            commands.push(Command::Scene(SceneCommand::SetScene(Box::new(scene))));
        }
    });
    if let Some(found) = scene_errors::at(state, "view") {
        field::fault(ui, &scene_errors::sentence(&found.fault));
    }
}

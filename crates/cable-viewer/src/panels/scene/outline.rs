//! The outline shows all items of the scene as a tree: a click on an item selects it, and the panel
//! on the right edits it.

use cable_core::scene::preset::robot_preset;
use cable_core::scene::{RobotTask, View};
use egui::{CollapsingHeader, Ui};

use crate::command::Command;
use crate::panels::scene::rows::row;
use crate::panels::scene::{loads, obstacles, supports};
use crate::panels::warnings;
use crate::state::{AppState, Item};
use crate::units::unit::Unit;
use crate::units::{format, labels};

/// Indent of the rows that belong to a cable or a heading, points.
const INDENT: f32 = 10.0;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    ui.spacing_mut().item_spacing.y = 2.0;
    let scene = &state.document.scene;
    let width = ui.available_width();
    let current = state.current_cable();
    row(ui, state, Item::Scene, "Scene", &scene.name, commands);
    for (k, cable) in scene.cables.iter().enumerate() {
        let most = greatest_tension(state, k);
        row(ui, state, Item::Cable(k), &cable.name, &most, commands);
        // The others open once they are selected.
        if k == current {
            indented(ui, ("supports", k), |ui| supports::ui(ui, state, k, commands));
        }
    }
    list(ui, width, "obstacles", &format!("Obstacles ({})", scene.obstacles.len()), |ui| {
        obstacles::ui(ui, state, commands);
    });
    list(ui, width, "loads", &format!("Loads ({})", scene.loads.len()), |ui| loads::ui(ui, state, commands));
    robot(ui, state, commands);
    row(ui, state, Item::Environment, "Environment", &environment(state), commands);
    let model = state.live.snapshot.solution.as_ref().map_or("", |s| labels::model(s.model));
    row(ui, state, Item::Solver, "Solver", model, commands);
    warnings::summary(ui, state, commands);
}

/// Contents moved to the right by one level.
fn indented(ui: &mut Ui, id: impl std::hash::Hash + std::fmt::Debug, contents: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        ui.add_space(INDENT);
        let width = ui.available_width();
        ui.push_id(id, |ui| {
            ui.vertical(|ui| {
                ui.set_max_width(width);
                contents(ui);
            });
        });
    });
}

fn list(ui: &mut Ui, width: f32, id: &str, title: &str, contents: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(title).id_salt(id).default_open(true).show_unindented(ui, |ui| {
        ui.set_max_width(width);
        indented(ui, id, contents);
    });
}

/// The greatest tension of a cable in words; empty if there is no answer.
fn greatest_tension(state: &AppState, cable: usize) -> String {
    let solved = state.live.snapshot.solution.as_ref().and_then(|s| s.cables.get(cable));
    let tensions = solved.into_iter().flat_map(|c| &c.nodes).map(|n| n.tension_n).filter(|t| t.is_finite());
    tensions.reduce(f64::max).map_or_else(String::new, |t| format!("max {}", format::force(t)))
}

/// The view, and what acts besides gravity.
fn environment(state: &AppState) -> String {
    let scene = &state.document.scene;
    let view = match scene.view {
        View::Elevation => "side view",
        View::Plan => "plan view",
    };
    let wind = scene.environment.wind_n_per_m != [0.0; 2] || !scene.environment.winds_n_per_m.is_empty();
    if wind { format!("{view}, wind") } else { view.to_owned() }
}

/// The robot, and the legs of its path.
fn robot(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Some(robot) = &state.document.scene.robot else { return };
    let about = robot_preset(&robot.preset).map_or(robot.preset.as_str(), |p| p.name.as_str());
    row(ui, state, Item::Robot, "robot", about, commands);
    for (k, task) in robot.path.iter().enumerate() {
        indented(ui, ("leg", k), |ui| match task {
            RobotTask::Drive { to_x_m, .. } => {
                let about = format!("to {}", Unit::COORDINATE.text(*to_x_m));
                row(ui, state, Item::PathLeg(k), &format!("leg {}", k + 1), &about, commands);
            }
            RobotTask::Wait { wait_s } => {
                ui.weak(format!("leg {}: wait {}", k + 1, format::duration(*wait_s)));
            }
        });
    }
}

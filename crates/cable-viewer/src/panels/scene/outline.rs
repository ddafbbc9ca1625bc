//! The outline is everything in the scene as a tree: a click on a thing selects it, and what the
//! window shows of it follows.

use cable_core::scene::RobotTask;
use cable_core::scene::preset::robot_preset;
use egui::{Atom, Button, CollapsingHeader, Ui};

use crate::command::{Command, ViewCommand};
use crate::panels::readouts::DIMMED;
use crate::panels::scene::{loads, obstacles, supports};
use crate::panels::warnings;
use crate::state::{AppState, Item};
use crate::units::format;
use crate::units::unit::Unit;
use crate::widgets::field;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let scene = &state.document.scene;
    let width = ui.available_width();
    let current = state.current_cable();
    for (k, cable) in scene.cables.iter().enumerate() {
        let most = greatest_tension(state, k);
        row(ui, state, Item::Cable(k), &cable.name, &most, commands);
        // The others open once they are selected.
        if k == current {
            ui.push_id(("supports", k), |ui| supports::ui(ui, state, k, commands));
        }
    }
    list(ui, width, "obstacles", &format!("Obstacles ({})", scene.obstacles.len()), |ui| {
        obstacles::ui(ui, state, commands);
    });
    list(ui, width, "loads", &format!("Loads ({})", scene.loads.len()), |ui| loads::ui(ui, state, commands));
    robot(ui, state, commands);
    warnings::summary(ui, state, commands);
}

fn list(ui: &mut Ui, width: f32, id: &str, title: &str, contents: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(title).id_salt(id).default_open(true).show_unindented(ui, |ui| {
        ui.set_max_width(width);
        contents(ui);
    });
}

/// A thing with a word about it at the right end.
fn row(ui: &mut Ui, state: &AppState, item: Item, name: &str, about: &str, commands: &mut Vec<Command>) {
    let selected = state.selection.selected == Some(item);
    let colour = if selected { ui.visuals().text_color() } else { ui.visuals().weak_text_color() };
    let opacity = if state.is_current() { 1.0 } else { DIMMED };
    let about = egui::RichText::new(about).color(colour.gamma_multiply(opacity));
    let button = Button::selectable(selected, (name, Atom::grow(), about)).truncate();
    let response = ui.add(button.min_size(egui::vec2(ui.available_width() - 4.0, 0.0)));
    field::name(&response, &format!("Select {name}"));
    if response.on_hover_text(format!("{}: click to select it", state.describe(item))).clicked() {
        commands.push(Command::View(ViewCommand::Select((!selected).then_some(item))));
    }
}

/// The greatest tension of a cable in words; nothing where there is no answer.
fn greatest_tension(state: &AppState, cable: usize) -> String {
    let solved = state.live.snapshot.solution.as_ref().and_then(|s| s.cables.get(cable));
    let tensions = solved.into_iter().flat_map(|c| &c.nodes).map(|n| n.tension_n).filter(|t| t.is_finite());
    tensions.reduce(f64::max).map_or_else(String::new, |t| format!("max {}", format::force(t)))
}

/// The robot, and the legs of its path.
fn robot(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Some(robot) = &state.document.scene.robot else { return };
    let about = robot_preset(&robot.preset).map_or(robot.preset.as_str(), |p| p.name.as_str());
    row(ui, state, Item::Robot, "robot", about, commands);
    for (k, task) in robot.path.iter().enumerate() {
        ui.indent(("leg", k), |ui| match task {
            RobotTask::Drive { to_x_m, .. } => {
                let about = format!("drive to {}", Unit::COORDINATE.text(*to_x_m));
                row(ui, state, Item::Leg(k), &format!("leg {}", k + 1), &about, commands);
            }
            RobotTask::Wait { wait_s } => {
                ui.weak(format!("leg {}: wait {}", k + 1, format::duration(*wait_s)));
            }
        });
    }
}

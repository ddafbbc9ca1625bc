//! This panel edits the selected item and shows the answer about it: the force on a support, the
//! contacts of an obstacle, the tension at a load, the motion of the robot. Cables, the environment
//! and the solver have panels of their own, which stand here once they are selected.

use cable_core::Solution;
use cable_core::scene::SupportKind;
use cable_core::solution::{ContactReport, ContactState};
use egui::Ui;

use crate::command::{Command, SceneCommand, ViewCommand};
use crate::geometry::handles;
use crate::geometry::supports::{is_broken, support_position};
use crate::panels::display_names::capital;
use crate::panels::readouts::dimmed_if_old;
use crate::panels::scene::{self, loads, obstacles, supports};
use crate::panels::{cable, environment, robot, solver};
use crate::state::{AppState, Item};
use crate::units::format;
use crate::widgets::{field, readout};

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Some(item) = state.selection.selected else { return };
    ui.add(egui::Label::new(egui::RichText::new(capital(&state.describe(item))).strong()).truncate());
    ui.horizontal(|ui| {
        let at_m = handles::of(state, item);
        if let Some(at_m) = at_m
            && ui
                .button("Zoom on it")
                .on_hover_text(format!("Shows what lies round {}", format::position(at_m)))
                .clicked()
        {
            commands.push(Command::View(ViewCommand::ZoomOn(at_m)));
        }
        if ui.button("Deselect").on_hover_text("Selects nothing (Esc)").clicked() {
            commands.push(Command::View(ViewCommand::Select(None)));
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| remove(ui, state, item, commands));
    });
    ui.push_id(item, |ui| match item {
        Item::Support { cable, support } => supports::form(ui, state, cable, support, commands),
        Item::Obstacle(k) | Item::Corner { obstacle: k, .. } => obstacles::form(ui, state, k, commands),
        Item::Load(k) | Item::LoadHead(k) => loads::form(ui, state, k, commands),
        Item::Cable(_) => cable::ui(ui, state, commands),
        Item::Robot | Item::PathLeg(_) => {
            scene::robot::ui(ui, state, commands);
            robot::ui(ui, state, commands);
        }
        Item::Scene => scene::ui(ui, state, commands),
        Item::Environment => environment::ui(ui, state, commands),
        Item::Solver => solver::ui(ui, state, commands),
    });
    let Some(answer) = state.live.snapshot.solution.as_deref() else { return };
    dimmed_if_old(ui, state, |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        for (name, value, help) in figures(state, answer, item) {
            readout::row(ui, name, &value, help, |_| {});
        }
    });
}

/// The button that takes it out of the scene, where that can be done.
fn remove(ui: &mut Ui, state: &AppState, item: Item, commands: &mut Vec<Command>) {
    let scene = &state.document.scene;
    let (name, help) = match item {
        Item::Support { cable, support } => {
            let Some(of) = scene.cables.get(cable) else { return };
            let Some(value) = of.supports.get(support) else { return };
            let end = support == 0 || support + 1 == of.supports.len();
            if end && value.kind == SupportKind::Free {
                return;
            }
            (value.name.clone(), if end { "Frees this end" } else { "Removes it" })
        }
        Item::Obstacle(k) | Item::Corner { obstacle: k, .. } => {
            (scene.obstacles.get(k).map_or_else(String::new, |o| o.name.clone()), "Removes it")
        }
        Item::Load(k) | Item::LoadHead(k) => (format!("load {}", k + 1), "Removes it"),
        _ => return,
    };
    // A corner or the head of an arrow has the form of what it is of.
    let whole = match item {
        Item::Corner { obstacle, .. } => Item::Obstacle(obstacle),
        Item::LoadHead(k) => Item::Load(k),
        other => other,
    };
    let button = ui.button("Remove");
    field::name(&button, &format!("Remove {name}"));
    if button.on_hover_text(help).clicked() {
        commands.push(Command::Scene(SceneCommand::Remove(whole)));
    }
}

type Figure = (&'static str, String, &'static str);

/// The figures of an item's answer.
fn figures(state: &AppState, answer: &Solution, item: Item) -> Vec<Figure> {
    match item {
        Item::Support { cable, support } => of_support(state, answer, cable, support),
        Item::Obstacle(k) | Item::Corner { obstacle: k, .. } => {
            let name = state.document.scene.obstacles.get(k).map_or("", |o| o.name.as_str());
            of_obstacle(answer, name)
        }
        Item::Load(k) | Item::LoadHead(k) => of_load(state, answer, k),
        // The panels of the others have their own figures, or none.
        Item::Robot | Item::PathLeg(_) | Item::Cable(_) | Item::Scene | Item::Environment | Item::Solver => Vec::new(),
    }
}

/// Help of the row with the components of a force.
const COMPONENTS_HELP: &str = "Its horizontal and its vertical component";

/// The components of a force, N, with their directions.
fn components(force_n: [f64; 2]) -> String {
    format::force_with_direction(force_n).join(", ")
}

/// The figures of a support.
fn of_support(state: &AppState, answer: &Solution, cable: usize, support: usize) -> Vec<Figure> {
    let Some(s) = answer.cables.get(cable).and_then(|c| c.supports.get(support)) else { return Vec::new() };
    // The answer leaves one that no piece hangs on where the run began.
    let torn_off = is_broken(state, cable) && s.reaction_x_n == 0.0 && s.reaction_y_n == 0.0;
    let now = [s.x_m, s.y_m];
    let place = if torn_off { support_position(state, cable, support).unwrap_or(now) } else { now };
    let mut rows = vec![
        ("Force on it", format::force(s.reaction_x_n.hypot(s.reaction_y_n)), "Force of the cable on the support"),
        ("  components", components([s.reaction_x_n, s.reaction_y_n]), COMPONENTS_HELP),
        (
            "Current position",
            format::position(place),
            "Where it is at this time; the position above is where it is sent",
        ),
    ];
    if torn_off {
        rows.push(("Holds", "nothing, torn off".to_owned(), "The cable broke away from it"));
        return rows;
    }
    for (name, tension, help) in [
        ("Tension before", s.tension_before_n, "On the side of the start of the cable"),
        ("Tension after", s.tension_after_n, "On the side of the end of the cable"),
    ] {
        rows.extend(tension.map(|t| (name, format::force(t), help)));
    }
    rows
}

/// The figures of an obstacle, over all cables.
fn of_obstacle(answer: &Solution, name: &str) -> Vec<Figure> {
    let contacts: Vec<&ContactReport> =
        answer.cables.iter().flat_map(|c| &c.contacts).filter(|c| c.obstacle == name).collect();
    if contacts.is_empty() {
        return vec![("Contacts", "none".to_owned(), "No cable touches it")];
    }
    let sliding = contacts.iter().filter(|c| c.state == ContactState::Slip).count();
    let sum = |of: fn(&ContactReport) -> f64| contacts.iter().map(|c| of(c)).sum::<f64>();
    let force = contacts.iter().fold([0.0; 2], |sum, c| [sum[0] - c.force_n[0], sum[1] - c.force_n[1]]);
    vec![
        ("Contacts", format!("{}, {sliding} sliding", contacts.len()), "Places where a cable touches it"),
        ("Contact force", format::force(sum(|c| c.normal_n)), "Sum of the normal forces"),
        ("Friction", format::force(sum(|c| c.friction_n.abs())), "Sum of the friction forces"),
        ("Lying on it", format::length(sum(|c| c.ends_m - c.begins_m)), "Length of cable in contact"),
        ("Force on it", format::force(force[0].hypot(force[1])), "Of all cables together"),
        ("  components", components(force), COMPONENTS_HELP),
    ]
}

/// The figures of a load.
fn of_load(state: &AppState, answer: &Solution, k: usize) -> Vec<Figure> {
    let Some(load) = state.document.scene.loads.get(k) else { return Vec::new() };
    let Some(cable) = answer.cables.iter().find(|c| c.name == load.cable) else { return Vec::new() };
    let next = cable.nodes.partition_point(|n| n.arc_length_m < load.arc_length_m);
    let Some(node) = cable.nodes.get(next).or(cable.nodes.last()) else { return Vec::new() };
    let steady = load.force_n.map(|[x, y]| ("Force", format::force(x.hypot(y)), "The same at every time"));
    let there = [
        ("Tension there", format::force(node.tension_n), "Tension of the cable beside it"),
        ("Current position", format::position([node.x_m, node.y_m]), "Where it acts at this time"),
    ];
    steady.into_iter().chain(there).collect()
}

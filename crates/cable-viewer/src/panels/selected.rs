//! What is selected is edited here, with the answer about it: the force on a support, the contacts of
//! an obstacle, the tension at a load, the motion of the robot.

use cable_core::Solution;
use cable_core::solution::{ContactReport, ContactState};
use egui::Ui;

use crate::command::{Command, ViewCommand};
use crate::geometry::handles;
use crate::panels::readouts::DIMMED;
use crate::panels::scene::{loads, obstacles, supports};
use crate::state::{AppState, Item};
use crate::units::format;
use crate::units::unit::Unit;
use crate::widgets::readout;

/// Whether it is shown; a whole cable has a panel of its own, and the readouts.
#[must_use]
pub fn is_shown(state: &AppState) -> bool {
    state.selection.selected.is_some_and(|item| !matches!(item, Item::Cable(_)))
}

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Some(item) = state.selection.selected else { return };
    ui.add(egui::Label::new(egui::RichText::new(state.describe(item)).strong()).truncate());
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
    });
    ui.push_id(item, |ui| match item {
        Item::Support { cable, support } => supports::form(ui, state, cable, support, commands),
        Item::Obstacle(k) | Item::Corner { obstacle: k, .. } => obstacles::form(ui, state, k, commands),
        Item::Load(k) | Item::Head(k) => loads::form(ui, state, k, commands),
        Item::Cable(_) | Item::Robot | Item::Leg(_) => {}
    });
    let Some(answer) = state.live.snapshot.solution.as_deref() else { return };
    ui.scope(|ui| {
        if !state.is_current() {
            ui.multiply_opacity(DIMMED);
        }
        ui.spacing_mut().item_spacing.y = 2.0;
        for (name, value, help) in figures(state, answer, item) {
            readout::row(ui, name, &value, help, |_| {});
        }
    });
}

type Figure = (&'static str, String, &'static str);

fn figures(state: &AppState, answer: &Solution, item: Item) -> Vec<Figure> {
    match item {
        Item::Support { cable, support } => of_support(answer, cable, support),
        Item::Obstacle(k) | Item::Corner { obstacle: k, .. } => {
            let name = state.document.scene.obstacles.get(k).map_or("", |o| o.name.as_str());
            of_obstacle(answer, name)
        }
        Item::Load(k) | Item::Head(k) => of_load(state, answer, k),
        Item::Robot | Item::Leg(_) => of_robot(answer),
        Item::Cable(_) => Vec::new(),
    }
}

fn of_support(answer: &Solution, cable: usize, support: usize) -> Vec<Figure> {
    let Some(s) = answer.cables.get(cable).and_then(|c| c.supports.get(support)) else { return Vec::new() };
    let mut rows = vec![
        ("Force on it", format::force(s.reaction_x_n.hypot(s.reaction_y_n)), "Force of the cable on the support"),
        ("  to the right", format::force(s.reaction_x_n), "Its horizontal component"),
        ("  upwards", format::force(s.reaction_y_n), "Its vertical component"),
        ("Place", format::position([s.x_m, s.y_m]), "Where it is now"),
        ("On the cable", Unit::COORDINATE.text(s.arc_length_m), "Unstretched length from the start of the cable"),
    ];
    for (name, tension, help) in [
        ("Tension before", s.tension_before_n, "On the side of the start of the cable"),
        ("Tension after", s.tension_after_n, "On the side of the end of the cable"),
    ] {
        rows.extend(tension.map(|t| (name, format::force(t), help)));
    }
    rows
}

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
        ("  to the right", format::force(force[0]), "Its horizontal component"),
        ("  upwards", format::force(force[1]), "Its vertical component"),
    ]
}

fn of_load(state: &AppState, answer: &Solution, k: usize) -> Vec<Figure> {
    let Some(load) = state.document.scene.loads.get(k) else { return Vec::new() };
    let Some(cable) = answer.cables.iter().find(|c| c.name == load.cable) else { return Vec::new() };
    let next = cable.nodes.partition_point(|n| n.arc_length_m < load.arc_length_m);
    let Some(node) = cable.nodes.get(next).or(cable.nodes.last()) else { return Vec::new() };
    let steady = load.force_n.map(|[x, y]| ("Force", format::force(x.hypot(y)), "The same at every time"));
    let there = [
        ("Tension there", format::force(node.tension_n), "Tension of the cable beside it"),
        ("Place", format::position([node.x_m, node.y_m]), "Where it acts now"),
    ];
    steady.into_iter().chain(there).collect()
}

fn of_robot(answer: &Solution) -> Vec<Figure> {
    let Some(robot) = answer.robot else {
        return vec![("Motion", "none".to_owned(), "It needs terrain below it in a side view")];
    };
    vec![
        ("Motion", robot.going.name().to_owned(), "Why it is as fast as it is"),
        ("Speed", Unit::M_PER_S.text(robot.speed_m_per_s), "Along the ground"),
        ("Pull of cable", format::force(robot.hitch_x_n.hypot(robot.hitch_y_n)), "On its hitch"),
        ("Place", format::position([robot.x_m, robot.y_m]), "The middle of its tracks"),
    ]
}
